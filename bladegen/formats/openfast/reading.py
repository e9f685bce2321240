"""OpenFAST: an AeroDyn blade file with the airfoil files of its AFID numbers, or what names it.

That is AeroDyn's main input, or a turbine's .fst file (`bladegen.formats.openfast.model`).

Conventions (OpenFAST documentation, AeroDyn input files): BlSpn [m] along the pitch axis from
the root; BlCrvAC [m] downwind and BlSwpAC [m] against the rotation, both of the aerodynamic
centre; BlTwist [deg] positive with the leading edge upwind; BlChord [m].  The aerodynamic centre
is the reference point of each airfoil's coordinate file.  BlCrvAng follows from BlCrvAC.
The files hold no reference axis: see `bladegen.definition.conventions.axis_of_line`.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from bladegen.definition.blade_definition import (
    BladeDefinition,
    Distribution,
    ReferenceAxis,
    Rotor,
    Station,
)
from bladegen.definition.conventions import axis_finding, axis_of_line
from bladegen.errors import Finding
from bladegen.formats.airfoils.folder_reading import beside
from bladegen.formats.common.document import Notes, Range
from bladegen.formats.common.text_file import head, number, numbers, read_lines, rising
from bladegen.formats.openfast.airfoils import FILES, Shape, files_in_order, shape
from bladegen.formats.openfast.model import (
    TURBINE,
    Main,
    is_main,
    is_turbine,
    main_beside,
    main_input,
    turbine,
)
from bladegen.formats.openfast.polar_reading import COLUMNS as COLUMNS_OF_TABLES
from bladegen.support.arrays import Array

__all__ = ["COLUMNS", "TWIST_SUFFIX", "read", "recognises"]

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
SAME = 1e-6  # of the span; nodes of two files nearer than this are one
LENGTHS_ALIKE = 0.01  # of the length; by more may blade and rotor not differ without a word


def recognises(path: Path) -> bool:
    """Tell whether a file is an AeroDyn blade file, AeroDyn's main input, or a turbine's."""
    text = head(path)
    if path.suffix.lower() == TURBINE:
        return is_turbine(text)
    return ("BlSpn" in text and "BlChord" in text) or is_main(text)


def read(path: Path, notes: Notes, airfoils: Path | None = None) -> BladeDefinition | None:
    """Read a blade; None if there are problems, which `notes` then holds."""
    main, rotor = None, Rotor()
    blade = path
    if path.suffix.lower() == TURBINE:
        named = turbine(path, notes)
        if named is None:
            return None
        main, rotor = named
    elif not _header(lines := read_lines(path)):
        main = main_input(path, lines)
    if main is not None:
        found = main.blade(notes)
        if found is None:
            return None
        blade = found
    lines = read_lines(blade)
    table = _table(lines, notes)
    if table is None:
        return None
    span, ids = table["BlSpn"], table["BlAFID"].astype(int)
    if not rising(span, [f"row {k + 1}" for k in range(len(span))], "BlSpn", notes):
        return None
    shapes = _shapes(blade, main, ids, airfoils, notes)
    if notes.problems or shapes is None:
        return None
    length = float(span[-1] - span[0])
    if rotor.diameter is not None and rotor.hub_radius is not None:
        stated = 0.5 * rotor.diameter - rotor.hub_radius
        if abs(stated - length) > LENGTHS_ALIKE * length:
            said = f"of ElastoDyn are {stated:g} m apart, BlSpn is {length:g} m long"
            notes.findings.append(Finding("TipRad, HubRad", said))
    return replace(_definition(path, blade, table, shapes, notes), rotor=rotor)


def _definition(
    path: Path, blade: Path, table: dict[str, Array], shapes: dict[int, Shape], notes: Notes
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
    names = lines[start].split() if lines else []
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


def _shapes(
    blade: Path, main: Main | None, ids: Array, given: Path | None, notes: Notes
) -> dict[int, Shape] | None:
    """Find the airfoils of the table: by the main input, a given folder, or that beside it."""
    if given is None and main is None:
        main = main_beside(blade)
    if given is None and main is not None:
        named = main.airfoils(notes)
        if named is None:
            return None
        files = named
    else:
        folder = beside(blade, given, notes)
        if folder is None:
            return None
        files = files_in_order(folder)
    if not files:
        notes.problems.append(
            f"BlAFID: {given or 'the folder'} holds no airfoil files ({', '.join(FILES)})"
        )
        return None
    last = int(ids.max())
    if last > len(files):
        where = given or (files[0].parent.name if files else "the folder")
        notes.problems.append(
            f"BlAFID: got {last}, allowed are 1 to {len(files)}, the airfoil files of {where}"
        )
        return None
    columns = COLUMNS_OF_TABLES if main is None else main.columns
    shapes = {}
    for k in np.unique(ids).tolist():
        made = shape(files[k - 1], notes, columns)
        if made is not None:
            shapes[k] = made
    return shapes if len(shapes) == len(np.unique(ids)) else None


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
