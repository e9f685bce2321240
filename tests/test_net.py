from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.airfoils.landmarks import landmark_parameters, landmarks
from bladegen.blade.blade import Blade
from bladegen.formats.bundled import bundled
from bladegen.formats.reading import read
from bladegen.measures import smoothness
from bladegen.surface import creases, fitting
from bladegen.surface.fitting import fitted
from bladegen.surface.net import on_knots
from bladegen.surface.splines import Knots
from strategies import SEEDS, definitions, ellipse, few, net_through

U = landmark_parameters(101)


def cone(top: float) -> np.ndarray:
    """Sections of an elliptic cone frustum of length 10, blunt by nothing."""
    shape = landmarks(ellipse(0.5, 721), 101)
    v = np.linspace(0, 1, 7)
    scale = 1 + (top - 1) * v
    flat = scale[:, None, None] * (shape - [0.5, 0.0])
    return np.concatenate(
        [flat[..., ::-1], np.broadcast_to(10 * v[:, None, None], (7, 101, 1))], axis=-1
    )


V = np.linspace(0, 1, 7)


@given(SEEDS)
def test_a_net_interpolates_its_sections(seed):
    sections = cone(0.5) + 0.01 * np.random.default_rng(seed).normal(size=(7, 1, 3))
    fitted = net_through(sections, U, V)
    assert_allclose(fitted.evaluate(U, V), sections, atol=1e-12)


@given(SEEDS)
def test_halves_are_the_whole(seed):
    sections = cone(0.5) + 0.01 * np.random.default_rng(seed).normal(size=(7, 1, 3))
    whole = net_through(sections, U, V)
    for half, u in zip(
        whole.halves(), (np.linspace(0, 0.5, 9), np.linspace(0.5, 1, 9)), strict=True
    ):
        assert_allclose(half.evaluate(u, V), whole.evaluate(u, V), atol=1e-12)
        assert len(half.u_knots) == len(half.poles) + 4
    suction, pressure = whole.halves()
    assert_allclose(suction.poles[-1], pressure.poles[0], atol=1e-14)


@pytest.mark.parametrize("ends", [(0.0, 0.4), (0.1, 0.5), (0.37, 1.0), (0.0, 1.0)])
def test_a_part_of_the_span_is_the_same_surface(ends):
    whole = net_through(cone(0.5), U, V)
    part, v = whole.between(*ends), np.linspace(*ends, 9)
    assert_allclose(part.evaluate(U, v), whole.evaluate(U, v), atol=1e-12)
    assert (part.v[0], part.v[-1]) == ends
    assert len(part.v_knots) == part.poles.shape[1] + 4
    low, high = (10.0 * end * (1.0 - 0.5 * end + end**2 / 12.0) for end in ends)
    assert_allclose(part.volume(), np.pi * 0.5 * 0.25 * (high - low), rtol=1e-5)


def test_a_cut_beside_a_knot_is_at_the_knot():
    """OCCT takes no knots that are nearer to each other than rounding."""
    part = net_through(cone(0.5), U, V).between(np.nextafter(V[2], 0.0), V[5] + 1e-12)
    assert_allclose(part.v, V[2:6], atol=0.0)


@pytest.mark.parametrize("top", [1.0, 0.5])
def test_volume_of_an_elliptic_cone(top):
    fitted = net_through(cone(top), U, V)
    wanted = np.pi * 0.5 * 0.25 * 10 * (1 + top + top**2) / 3
    assert_allclose(fitted.volume(), wanted, rtol=1e-5)


def test_offsets_are_distances_along_the_normal():
    fitted = net_through(cone(1.0), U, V)
    u, v = np.linspace(0.05, 0.95, 11), np.linspace(0.1, 0.9, 5)
    points = fitted.evaluate(u, v)
    assert_allclose(fitted.offsets(points, u, v), 0, atol=1e-15)
    along = fitted.evaluate(u, v, nu=1)
    slid = points + 1e-4 * along / np.linalg.norm(along, axis=-1, keepdims=True)
    assert np.abs(fitted.offsets(slid, u, v)).max() < 1e-6
    out = np.cross(along, fitted.evaluate(u, v, nv=1))
    out /= np.linalg.norm(out, axis=-1, keepdims=True)
    assert_allclose(fitted.offsets(points + 1e-3 * out, u, v), 1e-3, atol=1e-12)


@settings(max_examples=few(5))
@given(definitions())
def test_fitted_nets_meet_their_tolerance(definition):
    blade = Blade.from_definition(definition, landmarks=201)
    said = []
    fitted, deviation = fitting.fitted(blade, 1e-3, progress=said.append)
    assert deviation.maximum < 1e-3
    assert deviation.rms <= deviation.percentile99 <= deviation.maximum
    assert fitted.poles.size <= 3 * fitting.MAX_POLES
    assert said
    assert set(blade.eta) <= set(fitted.v)


@dataclass
class Tube:
    """A blade of circular sections, 2 m thick, that says which spans it is asked for."""

    jump: float = 0.0  # m, of the radius at eta = 0.4137
    turn: float = 0.0  # of the radius along z, from there on
    bend: float = 0.0  # 1/m, the same
    breaks: tuple = (0.0, 1.0)
    asked: list = field(default_factory=list)
    u = U
    eta = np.array([0.0, 1.0])
    length = 20.0
    sides = ("suction side", "pressure side")

    def stations(self, count):
        return np.linspace(0.0, 1.0, count)

    def sections(self, eta, u=None):
        self.asked += np.ravel(eta).tolist()
        angle = 2.0 * np.pi * (self.u if u is None else u)
        z = 20.0 * np.asarray(eta)[:, None] + 0.0 * angle
        beyond = np.maximum(z - 20.0 * PLACE, 0.0)
        radius = 1.0 + 0.3 * np.sin(0.5 * z) + self.jump * (beyond > 0.0)
        radius += self.turn * beyond + 0.5 * self.bend * beyond**2
        return np.stack([radius * np.sin(angle), radius * np.cos(angle), z], axis=-1)

    def __post_init__(self):
        self.breaks = np.array(self.breaks)


PLACE = 0.4137


def turned(surface, at):
    """The angles [rad] between normals just ahead of and behind a span, along the chord."""
    u = np.linspace(0.01, 0.99, 99)
    ahead, behind = surface.normals(u, np.array([at - 1e-9, at]))
    return np.arcsin(np.linalg.norm(np.cross(ahead, behind), axis=-1))


def test_a_net_passes_through_its_sections_with_their_slopes():
    tube, u = Tube(turn=0.1), np.array([0.1, 0.25, 0.4])
    v = Knots(np.array([0.0, 0.2, PLACE, 0.7, 1.0]), np.array([1, 2, 3, 1, 1]))
    surface = on_knots(tube, Knots.simple(np.linspace(0.0, 1.0, 81)), v)
    assert_allclose(surface.evaluate(u, v.at), tube.sections(v.at, u), atol=1e-6)
    step = 1e-6
    for at in (0.0, 0.2 - step, 0.2, PLACE - step, PLACE, 1.0 - step):
        wanted = np.diff(tube.sections(np.array([at, at + step]), u), axis=0)[0] / step
        given = surface.evaluate(u, np.array([min(at, at + step / 2)]), nv=1)[0]
        assert_allclose(given, wanted, atol=1e-3)
    assert_allclose(surface.spans, [0.0, 0.2, 0.2, PLACE, PLACE, PLACE, 0.7, 1.0])
    assert_allclose(surface.creases, [PLACE])


def test_no_section_is_made_twice_for_a_net():
    tube, knots = Tube(), Knots(np.linspace(0.0, 1.0, 9), np.array([1, 1, 2, 2, 3, 3, 2, 1, 1]))
    on_knots(tube, Knots.simple(U[::4]), knots)
    assert len(tube.asked) == len(set(tube.asked)) == 9 + 2 * (2 + 2 * 5)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
@pytest.mark.parametrize("breaks", [(0.0, PLACE, 1.0), (0.0, 1.0)], ids=["listed", "found"])
def test_a_crease_is_kept_and_none_is_made(breaks, tolerance):
    tube = Tube(turn=0.1, breaks=breaks)
    surface, measured = fitted(tube, tolerance)
    assert measured.maximum <= tolerance
    if breaks[1] == PLACE or tolerance < 1e-3:
        (crease,) = surface.creases
        assert crease == pytest.approx(PLACE, abs=1e-8)
        slope = 0.15 * np.cos(10.0 * PLACE)
        assert_allclose(
            turned(surface, crease), np.arctan(slope + 0.1) - np.arctan(slope), atol=2e-3
        )
    for at in np.setdiff1d(surface.v[1:-1], surface.creases):
        assert turned(surface, at).max() < 1e-6


def test_a_curvature_that_jumps_makes_no_crease():
    tube = Tube(bend=0.2, breaks=(0.0, PLACE, 1.0))
    surface, measured = fitted(tube, 1e-5)
    assert measured.maximum <= 1e-5
    assert not surface.creases.size
    assert np.count_nonzero(surface.spans == PLACE) == 2
    smooth, _ = fitted(Tube(breaks=(0.0, PLACE, 1.0)), 1e-5)
    assert np.count_nonzero(smooth.spans == PLACE) == 1


def test_jumps_of_slope_and_curvature_are_measured():
    for tube, turn, bend in ((Tube(turn=0.1), 0.1 * 20.0, 0.0), (Tube(bend=0.2), 0.0, 0.2 * 400.0)):
        breaks = creases.Breaks.of(replace(tube, breaks=(0.0, PLACE, 1.0)))
        tilt = np.hypot(1.0, 0.15 * np.cos(10.0 * PLACE) + 0.5 * tube.turn)
        assert_allclose(breaks.turns, turn / tilt, atol=5e-3)
        assert_allclose(breaks.bends, bend / tilt, atol=0.5)
        assert breaks.creases.tolist() == [turn > 0.0]


def test_creases_that_nobody_lists_are_found_and_jumps_are_not_taken_for_some():
    for tube, jumps in ((Tube(turn=0.05), False), (Tube(jump=1e-3), True)):
        at, said = creases.crease_between(tube, 0.4, 0.43)
        assert at == pytest.approx(PLACE, abs=1e-8)
        assert said is jumps


@settings(max_examples=few(6))
@given(st.lists(st.floats(1e-4, 3e-2), min_size=2, max_size=3))
def test_a_smaller_tolerance_never_gives_a_larger_deviation(tolerances):
    for tube in (Tube(turn=0.03, bend=0.1), Tube(jump=1e-3)):
        found = [fitted(tube, one)[1].maximum for one in sorted(tolerances)]
        assert found == sorted(found)


def test_deviation_falls_with_the_tolerance_and_the_blade_s_own_creases_stay():
    blade = Blade.from_definition(read("dtu10mw"), landmarks=101)
    found = [fitted(blade, 1e-3 * one) for one in (2.0, 1.0, 0.5, 0.2, 0.1)]
    maxima = [deviation.maximum for _, deviation in found]
    assert maxima == sorted(maxima, reverse=True)
    assert_allclose(
        [surface.poles.size for surface, _ in found], sorted(s.poles.size for s, _ in found)
    )
    eta, angles = smoothness.creases(blade)
    for surface, _ in found:
        for at, angle in zip(eta, angles, strict=True):
            if angle > 2.0 * creases.SHARP:
                assert turned(surface, at).max() == pytest.approx(angle, rel=0.1)


@pytest.mark.parametrize("tolerance", [3e-4, 5e-5])
def test_a_jump_is_not_followed_by_sections_without_end(tolerance):
    surface, measured = fitted(Tube(jump=0.05), tolerance)
    assert len(surface.v) < 100
    assert np.diff(surface.v).min() > 0.99 * creases.TEAR
    across = np.diff(surface.v[np.abs(surface.v - PLACE) < 1e-4])
    assert_allclose(across, 2.0 * creases.TEAR, rtol=1e-3)  # a wall, and as thick as it is ...
    assert (measured.maximum > tolerance) == (tolerance < 1e-4)  # ... so far off
    assert measured.eta == pytest.approx(PLACE, abs=1e-4)


def test_a_finer_tolerance_takes_more_sections_and_gives_less_deviation():
    blade = Blade.from_definition(read("nrel5mw"), landmarks=201)
    coarse, fine = (fitting.fitted(blade, tolerance) for tolerance in (5e-3, 1e-3))
    assert len(coarse[0].v) < len(fine[0].v)
    assert coarse[1].maximum > fine[1].maximum
    fixed, _ = fitting.fitted(blade, 1e-3, sections=50)
    assert len(fixed.v) == 50


def along(name, path):
    """A case; one blade's of either path is quick."""
    slow = (name, path) not in (("dtu10mw", "geodesic"), ("iea15mw", "spline"))
    return pytest.param(name, path, marks=[pytest.mark.nightly] * slow)


@pytest.mark.parametrize(
    ("name", "path"), [along(n, p) for n in bundled() for p in ("geodesic", "spline")]
)
def test_hundredths_of_a_millimetre_are_reached(name, path):
    blade = Blade.from_definition(read(name), path=path)
    surface, measured = fitted(blade, 5e-5)
    assert measured.maximum <= 5e-5
    spans = np.linspace(0.013, 0.987, 23)  # seen by nobody before
    u = np.sort(np.concatenate([[0.0, 1.0], blade.u[3::7], 1 - blade.u[3::7]]))
    assert np.abs(surface.offsets(blade.sections(spans, u), u, spans)).max() <= 5e-5


@pytest.mark.parametrize("name", bundled())
def test_a_coarse_tolerance_needs_few_poles(name):
    blade = Blade.from_definition(read(name))
    surface, measured = fitted(blade, 1e-3)
    assert measured.maximum <= 1e-3
    assert surface.poles.size / 3 < 19_000  # 2 MB of STEP


def test_noise_between_landmarks_is_followed_where_it_must_be():
    blade = Blade.from_definition(read("nrel5mw"), path="spline", fairing=None)
    surface, measured = fitted(blade, 5e-5)
    assert measured.maximum <= 5e-5
    assert len(surface.u) > len(blade.u)
    assert_allclose(surface.u + surface.u[::-1], 1.0, atol=1e-15)
