"""The thickest place of a section, where sides are so nearly parallel that places vie for it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.interpolate import CubicSpline

from bladegen.airfoils import thickest as places
from bladegen.airfoils.landmarks import landmark_parameters, landmarks
from bladegen.airfoils.section_curves import SectionCurves
from bladegen.airfoils.slopes import SplineSlopes
from bladegen.blade.variants import section_measures
from bladegen.curves.cubics import Cubics
from strategies import few, naca

COUNTS = (31, 51, 101, 401)
ALONG = np.array([1.0, 0.0])


def rippled(n, amplitude, length, phase, pressure):
    """A section (n, 2) whose sides wave with a length in landmarks about the thickest place."""
    points, side = landmarks(naca(0.21, 0.02, 0.003), n).copy(), n // 2
    i = np.arange(side)
    at = np.argmax(points[:side, 1] - points[:side:-1, 1])
    wave = amplitude * np.exp(-(((i - at) / (0.1 * n)) ** 2))
    wave *= np.cos(2.0 * np.pi * ((i - at) / length + phase))
    points[-1 - i if pressure else i, 1] += -wave if pressure else wave
    return points


def searched(u, points):
    """The largest height by a fine search over both sides' splines: no code of ours."""
    spline, middle = CubicSpline(u, points), len(u) // 2
    fine = np.linspace(u[1], u[middle - 1], 20001)
    upper = spline(fine)
    lower = spline(np.linspace(u[middle + 1], 1.0, 400001))
    heights = upper[:, 1] - np.interp(upper[:, 0], *lower.T)
    a, b, c = heights[np.argmax(heights) + np.arange(-1, 2)]
    return b - (a - c) ** 2 / (8.0 * (a - 2.0 * b + c))  # the top of a parabola


def found(u, points):
    """The same by each of the ways that measure it."""
    slopes, planes = SplineSlopes.at(u), np.ascontiguousarray(points.T)[:, None]
    rates = slopes.all(planes)
    yield "quickly", places.thickest(slopes, planes, ALONG[None]).height[0]
    yield "slowly", Cubics(u, points[None], rates.transpose(1, 2, 0)).height[0]
    section = section_measures.Section(
        u, np.ascontiguousarray(rates[:, 0].T), np.eye(2), np.ascontiguousarray(points.T)
    )
    yield "compiled", section_measures.thickest(section, (1.0, 0.0), np.empty(len(u)))[0]


@settings(max_examples=few(60), deadline=None)
@given(
    st.sampled_from(COUNTS),
    st.floats(-6.0, -3.3).map(lambda x: 10.0**x),
    st.floats(3.0, 12.0),
    st.floats(0.0, 1.0),
    st.booleans(),
)
def test_of_places_that_vie_the_thickest_is_found(n, amplitude, length, phase, pressure):
    u = landmark_parameters(n)
    points = rippled(n, amplitude, length, phase, pressure)
    wanted = searched(u, points)
    for way, height in found(u, points):
        assert_allclose(height, wanted, rtol=0, atol=2e-9, err_msg=way)


@pytest.mark.parametrize("n", COUNTS)
def test_thickness_goes_over_from_one_place_to_another_without_a_step(n):
    u, phases = landmark_parameters(n), np.linspace(0.0, 1.0, 401)
    heights = np.array(
        [[height for _, height in found(u, rippled(n, 1e-4, 5.0, p, False))] for p in phases]
    )
    assert np.abs(np.diff(heights, axis=0)).max() < 3e-6  # a wave's slope times its way
    assert np.ptp(heights, axis=1).max() < 1e-13  # the ways agree


def test_a_stretch_after_which_sides_have_changed_places_ends_in_no_warning():
    """As where a few landmarks of a damaged table are all that is looked at; found by fuzzing."""
    u = np.array([0.0, 0.129, 0.371, 0.5, 0.629, 0.871, 1.0])
    points = [
        (1.007, 0.014),
        (0.649, 0.107),
        (0.165, 0.163),
        (-0.035, -0.006),
        (0.218, -0.174),
        (0.321, -0.104),
        (1.006, -0.007),
    ]
    curves = SectionCurves(SplineSlopes.at(u), np.array([points]))
    assert np.all(np.isfinite(curves.sizing(np.array([0.339])).A))
