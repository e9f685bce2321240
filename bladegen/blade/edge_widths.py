"""Trailing edges between stations: sections brought to a width over span of its own.

Where neighbouring airfoils differ in their edge's width, a path between their shapes passes
through widths that neither has: a smooth one overshoots, and the surface behind mid-chord goes
concave.  The width is a design quantity like chord and thickness, so it gets a spline of its own
through the stations' widths, and sections are brought to it by a wedge: with x along the chord,

    y' = y +- (w - w0) / 2 * f^3 (2 - f),      f = (x - 1/2) / (1/2)      where x > 1/2

on the suction and the pressure side.  The wedge begins with no slope and no curvature and adds no
curvature at the edge; chord, leading edge, trailing-edge midpoint and thickness stay.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bladegen.airfoils.section_curves import SectionCurves
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.definition.blade_definition import Interpolant
from bladegen.errors import GeometryError
from bladegen.shapes import affine
from bladegen.support.arrays import Array

__all__ = ["EdgeWidths", "Joining", "Wedges"]

AHEAD = 0.5  # of chord: nothing moves ahead of it
DIGITS = 13  # of a width in chords; what lies behind is rounding

Joining = Callable[[Array, Array], Interpolant]


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
        """
        sized = affine.restore(airfoils, *splines.normalising(airfoils, thickness))
        widths = splines.fit(sized).edge_width
        return cls(splines, join(knots, np.round(widths, DIGITS)))

    def opening(
        self, landmarks: Array, thickness: Array | None, q: Array
    ) -> Callable[[Array], Array]:
        """Return the map that brings sections (k, n, 2), at any points on them, to their width.

        Widths hold once the sections are brought to unit chord and to `thickness` (k,).
        """
        curves = self.splines.fit(landmarks)
        A, c = curves.normalising(thickness)
        curves = curves.mapped(A, c)
        wedges, back = Wedges.to(curves, self.over(q)), np.linalg.inv(A)
        return lambda points: points + wedges(affine.restore(points, A, c)) @ back


@dataclass(frozen=True, eq=False)
class Wedges:
    """A wedge for each of k sections of unit chord.

    Parameters
    ----------
    nose, along : (k, 2) arrays
        Leading edges, and the chord line's directions.
    ends : (k, 2) array
        Where along the chord the suction and the pressure side end.
    lift : (k,) array
        By how much either side moves away from the chord line at its end, in chords.
    """

    nose: Array
    along: Array
    ends: Array
    lift: Array

    @classmethod
    def to(cls, curves: SectionCurves, width: Array) -> "Wedges":
        """Return the wedges that bring sections to edge widths (k,) in chords."""
        nose = curves.leading_edge
        along = curves.trailing_edge - nose
        along = along / np.linalg.norm(along, axis=-1, keepdims=True)
        ends = (curves.points[:, [0, -1]] - nose[:, None]) @ along[..., None]
        if not np.all(ends > AHEAD):
            raise GeometryError(
                f"trailing edge: a side of a section ends at {float(ends.min()):.3g} of its chord, "
                f"must be behind {AHEAD:g}; are the airfoils' points in order?"
            )
        return cls(nose, along, ends[..., 0], 0.5 * (width - curves.edge_width))

    def __call__(self, points: Array) -> Array:
        """Return by how much points of sections (k, n, 2) move, (k, n, 2).

        The first n // 2 points are those of the suction side, the last n // 2 the pressure side's.
        """
        half = points.shape[1] // 2
        x = ((points - self.nose[:, None]) @ self.along[..., None])[..., 0]
        share = _wedge(x)
        share[:, :half] *= (self.lift / _wedge(self.ends[:, 0]))[:, None]
        share[:, half:] *= -(self.lift / _wedge(self.ends[:, 1]))[:, None]
        normal = np.stack([-self.along[:, 1], self.along[:, 0]], axis=-1)
        return share[..., None] * normal[:, None]


def _wedge(x: Array) -> Array:
    """Return the wedge's share at places x along the chord: 0 ahead, 1 at the edge, C2."""
    f = np.maximum(x - AHEAD, 0.0) / (1.0 - AHEAD)
    share: Array = f**3 * (2.0 - f)
    return share
