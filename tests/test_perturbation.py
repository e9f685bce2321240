from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.blade.changes.deformation import AffineChange
from bladegen.blade.soundness import SOUND_SPANS
from bladegen.curves.crossing import crossing_sections
from bladegen.errors import PerturbationError
from bladegen.shapes import affine, grassmann
from strategies import definitions, few

SPACE = bg.ShapeSpace.bundled()
T = np.array([0.05, -0.04, 0.03, 0.02])
SPANS = np.linspace(0, 1, 31)
NAMES = pytest.mark.parametrize("name", bg.bundled())
SMALL = st.lists(st.floats(-0.3, 0.3), min_size=4, max_size=4)


@pytest.fixture(scope="module")
def blades():
    return {name: bg.Blade.from_definition(bg.read(name)) for name in bg.bundled()}


@NAMES
def test_by_coordinates_alone_chord_twist_and_thickness_stay(blades, name):
    blade = blades[name]
    variant = blade.perturbed(SPACE, T)
    assert_allclose(variant.chord(SPANS), blade.chord(SPANS), atol=0)
    assert_allclose(variant.twist(SPANS), blade.twist(SPANS), atol=0)
    assert_allclose(variant.relative_thickness(SPANS), blade.relative_thickness(SPANS), atol=1e-9)
    curves = variant.splines.fit(variant.profiles(SPANS))
    assert_allclose(curves.chord, 1.0, atol=1e-9)
    assert_allclose(variant.M, blade.M, atol=0)
    assert np.abs(variant.profiles(SPANS) - blade.profiles(SPANS)).max() > 5e-3


@NAMES
def test_the_tangent_is_carried_to_every_station(blades, name):
    blade = blades[name]
    variant = blade.perturbed(SPACE, T, window=bg.Window(), allow_odd=True)
    steps = grassmann.log(blade.points, variant.points)
    carried = SPACE.carried(np.broadcast_to(T, (len(blade.eta), 4)), blade.points)
    assert_allclose(steps, carried, atol=1e-9)
    assert_allclose(grassmann.norm(steps), np.linalg.norm(T), atol=1e-9)
    back = np.stack(
        [grassmann.transport(v, X, SPACE.mean) for v, X in zip(steps, blade.points, strict=True)]
    )
    coordinates = np.tensordot(back, SPACE.modes, axes=([1, 2], [1, 2]))
    assert_allclose(coordinates, np.broadcast_to(T, coordinates.shape), atol=1e-9)


@NAMES
def test_round_roots_stay_round(blades, name):
    blade = blades[name]
    variant = blade.perturbed(SPACE, T, thickness=1.1, chord=1.05)
    root = np.linspace(0, blade.eta[1], 7)
    assert_allclose(variant.profiles(root), blade.profiles(root), atol=1e-12)
    assert_allclose(variant.chord(root), blade.chord(root), atol=1e-12)


@NAMES
def test_zero_changes_nothing(blades, name):
    blade = blades[name]
    same = blade.perturbed(SPACE, np.zeros(4))
    assert_allclose(same.sections(SPANS), blade.sections(SPANS), atol=1e-12)


def test_representatives_do_not_matter(blades):
    blade = blades["nrel5mw"]
    angle = np.linspace(-3, 3, len(blade.eta))
    turns = affine.twist(angle)
    turned = replace(blade, representatives=blade.representatives @ turns, M=turns.mT @ blade.M)
    assert_allclose(
        turned.perturbed(SPACE, T).profiles(SPANS),
        blade.perturbed(SPACE, T).profiles(SPANS),
        atol=1e-9,
    )


def test_a_dent_stays_where_it_is_put(blades):
    blade = blades["iea15mw"]
    dent = bg.Coordinates([0.5, 0.6, 0.7], [[0, 0, 0, 0], T, [0, 0, 0, 0]])
    variant = blade.perturbed(SPACE, dent)
    moved = np.abs(variant.profiles(SPANS) - blade.profiles(SPANS)).max(axis=(1, 2))
    assert np.all(moved[(SPANS <= 0.5) | (SPANS >= 0.7)] < 1e-10)
    assert moved[np.abs(SPANS - 0.6) < 0.02].min() > 1e-3


def test_without_a_distribution_the_thickness_stays_too(blades):
    definition = replace(blades["nrel5mw"].definition, relative_thickness=None)
    blade = bg.Blade.from_definition(definition)
    variant = blade.perturbed(SPACE, T)
    assert_allclose(variant.relative_thickness(SPANS), blade.relative_thickness(SPANS), atol=1e-9)
    thicker = blade.perturbed(thickness=1.1)
    assert_allclose(
        thicker.relative_thickness([0.3, 1.0]),
        1.1 * blade.relative_thickness([0.3, 1.0]),
        atol=1e-9,
    )


@settings(max_examples=few(10))
@given(definitions(), st.floats(0.9, 1.1), st.floats(0.9, 1.1), st.floats(0.9, 1.1))
def test_affine_parameters_do_what_their_maps_do(definition, thickness, camber, chord):
    blade = bg.Blade.from_definition(definition, landmarks=101)
    variant = blade.perturbed(thickness=thickness, camber=camber, chord=chord, window=bg.Window())
    maps = affine.thickness(np.array(thickness)) @ affine.chord(np.array(chord))
    maps = maps @ affine.camber(np.array(camber / 2))
    width, height = np.diag(maps)
    assert_allclose(variant.chord(SPANS), width * blade.chord(SPANS), rtol=1e-12)
    ratio = variant.relative_thickness(SPANS) / blade.relative_thickness(SPANS)
    assert_allclose(ratio, height / width, rtol=1e-8)
    shapes = [affine.standardise(b.profiles(SPANS))[0] for b in (variant, blade)]
    assert np.max(grassmann.distance(*shapes)) < 1e-7


@given(st.floats(-0.2, 0.2), st.floats(0.5, 1.5), st.floats(0.5, 1.5), st.floats(0.5, 1.5))
@settings(max_examples=few(10))
def test_twist_and_scalings_act_on_the_distributions(twist, chords, twists, bend):
    blade = bg.Blade.from_definition(bg.read("iea15mw"), landmarks=51)
    variant = blade.perturbed(
        twist=twist, chord_scale=chords, twist_scale=twists, prebend_scale=bend, window=bg.Window()
    )
    eta = blade.definition.twist.grid
    assert_allclose(variant.twist(eta), twists * blade.twist(eta) + twist, atol=1e-12)
    assert_allclose(variant.chord(SPANS), chords * blade.chord(SPANS), rtol=1e-9)
    assert_allclose(variant.axis(SPANS)[:, 0], bend * blade.axis(SPANS)[:, 0], atol=1e-12)
    offset = variant.definition.offset_y(SPANS) / blade.definition.offset_y(SPANS)
    assert_allclose(offset, chords, rtol=1e-9)


def test_a_perturbed_blade_is_a_blade_like_any_other(blades, tmp_path):
    from bladegen.cad import solids
    from bladegen.measures import checks

    variant = blades["nrel5mw"].perturbed(SPACE, T, thickness=1.05, name="variant")
    assert variant.name == "variant"
    assert variant.changes[0]["thickness"] == 1.05
    assert variant.changes[0]["pga"] == [T.tolist()]
    check = checks.check_blade(variant)
    assert check.problems == ()
    assert check.figures["thickness_error"] < 1e-9
    assert check.figures["stations_missed_by_chord"] < 1e-9
    solid = solids.solid(variant, tolerance=2e-3)
    assert solid.deviation.maximum < 2e-3
    again = variant.perturbed(twist_scale=1.1)
    assert len(again.changes) == 2
    assert_allclose(again.profiles(SPANS), variant.profiles(SPANS), atol=1e-12)


def test_the_baseline_is_left_untouched(blades):
    blade = blades["nrel5mw"]
    before = blade.sections(SPANS)
    blade.perturbed(SPACE, T, thickness=1.2, twist=0.1)
    assert np.array_equal(blade.sections(SPANS), before)


def test_bounds_are_kept_unless_extrapolation_is_asked_for(blades):
    blade = blades["nrel5mw"]
    beyond = [SPACE.upper[0] + 0.02, 0, 0, 0]
    with pytest.raises(PerturbationError, match=r"t1 = .*, allowed is .*extrapolation"):
        blade.perturbed(SPACE, beyond)
    taken = blade.perturbed(SPACE, beyond, allow_extrapolation=True, allow_odd=True)
    found = {finding.where for finding in taken.findings}
    assert "beyond the space's data" in found


def test_it_is_where_sections_arrive_that_data_must_reach(blades):
    blade = blades["nrel5mw"]  # whose outer sections lie at t1 = 0.18
    with pytest.raises(
        PerturbationError,
        match=r"eta = .* itself at t1 = 0.\d*, arrives at t1 = 0.2.*to 0.2426.*--allow-extra",
    ):
        blade.perturbed(SPACE, [0.15, 0.0, 0.0, 0.0])
    end = np.array([-0.16, 0.0, 0.0, 0.0])
    assert SPACE.outside(end)  # and yet no section leaves the data
    tip = bg.Coordinates([0.65, 0.7], [np.zeros(4), end])
    assert blade.perturbed(SPACE, tip, allow_odd=True).deformations


def test_odd_sections_are_refused_or_found(blades):
    blade, groove = blades["dtu10mw"], [-0.04, -0.13, 0.06, -0.01]
    asked = {"allow_extrapolation": True}
    with pytest.raises(
        PerturbationError, match=r"eta = 0\.\d+ \(near .* has a .*, at (most|least) .*--allow-odd"
    ):
        blade.perturbed(SPACE, groove, **asked)
    taken = blade.perturbed(SPACE, groove, allow_odd=True, **asked)
    said = [str(finding) for finding in taken.findings]
    assert any("has a concave nose: its contour turns back by" in one for one in said)
    assert not blade.perturbed(thickness=1.3, camber=0.9, chord=1.2).findings[len(blade.findings) :]


def test_sections_that_cross_are_named_with_station_and_parameter(blades):
    with pytest.raises(PerturbationError, match=r"eta = 0\.\d+ \(near .* at .*\) .* with pga = "):
        blades["nrel5mw"].perturbed(SPACE, [1.2, 0.9, 0.5, 0.7], allow_extrapolation=True)


@pytest.mark.parametrize(
    ("name", "t", "thickness", "camber", "where"),
    [
        ("dtu10mw", [-0.15767, -0.1549, -0.02098, -0.04444], 1.035, 0.9987, (0.172, 0.184)),
        ("iea15mw", [-0.09564, -0.17211, -0.00873, -0.04306], 1.128, 0.9751, (0.125, 0.132)),
    ],
)
def test_noses_that_curl_up_between_the_spans_first_tested_are_found(
    name, t, thickness, camber, where
):
    change = AffineChange(thickness=thickness, camber=camber)
    blade = bg.Blade.from_definition(bg.read(name), path="geodesic")
    variant = blade.untested(SPACE, t, change, allow_extrapolation=True)
    first = np.union1d(np.linspace(0.0, 1.0, SOUND_SPANS), variant.eta)
    assert not crossing_sections(variant.profiles(first))
    assert crossing_sections(variant.profiles(np.linspace(*where, 20)))
    with pytest.raises(PerturbationError, match=r"eta = 0\.1\d+ .* crosses itself with "):
        variant.require_sound(allow_odd=True)


def test_a_blade_as_it_is_defined_is_sound(blades):
    for blade in blades.values():
        assert blade.require_sound() is blade


def test_deformations_that_eat_the_thickness_are_named(blades, monkeypatch):
    monkeypatch.setattr("bladegen.blade.soundness.LOST_THICKNESS", 1.5)
    monkeypatch.setattr("bladegen.blade.soundness.crossing_sections", lambda _: [])
    with pytest.raises(PerturbationError, match="loses its thickness with pga"):
        blades["nrel5mw"].perturbed(
            SPACE, -np.array([0.1, 0.1, 0.0, 0.0]), allow_extrapolation=True
        )


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"thickness": 0.0}, "thickness: got 0, allowed is 0.2 to 5"),
        ({"camber": 2.0}, "camber: got 2, allowed is 0.2 to 1.8"),
        ({"chord": -1.0}, "chord: got -1"),
        ({"twist": 2.0}, "twist: got 2"),
        ({"prebend_scale": float("nan")}, "prebend_scale: got nan"),
        ({"t": [0.1]}, "coordinates need a shape space"),
        ({"space": SPACE, "t": [0.1]}, "got 1 coordinates"),
    ],
)
def test_wrong_values_are_refused(blades, options, message):
    with pytest.raises(bg.BladegenError, match=message):
        blades["nrel5mw"].perturbed(**options)


def test_windows():
    window = bg.Window(0.2, 0.4)
    assert_allclose(window(np.array([0.0, 0.2, 0.3, 0.4, 1.0])), [0, 0, 0.5, 1, 1])
    assert_allclose(bg.Window()(SPANS), 1.0)
    assert_allclose(bg.Window(0.5, 0.5)(np.array([0.4, 0.6])), [0, 1])
    stations = bg.read("iea15mw").stations
    assert bg.Window.beyond_circles(stations) == bg.Window(0.02, 0.15)
    assert bg.Window.beyond_circles(stations[2:]) == bg.Window()
    assert bg.Window.beyond_circles(stations[:2]) == bg.Window(0.0, 0.02)
    for start, end in ((0.5, 0.4), (-0.1, 0.2), (0.5, 1.1)):
        with pytest.raises(PerturbationError, match=r"must rise within 0 \(root\) to 1"):
            bg.Window(start, end)


@pytest.mark.parametrize(
    ("grid", "values"),
    [([0.5, 0.4], [[0.0], [0.0]]), ([0.0, 2.0], [[0.0], [0.0]]), ([0.0], [[0.0], [1.0]]), ([], [])],
)
def test_wrong_coordinates_over_span_are_refused(grid, values):
    with pytest.raises(PerturbationError, match="coordinates over span"):
        bg.Coordinates(grid, values)


def test_identity_parameters_are_not_reported():
    assert AffineChange().changed() == {}
    assert AffineChange(thickness=1.1).changed() == {"thickness": 1.1}


def test_a_lower_nose_that_a_stretch_makes_the_farthest_is_seen():
    blade = bg.Blade.from_definition(bg.read("dtu10mw"))
    t = [-0.0625985557, -0.0989607698, 0.0078348874, -0.0640664086]
    eta = np.linspace(0.19, 0.4, 43)
    variant = blade.untested(SPACE, t, AffineChange())
    assert_allclose(variant.splines.fit(variant.profiles(eta)).chord, 1.0, atol=1e-9)


@NAMES
def test_chord_line_and_nose_stay_under_a_change_of_shape(blades, name):
    blade, spans = blades[name], np.linspace(0.2, 0.98, 27)
    before = blade.splines.fit(blade.profiles(spans))
    kept = blade.perturbed(SPACE, T)
    after = kept.splines.fit(kept.profiles(spans))
    assert_allclose(after.leading_edge, before.leading_edge, rtol=0, atol=1e-12)
    assert_allclose(after.trailing_edge, before.trailing_edge, rtol=0, atol=1e-12)
    paper = blade.perturbed(SPACE, T, chord_line="paper")
    raw = paper.splines.fit(paper.profiles(spans))
    assert np.abs(raw.leading_edge - before.leading_edge).max() > 5e-3
    assert_allclose(kept.points, paper.points, atol=0)  # no point of the Grassmannian moves
    assert paper.changes[-1]["chord_line"] == "paper"
    moved = affine.standardise(kept.profiles(spans))[0]
    assert grassmann.distance(moved, affine.standardise(paper.profiles(spans))[0]).max() < 1e-7


def test_each_change_keeps_the_chord_line_of_the_blade_that_it_changes(blades):
    first = blades["dtu10mw"].perturbed(SPACE, T, chord_line="paper")
    before = first.splines.fit(first.profiles(SPANS))
    kept = first.untested(SPACE, np.negative(T), AffineChange())
    after = kept.splines.fit(kept.profiles(SPANS))
    assert_allclose(after.leading_edge, before.leading_edge, rtol=0, atol=1e-12)
    assert_allclose(after.trailing_edge, before.trailing_edge, rtol=0, atol=1e-12)


def test_a_convention_that_is_none_is_refused(blades):
    with pytest.raises(PerturbationError, match="chord_line: got 'raw', allowed are kept"):
        blades["nrel5mw"].perturbed(SPACE, T, chord_line="raw")


@pytest.mark.parametrize("each", [False, True])
@given(t=SMALL.filter(lambda t: max(map(abs, t)) > 0.05), share=st.floats(0.001, 0.006))
@settings(max_examples=few(4))
def test_coordinates_move_the_skin_by_what_is_stated(blades, each, t, share):
    """Equal |t| moves a root by several times what it moves a tip."""
    blade = blades["nrel5mw"]
    found = bg.Coordinates.displacing(blade, SPACE, t, share, each=each)
    variant = blade.untested(SPACE, found, AffineChange(), allow_extrapolation=True)
    eta = blade.stations(41)
    eta = eta[bg.Window.beyond_circles(blade.definition.stations)(eta) >= 1.0]
    before, after = blade.profiles(eta), variant.profiles(eta)
    along = before[:, 2:] - before[:, :-2]
    normal = np.stack([-along[..., 1], along[..., 0]], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    away = np.abs(np.sum((after - before)[:, 1:-1] * normal, axis=-1)).max(axis=1)
    assert_allclose(away if each else away.max(), share, rtol=0.05)  # normals by other differences
    assert np.all(away < 1.05 * share)
    flat = found.values @ np.asarray(t) / np.linalg.norm(t) / np.linalg.norm(found.values, axis=1)
    assert_allclose(flat, 1.0, atol=1e-12)  # the direction that was given
    larger = bg.Coordinates.displacing(blade, SPACE, np.multiply(t, 7.0), share, each=each)
    assert_allclose(larger.values, found.values, rtol=1e-3, atol=1e-12)


def test_displacements_that_cannot_be_are_refused(blades):
    blade = blades["nrel5mw"]
    for t, share, said in (
        ([1, 0, 0, 0], 0.0, "displacement: got 0, must be above 0"),
        ([0, 0, 0, 0], 0.01, "t: moves the section at .* by nothing"),
        ([1, 0, 0, 0], 3.0, "displacement: got 3, which no multiple of t reaches; give less"),
    ):
        with pytest.raises(PerturbationError, match=said):
            bg.Coordinates.displacing(blade, SPACE, t, share)
