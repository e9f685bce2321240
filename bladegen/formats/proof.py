"""What is written is read back and compared before it gets its name.

Files are written into a folder of their own beside the target, with what lies there already under
the target's names, and read again.  What cannot be read never gets its name; what comes back as
another blade by more than its format's tolerance is a finding with figures.
"""

import os
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.definition.blade_definition import BladeDefinition, united
from bladegen.definition.thickness import ruled
from bladegen.errors import BladegenError, ExportError, FileError, Finding
from bladegen.formats.reading import read
from bladegen.support.arrays import Array
from bladegen.support.files import unwritable

__all__ = [
    "Marking",
    "compared",
    "marked",
    "proven",
    "put_in_place",
    "read_back",
    "taken_back",
    "unmarked",
]

LANDMARKS = 201
SPANS = 16  # at which sections are compared, besides the middles between stations
MOST_SPANS = 60
THIN = 4  # of the landmarks of the one blade, each is held against the other's section
ANGLE = 1e-6  # rad; by more a twist may not be off without a word, beyond the format's tolerance
Writing = Callable[[Path], tuple[Finding, ...]]
Marking = Callable[[Iterable[Path]], None]  # gives files that are whole what they say of their make


def unmarked(_: Iterable[Path]) -> None:
    """Leave files as they were written."""


def proven(
    write: Writing,
    path: Path,
    definition: BladeDefinition,
    tolerance: float,
    mark: Marking = unmarked,
) -> tuple[Finding, ...]:
    """Write a blade, read it back, compare, and only then give the files their names.

    Parameters
    ----------
    write : callable
        Writes the main file to a path, and its others beside it.
    path : Path
        The main file.
    definition : BladeDefinition
        What the files shall hold.
    tolerance : float
        By which the format may be off [m].
    mark : callable
        Marks the files that were written, before they are read back.

    Returns
    -------
    tuple of Finding
        What `write` returned, and how far off the blade came back if that is too far.

    Raises
    ------
    ExportError
        If the files cannot be written, or read back.
    """
    with put_in_place(path) as draft:
        said = marked(write, draft, mark)
        return said + read_back(draft, path, definition, tolerance)


def marked(write: Writing, path: Path, mark: Marking) -> tuple[Finding, ...]:
    """Write a file and others beside it, and mark those that are new; return what `write` does."""
    before = _beside(path)
    said = write(path)
    after = _beside(path)
    mark(file for file in after if after[file] != before.get(file))
    return said


def read_back(
    draft: Path,
    path: Path,
    definition: BladeDefinition,
    tolerance: float,
    whole: Path | None = None,
) -> tuple[Finding, ...]:
    """Read what was written to `draft` and compare.

    Raises
    ------
    ExportError
        If it cannot be read: then there is to be no `path`.  What was wrong in the file `whole`
        that the blade was put into is told apart.
    """
    try:
        again = read(draft)
    except FileError as error:
        said = "; ".join(error.problems)
        known = _problems(whole) if whole is not None else ()
        if known and set(error.problems) <= set(known):
            why = f"{whole} cannot be read itself, apart from its blade: {said}; mend it first"
        else:
            why = f"it could not be read back: {said}"
        raise ExportError(f"{path}: not written, for {why}") from None
    return compared(definition, again, tolerance)


def _problems(path: Path) -> tuple[str, ...]:
    try:
        read(path)
    except FileError as error:
        return error.problems
    return ()


@contextmanager
def taken_back(path: Path) -> Iterator[None]:
    """Put `path` and the files beside it back as they were if there is an error within."""
    home, own = path.parent, _literal(path.stem)

    def there() -> list[Path]:
        return [path] * path.is_file() + sorted(home.glob(f"{own}_*"))

    try:
        kept = Path(tempfile.mkdtemp(prefix=f".{path.stem}.", dir=home))
    except OSError as error:
        raise unwritable(path, error) from None
    try:
        for entry in there():
            _copied(entry, kept / entry.name, shutil.copy2)
        yield
    except BladegenError:
        before = _files(kept)
        for entry in there():
            inner = list(entry.iterdir()) if entry.is_dir() else [entry]
            for file in inner:
                if file.is_file() and file.relative_to(home) not in before:
                    file.unlink()
        for file in before:
            (kept / file).replace(home / file)
        raise
    finally:
        shutil.rmtree(kept, ignore_errors=True)


def compared(
    wanted: BladeDefinition, got: BladeDefinition, tolerance: float
) -> tuple[Finding, ...]:
    """Say in figures how far a blade that was read back is off, if by more than `tolerance` [m]."""
    found: list[str] = []
    etas = [station.eta for station in wanted.stations]
    grid = united(np.linspace(0.0, 1.0, 201), etas, wanted.chord.grid, wanted.twist.grid)
    chord = np.abs(got.chord(grid) - wanted.chord(grid))
    twist = np.abs(got.twist(grid) - wanted.twist(grid))
    if chord.max() > tolerance:
        found.append(f"chord by up to {_shown(chord.max())} at eta = {grid[chord.argmax()]:.4f}")
    if twist.max() > ANGLE + tolerance / float(wanted.chord.values.max()):
        worst = np.degrees(twist.max())
        found.append(f"twist by up to {worst:.2g} deg at eta = {grid[twist.argmax()]:.4f}")
    middles = 0.5 * (np.array(etas[1:]) + np.array(etas[:-1]))
    spans = united(np.linspace(0.0, 1.0, SPANS), middles[:: 1 + len(middles) // MOST_SPANS])
    try:
        apart = sections_apart(wanted, got, spans)
    except BladegenError as error:
        found.append(f"its sections could not be compared ({error})")
    else:
        if apart.max() > tolerance:
            where = spans[apart.argmax()]
            found.append(f"sections by up to {_shown(apart.max())} at eta = {where:.4f}")
    return tuple(Finding("read back", f"differs: {said}") for said in found)


def sections_apart(one: BladeDefinition, other: BladeDefinition, eta: Array) -> Array:
    """Return how far the sections of two blades lie apart at span fractions (k,) [m]."""
    first, second = (
        Blade.from_definition(ruled(each), landmarks=LANDMARKS, fairing=None).sections(eta)
        for each in (one, other)
    )
    return np.array([_from_polyline(a, b[::THIN]) for a, b in zip(first, second, strict=True)])


def _from_polyline(line: Array, points: Array) -> float:
    """Return the largest distance of points (m, 3) from a polyline (n, 3)."""
    start, along = line[:-1], np.diff(line, axis=0)
    square = np.maximum(np.sum(along**2, axis=-1), np.finfo(float).tiny)
    to = points[:, None] - start
    at = np.clip(np.einsum("mnk,nk->mn", to, along) / square, 0.0, 1.0)
    off = to - at[..., None] * along
    return float(np.sqrt(np.min(np.einsum("mnk,mnk->mn", off, off), axis=1).max()))


def _shown(length: float) -> str:
    return f"{1e3 * length:.2g} mm" if length >= 1e-5 else f"{1e6 * length:.2g} um"


@contextmanager
def put_in_place(path: Path) -> Iterator[Path]:
    """Give a path in a folder of its own beside `path`; put what is there in place if all is well.

    That folder holds the files that a format keeps beside `path`, under names that begin with its
    stem, so that what is taken away there is taken away beside `path` too.

    Raises
    ------
    ExportError
        If the folder is missing or cannot be written.
    """
    home = path.parent
    try:
        outer = Path(tempfile.mkdtemp(prefix=f".{path.stem}.", dir=home))
    except OSError as error:
        raise unwritable(path, error) from None
    stage = outer / (home.resolve().name or "stage")  # models tell their folders by name
    try:
        stage.mkdir()
        for entry in sorted(home.glob(f"{_literal(path.stem)}_*")):
            _copied(entry, stage / entry.name, _link)
        before = _files(stage)
        yield stage / path.name
        _moved(stage, home, before, last=path.name)
    except ExportError as error:
        raise ExportError(str(error).replace(f"{stage}{os.sep}", f"{home / '_'}"[:-1])) from None
    except OSError as error:
        raise unwritable(path, error) from None
    finally:
        shutil.rmtree(outer, ignore_errors=True)


def _literal(name: str) -> str:
    """Return a name as a pattern of glob that means itself."""
    return "".join(f"[{letter}]" if letter in "*?[" else letter for letter in name)


def _copied(entry: Path, copy: Path, way: Callable[[Path, Path], object]) -> None:
    """Copy a file, or a folder's files, in some way; deeper folders are nothing that we write."""
    if entry.is_symlink():
        return
    if entry.is_dir():
        copy.mkdir()
        for inner in entry.iterdir():
            if inner.is_file():
                _copied(inner, copy / inner.name, way)
    elif entry.is_file():
        way(entry, copy)


def _link(entry: Path, copy: Path) -> None:
    """Link a file, which stays as it is: whoever writes one anew writes another and renames it."""
    try:
        copy.hardlink_to(entry)
    except OSError:  # a file system without links
        shutil.copy2(entry, copy)


def _files(folder: Path) -> dict[Path, tuple[int, int]]:
    """Return a folder's files, and what changes when one is written anew."""
    return {file.relative_to(folder): _state(file) for file in folder.rglob("*") if file.is_file()}


def _beside(path: Path) -> dict[Path, tuple[int, int]]:
    """Return a file and those that formats keep beside it, and what changes when one is new."""
    if path.is_dir():
        return {path / file: state for file, state in _files(path).items()}
    entries = [path, *sorted(path.parent.glob(f"{_literal(path.stem)}_*"))]
    inner = [e for entry in entries for e in (entry.iterdir() if entry.is_dir() else [entry])]
    return {file: _state(file) for file in inner if file.is_file()}


def _state(file: Path) -> tuple[int, int]:
    """Return what changes when a file is written anew."""
    return file.stat().st_ino, file.stat().st_mtime_ns


def _moved(stage: Path, home: Path, before: dict[Path, tuple[int, int]], last: str) -> None:
    """Move what is new in `stage` to `home`, the main file last; take away what is gone there."""
    after = _files(stage)
    for file in sorted(after, key=lambda file: (file == Path(last), file)):
        if after[file] != before.get(file):
            (home / file).parent.mkdir(exist_ok=True)
            (stage / file).replace(home / file)
    for file in before.keys() - after.keys():
        (home / file).unlink(missing_ok=True)
