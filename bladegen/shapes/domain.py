"""Whether perturbed sections stay among the shapes that a space was learned from.

A section arrives at its own coordinates plus t: the sum is where it lies to within a thousandth
of a radian, since tangents are carried there by parallel transport.  The data's range along each
mode is what it may not leave, nor, where it lies outside already, go farther from.  Sections
thicker than `THICK` are on the way to a round root, of which data of airfoils say nothing:
they are judged by their soundness alone.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array, Mask

__all__ = ["BEYOND", "THICK", "Domain"]

THICK = 0.45  # of the chord
ROUNDING = 1e-12
BEYOND = "allow_extrapolation=True (--allow-extrapolation) goes beyond the space's data"


@dataclass(frozen=True, eq=False)
class Domain:
    """Sections and where the data allow them to go.

    Parameters
    ----------
    eta : (k,) array
        Span fractions.
    own : (k, r) array
        The coordinates of the sections.
    low, high : (k, r) arrays
        What they may be; infinite for sections that are too thick to be judged.
    """

    eta: Array
    own: Array
    low: Array
    high: Array

    @classmethod
    def of(cls, space: ShapeSpace, eta: Array, shapes: Array, thickness: Array) -> "Domain":
        """Return that of shapes (k, n, 2) of relative thickness (k,)."""
        return cls.around(space, eta, space.encode(shapes), thickness)

    @classmethod
    def around(cls, space: ShapeSpace, eta: Array, own: Array, thickness: Array) -> "Domain":
        """Return that of shapes of coordinates (k, r) and of relative thickness (k,)."""
        thick = (thickness > THICK)[:, None]
        low = np.where(thick, -np.inf, np.minimum(space.lower, own) - ROUNDING)
        high = np.where(thick, np.inf, np.maximum(space.upper, own) + ROUNDING)
        return cls(eta, own, low, high)

    def left(self, step: Array) -> Mask:
        """Tell which sections (..., k) steps (..., k, r) in their coordinates carry outside."""
        arrived = self.own + step
        outside: Mask = np.any((arrived < self.low) | (arrived > self.high), axis=-1)
        return outside

    def said(self, step: Array) -> str:
        """Say which section leaves the domain first under steps (k, r); "" if none does."""
        rows = np.flatnonzero(self.left(step))
        if not rows.size:
            return ""
        k = int(rows[0])
        arrived = self.own[k] + step[k]
        j = int(np.argmax((arrived < self.low[k]) | (arrived > self.high[k])))
        return (
            f"the section at eta = {self.eta[k]:.4f}, itself at t{j + 1} = {self.own[k, j]:.4g}, "
            f"arrives at t{j + 1} = {arrived[j]:.4g}, allowed is the data's {self.low[k, j]:.4g} "
            f"to {self.high[k, j]:.4g}"
        )
