"""The lines of a coordinate file to its points (m, 2); nothing between two points is passed over.

Ahead of the first point a line may be a title or a count, and behind the last one a text.  Only
blank lines and remarks (behind ! # % // ; * or in <tags>) stand between points; every other line
is a point, or an error that names it.  Numbers may have Fortran's exponents (1.5D-03, 1.5-103)
and decimal commas, divided by blanks, tabs, commas or semicolons, a remark behind them, and a
third coordinate that is the same in all lines.  Three columns may also be x, y of one side and y
of the other, which become one loop.
"""

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from bladegen.errors import FileError
from bladegen.formats.common.text_file import number
from bladegen.support.arrays import Array

__all__ = ["PointLines", "numbers_of", "point_lines", "two_sided"]

SHOWN = 40  # letters of a line that a message shows
SAME_Z = 1e-9  # of the largest coordinate
FEW = 3  # lines passed over that are named
ENDS = 0.02  # chords; by so much x of two sides may miss 0 and 1
BLUNT = 0.05  # chords between two sides at x = 0, which meet there
WORDS = 3  # of a damaged point at most; a text that begins with numbers has more
THIRD = (
    "must be x and y; a z must be the same in all lines, and of x, y of one side and y of the "
    "other x must run from 0 to 1 with one side above the other"
)
_REMARK = re.compile(r"[!#%]|//")
_WHOLE_REMARK = ("!", "#", "%", "//", ";", "*")
_TAG = re.compile(r"\s*</?[A-Za-z][^<>]*>(.*</[A-Za-z]\w*>)?\s*")
_EMPTY_CELL = re.compile(r"[\d.]\s*[,;]\s*[,;]\s*[-+.\d]")
_GLUED = re.compile(r"[-+]?[0-9]*\.[0-9]+[-+][0-9]*\.[0-9]+")  # columns of fixed width
_STARS = re.compile(
    r"\s*(?:\*{2,}[\s,;]+[-+]?[.\d]|[-+]?[.\d]\S*[\s,;]+\*{2,})\S*(?:[\s,;]+\S+)?\s*"
)
_DECIMAL_COMMA = re.compile(r",\d")
_PLAIN = re.compile(r"\s*([-+]?\d*\.?\d+(?:[eE][-+]?\d+)?)\s+([-+]?\d*\.?\d+(?:[eE][-+]?\d+)?)\s*")
_BEGUN = re.compile(r"[-+]?[.,]?\d")  # how a number begins, whole or damaged

Split = Callable[[str], list[float] | None]


@dataclass(frozen=True)
class PointLines:
    """The points of a file, each with its line, and what stands about them.

    Parameters
    ----------
    xy : (m, 2) array
        As the file has them.
    at : tuple of int
        The line of each, from 1.
    ahead : tuple of (int, str)
        The lines ahead of the first point that are not blank, with their numbers.
    said : tuple of str
        What was read otherwise than it stands.
    """

    xy: Array
    at: tuple[int, ...]
    ahead: tuple[tuple[int, str], ...]
    said: tuple[str, ...]


def point_lines(lines: Sequence[str], name: str) -> PointLines:
    """Read the points of a coordinate file's lines.

    Raises
    ------
    FileError
        With the line that can neither be read nor be passed over; `name` is the file's.
    """
    found, error = _tried(lines, _with_points)
    if any(map(_DECIMAL_COMMA.search, lines)):
        other, _ = _tried(lines, _with_commas)
        if other is not None and len(other.rows) > (0 if found is None else len(found.rows)):
            return _table(other, ["decimal commas are read as points"])
    if found is None:
        raise FileError(name, [error])
    return _table(found, [])


def _tried(lines: Sequence[str], split: Split) -> tuple["_Lines | None", str]:
    """Read lines with one decimal mark; None and the reason where they make no sense with it."""
    try:
        return _read(lines, split), ""
    except _LineError as error:
        return None, str(error)


def _table(found: "_Lines", said: list[str]) -> PointLines:
    """Return lines as an array, and what was passed over."""
    bounds = [place for place in found.ahead if len(numbers_of(place[1]) or []) > 1]
    for where, places in (("ahead of", bounds), ("behind", found.behind)):
        if places:
            named = ", ".join(f"line {k} ({_shown(line)})" for k, line in places[:FEW])
            if len(places) > FEW:
                named += f" and {len(places) - FEW} more"
            said.append(f"{named} {where} the points passed over")
    if not found.rows:
        return PointLines(np.zeros((0, 2)), (), tuple(found.ahead), ())
    table = np.array([values for _, values in found.rows])
    at = tuple(k for k, _ in found.rows)
    if two_sided(table):
        said.append("three columns are read as x, y of one side and y of the other")
        table, at = _loop_of(table, at)
    elif table.shape[1] == 3:
        said.append(f"z is {table[0, 2]:g} in all lines; dropped")
    return PointLines(table[:, :2], at, tuple(found.ahead), tuple(said))


def two_sided(table: Array) -> bool:
    """Tell whether rows (m, 3) are x, y of one side and y of the other.

    Then x runs one way from 0 to 1, one side lies above the other all along and both meet at 0;
    the lower one goes below 0, which camber and thickness, or lift and drag, do not.
    """
    if table.shape[1] != 3 or len(table) < FEW:
        return False
    x, one, other = table[np.argsort(table[:, 0])].T
    steps = np.diff(table[:, 0])
    ends = abs(x[0]) <= ENDS and abs(x[-1] - 1.0) <= ENDS
    apart = one - other
    above = bool(np.all(apart >= 0) or np.all(apart <= 0)) and np.abs(apart[:-1]).max() > 0
    below = min(one.min(), other.min()) < 0
    one_way = bool(np.all(steps > 0) or np.all(steps < 0))
    return bool(one_way and ends and above and below and abs(apart[0]) <= BLUNT)


def _loop_of(table: Array, at: tuple[int, ...]) -> tuple[Array, tuple[int, ...]]:
    """Return two sides in columns as one loop, and the line of each point."""
    order = np.argsort(table[:, 0])
    table, lines = table[order], np.array(at)[order]
    skipped = int(table[0, 1] == table[0, 2])  # the nose, where both sides have it
    loop = np.concatenate([table[::-1, :2], table[skipped:, [0, 2]]])
    return loop, tuple(np.concatenate([lines[::-1], lines[skipped:]]).tolist())


def numbers_of(line: str) -> list[float] | None:
    """Return the numbers that a line holds, with decimal points; None if it holds anything else."""
    return _with_points(line)


class _LineError(Exception):
    """A line that can neither be read nor be passed over."""

    def __init__(self, at: int, line: str, demand: str = "") -> None:
        super().__init__(f"line {at}: got {_shown(line)}, {demand or _demand(line)}")


@dataclass
class _Lines:
    """Lines with points, those ahead of them and those behind, each with its number."""

    rows: list[tuple[int, list[float]]] = field(default_factory=list)
    ahead: list[tuple[int, str]] = field(default_factory=list)
    behind: list[tuple[int, str]] = field(default_factory=list)


def _read(lines: Sequence[str], split: Split) -> _Lines:
    """Tell lines with points from others; all must be alike."""
    found = _Lines()
    for k, line in enumerate(lines, 1):
        begun = bool(found.rows)
        plain = _PLAIN.fullmatch(line)  # as nearly all lines are, and much quicker
        if plain is None and (
            not line.strip() or (begun and (_is_remark(line) or _TAG.fullmatch(line)))
        ):
            continue
        values = split(line) if plain is None else [float(word) for word in plain.groups()]
        if values is not None and len(values) in (2, 3):
            if found.behind:
                raise _LineError(*found.behind[0])
            if not all(map(math.isfinite, values)):
                raise _LineError(k, line, "must be finite")
            if begun and len(values) != len(found.rows[0][1]):
                raise _LineError(k, line, f"must hold {len(found.rows[0][1])} numbers as the first")
            found.rows.append((k, values))
        elif not begun and (values is not None or not _damaged(line)):
            found.ahead.append((k, line))
        elif not found.behind and (not begun or values is not None or _damaged(line)):
            raise _LineError(k, line)
        else:
            found.behind.append((k, line))
    if found.rows and len(found.rows[0][1]) == 3:
        z = np.array([values for _, values in found.rows])
        varies = np.flatnonzero(np.abs(z[:, 2] - z[0, 2]) > SAME_Z * np.abs(z).max())
        if varies.size and not two_sided(z):
            k = found.rows[int(varies[0])][0]
            raise _LineError(k, lines[k - 1], THIRD)
    return found


def _is_remark(line: str) -> bool:
    """Tell whether all of a line among points is a remark."""
    return line.lstrip().startswith(_WHOLE_REMARK) and not _STARS.fullmatch(line)


def _demand(line: str) -> str:
    """Return what a line must hold that is neither a point nor a text."""
    if _STARS.fullmatch(line):
        return "must be x and y; stars are what Fortran writes where a number is too wide"
    if _GLUED.match(line.strip()):
        return "must be x and y; put a space between the two"
    return "must be x and y"


def _damaged(line: str) -> bool:
    """Tell whether a line is a point with one number damaged or something behind it, not a text."""
    words = re.split(r"[\s,;]+", _REMARK.split(line, maxsplit=1)[0].strip())
    if _GLUED.fullmatch(words[0]) or _STARS.fullmatch(line):
        return True
    if len(words) < 2 or not all(map(_BEGUN.match, words[:2])):
        return False
    values = [number(word) for word in words[:2]]
    if values[0] is not None and "." in words[0]:
        return True
    return values[1] is not None and len(words) <= WORDS


def _with_points(line: str) -> list[float] | None:
    if _EMPTY_CELL.search(line):
        return None
    return _numbers(line, lambda text: text.replace(",", " "))


def _with_commas(line: str) -> list[float] | None:
    return _numbers(line, lambda text: re.sub(r",(?=\d)", ".", text).replace(",", " "))


def _numbers(line: str, mended: Callable[[str], str]) -> list[float] | None:
    """Return the numbers of a line without its remark; None if it holds anything else.

    A semicolon divides where a number follows it, and begins a remark otherwise.
    """
    text = _REMARK.split(mended(line.replace('"', " ")), maxsplit=1)[0]
    values: list[float] = []
    for part in text.split(";"):
        words = part.split()
        if values and words and number(words[0]) is None:
            break
        for word in words:
            value = number(word)
            if value is None:
                return None
            values.append(value)
    return values or None


def _shown(line: str) -> str:
    text = " ".join(line.split())
    return repr(text if len(text) <= SHOWN else text[: SHOWN - 3] + "...")
