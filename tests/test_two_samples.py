"""Tests of two sets of coordinates: laws of the statistics, level and power of the test."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.stats import energy_distance

import bladegen as bg
from bladegen.errors import SpaceError
from bladegen.shapes.statistics.two_samples import KERNELS, MOST

SEEDS = st.integers(0, 2**31)


def drawn(seed, count=40, r=3, shift=0.0):
    return np.random.default_rng(seed).normal(size=(count, r)) + shift


@given(SEEDS, st.floats(-1.0, 1.0), st.integers(5, 60))
def test_on_one_coordinate_it_is_scipys_energy_distance(seed, shift, count):
    one, other = drawn(seed, r=1), drawn(seed + 1, count, 1, shift)
    found = bg.two_samples(one, other, shuffles=1)
    spread = np.concatenate([one, other]).std()
    expected = energy_distance(one[:, 0] / spread, other[:, 0] / spread) ** 2
    assert_allclose(found.statistic, expected, atol=1e-12)


@pytest.mark.parametrize("kind", KERNELS)
@given(SEEDS)
def test_order_units_and_origin_do_not_matter(kind, seed):
    one, other = drawn(seed), drawn(seed + 1, 25, shift=0.3)
    plain = bg.two_samples(one, other, kind=kind, shuffles=19).statistic
    scale, origin = np.array([1.0, 57.3, 1e-3]), np.array([0.0, -5.0, 2.0])
    found = [
        bg.two_samples(other, one, kind=kind, shuffles=1).statistic,
        bg.two_samples(one[::-1], other, kind=kind, shuffles=1).statistic,
        bg.two_samples(
            one * scale + origin, other * scale + origin, kind=kind, shuffles=1
        ).statistic,
    ]
    assert_allclose(found, plain, rtol=1e-9)
    assert plain > 0.0
    assert_allclose(bg.two_samples(one, one, kind=kind, shuffles=1).statistic, 0.0, atol=1e-12)


@pytest.mark.parametrize("kind", KERNELS)
def test_one_in_twenty_of_like_sets_is_called_different(kind):
    """Of 200 pairs drawn alike, 10 are expected below 0.05: 22 or more come once in 2,000 times."""
    values = [
        bg.two_samples(drawn(2 * k), drawn(2 * k + 1), kind=kind, shuffles=99).p_value
        for k in range(200)
    ]
    assert 1 <= sum(value <= 0.05 for value in values) <= 22
    assert 0.4 < np.mean(values) < 0.6


@pytest.mark.parametrize("kind", KERNELS)
def test_sets_that_differ_in_place_or_in_how_they_hang_together_are_told_apart(kind):
    moved = bg.two_samples(drawn(1, 200), drawn(2, 200, shift=[0.5, 0, 0]), kind=kind)
    assert moved.p_value == pytest.approx(0.001)
    assert not moved.alike
    assert np.argmin(moved.each) == 0
    turned = drawn(4, 400) @ np.linalg.cholesky([[1, 0.8, 0], [0.8, 1, 0], [0, 0, 1]]).T
    hung = bg.two_samples(drawn(3, 400), turned, kind=kind)
    assert hung.p_value < 0.01  # each coordinate alone is distributed as before
    assert min(hung.each) > 0.01


def test_families_and_spaces_are_taken_as_they_are_and_large_sets_by_draws():
    space = bg.ShapeSpace.bundled()
    found = bg.two_samples(space, space, shuffles=9)
    assert found.counts == (MOST, MOST)
    assert found.alike
    assert "drawn alike" in repr(found)
    same = bg.two_samples(space, space, shuffles=9)
    assert (same.statistic, same.p_value) == (found.statistic, found.p_value)


def test_sets_that_cannot_be_compared_say_so():
    for one, other, how, said in (
        (drawn(1), drawn(1, r=2), {}, "other: got 2 columns, must be 3"),
        (drawn(1), drawn(1, 1), {}, r"other: got the shape \(1, 3\), must be \(samples, coord"),
        (drawn(1), np.full((3, 3), np.nan), {}, "finite numbers, such as family.parameters"),
        (drawn(1), drawn(2), {"kind": "t"}, "kind: got 't', allowed are energy, mmd"),
        (drawn(1), drawn(2), {"shuffles": 0}, "shuffles: got 0, must be at least 1"),
    ):
        with pytest.raises(SpaceError, match=said):
            bg.two_samples(one, other, **how)
