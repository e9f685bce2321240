"""From unit-chord sections to sections in space: chord, twist and offsets in section planes.

Blade frame: origin at the root on the pitch axis, x to the suction side, y to the trailing
edge, z to the tip.  Positive twist moves the leading edge upwind (to -x).  Before a section
is tilted to its plane (`section_planes`), an airfoil point (x, y) with chord c, twist t and axis
(Xa, Ya, Za) lies at

    X = Xa + h cos t + a sin t        a = c x - section_offset_y   (along the chord)
    Y = Ya + a cos t - h sin t        h = c y + section_offset_x   (normal to the chord)

This is the one place where these signs stand.
"""

from dataclasses import dataclass, field
from typing import cast

import numpy as np

from bladegen.blade.section_planes import (
    PLANES,
    AxisFrames,
    Frames,
    SectionPlanes,
    flange_to_axis,
    normal_to_axis,
    normal_to_z,
    root_end,
)
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.fair_planform import PlanformFairing
from bladegen.errors import DefinitionError
from bladegen.support.arguments import function
from bladegen.support.arrays import Array

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
