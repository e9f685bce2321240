"""What is wrong with variants of a family: bounds, data, faults of sections, oddities."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.blade.changes.deformation import AffineChange
from bladegen.blade.variants.batch import SectionBatch
from bladegen.blade.variants.factors import Factors
from bladegen.blade.variants.verdicts import leaving, strayed, unsound
from bladegen.support.arrays import Array, Indices, Mask

__all__ = ["Rules"]


@dataclass(frozen=True, eq=False)
class Rules:
    """What a sound variant keeps to.

    Parameters
    ----------
    sections : SectionBatch
        Makes and tests the sections.
    what : Factors
        What varies, and between which bounds.
    thinnest : float
        Least relative thickness of a sound section.
    allow_extrapolation, allow_odd : bool
        Whether sections may leave the space's data, and be odd.
    """

    sections: SectionBatch
    what: Factors
    thinnest: float
    allow_extrapolation: bool
    allow_odd: bool

    def split(self, values: Array) -> tuple[Array, AffineChange]:
        """Return coordinates and affine parameters of variants (b, d)."""
        return self.what.split(values, self.sections.modes)

    def tested(self, values: Array) -> list[str]:
        """Say what is wrong with variants (b, d), without making their sections."""
        reasons = self._strayed(values)
        near = np.flatnonzero([not reason for reason in reasons])
        if near.size:
            tested = self.sections.tested(*self.split(values[near]))
            for row, reason in zip(near, self.reasons(values[near], *tested), strict=True):
                reasons[row] = reason
        return reasons

    def left(self, values: Array) -> Mask:
        """Tell which variants (b, d) have a section that leaves the space's data, (b,)."""
        if self.allow_extrapolation:
            return np.zeros(len(values), dtype=bool)
        return leaving(self.sections, self.split(values)[0])

    def strayed(self, values: Array) -> Mask:
        """Tell which variants (b, d) leave their bounds or the space's data, (b,)."""
        outside: Mask = np.array([bool(said) for said in self.what.outside(values)])
        return outside | self.left(values)

    def _strayed(self, values: Array) -> list[str]:
        """Say which variants (b, d) leave their bounds or the space's data; "" if none does."""
        reasons = self.what.outside(values)
        if self.allow_extrapolation:
            return reasons
        return _first(reasons, strayed(self.sections, self.split(values)[0]))

    def reasons(self, values: Array, faults: Indices, thickness: Array, looks: Array) -> list[str]:
        """Say what is wrong with variants (b, d), first thing first; "" if nothing is."""
        how: dict[str, Any] = {"thinnest": self.thinnest, "allow_odd": self.allow_odd}
        found = unsound(self.sections, faults, thickness, looks, **how)
        return _first(self._strayed(values), found)


def _first(reasons: list[str], others: list[str]) -> list[str]:
    """Return the reason of each variant, or where there is none the other."""
    return [one or other for one, other in zip(reasons, others, strict=True)]
