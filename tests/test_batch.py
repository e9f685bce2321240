from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import bladegen as bg
from bladegen import affine
from bladegen.batch import FAULTS, LOST_THICKNESS, SectionBatch
from bladegen.crossing import crossing_sections
from bladegen.deformation import AffineChange, Window
from bladegen.sections import SectionSplines

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
        single = {key: float(value[i]) for key, value in vars(change).items()}
        variant = made.blade.untested(space(), t[i], AffineChange(**single))
        assert_allclose(result.sections[i], variant.sections(SPANS), rtol=0, atol=2e-9)
        assert_allclose(result.chord[i], variant.chord(SPANS), rtol=0, atol=1e-12)
        assert_allclose(result.twist[i], variant.twist(SPANS), rtol=0, atol=1e-12)
        assert_allclose(
            result.relative_thickness[i], variant.wanted_thickness(SPANS), rtol=0, atol=1e-12
        )


@pytest.mark.parametrize("name", BLADES)
def test_quick_measures_agree_with_those_on_splines(name):
    made = batch_of(name)
    raw = made.coefficients(drawn(2, 12, 0.8))
    features = made.features
    measures = features.measure(raw)
    sections = np.moveaxis(features.points(raw), 0, 1)
    assert_allclose(sections, (features.values.mT[:, None] @ raw), rtol=0, atol=1e-13)
    curves = SectionSplines(made.blade.u).fit(sections.reshape(-1, *sections.shape[2:]))
    sure = ~measures.unsure.reshape(-1)
    assert sure.mean() > 0.9
    assert_allclose(measures.chord.reshape(-1)[sure], curves.chord[sure], rtol=0, atol=1e-13)
    assert_allclose(measures.thickness.reshape(-1)[sure], curves.thickness[sure], rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", BLADES)
def test_faults_are_those_of_an_exact_test(name):
    made = batch_of(name)
    raw = made.coefficients(drawn(4, 24, 1.0))
    sections = np.moveaxis(made.features.points(raw), 0, 1)
    k, b = raw.shape[:2]
    flat = sections.reshape(-1, *sections.shape[2:])
    crossing = np.zeros(k * b, dtype=bool)
    crossing[crossing_sections(flat)] = True
    faults, _ = made.faults(drawn(4, 24, 1.0), AffineChange())
    assert_array_equal((FAULTS.index("crosses itself") == faults.T).reshape(-1), crossing)
    proved = made.features.proved_sound(raw).reshape(-1)
    assert not np.any(proved & crossing)
    assert proved.mean() > 0.4


def test_a_section_that_loses_its_thickness_is_found():
    made = batch_of("dtu10mw")
    faults, _ = made.faults(np.zeros((1, 4)), AffineChange())
    assert not faults.any()
    thin = SectionBatch(made.blade, space(), made.window, SPANS)
    thin.__dict__["before"] = made.before / LOST_THICKNESS * 1.01
    faults, _ = thin.faults(np.zeros((1, 4)), AffineChange())
    assert {FAULTS[i] for i in np.unique(faults)} == {"loses its thickness"}


def test_a_batch_equals_its_parts_and_may_be_single_precision():
    made, t = batch_of("nrel5mw"), drawn(5, 20, 0.5)
    change = AffineChange(thickness=np.linspace(0.9, 1.1, 20))
    whole = made.evaluate(t, change)
    part = made.evaluate(t[7:9], AffineChange(thickness=change.thickness[7:9]))
    assert_allclose(whole.sections[7:9], part.sections, rtol=0, atol=1e-10)
    small = made.evaluate(t, change, dtype=np.float32)
    assert small.sections.dtype == np.float32
    assert_allclose(small.sections, whole.sections, rtol=0, atol=1e-5)


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
