"""What is wrong with variants of a family: bounds, data, faults of sections, oddities."""

from dataclasses import dataclass

import numpy as np

from bladegen.blade.deformation import AffineChange
from bladegen.support.arrays import Array, Indices, Mask
from bladegen.variants.batch import FAULTS, SectionBatch
from bladegen.variants.factors import Factors

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
        domain, t = self.sections.domain, self.split(values)[0]
        if domain is None or self.allow_extrapolation:
            return np.zeros(len(values), dtype=bool)
        left: Mask = np.any(domain.left(self.sections.step(t)), axis=1)
        return left

    def _strayed(self, values: Array) -> list[str]:
        """Say which variants (b, d) leave their bounds or the space's data; "" if none does."""
        reasons = self.what.outside(values)
        domain, t = self.sections.domain, self.split(values)[0]
        if domain is not None:
            for row in np.flatnonzero(self.left(values)):
                reasons[row] = reasons[row] or domain.said(self.sections.step(t[row : row + 1])[0])
        return reasons

    def reasons(self, values: Array, faults: Indices, thickness: Array, looks: Array) -> list[str]:
        """Say what is wrong with variants (b, d), first thing first; "" if nothing is."""
        reasons, eta = self._strayed(values), self.sections.eta
        for row in np.flatnonzero(faults.any(axis=1)):
            k = int(np.argmax(faults[row] > 0))
            reasons[row] = reasons[row] or f"{FAULTS[faults[row, k]]} at eta = {eta[k]:.4f}"
        for row in np.flatnonzero(thickness.min(axis=1) < self.thinnest):
            k = int(np.argmin(thickness[row]))
            reasons[row] = reasons[row] or (
                f"relative thickness {thickness[row, k]:.4f} at eta = {eta[k]:.4f} is below "
                f"{self.thinnest:g}"
            )
        if self.allow_odd:
            return reasons
        odd = self.sections.oddities(looks)
        for place in np.flatnonzero(odd.kinds.any(axis=1)).tolist():
            k = int(np.argmax(odd.kinds[place] > 0))
            said = f"{odd.said((place, k))} at eta = {eta[k]:.4f}"
            reasons[place] = reasons[place] or said
        return reasons
