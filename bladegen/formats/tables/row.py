"""What bladegen does with spanwise tables; what does it is imported when it is asked for."""

from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import Finding
from bladegen.formats.common.document import Notes
from bladegen.formats.format import GRID, Format, Reader, Writer

__all__ = ["FORMAT"]


def _recognises(path: Path) -> bool:
    from bladegen.formats.tables.reading import recognises

    return recognises(path)


def _read(path: Path, notes: Notes, airfoils: Path | None) -> BladeDefinition | None:
    from bladegen.formats.tables.reading import read

    return read(path, notes, airfoils)


def _write(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    from bladegen.formats.tables.writing import write

    return write(definition, path)


FORMAT = Format(
    "spanwise table",
    Reader((".csv", ".xlsx"), "a table with span and chord", _recognises, _read),
    (
        Writer("csv", "spanwise table (CSV)", (".csv",), _write),
        Writer("xlsx", "spanwise table (IEA workbook)", (".xlsx",), _write, False, GRID),
    ),
)
