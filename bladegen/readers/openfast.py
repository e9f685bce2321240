"""OpenFAST: an AeroDyn blade file, with the airfoil coordinate files of its AFID numbers.

Conventions (OpenFAST documentation, AeroDyn input files): BlSpn [m] along the pitch axis from
the root; BlCrvAC [m] downwind and BlSwpAC [m] against the rotation, both of the aerodynamic
centre; BlTwist [deg] positive with the leading edge upwind; BlChord [m].  The aerodynamic centre
is the reference point of each airfoil's coordinate file.  BlCrvAng follows from BlCrvAC.
The files hold no reference axis: see `bladegen.conventions.axis_of_line`.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bladegen.arrays import Array
from bladegen.conventions import axis_finding, axis_of_line
from bladegen.definition import Airfoil, BladeDefinition, Distribution, ReferenceAxis, Station
from bladegen.errors import FileError, Finding
from bladegen.readers.airfoil_folder import beside, files_of
from bladegen.readers.airfoils import airfoil
from bladegen.readers.document import Node, Notes, Range
from bladegen.readers.text_file import head, number, numbers, read_lines, referred, rising

__all__ = ["COLUMNS", "MARK", "SUFFIXES", "TWIST_SUFFIX", "read", "recognises"]

MARK = "an AeroDyn blade table with BlSpn and BlChord, or an AeroDyn input with ADBlFile(1)"
SUFFIXES = (".dat",)
COLUMNS = {
    "BlSpn": Range(0.0, 1000.0, "m"),
    "BlCrvAC": Range(-1000.0, 1000.0, "m"),
    "BlSwpAC": Range(-1000.0, 1000.0, "m"),
    "BlTwist": Range(-90.0, 90.0, "deg"),
    "BlChord": Range(0.0, 100.0, "m", above=True),
    "BlAFID": Range(1, 10_000),
}
TWIST_SUFFIX = "_ElastoDyn_twist.dat"
PITCH_AXIS = Range(-1.0, 2.0, "of the chord")
REFERENCE = Range(-0.5, 1.5, "of the chord")
QUARTER = 0.25
SAME = 1e-6  # of the span; nodes of two files nearer than this are one
NEIGHBOURS = 200  # files beside a blade file that are looked into for AeroDyn's main input


@dataclass(frozen=True)
class _Shape:
    """An airfoil and its reference point, in chords."""

    airfoil: Airfoil
    x: float
    y: float


def recognises(path: Path) -> bool:
    """Tell whether a file is an AeroDyn blade file, or AeroDyn's main input."""
    text = head(path)
    return ("BlSpn" in text and "BlChord" in text) or _names_blade(text)


def read(path: Path, notes: Notes, airfoils: Path | None = None) -> BladeDefinition | None:
    """Read a blade; None if there are problems, which `notes` then holds."""
    main: list[str] | None = None
    blade = path
    lines = read_lines(path)
    if not _header(lines):
        main, named = lines, _main_value(lines, r"ADBlFile\(1\)")
        found = referred(named or "", [path.parent])
        if found is None:
            notes.problems.append(
                f"ADBlFile(1): got {named!r}, must be a file in {path.parent.name or '.'} or below "
                "it; convert the blade file itself where it lies elsewhere"
            )
            return None
        blade, lines = found, read_lines(found)
    table = _table(lines, notes)
    if table is None:
        return None
    span, ids = table["BlSpn"], table["BlAFID"].astype(int)
    if not rising(span, [f"row {k + 1}" for k in range(len(span))], "BlSpn", notes):
        return None
    shapes = _shapes(path, blade, main, ids, airfoils, notes)
    if notes.problems or shapes is None:
        return None
    return _definition(path, blade, table, shapes, notes)


def _definition(
    path: Path, blade: Path, table: dict[str, Array], shapes: dict[int, _Shape], notes: Notes
) -> BladeDefinition:
    span, chord, twist = table["BlSpn"], table["BlChord"], np.radians(table["BlTwist"])
    ids = table["BlAFID"].astype(int)
    eta = (span - span[0]) / (span[-1] - span[0])
    at = np.array([[shapes[k].x, shapes[k].y] for k in ids])
    x = table["BlCrvAC"] - at[:, 1] * chord * np.cos(twist)
    y = table["BlSwpAC"] + at[:, 1] * chord * np.sin(twist)
    pitch_axis = _pitch_axis(blade, eta, notes)
    line = axis_of_line(x, y, chord, twist, at[:, 0], pitch_axis)
    if pitch_axis is None:
        notes.findings.append(axis_finding("BlSwpAC", line))
    runs = np.flatnonzero(np.diff(ids)) + 1
    kept = np.unique(np.concatenate([[0], runs - 1, runs, [len(ids) - 1]]))
    return BladeDefinition(
        name=path.stem,
        stations=tuple(Station(float(eta[k]), shapes[int(ids[k])].airfoil) for k in kept),
        chord=Distribution(eta, chord),
        twist=Distribution(eta, twist),
        axis=ReferenceAxis(
            Distribution(eta, line.x), Distribution(eta, line.y), Distribution(eta, span)
        ),
        section_offset_y=Distribution(eta, line.offset),
        source=str(path),
        findings=tuple(notes.findings),
    )


def _header(lines: list[str]) -> int:
    """Return the number of the line that names the columns, 0 if none does."""
    for k, line in enumerate(lines[:40]):
        words = line.split()
        if words[:1] == ["BlSpn"] and "BlChord" in words:
            return k
    return 0


def _table(lines: list[str], notes: Notes) -> dict[str, Array] | None:
    """Read the columns of a blade table."""
    start = _header(lines)
    names = lines[start].split()
    missing = [name for name in COLUMNS if name not in names]
    if not start or missing:
        notes.problems.append(f"columns: {', '.join(missing)} missing, must be given")
        return None
    stated = next(
        (line.split()[0] for line in lines[:start] if "NumBlNds" in line.split()[1:2]), ""
    )
    count = number(stated)
    if count is None or not 2 <= count <= 100_000 or count != int(count):
        notes.problems.append(f"NumBlNds: got {stated[:40]!r}, allowed are whole numbers from 2")
        return None
    rows = [line.split() for line in lines[start + 2 : start + 2 + int(count)]]
    short = [k for k, row in enumerate(rows) if len(row) <= max(map(names.index, COLUMNS))]
    if short or len(rows) < count:
        at = start + 3 + (short[0] if short else len(rows))
        notes.problems.append(
            f"line {at}: must be row {at - start - 2} of the {int(count)} that NumBlNds states, "
            f"with {', '.join(COLUMNS)}"
        )
        return None
    places = [f"line {start + 3 + k}" for k in range(len(rows))]
    found = {
        name: numbers([row[names.index(name)] for row in rows], places, name, allowed, notes)
        for name, allowed in COLUMNS.items()
    }
    table = {name: values for name, values in found.items() if values is not None}
    return table if len(table) == len(COLUMNS) else None


def _names_blade(text: str) -> bool:
    return "ADBlFile(1)" in text


def _main_value(lines: list[str], label: str) -> str | None:
    """Return the quoted value that stands before a label in AeroDyn's main input."""
    for line in lines:
        match = re.match(rf"\s*(\"[^\"]*\"|'[^']*'|\S+)\s+{label}(\s|$)", line)
        if match:
            return match[1].strip("\"'")
    return None


def _airfoil_names(lines: list[str]) -> list[str]:
    """Return the airfoil files that AeroDyn's main input lists, in the order of AFID."""
    for k, line in enumerate(lines):
        if re.search(r"\sAFNames(\s|$)", line):
            names = []
            for entry in lines[k:]:
                match = re.match(r"\s*(\"[^\"]*\"|'[^']*')", entry)
                if match is None:
                    break
                names.append(match[1].strip("\"'"))
            return names
    return []


def _shapes(
    path: Path, blade: Path, main: list[str] | None, ids: Array, given: Path | None, notes: Notes
) -> dict[int, _Shape] | None:
    """Find the airfoils of the table: by the main input, a given folder, or that beside it."""
    if given is None and main is None:
        main = _main_beside(blade)
    files: list[Path] = []
    if given is None and main is not None:
        base = path.parent
        for k, name in enumerate(_airfoil_names(main)):
            found = referred(name, [base])
            if found is None:
                notes.problems.append(
                    f"AFNames, entry {k + 1}: {name[:60]!r} is no file in {base.name or '.'} or "
                    "below it; name the folder (--airfoils DIR)"
                )
                return None
            files.append(found)
    else:
        folder = beside(blade, given, notes)
        if folder is None:
            return None
        files = _in_order(folder)
    last = int(ids.max())
    if last > len(files):
        where = given or (files[0].parent.name if files else "the folder")
        notes.problems.append(
            f"BlAFID: got {last}, allowed are 1 to {len(files)}, the airfoil files of {where}"
        )
        return None
    shapes = {}
    for k in np.unique(ids).tolist():
        shape = _shape(files[k - 1], notes)
        if shape is not None:
            shapes[k] = shape
    return shapes if len(shapes) == len(np.unique(ids)) else None


def _main_beside(blade: Path) -> list[str] | None:
    """Return AeroDyn's main input that names a blade file, if it lies beside it."""
    for path in files_of(blade.parent, SUFFIXES)[:NEIGHBOURS]:
        if path != blade and _names_blade(head(path)):
            lines = read_lines(path)
            named = referred(_main_value(lines, r"ADBlFile\(1\)") or "", [path.parent])
            if named == blade.resolve():
                return lines
    return None


def _in_order(folder: Path) -> list[Path]:
    """Return the airfoil files of a folder in the order of AFID: coordinates, else polars."""
    files = files_of(folder, (".txt", ".dat", ".csv"))
    coordinates = [path for path in files if "coord" in path.name.lower()]
    return coordinates or files


def _shape(path: Path, notes: Notes) -> _Shape | None:
    """Read an airfoil's coordinates: from its own file, or the one that a polar file names."""
    try:
        lines = read_lines(path)
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
    return None if made is None else _Shape(made, x, y)


def _name(lines: list[str], path: Path) -> str:
    """Return the name that bladegen writes into its coordinate files, else the file's own."""
    for line in lines[:8]:
        match = re.match(r"!\s*airfoil:\s*(\S.*)", line)
        if match:
            return match[1].strip()[:80]
    return path.stem


def _pitch_axis(blade: Path, eta: Array, notes: Notes) -> Array | None:
    """Return the pitch axis (of chord) of the twist table that bladegen writes beside a blade."""
    path = blade.with_name(f"{blade.stem}{TWIST_SUFFIX}")
    if not path.is_file():
        return None
    rows = [[number(word) for word in line.split()] for line in read_lines(path)]
    pairs = [row[:2] for row in rows if len(row) == 3 and None not in row]
    if len(pairs) == len(eta):
        table = np.array(pairs, dtype=np.float64)
        if np.all(np.abs(table[:, 0] - eta) < SAME) and PITCH_AXIS.holds(table[:, 1]).all():
            return table[:, 1]
    notes.findings.append(Finding(path.name, "is of another blade (BlFract differs); passed over"))
    return None
