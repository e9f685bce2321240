"""Where the sections of many variants of a blade stand: chord, twist, offset, axis."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.changes.deformation import AffineChange, Window, faded
from bladegen.blade.planform import placement
from bladegen.blade.section_planes import stretched
from bladegen.definition.blade_definition import Distribution
from bladegen.support.arrays import Array, ArrayLike

__all__ = ["Placing", "column"]


@dataclass(frozen=True)
class Own:
    """A blade's chord [m], twist [rad] and offsets [m] at span fractions, (k,) each."""

    chord: Array
    twist: Array
    offset_y: Array
    offset_x: Array


@dataclass(frozen=True, eq=False)
class Placing:
    """Places a blade's sections at span fractions `eta` (k,), for many changes at once."""

    blade: Blade
    eta: Array

    def __call__(
        self, change: AffineChange, weight: Array, count: int
    ) -> tuple[Array, Array, Array]:
        """Return the maps (b, k, 3, 3) of (x, y, 1) to space, and chord and twist (b, k).

        What acts within a window does so by its weights (k,).
        """
        chord, twist, offset_y = self.planform(change, weight)
        offset = np.stack(np.broadcast_arrays(-offset_y, self.own.offset_x), axis=-1)
        axis, frames = self._axis(change)
        axes, start = placement(chord, twist, offset, axis, frames)
        shape = count, len(self.eta)
        to_space = np.concatenate([axes, start[..., None, :]], axis=-2)
        return (
            np.broadcast_to(to_space, (*shape, 3, 3)),
            np.array(np.broadcast_to(chord, shape)),
            np.array(np.broadcast_to(twist, shape)),
        )

    def planform(self, change: AffineChange, weight: Array) -> tuple[Array, Array, Array]:
        """Return chord [m], twist [rad] and offset along the chord [m], (b or 1, k) each."""
        own = self.own
        widening, whole = column(change.widening), column(change.plain("chord_scale"))
        scale, turn = column(change.plain("twist_scale")), column(change.plain("twist"))
        return (
            whole * faded(own.chord, weight, widening),
            faded(scale * own.twist, weight, 1.0, turn),
            whole * faded(own.offset_y, weight, widening),
        )

    @cached_property
    def own(self) -> "Own":
        """What the blade itself has at the spans."""
        blade, definition, eta = self.blade, self.blade.definition, self.eta
        return Own(
            blade.chord(eta), blade.twist(eta), definition.offset_y(eta), definition.offset_x(eta)
        )

    def _axis(self, change: AffineChange) -> tuple[Array, Array]:
        """Return reference axes (b or 1, k, 3) and section frames (b or 1, k, 3, 3).

        No window touches them.
        """
        prebend_scale = np.asarray(change.plain("prebend_scale"), dtype=np.float64)
        values, inverse = np.unique(prebend_scale, return_inverse=True)
        index = np.atleast_1d(inverse)
        if change.prebend is None and np.all(values == 1.0):
            axes, frames = (part[None] for part in self.own_axis)
            return axes[index], frames[index]
        axes, bent = stretched(self.own_axis[0], np.atleast_1d(prebend_scale)), None
        if change.prebend is None:
            bent = self.blade.planform.frames.bent(values, self.eta)
        else:
            axes[..., 0] += change.prebend(self.eta)
        if bent is None:
            bent = np.stack([self._frames(value, change.prebend) for value in values])
        return axes, bent if len(bent) == 1 else bent[index]

    @cached_property
    def own_axis(self) -> tuple[Array, Array]:
        """The reference axis (k, 3) [m] and the section frames (k, 3, 3) of the blade itself."""
        planform = self.blade.planform
        return planform.definition.axis(self.eta), planform.frames(self.eta)

    def _frames(self, prebend_scale: float, prebend: Distribution | None) -> Array:
        """Return the section frames (k, 3, 3) at one factor of the prebend, and what is added."""
        change = AffineChange(prebend_scale=float(prebend_scale), prebend=prebend)
        axis = change.applied(self.blade.definition, Window()).axis
        return replace(self.blade.planform.frames, axis=axis)(self.eta)


def column(value: ArrayLike) -> Array:
    """Return a number, or one a variant (b,), as (1, 1) or (b, 1); (b, k) as it is."""
    amounts = np.asarray(value, dtype=np.float64)
    return amounts if amounts.ndim == 2 else np.atleast_1d(amounts)[:, None]
