"""Variants of families as blades of commands: FOLDER/NUMBER or FOLDER/NAME."""

from pathlib import Path
from typing import Any

from bladegen.errors import BladegenError
from bladegen.support.arguments import suggestion

__all__ = ["defined", "is_family", "place", "variant"]


def is_family(path: Path) -> bool:
    """Tell whether a path is a family's folder, without opening it."""
    if isinstance(path, Path):  # nothing of families is loaded
        return (path / "family.json").is_file()
    from bladegen.families.storage.places import told

    with told(path):
        return (path / "family.json").is_file()


def place(source: str) -> Path:
    """Return where a source lies, if it is the name of something there."""
    if "://" not in source:  # nothing of families is loaded for a plain name
        return Path(source)
    from bladegen.families.storage.places import located

    return located(source)


def defined(source: str, airfoils: Any = None) -> Any:
    """Return the definition that a source means; of a variant, one with airfoils of its own."""
    from bladegen.formats.common.redefinition import redefined
    from bladegen.formats.reading import read

    made = variant(source, None, plain=airfoils is None)
    return read(source, airfoils=airfoils) if made is None else redefined(made)


def variant(source: str, landmarks: int | None, *, plain: bool) -> Any:
    """Return the variant of a family that a source means, None if it means something else.

    Parameters
    ----------
    source : str
        What a command was given as its blade.
    landmarks : int, optional
        How many landmarks it must have, any if not given.
    plain : bool
        Whether options that say how a definition becomes a blade are as they are by default.

    Raises
    ------
    BladegenError
        If the family has no such variant, or was made otherwise.
    """
    path = place(source)
    if is_family(path):
        folder, last = path, None
    elif not path.exists() and is_family(path.parent):
        folder, last = path.parent, path.name
    else:
        return None
    from bladegen.families.dataset.loading import load_family

    family = load_family(folder)
    names = [str(name) for name in family["name"][:]]
    if last is None:
        raise BladegenError(
            f"{source}: is a family's folder; name one of its variants: {folder / '0'} to "
            f"{folder / str(len(family) - 1)}, or {folder / names[0]}"
        )
    if not last.isdecimal() and last not in names:
        raise BladegenError(
            f"{source}: {folder} has no variant {last!r}, but 0 to {len(family) - 1} and "
            f"{names[0]} to {names[-1]}{suggestion(last, names)}"
        )
    made = family[int(last) if last.isdecimal() else names.index(last)]
    if not plain or landmarks not in (None, len(made.u)):
        raise BladegenError(
            f"{source}: a variant is made as its family was, with {len(made.u)} landmarks; leave "
            "options out that say otherwise"
        )
    return made
