import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.errors import GeometryError
from bladegen.shapes import grassmann as gr
from bladegen.shapes import small_matrices
from strategies import SEEDS, points, random_points, random_tangent, rotations


def span(X):
    """The orthogonal projector: equal for equal planes (n x n, so small cases only)."""
    return X @ X.mT


@given(points(count=2))
def test_exp_of_log_spans_the_target(XY):
    X, Y = XY
    assert_allclose(span(gr.exp(X, gr.log(X, Y))), span(Y), atol=1e-12)


@given(points(count=2))
def test_exp_of_log_is_the_aligned_target(XY):
    X, Y = XY
    assert_allclose(gr.exp(X, gr.log(X, Y)), gr.align(X, Y), atol=1e-12)


@given(points(), SEEDS, st.floats(1e-9, 1.5))
def test_log_of_exp_is_the_tangent(X, seed, size):
    D = random_tangent(np.random.default_rng(seed), X, size)
    assert_allclose(gr.log(X, gr.exp(X, D)), D, atol=1e-11)


@given(points(count=2), rotations())
def test_log_does_not_depend_on_the_basis_of_its_target(XY, R):
    X, Y = XY
    assert_allclose(gr.log(X, Y @ R), gr.log(X, Y), atol=1e-12)


@given(points(count=2), rotations())
def test_log_turns_with_the_basis_of_its_start(XY, R):
    X, Y = XY
    assert_allclose(gr.log(X @ R, Y), gr.log(X, Y) @ R, atol=1e-12)


@given(points(count=2))
def test_logs_are_horizontal_and_as_long_as_the_distance(XY):
    X, Y = XY
    D = gr.log(X, Y)
    assert_allclose(X.mT @ D, 0, atol=1e-14)
    assert_allclose(gr.norm(D), gr.distance(X, Y), atol=1e-12)


@given(points(count=3), rotations())
def test_distance_is_a_metric_of_planes(XYZ, R):
    X, Y, Z = XYZ
    assert gr.distance(X, X @ R) < 1e-14
    assert_allclose(gr.distance(X, Y), gr.distance(Y, X), atol=1e-13)
    assert gr.distance(X, Z) <= gr.distance(X, Y) + gr.distance(Y, Z) + 1e-12


@given(points(), SEEDS, st.floats(-12, -1))
def test_small_distances_are_accurate(X, seed, exponent):
    D = random_tangent(np.random.default_rng(seed), X, 10.0**exponent)
    assert_allclose(gr.distance(X, gr.exp(X, D)), gr.norm(D), rtol=1e-3, atol=1e-15)


@given(points(), SEEDS, st.floats(0, 1))
def test_geodesics_have_constant_speed(X, seed, fraction):
    D = random_tangent(np.random.default_rng(seed), X, 1.0)
    assert_allclose(gr.distance(X, gr.exp(X, fraction * D)), fraction * gr.norm(D), atol=1e-12)


@given(points(count=2), SEEDS)
def test_transport_keeps_inner_products_and_stays_tangent(XY, seed):
    X, Y = XY
    rng = np.random.default_rng(seed)
    V, W = random_tangent(rng, np.stack([X, X]), 1.0)
    carried = gr.transport(np.stack([V, W]), X, Y)
    assert_allclose(Y.mT @ carried, 0, atol=1e-12)
    assert_allclose(np.sum(carried[0] * carried[1]), np.sum(V * W), atol=1e-12)
    assert_allclose(gr.norm(carried), gr.norm(np.stack([V, W])), atol=1e-12)


@given(points(count=2), SEEDS)
def test_transport_returns(XY, seed):
    X, Y = XY
    V = random_tangent(np.random.default_rng(seed), X, 1.0)
    assert_allclose(gr.transport(gr.transport(V, X, Y), Y, X), V, atol=1e-11)


@given(points(count=2), SEEDS, st.floats(-3, 3))
def test_transport_is_linear(XY, seed, factor):
    X, Y = XY
    V, W = random_tangent(np.random.default_rng(seed), np.stack([X, X]), 1.0)
    whole = gr.transport(V + factor * W, X, Y)
    assert_allclose(whole, gr.transport(V, X, Y) + factor * gr.transport(W, X, Y), atol=1e-12)


@given(points(count=2))
def test_transport_carries_the_geodesic_along_itself(XY):
    X, Y = XY
    assert_allclose(gr.transport(gr.log(X, Y), X, Y), -gr.log(Y, X), atol=1e-12)


@given(points(count=2), SEEDS, rotations(), rotations())
def test_transport_does_not_depend_on_bases(XY, seed, Q, R):
    X, Y = XY
    V = random_tangent(np.random.default_rng(seed), X, 1.0)
    assert_allclose(gr.transport(V @ Q, X @ Q, Y @ R), gr.transport(V, X, Y) @ R, atol=1e-12)


@given(SEEDS, st.integers(5, 30))
def test_a_batch_equals_its_parts(seed, n):
    rng = np.random.default_rng(seed)
    base = random_points(rng, 1, n)[0]
    X = gr.exp(base, random_tangent(rng, np.broadcast_to(base, (2, 3, n, 2)), 0.4))
    Y = gr.exp(base, random_tangent(rng, np.broadcast_to(base, (2, 3, n, 2)), 0.4))
    D = gr.log(X, Y)
    V = random_tangent(rng, X, 1.0)
    for i, j in np.ndindex(2, 3):
        assert_allclose(D[i, j], gr.log(X[i, j], Y[i, j]), atol=1e-13)
        assert_allclose(gr.exp(X, D)[i, j], gr.exp(X[i, j], D[i, j]), atol=1e-13)
        assert_allclose(gr.align(X, Y)[i, j], gr.align(X[i, j], Y[i, j]), atol=1e-13)
        assert_allclose(gr.distance(X, Y)[i, j], gr.distance(X[i, j], Y[i, j]), atol=1e-13)
        carried = gr.transport(V[i, j], X[i, j], Y[i, j])
        assert_allclose(gr.transport(V, X, Y)[i, j], carried, atol=1e-13)


@given(points())
def test_zero_is_no_special_case(X):
    assert_allclose(gr.log(X, X), 0, atol=1e-14)
    assert_allclose(gr.exp(X, np.zeros_like(X)), X, atol=0)
    V = random_tangent(np.random.default_rng(0), X, 1.0)
    assert_allclose(gr.transport(V, X, X), V, atol=1e-13)


@pytest.mark.parametrize("short_of_90", [1e-2, 1e-5, 1e-8])
def test_log_and_exp_near_90_degrees(short_of_90):
    X, E = np.eye(6)[:, :2], np.eye(6)[:, 2:4]
    D = E * [np.pi / 2 - short_of_90, 0.3]
    assert_allclose(gr.log(X, gr.exp(X, D)), D, atol=1e-7)
    assert_allclose(gr.distance(X, gr.exp(X, D)), gr.norm(D), atol=1e-12)


def test_log_and_transport_refuse_90_degrees():
    X, Y = np.eye(6)[:, :2], np.eye(6)[:, [0, 2]]
    with pytest.raises(GeometryError, match="90 degrees"):
        gr.log(X, Y)
    with pytest.raises(GeometryError, match="90 degrees"):
        gr.transport(np.zeros((6, 2)), X, Y)
    assert_allclose(gr.distance(X, Y), np.pi / 2, atol=1e-14)


@given(points(count=5), rotations())
def test_karcher_mean_balances_its_points(cloud, R):
    """Within pi/4 of one of them there is one mean, and gradient steps reach it."""
    cloud = gr.exp(cloud[:1], 0.6 * gr.log(cloud[:1], cloud))
    mean = gr.karcher_mean(cloud)
    assert gr.norm(gr.log(mean, cloud).mean(axis=0)) < 1e-12
    turned = gr.karcher_mean(cloud @ R)
    assert gr.distance(mean, turned) < 1e-10


@given(points(count=2))
def test_karcher_mean_of_two_points_is_halfway(XY):
    X, Y = XY
    assert gr.distance(gr.karcher_mean(XY), gr.exp(X, 0.5 * gr.log(X, Y))) < 1e-10


def test_karcher_mean_says_when_it_does_not_converge():
    cloud = random_points(np.random.default_rng(1), 4, 20)
    with pytest.raises(GeometryError, match="not converged after 1 steps"):
        gr.karcher_mean(cloud, max_steps=1)


def test_agrees_with_pymanopt():
    manifolds = pytest.importorskip("pymanopt.manifolds")
    oracle = manifolds.Grassmann(9, 2)
    rng = np.random.default_rng(7)
    X = random_points(rng, 1, 9)[0]
    D, V = random_tangent(rng, np.stack([X, X]), 0.9)
    Y = gr.exp(X, D)
    assert_allclose(span(oracle.exp(X, D)), span(Y), atol=1e-12)
    assert_allclose(oracle.dist(X, Y), gr.distance(X, Y), atol=1e-12)
    assert_allclose(oracle.log(X, Y), gr.log(X, Y), atol=1e-12)
    # pymanopt has no parallel transport; the equation of transport itself is the oracle:
    # along X(t) the derivative of V(t) must have no horizontal part.
    h = 1e-4
    points_ = [gr.exp(X, t * D) for t in (0.5 - h, 0.5, 0.5 + h)]
    before, here, after = (gr.transport(V, X, P) for P in points_)
    rate = (after - before) / (2 * h)
    assert_allclose(rate - points_[1] @ (points_[1].mT @ rate), 0, atol=1e-6)
    assert gr.norm(here) > 0.5


@given(SEEDS, st.sampled_from(["plain", "equal", "mirror", "singular", "zero"]))
def test_singular_values_by_formula(seed, kind):
    A = np.random.default_rng(seed).normal(size=(3, 2, 2))
    if kind == "equal":
        A = 2.0 * np.linalg.qr(A).Q
    elif kind == "mirror":
        A = A @ np.diag([1.0, -1.0])
    elif kind == "singular":
        A = A[..., :1] @ A[..., 1:].mT
    elif kind == "zero":
        A = np.zeros_like(A)
    U, s, Vt = small_matrices.svd(A)
    eye = np.broadcast_to(np.eye(2), (3, 2, 2))
    assert_allclose((U * s[..., None, :]) @ Vt, A, atol=1e-13)
    assert_allclose(U @ U.mT, eye, atol=1e-14)
    assert_allclose(Vt @ Vt.mT, eye, atol=1e-14)
    assert_allclose(s, np.linalg.svd(A, compute_uv=False), atol=1e-13)


def test_planes_of_more_than_two_dimensions():
    rng = np.random.default_rng(2)
    X = np.linalg.qr(rng.normal(size=(20, 3))).Q
    D = random_tangent(rng, X, 0.7)
    assert_allclose(gr.log(X, gr.exp(X, D)), D, atol=1e-12)


@given(points(count=2), SEEDS)
def test_the_rate_of_a_log_is_its_derivative(XY, seed):
    X, Y = XY
    E = random_tangent(np.random.default_rng(seed), Y, 1.0)
    steps = [1e-3, 5e-4]  # Richardson's extrapolation of central differences
    differences = [
        (gr.log(X, gr.exp(Y, h * E)) - gr.log(X, gr.exp(Y, -h * E))) / (2 * h) for h in steps
    ]
    wanted = (4.0 * differences[1] - differences[0]) / 3.0
    size = max(1.0, np.abs(wanted).max())
    assert_allclose(gr.log_rate(X, Y, E) / size, wanted / size, atol=1e-7)


@given(points(count=2), SEEDS)
def test_the_rate_of_a_log_undoes_that_of_exp_at_its_start(XY, seed):
    X, _ = XY
    E = random_tangent(np.random.default_rng(seed), X, 1.0)
    assert_allclose(gr.log_rate(X, X, E), E, atol=1e-12)
