"""Mass of what lies inside the skin of a family's variants."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.families.block import Block
from bladegen.families.family import Family
from bladegen.support.arrays import Array, Indices

__all__ = ["MassLabel"]


@dataclass(frozen=True, eq=False)
class MassLabel:
    """Weighs the layers of a family's variants on their own sections."""

    family: Family

    @property
    def settings(self) -> dict[str, Any]:
        """Nothing: the definition holds all."""
        return {}

    def computed(self, block: Block, rows: Indices) -> dict[str, Array]:
        """Return the figures of some variants of a block, by name."""
        family = self.family
        layups = [family.named(block, int(place)).layup for place in block.index[rows]]
        return {
            "mass": np.array([layup.mass for layup in layups]),
            "mass_centre": np.array([layup.centre[2] for layup in layups]),
            "mass_per_length": np.array([one.at(family.eta).mass_per_length for one in layups]),
        }
