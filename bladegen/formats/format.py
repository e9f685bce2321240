"""What a format of blade files can do: be read, written, and take a blade back.

A row of the table in `registry` is a `Format`; packages of others make such rows, too.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import DefinitionError, ExportError, Finding
from bladegen.formats.common.document import Notes

__all__ = ["GRID", "Format", "PutBack", "Reader", "Writer", "with_nodes"]

WHOLE = 5e-6  # m; formats with a grid for each quantity hold a blade to 1e-6, where they can
GRID = 1.5e-3  # m; formats with one grid are within 0.3 or 0.5 mm of each quantity


@dataclass(frozen=True)
class Reader:
    """How a format is read.

    Parameters
    ----------
    suffixes : tuple of str
        Of its files, lower case, with their dots.
    mark : str
        What tells its files from others, in words.
    recognises : callable
        Tells by a bounded look whether a file of one of the suffixes is of this format.
    read : callable
        From a file, the notes to make on it (`Notes`), and a folder of airfoil files for formats
        that only name their airfoils (None: the format's own place) to the definition; None if
        there are problems, which the notes then hold, all of them.  An unset
        `BladeDefinition.format` becomes the format's name.
    """

    suffixes: tuple[str, ...]
    mark: str
    recognises: Callable[[Path], bool]
    read: Callable[[Path, Notes, Path | None], BladeDefinition | None]

    def __post_init__(self) -> None:
        _require_suffixes(self.suffixes, self.mark)


@dataclass(frozen=True)
class Writer:
    """A way to write a format.

    Parameters
    ----------
    name : str
        By which it is asked for: one word, lower case.
    title : str
        What it is called.
    suffixes : tuple of str
        Of its files, lower case, "" for a folder; the first way with a suffix is meant by it.
    write : callable
        From a definition and a path to what the format cannot hold.  A format of one file writes
        it through `files.replacing`; one of several writes its main file to the path, and the
        others beside it, under names that start with the main file's.
    polars : bool
        Whether it holds polars.
    structure : bool
        Whether it holds what lies inside the skin.
    tolerance : float, optional
        How far a blade may be off that is read back [m] without a finding; None for formats that
        hold no blade.
    nodes : bool
        Whether `write` takes how many nodes there shall be, as ``nodes=``.
    """

    name: str
    title: str
    suffixes: tuple[str, ...]
    write: Callable[..., tuple[Finding, ...]]
    polars: bool = False
    tolerance: float | None = WHOLE
    structure: bool = False
    nodes: bool = False

    def __post_init__(self) -> None:
        if self.suffixes != ("",):
            _require_suffixes(self.suffixes, self.name)


@dataclass(frozen=True)
class PutBack:
    """How a blade is put back into a full model of a tool.

    Parameters
    ----------
    suffixes : tuple of str
        Of the models, lower case, with their dots.
    write : callable
        From a definition, the model and a path: writes the model with its blade replaced and
        everything else as it is, and returns what it cannot hold.
    tolerance : float
        How far a blade may be off that is read back [m] without a finding.
    nodes : bool
        Whether `write` takes how many nodes there shall be, as ``nodes=``.
    """

    suffixes: tuple[str, ...]
    write: Callable[..., tuple[Finding, ...]]
    tolerance: float = WHOLE
    nodes: bool = False

    def __post_init__(self) -> None:
        _require_suffixes(self.suffixes, "put_back")


def with_nodes(way: Writer | PutBack, nodes: int | None) -> dict[str, int]:
    """Return what a way to write is told of nodes.

    Raises
    ------
    ExportError
        If nodes are given and the format has none.
    """
    if nodes is None:
        return {}
    if not way.nodes:
        raise ExportError(
            f"nodes: got {nodes}, only AeroDyn's blades have nodes of their own; leave it out for "
            f"{', '.join(suffix or 'a folder' for suffix in way.suffixes)}"
        )
    return {"nodes": nodes}


@dataclass(frozen=True)
class Format:
    """A file format.

    Parameters
    ----------
    name : str
        What it is called.
    reader : Reader, optional
        How it is read, if it is.
    writers : tuple of Writer
        The ways to write it: versions, layouts, kinds of file.
    put_back : PutBack, optional
        How a blade is put back into a model.
    alone : bool
        Whether a file of it names no others, so that it can be written elsewhere and read there.
    """

    name: str
    reader: Reader | None = None
    writers: tuple[Writer, ...] = ()
    put_back: PutBack | None = None
    alone: bool = False


def _require_suffixes(suffixes: tuple[str, ...], name: str) -> None:
    """Raise unless suffixes are as those of files are looked for."""
    wrong = [one for one in suffixes if one[:1] != "." or one != one.lower()]
    if isinstance(suffixes, str) or wrong or not suffixes:
        raise DefinitionError(
            f"{name}: suffixes: got {suffixes!r}, must be a tuple such as ('.toy',), lower case"
        )
