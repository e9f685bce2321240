"""Files that others wrote, read by a process of its own: what it cannot do is one line.

The libraries that parse CAD and mesh files crash, hang or eat memory on damaged ones.  So a child
process (`foreign_reader`) reads a file and sends back plain arrays and JSON; its memory and time
are limited, it ends with its parent, and what it prints is dropped.  Whatever happens there is a
result here, or a `FileError`.
"""

import io
import json
import os
import select
import signal
import subprocess
import sys
import time
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.errors import FileError
from bladegen.support.files import beside

__all__ = ["GRIDS", "MESHES", "SOLIDS", "Answer", "ask", "kind_of"]

GRIDS = (".p3d", ".fmt", ".cgns")
SOLIDS = (".step", ".stp", ".iges", ".igs", ".brep")
MESHES = (".stl", ".glb", ".ply", ".obj", ".3mf", ".off", ".vtp")
LARGEST = 2 * 10**9  # bytes of a file
SECONDS, SECONDS_A_BYTE = 90, 5e-6  # of a processor; a bundled blade's STEP file takes 4 s
MEMORY, MEMORY_A_BYTE = 4 * 2**30, 40  # bytes; the libraries alone take 0.9 GB of addresses
PATIENCE = 5.0  # s on the clock for each second of a processor: other programs run too
ANSWER = 4 * 10**9  # bytes that a child may send
GRIP = 1 << 20  # bytes taken from the child at a time
CODE = "import json, sys; sys.path[:] = json.loads(sys.argv[1]); \
from bladegen.measures.foreign_reader import main; main(sys.argv[2:])"


@dataclass(frozen=True, eq=False)
class Answer:
    """What a child made of a file.

    Parameters
    ----------
    facts : dict
        Figures and names, as JSON holds them.
    arrays : dict
        Arrays by name.
    """

    facts: dict[str, Any]
    arrays: Mapping[str, Any]


def kind_of(path: Path) -> str:
    """Return "solid", "mesh" or "grid" by a file's suffix.

    Raises
    ------
    FileError
        If it is none of them, no regular file, or too large.
    """
    suffix = path.suffix.lower()
    if suffix not in SOLIDS + MESHES + GRIDS:
        allowed = ", ".join(SOLIDS + MESHES + GRIDS)
        foam = path.name.lower().endswith(".foam.zip")
        hint = "; unpack it, and OpenFOAM's checkMesh runs there" if foam else ""
        raise FileError(str(path), [f"suffix {suffix!r}, allowed are {allowed}{hint}"])
    if not path.is_file():
        raise FileError(str(path), [f"is no file{beside(path, SOLIDS + MESHES + GRIDS)}"])
    size = path.stat().st_size
    if size > LARGEST:
        raise FileError(str(path), [f"has {size} bytes, allowed are {LARGEST}"])
    return "solid" if suffix in SOLIDS else "mesh" if suffix in MESHES else "grid"


def ask(what: str, path: Path) -> Answer:
    """Have a child answer a question about a file.

    Parameters
    ----------
    what : str
        A question of `foreign_reader.QUESTIONS`: "figures", "surface" or "points".
    path : Path
        A CAD or mesh file that anyone made.

    Returns
    -------
    Answer
        Finite or not: who asks looks at the numbers.

    Raises
    ------
    FileError
        If the file is of no known kind, or cannot be read: by whatever end the child came to.
    ImportError
        If the library that reads the kind is missing.
    """
    kind = kind_of(path)
    library = {"solid": "OCP", "mesh": "trimesh"}.get(kind, "h5py")
    if find_spec(library) is None:
        raise ImportError(f"No module named {library!r}", name=library)
    size = path.stat().st_size
    seconds, memory = SECONDS + SECONDS_A_BYTE * size, MEMORY + MEMORY_A_BYTE * size
    words = [what, str(path), str(int(seconds)), str(int(memory)), str(os.getpid())]
    child = started(words)
    try:
        sent = _sent(child, PATIENCE * seconds)
    finally:
        child.kill()
        code = child.wait()
    if sent is None:
        raise FileError(str(path), [_late(PATIENCE * seconds, "on the clock")])
    try:
        answer = unpacked(sent)
    except (ValueError, KeyError, OSError, EOFError, zipfile.BadZipFile):
        raise FileError(str(path), [_end(code, seconds)]) from None
    if "missing" in answer.facts:
        raise ImportError(answer.facts["message"], name=answer.facts["missing"])
    if "problems" in answer.facts:
        raise FileError(str(path), answer.facts["problems"])
    return answer


def started(words: Sequence[str]) -> "subprocess.Popen[bytes]":
    """Start the child, with the paths on which this process finds its modules."""
    # -P: a folder in which one works must not lend the child its modules
    command = [sys.executable, "-P", "-c", CODE, json.dumps(sys.path), *words]
    null = subprocess.DEVNULL
    return subprocess.Popen(command, stdin=null, stdout=subprocess.PIPE, stderr=null)


def packed(answer: Answer) -> bytes:
    """Return an answer as the bytes of an npz file."""
    stream = io.BytesIO()
    facts = np.frombuffer(json.dumps(answer.facts).encode(), dtype=np.uint8)
    np.savez(stream, allow_pickle=False, facts=facts, **answer.arrays)
    return stream.getvalue()


def unpacked(sent: bytes) -> Answer:
    """Return the answer that bytes hold, which may be anything: nothing of it is evaluated."""
    with np.load(io.BytesIO(sent), allow_pickle=False) as archive:
        arrays = {name: archive[name] for name in archive.files}
    return Answer(json.loads(arrays.pop("facts").tobytes()), arrays)


def _sent(child: "subprocess.Popen[bytes]", seconds: float) -> bytes | None:
    """Return what a child writes until it closes its pipe, None if it takes longer than that."""
    parts: list[bytes] = []
    end, total = time.monotonic() + seconds, 0
    with child.stdout or io.BytesIO() as pipe:
        while (left := end - time.monotonic()) > 0 and select.select([pipe], [], [], left)[0]:
            part = os.read(pipe.fileno(), GRIP)
            total += len(part)
            if not part or total > ANSWER:
                return b"".join(parts)
            parts.append(part)
    return None


def _end(code: int, seconds: float) -> str:
    """Say how a child ended that sent nothing of use."""
    if code == -signal.SIGXCPU:
        return _late(seconds, "of a processor")
    if code == -signal.SIGKILL:
        return "was not read: the process was killed, perhaps for want of memory"
    if code < 0:
        name = signal.strsignal(-code) or f"signal {-code}"
        return f"is damaged, or holds what the library cannot read: it crashed ({name.lower()})"
    return f"was not read: the process that reads it ended with {code}"


def _late(seconds: float, where: str) -> str:
    return f"was not read in {seconds:.0f} s {where}; it may be damaged"
