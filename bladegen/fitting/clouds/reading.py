"""Points of files: text with three numbers a line (.xyz, .csv, .txt), and PLY without triangles."""

from pathlib import Path

import numpy as np

from bladegen.errors import FileError
from bladegen.measures import foreign
from bladegen.support.arrays import Array
from bladegen.surface.mesh_files import FARTHEST

__all__ = ["TEXTS", "is_cloud", "points_of"]

TEXTS = (".xyz", ".csv", ".txt", ".pts")
LARGEST = 2 * 10**9  # bytes of a file
HEADER = 20  # lines at most that are no numbers, before the points
MARKS = (",", ";", "\t", None)  # between numbers; None is any blank


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
    points = _text(path) if path.suffix.lower() in TEXTS else _ply(path)
    if not np.isfinite(points).all() or np.abs(points).max(initial=0.0) > FARTHEST:
        raise FileError(
            str(path), [f"has points that are no numbers, or farther away than {FARTHEST:g}"]
        )
    return points


def _ply(path: Path) -> Array:
    return np.asarray(foreign.ask("points", path).arrays["points"], dtype=np.float64)


def _text(path: Path) -> Array:
    if not path.is_file():
        raise FileError(str(path), ["is no file"])
    if path.stat().st_size > LARGEST:
        raise FileError(str(path), [f"has {path.stat().st_size} bytes, allowed are {LARGEST}"])
    with path.open(encoding="utf-8", errors="replace") as stream:
        head = [stream.readline() for _ in range(HEADER)]
    for skipped, line in enumerate(head):
        mark = next((m for m in MARKS if _is_row(line, m)), "")
        if mark == "":
            continue
        try:
            return np.loadtxt(
                path, delimiter=mark, skiprows=skipped, usecols=(0, 1, 2), ndmin=2, comments="#"
            )
        except ValueError as error:
            raise FileError(str(path), [f"no table of numbers: {error}"]) from None
    raise FileError(
        str(path), [f"no line of its first {HEADER} holds three numbers x, y, z of a point"]
    )


def _is_row(line: str, mark: str | None) -> bool:
    words = line.split(mark)
    try:
        return len([float(word) for word in words[:3]]) == 3
    except ValueError:
        return False
