"""OpenFAST: airfoil files, each of coordinates alone or of polars that name their coordinates.

The first point of a coordinate file is the airfoil's reference point, about which its polars
are; AeroDyn's blade table tells where it runs.
"""

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from bladegen.definition import Airfoil
from bladegen.errors import FileError
from bladegen.readers.airfoil_folder import files_of
from bladegen.readers.airfoil_info import COLUMNS, Columns, holds_tables, polars
from bladegen.readers.airfoils import airfoil
from bladegen.readers.document import Node, Notes, Range
from bladegen.readers.text_file import head, number, read_lines, referred

__all__ = ["Shape", "files_in_order", "shape"]

REFERENCE = Range(-0.5, 1.5, "of the chord")
QUARTER = 0.25


@dataclass(frozen=True)
class Shape:
    """An airfoil and its reference point, in chords."""

    airfoil: Airfoil
    x: float
    y: float


def files_in_order(folder: Path) -> list[Path]:
    """Return the airfoil files of a folder in the order of AFID.

    Those with polars where there is one for each file of coordinates, else the coordinates.
    """
    files = files_of(folder, (".txt", ".dat", ".csv"))
    coordinates = [path for path in files if "coord" in path.name.lower()]
    others = [path for path in files if path not in coordinates]
    tables = [path for path in others if coordinates and holds_tables(head(path))]
    return (tables if len(tables) >= len(coordinates) else coordinates) or files


def shape(path: Path, notes: Notes, columns: Columns = COLUMNS) -> Shape | None:
    """Read an airfoil: its coordinates, of its own file or one below its folder, and polars.

    Parameters
    ----------
    path : Path
        The airfoil's file.
    notes : Notes
        Takes problems of its shape, and findings on its polars.
    columns : Columns
        Of the tables of polars.
    """
    try:
        lines = read_lines(path)
        own = polars(lines, path.name, notes, columns)
        named = next((line for line in lines if re.search(r"\sNumCoords(\s|$)", line)), "")
        linked = re.match(r"\s*@\s*[\"']?([^\"'\s]+)", named)
        if linked:
            found = referred(linked[1], [path.parent])
            if found is None:
                notes.problems.append(
                    f"{path.name}, NumCoords: {linked[1][:60]!r} is no file in {path.parent.name}"
                )
                return None
            path, lines = found, read_lines(found)
    except FileError as error:
        notes.problems += [f"{path.name}: {problem}" for problem in error.problems]
        return None
    rows = [tuple(map(number, line.split())) for line in lines if not line.lstrip().startswith("!")]
    pairs = [row for row in rows if len(row) == 2 and None not in row]
    counted = any(re.search(r"\sNumCoords(\s|$)", line) for line in lines)
    if not pairs:
        notes.problems.append(f"{path.name}: holds no coordinates (NumCoords and rows of x/c, y/c)")
        return None
    points = np.array(pairs, dtype=np.float64)
    x, y = (points[0].tolist()) if counted else (QUARTER, 0.0)
    points = points[1:] if counted else points
    if not REFERENCE.holds([x, y]).all():
        notes.problems.append(
            f"{path.name}: reference point ({x:g}, {y:g}), allowed is {REFERENCE}"
        )
        return None
    value = {"coordinates": {"x": points[:, 0].tolist(), "y": points[:, 1].tolist()}}
    made = airfoil(_name(lines, path), Node(value, path.name, notes), "relative_thickness")
    if made is not None and own:
        made = replace(made, polars=own, aerodynamic_center=x)
    return None if made is None else Shape(made, x, y)


def _name(lines: list[str], path: Path) -> str:
    """Return the name that bladegen writes into its coordinate files, else the file's own."""
    for line in lines[:8]:
        match = re.match(r"!\s*airfoil:\s*(\S.*)", line)
        if match:
            return match[1].strip()[:80]
    return path.stem
