"""Section planes: frames over span that stand upright, follow the reference axis, or turn to it.

Frames are rotation-minimising along the reference axis: no roll is added (Wang, Juttler, Zheng &
Liu, ACM TOG 27 (2008)).

The root is a flange: over the round root, from span fraction 0 to r (`root_end`), the normals of
sections turn from the pitch axis to the reference axis.  With f = eta / r, they are along

    (w x', w y', z')        w = f^3 (10 - 15 f + 6 f^2)
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.blade.changes.window import Window
from bladegen.definition.blade_definition import BladeDefinition, ReferenceAxis
from bladegen.support.arrays import Array
from bladegen.support.values import brief, state_of

__all__ = [
    "PLANES",
    "AxisFrames",
    "Frames",
    "SectionPlanes",
    "flange_to_axis",
    "normal_to_axis",
    "normal_to_z",
    "root_end",
]

AT_REST = 1e-6  # of the span, from an end at which the axis has no velocity
ROOT = 0.02  # of the span: IEA 15 and 22 MW are round so far, DTU 10 and NREL 5 MW to 0.023
UPRIGHT = np.array([0.0, 0.0, 1.0])
FRAME_STEPS = 2000  # spans at which frames are carried; a sweep of 10 % turns by 1e-4 rad a step

Frames = Callable[[Array], Array]
SectionPlanes = Callable[[ReferenceAxis], Frames]


def root_end(definition: BladeDefinition) -> float:
    """Return the span fraction up to which section planes turn: `ROOT`, 0 if no root is round.

    It asks no station but the first, so that a blade with more stations is the same blade.
    """
    return ROOT if definition.stations[0].airfoil.is_round else 0.0


def normal_to_z(axis: ReferenceAxis) -> Frames:  # noqa: ARG001
    """Keep all section planes normal to the pitch axis z."""
    return lambda eta: np.broadcast_to(np.eye(3), (*eta.shape, 3, 3))


def normal_to_axis(axis: ReferenceAxis) -> Frames:
    """Turn section planes normal to the reference axis, without adding roll."""
    return flange_to_axis(axis, 0.0)


def flange_to_axis(axis: ReferenceAxis, root: float = ROOT) -> Frames:
    """Turn section planes from the flange to the reference axis, then with it, without roll.

    Parameters
    ----------
    axis : ReferenceAxis
        What they follow.
    root : float
        Span fraction from which on they are normal to the axis; at 0 they are normal to z.

    Returns
    -------
    callable
        From span fractions (k,) to frames (k, 3, 3), whose rows are the unit vectors of the
        section's x, its y and the axis' tangent.
    """
    if in_a_plane(axis):
        return lambda eta: turn(UPRIGHT, _tangents(axis, eta, root))
    grid = frame_grid(axis)
    tangents = _tangents(axis, grid, root)
    steps = turn(np.concatenate([[UPRIGHT], tangents[:-1]]), tangents)
    carried = running_product(steps)

    def frames(eta: Array) -> Array:
        i = np.clip(np.searchsorted(grid, eta, side="right") - 1, 0, len(grid) - 1)
        return carried[i] @ turn(carried[i, 2], _tangents(axis, eta, root))

    return frames


PLANES: dict[str, SectionPlanes] = {
    "flange": flange_to_axis,
    "axis": normal_to_axis,
    "z": normal_to_z,
}


def in_a_plane(axis: ReferenceAxis) -> bool:
    """Tell whether an axis has no sweep, or no prebend.

    All turns along it are then about one line: the turn from the pitch axis at once is the product
    of all turns on the way.
    """
    return any(bool(np.all(one.values == one.values[0])) for one in (axis.x, axis.y))


def frame_grid(axis: ReferenceAxis) -> Array:
    """Return the span fractions at which frames are carried along an axis, (m,)."""
    return np.union1d(np.linspace(0.0, 1.0, FRAME_STEPS + 1), axis.z.grid)


def running_product(matrices: Array) -> Array:
    """Return the products of the first 1, 2, 3, ... of some matrices (m, j, j).

    In rows of the root of m, all rows at once, then from row to row: twice as many products as
    one after the other, in few calls.
    """
    count = len(matrices)
    width = math.isqrt(count - 1) + 1
    rows = np.tile(np.eye(matrices.shape[-1]), (width, width, 1, 1))
    rows.reshape(-1, *matrices.shape[1:])[:count] = matrices
    for place in range(1, width):
        rows[:, place] = rows[:, place - 1] @ rows[:, place]
    for row in range(1, width):
        rows[row] = rows[row - 1, -1] @ rows[row]
    product: Array = rows.reshape(-1, *matrices.shape[1:])[:count]
    return product


def _tangents(axis: ReferenceAxis, eta: Array, root: float) -> Array:
    return normalised(direction(axis, eta, root))


def normalised(vectors: Array) -> Array:
    """Return vectors (..., 3) at a length of 1."""
    unit: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit


def stretched(vectors: Array, scale: Array) -> Array:
    """Return points or directions (b, k, 3) along an axis, of (k, 3), under factors of its x."""
    result: Array = np.repeat(vectors[None], len(scale), axis=0)
    result[..., 0] *= scale[:, None]
    return result


def direction(axis: ReferenceAxis, eta: Array, root: float) -> Array:
    """Return vectors (..., 3) along the normals of sections, nowhere zero.

    The axis' derivative over span; beyond its ends, as there; along z at the root, and on the way
    from there to the axis up to the end of the `root`.
    """
    start, end = axis.z.grid[0], axis.z.grid[-1]
    leaning = np.ones((*np.shape(eta), 3))
    if root > 0.0:
        leaning[..., :2] = Window(0.0, root)(np.asarray(eta))[..., None]
    along: Array = leaning * axis(np.clip(eta, start, end), 1)
    still = ~np.any(along, axis=-1, keepdims=True)
    if still.any():  # monotone splines may start from rest: the direction just inside holds
        inside = np.clip(eta, start + AT_REST * (end - start), end - AT_REST * (end - start))
        along = np.where(still, leaning * axis(inside, 1), along)
    return along


def turn(start: Array, end: Array) -> Array:
    """Return the smallest rotation that takes unit vectors `start` to `end`, acting on rows."""
    c = np.sum(start * end, axis=-1)[..., None, None]
    outer = start[..., :, None] * end[..., None, :]
    cross = outer - outer.mT  # `crossing` of the cross product
    rotation: Array = np.eye(3) + cross + cross @ cross / (1.0 + c)
    return rotation


def crossing(v: Array) -> Array:
    """Return the matrices (..., 3, 3) whose product from the right is that with vectors v."""
    matrices: Array = np.zeros((*v.shape, 3))
    matrices[..., 0, 1], matrices[..., 1, 2], matrices[..., 2, 0] = v[..., 2], v[..., 0], v[..., 1]
    matrices -= matrices.mT
    return matrices


@dataclass(frozen=True, eq=False)
class AxisFrames:
    """Section frames (k, 3, 3) along an axis as a function of span, made when first needed."""

    axis: ReferenceAxis
    planes: SectionPlanes
    root: float

    __repr__ = brief

    __getstate__ = state_of

    @cached_property
    def _frames(self) -> Frames:
        if self.planes is flange_to_axis:  # the one that asks where the round root ends
            return flange_to_axis(self.axis, self.root)
        return self.planes(self.axis)

    def __call__(self, eta: Array) -> Array:
        return self._frames(eta)

    @property
    def turning(self) -> float | None:
        """Where planes are normal to the axis from, if they are; None if they are not."""
        if self.planes is flange_to_axis:
            return self.root
        return 0.0 if self.planes is normal_to_axis else None

    def bent(self, scale: Array, eta: Array) -> Array | None:
        """Return frames (b, k, 3, 3) under factors (b,) of the prebend, all at once.

        None where that cannot be: planes of one's own, or an axis that is not `in_a_plane`.
        """
        if self.planes is normal_to_z:
            return self(eta)[None]
        if self.turning is None or not in_a_plane(self.axis):
            return None
        along = direction(self.axis, eta, self.turning)
        if not along[..., 2].all():  # of an axis that starts across z: its prebend may vanish
            return None
        return turn(UPRIGHT, normalised(stretched(along, scale)))
