"""What bladegen does with files of HAWC2; what does it is imported when it is asked for."""

from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import Finding
from bladegen.formats.common.document import Notes
from bladegen.formats.format import GRID, Format, PutBack, Reader, Writer

__all__ = ["FORMAT"]


def _recognises(path: Path) -> bool:
    from bladegen.formats.hawc2.reading import recognises

    return recognises(path)


def _read(path: Path, notes: Notes, airfoils: Path | None) -> BladeDefinition | None:
    from bladegen.formats.hawc2.reading import read

    return read(path, notes, airfoils)


def _write(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    from bladegen.formats.hawc2.writing import write

    return write(definition, path)


def _into(definition: BladeDefinition, htc: Path, path: Path) -> tuple[Finding, ...]:
    from bladegen.formats.hawc2.into import write_into_htc

    return write_into_htc(definition, htc, path)


FORMAT = Format(
    "HAWC2",
    Reader((".htc",), "a main_body with c2_def", _recognises, _read),
    (Writer("hawc2", "HAWC2", (".htc",), _write, True, GRID),),
    put_back=PutBack((".htc",), _into, GRID),
)
