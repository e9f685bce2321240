"""Plain spanwise tables: CSV with a folder of airfoils, and workbooks in the IEA layout.

A CSV file keeps every quantity's own grid: a row for each span of any of them, cells empty where
a quantity has no point.  A workbook has one full table.  Conventions and layouts:
`bladegen.formats.tables.reading`.
"""

import csv
import errno
import io
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.definition.blade_definition import BladeDefinition, Distribution
from bladegen.errors import Finding
from bladegen.formats.airfoils.folder_writing import write_airfoils
from bladegen.formats.airfoils.unique_names import unique_names
from bladegen.formats.common.number_text import exact, write_lines
from bladegen.formats.common.resampling import common_grid
from bladegen.formats.tables.reading import AIRFOIL, FACTS, GEOMETRY
from bladegen.support.arrays import Array
from bladegen.support.files import replacing

__all__ = ["write"]

TITLE_LENGTH = 31  # of a sheet's name, Excel's limit
FORBIDDEN = str.maketrans(dict.fromkeys(r"[]:*?/\\", "_"))


def write(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    """Write a blade as CSV or workbook; returns what the file cannot hold."""
    return (_workbook if path.suffix.lower() == ".xlsx" else _csv)(definition, path)


def _quantities(definition: BladeDefinition) -> list[tuple[str, Distribution, float]]:
    """Return the columns of a CSV file: title, quantity, and its unit's factor from SI."""
    axis = definition.axis
    columns = [
        ("z_m", axis.z, 1.0),
        ("chord_m", definition.chord, 1.0),
        ("twist_deg", definition.twist, degrees(1.0)),
        ("rthick", definition.relative_thickness, 1.0),
        ("prebend_m", axis.x, 1.0),
        ("sweep_m", axis.y, 1.0),
        ("pitch_axis", definition.pitch_axis, 1.0),
        ("section_offset_y_m", definition.section_offset_y, 1.0),
        ("section_offset_x_m", definition.section_offset_x, 1.0),
    ]
    return [(title, held, factor) for title, held, factor in columns if held is not None]


def _csv(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    folder = write_airfoils(path, definition.stations, placed=False)
    names = unique_names(definition.stations)
    columns = _quantities(definition)
    stations = {station.eta: names[id(station.airfoil)][0] for station in definition.stations}
    eta = np.unique(np.concatenate([list(stations), *(held.grid for _, held, _ in columns)]))
    cells = {
        title: dict(zip(held.grid.tolist(), (factor * held.values).tolist(), strict=True))
        for title, held, factor in columns
    }
    table = io.StringIO()
    rows = csv.writer(table, lineterminator="\n")
    rows.writerow(["eta", *cells, "airfoil"])
    for at in eta.tolist():
        row = (exact(held[at]) if at in held else "" for held in cells.values())
        rows.writerow([exact(at), *row, stations.get(at, "")])
    write_lines(path, [*_comments(definition, folder.name), *table.getvalue().splitlines()])
    return ()


def _comments(definition: BladeDefinition, folder: str) -> list[str]:
    """Return the lines that say what a CSV file holds."""
    rotor = definition.rotor
    facts = (
        rotor.blades,
        rotor.hub_radius,
        rotor.diameter,
        None if rotor.cone is None else degrees(rotor.cone),
        None if rotor.tilt is None else degrees(rotor.tilt),
    )
    said = [
        f"# {key}: {value!r}" for key, value in zip(FACTS, facts, strict=True) if value is not None
    ]
    return [
        "# a wind turbine blade, root to tip; written by bladegen",
        f"# description: {' '.join(definition.description.split())}",
        *said,
        f"# airfoils: in {folder}, by the names of the last column",
        "# twist moves the leading edge upwind; prebend is positive downwind (to the suction side)",
        "# sweep is positive to the trailing edge; pitch_axis is in chords from the leading edge",
        "# section_offset_y is that distance in metres; an empty cell: no point of its own there",
    ]


def _workbook(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    from lxml.etree import LxmlError
    from openpyxl import Workbook

    eta, loss = common_grid(definition)
    names = unique_names(definition.stations)
    book = Workbook()
    book.remove(book.active)
    overview = book.create_sheet("Overview")
    overview.append(["Parameter", definition.description or definition.name])
    rotor = definition.rotor
    overview.append(["Number of blades", rotor.blades])
    if rotor.hub_radius is not None:
        overview.append(["Hub diameter [m]", 2.0 * rotor.hub_radius])
    if rotor.diameter is not None:
        overview.append(["Rotor diameter [m]", rotor.diameter])
    sheet = book.create_sheet(GEOMETRY)
    sheet.append(["Spanwise position [r/R]", "Airfoil name"])
    for station in definition.stations:
        sheet.append([station.eta, names[id(station.airfoil)][0]])
    sheet.append([])
    sheet.append(["Profile"])
    titles, table = _profile(definition, eta)
    sheet.append(titles)
    for row in table.tolist():
        sheet.append(row)
    _airfoil_sheets(book, names)
    with replacing(path) as temporary:
        try:
            book.save(temporary)
        except LxmlError as error:  # openpyxl writes sheets to temporary files through lxml
            raise OSError(errno.EIO, f"a temporary file cannot be written ({error})") from None
    found = [
        Finding(
            GEOMETRY,
            f"{len(eta)} rows for all quantities; between them at most {loss * 1e3:.2f} mm off",
        )
    ]
    if rotor.cone is not None or rotor.tilt is not None:
        found.append(Finding("rotor", "cone and tilt have no place in this layout"))
    return tuple(found)


def _profile(definition: BladeDefinition, eta: Array) -> tuple[list[str], Array]:
    """Return titles and rows of the profile table; prebend is positive upwind."""
    axis, chord = definition.axis(eta), definition.chord(eta)
    columns = {
        "Spanwise position [r/R]": eta,
        "Chord [m]": chord,
        "Twist [rad]": definition.twist(eta),
        "Pitch axis [x/c]": definition.offset_y(eta) / chord,
        "Span [m]": axis[:, 2],
        "Prebend [m]": 0.0 - axis[:, 0],
        "Sweep [m]": axis[:, 1],
    }
    if definition.relative_thickness is not None:
        columns["Relative thickness [t/c]"] = definition.relative_thickness(eta)
    if definition.section_offset_x is not None:
        columns["Section offset x [m]"] = definition.section_offset_x(eta)
    return list(columns), np.stack(list(columns.values()), axis=1)


def _airfoil_sheets(book: Any, names: dict[int, tuple[str, Any]]) -> None:
    """Add a sheet for each airfoil: name, relative_thickness, then rows of x and y."""
    for k, (name, airfoil) in enumerate(names.values()):
        title = (AIRFOIL + name).translate(FORBIDDEN)
        if len(title) > TITLE_LENGTH or title in book.sheetnames:
            title = f"{title[: TITLE_LENGTH - 5]} {k + 1:04d}"
        sheet = book.create_sheet(title)
        sheet.append(["name", name])
        sheet.append(["relative_thickness", airfoil.relative_thickness])
        sheet.append([])
        sheet.append([])
        sheet.append(["x", "y"])
        for x, y in airfoil.coordinates.tolist():
            sheet.append([x, y])
