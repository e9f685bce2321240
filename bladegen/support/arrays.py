"""Arrays as values: read-only float64 copies, so that a frozen dataclass stays frozen."""

from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["Array", "ArrayLike", "Indices", "Mask", "laid_out", "mapped", "readonly"]

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.int64]
ArrayLike = npt.ArrayLike


def readonly(values: Any) -> Array:
    """Return a read-only float64 copy of `values`, of any shape."""
    array = np.array(values, dtype=np.float64)
    array.flags.writeable = False
    return array


def laid_out(*arrays: Any) -> list[Any]:
    """Return arrays as compiled loops are compiled for, contiguous and not read-only.

    Numba compiles anew for arrays that lie otherwise, and sums otherwise.
    """
    return [np.require(array, requirements=["C", "W"]) for array in arrays]


def mapped(points: Array, A: Array, c: Array) -> Array:
    """Return points (..., n, 2) under affine maps of the plane, ``points @ A + c``.

    Parameters
    ----------
    points : (..., n, 2) array
        Rows are points, so maps act on the right.
    A, c : (..., 2, 2), (..., 2) arrays
        The maps.
    """
    lead = np.broadcast_shapes(points.shape[:-2], A.shape[:-2], c.shape[:-1])
    planes: Array = np.empty((2, *lead, points.shape[-2]))  # all x, then all y: quick to work with
    inner = tuple(range(1, planes.ndim - 1))
    np.matmul(A.mT, points.mT, out=planes.transpose(*inner, 0, -1))
    planes[0] += c[..., 0, None]
    planes[1] += c[..., 1, None]
    return planes.transpose(*inner, -1, 0)
