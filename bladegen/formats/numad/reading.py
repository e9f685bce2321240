"""NuMAD workbooks: the sheet "Geometry" of the blade files of NuMAD and pyNuMAD.

Layout (pyNuMAD, io/excel_to_blade and objects/geometry): in column B natural offset (T or F),
rotor spin (CW or CCW) and swept twist (T or F) in rows 2 to 4; from row 7 on, down to the first
empty span: span [m], twist [deg, leading edge upwind], chord [m], thickness [%], chord offset and
aerodynamic centre [chords] in A to F, empty where there is no value; airfoils in H (span [m])
and I (name).  The offset is the distance from leading edge to pitch axis; with natural offset it
is counted from the place of the greatest thickness.  There is no prebend and no sweep.  Column K
has output stations [m], over which what lies inside the skin (`components`) counts its span.  The
older workbooks, and project files, are `stations`.
"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from bladegen.definition.blade_definition import BladeDefinition, Distribution
from bladegen.errors import Finding
from bladegen.formats.airfoils.contours import thickest
from bladegen.formats.airfoils.folder_reading import beside, shapes
from bladegen.formats.common import workbook
from bladegen.formats.common.assembly import Library, Schedule, assemble, span_fractions
from bladegen.formats.common.document import Notes, Range
from bladegen.formats.common.table import Column, Rows, values_of
from bladegen.formats.common.text_file import head
from bladegen.formats.numad import components, materials
from bladegen.formats.numad import stations as numad_stations
from bladegen.support.arrays import Array

__all__ = ["SHEET", "read", "recognises"]

PROJECT = ".nmd"
SHEET = "Geometry"
FIRST_ROW = 7
COLUMNS = (
    ("z", "span", 1.0, Range(0.0, 1000.0, "m")),
    ("twist", "twist", math.pi / 180.0, Range(-math.pi / 2, math.pi / 2, "rad")),
    ("chord", "chord", 1.0, Range(0.0, 100.0, "m", above=True)),
    ("rthick", "thickness", 0.01, Range(0.0, 1.05, "of the chord", above=True)),
    ("pitch_axis", "chord offset", 1.0, Range(-1.0, 2.0, "of the chord")),
)
AIRFOIL_SPAN, AIRFOIL_NAME = 7, 8
OUTPUT = 10  # its column
ROUNDING = 1e-6  # of the span, by which output stations may miss root and tip


def recognises(path: Path) -> bool:
    """Tell whether a file is a workbook or a project of NuMAD."""
    if path.suffix.lower() == PROJECT:
        return "<blade>" in head(path).lower()
    return _sheet(path) is not None


def _sheet(path: Path) -> str | None:
    """Return the title of the sheet, however it is capitalised."""
    return next(
        (name for name in workbook.sheet_names(path) if name.lower() == SHEET.lower()), None
    )


def read(path: Path, notes: Notes, airfoils: Path | None = None) -> BladeDefinition | None:
    """Read a blade; None if there are problems, which `notes` then holds."""
    if path.suffix.lower() == PROJECT:
        return numad_stations.read_project(path, notes)
    titles = {name.strip().lower(): name for name in workbook.sheet_names(path)}
    wanted = [titles.get(one.lower(), one) for one in (SHEET, components.SHEET, materials.SHEET)]
    found_sheets = workbook.sheets(path, tuple(wanted))
    rows, parts, made_of = (found_sheets.get(name, []) for name in wanted)
    if numad_stations.is_layout(rows):
        return numad_stations.read_workbook(path, rows, notes, airfoils)
    natural = _switch(rows, 2, ("T", "F"), notes) == "T"
    if _switch(rows, 3, ("CW", "CCW"), notes) == "CCW":
        notes.findings.append(
            Finding(f"{SHEET}!B3", "CCW: read as CW, of which the rotor is the mirror image")
        )
    twisted = _switch(rows, 4, ("T", "F"), notes) == "T"
    table = _until_empty(rows, 0)
    places = tuple(at for at, _ in table)
    values = {}
    for k, (key, title, factor, allowed) in enumerate(COLUMNS):
        cells = tuple(row[k] if k < len(row) else None for _, row in table)
        column = values_of(Column(key, title, factor, allowed, cells, places), notes)
        if column is not None and not np.isnan(column).all():
            values[key] = column
    if "z" not in values:
        notes.problems.append(f"{SHEET}!A{FIRST_ROW}: holds no span, must be metres from the root")
    if notes.problems or span_fractions(values, places, notes) is None:
        return None
    schedule = _schedule(rows, values["z"], notes)
    folder = beside(path, airfoils, notes)
    if notes.problems or folder is None:
        return None
    found = shapes(folder, [name for _, name, _ in schedule], notes)
    offset = values.setdefault("pitch_axis", np.zeros(len(places)))
    if natural and not notes.problems:
        natural_offset = _natural([(eta, found[name].coordinates) for eta, name, _ in schedule])
        z = values["z"]
        values["pitch_axis"] = offset + natural_offset((z - z[0]) / (z[-1] - z[0]))
        notes.findings.append(
            Finding(
                f"{SHEET}!B2",
                "natural offset: the pitch axis is counted from the greatest thickness of the "
                "airfoils, interpolated between them",
            )
        )
    ends = _output_ends(rows, values["z"], notes)
    structure = components.read(parts, made_of, notes, ends=ends, twisted=twisted)
    made = assemble(path, values, places, schedule, Library(lambda _: found, list), notes)
    return None if made is None else replace(made, structure=structure)


def _output_ends(rows: Rows, z: Array, notes: Notes) -> tuple[float, float]:
    """Return the span fractions of the first and the last output station, the blade's if none."""
    stations = [
        cell for _, cells in _until_empty(rows, OUTPUT) if isinstance(cell := cells[OUTPUT], float)
    ]
    if len(stations) < 2 or stations[0] >= stations[-1]:
        return 0.0, 1.0
    low, high = ((at - z[0]) / (z[-1] - z[0]) for at in (stations[0], stations[-1]))
    if low < -ROUNDING or high > 1.0 + ROUNDING:
        said = (
            f"output stations run {stations[0]:g} to {stations[-1]:g} m, the blade {z[0]:g} to "
            f"{z[-1]:g} m; components are counted over what is common"
        )
        notes.findings.append(Finding(f"{SHEET}!K{FIRST_ROW}", said))
    return (
        float(low) if low > ROUNDING else 0.0,
        float(high) if high < 1.0 - ROUNDING else 1.0,
    )


def _switch(rows: Rows, at: int, allowed: tuple[str, str], notes: Notes) -> str:
    """Return one of two words from column B; an empty cell is the second one."""
    cells = next((row for number, row in rows if number == at), [])
    cell = cells[1] if len(cells) > 1 else None
    word = {"TRUE": "T", "FALSE": "F"}.get(str(cell).strip().upper(), str(cell).strip().upper())
    if cell is None:
        return allowed[1]
    if word not in allowed:
        notes.problems.append(
            f"{SHEET}!B{at}: got {str(cell)[:40]!r}, allowed are {' and '.join(allowed)}"
        )
    return word


def _until_empty(rows: Rows, column: int) -> Rows:
    """Return the rows from the first of the data to the first without an entry in a column."""
    found: Rows = []
    for at, cells in rows:
        if at < FIRST_ROW:
            continue
        cell = cells[column] if column < len(cells) else None
        if cell is None or (isinstance(cell, str) and not cell.strip()):
            break
        found.append((at, cells))
    return found


def _schedule(rows: Rows, z: Array, notes: Notes) -> Schedule:
    """Return the airfoils along the span."""
    table = _until_empty(rows, AIRFOIL_SPAN)
    places = tuple(at for at, _ in table)
    span = values_of(
        Column(
            "z",
            "airfoil span",
            1.0,
            Range(float(z[0]), float(z[-1]), "m, the blade's span"),
            tuple(cells[AIRFOIL_SPAN] for _, cells in table),
            places,
        ),
        notes,
    )
    if not table:
        notes.problems.append(f"{SHEET}!H{FIRST_ROW}: holds no airfoils, must be span and name")
    if span is None:
        return []
    names = [str(cells[AIRFOIL_NAME]).strip() for _, cells in table]
    eta = (span - z[0]) / (z[-1] - z[0])
    return list(zip(eta.tolist(), names, places, strict=True))


def _natural(stations: list[tuple[float, Array]]) -> Distribution:
    """Return where the airfoils are thickest [chords] as a function of span."""
    eta = np.array([at for at, _ in stations])
    values = np.array([thickest(points) for _, points in stations])
    if len(eta) == 1:
        return Distribution.constant(float(values[0]))
    return Distribution(eta, values)
