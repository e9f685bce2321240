import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.airfoils import landmarks as lm
from bladegen.curves.arc_lengths import divided
from bladegen.errors import GeometryError
from strategies import airfoils, circle, ellipse, naca

COUNTS = st.sampled_from([51, 101, 401])


def distances_to_polyline(points, line):
    """Distance of each point to a polyline."""
    start, step = line[:-1], np.diff(line, axis=0)
    t = np.sum((points[:, None] - start) * step, axis=-1) / np.sum(step * step, axis=-1)
    foot = start + np.clip(t, 0, 1)[..., None] * step
    return np.min(np.linalg.norm(points[:, None] - foot, axis=-1), axis=1)


@given(airfoils(), COUNTS)
def test_landmarks_run_from_edge_to_edge_suction_side_first(xy, n):
    points = lm.landmarks(xy, n)
    assert points.shape == (n, 2)
    x, y = points.T
    area = 0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)
    assert area > 0
    ends = xy[[0, -1]] if xy[1, 1] > xy[-2, 1] else xy[[-1, 0]]
    assert_allclose(points[[0, -1]], ends, atol=1e-12)


@given(airfoils(), COUNTS)
def test_the_order_of_the_points_does_not_matter(xy, n):
    assert_allclose(lm.landmarks(xy[::-1], n), lm.landmarks(xy, n), atol=1e-12)


@given(airfoils())
def test_repeated_points_do_not_matter(xy):
    doubled = np.repeat(xy, 2, axis=0)
    assert_allclose(lm.landmarks(doubled, 51), lm.landmarks(xy, 51), atol=1e-13)


@given(airfoils(), COUNTS)
def test_the_middle_landmark_is_the_farthest_from_the_trailing_edge(xy, n):
    points = lm.landmarks(xy, n)
    middle = 0.5 * (points[0] + points[-1])
    fine = lm.landmarks(xy, 4001, spacing=lm.cosine)
    farthest = np.linalg.norm(fine - middle, axis=1).max()
    assert_allclose(np.linalg.norm(points[n // 2] - middle), farthest, atol=1e-7)


@given(airfoils())
def test_landmarks_lie_on_the_airfoil(xy):
    assert distances_to_polyline(lm.landmarks(xy, 101), np.asarray(xy)).max() < 5e-3


@given(airfoils(), st.sampled_from([lm.uniform, lm.cosine, lm.clustered]))
def test_arc_length_is_one_smooth_function_of_the_sides_lengths(xy, spacing):
    n = 1601
    points = lm.landmarks(xy, n, spacing=spacing)
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    inner = slice(1, -1)
    turned = 1.0 / np.tan(np.pi * arc[inner] / arc[-1])
    wanted = 1.0 / np.tan(np.pi * lm.landmark_parameters(n, spacing)[inner])
    shift = turned - wanted  # the same at all landmarks: that of the nose, where u is 1/2
    rate = (np.pi / arc[-1]) * (1.0 + turned**2)  # chords are shorter than arcs at the nose
    assert_allclose((shift - shift[n // 2 - 1]) / rate, 0.0, atol=2e-4)


@given(airfoils())
def test_landmarks_pass_the_nose_without_a_change_of_step(xy):
    points = lm.landmarks(xy, 6401, spacing=lm.uniform)
    before, after = np.linalg.norm(np.diff(points, axis=0), axis=1)[3199:3201]
    assert_allclose(after, before, rtol=2e-3)


@given(st.floats(0.02, 0.98), st.floats(0.02, 0.98))
def test_lengths_are_divided_smoothly_all_around(middle, other):
    u = np.linspace(0.0, 1.0, 4001)
    share = divided(u, middle)
    assert (share[0], share[2000], share[-1]) == (0.0, middle, 1.0)
    assert np.all(np.diff(share) > 0.0)
    assert_allclose(divided(1.0 - u, 1.0 - middle), 1.0 - share, rtol=0, atol=1e-12)
    assert_allclose(divided(share, 1.0 - middle), u, rtol=0, atol=1e-12)  # and back again
    assert_allclose(divided(u, np.array([[middle], [other]]))[0], share, rtol=0, atol=0)
    between = 0.5 * (u[1:] + u[:-1])
    speed = (np.sin(np.pi * divided(between, middle)) / np.sin(np.pi * between)) ** 2
    assert_allclose(np.diff(share) / np.diff(u), speed, rtol=5e-3)  # one law on both sides


@given(COUNTS)
def test_finer_landmarks_hold_the_coarser(n):
    xy = ellipse(0.3)
    assert_allclose(lm.landmarks(xy, 2 * n - 1)[::2], lm.landmarks(xy, n), atol=1e-12)


def test_a_circle_is_a_circle():
    points = lm.landmarks(circle(), 401)
    assert_allclose(np.linalg.norm(points - [0.5, 0.0], axis=1), 0.5, atol=1e-6)
    assert_allclose(points[200], [0.0, 0.0], atol=1e-6)


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize("lean", [0.0, 1e-3, -1e-3])
def test_an_upright_base_closed_to_a_point_is_opened_at_its_corners(order, lean):
    open_ = naca(0.3, 0.02, 0.03)
    closed = np.concatenate([[[1.0 + lean, 0.0]], open_, [[1.0 + lean, 0.0]]])[::order]
    curve = lm.contour(closed)
    assert curve.opened == pytest.approx(0.03, rel=0.05)
    placed = curve.landmarks(lm.landmark_parameters(101))
    assert_allclose(placed, lm.landmarks(open_, 101), atol=1e-3 + 2 * abs(lean))


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize("lost", [0, 1])
def test_a_base_closed_to_one_of_its_corners_is_opened(order, lost):
    """As in turbine files, whose last point is the first again, instead of the other corner."""
    open_ = naca(0.24, 0.02, 0.006)
    closed = np.concatenate([open_[: len(open_) - lost], open_[:1]])[::order]
    assert lm.contour(closed).opened == pytest.approx(open_[0, 1] - open_[-1, 1], rel=0.02)
    assert_allclose(lm.landmarks(closed, 101), lm.landmarks(open_, 101), rtol=0, atol=1e-5)


def test_a_base_whose_side_runs_straight_up_ends_in_its_corner():
    steep = naca(0.3, 0.02, 0.03)
    steep[1] = steep[0] + [0.0, 0.01]
    closed = np.concatenate([[[1.0, 0.0]], steep, [[1.0, 0.0]]])
    placed = lm.landmarks(closed, 101)
    assert np.isfinite(placed).all()
    assert placed[:, 0].max() < 1.01


@pytest.mark.parametrize("size", [1e7, 1e200])
def test_points_too_far_apart_for_their_digits_are_refused(size):
    with pytest.raises(GeometryError, match="allowed is up to 1e"):
        lm.landmarks(ellipse(0.2) * size, 51)


def test_a_blunt_base_closed_to_a_point_is_opened():
    open_edge = ellipse(0.3, 401)[20:-20]
    edge = np.array([[open_edge[0, 0] + 5e-4, 0.0]])
    height = open_edge[0, 1] - open_edge[-1, 1]
    assert 0.01 < height < 0.1
    closed = np.concatenate([edge, open_edge, edge])
    scaled = closed / closed[0, 0] * [1.0, 0.2]
    curve = lm.contour(scaled)
    assert_allclose(curve.opened, 0.2 * height / closed[0, 0], rtol=0.1)
    points = lm.landmarks(scaled, 101)
    assert_allclose(points[[0, -1], 0], 1.0, atol=1e-12)
    assert points[0, 1] - points[-1, 1] == pytest.approx(curve.opened, rel=1e-6)


@given(st.sampled_from([lm.uniform, lm.cosine, lm.clustered]), st.integers(2, 200))
def test_landmark_parameters_are_symmetric_and_increase(spacing, half):
    u = lm.landmark_parameters(2 * half + 1, spacing)
    assert_allclose(u + u[::-1], 1.0, atol=1e-15)
    assert_allclose(u[[0, half, -1]], [0.0, 0.5, 1.0], atol=1e-15)
    assert np.all(np.diff(u) > 0)


@pytest.mark.parametrize("n", [3, 100, 0, -5])
def test_an_even_or_small_number_of_landmarks_is_refused(n):
    with pytest.raises(GeometryError, match=f"got {n}, allowed are odd numbers from 5"):
        lm.landmark_parameters(n)


def test_unusable_airfoils_are_refused():
    with pytest.raises(GeometryError, match="distinct points"):
        lm.landmarks(np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 0.0]]), 11)
    with pytest.raises(GeometryError, match="area"):
        lm.landmarks(np.array([[1.0, 0.0], [0.5, 0.0], [0.0, 0.0]]), 11)
    gaping = np.array([[1.0, 2.0], [0.8, 1.0], [0.5, 0.0], [0.8, -1.0], [1.0, -2.0]])
    with pytest.raises(GeometryError, match="no leading edge"):
        lm.landmarks(gaping, 11)


def test_a_contour_that_turns_back_on_itself_has_landmarks():
    spline = lm._spline(np.array([[1.0, 0.0], [0.99, 0.0], [1.0, 0.0]]))
    assert np.hypot(*spline(spline.x[1], 1)) == 0.0
    points = lm.Contour(spline, spline.x[1]).landmarks(lm.landmark_parameters(41))
    assert_allclose(points[20], [0.99, 0.0], atol=1e-12)
    assert np.isfinite(points).all()


def test_a_ripple_beside_the_farthest_point_does_not_hide_it():
    """Sections of meshes have points in pairs, between which distances fall a little."""
    from scipy.interpolate import PPoly

    start, dip, top = 0.2, 0.27, 0.55  # of a distance whose slope is -(t - dip)(t - top)
    a, b, c = -1.0 / 3.0, (dip + top) / 2.0 - start, -(start - dip) * (start - top)
    distance = np.array([a, b, c, 1.0])
    low = np.array([0.0, 0.0, 0.0, 0.5])
    rows = np.stack([low, distance], axis=1)
    spline = PPoly(np.stack([rows, 0.0 * rows], axis=-1), [0.0, 1.0, 2.0])
    assert spline(1.0, 1)[0] < 0.0 < spline(1.25)[0] - spline(1.0)[0]
    assert_allclose(lm._farthest(spline, np.zeros(2)), 1.0 + top - start, atol=1e-12)
