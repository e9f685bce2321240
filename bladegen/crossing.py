"""Does a contour cross itself?  Proper crossings of segments, by orientation."""

import numpy as np

from bladegen.arrays import Array

__all__ = ["crossing_sections", "first_crossing"]

TOUCHING = 1e-14  # chord^2, twice a triangle's area: closed edges meet to rounding only
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
        Indices of the segments, the first pair found.  Segments that only touch, to
        rounding, do not cross.
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
    side[np.abs(side) <= TOUCHING] = 0.0
    return side


def crossing_sections(sections: Array) -> list[int]:
    """Return which sections cross themselves.

    Parameters
    ----------
    sections : (k, n, 2) array
        Trailing edge -> suction side -> leading edge (middle landmark) -> pressure side.

    Notes
    -----
    A section whose sides are both graphs over x with the suction side on top cannot cross
    itself; only the others are tested exactly.
    """
    middle = sections.shape[1] // 2
    suction, pressure = sections[:, middle::-1], sections[:, middle:]
    graphs = np.all(np.diff(suction[..., 0]) > 0, axis=1) & np.all(
        np.diff(pressure[..., 0]) > 0, axis=1
    )
    return [
        k
        for k in range(len(sections))
        if not (graphs[k] and _above(suction[k], pressure[k]))
        and first_crossing(sections[k]) is not None
    ]


def _above(upper: Array, lower: Array) -> bool:
    """Tell whether a graph lies above another where both are, their first point apart."""
    last = min(upper[-1, 0], lower[-1, 0])
    x = np.concatenate([upper[1:, 0], lower[1:, 0]])
    x = x[x <= last]
    over = np.interp(x, *upper.T) - np.interp(x, *lower.T)
    return bool(np.all(over >= 0))
