"""Blade definitions from files, in any format of the table in `registry`, and bundled blades."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import islice
from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.plausibility import doubts
from bladegen.errors import DefinitionError, FileError, Finding
from bladegen.formats.bundled import bundled, home
from bladegen.formats.common.document import Notes
from bladegen.formats.format import Reader
from bladegen.formats.registry import FORMATS, every, plugins
from bladegen.support.arguments import path_of, shown, suggestion
from bladegen.support.files import beside
from bladegen.support.recent import Recent

__all__ = ["SUFFIXES", "holds_blade", "is_read", "read"]

RADIANS = ("windIO 1",)  # formats whose angles are in radians
BY_AIRFOILS = Finding(
    "relative thickness", "is not given over span; it is that of the airfoils, PCHIP between them"
)


REPORT = ".report.json"  # of what bladegen built
FEW, MANY = 3, 1000  # files of a folder that are named, and looked at
OWN = tuple(row.reader for row in FORMATS if row.reader is not None)
SUFFIXES = tuple(dict.fromkeys(suffix for reader in OWN for suffix in reader.suffixes))
BUNDLED: Recent[BladeDefinition] = Recent(8)  # a definition never changes: read once is enough


def read(source: str | Path, *, airfoils: str | Path | None = None) -> BladeDefinition:
    """Read a blade definition.

    Parameters
    ----------
    source : str or Path
        The name of a bundled blade (`bundled`), or a path to a file in one of the formats of
        `registry`, of bladegen's own or of plug-ins.
    airfoils : str or Path, optional
        A folder of airfoil files, for formats that only name their airfoils.

    Raises
    ------
    FileError
        If there is no such blade or file, or with all problems of the file at once.
    """
    if not isinstance(source, str | Path) or not str(source).strip():
        raise FileError(shown(source), ["must be the name of a bundled blade, or a file's path"])
    if airfoils is not None:
        airfoils = path_of(airfoils, "airfoils", DefinitionError)
        if not airfoils.is_dir():
            near = beside(airfoils, folders=True)
            raise FileError(str(airfoils), [f"is no folder, must be one with airfoil files{near}"])
    path = _path(source)
    if airfoils is not None or path.parent != home():
        return _read(source, path, airfoils)
    file = path.stat()
    key = f"{path} {file.st_mtime_ns} {file.st_size}".encode()
    return BUNDLED.get(key, lambda: _read(source, path, None))


def _read(source: str | Path, path: Path, airfoils: Path | None) -> BladeDefinition:
    """Read a definition's file, with what is known of it before it becomes a blade."""
    notes = Notes()
    try:
        name, reader = _recognised(path)
        definition = reader.read(path, notes, airfoils)
    except DefinitionError as error:
        raise FileError(str(source), [str(error)]) from None
    except FileError as error:
        raise FileError(str(source), error.problems) from None
    if definition is None or notes.problems:
        raise FileError(str(source), notes.shown())
    known = definition.format or name
    findings = (*definition.findings, *doubts(definition, radians=known in RADIANS))
    if definition.relative_thickness is None:
        findings += (BY_AIRFOILS,)
    return replace(definition, format=known, findings=findings)


def holds_blade(path: Path) -> bool:
    """Tell whether a file looks like a blade's, by its suffix and a bounded look into it."""
    own = path.suffix.lower()
    return any(own in reader.suffixes and reader.recognises(path) for reader in OWN)


def _path(source: str | Path) -> Path:
    """Return the file that `source` names; only names that are listed become bundled paths."""
    names = bundled()
    if str(source) in names:
        return home() / f"{source}.yaml"
    path = Path(source)
    try:
        folder, exists, is_file = path.is_dir(), path.exists(), path.is_file()
    except (OSError, ValueError):  # a name too long for the system, or that holds a zero byte
        folder = exists = is_file = False
    if folder:
        raise FileError(str(source), [f"is a folder, must be a file{_inside(path)}"])
    if not is_file:
        kind = "is no regular file" if exists else "is neither a bundled blade nor a file"
        near = suggestion(source, names) or suggestion(path.stem, names) or beside(path, SUFFIXES)
        raise FileError(str(source), [f"{kind}; bundled blades are {', '.join(names)}{near}"])
    if not is_read(path):
        allowed = ", ".join(
            dict.fromkeys(suffix for _, row in _readers() for suffix in row.suffixes)
        )
        raise FileError(
            str(source),
            [f"has the suffix {path.suffix!r}, allowed are {allowed}{plugins().remark}"],
        )
    return path


def _inside(path: Path) -> str:
    """Say which files of a folder hold blades, as far as their names tell."""
    files = _blades(path)
    more = ", ..." if len(files) > FEW else ""
    return f", such as {', '.join(files[:FEW])}{more}" if files else ""


def _blades(path: Path) -> list[str]:
    """Return the names of a folder's files that have the suffix of a blade's."""
    try:
        found = sorted(file.name for file in islice(path.iterdir(), MANY))
    except OSError:
        return []
    return [name for name in found if Path(name).suffix.lower() in SUFFIXES]


def is_read(path: Path) -> bool:
    """Tell whether files of a path's suffix are read."""
    return any(path.suffix.lower() in reader.suffixes for _, reader in _readers())


def _readers() -> Iterator[tuple[str, Reader]]:
    """Give each format that is read, with its name; those of plug-ins last, and loaded late."""
    yield from ((row.name, row.reader) for row in every() if row.reader is not None)


def _recognised(path: Path) -> tuple[str, Reader]:
    """Return the first format of the file's suffix that recognises it."""
    marks = []
    for name, reader in _readers():
        if path.suffix.lower() in reader.suffixes:
            if reader.recognises(path):
                return name, reader
            marks.append(f"{reader.mark} ({name})")
    must = " or ".join(marks)
    others = (path.with_name(name) for name in _blades(path.parent) if name != path.name)
    named = (other for other in islice(others, MANY) if not other.name.endswith(REPORT))
    there = [other.name for other in named if holds_blade(other)][:FEW]
    near = f"; beside it there is one in {', '.join(there)}" if there else ""
    raise FileError(
        str(path), [f"holds no blade that is known, must hold {must}{plugins().remark}{near}"]
    )
