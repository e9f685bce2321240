"""Compiled: what an aerodynamicist looks at on a section, as numbers.

A section is (2, n): x, then y, trailing edge -> suction side -> leading edge -> pressure side.
All is measured in chords along its chord line and normal to it, the latter times a factor, so
that sections of different thickness can be held against each other.

A convex contour turns left all along; a side bends back where it turns right, as on the rear of a
pressure side.  What is less than `BEND` of turning is noise and no bend.
"""

from math import atan, atan2

import numpy as np

from bladegen.curves.plane_maps import Numbers
from bladegen.support.arrays import Array
from bladegen.support.compiled import ONE, ZERO, compiled

__all__ = ["characterise", "characteristics_of"]

NOSE = 0.1  # of the chord: the nose ends there
NEAR = 0.01  # of the chord behind the leading edge, where the nose's radius is taken
MEAN_LINE = np.array([NEAR, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9])
STEP = 0.005  # of the chord, at least, from point to point; what is finer is noise
BEND = np.radians(3.0)
SMALL = 0.1  # of a step's length across it; below the arc tangent is two terms to 1e-6


@compiled
def characterise(
    points: Array, line: Numbers, flat: float, turned: Array, work: Array, result: Array
) -> None:
    """Fill `sanity.CHARACTERISTICS` (6,) of a section.

    `line` is leading edge and trailing-edge midpoint (4,), `flat` the factor across the chord;
    `turned` (2, n) and `work` (n,) are written over.
    """
    x, y = turned[0], turned[1]
    ax, ay = line[2] - line[0], line[3] - line[1]
    scale = 1.0 / (ax * ax + ay * ay)
    ax, ay = ax * scale, ay * scale
    for i in range(len(x)):
        p, q = points[0, i] - line[0], points[1, i] - line[1]
        x[i] = p * ax + q * ay
        y[i] = (q * ax - p * ay) * flat
    nose = ZERO
    for i in range(len(x)):
        nose = i if x[i] < x[nose] else nose
    turning(x, y, nose, result)
    count = len(MEAN_LINE)
    heights(x, y, nose, -ONE, work[:count])
    heights(x, y, nose, ONE, work[count:])
    height = work[0] - work[count]
    result[1] = height * height / (8.0 * NEAR)
    result[4] = 0.0
    for j in range(1, count):
        result[4] += 0.5 * (work[j] + work[count + j]) / (count - 1)
    result[5] = atan(0.5 * (work[count - 1] + work[2 * count - 1]) / (1.0 - MEAN_LINE[-1]))


@compiled
def turning(x: Array, y: Array, nose: int, result: Array) -> None:
    """Fill what follows from the turning of a contour: the nose's notch and the sides' bends."""
    angle, high, low, way, bends = 0.0, 0.0, 0.0, 0, 0
    notch, most = 0.0, -np.inf
    last, px, py = 0, 0.0, 0.0
    for i in range(1, len(x)):
        if i == nose:
            result[2] = bends
            bends = 0
        qx, qy = x[i] - x[last], y[i] - y[last]
        if qx * qx + qy * qy < STEP * STEP:
            continue
        angle += between_steps(px, py, qx, qy)
        if x[last] < NOSE:
            most = max(most, angle)
            notch = max(notch, most - angle)
        last, px, py = i, qx, qy
        high, low = max(high, angle), min(low, angle)
        if way >= 0 and angle < high - BEND:
            bends += way
            way, low = -1, angle
        elif way <= 0 and angle > low + BEND:
            bends -= way
            way, high = 1, angle
    result[0], result[3] = notch, bends


@compiled
def between_steps(px: float, py: float, qx: float, qy: float) -> float:
    """Return the angle from one step to the next, positive to the left; 0 for one of no length."""
    across, along = px * qy - py * qx, px * qx + py * qy
    if abs(across) < SMALL * along:
        r = across / along
        return r - r * r * r / 3.0
    return atan2(across, along) if across != 0.0 or along != 0.0 else 0.0


@compiled
def heights(x: Array, y: Array, nose: int, way: int, result: Array) -> None:
    """Fill heights (m,) of a side at `MEAN_LINE`, walked from the nose in steps of `way`."""
    i, last = nose, (0 if way < 0 else len(x) - 1)
    for j in range(len(MEAN_LINE)):
        while i != last and x[i] < MEAN_LINE[j]:
            i += way
        before = i - way
        width = x[i] - x[before]
        share = (MEAN_LINE[j] - x[before]) / width if width > 0.0 else 1.0
        result[j] = y[before] + min(share, 1.0) * (y[i] - y[before])


@compiled
def characteristics_of(points: Array, lines: Array, flat: Array, result: Array) -> None:
    """Fill the characteristics (m, 6) of sections (m, 2, n) with lines (m, 4) and factors (m,)."""
    turned, work = np.empty(points.shape[1:]), np.empty(points.shape[2])
    for i in range(len(points)):
        line = lines[i, 0], lines[i, 1], lines[i, 2], lines[i, 3]
        characterise(points[i], line, flat[i], turned, work, result[i])
