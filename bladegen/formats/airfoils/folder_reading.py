"""Airfoil shapes that stand in files of their own beside a blade file.

A folder of coordinate files (`reading`), with or without `index.csv` that bladegen
writes: its columns are airfoil, file, relative_thickness and, where the blade file cannot say it,
span_fraction.  Without it an airfoil is known by its file's name, its thickness by its coordinates;
polars and other files that stand beside shapes are passed over, and reported.
"""

import csv
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from bladegen.definition.blade_definition import Airfoil, Station
from bladegen.errors import FileError, Finding
from bladegen.formats.airfoils.by_name import of_file
from bladegen.formats.airfoils.contours import THICKNESS, thickness
from bladegen.formats.airfoils.reading import MAX_BYTES, SUFFIXES, read_contour, tabulates
from bladegen.formats.common.document import Notes
from bladegen.formats.common.text_file import natural, number, read_lines, referred
from bladegen.support.files import safe_stem

__all__ = [
    "INDEX",
    "INDEX_COLUMNS",
    "PUT_BACK",
    "beside",
    "companion",
    "files_of",
    "holds",
    "placed_airfoils",
    "shapes",
    "thick_airfoils",
]

INDEX = "index.csv"
PUT_BACK = "_blade"  # behind a model's name, of the files of a blade that was put into it
INDEX_COLUMNS = ("airfoil", "file", "relative_thickness", "span_fraction")
MAX_FILES = 2000
MAX_NAMES = 10  # that a message lists


@dataclass(frozen=True)
class _Entry:
    """An airfoil of a folder: its name and file, its thickness and place if the index tells."""

    name: str
    path: Path
    thickness: float | None = None
    eta: float | None = None


def companion(path: Path) -> Path:
    """Return the folder for the airfoils of a blade file: one for each file of a blade."""
    return path.with_name(f"{path.stem}_{path.suffix.lstrip('.').lower()}_airfoils")


def beside(path: Path, given: Path | None, notes: Notes) -> Path | None:
    """Return the folder of a blade file's airfoils: the one given, or that beside the file.

    That is ``<stem>_<suffix>_airfoils``, as bladegen writes it (`companion`), the same of
    ``<stem>_blade`` where it put a blade back into a model, or ``airfoils``.
    """
    if given is not None:
        if given.is_dir():
            return given
        notes.problems.append(f"airfoils: {given} is no folder")
        return None
    put_back = companion(path.with_name(f"{path.stem}{PUT_BACK}{path.suffix}"))
    places = [companion(path), path.with_name("airfoils"), path.with_name("Airfoils"), put_back]
    for place in places:
        if place.is_dir():
            return place
    notes.problems.append(
        f"airfoils: this file holds no shapes, and there is no folder {places[0].name} or "
        f"{places[1].name} beside it; name one (--airfoils DIR)"
    )
    return None


def files_of(folder: Path, suffixes: tuple[str, ...] = SUFFIXES) -> list[Path]:
    """Return a folder's files of given suffixes in the order of their names and numbers."""
    try:
        found = [path for path in folder.iterdir() if path.suffix.lower() in suffixes]
    except OSError as error:
        raise FileError(str(folder), [f"cannot be read: {error.strerror}"]) from None
    if len(found) > MAX_FILES:
        raise FileError(str(folder), [f"holds {len(found)} files, allowed are {MAX_FILES}"])
    return sorted((path for path in found if path.name != INDEX and path.is_file()), key=natural)


def holds(folder: Path, name: str) -> bool:
    """Tell whether a folder has a file of an airfoil's name."""
    return any(_plain(path.stem) == _plain(name) for path in files_of(folder))


def shapes(folder: Path, wanted: Iterable[str], notes: Notes) -> dict[str, Airfoil]:
    """Read the airfoils of given names from a folder; what is missing is a problem.

    Names are those of its index, then those of files that the index does not list.
    """
    names = list(dict.fromkeys(wanted))
    entries = {entry.name: entry for entry in _entries(folder, notes)}
    if not set(names) <= set(entries) and (folder / INDEX).is_file():
        listed = {entry.path for entry in entries.values()}
        added = (entry for entry in _by_name(folder, notes) if entry.path not in listed)
        entries = {entry.name: entry for entry in added} | entries
    known = {_plain(name): entry for name, entry in entries.items()}
    found = {}
    for name in names:
        entry = entries.get(name) or known.get(_plain(name)) or known.get(_plain(safe_stem(name)))
        if entry is None:
            there = ", ".join(list(entries)[:MAX_NAMES]) or "none"
            notes.problems.append(
                f"airfoil {name!r}: {folder.name} holds {there}{_other(name, notes)}"
            )
            continue
        made = _airfoil(name, entry, notes)
        if made is not None:
            found[name] = made
    return found


def _other(name: str, notes: Notes) -> str:
    """Say what a file of an airfoil's name holds that is no shape."""
    plain = _plain(name)
    found = [one for one in notes.findings if _plain(Path(one.where).stem) == plain]
    return f"; {found[0].where} {found[0].message}" if found else ""


def thick_airfoils(folder: Path, notes: Notes) -> list[tuple[float, Airfoil]]:
    """Read all airfoils of a folder, each with its relative thickness."""
    found = {}
    for entry in _entries(folder, notes):
        made = None if entry.name in found else _airfoil(entry.name, entry, notes)
        if made is not None:
            own = made.relative_thickness
            found[entry.name] = (thickness(made.coordinates) if own is None else own, made)
    if not found and not notes.problems:
        notes.problems.append(f"airfoils: {folder} holds no airfoil files ({', '.join(SUFFIXES)})")
    return list(found.values())


def placed_airfoils(folder: Path, notes: Notes) -> tuple[Station, ...]:
    """Read the stations that a folder's index tells; none if it does not place all of them."""
    entries = _entries(folder, notes)
    if not all(entry.eta is not None and 0 <= entry.eta <= 1 for entry in entries):
        return ()
    made: dict[str, Airfoil | None] = {}
    for entry in entries:
        if entry.name not in made:
            made[entry.name] = _airfoil(entry.name, entry, notes)
    stations = []
    for entry in entries:
        airfoil_ = made[entry.name]
        if airfoil_ is not None and entry.eta is not None:
            stations.append(Station(entry.eta, airfoil_))
    return tuple(stations)


def _airfoil(name: str, entry: _Entry, notes: Notes) -> Airfoil | None:
    """Read one airfoil's file."""
    file = entry.path.name
    try:
        read = read_contour(entry.path)
    except FileError as error:
        notes.problems += [f"{file}: {problem}" for problem in error.problems]
        return None
    if entry.thickness is not None and not THICKNESS.holds(entry.thickness):
        notes.problems.append(
            f"{INDEX}, {name}, relative_thickness: got {entry.thickness:g}, allowed is {THICKNESS}"
        )
        return None
    if read.reference is not None:
        x, y = read.reference
        said = f"its first point ({x:g}, {y:g}) is what polars are about (NumCoords); not a point"
        notes.findings.append(Finding(file, said))
    return of_file(name, file, read, entry.thickness, notes)


def _entries(folder: Path, notes: Notes) -> list[_Entry]:
    """Return what a folder holds, by its index or by its files' names."""
    index = folder / INDEX
    if not index.is_file():
        return _by_name(folder, notes)
    entries = []
    rows = csv.DictReader(line for line in read_lines(index) if not line.startswith("#"))
    for row in rows:
        name, file, thick, eta = ((row.get(key) or "").strip() for key in INDEX_COLUMNS)
        path = referred(file, [folder])
        if path is None:
            notes.problems.append(
                f"{INDEX}, line {rows.line_num}, file: got {file[:40]!r}, must be a file of "
                f"{folder.name}"
            )
            continue
        entries.append(_Entry(name, path, number(thick), number(eta)))
    return entries


def _by_name(folder: Path, notes: Notes) -> list[_Entry]:
    """Return a folder's shapes by the names of their files; what else it holds is said."""
    found: dict[str, _Entry] = {}
    for path in files_of(folder):
        other = None
        with suppress(FileError):  # what cannot be read is a problem if a blade needs it
            other = tabulates(read_lines(path, most=MAX_BYTES))
        if other is not None:
            said = f"holds {other}, not a shape; passed over"
        elif path.stem in found:
            said = f"is a second file of {path.stem}; {found[path.stem].path.name} is taken"
        else:
            found[path.stem] = _Entry(path.stem, path)
            continue
        notes.findings.append(Finding(path.name, said))
    return list(found.values())


def _plain(name: str) -> str:
    """Return a name without what people write differently: case, blanks, dashes."""
    return "".join(letter for letter in name.lower() if letter.isalnum() or letter == ".")
