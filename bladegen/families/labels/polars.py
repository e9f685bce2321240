"""Polars of the sections that a family stores, by NeuralFoil with its confidence."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.blade.aero.elements import elements_of
from bladegen.blade.aero.section_polars import polars_of
from bladegen.blade.spans import reflected
from bladegen.families.block import Block
from bladegen.families.family import Family
from bladegen.families.labels.figures import ALPHA, REYNOLDS, polar_places
from bladegen.support.arrays import Array, Indices

__all__ = ["PolarLabel"]


@dataclass(frozen=True, eq=False)
class PolarLabel:
    """Computes polars of some of a family's sections, as they are stored."""

    family: Family

    @property
    def settings(self) -> dict[str, Any]:
        """At which Reynolds numbers and angles [deg]."""
        ends = f"{ALPHA[0]:g} to {ALPHA[-1]:g} in {len(ALPHA)}"
        return {"reynolds": REYNOLDS.tolist(), "alpha_deg": ends}

    def computed(self, block: Block, rows: Indices) -> dict[str, Array]:
        """Return the figures of some variants of a block, by name."""
        places = polar_places(len(self.family.eta))
        sections = block.batch.sections[rows][:, places]
        plain = reflected(sections) if self.family.blade.mirrored else sections
        elements = elements_of(plain, 0.0, 0.0)
        shape = (*elements.thickness.shape, len(REYNOLDS))
        outlines = np.repeat(elements.outlines[:, :, None], len(REYNOLDS), axis=2)
        thickness = np.broadcast_to(elements.thickness[..., None], shape)
        found = polars_of(outlines, thickness, np.broadcast_to(REYNOLDS, shape), angles=ALPHA)
        names = ("cl", "cd", "cm", "confidence")
        return {f"polar_{name}": getattr(found, name) for name in names}
