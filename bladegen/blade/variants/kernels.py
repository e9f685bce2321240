"""Compiled loops over perturbed sections: each is tested, sized, finished and placed by itself.

A section is the n landmarks ``values.T @ coefficients`` of its span's features (`batch`):
trailing edge -> suction side -> leading edge -> pressure side, so that landmarks i and -1 - i lie
opposite.  Points are (2, n) here: x, then y.  All that is done to a section is done while it
lies in the processor's nearest cache, and sections do not know of each other: what comes out
does not depend on how many are made at once, where, or in what order.

`made` and `lines` are called from outside.  They are numpy's laws once more, with their notation
and tolerances: `crossing_sections`, `SectionSplines.normalising` and `ChordLines.onto` (`sizes`),
`MinimumThickness`, `polygons.measure`, and a map to space.
"""

from math import cos, inf, sin, sqrt

import numpy as np

from bladegen.airfoils.characteristics import characterise
from bladegen.blade.edges import WINDOW
from bladegen.blade.variants.section_measures import Section
from bladegen.blade.variants.sizes import chord_line, sizing
from bladegen.curves.plane_maps import Numbers, both, carried, carry, combine, motion_of, onto
from bladegen.curves.separation import ANGLES, APART, FLAT
from bladegen.support.arrays import Array, Indices
from bladegen.support.compiled import ONE, ZERO, compiled

__all__ = ["CROSSING", "OPEN", "SOUND", "lines", "made"]

REVISION = 23  # of all that is compiled with these: with another text it is compiled anew
SOUND, CROSSING, OPEN = range(3)  # what is known of a section
AHEAD, BEHIND = WINDOW


@compiled
def made(
    u: Array,
    values: Array,
    slopes: Array,
    coefficients: Array,
    target: Array,
    standing: Array,
    own: Array,
    known: Indices,
    chord: Array,
    to_space: Array,
    sections: Array,
    measures: Array,
    edge: Array,
    flat: Array,
    looks: Array,
    kept: bool,
    first: int,
    step: int,
) -> None:
    """Test sections, bring them to unit chord and relative thickness, finish and place them.

    Parameters
    ----------
    u : (n,) array
        Landmark parameters.
    values, slopes : (k, F, n), (k, n, F) arrays
        Features, and the slopes of their splines; F is odd, and the last is constant.
    coefficients : (k, b, F, 2) array
        Of the sections.
    target : (k, b) array
        Relative thickness to reach.
    standing : (k, b, 4) array
        The nose and trailing-edge midpoint to bring a section's onto, or a motion: cosine, sine
        and shift; not looked at without sections and measures.
    own : (k, b) array
        Filled: the relative thickness before.
    known : (k, b) array of int, or of no length
        Filled: `SOUND`, `CROSSING`, or `OPEN` to an exact test.
    chord : (b, k) array
        [m].
    to_space : (b, k, 3, 3) array
        Maps of (x, y, 1) to space.
    sections : (b, k, n, 3) array, or of no length
        Filled: points [m].
    measures : (b, k, 7) array, or of no length
        Filled: `polygons.MEASURES` [m].
    edge : (b, k) array, or of no length without sections
        Least thickness of the trailing edges over the chord.
    flat : (k, b) array
        Factors across the chord under which characteristics are taken.
    looks : (b, k, 6) array, or of no length
        Filled: `sanity.CHARACTERISTICS`.
    kept : bool
        Whether `standing` holds chord lines; else motions.
    first, step : int
        Which of the spans, as in a range.
    """
    spans, count, features, _ = coefficients.shape
    points, moved = np.empty((2, len(u))), np.empty((2, len(u)))
    now, work = np.empty((features, 2)), np.empty(len(u))
    for k in range(first, spans, step):
        for b in range(count):
            c = coefficients[k, b]
            combine(values[k], c, points)
            if len(known):
                known[k, b] = SOUND if laddered(points) else compared(points, moved)
            section = Section(u, slopes[k], c, points)
            total, own[k, b], line, _, turned = sizing(
                section, values[k], target[k, b], now, moved, work
            )
            if not len(sections) and not len(looks):
                continue
            line = sized_line(section, total, line, turned, now, work)
            if len(looks):
                characterise(points, line, flat[k, b], moved, work, looks[b, k])
            if len(sections):
                there = standing[k, b]
                carry(points, onto(line, there) if kept else motion_of(there))
                finish(points, edge[b, k])
                place(points, to_space[b, k], sections[b, k])
            if len(measures):
                measure(points, chord[b, k], measures[b, k])


@compiled
def sized_line(
    s: Section, total: Numbers, line: Numbers, turned: bool, now: Array, work: Array
) -> Numbers:
    """Bring a section's points to size, and return the chord line that it has then."""
    carry(s.points, total)
    if turned:
        carried(s.c, total, now)
        after: Numbers = chord_line(Section(s.u, s.slopes, now, s.points), work)
        return after
    kept: Numbers = both(line, total)  # a stretch normal to it keeps it (`ChordLines.sized`)
    return kept


@compiled
def lines(
    u: Array, values: Array, slopes: Array, coefficients: Array, target: Array, result: Array
) -> None:
    """Fill the chord lines (k, b, 4) of sections at relative thickness (k, b); see `made`."""
    spans, count, features, _ = coefficients.shape
    points, moved = np.empty((2, len(u))), np.empty((2, len(u)))
    now, work = np.empty((features, 2)), np.empty(len(u))
    for k in range(spans):
        for b in range(count):
            combine(values[k], coefficients[k, b], points)
            section = Section(u, slopes[k], coefficients[k, b], points)
            total, _, line, _, turned = sizing(section, values[k], target[k, b], now, moved, work)
            after = sized_line(section, total, line, turned, now, work)
            for j in range(4):
                result[k, b, j] = after[j]


@compiled
def laddered(points: Array) -> bool:
    """Tell whether triangles between the sides prove a section sound (`separation.ladders`)."""
    x, y = points[0], points[1]
    n = len(x)
    turns = (x[0] > x[-1]) != (x[-1] > x[-2])
    turns += (x[0] > x[-1]) != (x[1] > x[0])
    for i in range(1, n - 1):
        turns += (x[i + 1] > x[i]) != (x[i] > x[i - 1])
    flipped = 0
    for i in range(n // 2):
        ax, ay = x[i] - x[-1 - i], y[i] - y[-1 - i]
        bx, by = x[i + 1] - x[-2 - i], y[i + 1] - y[-2 - i]
        flipped += not ax * (y[-2 - i] - y[-1 - i]) - ay * (x[-2 - i] - x[-1 - i]) >= FLAT
        flipped += not bx * (y[i + 1] - y[i]) - by * (x[i + 1] - x[i]) >= FLAT
    return turns <= 2 and flipped == 0


@compiled
def compared(points: Array, seen: Array) -> int:
    """Tell whether a section crosses itself from the graphs of its sides (`separation.graphs`).

    `seen` is filled with the section turned so that it goes back and forth only once.
    """
    x, y = seen[0], seen[1]
    n = len(x)
    for angle in ANGLES:
        c, s = cos(angle), sin(angle)
        for i in range(n):
            x[i] = points[0, i] * c + points[1, i] * s
            y[i] = points[1, i] * c - points[0, i] * s
        right, left, turns = ZERO, ZERO, 0
        for i in range(n):
            before, after = x[i] - x[i - 1], x[following(i, ONE, n)] - x[i]
            turns += not before * after > 0.0  # a side that stands upright is left open
            right = i if x[i] > x[right] else right
            left = i if x[i] < x[left] else left
        if turns == 2:
            back = gaps(x, y, right, left, ONE)
            forth = gaps(x, y, right, left, -ONE)
            least, most = min(back[0], -forth[1]), max(back[1], -forth[0])
            if least >= APART:
                return SOUND
            return CROSSING if least <= -APART and most >= APART else OPEN
    return OPEN


@compiled
def gaps(x: Array, y: Array, right: int, left: int, way: int) -> Numbers:
    """Return the least and largest height of one side's landmarks over the other side.

    The one is walked from its right end to its left in steps of `way`, the other against it.
    """
    n = len(x)
    low, high = inf, -inf
    a, b = following(right, way, n), right
    c = following(b, -way, n)
    while a != left:
        while x[c] > x[a]:
            b, c = c, following(c, -way, n)
        gap = y[a] - y[b] - (y[c] - y[b]) * (x[a] - x[b]) / (x[c] - x[b])
        low, high = min(low, gap), max(high, gap)
        a = following(a, way, n)
    return low, high


@compiled
def following(i: int, way: int, n: int) -> int:
    """Return the landmark one step on around a contour of n."""
    i += way
    return 0 if i == n else n - 1 if i < 0 else i


@compiled
def finish(points: Array, thickness: float) -> None:
    """Open the trailing edge of a section in chords to a thickness at least (`edges`)."""
    x, y = points[0], points[1]
    missing = 0.25 * (thickness * thickness - (y[0] - y[-1]) ** 2)
    if not missing > 0.0:
        return
    for i in range(len(x) // 2):
        f = min(max((0.5 * (x[i] + x[-1 - i]) - AHEAD) / (BEHIND - AHEAD), 0.0), 1.0)
        weight = f * f * f * (10.0 - 15.0 * f + 6.0 * f * f)
        middle, half = 0.5 * (y[i] + y[-1 - i]), 0.5 * (y[i] - y[-1 - i])
        half = sqrt(half * half + weight * missing)
        y[i] = middle + half
        y[-1 - i] = middle - half


@compiled
def place(points: Array, to_space: Array, section: Array) -> None:
    """Fill a section (n, 3) with the map (3, 3) of (x, y, 1)."""
    x, y, flat = points[0], points[1], section.reshape(-1)
    a, b, c = to_space[0], to_space[1], to_space[2]
    a0, a1, a2, b0, b1, b2 = a[0], a[1], a[2], b[0], b[1], b[2]
    for i in range(len(x)):  # all three at once: a line of memory is written once
        flat[3 * i] = a0 * x[i] + b0 * y[i] + c[0]
        flat[3 * i + 1] = a1 * x[i] + b1 * y[i] + c[1]
        flat[3 * i + 2] = a2 * x[i] + b2 * y[i] + c[2]


@compiled
def measure(points: Array, chord: float, measures: Array) -> None:
    """Fill `polygons.MEASURES` (7,) of a section in chords."""
    x, y = points[0], points[1]
    area, sx, sy, xx, yy, xy, around = edge_sums(x[-1], y[-1], x[0], y[0])
    for i in range(1, len(x)):
        parts = edge_sums(x[i - 1], y[i - 1], x[i], y[i])
        area += parts[0]
        sx += parts[1]
        sy += parts[2]
        xx += parts[3]
        yy += parts[4]
        xy += parts[5]
        around += parts[6]
    cx, cy = sx / (3.0 * area), sy / (3.0 * area)
    area *= 0.5
    measures[0] = area * chord**2
    measures[1] = cx * chord
    measures[2] = cy * chord
    measures[3] = (xx / 12.0 - area * cy**2) * chord**4
    measures[4] = (yy / 12.0 - area * cx**2) * chord**4
    measures[5] = (xy / 24.0 - area * cx * cy) * chord**4
    measures[6] = around * chord


@compiled
def edge_sums(x: float, y: float, x1: float, y1: float) -> Numbers:
    """Return what an edge adds to the sums of `measure`."""
    twice = x * y1 - x1 * y
    return (
        twice,
        (x + x1) * twice,
        (y + y1) * twice,
        (y * (y + y1) + y1 * y1) * twice,
        (x * (x + x1) + x1 * x1) * twice,
        (x * (y1 + 2.0 * y) + x1 * (y + 2.0 * y1)) * twice,
        sqrt((x1 - x) ** 2 + (y1 - y) ** 2),
    )
