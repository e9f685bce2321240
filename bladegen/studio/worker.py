"""Writing a state's files in a process of its own, so that sliders stay quick meanwhile.

A job says everything that the other process needs; what it is doing it writes into a small
text file, which the page reads while it waits.
"""

import os
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from functools import lru_cache
from multiprocessing import active_children, get_context
from multiprocessing.process import BaseProcess
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

from bladegen.errors import BladegenError, StudioError, ToleranceError
from bladegen.exports import registry
from bladegen.exports.exporters import aside, write
from bladegen.exports.options import Options
from bladegen.exports.products import Products
from bladegen.formats.reading import read
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.studio.loft import Loft
from bladegen.studio.model import Baseline
from bladegen.studio.state import State

__all__ = ["FIRST", "Job", "Made", "Worker", "formats", "make"]

FIRST = (".step", ".stl", ".glb", ".yaml")
ALIAS = "the same as"


@dataclass(frozen=True)
class Job:
    """A file to write.

    Parameters
    ----------
    source : str
        The blade, as `bladegen.read` takes it.
    state : State
        What is changed of it.
    suffix : str
        The format.
    folder : str
        Where to.
    airfoils : str, optional
        The folder of the blade's airfoil files, as `bladegen.read` takes it.
    """

    source: str
    state: State
    suffix: str
    folder: str
    airfoils: str | None = None

    @property
    def told(self) -> Path:
        """The text file that says what is being done."""
        return Path(self.folder) / "progress.txt"


@dataclass(frozen=True)
class Made:
    """A file that was written, and what is odd about it; "" if nothing is."""

    path: str
    remark: str = ""


def formats() -> dict[str, str]:
    """Return what can be written, by suffix: the usual ones first, each format once."""
    rows = registry.formats().items()
    known = {s: row.description for s, row in rows if not row.description.startswith(ALIAS)}
    order = [s for s in FIRST if s in known] + [s for s in known if s not in FIRST]
    return {suffix: known[suffix] for suffix in order}


def make(job: Job) -> Made:
    """Write a job's file.

    Raises
    ------
    StudioError
        If the state's blade is not sound, or its file cannot be made.
    """
    try:
        return _made(job)
    except BladegenError as error:  # of which not all can travel between processes
        raise StudioError(str(error)) from None


def _made(job: Job) -> Made:
    def told(message: str) -> None:
        job.told.write_text(message, encoding="utf-8")

    told("reading the blade")
    baseline = _baseline(job.source, job.airfoils, job.state.loft)
    variant = baseline.variant(job.state)
    path = Path(job.folder) / f"{baseline.stem(job.state)}{job.suffix}"
    told(f"making {job.suffix.lstrip('.').upper()}")
    try:
        write(Products(variant, Options(), told), path)
    except ToleranceError as error:
        return Made(str(aside(path)), str(error).replace(str(path), path.name))
    return Made(str(_together(path, job)))


def _together(path: Path, job: Job) -> Path:
    """Return a job's file, or an archive where its format writes others beside it."""
    made = [p for p in sorted(path.parent.rglob("*")) if p.is_file() and p != job.told]
    if made == [path]:
        return path
    archive = path.with_name(f"{path.name}.zip")
    with ZipFile(archive, "w", ZIP_DEFLATED) as target:
        for file in made:
            target.write(file, file.relative_to(path.parent))
    return archive


@lru_cache(2)
def _baseline(source: str, airfoils: str | None, loft: Loft) -> Baseline:
    """Return a blade; what lies under a source in a studio's folder never changes."""
    definition = read(source, airfoils=airfoils)
    return Baseline(source, loft.blade(definition), ShapeSpace.bundled())


class Worker:
    """One process that makes files, started when it is first needed."""

    def __init__(self) -> None:
        self._pool: ProcessPoolExecutor | None = None
        self._processes: set[BaseProcess] = set()

    def begin(self) -> ProcessPoolExecutor:
        """Start the process, if it is not there, and let it load what it will need."""
        if self._pool is None:
            others = set(active_children())
            self._pool = ProcessPoolExecutor(1, mp_context=get_context("spawn"))
            self._pool.submit(_load, os.getpid())
            self._processes = set(active_children()) - others
        return self._pool

    def submit(self, job: Job) -> "Future[Made]":
        """Queue a job; a process that has died is replaced."""
        try:
            return self.begin().submit(make, job)
        except BrokenProcessPool:
            self.end()
            return self.begin().submit(make, job)

    def end(self) -> None:
        """Stop the process, whatever it is making: nobody waits for it any more."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)
            self._pool = None
        for process in self._processes:
            process.terminate()
        self._processes = set()


def _load(parent: int) -> None:
    """Import what is slow to import; leave the other processors to the page."""
    from bladegen.support.workers import end_with

    end_with(parent)
    import cadquery  # noqa: F401
    from threadpoolctl import threadpool_limits

    threadpool_limits(1)
