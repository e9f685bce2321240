"""Sections with the same landmark parameters to their splines."""

from dataclasses import dataclass
from functools import cached_property

from bladegen.airfoils.section_curves import SectionCurves
from bladegen.airfoils.slopes import SplineSlopes
from bladegen.support.arrays import Array
from bladegen.support.values import brief

__all__ = ["SectionSplines"]


@dataclass(frozen=True, eq=False)
class SectionSplines:
    """Fits splines to any number of sections with the same landmark parameters.

    Parameters
    ----------
    u : (n,) array
        Landmark parameters, 0.5 at the leading-edge landmark, symmetric about it.

    Notes
    -----
    A spline's slopes are linear in its points; they are made where they are asked for.
    """

    u: Array

    __repr__ = brief

    @cached_property
    def _slopes(self) -> SplineSlopes:
        return SplineSlopes.at(self.u)

    def values(self, u: Array, derivative: int = 0) -> Array:
        """Return the (m, n) matrix from landmarks to points, or derivatives, at `u`."""
        return self._slopes.values(u, derivative)

    def between(self, u: Array, points: Array) -> Array:
        """Return the points (k, m, 2) at `u` (m,) of splines through landmarks (k, n, 2)."""
        flat = points.swapaxes(0, 1).reshape(len(self.u), -1)  # one product is faster than k
        found: Array = (self.values(u) @ flat).reshape(len(u), -1, 2).swapaxes(0, 1)
        return found

    def fit(self, points: Array) -> "SectionCurves":
        """Return the splines through landmarks (k, n, 2)."""
        return SectionCurves(self._slopes, points)

    def normalising(self, points: Array, relative_thickness: Array | None) -> tuple[Array, Array]:
        """Return the maps that bring sections to unit chord and relative thickness, exactly.

        Both are maps of GL2 that move no point of the Grassmannian: a scaling, and a
        stretch normal to the chord line, which keeps leading edge and trailing-edge midpoint.

        Parameters
        ----------
        points : (k, n, 2) array
            Sections in airfoil axes, close to unit chord.
        relative_thickness : (k,) array, optional
            The thickness over chord to reach, not many times its own; None leaves it.

        Returns
        -------
        A, c : (k, 2, 2), (k, 2) arrays
            ``points @ A + c`` has unit chord and the thickness.
        """
        return self.fit(points).normalising(relative_thickness)
