"""Airfoil coordinate files: Selig and Lednicer formats, told apart by their content.

Selig: a title, then one loop of x and y, trailing edge -> leading edge -> trailing edge.
Lednicer: a title, the numbers of points of both sides, then the upper and the lower side, each
from leading to trailing edge.
"""

from pathlib import Path

import numpy as np

from bladegen.arrays import Array
from bladegen.crossing import first_crossing
from bladegen.definition import MAX_AIRFOIL_POINTS
from bladegen.errors import FileError

__all__ = ["SUFFIXES", "read_airfoil", "read_folder"]

SUFFIXES = (".dat", ".txt", ".csv", ".cor", ".pts")
MAX_BYTES = 1_000_000
FEWEST = 10  # points below which a file is no airfoil
LENGTHS = 1e-2, 1e4  # of the chord: in chords, metres, per cent or millimetres
HIGHEST = 2.0  # chords from the lowest to the highest point; a circle has 1


def read_airfoil(path: Path) -> Array:
    """Return an airfoil file's points (m, 2) as one loop from trailing edge to trailing edge.

    Raises
    ------
    FileError
        If the file cannot be read or holds no airfoil.
    """
    try:
        if path.stat().st_size > MAX_BYTES:
            raise FileError(str(path), [f"is larger than {MAX_BYTES} bytes"])
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        raise FileError(str(path), [f"cannot be read: {error.strerror}"]) from None
    rows = [pair for pair in map(_pair, lines) if pair is not None]
    points = _loop(np.array(rows, dtype=np.float64).reshape(-1, 2))
    problem = _problem(points)
    if problem:
        raise FileError(str(path), [problem])
    return points


def read_folder(folder: Path) -> tuple[dict[str, Array], dict[str, str]]:
    """Read all airfoil files of a folder.

    Returns
    -------
    airfoils : dict
        Points by file stem, in the order of names.
    unusable : dict
        The reason by file name.

    Raises
    ------
    FileError
        If there is no such folder.
    """
    if not folder.is_dir():
        raise FileError(str(folder), ["is no folder"])
    airfoils, unusable = {}, {}
    for path in sorted(folder.iterdir()):
        if path.suffix.lower() not in SUFFIXES or not path.is_file():
            continue
        try:
            airfoils[path.stem] = read_airfoil(path)
        except FileError as error:
            unusable[path.name] = "; ".join(error.problems)
    return airfoils, unusable


def _pair(line: str) -> tuple[float, float] | None:
    """Return a line's two numbers, or None if it holds anything else."""
    words = line.replace(",", " ").replace(";", " ").split()
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        return None
    return (numbers[0], numbers[1]) if len(numbers) == 2 else None


def _loop(rows: Array) -> Array:
    """Return rows as one loop, Lednicer's two sides joined at the leading edge."""
    if len(rows) < 3 or not np.all(np.isfinite(rows[0])):
        return rows
    counts = rows[0]
    whole = bool(np.all(counts == np.round(counts)) and np.all(counts > 1))
    if not whole or int(counts.sum()) != len(rows) - 1:
        return rows
    upper, lower = rows[1 : 1 + int(counts[0])], rows[1 + int(counts[0]) :]
    joined = bool(np.allclose(upper[0], lower[0], rtol=0, atol=1e-9))
    return np.concatenate([upper[::-1], lower[1:] if joined else lower])


def _problem(points: Array) -> str | None:
    """Say what keeps points from being an airfoil."""
    if not FEWEST <= len(points) <= MAX_AIRFOIL_POINTS:
        return f"has {len(points)} points, allowed are {FEWEST} to {MAX_AIRFOIL_POINTS}"
    if not np.isfinite(points).all():
        return "has a coordinate that is not finite"
    low, high = points.min(axis=0), points.max(axis=0)
    length, height = (high - low).tolist()
    if not LENGTHS[0] <= length <= LENGTHS[1]:
        return f"x spans {length:g}, allowed is {LENGTHS[0]:g} to {LENGTHS[1]:g}"
    crossing = None
    if height > HIGHEST * length:
        fault = f"y spans {height:g}, allowed is up to {HIGHEST:g} times the chord of {length:g}"
    elif min(points[[0, -1], 0]) < low[0] + 0.9 * length:
        fault = "does not run from trailing edge to trailing edge"
    else:
        crossing, fault = first_crossing(points / length), None
    if crossing is not None:
        return f"crosses itself between points {crossing[0]} and {crossing[1]}"
    return fault
