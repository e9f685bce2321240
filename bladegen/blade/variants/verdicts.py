"""What is wrong with variants of a batch, in words: their data's bounds, their sections."""

import numpy as np

from bladegen.blade.variants.batch import FAULTS, SectionBatch
from bladegen.support.arrays import Array, Indices, Mask

__all__ = ["THINNEST", "leaving", "strayed", "unsound"]

THINNEST = 0.05  # of the chord; a thinner section is no blade's


def leaving(sections: SectionBatch, t: Array) -> Mask:
    """Tell which variants of coordinates t have a section that leaves the space's data, (b,)."""
    if sections.domain is None:
        return np.zeros(len(t), dtype=bool)
    left: Mask = np.any(sections.domain.left(sections.step(t)), axis=1)
    return left


def strayed(sections: SectionBatch, t: Array) -> list[str]:
    """Say which section of each variant leaves the space's data first; "" if none does."""
    reasons = [""] * len(t)
    if sections.domain is not None:
        for row in np.flatnonzero(leaving(sections, t)):
            reasons[row] = sections.domain.said(sections.step(t[row : row + 1])[0])
    return reasons


def unsound(
    sections: SectionBatch,
    faults: Indices,
    thickness: Array,
    looks: Array,
    *,
    thinnest: float = THINNEST,
    allow_odd: bool = False,
) -> list[str]:
    """Say what is wrong with the sections of each variant, first thing first; "" if nothing is.

    Parameters
    ----------
    sections : SectionBatch
        What made and tested them.
    faults, thickness, looks : (b, k), (b, k), (b, k, 6) arrays
        As `SectionBatch.tested` gives them.
    thinnest : float
        Least relative thickness.
    allow_odd : bool
        Whether sections may be such as no aerodynamicist would take.
    """
    reasons, eta = [""] * len(faults), sections.eta
    for row in np.flatnonzero(faults.any(axis=1)):
        k = int(np.argmax(faults[row] > 0))
        reasons[row] = f"{FAULTS[faults[row, k]]} at eta = {eta[k]:.4f}"
    for row in np.flatnonzero(thickness.min(axis=1) < thinnest):
        k = int(np.argmin(thickness[row]))
        reasons[row] = reasons[row] or (
            f"relative thickness {thickness[row, k]:.4f} at eta = {eta[k]:.4f} is below "
            f"{thinnest:g}"
        )
    if allow_odd:
        return reasons
    odd = sections.oddities(looks)
    for place in np.flatnonzero(odd.kinds.any(axis=1)).tolist():
        k = int(np.argmax(odd.kinds[place] > 0))
        reasons[place] = reasons[place] or f"{odd.said((place, k))} at eta = {eta[k]:.4f}"
    return reasons
