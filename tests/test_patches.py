"""Patches are held against scipy's splines, exact spheres and brute force."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import BSpline

from bladegen.cad import face_patches
from bladegen.measures import distances, surfaces
from bladegen.measures.patches import Patch, inside, to_rims

RNG = np.random.default_rng(4)


def some(p, q, rational=False):
    u = np.concatenate([np.zeros(p + 1), np.sort(RNG.uniform(size=5)), np.ones(p + 1)])
    v = np.concatenate([np.zeros(q + 1), [0.2, 0.2, 0.5], np.ones(q + 1)])
    shape = len(u) - p - 1, len(v) - q - 1
    weights = RNG.uniform(0.5, 2.0, shape) if rational else None
    return Patch(RNG.normal(size=(*shape, 3)), u, v, weights)


def by_scipy(patch, uv):
    (a, b), (p, q) = patch.poles.shape[:2], patch.degrees
    across = BSpline(patch.u_knots, np.eye(a), p)(uv[:, 0])
    along = BSpline(patch.v_knots, np.eye(b), q)(uv[:, 1])
    w = np.ones((a, b)) if patch.weights is None else patch.weights
    top = np.einsum("mi,mj,ijd->md", across, along, patch.poles * w[..., None])
    return top / np.einsum("mi,mj,ij->m", across, along, w)[:, None]


@pytest.mark.parametrize("degrees", [(3, 3), (1, 3), (2, 5)])
@pytest.mark.parametrize("rational", [False, True])
def test_points_and_slopes_are_those_of_scipy(degrees, rational):
    patch = some(*degrees, rational)
    uv = np.concatenate([RNG.uniform(size=(40, 2)), [[0, 0], [1, 1], [0, 1], [0.3, 0.2]]])
    point, du, dv = patch.at(uv)
    assert_allclose(point, by_scipy(patch, uv), atol=1e-13)
    inner = 0.01 + 0.98 * uv
    step = 1e-7
    for k, slope in ((0, patch.at(inner)[1]), (1, patch.at(inner)[2])):
        move = step * np.eye(2)[k]
        rise = by_scipy(patch, inner + move) - by_scipy(patch, inner - move)
        assert_allclose(slope, rise / (2 * step), atol=2e-5 * np.abs(slope).max())
    assert du.shape == dv.shape == point.shape
    crossing = np.array([[uv[2, 0], uv[1, 1]]])
    grid = patch.grid(uv[:4, 0], uv[:3, 1])
    assert_allclose(grid[2, 1], by_scipy(patch, crossing)[0], atol=1e-13)


def test_the_nearest_point_is_that_of_brute_force():
    x = np.linspace(0.0, 1.0, 7)
    poles = np.stack([*np.meshgrid(x, x, indexing="ij"), np.zeros((7, 7))], axis=-1)
    poles[..., 2] = 0.05 * RNG.normal(size=(7, 7))
    knots = np.concatenate([np.zeros(3), np.linspace(0, 1, 5), np.ones(3)])
    patch = Patch(poles, knots, knots)
    t = np.linspace(0.0, 1.0, 301)
    fine = patch.grid(t, t).reshape(-1, 3)
    points = RNG.uniform(-0.2, 1.2, (40, 3)) * [1, 1, 0.2]
    away = np.linalg.norm(points[:, None] - fine, axis=-1)
    best = np.argmin(away, axis=1)
    start = np.stack([t[best // 301], t[best % 301]], axis=1)
    uv, there, _ = patch.nearest(points, np.clip(start + 0.01, 0, 1))
    found = np.linalg.norm(points - there, axis=1)
    assert (found < away.min(axis=1) + 1e-7).all()
    assert_allclose(found, away.min(axis=1), atol=2e-3)  # half a cell of the grid
    assert ((uv >= 0) & (uv <= 1)).all()


def test_rims_bound_what_is_inside():
    turn = np.linspace(0.0, 2 * np.pi, 400)
    circle = 0.5 + 0.4 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    hole = 0.5 + 0.1 * np.stack([np.cos(turn), np.sin(turn)], axis=1)[::-1]
    uv = RNG.uniform(size=(500, 2))
    radius = np.linalg.norm(uv - 0.5, axis=1)
    rims = (circle[:200], hole, circle[199:])  # in any order, in pieces
    assert (inside(rims, uv) == ((radius > 0.1) & (radius < 0.4))).all()
    flat = np.array([[[0.0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    plane = Patch(flat, np.array([0.0, 0, 1, 1]), np.array([0.0, 0, 1, 1]), None, rims)
    _, there = to_rims(plane, np.array([[0.95, 0.5, 0.0], [0.5, 0.55, 1.0]]))
    assert_allclose(there, [[0.9, 0.5, 0.0], [0.5, 0.6, 0.0]], atol=1e-3)


@pytest.fixture(scope="module")
def body():
    """A box with a hole, rounded edges and a dome: planes, cylinders and spheres, trimmed."""
    import cadquery

    box = cadquery.Workplane().box(2000, 1000, 500).edges("|Z").fillet(100)
    return box.faces(">Z").workplane().hole(300).union(cadquery.Workplane().sphere(400))


def faces_of(body):
    return surfaces.of_faces(face_patches.faces(body.val().wrapped)[0])


def test_trimmed_faces_are_exact(body):
    """The sphere's dome: distances are those to the sphere, the plane, or the circle between."""
    surface = faces_of(body)
    way = RNG.normal(size=(200, 3)) * [1, 1, 0.4]
    way[:, 2] = np.abs(way[:, 2]) + 0.7 * np.linalg.norm(way[:, :2], axis=1)
    out = way / np.linalg.norm(way, axis=1, keepdims=True)
    out = out[out[:, 2] > 0.75]
    for shift in (0.05, -0.02):
        found = distances.signed((0.4 + shift) * out, surface)
        assert_allclose(found, shift, atol=1e-7)
    above = np.array([[0.8, 0.3, 0.3], [0.6, -0.4, 0.251], [-0.9, 0.0, 0.2501]])
    assert_allclose(distances.signed(above, surface), above[:, 2] - 0.25, atol=1e-9)
    side = np.array([[1.003, 0.2, 0.1], [0.1, 0.502, -0.2]])
    assert_allclose(distances.signed(side, surface), [0.003, 0.002], atol=1e-9)


def test_a_body_is_no_distance_from_itself_and_a_millimetre_from_a_copy(body):
    one, two = faces_of(body), faces_of(body.translate((0, 0, 1.0)))
    assert np.abs(distances.between(one, one)[1]).max() < 2e-7
    for a, b in ((one, two), (two, one)):
        assert_allclose(np.abs(distances.between(a, b)[1]).max(), 1e-3, atol=5e-5)


def test_faces_without_splines_are_triangles(body, monkeypatch):
    exact = faces_of(body)
    monkeypatch.setattr(face_patches, "_patch", lambda _: {})
    flat = faces_of(body)
    assert flat.patches == ()
    assert np.abs(distances.between(flat, exact)[1]).max() < 1e-4


@pytest.mark.parametrize("weight", [1e-300, 0.0, -1.0])
def test_faces_with_poles_of_no_weight_are_triangles(weight, body, monkeypatch):
    exact, plain = faces_of(body), face_patches._arrays

    def spoilt(surface):
        parts = plain(surface)
        if "weights" in parts:
            parts["weights"][0] = weight
        return parts

    monkeypatch.setattr(face_patches, "_arrays", spoilt)
    found = faces_of(body)
    assert 0 < len(found.patches) < len(exact.patches)
    assert all(patch.weights is None for patch in found.patches)
    assert np.abs(distances.between(found, exact)[1]).max() < 1e-4


def test_faces_whose_rims_lie_beside_them_are_triangles(body, monkeypatch):
    """A damaged file may say that a face ends a turn away from where it is."""
    exact, plain = faces_of(body), face_patches._rims
    monkeypatch.setattr(face_patches, "_rims", lambda face: [rim + 1e4 for rim in plain(face)])
    found = faces_of(body)
    assert found.patches == ()
    assert np.abs(distances.between(found, exact)[1]).max() < 1e-4
