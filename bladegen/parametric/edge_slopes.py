"""Compiled: trailing-edge rules (`blade.edges`), on one section, and their derivatives.

A rule moves opposite landmarks i and -1 - i together.  Its derivative is written down once a
pair, as `SLOPES` numbers, and applied to any number of directions.
"""

from math import sqrt

from bladegen.blade.edges import LEAST_WEDGE, WINDOW
from bladegen.support.arrays import Array
from bladegen.support.compiled import compiled

__all__ = ["GIVEN", "MINIMUM", "SHARP", "SLOPES", "back", "carried_on", "finished"]

GIVEN, MINIMUM, SHARP = range(3)  # `AsGiven`, `MinimumThickness`, `Sharp`
SLOPES = 7  # the last: half the way between the sides before
AHEAD, BEHIND = WINDOW


@compiled
def finished(points: Array, kind: int, width: float, slopes: Array) -> float:
    """Finish a section (2, n) in chords, and fill the slopes (n // 2, 7) of what is done.

    `width` is the least thickness of the edge, in chords.  How far it was open is returned.
    """
    x, y = points[0], points[1]
    gap: float = y[0] - y[-1]
    missing = 0.25 * (width * width - gap * gap)
    for i in range(len(slopes)):
        slopes[i, 0] = 1.0
        for j in range(1, SLOPES):
            slopes[i, j] = 0.0
    if kind == GIVEN or (kind == MINIMUM and not missing > 0.0):
        return gap
    rear = 0.5 * (x[0] + x[-1])
    for i in range(len(x) // 2):
        middle, half = 0.5 * (x[i] + x[-1 - i]), 0.5 * (y[i] - y[-1 - i])
        f = min(max((middle - AHEAD) / (BEHIND - AHEAD), 0.0), 1.0)
        weight = f * f * f * (10.0 - 15.0 * f + 6.0 * f * f)
        rate = 30.0 * f * f * (1.0 - f) * (1.0 - f) / (BEHIND - AHEAD)
        s = slopes[i]
        level = 0.5 * (y[i] + y[-1 - i])
        if kind == MINIMUM:
            if not weight > 0.0:
                continue
            raised = sqrt(half * half + weight * missing)
            s[0] = half / raised  # of half the way between the sides
            s[1] = 0.5 * rate * missing / raised  # of the middle's place
            s[2] = 0.5 * weight / raised  # of what is missing
            y[i] = level + raised
            y[-1 - i] = level - raised
            continue
        if i == 0:
            s[0] = share = 0.0  # ends meet, however they lie to each other
        else:
            share = closed_share(s, half, max(0.5 * gap, 0.0), weight, rate, rear - middle)
        s[5], s[6] = 0.5 * (x[i] - x[-1 - i]), half
        across = s[5] * share
        x[i], x[-1 - i] = middle + across, middle - across
        y[i], y[-1 - i] = level + half * share, level - half * share
    return gap


@compiled
def closed_share(
    s: Array, half: float, edge: float, weight: float, rate: float, behind: float
) -> float:
    """Return the share of half the way between the sides that `Sharp` leaves, and fill slopes.

    s[0] is the share, s[1:5] its derivatives in the middle's place, half the edge's width, the
    rear's place and half the way.
    """
    if not half > 0.0:
        return 1.0
    ahead = max(behind, 0.0) / (1.0 - BEHIND)
    reach = 1.0 / (1.0 - BEHIND) if behind > 0.0 else 0.0
    least = LEAST_WEDGE * edge * weight * ahead
    free = half - edge * weight - least
    root = sqrt(free * free + least * least)
    share = (least + 0.5 * (free + root)) / half
    by_free = 0.5 * (1.0 + (free / root if root > 0.0 else 1.0))
    by_least = 1.0 + (0.5 * least / root if root > 0.0 else 0.0) - by_free
    wedge = by_least * LEAST_WEDGE
    s[0] = share
    s[1] = edge * (wedge * (rate * ahead - weight * reach) - by_free * rate) / half
    s[2] = weight * (wedge * ahead - by_free) / half if edge > 0.0 else 0.0
    s[3] = wedge * edge * weight * reach / half
    s[4] = (by_free - share) / half
    return share


@compiled
def carried_on(slopes: Array, kind: int, gap: float, width: float, step: float, d: Array) -> None:
    """Apply a rule's derivative in place to a direction d (2, n), whose width moves by `step`.

    `gap` is what `finished` returned, and `width` what it was given.
    """
    if kind == GIVEN:
        return
    x, y = d[0], d[1]
    opened = y[0] - y[-1]
    missing = 0.5 * (width * step - gap * opened)
    rear = 0.5 * (x[0] + x[-1])
    for i in range(len(x) // 2):
        s = slopes[i]
        middle, level = 0.5 * (x[i] + x[-1 - i]), 0.5 * (y[i] + y[-1 - i])
        rise = 0.5 * (y[i] - y[-1 - i])
        if kind == MINIMUM:
            raised = s[0] * rise + s[1] * middle + s[2] * missing
            y[i], y[-1 - i] = level + raised, level - raised
            continue
        across = 0.5 * (x[i] - x[-1 - i])
        share = s[1] * middle + s[2] * 0.5 * opened + s[3] * rear + s[4] * rise
        across = s[0] * across + s[5] * share
        raised = s[0] * rise + s[6] * share
        x[i], x[-1 - i] = middle + across, middle - across
        y[i], y[-1 - i] = level + raised, level - raised


@compiled
def back(slopes: Array, kind: int, gap: float, width: float, g: Array) -> float:
    """Apply the transpose of `carried_on` in place to g (2, n); return what falls to the width."""
    if kind == GIVEN:
        return 0.0
    x, y = g[0], g[1]
    opened = rear = missing = 0.0
    for i in range(len(x) // 2):
        s = slopes[i]
        level, raised = 0.5 * (y[i] + y[-1 - i]), 0.5 * (y[i] - y[-1 - i])
        middle, across = 0.5 * (x[i] + x[-1 - i]), 0.5 * (x[i] - x[-1 - i])
        if kind == MINIMUM:
            rise = s[0] * raised
            middle += s[1] * raised
            missing += 2.0 * s[2] * raised
        else:
            share = s[5] * across + s[6] * raised
            rise = s[0] * raised + s[4] * share
            across = s[0] * across
            middle += s[1] * share
            opened += s[2] * share
            rear += s[3] * share
        x[i], x[-1 - i] = middle + across, middle - across
        y[i], y[-1 - i] = level + rise, level - rise
    if kind == SHARP:
        x[0] += rear
        x[-1] += rear
    else:
        opened = -0.5 * gap * missing
    y[0] += opened
    y[-1] -= opened
    return 0.5 * width * missing
