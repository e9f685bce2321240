"""From unit-chord sections to sections in space: chord, twist, offsets and section planes.

Blade frame: origin at the root on the pitch axis, x to the suction side, y to the trailing
edge, z to the tip.  Positive twist moves the leading edge upwind (to -x).  Before a section
is tilted to its plane, an airfoil point (x, y) with chord c, twist t and axis (Xa, Ya, Za)
lies at

    X = Xa + h cos t + a sin t        a = c x - section_offset_y   (along the chord)
    Y = Ya + a cos t - h sin t        h = c y + section_offset_x   (normal to the chord)

This is the one place where these signs stand.  Frames are rotation-minimising along the
reference axis: no roll is added (Wang, Juttler, Zheng & Liu, ACM TOG 27 (2008)).

The root is a flange: over the round root, from span fraction 0 to r (`root_end`), the normals of
sections turn from the pitch axis to the reference axis.  With f = eta / r, they are along

    (w x', w y', z')        w = f^3 (10 - 15 f + 6 f^2)
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import cast

import numpy as np

from bladegen.blade.changes.window import Window
from bladegen.definition.blade_definition import BladeDefinition, ReferenceAxis
from bladegen.definition.fair_planform import PlanformFairing
from bladegen.errors import DefinitionError
from bladegen.support.arguments import function
from bladegen.support.arrays import Array
from bladegen.support.values import brief, state_of

__all__ = [
    "PLANES",
    "Frames",
    "Planform",
    "SectionPlanes",
    "flange_to_axis",
    "normal_to_axis",
    "normal_to_z",
    "placement",
    "root_end",
]

AT_REST = 1e-6  # of the span, from an end at which the axis has no velocity
ROOT = 0.02  # of the span: IEA 15 and 22 MW are round so far, DTU 10 and NREL 5 MW to 0.023
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
    grid = frame_grid(axis)
    tangents = _tangents(axis, grid, root)
    steps = turn(np.concatenate([[[0.0, 0.0, 1.0]], tangents[:-1]]), tangents)
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
    along = direction(axis, eta, root)
    unit: Array = along / np.linalg.norm(along, axis=-1, keepdims=True)
    return unit


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


@dataclass(frozen=True, eq=False)
class Planform:
    """Chord, twist, offsets and axis of a blade, and where they put its sections.

    Parameters
    ----------
    definition : BladeDefinition
        The distributions.
    planes : callable
        Section planes: `flange_to_axis`, `normal_to_axis` or `normal_to_z`.
    fair_planform : PlanformFairing, optional
        How far the definition's distributions were moved to be C2, if they were.
    frames : AxisFrames, optional
        Section frames (k, 3, 3) as a function of span; those of another planform are kept where
        axis and planes are the same.
    """

    definition: BladeDefinition
    planes: SectionPlanes = flange_to_axis
    fair_planform: PlanformFairing | None = None
    frames: AxisFrames = field(default=cast(AxisFrames, None), repr=False)

    def __post_init__(self) -> None:
        must = "a function such as bladegen.blade.planform.normal_to_z"
        function(self.planes, "planes", must, DefinitionError)
        axis, known, root = self.definition.axis, self.frames, root_end(self.definition)
        if (
            known is None
            or known.axis is not axis
            or known.planes is not self.planes
            or known.root != root
        ):
            object.__setattr__(self, "frames", AxisFrames(axis, self.planes, root))

    def __repr__(self) -> str:
        return f"<Planform of {self.definition.name}>"

    def place(self, profiles: Array, eta: Array) -> Array:
        """Put unit-chord sections in space.

        Parameters
        ----------
        profiles : (k, n, 2) array
            Sections in chords, airfoil axes.
        eta : (k,) array
            Their span fractions.

        Returns
        -------
        (k, n, 3) array
            Points [m], blade frame.
        """
        blade = self.definition
        axes, start = placement(
            blade.chord(eta),
            blade.twist(eta),
            np.stack([-blade.offset_y(eta), blade.offset_x(eta)], axis=-1),
            blade.axis(eta),
            self.frames(eta),
        )
        planes = np.ones((3, *profiles.shape[:-1]))
        planes[:2] = profiles.transpose(2, 0, 1)
        maps = np.concatenate([axes, start[:, None]], axis=1)
        placed: Array = planes.transpose(1, 2, 0) @ maps
        return placed


def placement(
    chord: Array, twist: Array, offset: Array, axis: Array, frames: Array
) -> tuple[Array, Array]:
    """Return the maps from sections in chords to space.

    Parameters
    ----------
    chord, twist : (...) arrays
        [m] and [rad].
    offset : (..., 2) array
        The leading edge from the axis, along the chord and normal to it [m].
    axis : (..., 3) array
        The reference axis [m].
    frames : (..., 3, 3) array
        Rows: the section's x and y, and the plane's normal.

    Returns
    -------
    axes, start : (..., 2, 3), (..., 3) arrays
        A section's points are ``profile @ axes + start``.
    """
    c, s = np.cos(twist), np.sin(twist)
    turn = np.empty((*c.shape, 2, 2))
    turn[..., 0, 0], turn[..., 0, 1], turn[..., 1, 0], turn[..., 1, 1] = s, c, c, -s
    axes = turn @ frames[..., :2, :]  # rows: along the chord, normal to it
    start = axis + (offset[..., None, :] @ axes)[..., 0, :]
    return chord[..., None, None] * axes, start
