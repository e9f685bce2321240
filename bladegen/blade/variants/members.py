"""What a batch of variants is: their sections at fixed spans, and what is wrong with each."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from bladegen.support.arrays import Array, Indices
from bladegen.support.values import brief

__all__ = ["CROSSING", "FAULTS", "SOUND", "THIN", "TURNED", "Batch"]

SOUND, CROSSING, THIN, TURNED = range(4)
FAULTS = ("", "crosses itself", "loses its thickness", "turns its trailing edge over")


@dataclass(frozen=True, eq=False)
class Batch:
    """Sections of b variants at k spans.

    Parameters
    ----------
    sections : (b, k, n, 3) array
        Points [m], blade frame, trailing edges finished.
    chord, twist, relative_thickness : (b, k) arrays
        [m], [rad], of the chord.
    faults : (b, k) array of int
        What is wrong with each section, a place in `FAULTS`.
    looks : (b, k, 6) array
        `sanity.CHARACTERISTICS` of each, for `SectionBatch.oddities`.
    measures : (b, k, 7) array, optional
        `polygons.MEASURES` of the sections [m], in axes along the chord from the leading edge
        and normal to it.
    """

    sections: Array
    chord: Array
    twist: Array
    relative_thickness: Array
    faults: Indices
    looks: Array
    measures: Array | None = None

    __repr__ = brief

    @classmethod
    def joined(cls, batches: "Sequence[Batch]") -> "Batch":
        """Return variants of some batches, in their order, as one."""
        made: dict[str, Any] = {}
        for name in (entry.name for entry in fields(cls)):
            parts = [getattr(one, name) for one in batches]
            made[name] = None if parts[0] is None else np.concatenate(parts)
        return cls(**made)

    def take(self, rows: Indices, other: "Batch") -> None:
        """Put the variants of another batch in the place of some."""
        for entry in fields(self):
            values = getattr(self, entry.name)
            if values is not None:
                values[rows] = getattr(other, entry.name)
