"""Blade definitions from files: one module a format, one row in `FORMATS`.

A new YAML layout needs a function that recognises its document and one that reads it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from bladegen.definition import BladeDefinition
from bladegen.errors import FileError
from bladegen.readers import windio
from bladegen.readers.document import load_yaml

__all__ = ["FORMATS", "Format", "bundled", "read"]


@dataclass(frozen=True)
class Format:
    """A layout of YAML documents: how to tell it, and how to read it."""

    name: str
    recognises: Callable[[object], bool]
    read: Callable[[object, Path], BladeDefinition]


FORMATS = (
    Format("windIO 2", windio.is_v2, windio.read_v2),
    Format("windIO 1", windio.is_v1, windio.read_v1),
)
SUFFIXES = (".yaml", ".yml")


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
    if str(source) in bundled():
        path = _home() / f"{source}.yaml"
    else:
        path = Path(source)
        if not path.is_file():
            kind = "is no file" if path.exists() else "is no blade's name and no file"
            raise FileError(str(source), [f"{kind}; bundled blades: {', '.join(bundled())}"])
        if path.suffix.lower() not in SUFFIXES:
            raise FileError(
                str(source), [f"suffix {path.suffix!r}, allowed are {', '.join(SUFFIXES)}"]
            )
    document = load_yaml(path)
    for layout in FORMATS:
        if layout.recognises(document):
            return layout.read(document, path)
    raise FileError(
        str(source),
        [
            "is no blade: components.blade must hold outer_shape (windIO 2) or outer_shape_bem "
            "(windIO 1)"
        ],
    )


def bundled() -> tuple[str, ...]:
    """Return the names of the blades that come with bladegen."""
    return tuple(sorted(path.stem for path in _home().glob("*.yaml")))


def _home() -> Path:
    """Return the folder of the bundled blades, in a wheel or in a checkout."""
    package = Path(__file__).resolve().parent.parent
    installed = package / "blades"
    return installed if installed.is_dir() else package.parent / "blades"
