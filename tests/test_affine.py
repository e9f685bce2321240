import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.airfoils.landmarks import landmarks
from bladegen.errors import GeometryError
from bladegen.shapes import affine
from strategies import airfoils, circle, ellipse, maps, points, rotations

STATIONS = np.stack([landmarks(xy, 101) for xy in (circle(), ellipse(0.5), ellipse(0.2))])


@given(airfoils(), maps(), st.floats(-5, 5))
def test_restore_undoes_standardise(xy, A, shift):
    xy = xy @ A + [shift, 1.0]
    X, M, b = affine.standardise(xy)
    assert_allclose(affine.restore(X, M, b), xy, atol=1e-11)
    assert_allclose(X.mT @ X, np.eye(2), atol=1e-13)
    assert_allclose(X.sum(axis=0), 0, atol=1e-10)


@given(airfoils(), maps())
def test_affine_maps_do_not_move_the_point(xy, A):
    X, Y = affine.standardise(xy)[0], affine.standardise(xy @ A + [1.0, 2.0])[0]
    assert_allclose(X @ X.mT, Y @ Y.mT, atol=1e-10)


def test_a_batch_equals_its_parts():
    batch = affine.standardise(STATIONS)
    for k, xy in enumerate(STATIONS):
        for whole, part in zip(batch, affine.standardise(xy), strict=True):
            assert_allclose(whole[k], part, atol=1e-13)


def test_a_line_is_no_shape():
    with pytest.raises(GeometryError, match="on a line"):
        affine.standardise(np.outer(np.arange(9.0), [1.0, 2.0]))


@given(points(count=4), st.lists(maps(), min_size=4, max_size=4))
def test_cluster_keeps_physical_shapes_and_matches_neighbours(X, M):
    M = np.stack(M)
    Y, N = affine.cluster(X, M)
    assert_allclose(Y @ N, X @ M, atol=1e-11)
    assert_allclose(Y[-1], X[-1], atol=0)
    overlap = Y[:-1].mT @ Y[1:]
    assert_allclose(overlap, overlap.mT, atol=1e-12)
    assert np.linalg.eigvalsh(overlap).min() > -1e-12


@given(points(count=3), rotations(), rotations(), rotations())
def test_cluster_does_not_depend_on_representatives_but_for_the_tip(X, P, Q, R):
    turns = np.stack([P, Q, R])
    M = np.broadcast_to(np.eye(2), (3, 2, 2))
    Y, N = affine.cluster(X, M)
    turned, maps_ = affine.cluster(X @ turns, turns.mT @ M)
    assert_allclose(turned, Y @ R, atol=1e-10)
    assert_allclose(maps_, R.mT @ N, atol=1e-10)


@given(maps())
def test_from_polar_undoes_polar(M):
    assert_allclose(affine.from_polar(*affine.polar(M)), M, atol=1e-11)


@given(maps(), rotations(proper=True))
def test_the_stretch_does_not_depend_on_the_representative(M, R):
    assert_allclose(affine.polar(R @ M)[1], affine.polar(M)[1], atol=1e-11)


@pytest.mark.parametrize("M", [np.diag([1.0, -1.0]), np.zeros((2, 2))])
def test_polar_refuses_singular_and_mirroring_maps(M):
    with pytest.raises(GeometryError, match="singular or mirrors"):
        affine.polar(M)


@given(st.floats(0.1, 0.9), st.floats(0.1, 0.9))
def test_one_parameter_families(s, r):
    s, r = np.array(s), np.array(r)
    assert_allclose(affine.thickness(s) @ affine.thickness(r), affine.thickness(s * r))
    assert_allclose(affine.chord(s) @ affine.chord(r), affine.chord(s * r))
    assert_allclose(affine.twist(s) @ affine.twist(r), affine.twist(s + r), atol=1e-15)
    assert_allclose(affine.camber(np.array(0.5)), np.eye(2))
    assert_allclose(affine.camber(s), np.diag([2 * (1 - s), 2 * s]))
    assert_allclose(affine.thickness(np.array([s, r])).shape, (2, 2, 2))


def test_positive_twist_is_nose_up():
    trailing_edge = np.array([[1.0, 0.0]]) @ affine.twist(np.array(0.1))
    assert trailing_edge[0, 1] < 0


@pytest.mark.parametrize("family", [affine.thickness, affine.chord, affine.camber, affine.twist])
def test_batches_of_maps_of_any_shape_equal_their_parts(family):
    amounts = np.linspace(0.2, 0.9, 6).reshape(2, 3)
    batch = family(amounts)
    assert batch.shape == (2, 3, 2, 2)
    for i, j in np.ndindex(2, 3):
        assert_allclose(batch[i, j], family(amounts[i, j]), atol=0)


def test_batches_of_shapes_and_stretches_of_any_shape_equal_their_parts():
    X, M, b = affine.standardise(np.stack([STATIONS, 2.0 * STATIONS[::-1]]))
    Y, N = affine.cluster(X, M)
    angle, log_stretch = affine.polar(N)
    again = affine.from_polar(angle, log_stretch)
    for i in range(2):
        for whole, part in zip((Y, N), affine.cluster(X[i], M[i]), strict=True):
            assert_allclose(whole[i], part, atol=1e-14)
        assert_allclose(again[i], N[i], atol=1e-12)
        assert_allclose(affine.restore(X, M, b)[i], affine.restore(X[i], M[i], b[i]), atol=0)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_how_flat_a_shape_may_be_does_not_depend_on_its_size(size):
    thin = ellipse(1.0) @ np.diag([1.0, 10 * affine.FLAT]) * size
    affine.standardise(thin)
    with pytest.raises(GeometryError, match="on a line"):
        affine.standardise(thin @ np.diag([1.0, 0.02]))
