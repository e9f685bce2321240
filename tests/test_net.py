from dataclasses import dataclass, field

import numpy as np
import pytest
from hypothesis import given, settings
from numpy.testing import assert_allclose

from bladegen.airfoils.landmarks import landmark_parameters, landmarks
from bladegen.blade.blade import Blade
from bladegen.formats.bundled import bundled
from bladegen.formats.reading import read
from bladegen.surface import fitting, net
from bladegen.surface.fitting import fitted
from strategies import SEEDS, definitions, ellipse, few

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
    fitted = net.fit(sections, U, V)
    assert_allclose(fitted.evaluate(U, V), sections, atol=1e-12)


@given(SEEDS)
def test_halves_are_the_whole(seed):
    sections = cone(0.5) + 0.01 * np.random.default_rng(seed).normal(size=(7, 1, 3))
    whole = net.fit(sections, U, V)
    for half, u in zip(
        whole.halves(), (np.linspace(0, 0.5, 9), np.linspace(0.5, 1, 9)), strict=True
    ):
        assert_allclose(half.evaluate(u, V), whole.evaluate(u, V), atol=1e-12)
        assert len(half.u_knots) == len(half.poles) + 4
    suction, pressure = whole.halves()
    assert_allclose(suction.poles[-1], pressure.poles[0], atol=1e-14)


@pytest.mark.parametrize("top", [1.0, 0.5])
def test_volume_of_an_elliptic_cone(top):
    fitted = net.fit(cone(top), U, V)
    wanted = np.pi * 0.5 * 0.25 * 10 * (1 + top + top**2) / 3
    assert_allclose(fitted.volume(), wanted, rtol=1e-5)


def test_offsets_are_distances_along_the_normal():
    fitted = net.fit(cone(1.0), U, V)
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
    assert len(fitted.v) <= fitting.MAX_SECTIONS
    assert said
    assert set(blade.eta) <= set(fitted.v)


@dataclass
class Tube:
    """A blade of circular sections, 2 m thick, that says which spans it is asked for."""

    jump: float = 0.0  # m, of the radius at eta = 0.4137
    asked: list = field(default_factory=list)
    u = U
    sides = ("suction side", "pressure side")

    def stations(self, count):
        return np.linspace(0.0, 1.0, count)

    def sections(self, eta, u=None):
        self.asked += np.ravel(eta).tolist()
        angle = 2.0 * np.pi * (self.u if u is None else u)
        z = 20.0 * np.asarray(eta)[:, None] + 0.0 * angle
        radius = 1.0 + 0.3 * np.sin(0.5 * z) + self.jump * (z > 20.0 * 0.4137)
        return np.stack([radius * np.sin(angle), radius * np.cos(angle), z], axis=-1)


def test_sections_are_made_once_while_others_are_added():
    tube, said, first = Tube(), [], np.linspace(0.0, 1.0, 12)
    surface, _ = fitted(tube, 1e-5, spans=first, progress=said.append)
    assert len(said) > 2
    added = np.setdiff1d(surface.v, first)
    middles = 0.5 * (surface.v[1:] + surface.v[:-1])
    assert {tube.asked.count(v) for v in (*added, *middles)} == {1}
    found = surface.evaluate(surface.u, surface.v)
    assert_allclose(found, tube.sections(surface.v, surface.u), rtol=0, atol=1e-12)


def test_a_jump_is_not_followed_by_sections_without_end():
    surface, measured = fitted(Tube(jump=0.05), 3e-4)
    assert len(surface.v) < 200
    assert np.diff(surface.v).min() > 0.49 * fitting.SHORTEST
    assert measured.maximum > 3e-4
    assert measured.eta == pytest.approx(0.4137, abs=1e-4)


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
    surface, _ = fitted(blade, 5e-5)
    assert len(surface.u) > len(blade.u)
    assert_allclose(surface.u + surface.u[::-1], 1.0, atol=1e-15)
