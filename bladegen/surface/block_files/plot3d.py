"""PLOT3D files: multi-block, three-dimensional, 8-byte reals, without blanking.

Fortran unformatted records, little-endian, or text.  Coordinates stand one after another, i
running fastest.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.errors import ExportError
from bladegen.support.arrays import Array

__all__ = ["write_binary", "write_text"]

LARGEST_RECORD = 2**31 - 1  # bytes that a record's mark of 32 bits can count


def write_binary(blocks: Sequence[Array], path: Path, *, scale: float = 1.0) -> None:
    """Write blocks (ni, nj, nk, 3) in Fortran unformatted records, their lengths times `scale`.

    Raises
    ------
    ExportError
        If a block is too large for a record.
    """
    largest = max(block.nbytes for block in blocks)
    if largest > LARGEST_RECORD:
        raise ExportError(
            f"{path.name}: a block takes {largest / 1e9:.1f} GB, a record of PLOT3D holds at most "
            f"{LARGEST_RECORD / 1e9:.1f} GB; write CGNS, or fewer points"
        )
    with path.open("wb") as file:
        _record(file, np.array([len(blocks)], dtype="<i4"))
        _record(file, np.array([block.shape[:3] for block in blocks], dtype="<i4"))
        for block in blocks:
            _record(file, _coordinates(block, scale))


def write_text(blocks: Sequence[Array], path: Path, *, scale: float = 1.0) -> None:
    """Write blocks (ni, nj, nk, 3) in text of 17 digits, their lengths times `scale`."""
    with path.open("w", encoding="ascii") as file:
        file.write(f"{len(blocks)}\n")
        file.writelines(" ".join(map(str, block.shape[:3])) + "\n" for block in blocks)
        for block in blocks:
            np.savetxt(file, _coordinates(block, scale), fmt="%.16e")


def _record(file: Any, values: Any) -> None:
    mark = np.array([values.nbytes], dtype="<i4").tobytes()
    file.write(mark)
    file.write(values.data)
    file.write(mark)


def _coordinates(block: Array, scale: float) -> Array:
    """Return all x, then all y, then all z, i running fastest."""
    values: Array = (scale * block).transpose(3, 2, 1, 0).reshape(-1).astype("<f8", copy=False)
    return values
