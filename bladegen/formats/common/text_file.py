"""Text files of other tools: bounded reading, numbers with their places, safe references.

A file that names another may only lead to files below its own folder (or one that the caller
allows): a blade from elsewhere cannot make its reader open what lies outside.
"""

import codecs
import re
from collections.abc import Sequence
from pathlib import Path, PureWindowsPath

import numpy as np

from bladegen.formats.common.document import Notes, Range
from bladegen.support.arrays import Array
from bladegen.support.files import beginning_of, content_of

__all__ = [
    "decimal_of",
    "delimiter_of",
    "head",
    "natural",
    "number",
    "numbers",
    "read_lines",
    "referred",
    "rising",
    "text_of",
]

MAX_BYTES = 16 * 2**20  # the largest blade or airfoil file of these tools has 0.1 MB
HEAD_BYTES = 8192
SHOWN = 5  # wrong entries of one column that are named one by one
_UTF_16 = codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE
_NUMBER = re.compile(r"([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))(?:[eEdDqQ]([-+]?[0-9]+))?")
_BARE = re.compile(r"([-+]?(?:[0-9]+\.[0-9]*|\.[0-9]+))([-+][0-9]{3})")
_NOT_FINITE = ("nan", "inf", "infinity")
_DIGITS = re.compile(r"(\d+)")


def head(path: Path) -> str:
    """Return the first 8 kB of a file as text; empty if it cannot be read."""
    return text_of(beginning_of(path, HEAD_BYTES))


def read_lines(path: Path, errors: str = "replace", *, most: int | None = None) -> list[str]:
    """Return a file's lines: UTF-8, or UTF-16 with its mark, as spreadsheets write it.

    Parameters
    ----------
    path : Path
        The file.
    errors : str
        What becomes of bytes that are not UTF-8: "surrogateescape" keeps them for writing.
    most : int, optional
        The most bytes that are read; 16 MB if not given.

    Raises
    ------
    FileError
        If it cannot be read, or is larger.
    """
    return text_of(content_of(path, MAX_BYTES if most is None else most), errors).splitlines()


def text_of(content: bytes, errors: str = "replace") -> str:
    """Return bytes as text: UTF-8, or UTF-16 with its mark, as spreadsheets write it."""
    if content.startswith(_UTF_16):
        return content.decode("utf-16", errors="replace")
    return content.decode("utf-8-sig", errors=errors)


def delimiter_of(text: str) -> str:
    """Return what divides the cells of a text's first row: a comma, a semicolon or a tab."""
    first = next((line for line in text.splitlines() if line.strip()), "")
    return max((",", ";", "\t"), key=first.count)


def decimal_of(text: str, delimiter: str) -> str:
    """Return the decimal mark of a table: a comma where cells have some and no points."""
    return "," if delimiter != "," and "," in text and "." not in text else "."


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
    """Return the number that a word is, Fortran's 1.0D+00 and 1.0-103 included; None if it is none.

    Fortran drops the letter of exponents of three digits; its numbers always have a point.
    """
    match = _NUMBER.fullmatch(text) or _BARE.fullmatch(text)
    if match is not None:
        return float(f"{match[1]}e{match[2] or 0}")
    return float(text) if text.lstrip("+-").lower() in _NOT_FINITE else None


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
