"""Segments between points to closed outlines.

Segments with a common point make chains; open chains (of shells that share no vertices, or of an
edge without a base) are joined at their nearest ends.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.support.arrays import Array, Indices

__all__ = ["Cut", "area_of", "outlines_of", "without_diagonals"]

SAME = 1e-7  # of an outline's extent; points nearer than this are one
WIDEST = 0.3  # of an outline's length: a gap wider than this is no edge without a base
JOINT = 1e-5  # of an outline's length: ends nearer than this are one point
INNER = 1e-3  # of the largest outline's area: smaller ones are crumbs
LEAST = 24  # points of an outline that has diagonals
FACET = np.radians(25.0)  # more than that is a corner proper
AROUND = 8  # points on either side, by which the outline's own turn is told


@dataclass(frozen=True, eq=False)
class Cut:
    """What a plane cuts out of a surface.

    Parameters
    ----------
    outline : (m, 2) array
        The largest closed outline, counter-clockwise in the plane's first two axes; empty if the
        plane meets nothing.
    gap : float
        The widest gap that was closed, in the outline's length.
    others : tuple of float
        Areas of the other outlines, in that of the largest.
    crossing : bool
        Whether an edge of the mesh has more than two triangles there.
    """

    outline: Array
    gap: float = 0.0
    others: tuple[float, ...] = ()
    crossing: bool = False


def area_of(outline: Array) -> float:
    """Return the area inside an outline (m, 2), positive if counter-clockwise."""
    x, y = outline.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def without_diagonals(outline: Array) -> Array:
    """Return an outline (m, 2) of facets without the corners that they alone make.

    Triangles of a grid have diagonals, which lie inside of a convex surface: where a plane meets
    them the outline turns the other way than it does on the whole.  Corners proper stay.
    """
    if len(outline) < LEAST:
        return outline
    before = outline - np.roll(outline, 1, axis=0)
    after = np.roll(before, -1, axis=0)
    turn = np.arctan2(
        before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], np.sum(before * after, axis=1)
    )
    facets = np.where(np.abs(turn) < FACET, turn, 0.0)
    ring = np.concatenate([facets[-AROUND:], facets, facets[:AROUND]])
    mean = np.lib.stride_tricks.sliding_window_view(ring, 2 * AROUND + 1).mean(axis=1)
    other = (facets * mean < 0.0) & (np.abs(facets) > np.abs(mean))
    neighbours = np.roll(other, 1) | np.roll(other, -1)
    kept: Array = outline[~other | neighbours]
    return kept


def outlines_of(points: Array, ends: Indices) -> Cut:
    """Return segments between points (m, 2) as closed outlines."""
    if not len(ends):
        return Cut(np.zeros((0, 2)))
    closed, open_, crossing = _chains(len(points), ends)
    found = [(points[chain], 0.0) for chain in closed]
    found += _joined([points[chain] for chain in open_ if len(chain) > 1])
    found = [(_distinct(outline), gap) for outline, gap in found if len(outline) > 2]
    found.sort(key=lambda one: -abs(area_of(one[0])))
    if not found or not area_of(found[0][0]):
        return Cut(np.zeros((0, 2)), crossing=crossing)
    outline, gap = found[0]
    area = area_of(outline)
    others = tuple(abs(area_of(other) / area) for other, _ in found[1:])
    others = tuple(one for one in others if one > INNER)
    return Cut(outline if area > 0 else outline[::-1], gap, others, crossing)


def _chains(count: int, ends: Indices) -> tuple[list[list[int]], list[list[int]], bool]:
    """Return chains of segments as lists of points: the closed, and the open ones."""
    one, other, crossing = _neighbours(count, ends)
    used = [False] * count
    closed: list[list[int]] = []
    open_: list[list[int]] = []
    starts = [i for i in range(count) if one[i] >= 0 > other[i]] + list(range(count))
    for start in starts:
        if used[start] or one[start] < 0:
            continue
        chain, place = [start], start
        used[start] = True
        while True:
            ahead = one[place]
            if used[ahead]:
                ahead = other[place]
                if ahead < 0 or used[ahead]:
                    break
            place = ahead
            used[place] = True
            chain.append(place)
        round_ = len(chain) > 2 and start in (one[place], other[place])
        (closed if round_ else open_).append(chain)
    return closed, open_, crossing


def _neighbours(count: int, ends: Indices) -> tuple[list[int], list[int], bool]:
    """Return up to two neighbours of each point, -1 where there is none, and whether one has more.

    Of more than two the first are kept, on both sides.
    """
    one, other = [-1] * count, [-1] * count
    crossing = False
    for a, b in ends.tolist():
        if a == b or b in (one[a], other[a]):
            continue
        if other[a] >= 0 or other[b] >= 0:
            crossing = True
            continue
        for here, there in ((a, b), (b, a)):
            if one[here] < 0:
                one[here] = there
            else:
                other[here] = there
    return one, other, crossing


def _joined(chains: list[Array]) -> list[tuple[Array, float]]:
    """Join open chains at their nearest ends, and close each; with the widest gap of each."""
    left = sorted(chains, key=lambda chain: -_length(chain))
    found = []
    while left:
        whole, widest = left.pop(0), 0.0
        while left:
            end = whole[-1]
            own = float(np.hypot(*(whole[0] - end)))
            away = np.array([[np.hypot(*(c[0] - end)), np.hypot(*(c[-1] - end))] for c in left])
            k, back = np.unravel_index(int(np.argmin(away)), away.shape)
            if own <= away[k, back] or away[k, back] > WIDEST * _length(whole):
                break
            chain = left.pop(int(k))
            widest = max(widest, float(away[k, back]))
            chain = chain[::-1] if back else chain
            if away[k, back] < JOINT * _length(whole):
                whole[-1] = 0.5 * (whole[-1] + chain[0])
                chain = chain[1:]
            whole = np.concatenate([whole, chain])
        length = _length(whole)
        widest = max(widest, float(np.hypot(*(whole[0] - whole[-1]))))
        found.append((whole, widest / length if length else 1.0))
    return found


def _length(chain: Array) -> float:
    return float(np.hypot(*np.diff(chain, axis=0).T).sum())


def _distinct(outline: Array) -> Array:
    """Drop points that repeat the one before them."""
    steps = np.hypot(*(outline - np.roll(outline, 1, axis=0)).T)
    kept: Array = outline[steps > SAME * float(np.ptp(outline, axis=0).max())]
    return kept
