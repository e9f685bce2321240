"""The manifest's rows of a block of variants, and what is told of their draws."""

import hashlib
from typing import Any

import numpy as np

from bladegen.blade.variants.draws import WIDEST
from bladegen.curves import polygons
from bladegen.families.block import Block, of_skin, over_span
from bladegen.families.family import Family
from bladegen.measures.spanwise import UNITS

__all__ = ["drawn_again", "rows_of", "sections_digest"]


def drawn_again(family: Family, block: Block) -> list[str]:
    """Say which variants of a block were drawn more than once, and why."""
    return [
        f"{family.name(int(block.index[row]))}: {block.attempts[row]} draws, the first refused: "
        f"{block.refused[row]}"
        for row in np.flatnonzero(block.attempts > 1)
    ]


def rows_of(family: Family, block: Block) -> dict[str, Any]:
    """Return the manifest's columns for a block."""
    batch = block.batch
    count, skin, measured = len(block.index), of_skin(batch), over_span(batch)
    rows: dict[str, Any] = {
        "index": block.index,
        "name": [family.name(int(place)) for place in block.index],
        "valid": block.valid,
        "reason": list(block.reasons),
        "attempts": block.attempts,
        "seed": _seeds(family.design.seed, count),
    }
    for name, column in zip(family.design.what.names, block.values.T, strict=True):
        degrees = name == "twist"
        rows["twist_deg" if degrees else name] = np.degrees(column) if degrees else column
    rows |= {
        "volume_m3": skin["volume"],
        "surface_m2": skin["surface"],
        "sections_sha256": [sections_digest(sections) for sections in batch.sections],
        "section_chord_m": measured["chord"],
        "section_twist_deg": measured["twist"],
        "section_relative_thickness": measured["thickness"],
    }
    return rows | {f"section_{name}_{UNITS[name]}": measured[name] for name in polygons.MEASURES}


def _seeds(seed: int, count: int) -> Any:
    """Return a seed's column; as text if it has more digits than a column of numbers holds."""
    return np.full(count, seed, dtype=np.int64) if seed < WIDEST else [str(seed)] * count


def sections_digest(sections: Any) -> str:
    """Return the SHA-256 of one variant's sections, little-endian, as hex digits."""
    data = np.ascontiguousarray(sections).astype(sections.dtype.newbyteorder("<"), copy=False)
    return hashlib.sha256(data.tobytes()).hexdigest()
