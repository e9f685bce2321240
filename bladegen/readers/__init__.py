"""Blade definitions from files: one module a format, one row in `FORMATS`.

A new YAML layout is a module with two functions: `recognises` tells its documents from
others, `read` makes the definition from a `Node`, which notes every problem of the file.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from bladegen.definition import BladeDefinition
from bladegen.errors import DefinitionError, FileError
from bladegen.readers import windio1, windio2
from bladegen.readers.document import Node, Notes
from bladegen.readers.yaml_file import YamlError, load_yaml

__all__ = ["FORMATS", "SUFFIXES", "Format", "bundled", "read"]


@dataclass(frozen=True)
class Format:
    """A layout of YAML documents: what it is, how to tell it, and how to read it."""

    name: str
    mark: str
    recognises: Callable[[object], bool]
    read: Callable[[Node, Path], BladeDefinition | None]


FORMATS = (
    Format("windIO 2", "components.blade.outer_shape", windio2.recognises, windio2.read),
    Format("windIO 1", "components.blade.outer_shape_bem", windio1.recognises, windio1.read),
)
SUFFIXES = (".yaml", ".yml", ".json")


def read(source: str | Path) -> BladeDefinition:
    """Read a blade definition.

    Parameters
    ----------
    source : str or Path
        The name of a bundled blade (`bundled`), or a path to a windIO 1 or 2 file.

    Raises
    ------
    FileError
        If there is no such blade or file, or with all problems of the file at once.
    """
    path = _path(source)
    try:
        document, findings = load_yaml(path)
        notes = Notes(findings=findings)
        definition = _parse(Node(document, "", notes), path)
    except (YamlError, DefinitionError) as error:
        raise FileError(str(source), [str(error)]) from None
    if definition is None or notes.problems:
        raise FileError(str(source), notes.shown())
    return definition


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


def _parse(root: Node, path: Path) -> BladeDefinition | None:
    if root.value is None:
        root.problem("is empty, must hold a turbine in the layout of windIO")
        return None
    for layout in FORMATS:
        if layout.recognises(root.value):
            return layout.read(root, path)
    marks = " or ".join(f"{layout.mark} ({layout.name})" for layout in FORMATS)
    root.problem(f"holds no blade that is known, must hold {marks}")
    return None
