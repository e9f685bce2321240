"""How the maps of sections to space change with chord, twist, offset and prebend.

The laws are those of `blade.planform` and `blade.section_planes`; here stand their derivatives.
Section planes that follow the axis are carried along it by rotations, whose running product is
followed by its derivative: products of ``[[R, 0], [dR, R]]`` hold both.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.blade.planform import Planform, placement
from bladegen.blade.section_planes import (
    UPRIGHT,
    crossing,
    direction,
    frame_grid,
    in_a_plane,
    normal_to_z,
    running_product,
    stretched,
    turn,
)
from bladegen.blade.variants.placing import Placing
from bladegen.errors import PerturbationError
from bladegen.support.arrays import Array

__all__ = ["CHORD", "OFFSET", "PREBEND", "TWIST", "PlacedSlopes"]

CHORD, TWIST, OFFSET, PREBEND = range(4)


@dataclass(frozen=True, eq=False)
class PlacedSlopes:
    """Maps of a blade's sections to space, and their derivatives."""

    placing: Placing

    @property
    def planform(self) -> Planform:
        """The blade's own."""
        return self.placing.blade.planform

    def __call__(
        self, chord: Array, twist: Array, offset_y: Array, prebend: Array | None
    ) -> tuple[Array, Array]:
        """Return maps (b, k, 3, 3) of (x, y, 1) to space and their derivatives (b, k, 4, 3, 3).

        Chord [m], twist [rad] and offset [m] are (b, k), the prebend's scale (b,), or None if it
        stays 1.  Derivatives are in these four, in the order of `CHORD`, ....
        """
        offset = np.stack(np.broadcast_arrays(-offset_y, self.placing.own.offset_x), axis=-1)
        axis, own_frames = self.placing.own_axis
        frames, bending = own_frames[None], np.zeros((1, *own_frames.shape))
        if prebend is not None:
            axis = stretched(axis, prebend)
            frames, bending = self._frames(prebend)
        axes, start = placement(chord, twist, offset, axis, frames)
        to_space = np.concatenate([axes, start[..., None, :]], axis=-2)
        slopes = np.zeros((*chord.shape, 4, 3, 3))
        unit = axes / chord[..., None, None]
        slopes[:, :, CHORD, :2] = unit
        turned = np.stack([unit[..., 1, :], -unit[..., 0, :]], axis=-2)  # of both rows in the twist
        slopes[:, :, TWIST, :2] = chord[..., None, None] * turned
        slopes[:, :, TWIST, 2] = (offset[..., None, :] @ turned)[..., 0, :]
        slopes[:, :, OFFSET, 2] = -unit[..., 0, :]
        if prebend is not None:
            still = np.zeros(1)
            bent, moved = placement(chord, twist, offset, still, bending)
            slopes[:, :, PREBEND, :2] = bent
            slopes[:, :, PREBEND, 2] = moved
            slopes[:, :, PREBEND, 2, 0] += self.placing.own_axis[0][:, 0]
        return to_space, slopes

    def _frames(self, scale: Array) -> tuple[Array, Array]:
        """Return section frames (b or 1, k, 3, 3) and their derivatives in the prebend's scale."""
        still, root = self.placing.own_axis[1][None], self.planform.frames.turning
        if self.planform.planes is normal_to_z:
            return still, np.zeros_like(still)
        if root is None:
            raise PerturbationError(
                "parameters: prebend_scale needs section planes normal to the axis or to z, or "
                "from one to the other; derivatives of others are not known"
            )
        axis, eta = self.planform.definition.axis, self.placing.eta
        values, inverse = np.unique(scale, return_inverse=True)
        end, change = _tangents(direction(axis, eta, root), values)
        if in_a_plane(axis):
            both = _turns(UPRIGHT, np.zeros(3), end, change)[inverse]
        else:
            own = np.stack([self._carried(value, root) for value in values])
            both = (own @ _turns(own[..., 2, :3], own[..., 5, :3], end, change))[inverse]
        return both[..., :3, :3], both[..., 3:, :3]

    def _carried(self, scale: float, root: float) -> Array:
        """Return frames on the grid before the spans, ``[[F, 0], [dF, F]]`` (k, 6, 6)."""
        axis = self.planform.definition.axis
        grid = frame_grid(axis)
        tangents, changes = _tangents(direction(axis, grid, root), np.array([scale]))
        starts = np.concatenate([UPRIGHT[None], tangents[0, :-1]])
        starting = np.concatenate([np.zeros((1, 3)), changes[0, :-1]])
        carried = running_product(_turns(starts, starting, tangents[0], changes[0]))
        before = np.searchsorted(grid, self.placing.eta, side="right") - 1
        result: Array = carried[np.clip(before, 0, len(grid) - 1)]
        return result


def _tangents(along: Array, scale: Array) -> tuple[Array, Array]:
    """Return unit tangents (b, m, 3) of an axis under prebend's factors, and their derivatives."""
    scaled = stretched(along, scale)
    length = np.linalg.norm(scaled, axis=-1, keepdims=True)
    unit, change = scaled / length, along * np.array([1.0, 0.0, 0.0]) / length
    return unit, change - unit * np.sum(unit * change, axis=-1, keepdims=True)


def _turns(start: Array, start_change: Array, end: Array, end_change: Array) -> Array:
    """Return `section_planes.turn` from start to end and its derivative as (..., 6, 6) matrices."""
    K = crossing(np.cross(start, end))
    change = crossing(np.cross(start_change, end) + np.cross(start, end_change))
    c = np.sum(start * end, axis=-1)[..., None, None]
    dc = np.sum(start_change * end + start * end_change, axis=-1)[..., None, None]
    result = np.zeros((*end.shape[:-1], 6, 6))
    result[..., :3, :3] = result[..., 3:, 3:] = turn(start, end)
    result[..., 3:, :3] = change + (change @ K + K @ change) / (1.0 + c)
    result[..., 3:, :3] -= K @ K * dc / (1.0 + c) ** 2
    return result
