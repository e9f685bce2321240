"""Products of many vectors in space (..., 3), coordinate by coordinate.

The same numbers as `numpy.cross`, `numpy.linalg.norm` and sums over the last axis, which walk along
three numbers at a time, in a fifth of their time.
"""

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["cross", "dots", "lengths"]


def cross(one: Array, other: Array) -> Array:
    """Return the cross products (..., 3) of vectors."""
    shape = np.broadcast_shapes(one.shape[:-1], other.shape[:-1])
    result = np.empty((3, *shape))  # all x, all y, all z: quick to work with
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        np.multiply(one[..., j], other[..., k], out=result[i])
        result[i] -= one[..., k] * other[..., j]
    return np.moveaxis(result, 0, -1)


def dots(one: Array, other: Array) -> Array:
    """Return the inner products (...) of vectors."""
    result: Array = one[..., 0] * other[..., 0]
    result += one[..., 1] * other[..., 1]
    result += one[..., 2] * other[..., 2]
    return result


def lengths(vectors: Array) -> Array:
    """Return the lengths (...) of vectors."""
    return np.sqrt(dots(vectors, vectors))
