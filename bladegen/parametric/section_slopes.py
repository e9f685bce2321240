"""Compiled: derivatives of what a section measures, and of the map that brings it to size.

A section is linear in coefficients c (F, 2), so each measure has a gradient (F, 2).  The farthest
point and the thickest place are extremal: their values change as if they stayed where they are, and
where they move to follows from the condition that puts them there.  Where many points are nearly
as far, the level above which they count follows from theirs (`fronts`).

A map to size is ``s (1 + l n n')`` about the chord line, with n normal to it: a scale s, a lift l
and a direction.  They are implicit functions of the raw section and of the relative thickness, by
three conditions,

    n turns as the chord line of the raw section does,

and of the section Q that comes out the reach stays 1, and the thickness is the one asked for.
Their derivatives solve three linear equations, however the map was found.  Where the map keeps the
chord line, that of Q turns as n does, and the raw section need not be measured.
"""

from math import sqrt

import numpy as np

from bladegen.blade.variants.nose_measures import (
    leveled,
    mean_weights,
    middle_of,
    rival_weights,
    rivals,
    share_of,
    squared,
)
from bladegen.blade.variants.section_measures import (
    Section,
    along_contour,
    basis,
    cell_of,
    highest,
    peak,
    thickest,
)
from bladegen.curves.plane_maps import Numbers, distance, inverted
from bladegen.support.arrays import Array
from bladegen.support.compiled import compiled

__all__ = ["LEAD_X", "LEAD_Y", "REACH", "THICKNESS", "gradients", "sized_slopes", "turning"]

LEAD_X, LEAD_Y, REACH, THICKNESS = range(4)  # rows of `gradients`


@compiled
def nose_gradient(
    s: Section, values: Array, nose: Numbers, edge: Numbers, phi: Array, rows: Array
) -> None:
    """Fill the gradients (4, F, 2) of the farthest point's x, y, u and squared distance."""
    basis(s, values, nose[2], cell_of(s.u, nose[2], len(s.u) // 2), phi)
    x1, y1, x2, y2 = along_contour(s, phi)
    x, y = nose[0] - edge[0], nose[1] - edge[1]
    bending = x1 * x1 + y1 * y1 + x * x2 + y * y2
    for f in range(len(s.c)):
        own = phi[0, f] - 0.5 * (values[f, 0] + values[f, -1])
        ux = -(own * x1 + x * phi[1, f]) / bending
        uy = -(own * y1 + y * phi[1, f]) / bending
        rows[0, f, 0] = phi[0, f] + x1 * ux
        rows[0, f, 1] = x1 * uy
        rows[1, f, 0] = y1 * ux
        rows[1, f, 1] = phi[0, f] + y1 * uy
        rows[2, f, 0], rows[2, f, 1] = ux, uy
        rows[3, f, 0], rows[3, f, 1] = 2.0 * x * own, 2.0 * y * own


@compiled
def mean_gradient(
    s: Section,
    values: Array,
    ends: tuple[Numbers, Numbers],
    first: int,
    level: float,
    weights: Array,
    rows: Array,
) -> None:
    """Fill gradients (3, F, 2): x and y of the mean of many points, and what rivals the farthest.

    `ends` are the edge and what `mean_weights` returns with its `weights`; the third lacks what
    the farthest point's own gradients add (`rival_weights`).
    """
    edge, mean = ends
    far = sqrt(mean[0] * mean[0] + mean[1] * mean[1])
    ax, ay = mean[0] / far, mean[1] / far
    for f in range(len(s.c)):
        end, own = 0.5 * (values[f, 0] + values[f, -1]), 0.0
        for q in range(3):
            rows[q, f, 0] = rows[q, f, 1] = 0.0
        for i in range(weights.shape[1]):
            if weights[3, i] > 0.0 or weights[2, i] > 0.0:
                at = first + i
                value = values[f, at] - end
                own += weights[3, i] * value
                dx = 2.0 * value * (s.points[0, at] - edge[0]) / level
                dy = 2.0 * value * (s.points[1, at] - edge[1]) / level
                for q in range(3):
                    rows[q, f, 0] += weights[q, i] * dx
                    rows[q, f, 1] += weights[q, i] * dy
        own *= mean[2]
        rows[0, f, 0] += own * ay * ay + end
        rows[0, f, 1] -= own * ax * ay
        rows[1, f, 0] -= own * ax * ay
        rows[1, f, 1] += own * ax * ax + end


@compiled
def gradients(s: Section, values: Array, work: Array, rows: Array, spare: Array) -> Numbers:
    """Fill gradients (4, F, 2): the leading edge's x and y, the reach, and the thickness.

    `spare` (2, 4, F, 2) is room.  Returned are x and y of the leading edge and of the
    trailing-edge midpoint.
    """
    edge = middle_of(s.points)
    squares, first = squared(s.points, edge, (1.0, 0.0, 0.0, 1.0), work)
    best = highest(squares)[0]
    phi, psi = spare[1, :3, :, 0], spare[1, :3, :, 1]
    one = peak(s, edge, best + first)
    lead, top = (one[0], one[1]), (one[0] - edge[0]) ** 2 + (one[1] - edge[1]) ** 2
    share, rate = share_of(rivals(s.u, squares, first, one[2], top)[1])
    if share < 1.0:
        nose_gradient(s, values, one, edge, phi, rows)
    if share > 0.0:
        other, weights = spare[0], np.empty((4, len(squares)))
        level = leveled(s.u, squares, first, squares[best])
        mean = mean_weights(s, edge, squares, first, level, weights)
        of_top, of_place = rival_weights(s.u, squares, first, one[2], top, weights[2])
        mean_gradient(s, values, (edge, mean), first, level, weights, other)
        x, y = edge[0] + mean[0], edge[1] + mean[1]
        for f in range(len(s.c)):
            for j in range(2):
                if share == 1.0:
                    rows[0, f, j], rows[1, f, j] = other[0, f, j], other[1, f, j]
                else:
                    moved = level * other[2, f, j]
                    moved = rate * (moved + of_top * rows[3, f, j] + of_place * rows[2, f, j])
                    rows[0, f, j] += share * (other[0, f, j] - rows[0, f, j])
                    rows[1, f, j] += share * (other[1, f, j] - rows[1, f, j])
                    rows[0, f, j] += moved * (x - one[0])
                    rows[1, f, j] += moved * (y - one[1])
        lead = one[0] + share * (x - one[0]), one[1] + share * (y - one[1])
    length = distance(lead, edge)
    ax, ay = (edge[0] - lead[0]) / length, (edge[1] - lead[1]) / length
    for f in range(len(s.c)):
        end = 0.5 * (values[f, 0] + values[f, -1])
        rows[REACH, f, 0] = ax * (end - rows[LEAD_X, f, 0]) - ay * rows[LEAD_Y, f, 0]
        rows[REACH, f, 1] = ay * (end - rows[LEAD_Y, f, 1]) - ax * rows[LEAD_X, f, 1]
    height, upper, lower = thickest(s, (ax, ay), work)
    basis(s, values, upper, cell_of(s.u, upper, len(s.u) // 4), phi)
    basis(s, values, lower, cell_of(s.u, lower, 3 * len(s.u) // 4), psi)
    x1, y1, _, _ = along_contour(s, psi)
    rate = (y1 * ax - x1 * ay) / (x1 * ax + y1 * ay)
    for f in range(len(s.c)):
        across = phi[0, f] - psi[0, f]
        tx, ty = turning(rows, values, f, (ax, ay, length))
        rows[THICKNESS, f, 0] = across * (-ay - rate * ax) - rate * height * tx
        rows[THICKNESS, f, 1] = across * (ax - rate * ay) - rate * height * ty
    return lead[0], lead[1], edge[0], edge[1]


@compiled
def turning(rows: Array, values: Array, f: int, line: Numbers) -> Numbers:
    """Return the gradient (2,) of the chord line's angle in a feature's coefficients."""
    ax, ay, length = line
    end = 0.5 * (values[f, 0] + values[f, -1])
    x = -ay * (end - rows[LEAD_X, f, 0]) - ax * rows[LEAD_Y, f, 0]
    y = ay * rows[LEAD_X, f, 1] + ax * (end - rows[LEAD_Y, f, 1])
    return x / length, y / length


@compiled
def sized_slopes(
    values: Array,
    c: Array,
    rows: Array,
    line: Numbers,
    sizes: tuple[Numbers, Numbers],
    turns: Array,
    raw: Array,
    slopes: Array,
) -> None:
    """Fill the derivatives (q + 1, F, 2) of a sized section's coefficients.

    Parameters
    ----------
    values : (F, n) array
        Features.
    c, rows : (F, 2), (4, F, 2) arrays
        The sized section's coefficients, and its `gradients`.
    line : (4,) numbers
        Its leading edge and trailing-edge midpoint.
    sizes : (6,) and (2,) numbers
        The map that sized it, and the direction of the chord line before.
    turns : (q,) array, or of no length
        Derivatives of that direction's angle; without them the chord line was kept.
    raw : (q, F, 2) array
        Derivatives of the coefficients before.
    slopes : (q + 1, F, 2) array
        Filled; the last is that in the relative thickness.
    """
    length = distance(line[:2], line[2:])
    own = (line[2] - line[0]) / length, (line[3] - line[1]) / length, length
    total, (ax, ay) = sizes
    a, b, d, e, kx, ky = total
    scale = ax * (a * ax + d * ay) + ay * (b * ax + e * ay)
    lifted = -ay * (-a * ay + d * ax) + ax * (-b * ay + e * ax)
    lift, side = lifted / scale - 1.0, 1.0 - scale / lifted
    moves = moves_of((ax, ay), lift, side)
    for q in range(len(raw)):
        for f in range(len(c)):
            slopes[q, f, 0] = raw[q, f, 0] * a + raw[q, f, 1] * d
            slopes[q, f, 1] = raw[q, f, 0] * b + raw[q, f, 1] * e
    for f in range(len(c)):
        slopes[-1, f, 0] = slopes[-1, f, 1] = 0.0
    shares = solved(values, c, rows, own, turns, moves, slopes)
    # the map's shift is normal to the line: -lift / (1 + lift) times the carried edge's height
    above = -ay * kx + ax * ky
    ahead = ax * (line[2] - kx) + ay * (line[3] - ky)
    high = -ay * (line[2] - kx) + ax * (line[3] - ky)
    for q in range(len(slopes)):
        z = shares[q]
        xx = z[0] * moves[0, 0, 0] + z[1] * moves[1, 0, 0] + z[2] * moves[2, 0, 0]
        xy = z[1] * moves[1, 0, 1] + z[2] * moves[2, 0, 1]
        yx = z[1] * moves[1, 1, 0] + z[2] * moves[2, 1, 0]
        yy = z[0] * moves[0, 1, 1] + z[1] * moves[1, 1, 1] + z[2] * moves[2, 1, 1]
        rise = 0.0  # of the raw trailing edge's midpoint over the line, carried
        for f in range(len(c)):
            end = 0.5 * (values[f, 0] + values[f, -1])
            rise += end * (ax * slopes[q, f, 1] - ay * slopes[q, f, 0])
            slopes[q, f, 0] += c[f, 0] * xx + c[f, 1] * yx
            slopes[q, f, 1] += c[f, 0] * xy + c[f, 1] * yy
        normal = above * z[0] - high * z[1] + lift * ahead * z[2] - side * rise
        slopes[q, -1, 0] -= kx * xx + ky * yx + ay * normal + ax * above * z[2]
        slopes[q, -1, 1] -= kx * xy + ky * yy - ax * normal + ay * above * z[2]


@compiled
def moves_of(along: Numbers, lift: float, side: float) -> Array:
    """Return the moves (3, 2, 2) of the plane by which maps to size differ.

    A scale, a stretch normal to the chord line, and a turn of the line that is stretched from.
    """
    ax, ay = along
    moves = np.zeros((3, 2, 2))
    moves[0, 0, 0] = moves[0, 1, 1] = 1.0
    moves[1, 0, 0], moves[1, 0, 1], moves[1, 1, 0], moves[1, 1, 1] = (
        ay * ay,
        -ax * ay,
        -ax * ay,
        ax * ax,
    )
    moves[2, 0, 0], moves[2, 0, 1] = (
        lift * ax * ay + side * ax * ay,
        -lift * ax * ax + side * ay * ay,
    )
    moves[2, 1, 0], moves[2, 1, 1] = lift * ay * ay - side * ax * ax, -(lift + side) * ax * ay
    return moves


@compiled
def solved(
    values: Array, c: Array, rows: Array, line: Numbers, turns: Array, moves: Array, slopes: Array
) -> Array:
    """Return the shares (q + 1, 3) of moves that keep the three conditions under changes.

    The changes (q + 1, F, 2) of the coefficients are carried by the map already; with the last
    the relative thickness grows by 1.
    """
    given = len(turns) > 0
    count = len(slopes)
    system, right = np.zeros((3, 3)), np.zeros((count, 3))
    own = np.zeros((3, 2))
    for f in range(len(c)):
        if not given:
            own[0, 0], own[0, 1] = turning(rows, values, f, line)
        for i in range(2):
            own[1, i], own[2, i] = rows[REACH, f, i], rows[THICKNESS, f, i]
        for m in range(3):
            x = c[f, 0] * moves[m, 0, 0] + c[f, 1] * moves[m, 1, 0]
            y = c[f, 0] * moves[m, 0, 1] + c[f, 1] * moves[m, 1, 1]
            for i in range(3):
                system[i, m] += own[i, 0] * x + own[i, 1] * y
        for q in range(count):
            for i in range(3):
                right[q, i] -= own[i, 0] * slopes[q, f, 0] + own[i, 1] * slopes[q, f, 1]
    for q in range(len(turns)):
        right[q, 0] = -turns[q]
    system[0, 2] -= 1.0
    right[count - 1, 2] = 1.0
    inverse = inverted(system)
    shares = np.zeros((count, 3))
    for q in range(count):
        for m in range(3):
            for i in range(3):
                shares[q, m] += inverse[m, i] * right[q, i]
    return shares
