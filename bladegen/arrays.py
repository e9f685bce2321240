"""Arrays as values: read-only float64 copies, so that a frozen dataclass stays frozen."""

from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["Array", "ArrayLike", "Indices", "Mask", "readonly"]

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.int64]
ArrayLike = npt.ArrayLike


def readonly(values: Any) -> Array:
    """Return a read-only float64 copy of `values`, of any shape."""
    array = np.array(values, dtype=np.float64)
    array.flags.writeable = False
    return array
