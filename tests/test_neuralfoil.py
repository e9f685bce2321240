"""NeuralFoil's coefficients and their derivatives, held against NeuralFoil and differences."""

from functools import cache

import neuralfoil
import numpy as np
import pytest
from aerosandbox.geometry.airfoil.airfoil_families import get_kulfan_parameters
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.airfoils.landmarks import landmarks
from bladegen.errors import BladegenError, MissingLibraryError
from bladegen.formats.baselines import baselines
from bladegen.neuralfoil import NAMES, coefficients
from strategies import SEEDS, few, naca

RE = 6e6


@cache
def airfoils():
    """Landmarks (m, 101, 2) of airfoils of up to 40 %, their chord line along x."""
    xy = np.stack([landmarks(points, 101) for points in baselines().values()])
    z = xy[..., 0] + 1j * xy[..., 1]
    z = (z - z[:, 50, None]) / (0.5 * (z[:, :1] + z[:, -1:]) - z[:, 50, None])
    return np.stack([z.real, z.imag], axis=-1)[np.ptp(z.imag, axis=1) < 0.4]


def by_neuralfoil(xy, degrees):
    kulfan = get_kulfan_parameters(xy, normalize_coordinates=False)
    found = neuralfoil.get_aero_from_kulfan_parameters(kulfan, degrees, RE)
    return [found[name][0] for name in NAMES]


def test_coefficients_are_neuralfoils():
    xy, degrees = airfoils(), np.linspace(-5.0, 10.0, len(airfoils()))
    found = coefficients(xy, np.radians(degrees), RE).values
    wanted = [by_neuralfoil(*pair) for pair in zip(xy, degrees, strict=True)]
    assert_allclose(found, wanted, rtol=1e-9, atol=1e-11)


def test_an_edge_that_is_fitted_best_by_a_negative_thickness_is_taken_for_sharp():
    xy = landmarks(naca(0.18, 0.02, 0.0), 101)
    xy = xy - xy[50]
    xy[:, 1] -= 0.01 * np.sign(50 - np.arange(101)) * xy[:, 0]  # sides cross at the edge
    assert get_kulfan_parameters(xy, normalize_coordinates=False)["TE_thickness"] == 0
    found = coefficients(xy, np.radians(3.0), RE)
    # nothing turns: the middle of the edge stays on the axis
    assert_allclose(found.values, by_neuralfoil(xy, 3.0), rtol=1e-4)
    agree(xy, 3.0, np.random.default_rng(0))


def differences(f, step):
    return (8.0 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step))) / (12.0 * step)


def agree(xy, degrees, rng):
    alpha, way = np.radians(degrees), rng.normal(size=xy.shape)
    found = coefficients(xy, alpha, RE)
    along = (found.in_points * way).sum(axis=(-1, -2))
    moved = differences(lambda s: coefficients(xy + s * way, alpha, RE).values, 1e-6)
    assert_allclose(along, moved, rtol=0, atol=1e-7 * np.abs(found.in_points).sum())
    turned = differences(lambda s: coefficients(xy, alpha + s, RE).values, 1e-3)
    assert_allclose(found.in_alpha, turned, rtol=1e-6, atol=1e-7)
    faster = differences(lambda s: coefficients(xy, alpha, RE * (1.0 + s)).values, 1e-3)
    assert_allclose(RE * found.in_reynolds, faster, rtol=1e-6, atol=1e-8)


@settings(max_examples=few(8))
@given(seed=SEEDS, degrees=st.floats(-6.0, 10.0))
def test_derivatives_are_those_of_differences(seed, degrees):
    rng = np.random.default_rng(seed)
    agree(airfoils()[seed % len(airfoils())], degrees, rng)


@given(seed=SEEDS, turn=st.floats(-3.0, 3.0), size=st.floats(0.1, 10.0))
def test_neither_place_nor_turn_nor_size_changes_coefficients(seed, turn, size):
    xy = airfoils()[:3]
    moved = size * xy @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    moved += np.random.default_rng(seed).normal(size=2)
    one, other = (coefficients(points, 0.05, RE) for points in (xy, moved))
    assert_allclose(other.values, one.values, rtol=1e-8, atol=1e-10)
    assert_allclose(
        np.linalg.norm(size * other.in_points, axis=(-1, -2)),
        np.linalg.norm(one.in_points, axis=(-1, -2)),
        rtol=1e-6,
    )


def test_a_batch_equals_its_parts():
    xy = airfoils()[:4].reshape(2, 2, 101, 2)
    alpha = np.array([[0.0, 0.05], [0.1, -0.05]])
    whole = coefficients(xy, alpha, RE)
    part = coefficients(xy[1, 0], 0.1, RE)
    for name in ("values", "in_points", "in_alpha", "in_reynolds"):
        assert_allclose(getattr(whole, name)[1, 0], getattr(part, name), rtol=1e-10, atol=1e-13)
    assert whole.in_points.shape == (2, 2, 3, 101, 2)
    assert repr(part).startswith("Coefficients(values=")


def test_slips_are_answered_in_one_line(monkeypatch):
    with pytest.raises(BladegenError, match=r"points: got shape \(3, 2\), must be"):
        coefficients(np.zeros((3, 2)), 0.0, RE)
    with pytest.raises(BladegenError, match=r"size: Invalid model_size='huge'"):
        coefficients(airfoils()[0], 0.0, RE, size="huge")
    monkeypatch.setitem(__import__("sys").modules, "neuralfoil", None)
    with pytest.raises(MissingLibraryError, match=r"pip install 'bladegen\[aero\]'"):
        coefficients(airfoils()[0], 0.0, RE, size="small")
