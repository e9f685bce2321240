"""How much room there is for a wall inside of sections, and walls that keep to it.

The room at a place is the radius of the largest circle inside the section that touches it there:
half the way to the other side where sides are even, the radius of curvature at a tight nose.  On
normals that end before it no point is met twice (the circles' centres are the medial axis, and
each point before it is nearest to one place of the outline alone: Blum, 1967), so that an inner
outline that keeps within a share of it crosses neither itself nor the outline.
"""

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["MOST", "kept_within", "lowered", "rooms"]

MOST = 0.9  # of the room, which no wall takes more of
FREE = 0.75  # of the room, up to which walls are as thick as they are
BASE = 9  # points on the base of a trailing edge
SLOPES = 0.5, 0.05  # of the room at most, along the outline and along the span
LEAST = 1e-9  # m, of a room: that of a sharp trailing edge is none
ROUNDING = 1e-12  # m
CHUNK = 4_000_000  # pairs of points at once


def rooms(outlines: Array, inward: Array) -> Array:
    """Return the radii (k, n) of circles inside outlines that touch them at each point.

    Parameters
    ----------
    outlines : (k, n, 3) array
        Points, each section in its plane, closed by a straight line.
    inward : (k, n, 3) array
        Unit normals in that plane.
    """
    share = np.linspace(0.0, 1.0, BASE)[1:-1, None]
    base = outlines[:, -1:] + share * (outlines[:, :1] - outlines[:, -1:])
    others = np.concatenate([outlines, base], axis=1)
    middle = outlines.mean(axis=1, keepdims=True)
    points, others = outlines - middle, others - middle
    squares, level = np.sum(others**2, axis=-1), np.sum(points * inward, axis=-1)
    k, n = level.shape
    found = np.empty((k, n))
    for some in np.array_split(np.arange(k), -(-k * n * n // CHUNK)):
        to = others[some].mT
        ahead = inward[some] @ to - level[some, :, None]
        apart = squares[some, :n, None] + squares[some, None] - 2.0 * points[some] @ to
        with np.errstate(divide="ignore", invalid="ignore"):
            radius = np.where(ahead > ROUNDING, 0.5 * apart / ahead, np.inf)
        radius[apart < ROUNDING] = 0.0  # the other corner of a sharp trailing edge
        radius[:, np.arange(n), np.arange(n)] = np.inf
        found[some] = radius.min(axis=-1)
    return np.maximum(found, 0.0)


def lowered(room: Array, along: Array, span: Array) -> Array:
    """Return a room (k, n) nowhere larger than it was, which changes by `SLOPES` at most.

    Parameters
    ----------
    room : (k, n) array
        [m]
    along : (k, n) array
        Lengths along the outlines [m].
    span : (k,) array
        Places along the span [m].
    """
    for ways, slope, axis in ((along, SLOPES[0], 1), (span[:, None], SLOPES[1], 0)):
        there = np.minimum.accumulate(room - slope * ways, axis=axis) + slope * ways
        back = np.flip(np.minimum.accumulate(np.flip(room + slope * ways, axis), axis=axis), axis)
        room = np.minimum(there, back - slope * ways)
    return room


def kept_within(depth: Array, room: Array) -> Array:
    """Return depths [m] that take no more than `MOST` of a room: the same up to `FREE` of it."""
    slack, room = MOST - FREE, np.maximum(room, LEAST)
    over = np.maximum(depth / room - FREE, 0.0) / slack
    return np.where(over > 0.0, room * (FREE + slack * np.tanh(over)), depth)
