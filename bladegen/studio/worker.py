"""Writing a state's files, in a process of its own so that sliders stay quick meanwhile.

A job says everything that the process needs; what it is doing it writes into a small
text file, which the page reads while it waits.
"""

from dataclasses import dataclass
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

from bladegen.errors import BladegenError, StudioError, ToleranceError
from bladegen.exports import registry
from bladegen.exports.exporters import aside, write
from bladegen.exports.options import Kind
from bladegen.exports.products import Products
from bladegen.studio.results.question import opened
from bladegen.studio.state import State

__all__ = ["FIRST", "Job", "Made", "formats", "grouped", "load", "make"]

FIRST = (".step", ".stl", ".glb", ".yaml")
ALIAS = "the same as"
GROUPS = {
    Kind.solid: "CAD",
    Kind.curves: "CAD",
    Kind.structure: "CAD",
    Kind.triangles: "Meshes",
    Kind.grid: "CFD grids",
    Kind.volume: "CFD grids",
    Kind.definition: "Aeroelastic and structural tools",
    Kind.shell: "Aeroelastic and structural tools",
    Kind.beam: "Aeroelastic and structural tools",
    Kind.table: "Data",
    Kind.picture: "Pictures",
}


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


def grouped() -> dict[str, dict[str, str]]:
    """Return what can be written by what it is for, then by suffix."""
    known = registry.formats()
    found: dict[str, dict[str, str]] = {title: {} for title in GROUPS.values()}
    for suffix, words in formats().items():
        found[GROUPS[known[suffix].kind]][suffix] = words
    return {title: rows for title, rows in found.items() if rows}


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
    baseline = opened(job.source, job.airfoils, job.state.loft)
    variant = baseline.variant(job.state)
    path = Path(job.folder) / f"{baseline.stem(job.state)}{job.suffix}"
    told(f"making {job.suffix.lstrip('.').upper()}")
    try:
        write(Products(variant, job.state.files.options, told), path)
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


def load() -> None:
    """Import what solids need, before somebody asks for one."""
    import cadquery  # noqa: F401
