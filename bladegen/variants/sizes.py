"""Compiled: the map that brings a section to unit chord and to a relative thickness.

`section_curves.SectionCurves.normalising` once more, for one section in a loop of a compiled
function, with the notation and the tolerances there.  What is measured: `section_measures` and
`nose_measures`.
"""

from bladegen.airfoils.resizing import LITTLE
from bladegen.airfoils.section_curves import DOUBLED, EVEN, SETTLED, STEEPEST
from bladegen.curves.plane_maps import Numbers, combine, distance
from bladegen.curves.roots import ITERATIONS, ROUNDING
from bladegen.support.arrays import Array
from bladegen.support.compiled import compiled
from bladegen.variants.nose_measures import lead, other_nose
from bladegen.variants.section_measures import Section, thickest

__all__ = ["chord_line", "sizing"]

Room = tuple[Array, Array, Array]  # for coefficients (F, 2), points (2, n), and n numbers


@compiled
def sizing(
    s: Section, values: Array, target: float, now: Array, moved: Array, work: Array
) -> tuple[Numbers, float]:
    """Return the map that brings a section to size, and the relative thickness it has.

    Maps are (a, b, c, d, e, f): x' = a x + c y + e and y' = b x + d y + f.
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
        total = rounded(s, values, (edge, along), target, stretch, (now, moved, work))
    return total, thickness / length


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
    line: tuple[Numbers, Numbers],
    target: float,
    stretch: float,
    room: Room,
) -> Numbers:
    """Return the map where the leading edge may be a mean of many points (`_round`).

    `line` is the trailing-edge midpoint, and the direction of the section's own chord line.
    """
    edge, own = line
    stretch, reach, above = stretched(s, values, edge, own, target, stretch, room)
    side, end, below, turn = (-1.0 if above < 0.0 else 1.0), above, 0.0, 0.0
    above *= side
    for _ in range(DOUBLED):
        if not above > EVEN:
            break
        end = min(max(2.0 * end, -STEEPEST), STEEPEST)
        turn = end
        stretch, reach, below = stretched(s, values, edge, sloped(own, turn), target, stretch, room)
        below *= side
        if not below > 0.0 or abs(end) >= STEEPEST:
            break
    if below < -EVEN:
        place, low, high, kept = 0.0, 0.0, 1.0, 0
        for _ in range(ITERATIONS):
            before, place = place, low + (high - low) * (above / (above - below))
            turn = place * end
            stretch, reach, value = stretched(
                s, values, edge, sloped(own, turn), target, stretch, room
            )
            value *= side
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
    total: Numbers = stretching(edge, sloped(own, turn), stretch, reach)
    return total


@compiled
def sloped(along: Numbers, turn: float) -> Numbers:
    """Return a direction turned by a slope."""
    x, y = along[0] - turn * along[1], along[1] + turn * along[0]
    length = distance((x, y), (0.0, 0.0))
    return x / length, y / length


@compiled
def stretched(
    s: Section,
    values: Array,
    edge: Numbers,
    along: Numbers,
    target: float,
    stretch: float,
    room: Room,
) -> Numbers:
    """Stretch a section normal to a line to its edge, to a relative thickness (`_stretched`).

    Returns the stretch, the distance of the leading edge then, and by how much its own line's
    slope differs.
    """
    now, moved, work = room
    ax, ay = along
    thickness = thickest(s, along, work)[0]
    reach = beyond = 0.0
    for _ in range(ITERATIONS):
        for f in range(len(s.c)):
            now[f, 0] = s.c[f, 0] * ax + s.c[f, 1] * ay
            now[f, 1] = (s.c[f, 1] * ax - s.c[f, 0] * ay) * stretch
        now[-1, 0] -= edge[0] * ax + edge[1] * ay
        now[-1, 1] -= (edge[1] * ax - edge[0] * ay) * stretch
        combine(values, now, moved)
        nose, _, _, _, _ = lead(Section(s.u, s.slopes, now, moved), work)
        reach, beyond = distance(nose, (0.0, 0.0)), nose[1] / (stretch * nose[0])
        before, stretch = stretch, target * reach / thickness
        if abs(stretch - before) <= SETTLED * stretch:
            break
    return stretch, reach, beyond
