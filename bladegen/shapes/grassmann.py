"""The Grassmannian Gr(n, p): planes spanned by the columns of X, with X^T X = I.

A point is any orthonormal basis X of its plane, shape (..., n, p); X and X @ R are the
same point for orthogonal R.  A tangent vector at X has shape (..., n, p) and X^T D = 0.
Every map below is an even function of the principal angles, so it is a function of p x p
matrices: no n x n matrix is formed, and a zero angle is not a special case.
Formulas: Edelman, Arias & Smith, SIAM J. Matrix Anal. Appl. 20 (1998), theorems 2.3-2.4.
"""

import numpy as np

from bladegen.errors import GeometryError
from bladegen.shapes.small_matrices import (
    angle_over_sine,
    angle_over_tangent,
    angle_over_tangent_slope,
    apply,
    apply_rate,
    cos,
    sinc,
    svd,
    versine,
)
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
    "log_rate",
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
    return apply(cos, S2), apply(sinc, S2)


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
    U, cosines, Wt = svd(overlap)
    if cosines.size and cosines.min() < RIGHT_ANGLE:
        raise GeometryError(
            "log: a principal angle between the shapes reaches 90 degrees "
            f"(smallest cosine {cosines.min():.1e}); it must stay below"
        )
    Ut_f = angle_over_sine(cosines)[..., None] * U.mT
    return Wt.mT @ Ut_f, (U * cosines[..., None, :]) @ Ut_f


def log_rate(X: Array, Y: Array, E: Array) -> Array:
    """Return how `log(X, Y)` changes as `Y` moves with velocity `E`.

    Parameters
    ----------
    X, Y : (..., n, p) arrays
        Orthonormal bases, less than 90 degrees apart.
    E : (..., n, p) array
        Tangent vector at the basis `Y`.

    Returns
    -------
    (..., n, p) array
        Tangent vector at `X`: the differential of the logarithm, applied to `E`.

    Notes
    -----
    log = H f(H^T H) with H = Y (X^T Y)^-1 - X and f(s^2) = arctan s / s; the derivative of f of
    a matrix is that of Daletskii and Krein (Higham, Functions of Matrices (2008), theorem 3.11).
    """
    X, Y, E = _alike(X, Y, E)
    inverse = np.linalg.inv(X.mT @ Y)
    H = Y @ inverse - X
    rate = (E - Y @ (inverse @ (X.mT @ E))) @ inverse
    crossed = rate.mT @ H
    square, moved = H.mT @ H, crossed + crossed.mT
    D: Array = rate @ apply(angle_over_tangent, square)
    D = D + H @ apply_rate(angle_over_tangent, angle_over_tangent_slope, square, moved)
    return D - X @ (X.mT @ D)


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
    U, cosines, Wt = svd(X.mT @ Y)
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
    carried = V - (X @ apply(sinc, S2) + D @ apply(versine, S2)) @ along
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
    U, _, Wt = svd(X.mT @ Y)
    Q: Array = Wt.mT @ U.mT
    return Q


def _root_sum(squares: Array, axes: int | tuple[int, ...]) -> Array:
    root: Array = np.sqrt(np.sum(squares, axis=axes))
    return root
