"""Text with a row a point to named columns [file's unit], and to the sections that rows make."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bladegen.errors import FileError
from bladegen.formats.common.column_names import LENGTHS
from bladegen.support.arrays import Array, Indices
from bladegen.support.files import beside

__all__ = ["Table", "table_of"]

LARGEST = 2 * 10**9  # bytes of a file
BLOCKS = 10**8  # bytes of a file whose blank lines are looked for
HEADER = 20  # lines at most that are no numbers, before the points
MARKS = (",", ";", "\t", None)  # between numbers; None is any blank
FEWEST, SECTIONS = 12, 4  # points of a section, and sections
AXES = ("x", "y", "z")
NAMES = {
    **{name: name for name in AXES},
    **dict.fromkeys(("eta", "span fraction", "r r", "z l", "blfract"), "eta"),
    **dict.fromkeys(("normalized span", "normalised span", "spanwise fraction"), "eta"),
    **dict.fromkeys(("span", "r", "radius", "spanwise position"), "span"),
    **dict.fromkeys(("section", "section index", "section number", "section id"), "section"),
    **dict.fromkeys(("station", "station index", "station number", "index"), "section"),
}
_UNIT = re.compile(r"^(.*?)\s*[\[(]\s*([^\])]*?)\s*[\])]$")


@dataclass(frozen=True, eq=False)
class Table:
    """Columns of a text file.

    Parameters
    ----------
    path : str
        What errors call it.
    columns : dict of (m,) arrays
        By the names of `NAMES`; lengths in the file's unit.
    metres : float, optional
        The unit of its lengths, if it says one.
    blocks : (m,) array of int, optional
        Which block of lines each row stands in, where blank lines part them.
    """

    path: str
    columns: dict[str, Array]
    metres: float | None = None
    blocks: Indices | None = None

    @property
    def points(self) -> Array:
        """Points (m, 3); a `FileError` if a coordinate is missing."""
        missing = [name for name in AXES if name not in self.columns]
        if missing:
            raise FileError(self.path, [f"has no column {', '.join(missing)} of its points"])
        return np.stack([self.columns[name] for name in AXES], axis=-1)

    def sections(self) -> list[Indices] | None:
        """Return the rows of each section, None if the rows are points in no sections.

        Raises
        ------
        FileError
            If a column says that there are sections, and the rows make none.
        """
        for name in ("section", "span", "eta"):
            if name in self.columns:
                return self._parted(self.columns[name], name)
        if self.blocks is not None:
            return self._parted(self.blocks.astype(np.float64), "block of lines")
        level = [name for name in AXES if name in self.columns and _steps(self.columns[name])]
        if len(level) > 1:
            raise FileError(
                self.path,
                [
                    f"rows share {' and '.join(level)} by turns: which tells the sections? name it "
                    "span, or add a column section"
                ],
            )
        return self._parted(self.columns[level[0]], level[0]) if level else None

    def _parted(self, values: Array, name: str) -> list[Indices]:
        starts = np.flatnonzero(np.diff(values) != 0.0) + 1
        rows = np.split(np.arange(len(values)), starts)
        fewest = min(rows, key=len)
        if len(rows) < SECTIONS or len(fewest) < FEWEST:
            raise FileError(
                self.path,
                [
                    f"column {name}: {len(rows)} sections, one of {len(fewest)} points; needs at "
                    f"least {SECTIONS} of {FEWEST} points or more, rows of one beside each other"
                ],
            )
        own = values[[part[0] for part in rows]]
        unique, count = np.unique(own, return_counts=True)
        if count.max() > 1:
            twice = unique[np.argmax(count)]
            raise FileError(
                self.path,
                [f"column {name}: {twice:g} is in {count.max()} places; put its rows together"],
            )
        return rows


def table_of(path: Path) -> Table:
    """Read a table with a row a point.

    Columns are those that a header names, with units beside or below their names; without one the
    first three are x, y and z, or those after a first column of whole numbers that tells sections.

    Raises
    ------
    FileError
        If there is no row of numbers, a value is none, or units differ.
    """
    if not path.is_file():
        raise FileError(str(path), [f"is no file{beside(path, (path.suffix.lower(),))}"])
    size = path.stat().st_size
    if size > LARGEST:
        raise FileError(str(path), [f"has {size} bytes, allowed are {LARGEST}"])
    with path.open(encoding="utf-8", errors="replace") as stream:
        head = [stream.readline() for _ in range(HEADER)]
    skipped, mark = _first_row(path, head)
    named, metres = _named(path, head[:skipped], mark)
    wanted = named or _unnamed(head[skipped:], mark)
    try:
        values = np.loadtxt(
            path,
            delimiter=mark,
            skiprows=skipped,
            usecols=list(wanted.values()),
            ndmin=2,
            comments="#",
        )
    except ValueError as error:
        raise FileError(str(path), [f"no table of numbers: {error}"]) from None
    columns = {name: values[:, k] for k, name in enumerate(wanted)}
    blocks = _blocks(path, skipped, len(values)) if size < BLOCKS else None
    return Table(str(path), columns, metres, blocks)


def _first_row(path: Path, head: list[str]) -> tuple[int, str | None]:
    """Return how many lines stand before the first row of numbers, and what parts these."""
    for skipped, line in enumerate(head):
        for mark in MARKS:
            if len(_numbers(line, mark)) > 2:
                return skipped, mark
    raise FileError(
        str(path), [f"no line of its first {HEADER} holds three numbers x, y, z of a point"]
    )


def _numbers(line: str, mark: str | None) -> list[float]:
    """Return the numbers that a line begins with, or all but one name of a row."""
    found = []
    for word in line.split(mark):
        try:
            found.append(float(word))
        except ValueError:
            continue
    words = len(line.split(mark))
    return found if len(found) >= max(3, words - 1) else []


def _named(path: Path, lines: list[str], mark: str | None) -> tuple[dict[str, int], float | None]:
    """Return which column has which name of `NAMES`, and the unit of lengths in metres."""
    found: dict[str, int] = {}
    units: dict[str, str] = {}
    for line in lines:
        words = [word.strip(" \"'\ufeff\n\r").lower() for word in line.lstrip("#% ").split(mark)]
        if found and all(word.strip("[]()") in {*LENGTHS, *NO_UNIT} for word in words):
            for name, k in found.items():
                if k < len(words) and words[k].strip("[]()") in LENGTHS:
                    units[name] = words[k].strip("[]()")
            continue
        names: dict[str, int] = {}
        own: dict[str, str] = {}
        for k, word in enumerate(words):
            name, unit = _parts(word)
            if name in NAMES and NAMES[name] not in names:
                names[NAMES[name]] = k
                if unit in LENGTHS:
                    own[NAMES[name]] = unit
        if len(names) > 1 and {"x", "y"} & names.keys():
            found, units = names, own
    missing = [name for name in ("x", "y") if found and name not in found]
    if missing:
        raise FileError(str(path), [f"has no column {missing[0]} of its points"])
    said = {LENGTHS[unit] for unit in units.values()}
    if len(said) > 1:
        told = ", ".join(f"{name} in {unit}" for name, unit in units.items())
        raise FileError(str(path), [f"has lengths in several units ({told}); use one"])
    return found, said.pop() if said else None


NO_UNIT = ("", "-", "--", "1")


def _parts(word: str) -> tuple[str, str]:
    """Return a title's name as plain words, and its unit."""
    match = _UNIT.match(word)
    name, unit = (match[1], match[2]) if match else (word, "")
    words = re.sub(r"[^a-z0-9]+", " ", name).split()
    if not unit and len(words) > 1 and words[-1] in LENGTHS:
        unit, words = words[-1], words[:-1]
    return " ".join(words), unit


def _unnamed(lines: list[str], mark: str | None) -> dict[str, int]:
    """Return the columns of a table without a header."""
    rows = [row for row in (_numbers(line, mark) for line in lines) if row]
    width = min(len(row) for row in rows)
    first = np.array([row[0] for row in rows])
    if width > 3 and len(rows) >= FEWEST and np.all(first == np.round(first[0])):
        return {"section": 0, "x": 1, "y": 2, "z": 3}
    return {"x": 0, "y": 1, "z": 2}


def _steps(values: Array) -> bool:
    """Tell whether rows share a value, section by section."""
    changes = np.flatnonzero(np.diff(values) != 0.0)
    if not len(changes) or len(changes) > len(values) // FEWEST:
        return False
    runs = np.diff(np.concatenate([[-1], changes, [len(values) - 1]]))
    return bool(runs.min() >= FEWEST)


def _blocks(path: Path, skipped: int, count: int) -> Indices | None:
    """Return which block of lines each of so many rows stands in, None where there is but one."""
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()[skipped:]
    plain = [line.split("#")[0].strip() for line in lines]
    while plain and not plain[-1]:
        plain.pop()
    if all(plain):
        return None
    block, found = 0, []
    for line, after in zip(plain, [*plain[1:], ""], strict=True):
        if line:
            found.append(block)
        elif after:
            block += 1
    return np.array(found) if block and len(found) == count else None
