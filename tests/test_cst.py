import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen import cst
from bladegen.affine import standardise
from bladegen.landmarks import landmark_parameters, landmarks
from strategies import SEEDS, airfoils, naca

U = landmark_parameters(101)
SYMMETRIC = np.concatenate([np.full(9, 0.17), np.full(9, -0.17)])


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
