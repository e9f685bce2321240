import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.stats import kstest

import bladegen as bg
from bladegen.designs import DESIGNS, Design, Factors, factors, tabulated
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
