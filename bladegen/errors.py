"""What can go wrong, and what is worth saying though nothing went wrong.

Every error a user can meet is a `BladegenError`: one line that names the file, the field,
the value and what is allowed.  A `Finding` is a remark on data that was accepted.  Names in them
come from files of anybody: what would act on a terminal or hide is shown by its code.
"""

import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

__all__ = [
    "BladegenError",
    "CadError",
    "DefinitionError",
    "DesignError",
    "ExportError",
    "FamilyError",
    "FileError",
    "Finding",
    "GeometryError",
    "MissingLibraryError",
    "PerturbationError",
    "PlaceError",
    "PromiseError",
    "RenderError",
    "SizeError",
    "SpaceError",
    "StudioError",
    "ToleranceError",
    "visible",
]

PACKAGES = {
    "OCP": "cadquery-ocp",
    "vtkmodules": "pyvista",
    "PIL": "pillow",
    "yaml": "pyyaml",
    "neuralfoil": "'bladegen[aero]'",
    **{extra: f"'bladegen[{extra}]'" for extra in ("openmdao", "torch", "jax", "wisdem", "xarray")},
    "sklearn": "'bladegen[stats]' (scikit-learn)",
}

# control characters (C0, C1), those without a form of their own that turn the direction of what
# follows or join it, halves of pairs, and marks of lines and paragraphs
_HIDDEN = ("Cc", "Cf", "Cs", "Zl", "Zp")


def visible(text: str) -> str:
    """Return a text with the characters that show nothing, but act, as their codes.

    >>> print(visible("foil\\x1b[31m \\u202egnp.x"))
    foil\\x1b[31m \\u202egnp.x
    """
    if text.isprintable():
        return text
    return "".join(
        letter.encode("unicode_escape").decode("ascii")
        if unicodedata.category(letter) in _HIDDEN
        else letter
        for letter in text
    )


class BladegenError(Exception):
    """The base of every error that bladegen raises on purpose."""

    def __str__(self) -> str:
        return visible(" ".join(super().__str__().split("\n")))


class DefinitionError(BladegenError):
    """A blade definition, or a part of one, holds a value that is not allowed."""


class FileError(BladegenError):
    """A file cannot be found, read or parsed, or holds problems.

    Parameters
    ----------
    source : str
        The file, as the user named it.
    problems : sequence of str
        Each problem with its place inside the file, the value and what is allowed.
    """

    def __init__(self, source: str, problems: Sequence[str]) -> None:
        self.source = source
        self.problems = tuple(map(visible, problems))
        count = len(self.problems)
        head = f"{source}: " if count == 1 else f"{source}: {count} problems: "
        super().__init__(head + "; ".join(self.problems))


class GeometryError(BladegenError):
    """A computation on shapes has no answer for the values it was given."""


class CadError(BladegenError):
    """A solid could not be made, or is not the valid closed solid it should be."""


class DesignError(BladegenError):
    """A plan of variants cannot be made."""


class FamilyError(BladegenError):
    """A family of blades cannot be made, or its folder is not what it should be."""


class PlaceError(FamilyError, IndexError):
    """A family has no variant at a place."""


class PerturbationError(BladegenError):
    """A perturbation is out of range, or makes a blade that cannot be."""


class SpaceError(BladegenError):
    """A shape space cannot be made or read, or is asked for what it does not hold."""


class StudioError(BladegenError):
    """The studio cannot start, or is asked for what it does not show."""


class PromiseError(CadError):
    """A solid was made, but is not what was asked for.

    Parameters
    ----------
    message : str
        What was promised and what was reached.
    kept : Path, optional
        The file, under a name that says so.
    """

    def __init__(self, message: str, kept: Path | None = None) -> None:
        super().__init__(message)
        self.kept = kept


class ToleranceError(PromiseError):
    """A solid deviates from the blade by more than was asked for."""


class SizeError(PromiseError):
    """A solid's file is larger than was asked for."""


class ExportError(BladegenError):
    """A file cannot be written in the format or at the place asked for."""


class MissingLibraryError(ExportError, ImportError):
    """A library that only some files need is not installed, or cannot be loaded."""

    def __init__(self, error: ImportError) -> None:
        library = (error.name or "a library").partition(".")[0]
        package = PACKAGES.get(library, library)
        super().__init__(
            f"this needs {library}, which cannot be imported ({' '.join(str(error).split())}); "
            f"pip install {package}, and the system libraries that docs/install.md names"
        )


class RenderError(BladegenError):
    """This machine cannot render a picture."""


@dataclass(frozen=True, slots=True)
class Finding:
    """A remark on data that was accepted: where, and what was seen or mended."""

    where: str
    message: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "where", visible(self.where))
        object.__setattr__(self, "message", visible(self.message))

    def __str__(self) -> str:
        return f"{self.where}: {self.message}"
