"""Neighbouring variants of a family, made at once, and what is measured on them."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.spans import reflected
from bladegen.blade.variants.batch import Batch
from bladegen.curves import polygons
from bladegen.support.arrays import Array, Indices, Mask
from bladegen.support.values import brief

__all__ = ["OF_SKIN", "OVER_SPAN", "Block", "joined", "of_skin", "over_span"]

OVER_SPAN = ("chord", "twist", "thickness", *polygons.MEASURES)
OF_SKIN = ("volume", "surface")


def over_span(batch: Batch) -> dict[str, Array]:
    """Return what was measured on sections, (b, k) each: metres, degrees; `OVER_SPAN` by name."""
    assert batch.measures is not None  # it was asked for
    planform = batch.chord, np.degrees(batch.twist), batch.relative_thickness
    return dict(zip(OVER_SPAN, (*planform, *np.moveaxis(batch.measures, -1, 0)), strict=True))


def of_skin(batch: Batch) -> dict[str, Array]:
    """Return the volume [m3] within the skins of variants, and their areas [m2], (b,) each."""
    each = (sections.astype(np.float64) for sections in batch.sections)  # fits in a cache
    measured = [polygons.volume_and_area(sections) for sections in each]
    return dict(zip(OF_SKIN, np.reshape(measured, (-1, 2)).T, strict=True))


def joined(blocks: "list[Block]") -> "Block":
    """Return neighbouring blocks as one."""
    if len(blocks) == 1:
        return blocks[0]
    arrays: dict[str, Any] = {
        name: np.concatenate([getattr(one, name) for one in blocks])
        for name in ("index", "values", "attempts")
    }
    texts: dict[str, Any] = {
        name: tuple(text for one in blocks for text in getattr(one, name))
        for name in ("reasons", "refused")
    }
    return Block(**arrays, **texts, batch=Batch.joined([one.batch for one in blocks]))


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
