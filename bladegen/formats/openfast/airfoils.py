"""OpenFAST: airfoil files, each of coordinates alone or of polars that name their coordinates.

The first point of a coordinate file is the airfoil's reference point, about which its polars
are; AeroDyn's blade table tells where it runs.
"""

import re
from dataclasses import dataclass, replace
from pathlib import Path

from bladegen.definition.blade_definition import Airfoil
from bladegen.errors import FileError
from bladegen.formats.airfoils.by_name import of_file
from bladegen.formats.airfoils.folder_reading import files_of
from bladegen.formats.airfoils.reading import of_lines
from bladegen.formats.common.document import Notes, Range
from bladegen.formats.common.text_file import head, read_lines, referred
from bladegen.formats.openfast.polar_reading import COLUMNS, Columns, holds_tables, polars

__all__ = ["FILES", "Shape", "files_in_order", "shape"]

FILES = (".txt", ".dat", ".csv", ".afl")

REFERENCE = Range(-0.5, 1.5, "of the chord")
QUARTER = 0.25
_TABLES = re.compile(r"^\s*\S+\s+NumTabs\b")


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
    files = files_of(folder, FILES)
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
    try:
        read = of_lines(_shape_lines(lines), path.name)
    except FileError as error:
        notes.problems += [f"{path.name}: {problem}" for problem in error.problems]
        return None
    x, y = read.reference or (QUARTER, 0.0)
    if not REFERENCE.holds([x, y]).all():
        notes.problems.append(
            f"{path.name}: reference point ({x:g}, {y:g}), allowed is {REFERENCE}"
        )
        return None
    made = of_file(_name(lines, path), path.name, read, None, notes)
    if own:
        made = replace(made, polars=own, aerodynamic_center=x)
    return Shape(made, x, y)


def _shape_lines(lines: list[str]) -> list[str]:
    """Return a file's lines without the tables of polars behind its coordinates."""
    end = next((k for k, line in enumerate(lines) if _TABLES.match(line)), len(lines))
    return lines[:end]


def _name(lines: list[str], path: Path) -> str:
    """Return the name that bladegen writes into its coordinate files, else the file's own."""
    for line in lines[:8]:
        match = re.match(r"!\s*airfoil:\s*(\S.*)", line)
        if match:
            return match[1].strip()[:80]
    return path.stem
