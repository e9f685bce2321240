"""Splines along the chord and the span, held against SciPy's."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.interpolate import BSpline

from bladegen.surface.splines import Fit, Knots, basis, joined
from strategies import SEEDS

TIMES = st.lists(st.integers(1, 3), min_size=0, max_size=8)


def spline(times, seed):
    """Knots that stand so often, and a spline with them that has random poles."""
    rng = np.random.default_rng(seed)
    at = np.concatenate([[0.0], np.cumsum(rng.uniform(0.05, 1.0, len(times) + 1))])
    knots = Knots(at, np.array([1, *times, 1]))
    poles = rng.normal(size=(2, knots.poles, 3))
    return knots, poles, BSpline(knots.sequence, np.moveaxis(poles, 0, 1), 3)


@given(TIMES, SEEDS, st.integers(0, 2))
def test_bases_are_those_of_scipy(times, seed, nu):
    knots, _, _ = spline(times, seed)
    x = np.random.default_rng(seed).uniform(0.0, knots.at[-1], 40)
    x = np.concatenate([x, knots.at])
    wanted = BSpline(knots.sequence, np.eye(knots.poles), 3)(x, nu)
    found = basis(knots.sequence, x, nu).toarray()
    assert_allclose(found, wanted, rtol=0, atol=1e-9 * max(1.0, np.abs(wanted).max()))


@given(TIMES, SEEDS)
def test_values_and_slopes_at_knots_make_the_one_spline_that_has_them(times, seed):
    knots, poles, of = spline(times, seed)
    behind, ahead = knots.slopes
    left = np.nextafter(knots.at[ahead], -np.inf)
    given_ = (
        np.moveaxis(of(x, nu), 0, 1) for x, nu in ((knots.at, 0), (knots.at[behind], 1), (left, 1))
    )
    assert_allclose(joined(knots, *given_), poles, rtol=0, atol=1e-6)


@given(st.integers(0, 12), SEEDS)
def test_a_fit_gives_a_spline_s_points_their_spline(count, seed):
    knots, poles, of = spline([1] * count, seed)
    u = knots.inside(np.array([0.1, 0.4, 0.6, 0.9]))
    assert_allclose(Fit(knots, u)(np.moveaxis(of(u), 0, 1)), np.moveaxis(poles, 0, 1), atol=1e-8)


@given(st.integers(0, 12), SEEDS)
def test_a_fit_meets_both_ends_whatever_lies_between(count, seed):
    knots, _, _ = spline([1] * count, seed)
    u = knots.inside(np.array([0.1, 0.4, 0.6, 0.9]))
    points = np.random.default_rng(seed).normal(size=(3, len(u), 3))
    fitted = Fit(knots, u)(points)
    assert_allclose(fitted[[0, -1]], points[:, [0, -1]].swapaxes(0, 1), atol=1e-14)


@given(st.integers(0, 12), SEEDS)
def test_a_fit_meets_the_nose_and_is_the_closest_that_does(count, seed):
    rng = np.random.default_rng(seed)
    half = np.sort(rng.uniform(0.01, 0.49, count))
    knots = Knots.simple(np.concatenate([[0.0], half, [0.5], 1.0 - half[::-1], [1.0]]))
    u = np.union1d(knots.inside(np.array([0.1, 0.4, 0.6, 0.9])), [0.5])
    points, fit = rng.normal(size=(1, len(u), 3)), Fit(knots, u)
    poles = fit(points)[:, 0]
    pinned = fit.matrix[[0, np.flatnonzero(u == 0.5)[0], len(u) - 1]].toarray()
    assert_allclose(pinned @ poles, points[0, [0, np.flatnonzero(u == 0.5)[0], -1]], atol=1e-10)
    pull = fit.matrix.T @ (fit.matrix @ poles - points[0])  # balanced by what holds the three
    assert_allclose(pinned.T @ np.linalg.lstsq(pinned.T, pull, rcond=None)[0], pull, atol=1e-9)
