"""Compiled loops: sections brought to size, and how their coefficients change.

A section's own coordinates are few: the modes' coordinates t there, and the relative thickness.
`linearised` finds how its coefficients change with them, after it was brought to size and to its
chord line.  Arrays are (k, b, ...), spans first, as in `variants.kernels`.
"""

from math import sqrt

import numpy as np

from bladegen.blade.variants.section_measures import Section
from bladegen.blade.variants.sizes import sizing
from bladegen.curves.plane_maps import (
    Numbers,
    carried,
    carry,
    combine,
    distance,
    motion_of,
    onto,
)
from bladegen.parametric.section_slopes import LEAD_X, gradients, sized_slopes, turning
from bladegen.support.arrays import Array
from bladegen.support.compiled import compiled

__all__ = ["linearised", "lines_slopes"]

REVISION = 16  # of all that is compiled with these: with another text it is compiled anew
TERMS = 20  # of the series of cos S and sin S / S; principal angles below 2 rad need 14


@compiled
def linearised(
    u: Array,
    values: Array,
    slopes: Array,
    coefficients: Array,
    t: Array,
    gram: Array,
    M: Array,
    target: Array,
    standing: Array,
    standing_slopes: Array,
    kept: bool,
    result: Array,
    changes: Array,
    first: int,
    step: int,
) -> None:
    """Bring sections to size and to their chord lines; fill what comes out and its derivatives.

    Parameters
    ----------
    u : (n,) array
        Landmark parameters.
    values, slopes : (k, F, n), (k, n, F) arrays
        Features and their splines' slopes; the last is constant.
    coefficients : (k, b, F, 2) array
        Of the raw sections.
    t : (k, b, r) array
        Coordinates there [rad].
    gram : (k, r, r, 2, 2) array
        Products V_i^T V_j of the carried modes.
    M : (k, 2, 2) array
        Linear maps of the shapes.
    target : (k, b) array
        Relative thickness to reach.
    standing, standing_slopes : (k, b, 4) arrays
        As for `variants.kernels.made`, and the derivative in the relative thickness.
    kept : bool
        Whether `standing` holds chord lines; else motions.
    result : (k, b, F, 2) array
        Filled: coefficients of the sections in chords, edges as they are.
    changes : (k, b, r + 1, F, 2) array
        Filled: derivatives in t and in the relative thickness.
    first, step : int
        Which of the spans, as in a range.
    """
    spans, count, features, _ = coefficients.shape
    modes = t.shape[-1]
    points, moved = np.empty((2, len(u))), np.empty((2, len(u)))
    room = points, moved, np.empty(len(u)), np.empty((2, 4, features, 2))
    rows, now = np.empty((4, features, 2)), np.empty((features, 2))
    raw, still = np.zeros((modes, features, 2)), np.zeros(4)
    for k in range(first, spans, step):
        for b in range(count):
            c = coefficients[k, b]
            shape_slopes(t[k, b], gram[k], M[k], raw)
            change = changes[k, b]
            line = sized(u, values[k], slopes[k], c, target[k, b], raw, rows, now, change, room)
            there = standing[k, b]
            motion = onto(line, there) if kept else motion_of(there)
            carried(now, motion, result[k, b])
            for q in range(modes + 1):
                moving = standing_slopes[k, b] if q == modes else still
                if kept:
                    follow(values[k], result[k, b], rows, line, motion, there, moving, change[q])
                else:
                    turn(change[q], motion)


@compiled
def sized(
    u: Array,
    values: Array,
    slopes: Array,
    c: Array,
    target: float,
    raw: Array,
    rows: Array,
    now: Array,
    change: Array,
    room: tuple[Array, ...],
) -> Numbers:
    """Bring a section to size; return the chord line that comes out.

    Filled are its `gradients` (4, F, 2), its coefficients (F, 2), and their derivatives
    (q + 1, F, 2) for those of the coefficients before, `raw` (q, F, 2), and in the thickness.
    """
    points, moved, work, spare = room
    combine(values, c, points)
    section = Section(u, slopes, c, points)
    total, _, _, along, turned = sizing(section, values, target, now, moved, work)
    turns = np.zeros(len(raw) + 1 if turned else 0)
    if turned and len(raw):
        before = gradients(section, values, work, rows, spare)
        line = along[0], along[1], distance(before[:2], before[2:])
        for f in range(len(c)):
            tx, ty = turning(rows, values, f, line)
            for q in range(len(raw)):
                turns[q] += tx * raw[q, f, 0] + ty * raw[q, f, 1]
    carry(points, total)
    carried(c, total, now)
    after: Numbers = gradients(Section(u, slopes, now, points), values, work, rows, spare)
    sized_slopes(values, now, rows, after, (total, along), turns, raw, change)
    return after


@compiled
def turn(change: Array, motion: Numbers) -> None:
    """Turn a derivative (F, 2) of coefficients as a motion does."""
    for f in range(len(change)):
        x, y = change[f, 0], change[f, 1]
        change[f, 0] = x * motion[0] + y * motion[2]
        change[f, 1] = x * motion[1] + y * motion[3]


@compiled
def follow(
    values: Array,
    c: Array,
    rows: Array,
    line: Numbers,
    motion: Numbers,
    there: Array,
    moving: Array,
    change: Array,
) -> None:
    """Turn a derivative (F, 2) so that the chord line stays on `there`, which moves itself."""
    length = sqrt((line[2] - line[0]) ** 2 + (line[3] - line[1]) ** 2)
    along = (line[2] - line[0]) / length, (line[3] - line[1]) / length, length
    turning_by = lead_x = lead_y = 0.0
    for f in range(len(c)):
        tx, ty = turning(rows, values, f, along)
        turning_by += tx * change[f, 0] + ty * change[f, 1]
        lead_x += rows[LEAD_X, f, 0] * change[f, 0] + rows[LEAD_X, f, 1] * change[f, 1]
        lead_y += rows[LEAD_X + 1, f, 0] * change[f, 0] + rows[LEAD_X + 1, f, 1] * change[f, 1]
    bx, by = there[2] - there[0], there[3] - there[1]
    wanted = (bx * (moving[3] - moving[1]) - by * (moving[2] - moving[0])) / (bx * bx + by * by)
    angle = wanted - turning_by
    turn(change, motion)
    for f in range(len(c)):
        change[f, 0] -= angle * c[f, 1]
        change[f, 1] += angle * c[f, 0]
    change[-1, 0] += moving[0] - (lead_x * motion[0] + lead_y * motion[2]) + angle * there[1]
    change[-1, 1] += moving[1] - (lead_x * motion[1] + lead_y * motion[3]) - angle * there[0]


@compiled
def shape_slopes(t: Array, gram: Array, M: Array, raw: Array) -> None:
    """Fill the derivatives (r, F, 2) of ``X cos S + D sin S / S``, times M, in coordinates (r,).

    By the power series in S^2 = D^T D, which need no eigenvalues, and are exact where these agree.
    """
    modes = len(t)
    squares = np.zeros((2, 2))
    for i in range(modes):
        for j in range(modes):
            for a in range(2):
                for b in range(2):
                    squares[a, b] += t[i] * t[j] * gram[i, j, a, b]
    for q in range(modes):
        change = np.zeros((2, 2))
        for i in range(modes):
            for a in range(2):
                for b in range(2):
                    change[a, b] += t[i] * (gram[i, q, a, b] + gram[q, i, a, b])
        _, dcos = series(squares, change, 0.0)
        sinc, dsinc = series(squares, change, 1.0)
        for a in range(2):
            for b in range(2):
                raw[q, a, b] = dcos[a, 0] * M[0, b] + dcos[a, 1] * M[1, b]
                own = sinc[a, 0] * M[0, b] + sinc[a, 1] * M[1, b]
                other = dsinc[a, 0] * M[0, b] + dsinc[a, 1] * M[1, b]
                for i in range(modes):
                    raw[q, 2 + 2 * i + a, b] = t[i] * other + (own if i == q else 0.0)


@compiled
def series(squares: Array, change: Array, odd: float) -> tuple[Array, Array]:
    """Return cos S (odd 0) or sin S / S (odd 1) of S^2 (2, 2), and its derivative along a change.

    Horner's rule on the sum of (-S^2)^m / (2 m + odd)!.
    """
    value, slope = np.zeros((2, 2)), np.zeros((2, 2))
    value[0, 0] = value[1, 1] = 1.0
    following = np.empty((2, 2))
    for m in range(TERMS, 0, -1):
        share = 1.0 / ((2.0 * m + odd) * (2.0 * m + odd - 1.0))
        for a in range(2):
            for b in range(2):
                following[a, b] = change[a, 0] * value[0, b] + change[a, 1] * value[1, b]
                following[a, b] += squares[a, 0] * slope[0, b] + squares[a, 1] * slope[1, b]
        for b in range(2):
            x = squares[0, 0] * value[0, b] + squares[0, 1] * value[1, b]
            y = squares[1, 0] * value[0, b] + squares[1, 1] * value[1, b]
            value[0, b] = (1.0 if b == 0 else 0.0) - share * x
            value[1, b] = (1.0 if b == 1 else 0.0) - share * y
        for a in range(2):
            for b in range(2):
                slope[a, b] = -share * following[a, b]
    return value, slope


@compiled
def lines_slopes(
    u: Array, values: Array, slopes: Array, coefficients: Array, target: Array, result: Array
) -> None:
    """Fill how chord lines (m, b, 4) of sized sections move with the relative thickness.

    Those of the coefficients (m, b, F, 2), brought to relative thickness (m, b) and not moved.
    """
    sections, count, features, _ = coefficients.shape
    points, moved = np.empty((2, len(u))), np.empty((2, len(u)))
    room = points, moved, np.empty(len(u)), np.empty((2, 4, features, 2))
    rows, now = np.empty((4, features, 2)), np.empty((features, 2))
    raw, change = np.empty((0, features, 2)), np.empty((1, features, 2))
    for k in range(sections):
        for b in range(count):
            c = coefficients[k, b]
            sized(u, values[k], slopes[k], c, target[k, b], raw, rows, now, change, room)
            for j in range(4):
                result[k, b, j] = 0.0
            for f in range(features):
                end = 0.5 * (values[k, f, 0] + values[k, f, -1])
                for j in range(2):
                    result[k, b, 0] += rows[LEAD_X, f, j] * change[0, f, j]
                    result[k, b, 1] += rows[LEAD_X + 1, f, j] * change[0, f, j]
                    result[k, b, 2 + j] += end * change[0, f, j]
