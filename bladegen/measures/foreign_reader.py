"""The child process that reads a foreign file: the other end of `foreign.ask`.

It limits itself first, then imports what parses the file, and writes one answer to the pipe that
was its standard output.  What the libraries print goes nowhere.
"""

import os
import resource
import signal
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.errors import BladegenError, FileError
from bladegen.measures.foreign import GRIDS, SOLIDS, Answer, packed

__all__ = ["QUESTIONS", "answer", "main"]

LONGEST = 300  # characters of a library's own message
PARENT_DEATH = 1  # prctl's PR_SET_PDEATHSIG


def main(words: Sequence[str]) -> None:
    """Answer a question about a file, of the words that `foreign.ask` says; never return."""
    what, path, seconds, memory, parent = words
    pipe = os.dup(1)
    null = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(null, stream)
    limit(int(seconds), int(memory), int(parent))
    with os.fdopen(pipe, "wb") as end:
        end.write(packed(answer(what, Path(path))))
    os._exit(0)  # a library's own end may crash, and nothing is left to do


def limit(seconds: int, memory: int, parent: int) -> None:
    """Bound this process: time, memory, no core file, and no life without its parent."""
    for what, most in (
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_CPU, seconds),
        (resource.RLIMIT_AS, memory),
    ):
        _, hard = resource.getrlimit(what)
        allowed = most if hard == resource.RLIM_INFINITY else min(most, hard)
        try:
            resource.setrlimit(what, (allowed, allowed))
        except (ValueError, OSError):  # macOS bounds no address space
            continue
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(PARENT_DEATH, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(1)


def answer(what: str, path: Path) -> Answer:
    """Answer a question; whatever the libraries raise is a problem of the file."""
    try:
        return QUESTIONS[what](path)
    except FileError as error:
        problems = list(error.problems)
    except BladegenError as error:
        problems = [str(error).removeprefix(f"{path}: ")]
    except ImportError as error:
        return Answer({"missing": error.name, "message": str(error)}, {})
    except MemoryError:
        problems = ["takes more memory than it should; it may be damaged"]
    except Exception as error:  # parsers raise whatever they do
        problems = [f"cannot be read: {type(error).__name__}: {_plain(str(error))}"]
    return Answer({"problems": problems}, {})


def _plain(text: str) -> str:
    """Return a library's message as short printable text: it may quote the file."""
    words = " ".join(text.split())[:LONGEST]
    return "".join(letter if letter.isprintable() else "?" for letter in words)


def _loaded(path: Path) -> Any:
    """Read a file as a shape of OCCT or a trimesh.Trimesh."""
    from bladegen.cad import exchange
    from bladegen.surface import mesh_files, vtk_files

    if path.suffix.lower() in SOLIDS:
        return exchange.read(path)
    if path.suffix.lower() == ".vtp":
        return mesh_files.sound(path, *vtk_files.triangles(path))
    return mesh_files.read(path)


def _figures(path: Path) -> Answer:
    """Measure a solid, a mesh or a grid."""
    if path.suffix.lower() in GRIDS:
        from bladegen.measures.blocks import figures, reading

        return Answer(figures.figures_of(reading.read(path)), {})
    from bladegen.measures.file_figures import mesh_figures, solid_figures

    measure = solid_figures if path.suffix.lower() in SOLIDS else mesh_figures
    return Answer(measure(_loaded(path)), {})


def _surface(path: Path) -> Answer:
    """Send faces [m] or triangles, with what a unit is in metres if the file says so."""
    from bladegen.cad import face_patches, shapes

    if path.suffix.lower() in GRIDS:
        return _sheet(path)
    shape = _loaded(path)
    if path.suffix.lower() in SOLIDS:
        bodies, sheets = shapes.bodies(shape)
        arrays, lost = face_patches.faces(bodies)
        return Answer({"metres": 1.0, "lost": lost, "sheets": sheets}, arrays)
    own = METRES.get(str(shape.units)) if path.suffix.lower() == ".3mf" else None
    metres = 1.0 if path.suffix.lower() == ".glb" else own
    arrays = {"vertices": np.asarray(shape.vertices), "faces": np.asarray(shape.faces)}
    return Answer({"metres": metres, "lost": 0, "sheets": 0}, arrays)


def _sheet(path: Path) -> Answer:
    """Send the triangles of a grid, if it is that of a surface."""
    from bladegen.measures.blocks import figures, reading

    blocks = reading.read(path)
    if any(min(points.shape[:3]) > 1 for _, points in blocks):
        raise FileError(str(path), ["is a volume; distances are those of surfaces"])
    vertices, faces = figures.triangles_of(blocks)
    metres = 1.0 if path.suffix.lower() == ".cgns" else None
    found = {"vertices": vertices, "faces": faces}
    return Answer({"metres": metres, "lost": 0, "sheets": 0}, found)


def _points(path: Path) -> Answer:
    """Send the points of a file that has no triangles."""
    import io

    import trimesh

    kind = path.suffix.lower().lstrip(".")
    loaded = trimesh.load(io.BytesIO(path.read_bytes()), file_type=kind, resolver=None)
    return Answer({}, {"points": np.asarray(loaded.vertices, dtype=np.float64)})


METRES = {
    "micron": 1e-6,
    "millimeter": 1e-3,
    "centimeter": 1e-2,
    "inch": 0.0254,
    "foot": 0.3048,
    "meter": 1.0,
}
QUESTIONS: dict[str, Callable[[Path], Answer]] = {
    "figures": _figures,
    "surface": _surface,
    "points": _points,
}
