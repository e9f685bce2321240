"""Text files of other tools: bounded reading, numbers with their places, safe references.

A file that names another may only lead to files below its own folder (or one that the caller
allows): a blade from elsewhere cannot make its reader open what lies outside.
"""

import re
from collections.abc import Sequence
from pathlib import Path, PureWindowsPath

import numpy as np

from bladegen.arrays import Array
from bladegen.errors import FileError
from bladegen.readers.document import Notes, Range

__all__ = ["head", "natural", "number", "numbers", "read_lines", "referred", "rising"]

MAX_BYTES = 16 * 2**20  # the largest blade or airfoil file of these tools has 0.1 MB
HEAD_BYTES = 8192
SHOWN = 5  # wrong entries of one column that are named one by one
_DIGITS = re.compile(r"(\d+)")


def head(path: Path) -> str:
    """Return the first 8 kB of a file as text; empty if it cannot be read."""
    try:
        with path.open("rb") as stream:
            return stream.read(HEAD_BYTES).decode("utf-8", errors="replace")
    except OSError:
        return ""


def read_lines(path: Path, errors: str = "replace") -> list[str]:
    """Return a file's lines.

    Parameters
    ----------
    path : Path
        The file.
    errors : str
        What becomes of bytes that are not UTF-8: "surrogateescape" keeps them for writing.

    Raises
    ------
    FileError
        If it cannot be read, or is larger than 16 MB.
    """
    try:
        if not path.is_file():
            raise FileError(str(path), ["is no regular file"])
        with path.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except OSError as error:
        raise FileError(str(path), [f"cannot be read: {error.strerror}"]) from None
    if len(content) > MAX_BYTES:
        raise FileError(str(path), [f"is larger than {MAX_BYTES >> 20} MB, the most that is read"])
    return content.decode("utf-8-sig", errors=errors).splitlines()


def referred(name: str, bases: Sequence[Path], below: Path | None = None) -> Path | None:
    """Return the file that `name` refers to from one of `bases`, if it lies below that base.

    If `below` is given the file must lie below that folder instead.  Names may be quoted and
    written with the separators of Windows.
    """
    plain = name.strip().strip("\"'").strip()
    if not plain or "\0" in plain:
        return None
    relative = Path(*PureWindowsPath(plain).parts) if "\\" in plain else Path(plain)
    limit = None if below is None else below.resolve()
    for base in bases:
        root = base.resolve()
        try:
            found = (root / relative).resolve()
            if found.is_relative_to(limit or root) and found.is_file():
                return found
        except (OSError, ValueError):  # a name too long for the system
            continue
    return None


def natural(path: Path) -> list[str | int]:
    """Return a key that sorts names by their numbers: AF2 before AF10."""
    words = _DIGITS.split(path.name.lower())
    return [int(word) if word.isdigit() else word for word in words]


def number(text: str) -> float | None:
    """Return the number that a word is, Fortran's 1.0D+00 included; None if it is none."""
    try:
        return float(re.sub(r"[dD](?=[-+]?\d+$)", "e", text))
    except ValueError:
        return None


def numbers(
    words: Sequence[str], places: Sequence[str], field: str, allowed: Range, notes: Notes
) -> Array | None:
    """Return a column's words as numbers within `allowed`, or note those that are not.

    Parameters
    ----------
    words, places : sequences of str
        The column's entries, and where each stands in the file.
    field : str
        What the column is called.
    allowed : Range
        What each may be.
    notes : Notes
        Takes the problems.
    """
    values = np.array([np.nan if (v := number(word)) is None else v for word in words])
    wrong = np.flatnonzero(~allowed.holds(values))
    for i in wrong[:SHOWN]:
        demand = "must be a number," if np.isnan(values[i]) else "allowed is"
        notes.problems.append(f"{places[i]}, {field}: got {words[i][:40]!r}, {demand} {allowed}")
    if len(wrong) > SHOWN:
        notes.problems.append(f"{field}: {len(wrong) - SHOWN} more entries are not {allowed}")
    return None if wrong.size else values


def rising(values: Array, places: Sequence[str], field: str, notes: Notes) -> bool:
    """Tell whether values increase; note the first one that does not."""
    bad = np.flatnonzero(~(np.diff(values) > 0)) + 1
    for i in bad[:1]:
        notes.problems.append(
            f"{places[i]}, {field}: got {values[i]:g} after {values[i - 1]:g}, must increase"
        )
    return not bad.size
