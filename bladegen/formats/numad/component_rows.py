"""A row of the sheet "Components" of a NuMAD workbook, and the widths above the rows.

Column C has in rows 2 to 5 spar cap width, leading and trailing band, spar cap offset [mm]; of the
first and the last there may be two, [HP, LP].  A row has: group (0 the skin, 1 the first web,
...), name, number of its material, fabric angle [deg], extents on the high and the low pressure
side, span fractions and numbers of plies there ("[0, 0.5, 1]"), and how these are interpolated.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from bladegen.definition.distribution import Distribution, cubic_spline, united
from bladegen.definition.structure.structure import Material
from bladegen.errors import Finding
from bladegen.formats.common.document import Notes, Range
from bladegen.formats.common.table import Cell
from bladegen.formats.common.text_file import number
from bladegen.formats.numad.keypoints import Widths
from bladegen.support.arrays import Array

__all__ = ["MOST", "SHEET", "Component", "LeftOutError", "component", "text", "widths"]

SHEET = "Components"
MOST = 1000  # components, and groups of them; the published workbook has 14
MM = 1e-3
WIDTHS = {"spar cap width": 2, "LE band width": 3, "TE band width": 4, "spar cap offset": 5}
WIDTH, OFFSET = Range(0.0, 1e5, "mm"), Range(-1e5, 1e5, "mm")
SPANS, PLIES = Range(0.0, 1.0, "(root to tip)"), Range(0.0, 1e4, "plies")
METHODS = ("pchip", "linear", "spline")
KINK = 1e-5  # of the span, beside a point, where PCHIP is given the straight lines that meet in it
SPLINE_POINTS = 201


@dataclass(frozen=True)
class Component:
    """A row of the sheet; its extents as labels, of a web's foot as they are written."""

    row: int
    group: int
    name: str
    material: Material
    angle: float
    extents: dict[str, tuple[str, ...]]
    thickness: Distribution

    @property
    def span(self) -> tuple[float, float]:
        """Span fractions between which it is there."""
        return float(self.thickness.grid[0]), float(self.thickness.grid[-1])


class LeftOutError(Exception):
    """Why a component is left out, and the column of the cell."""

    def __init__(self, column: str, said: str) -> None:
        super().__init__(said)
        self.column = column


def widths(by_row: Mapping[int, Sequence[Cell]], notes: Notes) -> Widths | None:
    """Return the widths above the table; None, and a finding, if one is no width."""
    found: dict[str, list[float]] = {}
    for name, row in WIDTHS.items():
        cell = _cell(by_row.get(row, ()), 2)
        allowed = OFFSET if name == "spar cap offset" else WIDTH
        if cell is None and allowed is OFFSET:
            cell = 0.0
        values = _numbers(cell)
        most = 2 if row in (2, 5) else 1
        if not 1 <= len(values) <= most or not np.all(allowed.holds(values)):
            must = f"{'one or two figures' if most == 2 else 'one figure'}, {allowed}"
            shown = "nothing" if cell is None else repr(cell)[:40]
            said = f"{name}: got {shown}, must be {must}; the structure is left out"
            notes.findings.append(Finding(f"{SHEET}!C{row}", said))
            return None
        found[name] = [MM * value for value in values]
    cap, leading, trailing, offset = found.values()
    return Widths(
        leading[0],
        trailing[0],
        {"HP": cap[0], "LP": cap[-1]},
        {"HP": offset[0], "LP": offset[-1]},
    )


def component(
    at: int, cells: Sequence[Cell], known: dict[int, Material], ends: tuple[float, float]
) -> Component:
    """Return the component of a row.

    Parameters
    ----------
    at : int
        The row's number, from 1 on.
    cells : sequence of cells
        Of the row, from column A on.
    known : dict of Material
        By their numbers in the sheet Materials.
    ends : pair of float
        Span fractions of the blade between which those of the sheet count.

    Raises
    ------
    LeftOutError
        If a cell cannot be read; it names the column.
    """
    group, name = number(text(cells, 0)), text(cells, 1)
    if group is None or not group.is_integer() or not 0 <= group <= MOST:
        shown = text(cells, 0)[:40]
        raise LeftOutError("A", f"group: got {shown!r}, must be 0 (skin), 1, 2, ... (webs)")
    key = number(text(cells, 2))
    if key not in known:
        allowed = ", ".join(map(str, known)) or "none: the sheet Materials has none"
        raise LeftOutError("C", f"material: got {text(cells, 2)[:40]!r}, known are {allowed}")
    material = known[int(key)]
    angle = _numbers(_cell(cells, 3) or 0.0)
    if len(angle) != 1 or not abs(angle[0]) <= 180.0:
        shown = text(cells, 3)[:40]
        raise LeftOutError("D", f"angle: got {shown!r}, must be one figure, -180 to 180 deg")
    extents = {
        side: tuple(word.strip().lower() for word in text(cells, k).split(",") if word.strip())
        for side, k in (("HP", 4), ("LP", 5))
    }
    plies = _plies(cells)
    low, high = ends
    thickness = Distribution(
        low + (high - low) * plies.grid, plies.values * (material.ply_thickness or 0.0)
    )
    return Component(at, int(group), name or f"row {at}", material, angle[0], extents, thickness)


def _plies(cells: Sequence[Cell]) -> Distribution:
    """Return numbers of plies over span fractions of the sheet, so that PCHIP meets its method."""
    spans, plies = (np.array(_numbers(_cell(cells, k))) for k in (6, 7))
    for column, values, allowed in (("G", spans, SPANS), ("H", plies, PLIES)):
        if len(values) < 2 or not np.all(allowed.holds(values)):
            shown = text(cells, 6 if column == "G" else 7)[:40]
            must = f"at least two figures, {allowed}"
            raise LeftOutError(column, f"control points: got {shown!r}, must be {must}")
    if len(spans) != len(plies):
        raise LeftOutError("H", f"control points: {len(plies)} plies at {len(spans)} spans")
    if not np.all(np.diff(spans) > 2.0 * KINK):
        raise LeftOutError("G", f"control points: got {text(cells, 6)[:40]!r}, must increase")
    method = text(cells, 8).lower() or METHODS[0]
    if method not in METHODS:
        raise LeftOutError("I", f"layers: got {method[:40]!r}, allowed are {', '.join(METHODS)}")
    if method == "linear":
        grid = np.unique(np.concatenate([spans, spans[:-1] + KINK, spans[1:] - KINK]))
        return Distribution(grid, np.interp(grid, spans, plies))
    if method == "spline":
        grid = united(spans, np.linspace(spans[0], spans[-1], SPLINE_POINTS))
        curve: Array = np.asarray(cubic_spline(spans, plies)(grid))
        return Distribution(grid, np.maximum(curve, 0.0))
    return Distribution(spans, plies)


def _numbers(cell: Cell) -> list[float]:
    """Return the figures of a cell, brackets or not; none if one of them is no figure.

    A bracket may be missing, as in the published workbook.
    """
    if cell is None or isinstance(cell, float):
        return [] if cell is None else [cell]
    words = cell.strip().removeprefix("[").removesuffix("]").split(",")
    values = [number(word.strip()) for word in words]
    known = [value for value in values if value is not None]
    return known if len(known) == len(values) else []


def _cell(cells: Sequence[Cell], k: int) -> Cell:
    cell = cells[k] if k < len(cells) else None
    return None if isinstance(cell, str) and not cell.strip() else cell


def text(cells: Sequence[Cell], k: int) -> str:
    """Return what a cell says without the blanks around it; nothing if it is empty or not there."""
    cell = _cell(cells, k)
    if isinstance(cell, float):
        return f"{cell:.15g}"
    return "" if cell is None else cell.strip()
