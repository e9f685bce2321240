"""Maps of GL2 that bring measured sections to unit chord and to a relative thickness.

With rows for points, ``points @ A + c``: a stretch normal to the chord line, which keeps leading
edge and trailing-edge midpoint, and a scaling.  No point of the Grassmannian is moved.
"""

import numpy as np

from bladegen.support.arrays import Array, Mask

__all__ = ["RIVAL", "resizing", "stretching"]

RIVAL = 3e-2  # of the squared distance; lower peaks at landmarks no stretch makes the highest


def resizing(
    noses: Array,
    leading_edge: Array,
    trailing_edge: Array,
    thickness: Array | None,
    relative_thickness: Array | None,
) -> tuple[Array, Array, Mask]:
    """Return the maps of GL2 that bring measured sections to unit chord and thickness.

    Parameters
    ----------
    noses : (2, ..., 2) array
        The points that may be farthest from the trailing-edge midpoint.
    leading_edge, trailing_edge : (..., 2) arrays
        The ends of the chord line.
    thickness, relative_thickness : (...) arrays, optional
        The thickness it has, and the thickness over chord it shall have; None leaves it.

    Returns
    -------
    A, c : (..., 2, 2), (..., 2) arrays
        ``points @ A + c``; leading edge and trailing-edge midpoint stay but for the scaling.
    passed : (...) array of bool
        Where another nose may share the leading edge of the result or be it, so that the map is
        not the one sought.
    """
    line = trailing_edge - leading_edge
    length = np.hypot(line[..., 0], line[..., 1])
    along = line / length[..., None]
    ax, ay = along[..., 0], along[..., 1]
    normal = along[..., ::-1] * (-1.0, 1.0)
    far = noses - leading_edge
    fx, fy = far[..., 0], far[..., 1]
    x, y = fx * ax + fy * ay, fy * ax - fx * ay
    stretch, reach = np.ones_like(length), np.hypot(length - x, y)
    if thickness is not None and relative_thickness is not None:
        for _ in range(3):  # noses beside the chord line move with the stretch
            stretch = relative_thickness * reach.max(axis=0) / thickness
            reach = np.hypot(length - x, stretch * y)
    # the farthest point stays the farthest under the stretch but where another nose passes it,
    # whose peak moves along the contour meanwhile and gains by that
    passed = reach[0] - reach[1] < RIVAL * length
    passed &= (fx[0] != fx[1]) | (fy[0] != fy[1])
    return *stretching(leading_edge, normal, stretch, reach), passed


def stretching(start: Array, normal: Array, stretch: Array, reach: Array) -> tuple[Array, Array]:
    """Return the maps that stretch along a normal from a point, then bring noses to unit chord."""
    lift = (stretch - 1.0)[..., None, None] * normal[..., :, None] * normal[..., None, :]
    scale = 1.0 / reach.max(axis=0)
    shift = -(start[..., None, :] @ lift)[..., 0, :] * scale[..., None]
    return scale[..., None, None] * (np.eye(2) + lift), shift
