"""Compiled: the map that brings a section to unit chord and to a relative thickness.

`section_curves.SectionCurves.normalising` once more, for one section in a loop of a compiled
function, with the notation and the tolerances there.  What is measured: `section_measures` and
`nose_measures`.
"""

from math import exp, log, nan

from bladegen.airfoils.resizing import LITTLE
from bladegen.airfoils.section_curves import FASTEST, SETTLED, SLOWEST
from bladegen.blade.variants.nose_measures import lead, other_nose
from bladegen.blade.variants.section_measures import Section, thickest
from bladegen.curves.plane_maps import Numbers, carried, combine, distance
from bladegen.curves.roots import ITERATIONS
from bladegen.support.arrays import Array
from bladegen.support.compiled import compiled

__all__ = ["chord_line", "sizing"]

Room = tuple[Array, Array, Array]  # for coefficients (F, 2), points (2, n), and n numbers


@compiled
def sizing(
    s: Section, values: Array, target: float, now: Array, moved: Array, work: Array
) -> tuple[Numbers, float, Numbers, Numbers, bool]:
    """Return the map that brings a section to size, and the relative thickness it has.

    Maps are (a, b, c, d, e, f): x' = a x + c y + e and y' = b x + d y + f.  Returned besides are
    the chord line that it has, leading edge and trailing-edge midpoint, its direction, and whether
    the map may turn it.
    """
    nose, edge, _, wide, best = lead(s, work)
    length = distance(nose, edge)
    along = (edge[0] - nose[0]) / length, (edge[1] - nose[1]) / length
    thickness = thickest(s, along, work)[0]
    stretch = target * length / thickness
    total = stretching(edge, along, stretch, length)
    if not wide and abs(stretch - 1.0) > LITTLE:
        wide = other_nose(s, edge, total, best, work)
    if wide:
        total = rounded(s, values, (edge, along, length), target, stretch, (now, moved, work))
    return total, thickness / length, (nose[0], nose[1], edge[0], edge[1]), along, wide


@compiled
def chord_line(s: Section, work: Array) -> Numbers:
    """Return x and y of the leading edge and of the trailing-edge midpoint (`ChordLines.of`)."""
    nose, edge, _, _, _ = lead(s, work)
    return nose[0], nose[1], edge[0], edge[1]


@compiled
def stretching(start: Numbers, along: Numbers, stretch: float, reach: float) -> Numbers:
    """Return the map that stretches normal to a line from a point, then brings to unit chord."""
    ax, ay = along
    scale, lift = 1.0 / reach, stretch - 1.0
    a, b, d = 1.0 + lift * ay * ay, -lift * ax * ay, 1.0 + lift * ax * ax
    e, f = start[0] - (start[0] * a + start[1] * b), start[1] - (start[0] * b + start[1] * d)
    return scale * a, scale * b, scale * b, scale * d, scale * e, scale * f


@compiled
def rounded(
    s: Section,
    values: Array,
    line: tuple[Numbers, Numbers, float],
    target: float,
    start: float,
    room: Room,
) -> Numbers:
    """Return the map where the leading edge may be a mean of many points (`_round`).

    `line` is the section's own: the trailing-edge midpoint, the direction, and the chord.
    """
    edge, along, chord = line
    now, moved, work = room
    more = missing = step = 0.0  # logarithms
    reach, slope, known = chord, nan, False
    for _ in range(ITERATIONS):
        carried(s.c, stretching(edge, along, start * exp(more), 1.0), now)
        combine(values, now, moved)
        some = Section(s.u, s.slopes, now, moved)
        nose, end, _, _, _ = lead(some, work)
        reach = distance(nose, end)
        if known:
            break
        own = (end[0] - nose[0]) / reach, (end[1] - nose[1]) / reach
        left = log(target * reach / thickest(some, own, work)[0])
        if abs(left) <= SETTLED:
            break
        rate = (missing - left) / step if step != 0.0 else 1.0
        if rate < 0.0:
            more, reach = 0.0, chord
            break
        known, slope = abs(left * (rate - slope)) <= SETTLED, rate
        missing, step = left, left / min(max(rate, SLOWEST), FASTEST)
        more += step
    total: Numbers = stretching(edge, along, start * exp(more), reach)
    return total
