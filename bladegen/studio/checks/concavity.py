"""How hollow the sides of sections are: what their outlines turn back, in all, on either side.

An outline turns the same way all round where it is convex; what it turns the other way between the
nose and the tail is summed.  Beyond `TAIL` of the landmarks nothing is looked at: trailing edges
end in corners.
"""

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["hollows"]

TAIL = 0.04  # of a side's landmarks, at the trailing edge
NOSE = 0.10  # of them, at the nose: what turns back there is the check of noses


def hollows(sections: Array) -> Array:
    """Return what suction and pressure sides (k, 2) of sections (k, n, 3) turn back [rad]."""
    step = np.diff(sections, axis=1)
    x, y, z = np.moveaxis(step, -1, 0)
    # in the plane normal to the span's axis: sections lean by few degrees, which turns keep
    cross = x[:, :-1] * y[:, 1:] - y[:, :-1] * x[:, 1:]
    dot = x[:, :-1] * x[:, 1:] + y[:, :-1] * y[:, 1:] + z[:, :-1] * z[:, 1:]
    turn = np.arctan2(cross, dot)
    turn *= np.sign(turn.sum(axis=1, keepdims=True))
    back = np.maximum(-turn, 0.0)
    side = turn.shape[1] // 2
    tail, nose = round(TAIL * side), round(NOSE * side)
    suction = back[:, tail : side - nose].sum(axis=1)
    pressure = back[:, side + nose + 1 : turn.shape[1] - tail].sum(axis=1)
    return np.stack([suction, pressure], axis=-1)
