"""Compiled: the leading edge of a section: its farthest point, or the mean of many nearly as far.

`airfoils.noses` and `airfoils.fronts` once more, for one section in a loop of a compiled function,
with the notation and the tolerances there; and how that mean changes with the points.
"""

from math import sqrt

import numpy as np

from bladegen.airfoils.fronts import (
    ALMOST,
    DIGITS,
    FIRST,
    LEAST,
    LED,
    LEVEL,
    MASS,
    NEAR,
    PARABOLA,
    POWER,
    ROUND,
    SAME,
    STEPS,
)
from bladegen.airfoils.noses import FARTHER, SAME_NOSE
from bladegen.blade.variants.section_measures import Section, highest, peak
from bladegen.curves.plane_maps import Numbers
from bladegen.support.arrays import Array
from bladegen.support.compiled import compiled

__all__ = [
    "lead",
    "leveled",
    "mean_weights",
    "middle_of",
    "other_nose",
    "rival_weights",
    "rivals",
    "share_of",
    "squared",
]


@compiled
def lead(s: Section, work: Array) -> tuple[Numbers, Numbers, float, bool, int]:
    """Return the leading edge, the trailing-edge midpoint, and what is known of the nose.

    That is the share of the mean of many points in the leading edge, whether it may get one by a
    little change, and the landmark farthest from the edge.
    """
    edge = middle_of(s.points)
    squares, first = squared(s.points, edge, (1.0, 0.0, 0.0, 1.0), work)
    best = highest(squares)[0]
    one = peak(s, edge, best + first)
    top = (one[0] - edge[0]) ** 2 + (one[1] - edge[1]) ** 2
    wide, rivalry = rivals(s.u, squares, first, one[2], top)
    share = share_of(rivalry)[0]
    if share == 0.0:
        return (one[0], one[1]), edge, 0.0, wide, best
    x, y, far = counted(s, edge, squares, first, leveled(s.u, squares, first, squares[best]))
    scale = far / sqrt(x * x + y * y)
    x, y = edge[0] + scale * x, edge[1] + scale * y
    x, y = one[0] + share * (x - one[0]), one[1] + share * (y - one[1])
    return (x, y), edge, share, wide, best


@compiled
def middle_of(points: Array) -> Numbers:
    """Return the trailing-edge midpoint."""
    return 0.5 * (points[0, 0] + points[0, -1]), 0.5 * (points[1, 0] + points[1, -1])


@compiled
def squared(points: Array, edge: Numbers, total: Numbers, work: Array) -> tuple[Array, int]:
    """Return squared distances from the edge in the front half under a map, and where it begins."""
    first = points.shape[1] // 4
    x, y = points[0, first:-first], points[1, first:-first]
    a, b, c, d = total[0], total[1], total[2], total[3]
    squares = work[: len(x)]
    for i in range(len(x)):
        p, q = x[i] - edge[0], y[i] - edge[1]
        squares[i] = (a * p + c * q) ** 2 + (b * p + d * q) ** 2
    return squares, first


@compiled
def other_nose(s: Section, edge: Numbers, total: Numbers, best: int, work: Array) -> bool:
    """Tell whether a section may have a round or another nose than `best` under a map."""
    squares, first = squared(s.points, edge, total, work)
    there = highest(squares)[0]
    if abs(there - best) > SAME_NOSE:
        return True
    i = min(max(there, 1), len(squares) - 2)  # the top of a parabola through three landmarks
    rise, bend = squares[i - 1] - squares[i + 1], squares[i - 1] - 2.0 * squares[i] + squares[i + 1]
    h = 0.5 * rise / bend if bend < 0.0 else 0.0
    place = s.u[first + i] + 0.5 * h * (s.u[first + i + 1] - s.u[first + i - 1])
    rivalled: bool = is_rivalled(
        s.u, squares, first, place, squares[i] - 0.25 * rise * h, FARTHER * ROUND
    )
    return rivalled


@compiled
def is_rivalled(
    u: Array, squares: Array, first: int, place: float, top: float, fall: float
) -> bool:
    """Tell whether squared distances fall off from a place more slowly than `fall` says."""
    count, over = 0, 1.0 / top
    here = u[first : first + len(squares)]
    for i in range(len(squares)):  # quicker than to stop at the first
        away = here[i] - place
        count += 1.0 + SAME - squares[i] * over < fall * away * away
    return count > 0


@compiled
def rivals(u: Array, squares: Array, first: int, place: float, top: float) -> tuple[bool, float]:
    """Return whether points nearly rival a farthest one at u `place`, and by how much they do."""
    wide = is_rivalled(u, squares, first, place, top, ALMOST * ROUND)
    rivalry = 0.0
    if not wide:
        return wide, rivalry
    for i in range(len(squares)):
        at = first + i
        apart = (u[at] - place) ** 2
        fall, gap = ROUND * apart, 1.0 + DIGITS - squares[i] / top
        if gap < fall + DIGITS:
            y = 1.0 - gap / (fall + DIGITS)
            rivalry += 0.5 * (u[at + 1] - u[at - 1]) * y * y * apart / (apart + NEAR * NEAR) ** 1.5
    return wide, rivalry


@compiled
def sums(u: Array, squares: Array, first: int, level: float) -> Numbers:
    """Return the sums of shares of u times x and times x^2 (`fronts`)."""
    total = mass = 0.0
    for i in range(len(squares)):
        x = squares[i] / level - 1.0
        if x > 0.0:
            part = 0.5 * (u[first + i + 1] - u[first + i - 1]) * x
            total += part
            mass += part * x
    return total, mass


@compiled
def leveled(u: Array, squares: Array, first: int, top: float) -> float:
    """Return the level above which squared distances count."""
    mass = sums(u, squares, first, top / (1.0 + FIRST))[1]
    level: float = top / (1.0 + FIRST * (MASS / mass) ** POWER)
    for _ in range(STEPS):
        total, mass = sums(u, squares, first, level)
        step = mass * (1.0 - (MASS / mass) ** POWER) / (2.0 * POWER * (mass + total))
        level = min(level * (1.0 + step), top / (1.0 + LEAST * FIRST))
        if not abs(step) > LEVEL:
            break
    return level


@compiled
def share_of(rivalry: float) -> Numbers:
    """Return the share of the mean of many points in the leading edge, and its slope."""
    f = min(rivalry / LED, 1.0)
    return f * f * (3.0 - 2.0 * f), 6.0 * f * (1.0 - f) / LED


@compiled
def counted(s: Section, edge: Numbers, squares: Array, first: int, level: float) -> Numbers:
    """Return the mean of the points that count, from the edge on, and their distance."""
    x = y = mass = third = 0.0
    for i in range(len(squares)):
        ahead = squares[i] / level - 1.0
        if ahead > 0.0:
            at = first + i
            part = 0.5 * (s.u[at + 1] - s.u[at - 1]) * ahead * ahead
            mass += part
            third += part * ahead
            x += part * (s.points[0, at] - edge[0])
            y += part * (s.points[1, at] - edge[1])
    return x / mass, y / mass, sqrt(level * (1.0 + PARABOLA * third / mass))


@compiled
def mean_weights(
    s: Section, edge: Numbers, squares: Array, first: int, level: float, weights: Array
) -> Numbers:
    """Fill by what the mean of many points changes with squared distances.

    Filled are the first two and the last of weights (4, m): of x and of y in squared distances
    over the level, and those of the points themselves.  Returned are x and y of the mean as it
    leads, from the edge on, and how many times as far it is as the mean of points.
    """
    x, y, far = counted(s, edge, squares, first, level)
    length = sqrt(x * x + y * y)
    ax, ay, scale = x / length, y / length, far / length
    total, mass = sums(s.u, squares, first, level)
    total += mass
    ahead, three, vx, vy = np.zeros(len(squares)), 0.0, 0.0, 0.0
    for i in range(len(squares)):
        at = first + i
        ahead[i] = max(squares[i] / level - 1.0, 0.0)
        part = 0.5 * (s.u[at + 1] - s.u[at - 1]) * ahead[i] * (1.0 + ahead[i]) / total
        three += part * ahead[i]
        vx += part * (s.points[0, at] - edge[0])
        vy += part * (s.points[1, at] - edge[1])
    for i in range(len(squares)):
        at = first + i
        part = 0.5 * (s.u[at + 1] - s.u[at - 1]) * ahead[i]
        px, py = s.points[0, at] - edge[0] - vx, s.points[1, at] - edge[1] - vy
        reach = 1.5 * PARABOLA * level / far * part * (ahead[i] - three) / mass
        reach += 0.5 * far * part / total
        turn = 2.0 * scale * part * (py * ax - px * ay) / mass
        weights[0, i], weights[1, i] = reach * ax - turn * ay, reach * ay + turn * ax
        weights[3, i] = part * ahead[i] / mass
    return far * ax, far * ay, scale


@compiled
def rival_weights(
    u: Array, squares: Array, first: int, place: float, top: float, weights: Array
) -> Numbers:
    """Fill weights (m,) of squared distances in what `rivals` returns.

    Its derivatives in the farthest point's squared distance and place are returned.
    """
    of_top = of_place = 0.0
    for i in range(len(squares)):
        at = first + i
        away = u[at] - place
        fall, gap = ROUND * away * away + DIGITS, 1.0 + DIGITS - squares[i] / top
        y, near = max(1.0 - gap / fall, 0.0), away * away + NEAR * NEAR
        share = 0.5 * (u[at + 1] - u[at - 1]) * y / near**1.5
        part = share * away * away
        weights[i] = 2.0 * part / (fall * top)
        of_top -= weights[i] * squares[i] / top
        of_place -= 4.0 * ROUND * part * gap * away / (fall * fall)
        of_place -= share * y * away * (2.0 * NEAR * NEAR - away * away) / near
    return of_top, of_place
