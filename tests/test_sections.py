import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.optimize import brentq

import bladegen as bg
from bladegen.airfoils import fronts, noses
from bladegen.airfoils.landmarks import landmark_parameters, landmarks
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.edges import MinimumThickness, Sharp
from bladegen.errors import GeometryError
from strategies import airfoils, box, circle, ellipse, few, four_digit, naca

U = landmark_parameters(401)
SPLINES = SectionSplines(U)


def led(u, fine, edge):
    """The leading edge: the farthest point, or the mean of those nearly as far."""
    away = fine - edge
    squares = np.sum(away**2, axis=1) * ((u > 0.25) & (u < 0.75))
    top, part = squares.max(), np.gradient(u)
    first = np.argmax(squares)
    apart = np.abs(u - u[first])
    gap, fall = 1.0 - squares / top + fronts.DIGITS, fronts.ROUND * apart**2 + fronts.DIGITS
    y = np.maximum(1.0 - gap / fall, 0.0)
    f = min(np.sum((part * y**2 / (apart + fronts.NEAR))[squares > 0.0]) / fronts.LED, 1.0)

    def excess(level):
        return np.sum(part * np.maximum(squares / level - 1.0, 0.0) ** 2) - fronts.MASS

    x = np.maximum(squares / brentq(excess, 0.9 * top, top, xtol=1e-15) - 1.0, 0.0)
    level = np.max(squares[x > 0.0] / (1.0 + x[x > 0.0]))
    weights = part * x**2 / np.sum(part * x**2)
    mean = weights @ away
    mean *= np.sqrt(level * (1.0 + fronts.PARABOLA * weights @ x)) / np.linalg.norm(mean)
    return edge + away[first] + f * f * (3.0 - 2.0 * f) * (mean - away[first])


def measured(points):
    """Chord and thickness by brute force on a fine polyline, as an independent reference."""
    u = np.linspace(0, 1, 40001)
    fine = SPLINES.values(u) @ points
    edge = 0.5 * (points[0] + points[-1])
    near = u[np.argmax(np.linalg.norm(fine - edge, axis=1))] + 2.5e-5 * np.linspace(-1, 1, 2001)
    u = np.sort(np.concatenate([u, near]))
    fine = SPLINES.values(u) @ points
    nose = led(u, fine, edge)
    chord = np.linalg.norm(edge - nose)
    along = (edge - nose) / chord
    x, y = (fine - nose) @ along, (fine - nose) @ [-along[1], along[0]]
    half = np.argmin(np.linalg.norm(fine - nose, axis=1))
    at = np.linspace(0.02, 0.98, 4001) * chord
    upper = np.interp(at, x[half::-1], y[half::-1])
    return chord, np.max(upper - np.interp(at, x[half:], y[half:])) / chord


@settings(max_examples=few(15))
@given(airfoils())
def test_agrees_with_brute_force(xy):
    points = landmarks(xy, 401)
    curves = SPLINES.fit(points[None])
    chord, thickness = measured(points)
    sums = 2e-6 * (curves.shares[0] > 0.0)  # sums over landmarks are no integrals
    assert_allclose(curves.chord[0], chord, atol=1e-8 + sums)
    assert_allclose(curves.relative_thickness[0], thickness, atol=1e-6 + sums)


@given(st.floats(0.06, 0.3), st.floats(0.0, 0.05), st.floats(0.0, 0.02))
def test_a_nose_that_clearly_wins_is_the_farthest_point_to_the_bit(thickness, camber, gap):
    points = landmarks(naca(thickness, camber, gap), 401)
    curves = SPLINES.fit(points[None])
    assert curves.shares[0] == 0.0
    edge, away = curves.trailing_edge, points - curves.trailing_edge
    best = np.argmax(np.sum(away**2, axis=1), keepdims=True)
    first, _ = noses._peak(curves.splines, curves.planes, edge.T, np.array([0]), best)
    assert_array_equal(curves.leading_edge, first)
    u = np.linspace(0.4, 0.6, 2001)[None]
    away = np.linalg.norm(curves.at(u)[0][0] - edge, axis=-1)
    assert np.all(away <= curves.chord[0] * (1.0 + 1e-15))


def fronted(heights, sharp):
    """(k, 401, 2) sections whose fronts are a circle about the edge, with bumps (k, 3) on it."""
    turn = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 401)[::-1]
    far = np.cos(turn) ** 0.1 * (1.0 - 0.3 * np.maximum(np.abs(turn) - 0.3, 0.0) ** 2)
    places = np.array([-0.2, 0.02, 0.21])
    bumps = np.exp(-(((turn[:, None] - places) / sharp) ** 2))
    far = far * (1.0 + heights @ bumps.T)
    far[..., [0, -1]] = 0.0
    return np.stack([1.0 - np.cos(turn) * far, np.sin(turn) * far], axis=-1)


@given(st.integers(0, 2**32 - 1), st.sampled_from([0.03, 0.06, 0.1]))
@settings(max_examples=few(30), deadline=None)
def test_the_chord_line_is_continuous_where_noses_tie(seed, sharp):
    """Whatever noses pass each other, two or three: twice as many steps are half as large."""
    rng, splines = np.random.default_rng(seed), SectionSplines(np.linspace(0.0, 1.0, 401))
    start, end = rng.uniform(0.0, 2e-3, (2, 3))
    through = 0.5 * (start + end)  # where all three tie, nearly
    start, end = (one - through + 1e-3 for one in (start, end))
    steps = []
    for count in (1025, 2049):
        s = np.linspace(0.0, 1.0, count)[:, None]
        curves = splines.fit(fronted(start + s * (end - start), sharp))
        steps.append(np.abs(np.diff(curves.leading_edge, axis=0)).max())
    assert curves.shares.max() == 1.0
    assert steps[1] < 0.6 * steps[0]


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


@given(st.lists(airfoils(), min_size=2, max_size=4))
def test_thickness_does_not_depend_on_the_company(contours):
    points = np.stack([landmarks(xy, 401) for xy in contours])
    alone = [SPLINES.fit(one[None]).thickness[0] for one in points]
    assert_allclose(SPLINES.fit(points).thickness, alone, rtol=1e-12)


def test_a_section_without_thickness_cannot_be_brought_to_one():
    flat = landmarks(circle(721), 401) * [1.0, 0.0]
    with pytest.raises(GeometryError, match="no thickness"):
        SPLINES.normalising(flat[None], np.array([0.2]))


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


@pytest.mark.parametrize("thickness", [0.9, 1.1, 1.16])
def test_normalising_settles_where_noses_pass_each_other(thickness):
    splines = SectionSplines(np.linspace(0.0, 1.0, 401))
    points, wanted = box(401, np.linspace(-0.02, 0.02, 81)), np.full(81, thickness)
    A, c = splines.normalising(points, wanted)
    shapes = points @ A + c[:, None]
    curves = splines.fit(shapes)
    assert_allclose(curves.chord, 1.0, rtol=0, atol=1e-12)
    assert_allclose(curves.relative_thickness, wanted, rtol=0, atol=3e-12)
    assert_allclose(curves.leading_edge[40, 1], 0.0, atol=1e-5)  # as even as the section


@pytest.mark.parametrize("thickness", [1.25, 1.5])
def test_a_section_that_turns_before_it_is_so_thick_is_so_normal_to_its_own_line(thickness):
    """A box that is higher than long: what is stretched is its diagonal's height, no more."""
    splines = SectionSplines(np.linspace(0.0, 1.0, 401))
    points = box(401, np.array([-0.02, 0.02]))
    curves = splines.fit(points)
    A, c = splines.normalising(points, np.full(2, thickness))
    stretched = splines.fit(points @ A + c[:, None])
    assert np.all(stretched.relative_thickness < thickness)
    line = curves.trailing_edge - curves.leading_edge
    nose, edge = ((p[:, None] @ A)[:, 0] + c for p in (curves.leading_edge, curves.trailing_edge))
    (x, y), (x1, y1) = (edge - nose).T, line.T
    assert_allclose(x * y1 - y * x1, 0.0, atol=1e-12)
    assert_allclose(np.linalg.norm(edge - nose, axis=1), 1.0, rtol=1e-12)
    assert_allclose(np.linalg.det(A) * curves.chord**2 * curves.relative_thickness, thickness)


def test_noses_that_pass_each_other_leave_other_sections_as_they_are():
    splines = SectionSplines(np.linspace(0.0, 1.0, 401))
    oval = circle(401) * [1.0, 0.4]
    points = np.concatenate([box(401, np.array([0.003, 0.0])), oval[None]])
    A, c = splines.normalising(points, np.array([1.3, 1.3, 0.45]))
    B, d = splines.normalising(points[2:], np.array([0.45]))
    assert_allclose(A[2], B[0], rtol=0, atol=1e-15)
    assert_allclose(c[2], d[0], rtol=0, atol=1e-15)


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


@pytest.mark.parametrize("edge", [MinimumThickness(0.01), Sharp()])
def test_points_are_the_same_whatever_others_are_asked_for(edge):
    blade = bg.Blade.from_definition(bg.read("nrel5mw")).with_trailing_edge(edge)
    eta, rng = np.array([0.3, 0.95]), np.random.default_rng(3)
    few = np.sort(rng.uniform(0.001, 0.999, 7))  # neither the ends, nor symmetric
    whole = np.unique(np.concatenate([[0.0, 0.5, 1.0], few, 1.0 - few]))
    for one in (blade, blade.mirror_image()):
        points = one.sections(eta, whole)[:, np.searchsorted(whole, few)]
        assert_allclose(one.sections(eta, few), points, rtol=0, atol=1e-12)
        assert_allclose(one.point(eta[:, None], few), points, rtol=0, atol=1e-12)
        assert_allclose(one.sections(eta, few[3:4]), points[:, 3:4], rtol=0, atol=1e-12)
