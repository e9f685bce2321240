"""Trailing edges between stations: sections brought to a width over span of its own.

Where neighbouring airfoils differ in their edge's width, a path between their shapes passes
through widths that neither has: a smooth one overshoots, and the surface behind mid-chord goes
concave.  The width is a design quantity like chord and thickness, so it gets a spline of its own
through the stations' widths, and sections are brought to it by a wedge: with x along the chord,

    y' = y +- (w - w0) / 2 * f^3 (2 - f),      f = (x - 1/2) / (1/2)      where x > 1/2

on the suction and the pressure side.  Where stations differ by more than `WIDE` in their width, as
a circle and a flatback do, a path's sections may be thinner behind than both: corners open while
sides straighten.  Their width then rises sooner, so that most of that dent is filled.  The wedge
begins with no slope and no curvature and adds no curvature at the edge; chord, leading edge,
trailing-edge midpoint and thickness stay.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bladegen.airfoils.chord_lines import ChordLines
from bladegen.airfoils.section_curves import SectionCurves
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.curves.sides import sides
from bladegen.definition.blade_definition import Interpolant, pchip
from bladegen.errors import GeometryError
from bladegen.shapes import affine
from bladegen.support.arrays import Array, Indices

__all__ = ["EdgeWidths", "Joining", "Wedges"]

AHEAD = 0.5  # of chord: nothing moves ahead of it
DIGITS = 13  # of a width in chords; what lies behind is rounding

WIDE = 0.1  # of chord: neighbours whose widths differ by no more make no dent worth filling
BEHIND = np.array([0.95])  # of chord: where sections are held against their neighbours
DENT = 5e-3  # of chord
FILLED = 0.7  # of a dent: its sides dent unequally, and all of it would make the other bulge
BETWEEN = np.array([0.25, 0.5, 0.75])  # of the way between stations

Joining = Callable[[Array, Array], Interpolant]
Between = Callable[[Indices], tuple[Array, Array, Array | None]]


@dataclass(frozen=True, eq=False)
class EdgeWidths:
    """The widths that trailing edges have over span.

    Parameters
    ----------
    splines : SectionSplines
        Splines through sections with a blade's landmarks.
    over : callable
        The width in chords as a function of the path's parameter.
    """

    splines: SectionSplines
    over: Interpolant

    @classmethod
    def through(
        cls,
        airfoils: Array,
        splines: SectionSplines,
        thickness: Array | None,
        knots: Array,
        join: Joining,
        between: Between | None = None,
    ) -> "EdgeWidths":
        """Return the widths that pass through those of stations.

        Parameters
        ----------
        airfoils : (s, n, 2) array
            The stations' landmarks.
        splines : SectionSplines
            For these landmarks.
        thickness : (s,) array, optional
            The relative thickness that rules at the stations, if one does.
        knots : (s,) array
            The path's parameter there.
        join : callable
            Interpolates between stations.
        between : callable, optional
            Gives, for the numbers of stations (m,), the path's parameter (m, 3) between each and
            the next, at `BETWEEN` of the way, the sections (3 m, n, 2) and the thickness (3 m,)
            there, if one rules.
        """
        sized = affine.restore(airfoils, *splines.normalising(airfoils, thickness))
        widths = np.round(splines.fit(sized).edge_width, DIGITS)
        wide = np.flatnonzero(np.abs(np.diff(widths)) > WIDE)
        if between is not None and wide.size:
            knots, widths = _filled(splines, knots, widths, sized, wide, between(wide))
        return cls(splines, join(knots, widths))

    def wedges(self, curves: SectionCurves, thickness: Array | None, q: Array) -> "Wedges":
        """Return the wedges that bring sections to their width at the path's parameter (k,).

        Widths hold once the sections are brought to unit chord and to `thickness` (k,).
        """
        A, c, lines = ChordLines.sized(curves, thickness)
        return Wedges.between(curves, A, c, lines, self.over(q))


def _filled(
    splines: SectionSplines,
    knots: Array,
    widths: Array,
    sized: Array,
    wide: Indices,
    between: tuple[Array, Array, Array | None],
) -> tuple[Array, Array]:
    """Return knots and widths with more between stations whose path is dented behind.

    A width there is that of the path and `FILLED` of what the section is thinner at `BEHIND` than
    a monotone spline through the stations' thicknesses there; it stays between the stations' own.
    """
    q, points, thickness = between
    profiles = affine.restore(points, *splines.normalising(points, thickness))
    own, found = (_behind(sections) for sections in (sized, profiles))
    missing = pchip(knots, own)(q) - found.reshape(q.shape)
    ends = np.stack([own[wide], own[wide + 1]], axis=-1)
    dented = np.any(found.reshape(q.shape) < ends.min(axis=-1)[:, None] - DENT, axis=1)
    around = np.concatenate([knots[wide, None], q, knots[wide + 1, None]], axis=1)
    dented &= np.all(np.diff(around, axis=1) > 0.0, axis=1)
    lift = FILLED * np.maximum(missing, 0.0) / _wedge(BEHIND)
    opened = splines.fit(profiles).edge_width.reshape(q.shape) + lift
    start, end = widths[wide][:, None], widths[wide + 1][:, None]
    sign = np.sign(end - start)
    rising = np.maximum.accumulate(sign * np.clip(opened, *_sorted(start, end)), axis=1)
    knots = np.concatenate([knots, q[dented].reshape(-1)])
    widths = np.concatenate([widths, np.round((sign * rising)[dented].reshape(-1), DIGITS)])
    order = np.argsort(knots, kind="stable")
    return knots[order], widths[order]


def _sorted(one: Array, other: Array) -> tuple[Array, Array]:
    return np.minimum(one, other), np.maximum(one, other)


def _behind(profiles: Array) -> Array:
    """Return the thickness (k,) of sections in chords at `BEHIND`."""
    upper, lower = sides(profiles, BEHIND)
    found: Array = (upper - lower)[:, 0]
    return found


@dataclass(frozen=True, eq=False)
class Wedges:
    """A wedge for each of k sections.

    Parameters
    ----------
    axis, start : (k, 2), (k,) arrays
        Where a point is along the chord: x = point @ axis + start.
    shift : (2, k, 2) array
        By how much points of the suction and the pressure side would move at x = 1.
    """

    axis: Array
    start: Array
    shift: Array

    @classmethod
    def to(cls, curves: SectionCurves, width: Array) -> "Wedges":
        """Return the wedges that bring sections of unit chord to edge widths (k,) in chords."""
        k = len(curves.points)
        same = np.broadcast_to(np.eye(2), (k, 2, 2)), np.zeros((k, 2))
        return cls.between(curves, *same, ChordLines.of(curves), width)

    @classmethod
    def between(
        cls, curves: SectionCurves, A: Array, c: Array, lines: ChordLines, width: Array
    ) -> "Wedges":
        """Return the wedges of sections that maps A and c bring to unit chord, with those lines."""
        along = lines.edge - lines.nose
        along = along / np.hypot(along[:, 0], along[:, 1])[:, None]
        normal = along[:, ::-1] * (-1.0, 1.0)
        axis, to_nose = (A @ along[..., None])[..., 0], (c - lines.nose) * along
        start = to_nose[:, 0] + to_nose[:, 1]
        sides = curves.planes[..., [0, -1]].T  # (2, k, 2): where suction and pressure side end
        ends = sides[..., 0] * axis[:, 0] + sides[..., 1] * axis[:, 1] + start
        if not (ends > AHEAD).all():
            raise GeometryError(
                f"trailing edge: a side of a section ends at {float(ends.min()):.3g} of its chord, "
                f"must be behind {AHEAD:g}; are the airfoils' points in order?"
            )
        gap, across = sides[0] - sides[1], (A @ normal[..., None])[..., 0]
        present = gap[:, 0] * across[:, 0] + gap[:, 1] * across[:, 1]
        lift = 0.5 * (width - present) / _wedge(ends) * ((1.0,), (-1.0,))
        back = (normal[:, None] @ np.linalg.inv(A))[:, 0]
        return cls(axis, start, lift[..., None] * back)

    def __call__(self, points: Array) -> Array:
        """Return by how much points of sections (k, n, 2) move, (k, n, 2).

        The first n // 2 points are those of the suction side, the last n // 2 the pressure side's.
        """
        return self.opened(points)[0] - points

    def opened(self, points: Array) -> tuple[Array, int]:
        """Return points of sections (k, n, 2) moved, and how many from either end did move.

        The first n // 2 points are those of the suction side, the last n // 2 the pressure side's.
        """
        planes = np.array(points.transpose(2, 0, 1), order="C")
        n = planes.shape[2]
        x = (self.axis[:, None] @ planes.swapaxes(0, 1))[:, 0] + self.start[:, None]
        behind = np.asarray((x > AHEAD).any(axis=0))
        both = behind[: n // 2] | behind[: n - n // 2 - 1 : -1]
        count = int(np.max(np.arange(1, n // 2 + 1) * both, initial=0))
        for shift, side in zip(self.shift, (slice(count), slice(n - count, n)), strict=True):
            planes[..., side] += shift.T[..., None] * _wedge(x[:, side])
        return planes.transpose(1, 2, 0), count


def _wedge(x: Array) -> Array:
    """Return the wedge's share at places x along the chord: 0 ahead, 1 at the edge, C2."""
    f = np.maximum(x - AHEAD, 0.0) / (1.0 - AHEAD)
    share: Array = f * f * f * (2.0 - f)
    return share
