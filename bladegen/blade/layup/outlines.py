"""Outlines of sections, measured along the arc: places found on them, lengths and middles between.

Fractions of the arc run from the suction side's trailing edge (0) over the leading edge to the
pressure side's (1), along the landmarks of the sections as they are built.  All sections at once.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.definition.distribution import Distribution
from bladegen.definition.reference_axis import ReferenceAxis
from bladegen.definition.structure.positions import (
    Arc,
    Between,
    EdgeMiddle,
    Limited,
    PlaneCut,
    Position,
    Shifted,
)
from bladegen.support.arrays import Array, Indices, Mask

__all__ = ["Outlines", "beside_axis", "within"]

ENDS = 1e-9  # of the span, by which places may lie beyond the ends of a grid


@dataclass(frozen=True, eq=False)
class Outlines:
    """Sections of a blade as lines along which things are placed.

    Parameters
    ----------
    eta : (k,) array
        Span fractions.
    points : (k, n, 3) array
        Landmarks [m], blade frame, from the suction side's trailing edge on.
    flat : (k, n, 2) array
        The same in the section's plane from the reference axis: x and y of the blade's root [m].
    twist : (k,) array
        [rad]
    blade : Blade
        The blade.
    """

    eta: Array
    points: Array
    flat: Array
    twist: Array
    blade: Blade

    @classmethod
    def of(cls, blade: Blade, eta: Array) -> "Outlines":
        """Return the outlines at span fractions (k,) of a blade that is no mirror image."""
        points = blade.sections(eta)
        flat = (points - blade.axis(eta)[:, None]) @ blade.planform.frames(eta)[:, :2].mT
        return cls(eta, points, flat, blade.twist(eta), blade)

    @cached_property
    def _steps(self) -> Array:
        steps: Array = np.linalg.norm(np.diff(self.points, axis=1), axis=-1)
        return steps

    @cached_property
    def length(self) -> Array:
        """Lengths (k,) of the outlines [m], without the trailing edges."""
        total: Array = self._steps.sum(axis=1)
        return total

    @cached_property
    def half_edge(self) -> Array:
        """Half the widths (k,) of the trailing edges [m]."""
        found: Array = 0.5 * np.linalg.norm(self.points[:, -1] - self.points[:, 0], axis=-1)
        return found

    @property
    def edge_middles(self) -> Array:
        """Middles (2, k, 3) of the halves of the trailing edges, the suction side's first [m]."""
        first, last = self.points[:, 0], self.points[:, -1]
        return np.stack([0.75 * first + 0.25 * last, 0.25 * first + 0.75 * last])

    @cached_property
    def fractions(self) -> Array:
        """Fractions of the arc (k, n) of the landmarks."""
        along = np.cumsum(self._steps, axis=1) / self.length[:, None]
        along[:, -1] = 1.0
        return np.pad(along, ((0, 0), (1, 0)))

    @cached_property
    def _sums(self) -> Array:
        """Integrals (k, n, 3) of the points along the arc, up to each landmark [m2]."""
        middles = 0.5 * (self.points[:, 1:] + self.points[:, :-1])
        return np.pad(np.cumsum(middles * self._steps[..., None], axis=1), ((0, 0), (1, 0), (0, 0)))

    def _cells(self, fraction: Array) -> tuple[Indices, Array]:
        """Return the cells that fractions (..., k) lie in, and how far along them."""
        rows = 2.0 * np.arange(len(self.eta))
        flat, n = (self.fractions + rows[:, None]).reshape(-1), self.fractions.shape[1]
        at = np.searchsorted(flat, fraction + rows, side="right") - 1
        cell = np.clip(at - n * np.arange(len(self.eta)), 0, n - 2)
        row = np.broadcast_to(np.arange(len(self.eta)), fraction.shape)
        start, end = self.fractions[row, cell], self.fractions[row, cell + 1]
        share = np.divide(
            fraction - start, end - start, out=np.zeros_like(start), where=end > start
        )
        return cell, share

    def at(self, fraction: Array) -> Array:
        """Return the points (..., k, 3) [m] at fractions (..., k) within 0 to 1."""
        cell, share = self._cells(fraction)
        row = np.broadcast_to(np.arange(len(self.eta)), fraction.shape)
        start, end = self.points[row, cell], self.points[row, cell + 1]
        found: Array = start + share[..., None] * (end - start)
        return found

    def parameters(self, fraction: Array) -> Array:
        """Return the landmark parameters u (..., k) at fractions (..., k) within 0 to 1."""
        cell, share = self._cells(fraction)
        u = self.blade.u
        found: Array = u[cell] + share * (u[cell + 1] - u[cell])
        return found

    def moments(self, start: Array, end: Array) -> tuple[Array, Array]:
        """Return lengths (..., k) [m] and integrals of the points (..., k, 3) [m2] between places.

        Nothing lies between a start and an end that is not behind it.
        """
        end = np.maximum(start, end)
        row = np.broadcast_to(np.arange(len(self.eta)), start.shape)

        def upto(fraction: Array) -> Array:
            cell, share = self._cells(fraction)
            first, last = self.points[row, cell], self.points[row, cell + 1]
            part = (share * self._steps[row, cell])[..., None]
            done: Array = self._sums[row, cell] + part * (
                first + 0.5 * share[..., None] * (last - first)
            )
            return done

        return (end - start) * self.length, upto(end) - upto(start)

    def places(self, position: Position, known: dict[int, Array] | None = None) -> Array:
        """Return the fractions (k,) at which a place lies, NaN where there is none.

        `known` holds those found before, by the identity of their places.
        """
        known = {} if known is None else known
        if id(position) not in known:
            known[id(position)] = self._found(position, known)
        return known[id(position)]

    def _found(self, position: Position, known: dict[int, Array]) -> Array:
        if isinstance(position, PlaneCut):
            return self._cut(position)
        if isinstance(position, Between | Limited):
            return self._held(position, known)
        if isinstance(position, Shifted):
            width = np.nan_to_num(within(position.width, self.eta))
            return self.places(position.base, known) + position.times * width / self.length
        if isinstance(position, Arc):
            found = within(position.fraction, self.eta)
        elif isinstance(position, EdgeMiddle):
            half = self.half_edge / self.length
            found = -half if position.side == "suction" else 1.0 + half
        else:
            found = self.fractions[:, self.fractions.shape[1] // 2]
        return found

    def _held(self, position: Between | Limited, known: dict[int, Array]) -> Array:
        """Return a place at a share between two others, or one that goes no farther than they."""
        first, last = (self.places(one, known) for one in (position.first, position.last))
        if isinstance(position, Between):
            return first + position.share * (last - first)
        own = self.places(position.base, known)
        return np.clip(own, np.minimum(first, last), np.maximum(first, last))

    def _cut(self, plane: PlaneCut) -> Array:
        """Return where a plane cuts a side of the sections, NaN where it does not.

        Sections are turned about z until the plane is normal to y; its side ends at the point
        nearest to -y.
        """
        turn = np.zeros(len(self.eta)) if plane.rotation is None else plane.rotation(self.eta)
        if plane.frame == "chord":
            turn = turn + self.twist
        c, s = np.cos(turn), np.sin(turn)
        y = self.flat[..., 1] * c[:, None] + self.flat[..., 0] * s[:, None]
        off = within(plane.offset, self.eta)
        if plane.through is not None:
            axis = self.blade.definition.axis
            off = off + beside_axis(axis, self.eta, plane.through, turn)
        y = y - off[:, None]
        nose = np.argmin(y, axis=1)[:, None]
        cell = np.arange(y.shape[1] - 1)
        if plane.side == "suction":
            cuts: Mask = (y[:, :-1] > 0.0) & (y[:, 1:] <= 0.0) & (cell < nose)
        else:
            cuts = (y[:, :-1] <= 0.0) & (y[:, 1:] > 0.0) & (cell >= nose)
        first, row = np.argmax(cuts, axis=1), np.arange(len(y))
        before, after = y[row, first], y[row, first + 1]
        hit = cuts.any(axis=1)
        share = np.divide(before, before - after, out=np.zeros_like(before), where=hit)
        start, end = self.fractions[row, first], self.fractions[row, first + 1]
        return np.where(hit, start + share * (end - start), np.nan)


def beside_axis(
    axis: ReferenceAxis, eta: Array, through: tuple[float, float], turn: Array
) -> Array:
    """Return how far a line through two points of the axis lies from the axis, in y [m].

    Everything is turned about z by `turn` (k,) [rad] before, as sections are to be cut.
    """
    c, s = np.cos(turn), np.sin(turn)
    own, ends = axis(eta), axis(np.array(through))
    y = own[:, 1] * c + own[:, 0] * s
    first, last = (end[1] * c + end[0] * s for end in ends)
    along = (own[:, 2] - ends[0, 2]) / (ends[1, 2] - ends[0, 2])
    distance: Array = first + along * (last - first) - y
    return distance


def within(quantity: Distribution, eta: Array) -> Array:
    """Return a quantity at span fractions, NaN beyond the ends of its grid."""
    low, high = quantity.grid[0] - ENDS, quantity.grid[-1] + ENDS
    return np.where((eta >= low) & (eta <= high), quantity(eta), np.nan)
