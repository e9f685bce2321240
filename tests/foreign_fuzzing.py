"""Targets of the fuzzer that are parsed by libraries in C++: CAD and mesh files of every kind.

The child that reads a foreign file is a fork of the fuzzer's worker here, which has loaded the
libraries already: the same limits, the same code, a hundred times as many inputs.  What crashes,
hangs or hungers there must be a line here.
"""

import io
import json
import math
import os
import socket
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from functools import cache, partial
from pathlib import Path
from random import Random
from typing import Any

import mutators
import numpy as np
from fuzzing import Files, Target

import bladegen as bg
from bladegen.errors import FileError
from bladegen.measures import checks, foreign, foreign_reader, surfaces
from bladegen.views import comparison

SECONDS = 20  # of a processor for one input
FORMATS = (".step", ".iges", ".brep", ".stl", ".glb", ".ply", ".obj", ".3mf", ".vtp", ".off")
LIBRARIES = (
    "OCP",
    "trimesh",
    "networkx",
    "lxml.etree",
    "vtkmodules.vtkIOXML",
    "bladegen.measures.checks",
)


class Forked:
    """A fork of the zygote that answers as `foreign.started`'s child does."""

    def __init__(self, zygote: socket.socket, words: Sequence[str]) -> None:
        ours, theirs = os.pipe()
        socket.send_fds(zygote, [json.dumps(list(words)).encode()], [theirs])
        os.close(theirs)
        self.zygote, self.pid = zygote, int(zygote.recv(100))
        self.stdout = os.fdopen(ours, "rb", buffering=0)

    def kill(self) -> None:
        os.kill(self.pid, 9)

    def wait(self) -> int:
        self.zygote.send(b"wait")
        return int(self.zygote.recv(100))


def forking(words: Sequence[str]) -> Forked:
    """Start a child that needs no import: in place of `foreign.started`."""
    return Forked(_zygote(), [*words[:2], str(min(int(words[2]), SECONDS)), words[3]])


@cache
def _zygote() -> socket.socket:
    """Start a process of one thread that forks a child for each request."""
    ours, theirs = socket.socketpair()
    code = f"import sys; sys.path[:] = {sys.path!r}; import foreign_fuzzing as f; "
    code += f"f.serve({theirs.fileno()})"
    subprocess.Popen([sys.executable, "-c", code], pass_fds=[theirs.fileno()])
    theirs.close()
    return ours


def serve(handle: int) -> None:
    """Be the zygote, until its socket closes."""
    for name in LIBRARIES:
        __import__(name)
    asking = socket.socket(fileno=handle)
    while True:
        message, handles, *_ = socket.recv_fds(asking, 1 << 20, 1)
        if not message:
            return
        child = os.fork()
        if not child:
            os.dup2(handles[0], 1)
            os.closerange(3, 64)
            foreign_reader.main([*json.loads(message), str(os.getppid())])
        os.close(handles[0])
        asking.send(str(child).encode())
        asking.recv(10)
        asking.send(str(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])).encode())


@cache
def good(suffix: str) -> tuple[bytes, ...]:
    """Files of a kind: a small blade, and for CAD files a body of trimmed and curved faces too."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"blade{suffix}"
        blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=21)
        if suffix == ".off":
            from bladegen.surface import mesh, mesh_files

            mesh_files.to_trimesh(mesh.from_blade(blade, stations=14)).export(path)
            return (path.read_bytes(),)
        bg.export(
            blade, path, **({"sections": 14} if suffix in foreign.SOLIDS else {"stations": 14})
        )
        if suffix not in foreign.SOLIDS:
            return (path.read_bytes(),)
        other = Path(folder) / f"other{suffix}"
        _body(other)
        return (path.read_bytes(), other.read_bytes())


def _body(path: Path) -> None:
    """Write a box with a hole, a dome and a rounded edge: planes, cylinders, a sphere, a torus."""
    import cadquery

    box = cadquery.Workplane().box(2000, 1000, 500).edges("|Z").fillet(100)
    body = box.faces(">Z").workplane().hole(300).union(cadquery.Workplane().sphere(400))
    kinds = {".step": "STEP", ".brep": "BREP"}
    if path.suffix in kinds:
        cadquery.exporters.export(body, str(path), kinds[path.suffix])
        return
    from OCP.IGESControl import IGESControl_Writer

    writer = IGESControl_Writer("MM", 1)
    writer.AddShape(body.val().wrapped)
    stream = io.BytesIO()
    writer.Write(stream)
    path.write_bytes(stream.getvalue())


def changed(suffix: str, rng: Random) -> Files:
    """A good file with bytes, words or members changed, cut out or doubled."""
    files = good(suffix)
    data, kind = rng.choice(files), rng.random()
    if suffix == ".3mf" and kind < 0.8:
        data = mutators.packed(rng, data)
    elif suffix in {".stl", ".glb", ".ply"} or kind < 0.3:
        data = spoilt(rng, data)
    elif kind < 0.7:
        data = mutators.words(rng, data)
    else:
        data = mutators.text(rng, data, rng.choice(files))
    if rng.random() < 0.03:
        suffix = rng.choice(FORMATS)  # what it is not
    return {f"file{suffix}": data}


def spoilt(rng: Random, good: bytes) -> bytes:
    """Change single bytes, cut, double, or put numbers of four bytes into a binary file."""
    data = bytearray(good)
    for _ in range(rng.choice((1, 1, 1, 2, 5, 40))):
        i = rng.randrange(max(1, len(data)))
        if rng.random() < 0.3:
            i = min(i, rng.randrange(1, 200))  # heads matter
        kind, reach = rng.randrange(6), rng.choice((1, 4, 60, 2000))
        if kind < 2:
            data[i : i + 1] = bytes([rng.randrange(256)])
        elif kind == 2:
            del data[i : i + reach]
        elif kind == 3:
            data[i:i] = data[i : i + reach]
        elif kind == 4:
            number = rng.choice((math.nan, math.inf, 1e38, -1.0, 0.0, 1e-40))
            data[i : i + 4] = np.float32(number).tobytes()
        else:
            number = rng.choice((-1, 0, 1, 2**31 - 1, -(2**31), 2**24))
            data[i : i + 4] = np.int32(number).tobytes()
    if rng.random() < 0.1:
        del data[rng.randrange(max(1, len(data))) :]
    return bytes(data)


def answer_file(path: Path, _: Path, rng: Random) -> str:
    """Check a file by itself, or against a box."""
    foreign.started = forking
    try:
        if rng.random() < 0.6:
            check = checks.check_file(path)
            return "sound" if not check.problems else "a problem"
        return _compared(path)
    except FileError as error:
        return next(
            (f"FileError, {word}" for word in ("crashed", "processor") if word in str(error)),
            "FileError",
        )


def _compared(path: Path) -> str:
    found = comparison.compared(comparison.surface_of(path), _plate())
    figures: list[Any] = [*found.figures.values(), *(v for b in found.bands() for v in b.values())]
    if not all(math.isfinite(value) for value in figures):
        raise ArithmeticError("a distance is NaN or infinite")
    return "compared"


@cache
def _plate() -> comparison.Side:
    """A box of a blade's size."""
    import trimesh

    from bladegen.surface.mesh import TriangleMesh

    box = trimesh.creation.box((2.0, 3.0, 60.0))
    return comparison.Side("box", surfaces.of_mesh(TriangleMesh(box.vertices, box.faces)))


TARGETS = tuple(
    Target(f"{suffix[1:].upper()} file", partial(changed, suffix), answer_file, share)
    for suffix, share in zip(FORMATS, (4, 5, 3, 2, 4, 2, 2, 2, 2, 1), strict=True)
)
