"""A case's folder: written whole beside its place, then moved there."""

import shutil
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from bladegen.errors import ExportError
from bladegen.exports import marks
from bladegen.exports.cases.guidance import RUN
from bladegen.support import files
from bladegen.support.foam import Entries, dictionary

__all__ = ["put", "put_dictionaries", "put_fields", "put_run", "written"]

OWN = ("0", "constant", "system", RUN, "README.md")


def written(folder: Path, fill: Callable[[Path], None]) -> None:
    """Write a case; what an earlier one of ours left in the folder is replaced.

    Parameters
    ----------
    folder : Path
        Of the case.
    fill : callable
        Writes `OWN` into a folder that is there and empty.

    Raises
    ------
    ExportError
        If the folder holds anything else, or cannot be written.
    """
    _require_ours(folder)
    target = files.folder(folder).resolve()
    try:
        with tempfile.TemporaryDirectory(prefix=f".{target.name}.", dir=target.parent) as name:
            draft = Path(name)
            fill(draft)
            for part in OWN:
                there = target / part
                if there.is_dir():
                    shutil.rmtree(there)
                (draft / part).replace(there)
    except OSError as error:
        raise ExportError(f"{folder}: cannot be written: {error.strerror or error}") from None


def put(path: Path, text: str) -> None:
    """Write a text, and the folders it is in."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def put_fields(
    draft: Path, fields: Mapping[str, tuple[str, dict[str, Any]]], note: str = ""
) -> None:
    """Write fields by name: their class and their entries."""
    for name, (kind, entries) in fields.items():
        put(draft / "0" / name, dictionary(name, entries, kind=kind, note=note))


def put_dictionaries(folder: Path, held: Mapping[str, Entries], note: str = "") -> None:
    """Write dictionaries by name into a folder."""
    for name, entries in held.items():
        put(folder / name, dictionary(name, entries, note=note))


def put_run(draft: Path, script: str) -> None:
    """Write the script that runs a case."""
    put(draft / RUN, script)
    (draft / RUN).chmod(0o755)


def _require_ours(folder: Path) -> None:
    """See that a folder is missing, empty, or holds a case of ours that has not been run."""
    if not folder.is_dir() or not any(folder.iterdir()):
        return
    ours = (folder / "system" / "controlDict").is_file() and marks.read(folder / "README.md")
    if not ours:
        raise ExportError(
            f"{folder}: holds other files; a case needs a folder of its own, such as "
            f"-o {folder / 'case'}"
        )
    if any(file.is_dir() and file.name not in OWN for file in folder.iterdir()):
        raise ExportError(
            f"{folder}: holds the results of a run; remove it, or take another folder, such as "
            f"-o {folder.parent / f'{folder.resolve().name}2'}"
        )
