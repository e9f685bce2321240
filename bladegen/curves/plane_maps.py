"""Compiled: vectors and maps of the plane, and the sections that they carry.

Maps are (a, b, c, d, e, f): x' = a x + c y + e and y' = b x + d y + f.  Points are (2, n): x, then
y; sections are linear in features (`batch`), of which the last is constant.
"""

from math import sqrt

import numpy as np

from bladegen.support.arrays import Array
from bladegen.support.compiled import compiled

__all__ = [
    "Numbers",
    "between",
    "both",
    "carried",
    "carry",
    "combine",
    "distance",
    "followed",
    "inverted",
    "motion_of",
    "onto",
    "turned",
]

Numbers = tuple[float, ...]


@compiled
def between(one: Numbers, two: Numbers, share: float) -> Numbers:
    """Return the point at a share of the way from one to another."""
    return one[0] + share * (two[0] - one[0]), one[1] + share * (two[1] - one[1])


@compiled
def distance(point: Numbers, other: Numbers) -> float:
    """Return the distance of two points."""
    x, y = point[0] - other[0], point[1] - other[1]
    return sqrt(x * x + y * y)


@compiled
def turned(x: float, y: float, along: Numbers) -> Numbers:
    """Return a vector's parts along a direction and normal to it."""
    return x * along[0] + y * along[1], y * along[0] - x * along[1]


@compiled
def combine(values: Array, c: Array, points: Array) -> None:
    """Fill points with the section of coefficients (F, 2), F odd, in features values (F, n)."""
    x, y = points[0], points[1]
    last = len(values) - 1
    v, vx, vy = values[last], c[last, 0], c[last, 1]
    for i in range(len(x)):
        x[i] = vx * v[i]
        y[i] = vy * v[i]
    for f in range(0, last, 2):
        v, vx, vy = values[f], c[f, 0], c[f, 1]
        w, wx, wy = values[f + 1], c[f + 1, 0], c[f + 1, 1]
        for i in range(len(x)):
            x[i] += vx * v[i] + wx * w[i]
            y[i] += vy * v[i] + wy * w[i]


@compiled
def carry(points: Array, total: Numbers) -> None:
    """Map a section."""
    x, y = points[0], points[1]
    a, b, c, d, e, f = total
    for i in range(len(x)):
        p, q = x[i], y[i]
        x[i] = a * p + c * q + e
        y[i] = b * p + d * q + f


@compiled
def both(line: Numbers, total: Numbers) -> Numbers:
    """Return two points (4,) mapped."""
    a, b, c, d, e, f = total
    x, y, p, q = line
    return a * x + c * y + e, b * x + d * y + f, a * p + c * q + e, b * p + d * q + f


@compiled
def carried(c: Array, total: Numbers, result: Array) -> None:
    """Fill the coefficients (F, 2) of a section that is mapped."""
    for f in range(len(c)):
        result[f, 0] = c[f, 0] * total[0] + c[f, 1] * total[2]
        result[f, 1] = c[f, 0] * total[1] + c[f, 1] * total[3]
    result[-1, 0] += total[4]
    result[-1, 1] += total[5]


@compiled
def followed(one: Numbers, two: Numbers) -> Numbers:
    """Return a map followed by another one."""
    return (
        one[0] * two[0] + one[1] * two[2],
        one[0] * two[1] + one[1] * two[3],
        one[2] * two[0] + one[3] * two[2],
        one[2] * two[1] + one[3] * two[3],
        one[4] * two[0] + one[5] * two[2] + two[4],
        one[4] * two[1] + one[5] * two[3] + two[5],
    )


@compiled
def onto(line: Numbers, wanted: Array) -> Numbers:
    """Return the motion that brings a chord line onto another (4,) (`ChordLines.onto`)."""
    ax, ay = line[2] - line[0], line[3] - line[1]
    bx, by = wanted[2] - wanted[0], wanted[3] - wanted[1]
    length = sqrt((ax * ax + ay * ay) * (bx * bx + by * by))
    c, s = (ax * bx + ay * by) / length, (ax * by - ay * bx) / length
    x, y = c * line[0] - s * line[1], s * line[0] + c * line[1]
    return c, s, -s, c, wanted[0] - x, wanted[1] - y


@compiled
def motion_of(numbers: Array) -> Numbers:
    """Return the map of a motion (4,): cosine, sine and shift."""
    c, s = numbers[0], numbers[1]
    return c, s, -s, c, numbers[2], numbers[3]


@compiled
def inverted(m: Array) -> Array:
    """Return the inverse of a 3 x 3 matrix."""
    result = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            p, q, r, s = (j + 1) % 3, (j + 2) % 3, (i + 1) % 3, (i + 2) % 3
            result[i, j] = m[p, r] * m[q, s] - m[p, s] * m[q, r]
    determinant = m[0, 0] * result[0, 0] + m[0, 1] * result[1, 0] + m[0, 2] * result[2, 0]
    for i in range(3):
        for j in range(3):
            result[i, j] /= determinant
    return result
