"""Compiled: the map that brings a section to unit chord and to a relative thickness.

`section_splines.SectionSplines.normalising` once more, for one section in a loop of a compiled
function, with the notation and the tolerances there.  What is measured: `section_measures`.
"""

from math import asin, copysign, sin, sqrt

from bladegen.airfoils.resizing import RIVAL
from bladegen.airfoils.section_curves import AMBIGUOUS, EVEN, SETTLED
from bladegen.curves.plane_maps import (
    Numbers,
    between,
    combine,
    distance,
    turned,
)
from bladegen.curves.roots import HALVED, ITERATIONS, JUMP, ROUNDING, SMOOTH
from bladegen.support.arrays import Array
from bladegen.support.compiled import compiled
from bladegen.variants.section_measures import Section, noses, thickest

__all__ = ["chord_line", "sizing"]

Room = tuple[Array, Array, Array]  # for coefficients (F, 2), points (2, n), and n numbers


@compiled
def sizing(
    s: Section, values: Array, target: float, now: Array, moved: Array, work: Array
) -> tuple[Numbers, float]:
    """Return the map that brings a section to size, and the relative thickness it has.

    Maps are (a, b, c, d, e, f): x' = a x + c y + e and y' = b x + d y + f.
    """
    total, own, rivals, passed = resizing(s, target, work)
    if rivals or passed:
        other, place = shared(s, values, target, now, moved, work)
        if rivals or place > 0.0:
            total = other
    return total, own


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
    thickness = thickest(s, along, work)[0]

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
) -> tuple[Numbers, float]:
    """Return the map where noses share the edge, and their share.

    Where either may lead, it is the one that is farther now.
    """
    both, room = noses(s, work), (now, moved, work)
    first, above = stretched(s, values, both, 0.0, target, room)
    last, below = stretched(s, values, both, 1.0, target, room)
    if not above > EVEN:
        ahead = distance(both[0], both[2]) - distance(both[1], both[2])
        if below < -EVEN or ahead >= 0.0:
            return first, 0.0
        return last, 1.0
    if not below < -EVEN:
        return last, 1.0
    total, start, end = first, above, below
    place, low, high, kept, jumps = 0.0, 0.0, 1.0, 0, False
    for k in range(ITERATIONS):
        share = 0.5 if jumps else above / (above - below)
        before, place = place, low + (high - low) * share
        total, value = stretched(s, values, both, place, target, room)
        if value > 0.0:
            low, above, start = place, value, value
            below *= 0.5 if kept == 1 else 1.0
            kept = 1
        else:
            high, below, end = place, value, value
            above *= 0.5 if kept == -1 else 1.0
            kept = -1
        jumps = k >= SMOOTH and start - end > JUMP
        if abs(value) <= EVEN or abs(place - before) <= (HALVED if jumps else ROUNDING):
            break
    if jumps:
        place = low if start < -end else high
        total, _ = stretched(s, values, both, place, target, room)
    return total, place


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
    thickness = thickest(s, (ax, ay), work)[0]
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
        here, there, _ = noses(Section(s.u, s.slopes, now, moved), work)
        first, second = (here[0], here[1] / stretch), (there[0], there[1] / stretch)
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
