"""What bladegen does with files of OpenFAST; what does it is imported when it is asked for."""

from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import Finding
from bladegen.formats.common.document import Notes
from bladegen.formats.format import GRID, Format, PutBack, Reader, Writer

__all__ = ["FORMAT"]


def _recognises(path: Path) -> bool:
    from bladegen.formats.openfast.reading import recognises

    return recognises(path)


def _read(path: Path, notes: Notes, airfoils: Path | None) -> BladeDefinition | None:
    from bladegen.formats.openfast.reading import read

    return read(path, notes, airfoils)


def _write(
    definition: BladeDefinition, path: Path, nodes: int | None = None
) -> tuple[Finding, ...]:
    from bladegen.formats.openfast.writing import write

    return write(definition, path, nodes)


def _into(
    definition: BladeDefinition, main: Path, path: Path, nodes: int | None = None
) -> tuple[Finding, ...]:
    from bladegen.formats.openfast.into import write_into_main

    return write_into_main(definition, main, path, nodes)


FORMAT = Format(
    "OpenFAST",
    Reader(
        (".dat", ".fst"),
        "an AeroDyn blade table with BlSpn and BlChord, an AeroDyn input with ADBlFile(1), or a "
        ".fst file with AeroFile",
        _recognises,
        _read,
    ),
    (Writer("openfast", "OpenFAST (AeroDyn blade)", (".dat",), _write, True, GRID, nodes=True),),
    put_back=PutBack((".dat",), _into, GRID, nodes=True),
)
