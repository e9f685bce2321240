"""NuMAD 2: blades as stations, in project files ``.nmd`` and in the workbooks they are made from.

A workbook's sheet "Geometry" has, below its header (row 3), the columns Sta.#, Blade span (m),
Airfoil Shape File, TE Type, Twist (deg), Chord, xoffset (of the chord from the leading edge); a
station whose airfoil is "interp" lies between its neighbours, and what it leaves empty too.  The
sheet "bend & sweep" may hold span and displacement of both.  A project file has a <station> each,
with its own points, and tables of <presweep> and <precurve>: span, displacement, slope.  Twist
turns the leading edge upwind, sweep is toward the trailing edge, curve toward the suction side
(NuMAD's xls2nmd, readNuMADinput and getApp).  Interpolation here is PCHIP.
"""

import math
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from bladegen.definition.blade_definition import Airfoil, BladeDefinition
from bladegen.errors import FileError, Finding
from bladegen.formats.airfoils.by_name import of_file
from bladegen.formats.airfoils.folder_reading import beside, holds, shapes
from bladegen.formats.airfoils.reading import of_lines
from bladegen.formats.common import workbook
from bladegen.formats.common.assembly import Library, Schedule, assemble
from bladegen.formats.common.document import Notes, Range
from bladegen.formats.common.table import Cell, Column, Rows, values_of
from bladegen.formats.common.text_file import number, read_lines
from bladegen.support.arrays import Array

__all__ = ["is_layout", "read_project", "read_workbook"]

SHEET, CURVES = "Geometry", "bend & sweep"
HEADERS = range(1, 7)  # rows in which the header may stand; NuMAD's is the third
FIRST_OF_CURVES = 4
SPAN, SHAPE = 1, 2  # columns of the sheet
INTERPOLATED = "interp"
CIRCULAR = "circular"  # NuMAD's own cylinder
CIRCLE_POINTS = 181
QUANTITIES = (
    ("z", "Blade span (m)", 1, "locationz", 1.0, Range(-1000.0, 1000.0, "m")),
    ("twist", "Twist (deg)", 4, "degreestwist", math.pi / 180, Range(-1.6, 1.6, "rad")),
    ("chord", "Chord", 5, "chord", 1.0, Range(0.0, 100.0, "m", above=True)),
    ("pitch_axis", "xoffset", 6, "xoffset", 1.0, Range(-1.0, 2.0, "of the chord")),
)
MOST_STATIONS = 5000
PARALLEL = "sections stand parallel (shear) there; --planes z makes them so"
_STATION = re.compile(r"<station>(.*?)</station>", re.DOTALL)
_CURVE = re.compile(r"<(presweep|precurve|genlinex|genliney)>(.*?)</\1>", re.DOTALL)


def is_layout(rows: Rows) -> bool:
    """Tell whether the rows of a sheet Geometry are of this, the older layout."""
    return _header(rows) > 0


def _header(rows: Rows) -> int:
    """Return the row whose first cell is Sta.#, 0 if there is none."""
    return next(
        (at for at, cells in rows if at in HEADERS and _begins(cells, "sta")),
        0,
    )


def _begins(cells: Sequence[Cell], word: str) -> bool:
    return bool(cells) and str(cells[0]).strip().lower().startswith(word)


def read_workbook(
    path: Path, rows: Rows, notes: Notes, airfoils: Path | None
) -> BladeDefinition | None:
    """Read a workbook of the older layout; None if there are problems, which `notes` then holds."""
    table = []
    first = _header(rows) + 1
    for at, cells in rows:
        if at >= first and len(cells) > SHAPE:
            if cells[SPAN] is None:
                break
            table.append((at, cells))
    places = tuple(at for at, _ in table)
    columns = {
        key: tuple(cells[k] if k < len(cells) else None for _, cells in table)
        for key, _, k, *_ in QUANTITIES
    }
    values = _values(columns, places, notes)
    if values is None:
        return None
    values |= _bent(path, values["z"], notes)
    names = [str(cells[SHAPE] or INTERPOLATED).strip() for _, cells in table]
    schedule = _schedule(values["z"], names, places)
    wanted = [name for _, name, _ in schedule]
    folder = beside(path, airfoils, notes)
    if folder is None or notes.problems:
        return None
    round_ = CIRCULAR in wanted and not holds(folder, CIRCULAR)
    if round_:
        notes.findings.append(
            Finding(CIRCULAR, f"is not in {folder.name}; NuMAD's circle of that name is taken")
        )

    def named(_: list[str]) -> dict[str, Airfoil]:
        found = shapes(folder, [name for name in wanted if not (round_ and _is(name))], notes)
        return found | ({CIRCULAR: Airfoil(CIRCULAR, _circle())} if round_ else {})

    between = len(names) - len(schedule)
    if between:
        notes.findings.append(
            Finding(SHEET, f"{between} stations are {INTERPOLATED}: shapes between are blended")
        )
    return assemble(path, values, places, schedule, Library(named, list), notes)


def read_project(path: Path, notes: Notes) -> BladeDefinition | None:
    """Read a project file; None if there are problems, which `notes` then holds."""
    lines = read_lines(path)
    text = "\n".join(lines)
    blocks = [(match[1], text.count("\n", 0, match.start(1))) for match in _STATION.finditer(text)]
    if not 2 <= len(blocks) <= MOST_STATIONS:
        notes.problems.append(f"<station>: {len(blocks)} of them, allowed are 2 to {MOST_STATIONS}")
        return None
    places = tuple(line + 1 for _, line in blocks)
    columns: dict[str, tuple[Cell, ...]] = {
        key: tuple(_tagged(block, tag) for block, _ in blocks) for key, _, _, tag, *_ in QUANTITIES
    }
    values = _values(columns, places, notes)
    if values is None:
        return None
    spin = (_tagged(text, "rotation") or "ccw").lower()
    if spin != "cw":
        notes.findings.append(
            Finding("rotation", f"{spin}: read as cw, of which the rotor is the mirror image")
        )
    for name, block in _CURVE.findall(text):
        key = "sweep" if name in ("presweep", "genlinex") else "prebend"
        table = [[number(word) for word in line.split()] for line in _lines(block, "table")]
        curve = [(row[0], row[1]) for row in table if len(row) > 1]
        method = _tagged(block, "method")
        values |= _curve(key, name, curve, values["z"], method == "shear", notes)
    found: dict[str, Airfoil] = {}
    schedule: Schedule = []
    z = values["z"]
    for (block, line), at in zip(blocks, z, strict=True):
        made = _station_shape(block, line, path.name, found, notes)
        if made is not None:
            found[made.name] = made
            schedule.append((float((at - z[0]) / (z[-1] - z[0])), made.name, line + 1))
    if notes.problems:
        return None
    return assemble(path, values, places, schedule, Library(lambda _: found, list), notes)


def _values(
    columns: dict[str, tuple[Cell, ...]], places: tuple[int, ...], notes: Notes
) -> dict[str, Array] | None:
    """Return the quantities, NaN where a station leaves one open."""
    values = {}
    for key, title, _, _, factor, allowed in QUANTITIES:
        column = values_of(Column(key, title, factor, allowed, columns[key], places), notes)
        if column is not None and not np.isnan(column).all():
            values[key] = column
    if "z" not in values or len(places) < 2:
        notes.problems.append(f"{SHEET}: holds {len(places)} stations with a span, at least 2")
        return None
    steps = np.flatnonzero(~(np.diff(values["z"]) > 0))
    for i in steps[:1]:
        last, here = values["z"][i : i + 2]
        notes.problems.append(
            f"row {places[i + 1]}, Blade span (m): got {here:g} after {last:g}, must increase"
        )
    return None if notes.problems else values


def _schedule(z: Array, names: Sequence[str], places: tuple[int, ...]) -> Schedule:
    """Return the stations that have a shape of their own."""
    eta = (z - z[0]) / (z[-1] - z[0])
    return [
        (float(at), CIRCULAR if _is(name) else name.removesuffix(".txt"), row)
        for at, name, row in zip(eta, names, places, strict=True)
        if name.lower() != INTERPOLATED
    ]


def _is(name: str) -> bool:
    return name.lower().removesuffix(".txt") == CIRCULAR


def _bent(path: Path, z: Array, notes: Notes) -> dict[str, Array]:
    """Return bend and sweep at the stations, where a workbook has their sheet."""
    titles = [name for name in workbook.sheet_names(path) if name.strip().lower() == CURVES]
    found: dict[str, Array] = {}
    for rows in workbook.sheets(path, tuple(titles)).values() if titles else ():
        for key, first in (("prebend", 0), ("sweep", 3)):
            curve = [
                (row[first], row[first + 1])
                for at, row in rows
                if at >= FIRST_OF_CURVES and len(row) > first + 1
            ]
            numbers = [(x, y) for x, y in curve if isinstance(x, float) and isinstance(y, float)]
            methods = [row[first + 2] for _, row in rows[:1] if len(row) > first + 2]
            shear = bool(methods) and str(methods[0]).strip().lower() == "shear"
            found |= _curve(key, CURVES, numbers, z, shear, notes)
    return found


def _curve(
    key: str,
    where: str,
    curve: Sequence[tuple[float | None, float | None]],
    z: Array,
    shear: bool,
    notes: Notes,
) -> dict[str, Array]:
    """Return a displacement at the stations, by PCHIP through the points of its table."""
    points = np.array([pair for pair in curve if None not in pair], dtype=np.float64)
    if not points.size or not np.any(points[:, 1]):
        return {key: np.zeros(len(z))}
    if len(points) < 2 or not np.all(np.diff(points[:, 0]) > 0) or not np.isfinite(points).all():
        notes.problems.append(f"{where}: must hold rows of span, which increases, and displacement")
        return {}
    from bladegen.definition.blade_definition import pchip

    said = f"the curve through its {len(points)} points is PCHIP here"
    if shear:
        said += f"; {PARALLEL}"
    if points[0, 0] > z[0] or points[-1, 0] < z[-1]:
        said += f"; it runs {points[0, 0]:g} to {points[-1, 0]:g} m, beyond its end values are held"
    notes.findings.append(Finding(where, said))
    return {key: pchip(*points.T)(np.clip(z, points[0, 0], points[-1, 0]))}


def _station_shape(
    block: str, line: int, file: str, known: dict[str, Airfoil], notes: Notes
) -> Airfoil | None:
    """Read the shape of a station; one of a known name and other points gets a name of its own."""
    name = _tagged(block, "airfoilname") or f"station at line {line + 1}"
    before = block.partition("<coords>")[0]
    start = line + before.count("\n")
    try:
        read = of_lines([""] * start + ["", *_lines(block, "coords")], file)
    except FileError as error:
        notes.problems += [f"{name}: {problem}" for problem in error.problems]
        return None
    if name in known and not np.array_equal(known[name].coordinates, read.points):
        name = f"{name} at line {line + 1}"
    return known[name] if name in known else of_file(name, name, read, None, notes)


def _tagged(text: str, tag: str) -> str | None:
    """Return what stands in the first element of a name."""
    match = re.search(rf"<{tag}>(.*?)</{tag}>", text, re.DOTALL)
    return match[1].strip() if match else None


def _lines(text: str, tag: str) -> list[str]:
    return (_tagged(text, tag) or "").splitlines()


def _circle() -> Array:
    angle = np.linspace(0.0, 2.0 * np.pi, CIRCLE_POINTS)
    points = 0.5 * np.stack([1.0 + np.cos(angle), np.sin(angle)], axis=1)
    points[-1] = points[0]
    return points
