from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import bladegen as bg
from bladegen.blade.changes.deformation import RANGES, AffineChange, Window
from bladegen.blade.edges import AsGiven, MinimumThickness, Sharp
from bladegen.blade.soundness import Trial
from bladegen.blade.variants.batch import FAULTS, LOST_THICKNESS, SectionBatch
from bladegen.curves import polygons
from bladegen.curves.crossing import crossing_sections
from bladegen.errors import GeometryError
from bladegen.shapes import affine

BLADES = ("iea15mw", "nrel5mw", "dtu10mw")
SPANS = np.linspace(0.0, 1.0, 37)


@cache
def space():
    return bg.ShapeSpace.bundled()


@cache
def batch_of(name):
    blade = bg.Blade.from_definition(bg.read(name))
    window = Window.beyond_circles(blade.definition.stations)
    return SectionBatch(blade, space(), window, SPANS)


def drawn(seed, count, share):
    return share * space().sample(count, np.random.default_rng(seed))


@pytest.mark.parametrize("name", BLADES)
def test_a_batch_holds_the_sections_of_perturbed_blades(name):
    made, rng = batch_of(name), np.random.default_rng(3)
    t = drawn(1, 6, 0.4)
    change = AffineChange(
        thickness=rng.uniform(0.9, 1.1, 6),
        camber=rng.uniform(0.95, 1.05, 6),
        chord=rng.uniform(0.9, 1.1, 6),
        twist=rng.uniform(-0.1, 0.1, 6),
        chord_scale=rng.uniform(0.8, 1.2, 6),
        twist_scale=rng.uniform(0.5, 1.5, 6),
        prebend_scale=rng.uniform(0.0, 2.0, 6),
    )
    result = made.evaluate(t, change)
    for i in range(6):
        single = {key: float(getattr(change, key)[i]) for key in RANGES}
        variant = made.blade.untested(space(), t[i], AffineChange(**single))
        assert_allclose(result.sections[i], variant.sections(SPANS), rtol=0, atol=1e-9)
        assert_allclose(result.chord[i], variant.chord(SPANS), rtol=0, atol=1e-12)
        assert_allclose(result.twist[i], variant.twist(SPANS), rtol=0, atol=1e-12)
        assert_allclose(
            result.relative_thickness[i], variant.wanted_thickness(SPANS), rtol=0, atol=1e-12
        )


@pytest.mark.parametrize("name", BLADES)
def test_sections_with_two_noses_are_those_of_perturbed_blades(name):
    made, t = batch_of(name), drawn(2, 8, 1.0)
    sections = made.evaluate(t, AffineChange()).sections
    for i in range(len(t)):
        variant = made.blade.untested(space(), t[i], AffineChange(), allow_extrapolation=True)
        assert_allclose(sections[i], variant.sections(SPANS), rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("t", "thickness", "where"),
    [
        ([-0.0985, -0.1117, 0.0408, -0.0565], 1.15, (0.130, 0.134)),  # noses far apart
        ([-0.01983, -0.005, 0.02543, -0.0048], 1.0, (0.060, 0.064)),  # a front of many peaks
        ([-0.06377, 0.02464, 0.0097, 0.00055], 1.15, (0.113, 0.117)),
        ([-0.02939, -0.01393, 0.00735, -0.01409], 1.0, (0.0745, 0.0785)),  # three of them
        ([-0.02939, -0.01393, 0.00735, -0.01409], 0.85, (0.2173, 0.2213)),
    ],
)
def test_noses_that_pass_each_other_leave_no_step_and_are_followed_as_by_numpy(t, thickness, where):
    """They made steps of up to 300 mm, and missed chord and thickness by 2e-3."""
    blade = bg.Blade.from_definition(bg.read("iea15mw"), path="geodesic")
    spans = np.linspace(*where, 41)
    change = AffineChange(thickness=thickness, camber=1.029, chord=0.9345)
    variant = blade.untested(space(), np.array(t), change)
    profiles = variant.profiles(spans)
    curves = blade.splines.fit(profiles)
    assert curves.shares.any()
    assert_allclose(curves.chord, 1.0, rtol=0, atol=1e-12)
    assert_allclose(curves.relative_thickness, variant.wanted_thickness(spans), rtol=0, atol=3e-12)
    window = Window.beyond_circles(blade.definition.stations)
    result = SectionBatch(blade, space(), window, spans).evaluate(np.array([t]), change)
    assert_allclose(result.sections[0], variant.sections(spans), rtol=0, atol=1e-9)
    steps = np.abs(np.diff(profiles, axis=0)).max(axis=(1, 2))
    assert steps.max() < 2.0 * np.median(steps)


@pytest.mark.parametrize("name", BLADES)
def test_faults_are_those_of_an_exact_test(name):
    made = batch_of(name)
    raw = made.coefficients(drawn(4, 24, 1.0))
    sections = made.features.mT[:, None] @ raw
    k, b = raw.shape[:2]
    crossing = np.zeros(k * b, dtype=bool)
    crossing[crossing_sections(sections.reshape(-1, *sections.shape[2:]))] = True
    faults, _ = made.faults(drawn(4, 24, 1.0), AffineChange())
    assert_array_equal((FAULTS.index("crosses itself") == faults.T).reshape(-1), crossing)
    assert_array_equal(made.evaluate(drawn(4, 24, 1.0), AffineChange()).faults, faults)
    assert 0 < crossing.sum() < crossing.size


def test_a_section_that_loses_its_thickness_is_found():
    made = batch_of("dtu10mw")
    faults, _ = made.faults(np.zeros((1, 4)), AffineChange())
    assert not faults.any()
    thin = SectionBatch(made.blade, space(), made.window, SPANS)
    thin.__dict__["before"] = made.before / LOST_THICKNESS * 1.01
    faults, _ = thin.faults(np.zeros((1, 4)), AffineChange())
    assert {FAULTS[i] for i in np.unique(faults)} == {"loses its thickness"}


def test_a_batch_equals_its_parts_to_the_bit_and_may_be_single_precision():
    made, t = batch_of("nrel5mw"), drawn(5, 20, 0.9)
    scale = np.linspace(0.9, 1.1, 20)
    change = AffineChange(thickness=scale, twist=0.1 * scale, prebend_scale=np.round(scale))
    whole = made.evaluate(t, change, measured=True)
    for rows in ([7, 8], [19], [3, 0, 11]):
        own = {name: getattr(change, name)[rows] for name in ("thickness", "twist")}
        part = made.evaluate(
            t[rows],
            AffineChange(**own, prebend_scale=change.prebend_scale[rows]),
            measured=True,
        )
        for name, values in vars(part).items():
            assert_array_equal(values, getattr(whole, name)[rows], err_msg=name)
    small = made.evaluate(t, change, dtype=np.float32)
    assert small.sections.dtype == np.float32
    assert_array_equal(small.sections, whole.sections.astype(np.float32))


@pytest.mark.parametrize(
    "edge", [MinimumThickness(0.01), MinimumThickness(0.05, 0.01), AsGiven(), Sharp()]
)
def test_trailing_edges_are_finished_and_measured_as_the_blade_says(edge):
    blade = batch_of("dtu10mw").blade.with_trailing_edge(edge)
    made, t = SectionBatch(blade, space(), Window(), SPANS), drawn(6, 2, 0.3)
    result = made.evaluate(t, AffineChange(), measured=True)
    for i in range(2):
        variant = blade.untested(space(), t[i], AffineChange(), window=Window())
        assert_allclose(result.sections[i], variant.sections(SPANS), rtol=0, atol=1e-9)
        chord = variant.chord(SPANS)
        profiles = edge(variant.profiles(SPANS), chord) * chord[:, None, None]
        measures = polygons.measure(profiles)
        assert_allclose(result.measures[i], measures, rtol=1e-7, atol=1e-9)


def test_without_a_space_only_affine_changes_are_made():
    blade = batch_of("dtu10mw").blade
    made = SectionBatch(blade, None, Window(), SPANS)
    result = made.evaluate(np.zeros((2, 0)), AffineChange(chord=np.array([1.0, 1.2])))
    assert_allclose(result.sections[0], blade.sections(SPANS), rtol=0, atol=1e-9)
    assert_allclose(result.chord[1], 1.2 * blade.chord(SPANS), rtol=1e-14)


def test_a_perturbed_blade_can_be_the_baseline():
    blade = batch_of("iea15mw").blade.perturbed(space(), [0.02, 0.01, 0, 0], thickness=1.05)
    made = SectionBatch(blade, space(), Window(), SPANS)
    result = made.evaluate(np.zeros((1, 4)), AffineChange())
    assert_allclose(result.sections[0], blade.sections(SPANS), rtol=0, atol=1e-9)
    assert affine.restore(*blade.shapes(SPANS)[1:]).shape == (37, 401, 2)


def test_another_window_shares_what_it_does_not_touch():
    made, t = batch_of("nrel5mw"), drawn(4, 2, 0.3)
    change = AffineChange(thickness=1.1, twist=0.05, prebend_scale=0.5)
    before = made.evaluate(t, change)
    window = Window(0.3, 0.7)
    other = made.within(window)
    fresh = SectionBatch(made.blade, space(), window, SPANS)
    assert_array_equal(other.evaluate(t, change).sections, fresh.evaluate(t, change).sections)
    assert other.features is made.features
    assert_array_equal(made.evaluate(t, change).sections, before.sections)


@pytest.mark.parametrize("chord_line", ["kept", "paper"])
def test_a_batch_treats_chord_lines_as_perturbed_blades_do(chord_line):
    base = batch_of("dtu10mw").blade.untested(
        space(), [0.02, 0.01, 0.01, 0.0], AffineChange(), chord_line="paper"
    )
    base = base.untested(space(), [0.01, -0.01, 0.0, 0.0], AffineChange())
    t = drawn(9, 3, 0.6)
    made = SectionBatch(base, space(), Window(), SPANS, chord_line)
    sections = made.evaluate(t, AffineChange()).sections
    for i in range(len(t)):
        variant = base.untested(
            space(),
            t[i],
            AffineChange(),
            window=Window(),
            chord_line=chord_line,
            allow_extrapolation=True,
        )
        assert_allclose(sections[i], variant.sections(SPANS), rtol=0, atol=1e-9)


def test_edges_thicker_than_a_section_are_refused():
    blade = batch_of("dtu10mw").blade.with_trailing_edge(MinimumThickness(2.0))
    with pytest.raises(GeometryError, match="trailing edge: got 2000mm, more than the thickness"):
        SectionBatch(blade, space(), Window(), SPANS).evaluate(drawn(6, 2, 0.3), AffineChange())


@pytest.mark.parametrize("name", BLADES)
def test_looks_and_domain_are_those_of_perturbed_blades(name):
    made, t = batch_of(name), drawn(11, 4, 0.8)
    change = AffineChange(thickness=np.linspace(0.9, 1.1, 4))
    odd = made.oddities(made.evaluate(t, change).looks)
    again = made.oddities(made.tested(t, change)[2])
    assert_array_equal(odd.figures, again.figures)
    for i in range(4):
        one = AffineChange(thickness=float(change.thickness[i]))
        variant = made.blade.untested(space(), t[i], one, allow_extrapolation=True)
        if not made.tested(t, change)[0][i].any():
            trial = Trial(variant.shape, variant.definition, {})
            single = trial.tested(SPANS)[1]
            assert_allclose(
                odd.figures[i, :, [0, 1, 2, 5, 6]], single.figures.T[[0, 1, 2, 5, 6]], atol=1e-6
            )
            assert_array_equal(odd.kinds[i], single.kinds)
        left = made.domain.left(made.step(t[i : i + 1]))[0]
        deformation = variant.deformations[-1]
        assert bool(left.any()) == bool(made.domain.said(deformation.step(SPANS)))
    assert not made.oddities(made._looks_before).kinds.any()


def test_the_twist_of_a_batch_is_measured_on_its_sections():
    made, t = batch_of("dtu10mw"), drawn(13, 3, 0.4)
    kept = made.evaluate(t, AffineChange(), measured=True)
    assert_allclose(kept.twist, np.broadcast_to(made.blade.twist(SPANS), (3, 37)), atol=1e-3)
    paper = SectionBatch(made.blade, space(), made.window, SPANS, "paper")
    turned = paper.evaluate(t, AffineChange(), measured=True).twist
    assert np.degrees(np.abs(turned - made.blade.twist(SPANS)).max()) > 0.3
