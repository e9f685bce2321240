"""Compiled: the map that brings a section to unit chord and to a relative thickness.

`curves.SectionSplines.normalising` once more, for one section in a loop of a compiled function,
with the notation and the tolerances there.  Points are (2, n): x, then y; landmarks i and -1 - i
lie opposite.  Splines are linear in features (`batch`), and so are their slopes at landmarks.
"""

from math import asin, copysign, sin, sqrt
from typing import NamedTuple

import numpy as np

from bladegen.airfoils.curves import AMBIGUOUS, EVEN, SAME_NOSE, SETTLED
from bladegen.airfoils.plane_maps import (
    Numbers,
    between,
    carried,
    combine,
    distance,
    followed,
    turned,
)
from bladegen.airfoils.resizing import RIVAL
from bladegen.airfoils.roots import ITERATIONS, PARAMETER_TOLERANCE, ROUNDING
from bladegen.support.arrays import Array
from bladegen.support.compiled import compiled

__all__ = ["Section", "chord_line", "sizing"]

ACROSS = 8  # Newton steps to the point at the same x on the other side; two are usual
REACH = 4.0  # landmarks that one step towards the thickest place may pass
Room = tuple[Array, Array, Array]  # for coefficients (F, 2), points (2, n), and n numbers


class Section(NamedTuple):
    """A section: u (n,), slopes of the features (n, F), coefficients (F, 2), points (2, n)."""

    u: Array
    slopes: Array
    c: Array
    points: Array


@compiled
def sizing(
    s: Section, values: Array, target: float, now: Array, moved: Array, work: Array
) -> tuple[Numbers, float]:
    """Return the map that brings a section to size, and the relative thickness it has.

    Maps are (a, b, c, d, e, f): x' = a x + c y + e and y' = b x + d y + f.
    """
    total, own, either = step(s, values, target, now, moved, work)
    c, points = now, moved
    if either:
        c, points = np.empty_like(now), np.empty_like(moved)
    for _ in range(ITERATIONS):  # away from noses that agree
        if not either:
            break
        carried(s.c, total, c)
        combine(values, c, points)
        here = Section(s.u, s.slopes, c, points)
        more, _, either = step(here, values, target, now, moved, work)
        total = followed(total, more)
    return total, own


@compiled
def step(
    s: Section, values: Array, target: float, now: Array, moved: Array, work: Array
) -> tuple[Numbers, float, bool]:
    """Return the map, exact unless either nose may lead, the thickness, and whether that is so."""
    total, own, rivals, passed = resizing(s, target, work)
    either = False
    if rivals or passed:
        other, place, either = shared(s, values, target, now, moved, work)
        either = either and rivals
        if not either and (rivals or place > 0.0):
            total = other
    return total, own, either


@compiled
def resizing(s: Section, target: float, work: Array) -> tuple[Numbers, float, bool, bool]:
    """Return the map where one nose leads, the relative thickness, and whether another does.

    The noses may share the edge of the section as it is, and that of the result.
    """
    one, two, edge = noses(s, work)
    r1, r2 = distance(one, edge), distance(two, edge)
    chord, ahead = max(r1, r2), r1 - r2
    lead = between(one, two, led(ahead))
    length = distance(lead, edge)
    along = (edge[0] - lead[0]) / length, (edge[1] - lead[1]) / length
    thickness = thickest(s, along, work)

    x1, y1 = turned(one[0] - lead[0], one[1] - lead[1], along)
    x2, y2 = turned(two[0] - lead[0], two[1] - lead[1], along)
    q1, q2 = distance((x1, y1), (length, 0.0)), distance((x2, y2), (length, 0.0))
    stretch = 1.0
    for _ in range(3):  # noses beside the chord line move with the stretch
        stretch = target * max(q1, q2) / thickness
        q1 = distance((x1, stretch * y1), (length, 0.0))
        q2 = distance((x2, stretch * y2), (length, 0.0))
    rivals = one != two and abs(ahead) < 2.0 * AMBIGUOUS
    passed = one != two and q1 - q2 < RIVAL * length
    return stretching(lead, along, stretch, max(q1, q2)), thickness / chord, rivals, passed


@compiled
def led(ahead: float) -> float:
    """Return the second nose's share in the leading edge, where the first is so far ahead."""
    f = min(max(ahead / AMBIGUOUS, -1.0), 1.0)
    return 0.5 - 0.25 * f * (3.0 - f * f)


@compiled
def chord_line(s: Section, work: Array) -> Numbers:
    """Return x and y of the leading edge and of the trailing-edge midpoint (`ChordLines.of`)."""
    one, two, edge = noses(s, work)
    lead = between(one, two, led(distance(one, edge) - distance(two, edge)))
    return lead[0], lead[1], edge[0], edge[1]


@compiled
def stretching(start: Numbers, along: Numbers, stretch: float, reach: float) -> Numbers:
    """Return the map that stretches normal to a line from a point, then brings to unit chord."""
    ax, ay = along
    scale, lift = 1.0 / reach, stretch - 1.0
    a, b, d = 1.0 + lift * ay * ay, -lift * ax * ay, 1.0 + lift * ax * ax
    e, f = start[0] - (start[0] * a + start[1] * b), start[1] - (start[0] * b + start[1] * d)
    return scale * a, scale * b, scale * b, scale * d, scale * e, scale * f


@compiled
def shared(
    s: Section, values: Array, target: float, now: Array, moved: Array, work: Array
) -> tuple[Numbers, float, bool]:
    """Return the map where noses share the edge, their share, and if 0 and 1 are shares, too."""
    both, room = noses(s, work), (now, moved, work)
    first, above = stretched(s, values, both, 0.0, target, room)
    last, below = stretched(s, values, both, 1.0, target, room)
    if not above > EVEN:
        return first, 0.0, not below < -EVEN
    if not below < -EVEN:
        return last, 1.0, False
    total = first
    place, low, high, kept = 0.0, 0.0, 1.0, 0
    for _ in range(ITERATIONS):
        before, place = place, low + (high - low) * (above / (above - below))
        total, value = stretched(s, values, both, place, target, room)
        if value > 0.0:
            low, above = place, value
            below *= 0.5 if kept == 1 else 1.0
            kept = 1
        else:
            high, below = place, value
            above *= 0.5 if kept == -1 else 1.0
            kept = -1
        if abs(value) <= EVEN or abs(place - before) <= ROUNDING:
            break
    return total, place, False


@compiled
def stretched(
    s: Section, values: Array, both: tuple[Numbers, ...], place: float, target: float, room: Room
) -> tuple[Numbers, float]:
    """Return the map that stretches normal to a chord line between noses, and its excess.

    The line ends at `place`, 0 at the first of the two noses, 1 at the second; the excess is
    that of `SectionCurves._stretched`.
    """
    one, two, edge = both
    now, moved, work = room
    lead = between(one, two, place)
    length = distance(lead, edge)
    ax, ay = (edge[0] - lead[0]) / length, (edge[1] - lead[1]) / length
    thickness = thickest(s, (ax, ay), work)
    first = turned(one[0] - edge[0], one[1] - edge[1], (ax, ay))
    second = turned(two[0] - edge[0], two[1] - edge[1], (ax, ay))
    side = copysign(1.0, second[1] - first[1])
    stretch, floor = 1.0, SETTLED * thickness * thickness
    for _ in range(ITERATIONS):
        before = stretch
        free = max(thickness * thickness - (target * first[1]) ** 2, floor)
        other = max(thickness * thickness - (target * second[1]) ** 2, floor)
        stretch = target * max(abs(first[0]) / sqrt(free), abs(second[0]) / sqrt(other))
        for f in range(len(s.c)):
            now[f, 0] = s.c[f, 0] * ax + s.c[f, 1] * ay
            now[f, 1] = (s.c[f, 1] * ax - s.c[f, 0] * ay) * stretch
        now[-1, 0] -= edge[0] * ax + edge[1] * ay
        now[-1, 1] -= (edge[1] * ax - edge[0] * ay) * stretch
        combine(values, now, moved)
        first, second, _ = noses(Section(s.u, s.slopes, now, moved), work)
        first, second = (first[0], first[1] / stretch), (second[0], second[1] / stretch)
        if abs(stretch - before) <= SETTLED:
            break
    y1, y2 = side * first[1] * stretch, side * second[1] * stretch
    q1, q2 = distance((first[0], y1), (0.0, 0.0)), distance((second[0], y2), (0.0, 0.0))
    ahead = (q1 - q2) / max(q1, q2)
    if y1 > y2:
        y1, y2, ahead = y2, y1, -ahead
    total = stretching(lead, (ax, ay), stretch, max(q1, q2))
    if first == second:
        return total, y1
    share = min(max(-y1 / (y2 - y1), 0.0), 1.0)
    held = 2.0 * sin(asin(1.0 - 2.0 * share) / 3.0)
    return total, held - ahead / AMBIGUOUS


@compiled
def noses(s: Section, work: Array) -> tuple[Numbers, ...]:
    """Return the point farthest from the trailing-edge midpoint, its rival or itself, and that."""
    points = s.points
    first = points.shape[1] // 4  # noses are in the front half
    edge = 0.5 * (points[0, 0] + points[0, -1]), 0.5 * (points[1, 0] + points[1, -1])
    x, y = points[0, first:-first], points[1, first:-first]
    squares = work[: len(x)]
    for i in range(len(x)):
        squares[i] = (x[i] - edge[0]) ** 2 + (y[i] - edge[1]) ** 2
    best, alone = highest(squares)
    other, least = best, squares[best] * (1.0 - RIVAL)
    if not alone:
        for i in range(1, len(squares) - 1):
            here = squares[i]
            rises = here > least and here > squares[i - 1] and here >= squares[i + 1]
            if rises and abs(i - best) > SAME_NOSE:
                other, least = i, here
    one = two = peak(s, edge, best + first)
    if other != best:
        two = peak(s, edge, other + first)
    return one, two, edge


@compiled
def highest(values: Array) -> tuple[int, bool]:
    """Return where the largest of some values stands, and whether it is known to be alone."""
    turns, best = 0, 0
    for i in range(len(values) - 2):  # quicker than to compare all with the largest so far
        best += values[i + 1] > values[i]
        turns += (values[i + 2] > values[i + 1]) != (values[i + 1] > values[i])
    if turns == 1 and values[1] > values[0]:
        return best, True
    best = 0
    for i in range(len(values)):
        if values[i] > values[best]:
            best = i
    return best, False


@compiled
def peak(s: Section, edge: Numbers, landmark: int) -> Numbers:
    """Climb from a landmark to the point beside it that is farthest from the edge."""
    cell = landmark
    px, py = piece(s, cell, (1.0, 0.0))
    h = 0.0
    if (px[0] - edge[0]) * px[1] + (py[0] - edge[1]) * py[1] < 0.0:
        cell -= 1
        px, py = piece(s, cell, (1.0, 0.0))
        h = s.u[landmark] - s.u[cell]
    low, high = 0.0, s.u[cell + 1] - s.u[cell]
    for _ in range(ITERATIONS):
        x, x1, x2 = at(px, h)
        y, y1, y2 = at(py, h)
        x, y = x - edge[0], y - edge[1]
        slope = x * x1 + y * y1
        low, high = (h, high) if slope > 0.0 else (low, h)
        start, h = h, h - slope / (x1 * x1 + y1 * y1 + x * x2 + y * y2)
        if not low <= h <= high:
            h = 0.5 * (low + high)
        if abs(h - start) <= PARAMETER_TOLERANCE:
            break
    return at(px, h)[0], at(py, h)[0]


@compiled
def piece(s: Section, i: int, along: Numbers) -> tuple[Numbers, Numbers]:
    """Return the cubics from landmark i to the next, along a direction and normal to it."""
    x0 = y0 = x1 = y1 = 0.0
    for f in range(len(s.c)):
        x0 += s.slopes[i, f] * s.c[f, 0]
        y0 += s.slopes[i, f] * s.c[f, 1]
        x1 += s.slopes[i + 1, f] * s.c[f, 0]
        y1 += s.slopes[i + 1, f] * s.c[f, 1]
    start = turned(s.points[0, i], s.points[1, i], along)
    end = turned(s.points[0, i + 1], s.points[1, i + 1], along)
    slope, last = turned(x0, y0, along), turned(x1, y1, along)
    width = s.u[i + 1] - s.u[i]
    return (
        cubic(start[0], end[0], slope[0], last[0], width),
        cubic(start[1], end[1], slope[1], last[1], width),
    )


@compiled
def cubic(start: float, end: float, slope: float, last: float, width: float) -> Numbers:
    """Return a cubic between two values with slopes there, constant term first."""
    secant = (end - start) / width
    bend = last + slope - 2.0 * secant
    return start, slope, (secant - slope - bend) / width, bend / (width * width)


@compiled
def at(p: Numbers, h: float) -> Numbers:
    """Return a cubic's value and two derivatives."""
    return (
        p[0] + h * (p[1] + h * (p[2] + h * p[3])),
        p[1] + h * (2.0 * p[2] + 3.0 * h * p[3]),
        2.0 * p[2] + 6.0 * h * p[3],
    )


@compiled
def cell_of(u: Array, t: float, cell: int) -> int:
    """Return the cell that holds a parameter, sought from another one."""
    while cell < len(u) - 2 and t >= u[cell + 1]:
        cell += 1
    while cell > 0 and t < u[cell]:
        cell -= 1
    return cell


@compiled
def thickest(s: Section, along: Numbers, work: Array) -> float:
    """Return the largest distance between the sides normal to a direction, at one place along it.

    Newton's method climbs from the thickest pair of landmarks, kept by bisection between places
    where the distance rises and falls.
    """
    u, points = s.u, s.points
    middle = len(u) // 2
    heights = work[:middle]
    for i in range(middle):
        x, y = points[0, i] - points[0, -1 - i], points[1, i] - points[1, -1 - i]
        heights[i] = y * along[0] - x * along[1]
    cell = 1 + highest(heights[1 : middle - 1])[0]
    across = len(u) - 2 - cell
    t, w, low, high = u[cell], u[across + 1], u[1], u[middle - 1]
    px, py = piece(s, cell, along)
    qx, qy = piece(s, across, along)
    height = 0.0
    for _ in range(ITERATIONS):
        if not u[cell] <= t <= u[cell + 1]:
            cell = cell_of(u, t, cell)
            px, py = piece(s, cell, along)
        x, x1, x2 = at(px, t - u[cell])
        y, y1, y2 = at(py, t - u[cell])
        step = 1.0
        v = v1 = v2 = z1 = z2 = 0.0
        for _ in range(ACROSS):
            if not u[across] <= w <= u[across + 1]:
                across = cell_of(u, w, across)
                qx, qy = piece(s, across, along)
            z, z1, z2 = at(qx, w - u[across])
            v, v1, v2 = at(qy, w - u[across])
            step = (z - x) / z1
            w = min(max(w - step, 0.5), 1.0)
            if abs(step) <= PARAMETER_TOLERANCE:
                break
        rate = x1 / z1
        rising = y1 - v1 * rate
        bending = y2 - v2 * rate * rate - v1 * (x2 - z2 * rate * rate) / z1
        low, high = (t, high) if rising > 0.0 else (low, t)
        limit = REACH * (u[cell + 1] - u[cell])
        change = -rising / bending if bending < 0.0 else copysign(limit, rising)
        start, t = t, t + min(max(change, -limit), limit)
        if not low <= t <= high:
            t = 0.5 * (low + high)
        height = y - v + v1 * step + 0.5 * rising * (t - start)
        if abs(t - start) <= PARAMETER_TOLERANCE:
            break
        w += rate * (t - start)
    return height
