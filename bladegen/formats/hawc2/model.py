"""The files of a HAWC2 model: from an htc file to the commands of all files it continues in.

HAWC2 runs in the model's folder, and names start there.  The htc file lies in it, in its folder
``htc`` or below that (``htc/_master``), or in a folder beside ``htc`` or ``data``
(``hawcstab2``), as the published models have it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from bladegen.errors import Finding
from bladegen.formats.common.document import Notes
from bladegen.formats.common.text_file import read_lines, referred

__all__ = ["Command", "Finder", "commands", "finder", "value"]

HTC = "htc"
KEPT = (HTC, "data")  # folders that a model's folder holds
DEEPEST = 4  # folders from an htc file up in which the model's is sought
MAX_DEPTH = 4  # of continue_in_file
MAX_LINES = 500_000
Finder = Callable[[str], Path | None]


@dataclass(frozen=True)
class Command:
    """A command of an htc file: its words, its comment, and where it stands."""

    words: tuple[str, ...]
    comment: str
    place: str


def finder(path: Path) -> Finder:
    """Return what finds the files that an htc file names.

    Names start in the file's own folder or in the model's, and lead below that folder; in a model
    with ``htc/`` also to the folders beside the model's, which models share.
    """
    here = path.parent.resolve()
    above = [here, *here.parents][:DEEPEST]
    disk = Path(here.anchor)
    for folder in above:
        model = folder.parent
        if folder.name.lower() == HTC and model != disk:
            below = model if model.parent == disk else model.parent
            return partial(referred, bases=[here, model], below=below)
    for model in above[1:]:
        if model != disk and any((model / name).is_dir() for name in KEPT):
            return partial(referred, bases=[here, model])
    return partial(referred, bases=[here])


def commands(path: Path, find: Finder, notes: Notes, depth: int = 0) -> list[Command]:
    """Return the commands of an htc file and of those that it continues in."""
    found: list[Command] = []
    for k, line in enumerate(read_lines(path)):
        code, mark, comment = line.partition(";")
        words = code.replace(",", " ").split()
        if not words:
            continue
        place = f"line {k + 1}" if depth == 0 else f"{path.name}, line {k + 1}"
        first = words[0].lower()
        if first == "exit":
            break
        if first != "continue_in_file":
            found.append(Command(tuple(words), mark + comment, place))
            continue
        named = find(words[1]) if len(words) > 1 else None
        if named is None or depth == MAX_DEPTH:
            lost = "lies outside of the model's folders or is not there"
            said = lost if named is None else "nests too deep"
            notes.findings.append(
                Finding(place, f"continue_in_file {' '.join(words[1:])[:60]} {said}; passed over")
            )
            continue
        found += commands(named, find, notes, depth + 1)
        if len(found) > MAX_LINES:
            break
    return found


def value(lines: list[Command], command: str) -> str:
    """Return what stands behind the first command of a name, "" if nothing does."""
    found = next((line for line in lines if line.words[0].lower() == command), None)
    return found.words[1] if found is not None and len(found.words) > 1 else ""
