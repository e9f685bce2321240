"""Spanwise tables: rows of cells, whatever file they stand in, to named columns in SI units.

A header is a row with at least two known names.  Names are told by many spellings, units by
brackets or by an ending: ``Chord [m]``, ``chord_m``, ``Twist (deg)``, ``r/R``, or by a row of
units below the names.  What a header leaves open is taken as usual, and said.  Blank rows within a
table are of no meaning.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.errors import Finding
from bladegen.formats.common.column_names import UNITS, named, with_unit
from bladegen.formats.common.document import Notes, Range
from bladegen.formats.common.text_file import number
from bladegen.support.arrays import Array

__all__ = ["Block", "Cell", "Column", "Rows", "blocks", "values_of"]

Cell = str | float | None
Rows = list[tuple[int, Sequence[Cell]]]
SHARES = "of the chord", "(root to tip)"  # units of columns that may be given in per cent
SHOWN = 5  # wrong cells of one column that are named one by one


@dataclass(frozen=True)
class Column:
    """A column of a table: what it holds, as its header has it, its cells and their rows."""

    key: str
    title: str
    factor: float
    allowed: Range
    cells: tuple[Cell, ...]
    rows: tuple[int, ...]


@dataclass(frozen=True)
class Block:
    """A table: its columns by what they hold."""

    columns: dict[str, Column]

    @property
    def rows(self) -> tuple[int, ...]:
        """The numbers of its rows in the file."""
        return next(iter(self.columns.values())).rows


def blocks(rows: Rows, notes: Notes) -> list[Block]:
    """Find the tables in rows of cells; each starts with a header.

    It ends with the next header, or with a blank row behind which its span does not go on.
    """
    found: list[Block] = []
    header: _Header = {}
    taken: list[tuple[int, Sequence[Cell]]] = []
    left: list[int] = []
    units_at, blank = 0, False

    def close() -> None:
        if header and taken:
            found.append(_block(header, taken))

    for place, (at, cells) in enumerate(rows):
        if at == units_at:
            continue
        below = next((row for row in rows[place + 1 : place + 4] if not _empty(row[1])), None)
        known = _header(cells, below, notes, at)
        if known.columns:
            close()
            header, taken, blank = known.columns, [], False
            units_at = known.units_at
        elif _empty(cells):
            blank = True
        elif header and blank and not _goes_on(header, taken, cells):
            close()
            header, taken = {}, []
            left.append(at)
        elif header:
            taken.append((at, cells))
            blank = False
        elif found and sum(_number(cell) is not None for cell in cells) > 1:
            left.append(at)
    close()
    if left and found:
        notes.findings.append(
            Finding(f"row {left[0]}", f"{len(left)} rows behind a table passed over")
        )
    return found


def _goes_on(header: "_Header", taken: list[Any], cells: Sequence[Cell]) -> bool:
    """Tell whether a row behind a blank one is the table's next: its span is farther out."""
    for k, (key, *_) in header.items():
        if key in ("eta", "z") and k < len(cells):
            last = [_number(row[k]) for _, row in taken[-1:] if k < len(row)]
            here = _number(cells[k])
            return here is not None and (not last or last[0] is None or here > last[0])
    return False


def _empty(cells: Sequence[Cell]) -> bool:
    return all(_blank(cell) for cell in cells)


def values_of(column: Column, notes: Notes) -> Array | None:
    """Return a column in SI units, NaN where its cell is empty, or note what is no number."""
    values = np.full(len(column.cells), np.nan)
    wrong = []
    for i, cell in enumerate(column.cells):
        if _blank(cell):
            continue
        value = _number(cell)
        values[i] = math.nan if value is None else column.factor * value
        if not column.allowed.holds(values[i]):
            wrong.append(i)
    near = _percent(column, values, wrong)
    for i in wrong[:SHOWN]:
        demand = "must be a number," if math.isnan(values[i]) else "allowed is"
        notes.problems.append(
            f"row {column.rows[i]}, {column.title}: got {_shown(column.cells[i])}, {demand} "
            f"{column.allowed}{near if i == wrong[0] else ''}"
        )
    if len(wrong) > SHOWN:
        notes.problems.append(f"{column.title}: {len(wrong) - SHOWN} more cells are wrong")
    return None if wrong else values


def _percent(column: Column, values: Array, wrong: list[int]) -> str:
    """Return what to write if a column of fractions holds per cents, to end a message with."""
    shares = values[np.isfinite(values)] / 100.0
    if not wrong or column.allowed.unit not in SHARES or not len(shares):
        return ""
    if np.isnan(values[wrong]).any() or not all(map(column.allowed.holds, shares)):
        return ""
    return f"; are these per cent? name the column '{column.title.split('[')[0].strip()} [%]'"


_Header = dict[int, tuple[str, str, float, Range]]


@dataclass(frozen=True)
class _Named:
    """What the columns of a header hold, and the row of its units if they stand below."""

    columns: _Header
    units_at: int = 0


def _block(header: _Header, taken: list[Any]) -> Block:
    rows = tuple(at for at, _ in taken)
    columns = {}
    for k, (key, title, factor, allowed) in header.items():
        cells = tuple(cells[k] if k < len(cells) else None for _, cells in taken)
        columns[key] = Column(key, title, factor, allowed, cells, rows)
    return Block(columns)


def _header(
    cells: Sequence[Cell], below: tuple[int, Sequence[Cell]] | None, notes: Notes, at: int
) -> _Named:
    """Return what each column of a header row holds; none if the row is no header."""
    texts = [cell if isinstance(cell, str) else "" for cell in cells]
    if sum(named(title, [], at) is not None for title in texts) < 2 and not _units(below):
        return _Named({})
    units = _units(below)
    titles = [with_unit(title, units.get(k)) for k, title in enumerate(texts)]
    known: _Header = {}
    said: list[Finding] = []
    for k, title in enumerate(titles):
        found = named(title, said, at)
        if found is None:
            continue
        if any(found[0] == other[0] for other in known.values()):
            said.append(Finding(f"row {at}", f"{title!r} stands twice; the first one is taken"))
            continue
        known[k] = found
    if len(known) < 2:
        return _Named({})
    unknown = [title for k, title in enumerate(titles) if title.strip() and k not in known]
    if unknown:
        said.append(Finding(f"row {at}", f"columns passed over: {', '.join(unknown[:8])[:200]}"))
    notes.findings += said
    return _Named(known, below[0] if units and below else 0)


def _units(row: tuple[int, Sequence[Cell]] | None) -> dict[int, str]:
    """Return the units of a row that holds some and no number; none of any other row."""
    cells = [] if row is None else row[1]
    if any(_number(cell) is not None for cell in cells):
        return {}
    found = {}
    for k, cell in enumerate(cells):
        unit = cell.strip().strip("[]()").strip(" .").lower() if isinstance(cell, str) else ""
        if unit:
            found[k] = unit
    known = sum(unit in UNITS for unit in found.values())
    return found if 2 * known >= len(found) else {}


def _blank(cell: Cell) -> bool:
    return cell is None or (isinstance(cell, str) and not cell.strip())


def _number(cell: Cell) -> float | None:
    if cell is None or isinstance(cell, bool):
        return None
    if isinstance(cell, int | float):
        return float(cell)
    return number(str(cell).strip())


def _shown(cell: Cell) -> str:
    text = repr(cell)
    return text if len(text) <= 40 else text[:37] + "..."
