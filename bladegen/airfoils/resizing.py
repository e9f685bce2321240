"""Maps of GL2 that bring measured sections to unit chord and to a relative thickness.

With rows for points, ``points @ A + c``: a stretch normal to the chord line, which keeps leading
edge and trailing-edge midpoint, and a scaling.  No point of the Grassmannian is moved.
"""

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["LITTLE", "stretching"]

LITTLE = 0.02  # of a thickness; stretches by less make no sharp nose a round one


def stretching(start: Array, normal: Array, stretch: Array, reach: Array) -> tuple[Array, Array]:
    """Return the maps that stretch along a normal from a point, then bring a reach to unit chord.

    Parameters
    ----------
    start, normal : (k, 2) arrays
        A point of the chord line, and its unit normal.
    stretch, reach : (k,) arrays

    Returns
    -------
    A, c : (k, 2, 2), (k, 2) arrays
        ``points @ A + c``; the chord line stays but for the scaling.
    """
    lift = (stretch - 1.0)[..., None, None] * normal[..., :, None] * normal[..., None, :]
    scale = 1.0 / reach
    shift = -(start[..., None, :] @ lift)[..., 0, :] * scale[..., None]
    return scale[..., None, None] * (np.eye(2) + lift), shift
