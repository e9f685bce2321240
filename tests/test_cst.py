from math import comb

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import Polynomial
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from bladegen.airfoils.landmarks import landmark_parameters, landmarks
from bladegen.shapes import cst
from bladegen.shapes.affine import standardise
from strategies import SEEDS, airfoils, naca

U = landmark_parameters(101)
SYMMETRIC = np.concatenate([np.full(9, 0.17), np.full(9, -0.17)])
DRAWN = cst.perturbations(SYMMETRIC[None], 2, np.random.default_rng(11), reach=0.5)


class Exactly:
    """A class-shape airfoil as polynomials in s = sqrt(x); p is -s on the suction side."""

    def __init__(self, coefficients):
        s, left = Polynomial([0, 1]), Polynomial([1, 0, -1])  # left = 1 - x
        self.x = s**2
        self.y = [
            s
            * left
            * sum(a * comb(8, k) * s ** (2 * k) * left ** (8 - k) for k, a in enumerate(side))
            for side in np.split(coefficients, 2)
        ]
        away = [left**2 + y**2 for y in self.y]
        roots = [(i, d.deriv().roots()) for i, d in enumerate(away)]
        bends = [(i, r.real) for i, all_ in roots for r in all_ if abs(r.imag) < 1e-9]
        side, place = max(
            ((i, s) for i, s in bends if 0 <= s < 0.5), key=lambda b: away[b[0]](b[1])
        )
        self.nose = place if side else -place
        self.gauss = np.polynomial.legendre.leggauss(50)

    def point(self, p):
        return self.x(abs(p)), self.y[int(p > 0)](abs(p))

    def length(self, start, end):
        total = 0.0
        for low, high, y in ((start, min(end, 0.0), self.y[0]), (max(start, 0.0), end, self.y[1])):
            cuts = np.linspace(low, max(low, high), 5)
            half = 0.5 * np.diff(cuts)[:, None]
            s = np.abs(cuts[:-1, None] + half * (1 + self.gauss[0]))
            total += np.sum(half * self.gauss[1] * np.hypot(2 * s, y.deriv()(s)))
        return total

    def landmark(self, u):
        if u in (0.0, 0.5, 1.0):
            return self.point({0.0: -1, 0.5: self.nose, 1.0: 1}[u])
        total = self.length(-1, 1)
        shift = 1 / np.tan(np.pi * self.length(-1, self.nose) / total)
        wanted = total * (0.5 - np.arctan(1 / np.tan(np.pi * u) + shift) / np.pi)
        return self.point(brentq(lambda p: self.length(-1, p) - wanted, -1, 1, xtol=1e-15))


BLUNT = np.repeat([1.7, -0.3], 9)  # farthest from the trailing edge behind x = 0


@pytest.mark.parametrize(
    ("coefficients", "chords"),
    [
        pytest.param(SYMMETRIC, 1e-10, id="symmetric"),
        pytest.param(SYMMETRIC * np.repeat([1.3, 0.6], 9), 1e-10, id="sides differ at the nose"),
        pytest.param(DRAWN[0], 1e-10, id="drawn"),
        pytest.param(DRAWN[1], 1e-10, id="drawn again"),
        pytest.param(BLUNT, 1e-9, id="leading edge behind x = 0"),
    ],
)
def test_landmarks_are_right_to_the_digits_that_are_promised(coefficients, chords):
    """Where the first coefficients differ, the slope in the curve's parameter jumps at the nose."""
    curve = Exactly(coefficients)
    u = np.array([0.0, 0.1, 0.31, 0.49, 0.4985, 0.4996, 0.5, 0.5003, 0.501, 0.52, 0.75, 1.0])
    wanted = [curve.landmark(one) for one in u]
    assert_allclose(cst.shapes(coefficients[None], u)[0], wanted, rtol=0, atol=chords)


def by_landmarks(coefficients, n=101):
    """The same airfoil through a dense polyline and the landmarks of any airfoil."""
    x = 0.5 * (1 - np.cos(np.linspace(0, np.pi, 1200)))
    basis = (np.sqrt(x) * (1 - x))[:, None] * cst._bernstein(x)
    upper, lower = (np.stack([x, basis @ side], 1) for side in np.split(coefficients, 2))
    return landmarks(np.concatenate([upper[::-1], lower[1:]]), n)


@given(SEEDS)
def test_shapes_are_landmarks_of_the_class_shape_curve(seed):
    drawn = cst.perturbations(SYMMETRIC[None], 3, np.random.default_rng(seed))
    for one, made in zip(drawn, cst.shapes(drawn, U), strict=True):
        assert_allclose(made, by_landmarks(one), atol=5e-5)


def test_a_batch_equals_its_parts():
    drawn = cst.perturbations(SYMMETRIC[None], 7, np.random.default_rng(3))
    whole = cst.shapes(drawn, U)
    assert_allclose(whole, np.concatenate([cst.shapes(d[None], U) for d in drawn]), atol=1e-13)
    assert_allclose(cst.standardised_shapes(drawn, 101), standardise(whole)[0], atol=1e-13)


@given(SEEDS)
def test_fit_finds_the_coefficients_again(seed):
    (wanted,) = cst.perturbations(SYMMETRIC[None], 1, np.random.default_rng(seed))
    shape = cst.shapes(wanted[None], landmark_parameters(401))[0]
    found, residual = cst.fit(shape)
    assert residual < 1e-5
    assert_allclose(cst.shapes(found[None], U), cst.shapes(wanted[None], U), atol=2e-4)


@given(airfoils())
def test_fit_of_an_airfoil_is_close_and_takes_its_wedge_off(xy):
    _, residual = cst.fit(landmarks(xy, 401))
    assert residual < 2e-3


def test_the_wedge_of_an_open_edge_is_taken_off():
    closed, open_ = (cst.fit(landmarks(naca(0.2, 0.0, gap), 401))[0] for gap in (0.0, 0.02))
    assert_allclose(open_, closed, atol=5e-3)


@given(st.integers(1, 5), st.floats(0.0, 0.5), SEEDS)
def test_perturbations_stay_within_reach(count, reach, seed):
    base = np.stack([SYMMETRIC, 2 * SYMMETRIC])
    drawn = cst.perturbations(base, count, np.random.default_rng(seed), reach=reach)
    assert drawn.shape == (2 * count, 18)
    ratio = drawn.reshape(2, count, 18) / base[:, None]
    assert np.abs(ratio - 1).max() <= reach + 1e-12


@pytest.mark.parametrize("reach", [0.2])
def test_the_same_seed_gives_the_same_airfoils(reach):
    first, second = (
        cst.perturbations(SYMMETRIC[None], 5, np.random.default_rng(1), reach=reach)
        for _ in range(2)
    )
    assert np.array_equal(first, second)
