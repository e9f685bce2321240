"""Neighbouring variants of a family, made at once."""

from dataclasses import dataclass, replace

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.spans import reflected
from bladegen.blade.variants.batch import Batch
from bladegen.support.arrays import Array, Indices, Mask
from bladegen.support.values import brief

__all__ = ["Block"]


@dataclass(frozen=True, eq=False)
class Block:
    """Neighbouring variants of a family.

    Parameters
    ----------
    index : (b,) array of int
        Their places in the family.
    values : (b, d) array
        Values of the factors [rad].
    attempts : (b,) array of int
        How many draws each took.
    reasons : tuple of str
        What is wrong with each; "" if nothing is.
    refused : tuple of str
        What was wrong with the first draw of each; "" if nothing was.
    batch : Batch
        Their sections.
    """

    index: Indices
    values: Array
    attempts: Indices
    reasons: tuple[str, ...]
    refused: tuple[str, ...]
    batch: Batch

    __repr__ = brief

    @property
    def valid(self) -> Mask:
        """Which variants are sound, (b,)."""
        return np.array([not reason for reason in self.reasons])

    def of(self, blade: Blade) -> "Block":
        """Return this block of a blade, its sections mirrored where the blade is a mirror image."""
        if not blade.mirrored:
            return self
        sections = reflected(self.batch.sections)
        return replace(self, batch=replace(self.batch, sections=sections))
