"""Plain spanwise tables: CSV files, and workbooks in the layout of the IEA tabular files.

A CSV file has a header with units, a row a span, and a folder of airfoil files beside it; lines
that start with # say more (``# hub_radius_m: 3.97``).  An empty cell means that the quantity has
no point of its own there, so that each keeps its own grid.  A workbook has the sheet "Blade
Geometry" (airfoils along the span, then a profile table) and a sheet "Airfoil NAME" for each
airfoil; prebend is positive upwind there (generateTables.py of IEAWindTask37/IEA-15-240-RWT).
Signs are otherwise those of windIO: twist moves the leading edge upwind, prebend is positive
downwind, sweep positive toward the trailing edge.
"""

import csv
from collections.abc import Iterator
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np

from bladegen.definition.blade_definition import Airfoil, BladeDefinition, Rotor
from bladegen.errors import Finding
from bladegen.formats.airfoils.by_name import airfoil
from bladegen.formats.airfoils.contours import thickness
from bladegen.formats.airfoils.folder_reading import beside, shapes, thick_airfoils
from bladegen.formats.common import workbook
from bladegen.formats.common.assembly import Library, Schedule, assemble, span_fractions
from bladegen.formats.common.document import Node, Notes, Range
from bladegen.formats.common.header_languages import chords_elsewhere, in_english
from bladegen.formats.common.table import Block, Cell, Rows, blocks, values_of
from bladegen.formats.common.text_file import delimiter_of, head, number, read_lines
from bladegen.support.arrays import Array

__all__ = ["AIRFOIL", "FACTS", "GEOMETRY", "read", "recognises"]

GEOMETRY, AIRFOIL = "Blade Geometry", "Airfoil "
UPWIND = "positive upwind in this layout; read with its sign turned"
FACTS = {
    "number_of_blades": Range(1, 10),
    "hub_radius_m": Range(0.0, 500.0, "m"),
    "rotor_diameter_m": Range(0.0, 1000.0, "m"),
    "cone_deg": Range(-90.0, 90.0, "deg"),
    "tilt_deg": Range(-90.0, 90.0, "deg"),
}
LONGEST_HUB = 0.2  # of the tip radius; radii that start beyond it are no hub


def recognises(path: Path) -> bool:
    """Tell whether a file is a spanwise table."""
    if path.suffix.lower() == ".csv":
        words = head(path).lower()
        return "chord" in words or any(name in words for name in chords_elsewhere())
    names = workbook.sheet_names(path)
    return GEOMETRY in names or (bool(names) and "Geometry" not in names)


def read(path: Path, notes: Notes, airfoils: Path | None = None) -> BladeDefinition | None:
    """Read a blade; None if there are problems, which `notes` then holds."""
    own: dict[str, Rows] = {}
    if path.suffix.lower() == ".csv":
        facts, rows = _csv(path, notes)
        upwind = False
    else:
        book = workbook.sheets(path)
        upwind = GEOMETRY in book
        rows = book[GEOMETRY] if upwind else next(iter(book.values()), [])
        own = {name.removeprefix(AIRFOIL): book[name] for name in book if name.startswith(AIRFOIL)}
        facts = _overview(book.get("Overview", []))
    tables = blocks(rows, notes)
    profile = next((table for table in tables if "chord" in table.columns), None)
    if profile is None:
        notes.problems.append(
            "no table: must have a header with span and chord, such as z_m, chord_m"
            + in_english(next((cells for _, cells in rows if any(cells)), ()))
        )
        return None
    values = _values(profile, notes)
    if notes.problems:
        return None
    if upwind and "prebend" in values:
        values["prebend"] = 0.0 - values["prebend"]
        notes.findings.append(Finding("Prebend", UPWIND))
    hub = _hub_taken_off(profile, values, notes)
    span = span_fractions(values, profile.rows, notes)
    if span is None:
        return None
    schedule = _schedule(tables, profile, span, notes)
    library = _library(path, own if airfoils is None else {}, airfoils, notes)
    made = assemble(path, values, profile.rows, schedule, library, notes)
    if made is None:
        return None
    rotor = _rotor(facts, hub, notes)
    about = facts.get("description", "")
    if notes.problems:
        return None
    return replace(made, rotor=rotor, description=about, findings=tuple(notes.findings))


def _csv(path: Path, notes: Notes) -> tuple[dict[str, str], Rows]:
    """Return what the comments of a CSV file say, and its rows of cells."""
    lines = read_lines(path)
    facts = {}
    for line in lines:
        name, mark, value = line.lstrip("# ").partition(":")
        if line.startswith("#") and mark:
            facts[name.strip()] = _decimal(value.strip().strip(",;\t "))
    table = [(k + 1, line) for k, line in enumerate(lines) if not line.startswith("#")]
    plain = [line for _, line in table if line.strip()]
    header = next((k for k, line in enumerate(plain) if "chord" in line.lower()), 0)
    delimiter = delimiter_of("\n".join(plain[header : header + 1]))
    parsed = csv.reader((line for _, line in table), delimiter=delimiter)
    rows: Rows = []
    commas = 0
    for (k, _), cells in zip(table, parsed, strict=False):
        mended = [_decimal(cell) if delimiter != "," else cell for cell in cells]
        commas += mended != cells
        rows.append((k, list(mended)))
    if commas:
        notes.findings.append(Finding("table", "decimal commas are read as points"))
    _require_no_more(rows, notes)
    return facts, rows


def _require_no_more(rows: Rows, notes: Notes) -> None:
    """Note rows with more cells than the names above them: a cell is divided that should be one."""
    width, wide = 0, []
    for k, cells in rows:
        filled = [place for place, cell in enumerate(cells) if str(cell or "").strip()]
        if not any(number(str(cell)) is not None for cell in cells):
            width = max(width, len(cells))  # names, units
        elif width and filled[-1] >= width:
            wide.append((k, filled[-1] + 1))
    if wide:
        k, count = wide[0]
        more = f" and {len(wide) - 1} more rows" if wide[1:] else ""
        notes.problems.append(
            f"row {k}{more}: has {count} cells, the names above are {width}: is there a decimal "
            "comma? write decimal points, or divide cells by semicolons"
        )


def _decimal(cell: str) -> str:
    """Return a number written with a decimal comma with a point instead."""
    mended = cell.replace(",", ".")
    return mended if cell.count(",") == 1 and number(mended) is not None else cell


def _overview(rows: Rows) -> dict[str, str]:
    """Return the facts on the rotor of the sheet "Overview"."""
    said = {str(row[0]): row[1] for _, row in rows if len(row) > 1 and row[0] is not None}
    facts = {}
    if isinstance(said.get("Parameter"), str):
        facts["description"] = str(said["Parameter"])
    for title, key, factor in (
        ("Number of blades", "number_of_blades", 1.0),
        ("Hub diameter [m]", "hub_radius_m", 0.5),
        ("Rotor diameter [m]", "rotor_diameter_m", 1.0),
    ):
        value = said.get(title)
        if isinstance(value, float):
            facts[key] = repr(factor * value)
    return facts


def _rotor(facts: dict[str, str], hub: float | None, notes: Notes) -> Rotor:
    """Return the facts on the rotor; what is no number of its kind is a problem."""
    found: dict[str, float] = {}
    for key, allowed in FACTS.items():
        if key not in facts:
            continue
        value = number(facts[key])
        if value is None or not allowed.holds(value):
            notes.problems.append(f"{key}: got {facts[key][:40]!r}, allowed is {allowed}")
            continue
        found[key] = value
    cone, tilt = found.get("cone_deg"), found.get("tilt_deg")
    return Rotor(
        blades=int(found.get("number_of_blades", Rotor.blades)),
        hub_radius=found.get("hub_radius_m", hub),
        diameter=found.get("rotor_diameter_m"),
        cone=None if cone is None else radians(cone),
        tilt=None if tilt is None else radians(tilt),
    )


def _values(profile: Block, notes: Notes) -> dict[str, Array]:
    """Return the columns of numbers that are not empty."""
    values = {}
    for key, column in profile.columns.items():
        if key == "airfoil":
            continue
        numbers = values_of(column, notes)
        if numbers is not None and not np.isnan(numbers).all():
            values[key] = numbers
    return values


def _hub_taken_off(profile: Block, values: dict[str, Array], notes: Notes) -> float | None:
    """Take the hub radius off a column of radii, in place; return it if there is one."""
    if "z" not in values or "rad" not in profile.columns["z"].title.lower():
        return None
    held = values["z"][~np.isnan(values["z"])]
    if not 0 < held[0] < LONGEST_HUB * held[-1]:
        return None
    values["z"] = values["z"] - held[0]
    notes.findings.append(
        Finding(
            profile.columns["z"].title,
            f"starts at {held[0]:g} m, taken as the hub radius; the blade is measured from there",
        )
    )
    return float(held[0])


def _schedule(tables: list[Block], profile: Block, span: Array, notes: Notes) -> Schedule:
    """Return the airfoils along the span: a table of their own, or a column of the profile's."""
    apart = next(
        (t for t in tables if t is not profile and {"eta", "airfoil"} <= set(t.columns)), None
    )
    table = profile if apart is None else apart
    if "airfoil" not in table.columns:
        return []
    eta = span if apart is None else values_of(apart.columns["eta"], notes)
    if eta is None:
        return []
    return [
        (float(at), str(cell).strip(), row)
        for at, cell, row in zip(eta, table.columns["airfoil"].cells, table.rows, strict=True)
        if cell is not None and str(cell).strip() and not np.isnan(at)
    ]


def _library(path: Path, own: dict[str, Rows], folder: Path | None, notes: Notes) -> Library:
    """Return the airfoils of the file's own sheets, or else of a folder."""

    def named(names: list[str]) -> dict[str, Airfoil]:
        if own:
            return dict(_sheet_airfoils(own, names, notes))
        place = beside(path, folder, notes)
        return {} if place is None else shapes(place, names, notes)

    def every() -> list[tuple[float, Airfoil]]:
        if own:
            found = [airfoil_ for _, airfoil_ in _sheet_airfoils(own, list(own), notes)]
            return [(a.relative_thickness or thickness(a.coordinates), a) for a in found]
        place = beside(path, folder, notes)
        return [] if place is None else thick_airfoils(place, notes)

    return Library(named, every)


def _sheet_airfoils(
    own: dict[str, Rows], names: list[str], notes: Notes
) -> Iterator[tuple[str, Airfoil]]:
    """Read airfoils from sheets: name, relative_thickness, then rows of x and y."""
    titled = {str(rows[0][1][1]).strip(): rows for rows in own.values() if _says(rows, 0, "name")}
    for name in dict.fromkeys(names):
        rows = own.get(name) or titled.get(name)
        if rows is None:
            notes.problems.append(f"airfoil {name!r}: has no sheet {AIRFOIL}{name}")
            continue
        start = next((k for k in range(len(rows)) if _says(rows, k, "x")), len(rows))
        points: list[tuple[Cell, Cell]] = []
        for _, cells in rows[start + 1 :]:
            if not all(isinstance(cell, float) for cell in cells[:2]):
                break
            points.append((cells[0], cells[1]))
        value: dict[str, object] = {
            "coordinates": {"x": [x for x, _ in points], "y": [y for _, y in points]}
        }
        for _, cells in rows[:start]:
            if cells[0] == "relative_thickness" and isinstance(cells[1], float):
                value["relative_thickness"] = cells[1]
        made = airfoil(name, Node(value, f"{AIRFOIL}{name}", notes), "relative_thickness")
        if made is not None:
            yield name, made


def _says(rows: Rows, k: int, word: str) -> bool:
    """Tell whether a row starts with a word and goes on."""
    return len(rows) > k and len(rows[k][1]) > 1 and rows[k][1][0] == word
