"""What bladegen does with files of QBlade; what does it is imported when it is asked for."""

from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.formats.common.document import Notes
from bladegen.formats.format import Format, Reader

__all__ = ["FORMAT"]


def _recognises(path: Path) -> bool:
    from bladegen.formats.qblade.reading import recognises

    return recognises(path)


def _read(path: Path, notes: Notes, airfoils: Path | None) -> BladeDefinition | None:
    from bladegen.formats.qblade.reading import read

    return read(path, notes, airfoils)


FORMAT = Format(
    "QBlade",
    Reader((".bld",), "the columns POS, CHORD and TWIST of a QBlade blade", _recognises, _read),
)
