import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.stats import kstest

import bladegen as bg
from bladegen.blade.variants.designs import DESIGNS, Design, tabulated
from bladegen.blade.variants.factors import Factors, factors
from bladegen.errors import DesignError

SPACE = bg.ShapeSpace.bundled()
WHAT = factors(SPACE, {"thickness": (0.9, 1.1), "twist": (-0.05, 0.05)})


@pytest.mark.parametrize("kind", DESIGNS)
def test_the_same_seed_gives_the_same_design(kind):
    one, two = (Design.of(WHAT, kind, 20, 7).values for _ in range(2))
    assert_array_equal(one, two)
    assert len(one) == 20


@pytest.mark.parametrize("kind", ["sobol", "box", "ellipsoid", "normal"])
@given(st.integers(1, 40), st.integers(0, 2**31))
def test_a_variant_does_not_depend_on_how_many_there_are(kind, count, seed):
    few, many = Design.of(WHAT, kind, count, seed), Design.of(WHAT, kind, count + 17, seed)
    assert_array_equal(few.values, many.values[:count])


@pytest.mark.parametrize("kind", ["sobol", "lhs", "box", "sweep"])
def test_boxes_are_kept_and_filled(kind):
    values = Design.of(WHAT, kind, 256, 1).values
    unit = (values - WHAT.low) / (WHAT.high - WHAT.low)
    assert unit.min() >= -1e-12
    assert unit.max() <= 1 + 1e-12
    assert_allclose(unit.mean(axis=0), 0.5, atol=0.06)


def test_a_latin_hypercube_has_one_point_in_every_slice():
    unit = (Design.of(WHAT, "lhs", 50, 3).values - WHAT.low) / (WHAT.high - WHAT.low)
    assert_array_equal(np.sort((unit * 50).astype(int), axis=0), np.arange(50)[:, None] + [0] * 6)


def test_the_ellipsoid_is_filled_uniformly():
    what = factors(SPACE)
    values = Design.of(what, "ellipsoid", 4000, 1).values
    radius = np.linalg.norm(values / what.spread, axis=1) / what.reach
    assert radius.max() <= 1
    assert kstest(radius**4, "uniform").pvalue > 1e-3
    assert kstest((values[:, 0] > 0).mean(axis=0, keepdims=True), "uniform").pvalue > 1e-3
    assert not any(what.outside(values))


def test_normal_draws_have_the_covariance_of_the_data():
    values = Design.of(factors(SPACE), "normal", 8000, 2).values
    spread = np.sqrt(SPACE.variances[:4])
    assert_allclose(np.cov(values.T) / np.outer(spread, spread), np.eye(4), atol=0.06)


def test_sweeps_run_from_corner_to_corner():
    what = factors(None, {"thickness": (0.9, 1.1), "chord": (0.8, 1.2)})
    values = Design.of(what, "sweep", 10, 0).values
    for line in (values[0::2], values[1::2]):
        corners = np.sort(np.stack([line[0], line[-1]]), axis=0)
        assert_allclose(corners, [[0.9, 0.8], [1.1, 1.2]])
        assert_allclose(np.diff(line, 2, axis=0), 0, atol=1e-12)
    assert not Design.of(what, "sweep", 10, 0).redraws


def test_redrawn_values_differ_and_depend_on_the_place_alone():
    design = Design.of(WHAT, "sobol", 16, 5)
    index = np.array([3, 9])
    assert_array_equal(design.redrawn(index, 1)[1], design.redrawn(index[1:], 1)[0])
    assert not np.allclose(design.redrawn(index, 1), design.redrawn(index, 2))
    assert not np.allclose(design.redrawn(index, 1), design.values[index])


def test_values_outside_are_named():
    values = np.stack([WHAT.low, WHAT.high, WHAT.high])
    values[1, 4] = 1.2
    values[2, :4] = 10.0
    said = WHAT.outside(values)
    assert said[0] == ""
    assert said[1].startswith("thickness = 1.2 is outside 0.9 to 1.1")
    assert said[2].startswith("t1 = 10 is outside")


def test_bounds_of_ones_own_replace_those_of_the_space():
    what = factors(SPACE, {"t2": (-0.01, 0.02)}, reach=0.5)
    assert what.names == ("t1", "t2", "t3", "t4")
    assert (what.low[1], what.high[1]) == (-0.01, 0.02)
    assert what.high[0] == 0.5 * SPACE.upper[0]
    values = Design.of(what, "ellipsoid", 500, 1).values
    assert values[:, 1].min() >= -0.01
    assert values[:, 1].max() <= 0.02


def test_split_returns_coordinates_and_affine_parameters():
    what = Factors(("t2", "chord"), np.zeros(2), np.ones(2), np.zeros(2))
    t, change = what.split(np.array([[0.1, 1.1], [0.2, 0.9]]), 4)
    assert_array_equal(t, [[0, 0.1, 0, 0], [0, 0.2, 0, 0]])
    assert_array_equal(change.chord, [1.1, 0.9])
    assert change.thickness == 1.0


def test_tables_are_taken_as_they_are():
    design = tabulated(SPACE, {"t1": [0.1, 0.2], "twist": [0.0, 0.1]})
    assert design.what.names == ("t1", "twist")
    assert_array_equal(design.values, [[0.1, 0.0], [0.2, 0.1]])
    assert not design.redraws


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Design.of(WHAT, "grid", 3, 0), "allowed are sobol"),
        (lambda: Design.of(WHAT, "box", 0, 0), "count: got 0"),
        (lambda: Design.of(WHAT, "box", 3, -1), "seed: got -1"),
        (lambda: factors(None), "nothing varies"),
        (lambda: factors(SPACE, {"t9": (0, 1)}), "factor 't9'"),
        (lambda: factors(SPACE, {"t1": (1, 0)}), "must not fall"),
        (lambda: factors(SPACE, {"chord": (0, 1)}), "allowed is 0.2 to 5"),
        (lambda: factors(SPACE, reach=0), "reach: got 0"),
        (lambda: tabulated(None, {"t1": [0]}), "got 't1'"),
        (lambda: tabulated(SPACE, {}), "no factor"),
        (lambda: tabulated(SPACE, {"t1": [0, np.nan]}), "row 2, t1"),
        (lambda: tabulated(SPACE, {"t1": []}), "no rows"),
        (lambda: tabulated(SPACE, {"chord": [1, 9]}), "row 2, chord: got 9"),
    ],
)
def test_what_cannot_be_planned_is_refused(make, said):
    with pytest.raises(DesignError, match=said):
        make()


@pytest.mark.parametrize("kind", DESIGNS)
def test_variants_are_drawn_one_by_one_as_they_are_all_at_once(kind):
    design = Design.of(WHAT, kind, 200, 5)
    index = np.array([7, 199, 0, 7, 64])
    assert_array_equal(design.at(index), design.values[index])
    assert design.at(np.arange(0)).shape == (0, len(WHAT.names))


def test_sobol_points_are_scipys_beyond_a_page():
    from scipy.stats import qmc

    from bladegen.blade.variants.draws import PAGE, sobol

    whole = qmc.Sobol(3, rng=np.random.default_rng(9)).random_base2(16)
    index = np.array([0, PAGE - 1, PAGE, 3 * PAGE + 5, 2**16 - 1])
    assert_array_equal(sobol(index, 2**16, 3, 9), whole[index])


@pytest.mark.parametrize("kind", [kind for kind in DESIGNS if kind != "lhs"])
def test_a_plan_of_millions_takes_no_memory(kind):
    import tracemalloc

    tracemalloc.start()
    design = Design.of(WHAT, kind, 5_000_000, 1)
    last = design.at(np.arange(4_999_936, 5_000_000))
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert len(last) == 64
    assert most < 5e6


def test_a_latin_hypercube_is_bounded_and_says_what_is_not():
    with pytest.raises(DesignError, match="allowed is 1 to 1000000; sobol takes any number"):
        Design.of(WHAT, "lhs", 5_000_000, 1)


def test_seeds_are_numpys():
    def first(seed):
        return Design.of(WHAT, "box", 3, seed).values

    assert_array_equal(first(7), first(np.int32(7)))
    rng = np.random.default_rng(3)
    one, two = Design.of(WHAT, "box", 3, rng), Design.of(WHAT, "box", 3, rng)
    assert one.seed != two.seed  # the generator has moved on
    assert_array_equal(one.values, first(one.seed))
    assert Design.of(WHAT, "box", 3, np.random.default_rng(3)).seed == one.seed
    assert Design.of(WHAT, "box", 3, np.random.SeedSequence(3)).seed == one.seed
    assert Design.of(WHAT, "box", 3, np.random.PCG64(3)).seed == one.seed
    assert first(2**100).shape == (3, len(WHAT.names))
    assert Design.of(WHAT, "box", 3, None).seed != Design.of(WHAT, "box", 3, None).seed
    for bad in (-1, 2.5, "7", True, [1], {}):
        with pytest.raises(DesignError, match="seed: got"):
            Design.of(WHAT, "box", 3, bad)


def test_bounds_that_are_none_are_refused():
    for bounds, said in (
        ({"thickness": 1}, r"thickness: got 1, must be two bounds, \(low, high\)"),
        ({"thickness": (1, 2, 3)}, "must be two bounds"),
        ({"thicknes": (1, 2)}, "did you mean thickness"),
        ({"twist": (-60, 60)}, r"-60 rad \(-3\.44e\+03 deg\)"),
        ([("thickness", (1, 2))], "bounds: got .* must be a mapping"),
        ({"t1": (np.nan, 1)}, "must not fall"),
    ):
        with pytest.raises(DesignError, match=said):
            factors(SPACE, bounds)
    with pytest.raises(DesignError, match="lists of one length, got t1: 2, chord: 1"):
        tabulated(SPACE, {"t1": [0.0, 0.1], "chord": [1.0]})
