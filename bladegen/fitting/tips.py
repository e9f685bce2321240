"""Where a blade ends: the span at which planes normal to its axis still cut a section."""

import numpy as np

from bladegen.definition.reference_axis import ReferenceAxis
from bladegen.support.arrays import Array

__all__ = ["length_along"]

OUTER = 0.9  # of the length, from which on points may be the last
ROUNDS = 6


def length_along(points: Array, axis: ReferenceAxis) -> float:
    """Return the z of the axis at which a plane normal to it meets the last of points (m, 3).

    The axis is prolonged straight beyond its end.
    """
    length = float(axis.z(1.0))
    last = points[points[:, 2] > OUTER * length]
    z = last[:, 2]
    for _ in range(ROUNDS):
        at = np.clip(z / length, 0.0, 1.0)
        tangent = axis(at, 1) / length
        place = axis(at) + tangent * (z - at * length)[:, None]
        z = z + np.sum((last - place) * tangent, axis=1) / np.sum(tangent * tangent, axis=1)
    return float(z.max())
