"""A closed outline to landmarks: where its trailing edge opens, where its nose is.

Outlines are counter-clockwise with x toward the trailing edge and y toward the suction side.  The
edge is open between the first and the last corner of the outline's rear; it is a point where there
is one corner, or none: then the hindmost point, as on a round root.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.airfoils.landmarks import contour
from bladegen.support.arrays import Array, Indices

__all__ = [
    "Outline",
    "circle_of",
    "edge_at",
    "edge_of",
    "fullness",
    "is_round",
    "landmarks_of",
    "middle_of",
]

REAR = 0.25  # of the extent: corners farther ahead are no trailing edge
CORNER = np.radians(25.0)  # facets of a round edge turn by less
SLANTED = 0.06  # of the extent along the chord: a base slants by less; readers want below a tenth
SLIGHT, ALONE = np.radians(3.0), 5.0  # or more than this, and so many times the turns around
AROUND = 8  # points on either side
WINDOWS = (1e-5, 1e-4, 1e-3)  # of the extent, over which a corner may be rounded
ROUND = 0.015  # of the mean radius: outlines nearer to a circle than this are round
SAME = 1e-9  # rad between two points of an outline that are one


@dataclass(frozen=True, eq=False)
class Outline:
    """An outline from its suction side's end to its pressure side's, (m, 2)."""

    points: Array
    cornered: bool

    @property
    def edge(self) -> Array:
        """The middle of the trailing edge."""
        return np.asarray(0.5 * (self.points[0] + self.points[-1]))

    @property
    def width(self) -> float:
        """How far its ends lie apart."""
        return float(np.hypot(*(self.points[0] - self.points[-1])))


def is_round(outline: Array, within: float = ROUND) -> bool:
    """Tell whether an outline is a circle, but for a share of its radius."""
    centre, radius = circle_of(outline)
    away = np.hypot(*(outline - centre).T)
    return bool(np.all(np.abs(away - radius) < within * radius))


def circle_of(points: Array) -> tuple[Array, float]:
    """Return centre and radius of the circle through points (m, 2), by least squares (Kasa)."""
    middle = points.mean(axis=0)
    rows = np.column_stack([2.0 * (points - middle), np.ones(len(points))])
    x, y, c = np.linalg.lstsq(rows, np.sum((points - middle) ** 2, axis=1), rcond=None)[0]
    return np.array([middle[0] + x, middle[1] + y]), float(np.sqrt(max(c + x * x + y * y, 0.0)))


def edge_of(outline: Array, along: Array) -> Outline:
    """Open an outline at its trailing edge.

    Parameters
    ----------
    outline : (m, 2) array
        Closed, counter-clockwise.
    along : (2,) array
        Unit vector from leading to trailing edge, roughly.
    """
    reach = outline @ along
    extent = float(np.ptp(reach))
    rear = reach > reach.max() - REAR * extent
    for window in WINDOWS:
        turns = _turns(outline, window * extent)
        corners = np.flatnonzero(rear & (turns > CORNER))
        if window == WINDOWS[0] and len(corners) < 2:
            slight = (turns > SLIGHT) & (turns > ALONE * _around(turns))
            corners = np.union1d(corners, np.flatnonzero(rear & slight))
        if corners.size:
            return _opened(outline, _highest(outline, corners, turns, 2.0 * window * extent), reach)
    return Outline(_rolled(outline, int(np.argmax(reach)), closed=True), False)


def _opened(outline: Array, corners: Indices, reach: Array) -> Outline:
    """Open an outline between the first and the last of its corners."""
    front = int(np.argmin(reach))
    order = np.sort((corners - front) % len(outline))  # from the nose along the pressure side
    first, last = (int(order[0]) + front) % len(outline), (int(order[-1]) + front) % len(outline)
    slant = reach[first] - reach[last]
    if abs(slant) > SLANTED * float(np.ptp(reach)):  # a side, not a base
        first = last = first if slant > 0.0 else last
    if first == last:
        return Outline(_rolled(outline, first, closed=True), True)
    rolled = np.roll(outline, -last, axis=0)
    return Outline(rolled[: (first - last) % len(outline) + 1], True)


def _highest(outline: Array, corners: Indices, turns: Array, apart: float) -> Indices:
    """Return of corners that lie within a distance of sharper ones only the sharper."""
    order = corners[np.argsort(-turns[corners], kind="stable")]
    kept: list[int] = []
    for i in order.tolist():
        if all(np.hypot(*(outline[i] - outline[j])) > apart for j in kept):
            kept.append(i)
    return np.array(kept)


def _rolled(outline: Array, start: int, *, closed: bool) -> Array:
    rolled = np.roll(outline, -start, axis=0)
    return np.concatenate([rolled, rolled[:1]]) if closed else rolled


def edge_at(outline: Array, angle: float, width: float) -> Outline:
    """Open an outline where a ray from its middle leaves it, over a width that the ray halves.

    For edges that cannot be seen: `angle` is that of the ray from the x axis [rad].
    """
    away = outline - middle_of(outline)
    around = np.arctan2(*(away @ _turn(angle)).T[::-1])
    reach = float(np.hypot(*away[np.argmin(np.abs(around))]))
    half = float(np.arctan2(0.5 * width, reach))
    order = np.argsort(around)
    ring = np.concatenate([around[order] - 2.0 * np.pi, around[order], around[order] + 2.0 * np.pi])
    points = np.tile(outline[order], (3, 1))
    ends = np.stack([np.interp([half, -half], ring, points[:, k]) for k in (0, 1)], axis=1)
    front = np.flatnonzero(np.abs(around) > half * (1.0 + SAME) + SAME)
    front = front[np.argsort(around[front] % (2.0 * np.pi))]
    return Outline(np.concatenate([ends[:1], outline[front], ends[1:]]), False)


def _turn(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


def middle_of(outline: Array) -> Array:
    """Return the centroid of the area inside an outline (m, 2)."""
    x, y = (outline - outline[0]).T
    u, v = np.roll(x, -1), np.roll(y, -1)
    cross = x * v - u * y
    area = 3.0 * cross.sum()
    moments = np.array([np.sum((x + u) * cross), np.sum((y + v) * cross)])
    return np.asarray(moments / area + outline[0])


def fullness(outline: Array) -> float:
    """Return the least width of an outline over its largest."""
    angle = np.linspace(0.0, np.pi, 37)[:-1]
    sizes = np.ptp(outline @ np.stack([np.cos(angle), np.sin(angle)]), axis=0)
    return float(sizes.min() / sizes.max())


def _turns(outline: Array, window: float) -> Array:
    """Return by what angle an outline turns to the left at each point, over a window each way."""
    steps = np.roll(outline, -1, axis=0) - outline
    lengths = np.hypot(*steps.T)
    arc = np.concatenate([[0.0], np.cumsum(lengths)])
    around = np.concatenate([arc[:-1] - arc[-1], arc, arc[1:] + arc[-1]])
    ring = np.concatenate([outline, outline, outline, outline[:1]])

    def at(place: Array) -> Array:
        return np.stack([np.interp(place, around, ring[:, k]) for k in (0, 1)], axis=1)

    before, after = outline - at(arc[:-1] - window), at(arc[:-1] + window) - outline
    turn: Array = np.arctan2(
        before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], np.sum(before * after, axis=1)
    )
    return turn


def _around(turns: Array) -> Array:
    """Return the median size of the turns about each point of an outline."""
    ring = np.abs(np.concatenate([turns[-AROUND:], turns, turns[:AROUND]]))
    near = np.lib.stride_tricks.sliding_window_view(ring, 2 * AROUND + 1)
    median: Array = np.median(near, axis=1)
    return median


def landmarks_of(outline: Outline, u: Array, fairing: float | None) -> Array:
    """Return landmarks (n, 2) of an outline at parameters (n,), faired within a distance."""
    points = outline.points
    origin, extent = points.min(axis=0), float(np.ptp(points, axis=0).max())
    share = None if fairing is None else min(fairing / extent, 1e-2)
    placed = contour((points - origin) / extent, fairing=share).landmarks(u)
    return np.asarray(placed * extent + origin)
