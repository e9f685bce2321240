"""Does a contour cross itself?  Proper crossings of segments, by orientation."""

import numpy as np

from bladegen.arrays import Array

__all__ = ["first_crossing"]

CHUNK = 1_000_000  # pairs of segments tested at once: bounds memory to some tens of megabytes


def first_crossing(points: Array) -> tuple[int, int] | None:
    """Return two segments of an open polyline that cross, or None.

    Parameters
    ----------
    points : (m, 2) array
        Vertices; segment i runs from vertex i to i + 1.

    Returns
    -------
    (int, int) or None
        Indices of the segments, the first pair found.  Segments that only touch do not cross.
    """
    start, end = points[:-1], points[1:]
    count = len(start)
    rows = max(1, CHUNK // count)
    for first in range(0, count, rows):
        a, b = start[first : first + rows, None], end[first : first + rows, None]
        apart = (_side(a, b, start) * _side(a, b, end) < 0) & (
            _side(start, end, a) * _side(start, end, b) < 0
        )
        i, j = np.nonzero(apart)
        if i.size:
            return int(i[0]) + first, int(j[0])
    return None


def _side(a: Array, b: Array, p: Array) -> Array:
    """Return on which side of the line from a to b each p lies."""
    along, to = b - a, p - a
    side: Array = along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0]
    return side
