"""All formats of blade files: one row each, with everything that bladegen can do with it.

A new format is a package beside the others and one row in `FORMATS`; a package of somebody else
offers its rows by the entry point ``bladegen.readers``.  Formats of bladegen's own come first
wherever one is looked for, so that no plug-in can take the place of one.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import DefinitionError, ExportError, Finding
from bladegen.formats.common.document import Notes
from bladegen.formats.format import Format, PutBack, Reader, Writer
from bladegen.formats.hawc2 import reading as hawc2
from bladegen.formats.numad import reading as numad
from bladegen.formats.openfast import reading as openfast
from bladegen.formats.qblade import reading as qblade
from bladegen.formats.tables import reading as tables
from bladegen.formats.windio import turbine_file as windio
from bladegen.formats.windio import version1, version2
from bladegen.formats.windio.into import write_into_turbine
from bladegen.support.plugins import Offered, guarded, offered

__all__ = ["FORMATS", "GROUP", "every", "plugged", "plugins"]

GROUP = "bladegen.readers"  # of entry points
GRID = 1.5e-3  # m; formats with one grid are within 0.3 or 0.5 mm of each quantity

# who reads a blade loads nothing that makes one to write it


def _write_openfast(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    from bladegen.formats.openfast.writing import write

    return write(definition, path)


def _into_openfast(definition: BladeDefinition, main: Path, path: Path) -> tuple[Finding, ...]:
    from bladegen.formats.openfast.into import write_into_main

    return write_into_main(definition, main, path)


def _write_hawc2(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    from bladegen.formats.hawc2.writing import write

    return write(definition, path)


def _into_hawc2(definition: BladeDefinition, htc: Path, path: Path) -> tuple[Finding, ...]:
    from bladegen.formats.hawc2.into import write_into_htc

    return write_into_htc(definition, htc, path)


def _write_table(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    from bladegen.formats.tables.writing import write

    return write(definition, path)


def _write_airfoils(definition: BladeDefinition, path: Path, layout: str) -> tuple[Finding, ...]:
    from bladegen.formats.airfoils.writing import write_folder

    return write_folder(definition, path, layout)


FORMATS = (
    Format(
        "windIO",
        Reader(windio.SUFFIXES, windio.MARK, windio.recognises, windio.read),
        (
            Writer("windio2", "windIO 2", (".yaml", ".yml"), version2.write, polars=True),
            Writer("windio1", "windIO 1", (".yaml", ".yml"), version1.write, polars=True),
        ),
        put_back=PutBack((".yaml", ".yml"), write_into_turbine),
        alone=True,
    ),
    Format(
        "OpenFAST",
        Reader(openfast.SUFFIXES, openfast.MARK, openfast.recognises, openfast.read),
        (Writer("openfast", "OpenFAST (AeroDyn blade)", (".dat",), _write_openfast, True, GRID),),
        put_back=PutBack((".dat",), _into_openfast, GRID),
    ),
    Format(
        "HAWC2",
        Reader(hawc2.SUFFIXES, hawc2.MARK, hawc2.recognises, hawc2.read),
        (Writer("hawc2", "HAWC2", (".htc",), _write_hawc2, True, GRID),),
        put_back=PutBack((".htc",), _into_hawc2, GRID),
    ),
    Format("QBlade", Reader(qblade.SUFFIXES, qblade.MARK, qblade.recognises, qblade.read)),
    Format("NuMAD", Reader(numad.SUFFIXES, numad.MARK, numad.recognises, numad.read)),
    Format(
        "spanwise table",
        Reader(tables.SUFFIXES, tables.MARK, tables.recognises, tables.read),
        (
            Writer("csv", "spanwise table (CSV)", (".csv",), _write_table),
            Writer("xlsx", "spanwise table (IEA workbook)", (".xlsx",), _write_table, False, GRID),
        ),
    ),
    Format(
        "airfoil files",
        writers=tuple(
            Writer(
                name,
                f"a folder of airfoil files ({name.title()})",
                ("",),
                partial(_write_airfoils, layout=name),
                tolerance=None,
            )
            for name in ("selig", "lednicer")
        ),
    ),
)


def every() -> Iterator[Format]:
    """Give the formats one after the other; plug-ins are loaded once all own ones were passed."""
    yield from FORMATS
    yield from (row for _, row in plugged())


@cache
def plugged() -> tuple[tuple[str, Format], ...]:
    """Return the formats that packages of others offer, each with the name of its entry point."""
    return tuple((name, _guarded(row, name)) for name, row in plugins().rows)


def plugins() -> Offered:
    """Return what packages of others offer as it is, and what is wrong with it."""
    return offered(GROUP, Format)


def _guarded(row: Format, name: str) -> Format:
    """Return a plug-in's row, whose functions raise nothing but errors of one line."""
    reader, put_back = row.reader, row.put_back
    if reader is not None:
        reader = replace(
            reader,
            recognises=guarded(reader.recognises, name, DefinitionError),
            read=guarded(_checked(reader), name, DefinitionError),
        )
    if put_back is not None:
        put_back = replace(put_back, write=guarded(put_back.write, name, ExportError))
    writers = tuple(
        replace(way, write=guarded(way.write, name, ExportError)) for way in row.writers
    )
    return replace(row, reader=reader, writers=writers, put_back=put_back)


def _checked(reader: Reader) -> Callable[[Path, Notes, Path | None], BladeDefinition | None]:
    """Return a plug-in's way to read, which must return a definition or note a problem."""

    def read(path: Path, notes: Notes, airfoils: Path | None) -> BladeDefinition | None:
        found = reader.read(path, notes, airfoils)
        if not (isinstance(found, BladeDefinition) or notes.problems):
            raise TypeError(f"read: got {found!r}, must be a BladeDefinition, or note a problem")
        return found

    return read
