"""Landmark-affine standardisation: a shape is a point X of Gr(n, 2) and an affine map.

Rows are landmarks, so maps act on the right: ``xy = X @ M + b`` with X^T X = I and the
columns of X summing to zero (section "Affine deformations" of the paper).  Shapes may have
any leading axes: xy and X are (..., n, 2), M is (..., 2, 2), b is (..., 2).
"""

import numpy as np

from bladegen.errors import GeometryError
from bladegen.shapes.small_matrices import exp
from bladegen.support.arguments import numbers
from bladegen.support.arrays import Array, mapped

__all__ = [
    "camber",
    "chord",
    "cluster",
    "from_polar",
    "polar",
    "restore",
    "rotation",
    "standardise",
    "thickness",
    "twist",
]

FLAT = 1e-9  # ratio of singular values at which a shape counts as a line


def standardise(xy: Array) -> tuple[Array, Array, Array]:
    """Split shapes into standardised landmarks and the affine map that restores them.

    Parameters
    ----------
    xy : (..., n, 2) array
        Landmarks.

    Returns
    -------
    X : (..., n, 2) array
        Orthonormal, centred columns: the polar factor of the centred landmarks, which is the
        orthonormal basis that lies closest to them.
    M : (..., 2, 2) array
        Symmetric and positive definite here; any M @ rotation would do.
    b : (..., 2) array
        Centre of the landmarks.

    Raises
    ------
    GeometryError
        If the landmarks of a shape lie on a line.
    """
    xy = numbers(xy, "landmarks", GeometryError)
    if xy.ndim < 2 or xy.shape[-1] != 2 or xy.shape[-2] < 3 or not np.isfinite(xy).all():
        raise GeometryError(
            f"landmarks: got the shape {xy.shape}, must be (..., n, 2) with n from 3, and finite"
        )
    b = xy.mean(axis=-2)
    U, s, Vt = np.linalg.svd(xy - b[..., None, :], full_matrices=False)
    if np.any(s[..., -1] <= FLAT * s[..., 0]):
        raise GeometryError("standardise: the landmarks of a shape lie on a line")
    return U @ Vt, (Vt.mT * s[..., None, :]) @ Vt, b


def restore(X: Array, M: Array, b: Array) -> Array:
    """Return the landmarks ``X @ M + b``, the inverse of `standardise`."""
    return mapped(X, M, b)


def cluster(X: Array, M: Array) -> tuple[Array, Array]:
    """Rotate each representative onto its neighbour, from the tip to the hub (Procrustes).

    Parameters
    ----------
    X : (..., s, n, 2) array
        Standardised shapes at s stations, hub first.
    M : (..., s, 2, 2) array
        Their linear maps.

    Returns
    -------
    X, M : arrays of the same shapes
        The same physical shapes, X @ M unchanged; the tip keeps its representative, and each
        X[k]^T X[k + 1] is symmetric and positive, so that M varies as little as it can.
    """
    X, M = X.copy(), M.copy()
    for k in range(X.shape[-3] - 2, -1, -1):
        U, _, Vt = np.linalg.svd(X[..., k, :, :].mT @ X[..., k + 1, :, :])
        R = U @ Vt
        X[..., k, :, :] = X[..., k, :, :] @ R
        M[..., k, :, :] = R.mT @ M[..., k, :, :]
    return X, M


def polar(M: Array) -> tuple[Array, Array]:
    """Split linear maps into a rotation angle and the logarithm of a stretch.

    Parameters
    ----------
    M : (..., 2, 2) array
        Maps with positive determinant.

    Returns
    -------
    angle : (...) array
        Of the rotation R in M = R @ S with S symmetric positive definite [rad].
    log_stretch : (..., 2, 2) array
        Symmetric logarithm of S.  S acts on the physical axes, so it does not depend on the
        representative; a change of representative shifts the angle by a constant.

    Raises
    ------
    GeometryError
        If a map is singular or mirrors.
    """
    if np.any(np.linalg.det(M) <= 0):
        raise GeometryError("polar: a linear map is singular or mirrors the shape")
    U, s, Vt = np.linalg.svd(M)
    R = U @ Vt
    return np.arctan2(R[..., 1, 0], R[..., 0, 0]), (Vt.mT * np.log(s)[..., None, :]) @ Vt


def from_polar(angle: Array, log_stretch: Array) -> Array:
    """Return R(angle) @ exp(log_stretch), the inverse of `polar`; never singular."""
    M: Array = rotation(angle) @ exp(log_stretch)
    return M


def rotation(angle: Array) -> Array:
    """Return [[cos, -sin], [sin, cos]], shape (..., 2, 2)."""
    c, s = np.cos(angle), np.sin(angle)
    result: Array = np.empty((*c.shape, 2, 2))
    result[..., 0, 0], result[..., 0, 1], result[..., 1, 0], result[..., 1, 1] = c, -s, s, c
    return result


def thickness(s: Array) -> Array:
    """Return diag(1, s), the paper's subgroup (i): thickness times s; identity at 1."""
    return _diagonal(np.ones_like(s), s)


def camber(s: Array) -> Array:
    """Return 2 diag(1 - s, s), the paper's (ii): camber and thickness against chord.

    Identity at 1/2, meaningful in (0, 1).
    """
    return _diagonal(2.0 * (1.0 - s), 2.0 * s)


def chord(s: Array) -> Array:
    """Return diag(s, 1), the paper's (iii): chord times s; identity at 1."""
    return _diagonal(s, np.ones_like(s))


def twist(angle: Array) -> Array:
    """Return the paper's (iv), [[cos, -sin], [sin, cos]]: rotation by `angle` [rad].

    Acting on rows from the right it turns shapes clockwise for positive angles, which is
    leading edge up: nose toward the suction side.
    """
    return rotation(angle)


def _diagonal(a: Array, d: Array) -> Array:
    zero = np.zeros_like(a)
    return np.stack([np.stack([a, zero], axis=-1), np.stack([zero, d], axis=-1)], axis=-2)
