"""Compiled: what a section measures on its splines: its farthest point, and its thickest place.

`section_curves.SectionCurves` once more, for one section in a loop of a compiled function, with the
notation and the tolerances there.  Points are (2, n): x, then y; landmarks i and -1 - i lie
opposite.  Splines are linear in features (`batch`), and so are their slopes at landmarks.
"""

from math import copysign
from typing import NamedTuple

from bladegen.curves.cubics import APART, HIDDEN, WINDOW
from bladegen.curves.plane_maps import Numbers, turned
from bladegen.curves.roots import ITERATIONS, PARAMETER_TOLERANCE
from bladegen.support.arrays import Array
from bladegen.support.compiled import compiled

__all__ = ["Section", "along_contour", "basis", "cell_of", "highest", "peak", "thickest"]

ACROSS = 8  # Newton steps to the point at the same x on the other side; two are usual
REACH = 4.0  # landmarks that one step towards the thickest place may pass


class Section(NamedTuple):
    """A section: u (n,), slopes of the features (n, F), coefficients (F, 2), points (2, n)."""

    u: Array
    slopes: Array
    c: Array
    points: Array


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
    """Climb from a landmark to the point beside it that is farthest from the edge, (x, y, u)."""
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
    return at(px, h)[0], at(py, h)[0], s.u[cell] + h


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
def thickest(s: Section, along: Numbers, work: Array) -> Numbers:
    """Return the largest distance between the sides normal to a direction, at one place along it.

    The places u on the suction and the pressure side are returned besides.

    Newton's method climbs from the landmark where it is largest, and from those beside which a peak
    may be as high (`cubics.rivals`).
    """
    u, points = s.u, s.points
    middle = len(u) // 2
    heights = work[:middle]
    for i in range(middle):
        x, y = points[0, i] - points[0, -1 - i], points[1, i] - points[1, -1 - i]
        heights[i] = y * along[0] - x * along[1]
    cell = 1 + highest(heights[1 : middle - 1])[0]
    first, last = max(cell - WINDOW, 1), min(cell + WINDOW, middle - 2)
    level, j = -1.0, len(u) - 1 - first
    for i in range(first, last + 1):  # at equal x, by lines between landmarks
        x, y = turned(points[0, i], points[1, i], along)
        start = turned(points[0, j], points[1, j], along)
        while start[0] > x and j > middle + 1:
            j -= 1
            start = turned(points[0, j], points[1, j], along)
        end = turned(points[0, j + 1], points[1, j + 1], along)
        while end[0] < x and j < len(u) - 2:
            j, start = j + 1, end
            end = turned(points[0, j + 1], points[1, j + 1], along)
        heights[i] = y - start[1] - (x - start[0]) * (end[1] - start[1]) / (end[0] - start[0])
        if heights[i] > level:
            level, cell = heights[i], i
    found: Numbers = climbed(s, along, cell, u[1], u[middle - 1])
    vie = level > found[0]  # it climbed to another peak
    for i in range(first + 1, last):
        vie |= rivalled(heights, i, cell)
    if vie:
        found = highest_peak(s, along, heights[: last + 1], first, found)
    return found


@compiled
def rivalled(heights: Array, i: int, best: int) -> bool:
    """Tell whether a peak beside landmark i may be as high as the one beside the highest."""
    bend = abs(heights[i - 1] - 2.0 * heights[i] + heights[i + 1])
    return bool(heights[i] + HIDDEN * bend > heights[best] and abs(i - best) >= APART)


@compiled
def highest_peak(s: Section, along: Numbers, heights: Array, first: int, found: Numbers) -> Numbers:
    """Climb from each landmark from `first` on beside which the highest peak may be.

    Heights are brought to those of the splines, and `found` is returned if none is higher.
    """
    best = first
    for i in range(first, len(heights)):
        heights[i] = climbed(s, along, i, s.u[i], s.u[i])[0]
        if heights[i] > heights[best]:
            best = i
    for i in range(first + 1, len(heights) - 1):
        if i == best or rivalled(heights, i, best):
            peak = climbed(s, along, i, s.u[i - 1], s.u[i + 1])
            if peak[0] > found[0]:
                found = peak
    return found


@compiled
def climbed(s: Section, along: Numbers, cell: int, low: float, high: float) -> Numbers:
    """Climb from a landmark to where the distance between the sides is largest (`thickest`).

    Kept by bisection between places where the distance rises and falls, which are between `low`
    and `high`; where these are the landmark itself, the distance there is returned.
    """
    u = s.u
    across = len(u) - 2 - cell
    t, w = u[cell], u[across + 1]
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
        w += rate * (t - start)
        if abs(t - start) <= PARAMETER_TOLERANCE:
            break
    return height, t, w


@compiled
def basis(s: Section, values: Array, place: float, cell: int, phi: Array) -> None:
    """Fill the features' splines and two derivatives (3, F) at a place in a cell of landmarks."""
    width = s.u[cell + 1] - s.u[cell]
    h = place - s.u[cell]
    for f in range(len(values)):
        start, slope = values[f, cell], s.slopes[cell, f]
        secant = (values[f, cell + 1] - start) / width
        bend = s.slopes[cell + 1, f] + slope - 2.0 * secant
        second, third = (secant - slope - bend) / width, bend / (width * width)
        phi[0, f] = start + h * (slope + h * (second + h * third))
        phi[1, f] = slope + h * (2.0 * second + 3.0 * h * third)
        phi[2, f] = 2.0 * second + 6.0 * h * third


@compiled
def along_contour(s: Section, phi: Array) -> Numbers:
    """Return the first and the second derivative of the contour where a basis (3, F) was taken."""
    x1 = y1 = x2 = y2 = 0.0
    for f in range(len(s.c)):
        x1 += phi[1, f] * s.c[f, 0]
        y1 += phi[1, f] * s.c[f, 1]
        x2 += phi[2, f] * s.c[f, 0]
        y2 += phi[2, f] * s.c[f, 1]
    return x1, y1, x2, y2
