"""Airfoil coordinate files: Selig, Lednicer, NuMAD and AeroDyn, told apart by their content.

Selig: a title, then one loop of x and y, trailing edge -> leading edge -> trailing edge, or from
the leading edge around.  Lednicer: a title, the numbers of points of both sides or none, then the
upper and the lower side.  NuMAD: a loop within <coords>.  AeroDyn: NumCoords, the point that
polars are about, then the loop.  What was read otherwise than it stands is said.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bladegen.errors import FileError, Finding
from bladegen.formats.airfoils.contours import ContourError, contour, joined, sides
from bladegen.formats.airfoils.point_lines import PointLines, numbers_of, point_lines, two_sided
from bladegen.formats.common.text_file import number, read_lines
from bladegen.support.arrays import Array
from bladegen.support.files import beside

__all__ = [
    "SUFFIXES",
    "AirfoilFile",
    "AirfoilFolder",
    "airfoil_folder",
    "of_lines",
    "read_airfoil",
    "read_contour",
    "read_folder",
    "tabulates",
]

SUFFIXES = (".dat", ".txt", ".csv", ".cor", ".pts", ".afl")
MAX_BYTES = 1_000_000
FEWEST_ROWS = 4  # of a table that is one
WIDEST = 2.0  # chords: what x of Lednicer's points does not exceed, and counts do
NOTHING = "no coordinates"
ONE_WAY = 0.9  # of a table's steps along its first column
COUNTED = re.compile(r"^\s*\S+\s+NumCoords(\s|$)")
_POLAR_WORDS = re.compile(r"\b(alpha|aoa|angle|cl|cd)\b", re.IGNORECASE)
_AERODYN = re.compile(r"^\s*\S+\s+(NumTabs|NumAlf)\b", re.MULTILINE)


@dataclass(frozen=True)
class AirfoilFile:
    """An airfoil's contour (m, 2) in chords, trailing edge to trailing edge.

    Parameters
    ----------
    points : (m, 2) array
        The contour.
    said : tuple of str
        What was read otherwise than it stands.
    reference : (float, float), optional
        The point that AeroDyn's polars are about, in chords.
    """

    points: Array
    said: tuple[str, ...]
    reference: tuple[float, float] | None = None


def read_airfoil(path: Path) -> Array:
    """Return an airfoil file's points (m, 2) as one loop from trailing edge to trailing edge.

    Raises
    ------
    FileError
        If the file cannot be read or holds no airfoil.
    """
    return read_contour(path).points


def read_contour(path: Path) -> AirfoilFile:
    """Read an airfoil file.

    Raises
    ------
    FileError
        If the file cannot be read or holds no airfoil, with the line where one is to blame.
    """
    return of_lines(read_lines(path, most=MAX_BYTES), str(path))


def of_lines(lines: Sequence[str], name: str) -> AirfoilFile:
    """Return the airfoil of a coordinate file's lines; `name` is the file's.

    Raises
    ------
    FileError
        If they hold no airfoil.
    """
    found = point_lines(lines, name)
    said = list(found.said)
    points, first = found.xy, None
    if not len(points):
        raise FileError(name, ["holds no coordinates (0 points): no line has x and y"])
    counted = next((line for _, line in found.ahead if COUNTED.match(line)), None)
    if counted is not None and len(points):
        said += _miscounted(number(counted.split()[0]), len(points), "NumCoords")
        first, points = points[0], points[1:]
    elif found.ahead[1:]:
        _, line = found.ahead[-1]
        values = numbers_of(line) or []
        if len(values) == 1:
            said += _miscounted(values[0], len(points), "the line ahead of them")
    try:
        loop = contour(_loop(points, found, name), any_unit=True)
    except ContourError as error:
        raise FileError(name, [str(error)]) from None
    about = None if first is None else (loop.scale * first - loop.shift).tolist()
    return AirfoilFile(loop.points, (*said, *loop.said), about and (about[0], about[1]))


@dataclass(frozen=True)
class AirfoilFolder:
    """What a folder of airfoil files holds.

    Parameters
    ----------
    airfoils : dict
        Contours by file stem, in the order of names.
    unusable : dict
        The reason by file name.
    said : tuple of Finding
        What was read otherwise than it stands, and what stands beside shapes.
    """

    airfoils: dict[str, Array]
    unusable: dict[str, str]
    said: tuple[Finding, ...]


def read_folder(folder: Path) -> tuple[dict[str, Array], dict[str, str]]:
    """Read all airfoil files of a folder: points by stem, and the reason by unusable file.

    Raises
    ------
    FileError
        If there is no such folder.
    """
    found = airfoil_folder(folder)
    return found.airfoils, found.unusable


def airfoil_folder(folder: Path) -> AirfoilFolder:
    """Read all airfoil files of a folder; polars and texts beside them are passed over.

    Raises
    ------
    FileError
        If there is no such folder.
    """
    if not folder.is_dir():
        raise FileError(str(folder), [f"is no folder{beside(folder, folders=True)}"])
    airfoils: dict[str, Array] = {}
    unusable, said = {}, []
    for path in sorted(folder.iterdir()):
        if path.suffix.lower() not in SUFFIXES or not path.is_file():
            continue
        try:
            lines = read_lines(path, most=MAX_BYTES)
            other = tabulates(lines)
            if other is not None and other != NOTHING:
                said.append(Finding(path.name, f"holds {other}, not a shape; passed over"))
                continue
            read = of_lines(lines, str(path))
        except FileError as error:
            unusable[path.name] = "; ".join(error.problems)
            continue
        airfoils[path.stem] = read.points
        said += [Finding(path.name, one) for one in read.said]
    return AirfoilFolder(airfoils, unusable, tuple(said))


def tabulates(lines: Sequence[str]) -> str | None:
    """Say what a file holds that is no contour though it may stand beside some: polars, a text.

    Rows of three and more numbers of which the first runs one way are a table over angles; no
    contour's x does, which runs to the nose and back.
    """
    if _AERODYN.search("\n".join(lines)):
        return "polars"
    values = [numbers for line in lines if (numbers := numbers_of(line)) is not None]
    rows = [row for row in values if len(row) > 1]
    if not rows:
        return None if values else NOTHING
    if all(len(row) == 3 for row in rows) and two_sided(np.array(rows)):
        return None
    width = max({len(row) for row in rows}, key=[len(row) for row in rows].count)
    first = np.array([row[0] for row in rows if len(row) == width])
    first = first[np.isfinite(first)]
    steps = np.sign(np.diff(first))
    one_way = len(first) >= FEWEST_ROWS - 1 and abs(steps.sum()) >= ONE_WAY * len(steps)
    named = any(_POLAR_WORDS.search(line) for line in lines if numbers_of(line) is None)
    if one_way and (named or width > 2):
        return "polars" if named else f"a table of {width} columns"
    return None


def _miscounted(count: float | None, points: int, name: str) -> list[str]:
    """Say that a file counts other points than it holds."""
    if count is None or count != round(count) or count == points:
        return []
    return [f"{name} counts {count:g} points, the file holds {points}; all are taken"]


def _loop(points: Array, found: PointLines, name: str) -> Array:
    """Return points as one loop, two sides joined at the leading edge."""
    if len(points) < 4:
        return points
    counts, rest = points[0], points[1:]
    whole = bool(np.all(counts == np.round(counts)) and np.all(counts > 1))
    if not whole:
        return sides(points)
    upper = int(counts[0]) if counts[0] < len(points) else len(points)
    if int(min(counts.sum(), 1e9)) == len(rest):
        return joined(rest[:upper], rest[upper:])
    if np.ptp(rest[:, 0]) <= WIDEST < counts.min():
        raise FileError(
            name,
            [
                f"line {found.at[0]}: counts {counts[0]:g} and {counts[1]:g} points of the sides, "
                f"{counts.sum():g} together; the file holds {len(rest)}"
            ],
        )
    return sides(points)
