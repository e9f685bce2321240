"""The Grassmannian Gr(n, p): planes spanned by the columns of X, with X^T X = I.

A point is any orthonormal basis X of its plane, shape (..., n, p); X and X @ R are the
same point for orthogonal R.  A tangent vector at X has shape (..., n, p) and X^T D = 0.
Every map below is an even function of the principal angles, so it is a function of p x p
matrices: no n x n matrix is formed, and a zero angle is not a special case.
Formulas: Edelman, Arias & Smith, SIAM J. Matrix Anal. Appl. 20 (1998), theorems 2.3-2.4.
"""

from collections.abc import Callable

import numpy as np

from bladegen.errors import GeometryError
from bladegen.support.arguments import numbers
from bladegen.support.arrays import Array

__all__ = [
    "align",
    "distance",
    "exp",
    "exp_factors",
    "karcher_mean",
    "log",
    "log_factors",
    "norm",
    "transport",
]

RIGHT_ANGLE = 1e-12  # cosine of a principal angle that counts as 90 degrees: rounding of X^T Y
MEAN_TOLERANCE = 1e-12  # mean tangent at the Karcher mean [rad]
MEAN_STEPS = 300


def align(X: Array, Y: Array) -> Array:
    """Return the basis of the plane of `Y` that lies closest to `X` (Procrustes).

    Parameters
    ----------
    X, Y : (..., n, p) arrays
        Orthonormal bases.

    Returns
    -------
    (..., n, p) array
        Y @ Q with orthogonal Q, such that X^T Y Q is symmetric and positive.
    """
    X, Y = _alike(X, Y)
    return Y @ _procrustes(X, Y)


def exp(X: Array, D: Array) -> Array:
    """Follow the geodesic that leaves `X` with velocity `D` for unit time.

    Parameters
    ----------
    X : (..., n, p) array
        Orthonormal basis of the starting plane.
    D : (..., n, p) array
        Tangent vector at `X`; its singular values are principal angles [rad].

    Returns
    -------
    (..., n, p) array
        Orthonormal basis of the end plane, continuous in `D` (theorem 2.3).
    """
    X, D = _alike(X, D)
    cosine, sinc = exp_factors(D.mT @ D)
    return X @ cosine + D @ sinc


def exp_factors(S2: Array) -> tuple[Array, Array]:
    """Return cos S and sin S / S for S^2 = D^T D, (..., p, p): the factors of X and D in `exp`."""
    return _apply(_cos, S2), _apply(_sinc, S2)


def log(X: Array, Y: Array) -> Array:
    """Return the tangent vector at `X` whose geodesic reaches `Y` in unit time.

    Parameters
    ----------
    X, Y : (..., n, p) arrays
        Orthonormal bases; the result does not depend on the basis of `Y`.

    Returns
    -------
    (..., n, p) array
        D with X^T D = 0 and exp(X, D) = align(X, Y).

    Raises
    ------
    GeometryError
        If a principal angle between the planes reaches 90 degrees.
    """
    X, Y = _alike(X, Y)
    G, H = log_factors(X.mT @ Y)
    D: Array = Y @ G - X @ H
    return D - X @ (X.mT @ D)  # rounding of the difference leaves the horizontal space


def log_factors(overlap: Array) -> tuple[Array, Array]:
    """Return the p x p matrices G and H with log(X, Y) = Y G - X H.

    Parameters
    ----------
    overlap : (..., p, p) array
        X^T Y.

    Raises
    ------
    GeometryError
        If a principal angle between the planes reaches 90 degrees.

    Notes
    -----
    With X^T Y = U c W^T, Q = W U^T and C = U c U^T, log = (Y Q - X C) f(C), so that
    G = W f(c) U^T and H = U c f(c) U^T.
    """
    U, cosines, Wt = _svd(overlap)
    if cosines.size and cosines.min() < RIGHT_ANGLE:
        raise GeometryError(
            "log: a principal angle between the shapes reaches 90 degrees "
            f"(smallest cosine {cosines.min():.1e}); it must stay below"
        )
    Ut_f = _angle_over_sine(cosines)[..., None] * U.mT
    return Wt.mT @ Ut_f, (U * cosines[..., None, :]) @ Ut_f


def distance(X: Array, Y: Array) -> Array:
    """Return the Riemannian distance [rad], the root sum of squared principal angles.

    Parameters
    ----------
    X, Y : (..., n, p) arrays
        Orthonormal bases; any principal angles up to 90 degrees.

    Returns
    -------
    (...) array
        Accurate for small angles too: sines come from the residual, not from cosines.
    """
    X, Y = _alike(X, Y)
    U, cosines, Wt = _svd(X.mT @ Y)
    residual = Y @ Wt.mT - (X @ U) * cosines[..., None, :]
    sines = np.linalg.svd(residual, compute_uv=False)[..., ::-1]
    return _root_sum(np.arctan2(sines, cosines) ** 2, axes=-1)


def norm(D: Array) -> Array:
    """Return the length of tangent vectors, shape (..., n, p) to (...)."""
    (D,) = _alike(D)
    return _root_sum(D * D, axes=(-2, -1))


def transport(V: Array, X: Array, Y: Array) -> Array:
    """Carry `V` by parallel transport along the geodesic from `X` to `Y`.

    Parameters
    ----------
    V : (..., n, p) array
        Tangent vector at `X`.
    X, Y : (..., n, p) arrays
        Orthonormal bases of the start and the end.

    Returns
    -------
    (..., n, p) array
        The tangent vector at the basis `Y`, with lengths and inner products kept
        (theorem 2.4).

    Raises
    ------
    GeometryError
        If a principal angle between the planes reaches 90 degrees.
    """
    V, X, Y = _alike(V, X, Y)
    D = log(X, Y)
    S2 = D.mT @ D
    along = D.mT @ V
    carried = V - (X @ _apply(_sinc, S2) + D @ _apply(_versine, S2)) @ along
    return carried @ _procrustes(X, Y).mT


def karcher_mean(
    points: Array, *, tolerance: float = MEAN_TOLERANCE, max_steps: int = MEAN_STEPS
) -> Array:
    """Return the point that minimises the sum of squared distances to `points`.

    Parameters
    ----------
    points : (m, n, p) array
        Orthonormal bases.
    tolerance : float
        Largest length of the mean tangent at the result [rad].
    max_steps : int
        Gradient steps of unit length before giving up.

    Returns
    -------
    (n, p) array
        Orthonormal basis of the mean.

    Raises
    ------
    GeometryError
        If the steps do not converge.
    """
    (points,) = _alike(points)
    if points.ndim != 3 or not len(points):
        raise GeometryError(f"points: got the shape {points.shape}, must be (m, n, p)")
    mean = np.linalg.svd(align(points[:1], points).mean(axis=0), full_matrices=False)
    X: Array = mean.U @ mean.Vh
    length = np.inf
    for _ in range(max_steps):
        step = log(X[None], points).mean(axis=0)
        length = float(norm(step))
        if length <= tolerance:
            return X
        X = np.linalg.qr(exp(X, step)).Q
    raise GeometryError(
        f"karcher_mean: not converged after {max_steps} steps: the mean tangent is "
        f"{length:.1e} rad, allowed is {tolerance:.1e}"
    )


def _alike(*given: Array) -> list[Array]:
    """Return bases or tangent vectors as arrays (..., n, p) of one n and p, or say they are not."""
    arrays = [numbers(values, "points", GeometryError, "(..., n, p) arrays") for values in given]
    shapes = {array.shape[-2:] for array in arrays}
    if len(shapes) > 1 or any(array.ndim < 2 for array in arrays):
        shown = " and ".join(str(array.shape) for array in arrays)
        raise GeometryError(f"points: got the shapes {shown}, must be (..., n, p) of one n and p")
    return arrays


def _procrustes(X: Array, Y: Array) -> Array:
    """Return the orthogonal Q that minimises |Y Q - X|."""
    U, _, Wt = _svd(X.mT @ Y)
    Q: Array = Wt.mT @ U.mT
    return Q


def _svd(A: Array) -> tuple[Array, Array, Array]:
    """Return U, s, V^T of p x p matrices; those of 2 x 2 by formula, ten times as fast.

    A = R(phi) diag(s1, s2) R(theta)^T with plane rotations R; a negative s2 is turned positive
    by a mirrored U.
    """
    if A.shape[-1] != 2:
        general = np.linalg.svd(A)
        return general.U, general.S, general.Vh
    (a, b), (c, d) = np.moveaxis(A, (-2, -1), (0, 1))
    turn, mirror = 0.5 * np.arctan2(c - b, a + d), 0.5 * np.arctan2(c + b, a - d)
    half_sum, half_difference = 0.5 * np.hypot(a + d, c - b), 0.5 * np.hypot(a - d, c + b)
    smaller = half_sum - half_difference
    phi, theta = mirror + turn, mirror - turn
    side = np.where(smaller < 0, -1.0, 1.0)
    U = _columns(np.cos(phi), np.sin(phi), -side * np.sin(phi), side * np.cos(phi))
    V = _columns(np.cos(theta), np.sin(theta), -np.sin(theta), np.cos(theta))
    return U, np.stack([half_sum + half_difference, np.abs(smaller)], axis=-1), V.mT


def _columns(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Return matrices with the columns (a, b) and (c, d)."""
    return np.stack([np.stack([a, c], axis=-1), np.stack([b, d], axis=-1)], axis=-2)


def _root_sum(squares: Array, axes: int | tuple[int, ...]) -> Array:
    root: Array = np.sqrt(np.sum(squares, axis=axes))
    return root


def _apply(f: Callable[[Array], Array], A: Array) -> Array:
    """Apply `f` to the eigenvalues of the symmetric matrices `A`, shape (..., p, p).

    For 2 x 2 matrices with eigenvalues m - d and m + d, f(A) is the mean of f there plus half
    their difference times (A - m) / d: no eigenvectors are needed.
    """
    if A.shape[-1] == 2:
        (a, b), (_, d) = np.moveaxis(A, (-2, -1), (0, 1))
        middle, half = 0.5 * (a + d), 0.5 * (a - d)
        reach = np.hypot(half, b)
        low, high = f(np.maximum(middle - reach, 0.0)), f(np.maximum(middle + reach, 0.0))
        rate = np.divide(high - low, 2.0 * reach, out=np.zeros_like(reach), where=reach > 0)
        mean = 0.5 * (low + high)
        return _columns(mean + rate * half, rate * b, rate * b, mean - rate * half)
    w, V = np.linalg.eigh(A)
    result: Array = (V * f(np.maximum(w, 0.0))[..., None, :]) @ V.mT
    return result


def _cos(squared: Array) -> Array:
    cosine: Array = np.cos(np.sqrt(squared))
    return cosine


def _sinc(squared: Array) -> Array:
    sinc: Array = np.sinc(np.sqrt(squared) / np.pi)
    return sinc


def _versine(squared: Array) -> Array:
    """(1 - cos s) / s^2 = sinc(s / 2)^2 / 2, which is 1/2 at zero."""
    return 0.5 * _sinc(squared / 4.0) ** 2


def _angle_over_sine(cosine: Array) -> Array:
    """arccos c / sin arccos c, which is 1 at c = 1; rounding above 1 counts as 1."""
    c = np.minimum(cosine, 1.0)
    sine = np.sqrt((1.0 - c) * (1.0 + c))
    ratio: Array = np.divide(np.arccos(c), sine, out=np.ones_like(c), where=sine > 0)
    return ratio
