"""What sections were before anything was perturbed, as perturbed ones are held against them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.airfoils.section_curves import SectionCurves
from bladegen.blade.sanity import characteristics
from bladegen.curves.crossing import crossing_sections
from bladegen.support.arrays import Array, Indices

__all__ = ["Before"]


@dataclass(frozen=True, eq=False)
class Before:
    """Sections before anything was perturbed, and what is measured of them once.

    Parameters
    ----------
    curves : SectionCurves
        Not brought to size.
    ruling : (k,) array
        The relative thickness that they have or shall have.
    """

    curves: SectionCurves
    ruling: Array

    @cached_property
    def crossing(self) -> list[int]:
        """Which of them cross themselves."""
        return crossing_sections(self.curves.points)

    @cached_property
    def looks(self) -> Array:
        """Their `sanity.CHARACTERISTICS` (k, 6), brought to size."""
        return characteristics(self.curves, self.ruling / self.curves.relative_thickness)

    @cached_property
    def _steps(self) -> list[tuple[Array, tuple[Indices, ...]]]:
        """Steps along contours and across sections over their squared lengths, and still ones."""
        return [_inverse(steps) for steps in _steps(self.curves.planes)]

    def kept(self, curves: SectionCurves) -> Array:
        """Return the least share of its direction that a step of each section keeps, (k,).

        Along the contour or across the section: 1 unchanged, 0 turned by a right angle or shrunk
        to nothing.
        """
        result = np.full(len(curves.points), np.inf)
        for steps, (inverse, still) in zip(_steps(curves.planes), self._steps, strict=True):
            x, y = steps * inverse
            x += y
            x[still] = 1.0
            np.minimum(result, x.min(axis=1), out=result)
        return result


def _steps(planes: Array) -> tuple[Array, Array]:
    """Return steps (2, k, m) along contours, and across from the pressure to the suction side."""
    half = planes.shape[2] // 2
    return np.diff(planes), planes[..., 1:half] - planes[..., -2:half:-1]


def _inverse(steps: Array) -> tuple[Array, tuple[Indices, ...]]:
    """Return steps over their squared lengths, and which have none."""
    squares = steps[0] * steps[0] + steps[1] * steps[1]
    still = ~(squares > 0.0)
    return steps / np.where(still, 1.0, squares), np.nonzero(still)
