"""Blade definitions from files: one module a format, one row in `FORMATS`.

A new format is a module with two functions: `recognises` tells its files from others of the
same suffix, by a bounded look; `read` makes the definition and notes every problem of the file
in `Notes`, so that a user hears of all of them at once.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from bladegen.definition import BladeDefinition
from bladegen.errors import DefinitionError, FileError, Finding
from bladegen.readers import hawc2, numad, openfast, qblade, spanwise_table, turbine_file
from bladegen.readers.document import Notes

__all__ = ["FORMATS", "SUFFIXES", "Format", "bundled", "holds_blade", "read"]

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
    path = _path(source)
    notes = Notes()
    try:
        row = _recognised(path)
        definition = row.read(path, notes, None if airfoils is None else Path(airfoils))
    except DefinitionError as error:
        raise FileError(str(source), [str(error)]) from None
    except FileError as error:
        raise FileError(str(source), error.problems) from None
    if definition is None or notes.problems:
        raise FileError(str(source), notes.shown())
    if definition.relative_thickness is None:
        definition = replace(definition, findings=(*definition.findings, BY_AIRFOILS))
    return replace(definition, format=definition.format or row.name)


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
        exists, is_file = path.exists(), path.is_file()
    except OSError:  # a name too long for the system
        exists = is_file = False
    if not is_file:
        kind = "is no regular file" if exists else "is neither a bundled blade nor a file"
        raise FileError(str(source), [f"{kind}; bundled blades are {', '.join(names)}"])
    if path.suffix.lower() not in SUFFIXES:
        raise FileError(
            str(source), [f"has the suffix {path.suffix!r}, allowed are {', '.join(SUFFIXES)}"]
        )
    return path


def _recognised(path: Path) -> Format:
    """Return the first format of the file's suffix that recognises it."""
    rows = [row for row in FORMATS if path.suffix.lower() in row.suffixes]
    for row in rows:
        if row.recognises(path):
            return row
    marks = " or ".join(f"{row.mark} ({row.name})" for row in rows)
    raise FileError(str(path), [f"holds no blade that is known, must hold {marks}"])
