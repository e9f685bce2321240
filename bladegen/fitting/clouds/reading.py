"""Points of files: text with three numbers a line (.xyz, .csv, .txt), and PLY without triangles."""

from pathlib import Path

import numpy as np

from bladegen.errors import FileError
from bladegen.fitting.tables.reading import table_of
from bladegen.measures import foreign
from bladegen.support.arrays import Array
from bladegen.surface.mesh_files import FARTHEST

__all__ = ["TEXTS", "is_cloud", "points_of", "sound"]

TEXTS = (".xyz", ".csv", ".txt", ".pts")


def is_cloud(path: Path) -> bool:
    """Tell whether a file holds points and no triangles."""
    if path.suffix.lower() in TEXTS:
        return True
    if path.suffix.lower() != ".ply" or not path.is_file():
        return False
    with path.open("rb") as stream:
        head = stream.read(4096)
    return b"element face" not in head or b"element face 0\n" in head.replace(b"\r", b"")


def points_of(path: Path) -> Array:
    """Read points (m, 3) in the file's unit.

    Raises
    ------
    FileError
        If there are none, or a coordinate is no number.
    """
    points = table_of(path).points if path.suffix.lower() in TEXTS else _ply(path)
    return sound(points, str(path))


def sound(points: Array, name: str) -> Array:
    """Return points (m, 3) of a file, or raise a `FileError` if one is no place near it."""
    if not np.isfinite(points).all() or np.abs(points).max(initial=0.0) > FARTHEST:
        raise FileError(
            name, [f"has points that are no numbers, or farther away than {FARTHEST:g}"]
        )
    return points


def _ply(path: Path) -> Array:
    return np.asarray(foreign.ask("points", path).arrays["points"], dtype=np.float64)
