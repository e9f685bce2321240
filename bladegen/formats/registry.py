"""All formats of blade files: one row each, with everything that bladegen can do with it.

A new format is a package beside the others with a module `row`, named in `FORMATS`; a package
of somebody else offers its rows by the entry point ``bladegen.readers``.  Formats of bladegen's own
come first wherever one is looked for, so that no plug-in can take the place of one.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import DefinitionError, ExportError
from bladegen.formats.actuator_lines import row as actuator_lines
from bladegen.formats.airfoils import row as airfoils
from bladegen.formats.common.document import Notes
from bladegen.formats.format import Format, Reader
from bladegen.formats.hawc2 import row as hawc2
from bladegen.formats.numad import row as numad
from bladegen.formats.openfast import row as openfast
from bladegen.formats.qblade import row as qblade
from bladegen.formats.tables import row as tables
from bladegen.formats.windio import row as windio
from bladegen.support.plugins import Offered, guarded, offered

__all__ = ["FORMATS", "GROUP", "every", "plugged", "plugins"]

GROUP = "bladegen.readers"  # of entry points

FORMATS = (
    windio.FORMAT,
    openfast.FORMAT,
    hawc2.FORMAT,
    qblade.FORMAT,
    numad.FORMAT,
    tables.FORMAT,
    airfoils.FORMAT,
    actuator_lines.FORMAT,
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
