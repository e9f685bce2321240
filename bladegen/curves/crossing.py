"""Does a contour cross itself?  Proper crossings of segments, by orientation."""

import numpy as np

from bladegen.curves.separation import graphs, ladders
from bladegen.support.arrays import Array

__all__ = ["crossing_sections", "first_crossing"]

TOUCHING = 1e-12  # chord^2, twice a triangle's area: edges that close are nearer than 1e-9 chord
RUN = 16  # segments in a run, whose boxes are compared first
CHUNK = 2_000  # pairs of runs tested at once: bounds memory to some tens of megabytes


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

    Notes
    -----
    Only segments of runs whose bounding boxes overlap are compared.
    """
    count = len(points) - 1
    runs = -(-count // RUN)
    at = np.minimum(np.arange(runs)[:, None] * RUN + np.arange(RUN), count - 1)
    start, end = points[at], points[at + 1]
    low = np.minimum(start, end).min(axis=1)
    high = np.maximum(start, end).max(axis=1)
    overlap = np.all((low[:, None] <= high) & (low <= high[:, None]), axis=-1)
    ones, others = np.nonzero(np.triu(overlap))
    for first in range(0, len(ones), CHUNK):
        one, other = ones[first : first + CHUNK], others[first : first + CHUNK]
        a, b = start[one][:, :, None], end[one][:, :, None]
        c, d = start[other][:, None], end[other][:, None]
        apart = (_side(a, b, c) * _side(a, b, d) < 0) & (_side(c, d, a) * _side(c, d, b) < 0)
        pairs, i, j = np.nonzero(apart)
        if pairs.size:
            k, m = at[one[pairs], i], at[other[pairs], j]
            best = np.lexsort((m, k))[0]
            return int(k[best]), int(m[best])
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
        Trailing edge -> suction side -> leading edge (middle landmark) -> pressure side,
        closed by a straight line over the trailing edge.

    Notes
    -----
    Most sections are proved sound all at once (`separation`); only the others are tested
    exactly.
    """
    unsure = np.flatnonzero(~ladders(sections))
    sound, crossing = graphs(sections[unsure])
    for i in np.flatnonzero(~sound & ~crossing):
        section = sections[unsure[i]]
        crossing[i] = first_crossing(np.concatenate([section, section[:1]])) is not None
    return [int(k) for k in unsure[crossing]]
