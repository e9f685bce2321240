"""Functions and singular values of small matrices: by formula for 2 x 2, many at once."""

from collections.abc import Callable

import numpy as np

from bladegen.support.arrays import Array

__all__ = [
    "angle_over_sine",
    "angle_over_tangent",
    "angle_over_tangent_slope",
    "apply",
    "apply_rate",
    "cos",
    "exp",
    "sinc",
    "svd",
    "versine",
]

SMALL = 1e-3  # below it a series of four terms is exact to 1e-12
NEAR = 1e-5  # eigenvalues nearer than this have the slope between them: exact to 1e-11


def svd(A: Array) -> tuple[Array, Array, Array]:
    """Return U, s, V^T of p x p matrices; those of 2 x 2 by formula, ten times as fast.

    A = R(phi) diag(s1, s2) R(theta)^T with plane rotations R; a negative s2 is turned positive
    by a mirrored U.
    """
    if A.shape[-1] != 2:
        general = np.linalg.svd(A)
        return general.U, general.S, general.Vh
    a, b, c, d = A[..., 0, 0], A[..., 0, 1], A[..., 1, 0], A[..., 1, 1]
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
    result: Array = np.empty((*a.shape, 2, 2))
    result[..., 0, 0], result[..., 0, 1], result[..., 1, 0], result[..., 1, 1] = a, c, b, d
    return result


def apply(f: Callable[[Array], Array], A: Array) -> Array:
    """Apply `f` to the eigenvalues of the symmetric matrices `A`, shape (..., p, p).

    For 2 x 2 matrices with eigenvalues m - d and m + d, f(A) is the mean of f there plus half
    their difference times (A - m) / d: no eigenvectors are needed.
    """
    if A.shape[-1] == 2:
        a, b, d = A[..., 0, 0], A[..., 0, 1], A[..., 1, 1]
        middle, half = 0.5 * (a + d), 0.5 * (a - d)
        reach = np.hypot(half, b)
        low, high = f(np.maximum(middle - reach, 0.0)), f(np.maximum(middle + reach, 0.0))
        rate = np.divide(high - low, 2.0 * reach, out=np.zeros_like(reach), where=reach > 0)
        mean = 0.5 * (low + high)
        return _columns(mean + rate * half, rate * b, rate * b, mean - rate * half)
    w, V = np.linalg.eigh(A)
    result: Array = (V * f(np.maximum(w, 0.0))[..., None, :]) @ V.mT
    return result


def apply_rate(
    f: Callable[[Array], Array], slope: Callable[[Array], Array], A: Array, change: Array
) -> Array:
    """Return how `apply(f, A)` changes as A changes at the symmetric rate `change`.

    In A's eigenvectors each entry is multiplied by the divided difference of f between its two
    eigenvalues (Daletskii and Krein); `slope` is f's derivative.
    """
    w, V = np.linalg.eigh(A)
    apart = w[..., :, None] - w[..., None, :]
    middle = 0.5 * (w[..., :, None] + w[..., None, :])
    near = np.abs(apart) < NEAR
    values = f(np.maximum(w, 0.0))
    differences = values[..., :, None] - values[..., None, :]
    divided = np.where(
        near, slope(np.maximum(middle, 0.0)), differences / np.where(near, 1.0, apart)
    )
    result: Array = V @ (divided * (V.mT @ change @ V)) @ V.mT
    return result


def exp(A: Array) -> Array:
    """Return the exponentials of the symmetric matrices `A`, shape (..., 2, 2).

    With eigenvalues m - d and m + d that is e^m times cosh d plus sinh d / d times A - m.
    """
    a, b, d = A[..., 0, 0], A[..., 0, 1], A[..., 1, 1]
    half, scale = 0.5 * (a - d), np.exp(0.5 * (a + d))
    reach = np.hypot(half, b)
    mean = scale * np.cosh(reach)
    rate = scale * np.divide(np.sinh(reach), reach, out=np.ones_like(reach), where=reach > 0)
    return _columns(mean + rate * half, rate * b, rate * b, mean - rate * half)


def cos(squared: Array) -> Array:
    cosine: Array = np.cos(np.sqrt(squared))
    return cosine


def sinc(squared: Array) -> Array:
    sinc: Array = np.sinc(np.sqrt(squared) / np.pi)
    return sinc


def versine(squared: Array) -> Array:
    """(1 - cos s) / s^2 = sinc(s / 2)^2 / 2, which is 1/2 at zero."""
    return 0.5 * sinc(squared / 4.0) ** 2


def angle_over_sine(cosine: Array) -> Array:
    """arccos c / sin arccos c, which is 1 at c = 1; rounding above 1 counts as 1."""
    c = np.minimum(cosine, 1.0)
    sine = np.sqrt((1.0 - c) * (1.0 + c))
    ratio: Array = np.divide(np.arccos(c), sine, out=np.ones_like(c), where=sine > 0)
    return ratio


def angle_over_tangent(squared: Array) -> Array:
    """arctan t / t, which is 1 at zero, of t squared."""
    t = np.sqrt(squared)
    ratio: Array = np.divide(np.arctan(t), t, out=np.ones_like(t), where=t > 0)
    return ratio


def angle_over_tangent_slope(squared: Array) -> Array:
    """The derivative of `angle_over_tangent` in t squared, -1/3 at zero."""
    x = np.where(squared < SMALL, 1.0, squared)
    series = -1.0 / 3.0 + squared * (2.0 / 5.0 - squared * (3.0 / 7.0 - squared * (4.0 / 9.0)))
    direct = (1.0 / (1.0 + x) - angle_over_tangent(x)) / (2.0 * x)
    slope: Array = np.where(squared < SMALL, series, direct)
    return slope
