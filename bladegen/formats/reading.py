"""Blade definitions from files: one module a format, one row in `FORMATS`.

A new format is a module with two functions: `recognises` tells its files from others of the
same suffix, by a bounded look; `read` makes the definition and notes every problem of the file
in `Notes`, so that a user hears of all of them at once.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.plausibility import doubts
from bladegen.errors import DefinitionError, FileError, Finding
from bladegen.formats.common.document import Notes
from bladegen.formats.hawc2 import reading as hawc2
from bladegen.formats.numad import reading as numad
from bladegen.formats.openfast import reading as openfast
from bladegen.formats.qblade import reading as qblade
from bladegen.formats.tables import reading as spanwise_table
from bladegen.formats.windio import turbine_file
from bladegen.support.arguments import path_of, shown, suggestion

__all__ = ["FORMATS", "SUFFIXES", "Format", "bundled", "holds_blade", "read"]

RADIANS = ("windIO 1",)  # formats whose angles are in radians
BY_AIRFOILS = Finding(
    "relative thickness", "is not given over span; it is that of the airfoils, PCHIP between them"
)


@dataclass(frozen=True)
class Format:
    """A file format.

    Parameters
    ----------
    name : str
        What it is called.
    mark : str
        What tells its files from others, in words.
    suffixes : tuple of str
        Of its files, lower case.
    recognises : callable
        Tells whether a file of one of the suffixes is of this format.
    read : callable
        From a file, the notes to make on it, and a folder of airfoil files for formats that
        only name their airfoils (None: the format's own place) to the definition; None if
        there are problems.  An unset `BladeDefinition.format` becomes `name`.
    """

    name: str
    mark: str
    suffixes: tuple[str, ...]
    recognises: Callable[[Path], bool]
    read: Callable[[Path, Notes, Path | None], BladeDefinition | None]


FORMATS = (
    Format(
        "windIO",
        turbine_file.MARK,
        turbine_file.SUFFIXES,
        turbine_file.recognises,
        turbine_file.read,
    ),
    Format("OpenFAST", openfast.MARK, openfast.SUFFIXES, openfast.recognises, openfast.read),
    Format("HAWC2", hawc2.MARK, hawc2.SUFFIXES, hawc2.recognises, hawc2.read),
    Format("QBlade", qblade.MARK, qblade.SUFFIXES, qblade.recognises, qblade.read),
    Format("NuMAD", numad.MARK, numad.SUFFIXES, numad.recognises, numad.read),
    Format(
        "spanwise table",
        spanwise_table.MARK,
        spanwise_table.SUFFIXES,
        spanwise_table.recognises,
        spanwise_table.read,
    ),
)
FEW, MANY = 3, 1000  # files of a folder that are named, and looked at
SUFFIXES = tuple(dict.fromkeys(suffix for row in FORMATS for suffix in row.suffixes))


def read(source: str | Path, *, airfoils: str | Path | None = None) -> BladeDefinition:
    """Read a blade definition.

    Parameters
    ----------
    source : str or Path
        The name of a bundled blade (`bundled`), or a path to a file in one of `FORMATS`.
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
            raise FileError(str(airfoils), ["is no folder, must be one of airfoil files"])
    path = _path(source)
    notes = Notes()
    try:
        row = _recognised(path)
        definition = row.read(path, notes, airfoils)
    except DefinitionError as error:
        raise FileError(str(source), [str(error)]) from None
    except FileError as error:
        raise FileError(str(source), error.problems) from None
    if definition is None or notes.problems:
        raise FileError(str(source), notes.shown())
    known = definition.format or row.name
    findings = (*definition.findings, *doubts(definition, radians=known in RADIANS))
    if definition.relative_thickness is None:
        findings += (BY_AIRFOILS,)
    return replace(definition, format=known, findings=findings)


def holds_blade(path: Path) -> bool:
    """Tell whether a file looks like a blade's, by its suffix and a bounded look into it."""
    return any(path.suffix.lower() in row.suffixes and row.recognises(path) for row in FORMATS)


def bundled() -> tuple[str, ...]:
    """Return the names of the blades that come with bladegen."""
    return tuple(sorted(path.stem for path in _home().glob("*.yaml")))


def _home() -> Path:
    """Return the folder of the bundled blades, in a wheel or in a checkout."""
    package = Path(__file__).resolve().parent.parent
    installed = package / "blades"
    return installed if installed.is_dir() else package.parent / "blades"


def _path(source: str | Path) -> Path:
    """Return the file that `source` names; only names that are listed become bundled paths."""
    names = bundled()
    if str(source) in names:
        return _home() / f"{source}.yaml"
    path = Path(source)
    try:
        folder, exists, is_file = path.is_dir(), path.exists(), path.is_file()
    except (OSError, ValueError):  # a name too long for the system, or that holds a zero byte
        folder = exists = is_file = False
    if folder:
        raise FileError(str(source), [f"is a folder, must be a file{_inside(path)}"])
    if not is_file:
        kind = "is no regular file" if exists else "is neither a bundled blade nor a file"
        near = suggestion(source, names) or suggestion(path.stem, names) or _beside(path)
        raise FileError(str(source), [f"{kind}; bundled blades are {', '.join(names)}{near}"])
    if path.suffix.lower() not in SUFFIXES:
        raise FileError(
            str(source), [f"has the suffix {path.suffix!r}, allowed are {', '.join(SUFFIXES)}"]
        )
    return path


def _beside(path: Path) -> str:
    """Return which file beside a path that is none may be meant."""
    return suggestion(path.name, _blades(path.parent), lambda name: str(path.with_name(name)))


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


def _recognised(path: Path) -> Format:
    """Return the first format of the file's suffix that recognises it."""
    rows = [row for row in FORMATS if path.suffix.lower() in row.suffixes]
    for row in rows:
        if row.recognises(path):
            return row
    marks = " or ".join(f"{row.mark} ({row.name})" for row in rows)
    raise FileError(str(path), [f"holds no blade that is known, must hold {marks}"])
