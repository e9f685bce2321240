import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.landmarks import landmark_parameters, landmarks
from bladegen.sections import SectionSplines
from strategies import airfoils, circle, ellipse, four_digit

U = landmark_parameters(401)
SPLINES = SectionSplines(U)


def measured(points):
    """Chord and thickness by brute force on a fine polyline, as an independent reference."""
    fine = SPLINES.values(np.linspace(0, 1, 40001)) @ points
    edge = 0.5 * (points[0] + points[-1])
    nose = fine[np.argmax(np.linalg.norm(fine - edge, axis=1))]
    chord = np.linalg.norm(edge - nose)
    along = (edge - nose) / chord
    x, y = (fine - nose) @ along, (fine - nose) @ [-along[1], along[0]]
    half = np.argmin(np.linalg.norm(fine - nose, axis=1))
    at = np.linspace(0.02, 0.98, 4001) * chord
    upper = np.interp(at, x[half::-1], y[half::-1])
    return chord, np.max(upper - np.interp(at, x[half:], y[half:])) / chord


@given(airfoils())
def test_agrees_with_brute_force(xy):
    points = landmarks(xy, 401)
    curves = SPLINES.fit(points[None])
    chord, thickness = measured(points)
    assert_allclose(curves.chord[0], chord, atol=1e-8)
    assert_allclose(curves.relative_thickness[0], thickness, atol=1e-6)


@pytest.mark.parametrize("thickness", [0.12, 0.18, 0.3])
def test_thickness_of_a_symmetric_four_digit_section(thickness):
    x = 0.5 * (1 - np.cos(np.linspace(0, np.pi, 2001)))
    half, _ = four_digit(x, thickness, 0.0)
    xy = np.concatenate([np.stack([x, half], 1)[::-1], np.stack([x, -half], 1)[1:]])
    curves = SPLINES.fit(landmarks(xy, 401)[None])
    assert_allclose(curves.chord, 1.0, atol=1e-9)
    assert_allclose(curves.relative_thickness, 2 * half.max(), atol=1e-7)


@pytest.mark.parametrize("thickness", [0.2, 0.7, 1.0])
def test_thickness_of_ellipses(thickness):
    xy = circle(721) * [1.0, thickness]
    curves = SPLINES.fit(landmarks(xy, 401)[None])
    assert_allclose(curves.relative_thickness, thickness, atol=1e-7)


@given(airfoils(), st.floats(0.6, 1.6))
def test_normalising_is_exact(xy, factor):
    points = landmarks(xy, 401)[None]
    thickness = factor * SPLINES.fit(points).relative_thickness[0]
    angle = 0.05
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    for shape in (points, 1.3 * points @ turn + 0.2):
        B, c = SPLINES.normalising(shape, np.array([thickness]))
        curves = SPLINES.fit(shape @ B + c[:, None])
        assert_allclose(curves.chord, 1.0, atol=1e-12)
        assert_allclose(curves.relative_thickness, thickness, atol=1e-11)
        B, c = SPLINES.normalising(shape, None)
        curves = SPLINES.fit(shape @ B + c[:, None])
        assert_allclose(curves.chord, 1.0, atol=1e-12)


def test_a_batch_equals_its_parts():
    shapes = np.stack([landmarks(ellipse(t), 401) for t in (0.2, 0.5, 1.0)])
    curves = SPLINES.fit(shapes)
    for k in range(3):
        alone = SPLINES.fit(shapes[k : k + 1])
        assert_allclose(curves.chord[k], alone.chord[0], atol=1e-14)
        assert_allclose(curves.relative_thickness[k], alone.relative_thickness[0], atol=1e-12)


def test_splines_pass_through_their_landmarks():
    shapes = np.stack([landmarks(ellipse(t), 401) for t in (0.2, 0.5)])
    curves = SPLINES.fit(shapes)
    at = np.broadcast_to(U, (2, 401))
    assert_allclose(curves.at(at)[0], shapes, atol=1e-14)
    assert_allclose(SPLINES.values(U) @ shapes, shapes, atol=1e-13)
    middle = 0.5 * (U[1:] + U[:-1])
    dense = np.broadcast_to(middle, (2, 400))
    assert_allclose(curves.at(dense)[0], SPLINES.values(middle) @ shapes, atol=1e-12)
    assert_allclose(curves.at(dense)[1], SPLINES.values(middle, 1) @ shapes, atol=1e-9)


@pytest.mark.parametrize("n", [5, 7, 9, 11])
def test_few_landmarks_have_measures_too(n):
    splines = SectionSplines(landmark_parameters(n))
    points = np.stack([landmarks(ellipse(t), n) for t in (0.2, 0.4)])
    wanted = np.array([0.25, 0.35])
    A, c = splines.normalising(points, wanted)
    curves = splines.fit(points @ A + c[:, None])
    assert_allclose(curves.chord, 1.0, atol=1e-9)
    assert_allclose(curves.relative_thickness, wanted, rtol=1e-6)
