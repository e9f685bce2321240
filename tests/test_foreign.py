"""Foreign files are read by a child process: whatever it comes to is a result or one line."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import foreign_fuzzing
import numpy as np
import pytest
from foreign_fuzzing import FORMATS, good
from fuzzing import fuzz
from numpy.testing import assert_allclose

from bladegen.errors import BladegenError, CadError, FileError
from bladegen.measures import checks, foreign, foreign_reader
from bladegen.measures.foreign import Answer, packed, unpacked
from bladegen.surface import mesh_files
from bladegen.views import comparison


@pytest.fixture
def forked(monkeypatch):
    """Children that need not import."""
    monkeypatch.setattr(foreign, "started", foreign_fuzzing.forking)


def written(folder: Path, suffix: str, change=lambda data: data) -> Path:
    path = folder / f"file{suffix}"
    path.write_bytes(change(good(suffix)[0]))
    return path


@pytest.mark.parametrize("suffix", [".step", ".vtp"])
def test_a_real_child_measures_as_this_process_does(suffix, tmp_path):
    path = written(tmp_path, suffix)
    told = foreign.ask("figures", path).facts
    assert told == json.loads(json.dumps(foreign_reader.answer("figures", path).facts))
    assert_allclose(told.get("volume_m3", told.get("volume")), 188.0, rtol=0.05)


@pytest.mark.parametrize("suffix", FORMATS)
def test_surfaces_enclose_what_figures_say(suffix, tmp_path, monkeypatch):
    monkeypatch.setattr(foreign, "ask", foreign_reader.answer)
    path = written(tmp_path, suffix)
    figures = foreign_reader.answer("figures", path).facts
    volume = figures.get("volume_m3", figures.get("volume")) / (1e9 if suffix == ".3mf" else 1.0)
    assert_allclose(comparison.surface_of(path).surface.mesh.volume, volume, rtol=2e-3)


@pytest.mark.parametrize("suffix", FORMATS)
@pytest.mark.parametrize(
    "spoil",
    [lambda d: b"", lambda d: d[:200], lambda d: bytes(range(256)) * 9, lambda d: b"\0" * 500],
    ids=["empty", "head", "binary", "zeros"],
)
def test_what_is_no_such_file_is_refused_in_a_line(suffix, spoil, tmp_path, forked):
    path = written(tmp_path, suffix, spoil)
    with pytest.raises(BladegenError, match=f"file{suffix}: ") as refusal:
        checks.check_file(path)
    assert "\n" not in str(refusal.value)
    assert len(str(refusal.value)) < 700


@pytest.mark.parametrize("count", [6, pytest.param(40, marks=pytest.mark.nightly)])
def test_damaged_files_end_well(count):
    tally = fuzz(foreign_fuzzing.TARGETS, seed=14, count=count)
    assert tally.failures == []
    assert tally.inputs == count
    refused = sum(n for outcome, n in tally.outcomes.items() if "FileError" in outcome)
    assert 0.2 * count < refused < 0.9 * count


@pytest.mark.parametrize(
    ("code", "said"),
    [
        (-signal.SIGSEGV, "it crashed"),
        (-signal.SIGXCPU, "was not read in 7 s of a processor"),
        (-signal.SIGKILL, "want of memory"),
        (3, "ended with 3"),
    ],
)
def test_every_end_of_a_child_is_a_line(code, said, tmp_path, monkeypatch):
    end = f"os.kill(os.getpid(), {-code})" if code < 0 else f"os._exit({code})"
    monkeypatch.setattr(foreign, "CODE", f"import os; os.write(1, b'half'); {end}")
    monkeypatch.setattr(foreign, "SECONDS", 7)
    with pytest.raises(FileError, match=said):
        foreign.ask("figures", written(tmp_path, ".stl"))


def test_a_child_that_hangs_is_ended(tmp_path, monkeypatch):
    started, children = foreign.started, []

    def watched(words):
        children.append(started(words))
        return children[-1]

    monkeypatch.setattr(foreign, "CODE", "import time; time.sleep(3600)")
    monkeypatch.setattr(foreign, "PATIENCE", 0.002)
    monkeypatch.setattr(foreign, "started", watched)
    with pytest.raises(FileError, match="was not read in 0 s on the clock"):
        foreign.ask("figures", written(tmp_path, ".stl"))
    assert children[0].returncode == -signal.SIGKILL


@pytest.mark.parametrize(
    "sent", [b"", b"PK\x03\x04", b"\x93NUMPY\x01\x00", packed(Answer({}, {}))[:-30]]
)
def test_what_a_child_sends_may_be_anything(sent):
    with pytest.raises((ValueError, KeyError, OSError, EOFError, foreign.zipfile.BadZipFile)):
        unpacked(sent)


def test_objects_are_not_unpickled(tmp_path):
    np.savez(tmp_path / "a.npz", facts=np.array([{"a": 1}], dtype=object))
    with pytest.raises(ValueError, match="pickle"):
        unpacked((tmp_path / "a.npz").read_bytes())


def test_a_child_works_within_its_limits_and_ends_with_its_parent(tmp_path):
    code = (
        "import os, resource, sys, time\n"
        "from bladegen.measures.foreign_reader import limit\n"
        "child = os.fork()\n"
        "if child:\n"
        "    time.sleep(1.0)\n"
        "    print(child, flush=True)\n"
        "    os._exit(0)\n"
        "limit(100, 3 * 2**30, os.getppid())\n"
        f"open({str(tmp_path / 'limits')!r}, 'w').write(' '.join(str(resource.getrlimit(r)[0])"
        " for r in (resource.RLIMIT_CORE, resource.RLIMIT_CPU, resource.RLIMIT_AS)))\n"
        "time.sleep(3600)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert (tmp_path / "limits").read_text() == f"0 100 {3 * 2**30}"
    end = time.monotonic() + 600.0
    while Path(f"/proc/{int(done.stdout)}").exists() and time.monotonic() < end:
        time.sleep(0.05)
    assert not Path(f"/proc/{int(done.stdout)}").exists()


def test_an_orphan_does_not_begin():
    code = "from bladegen.measures.foreign_reader import limit; limit(100, 3 * 2**30, 1 << 30)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 1


def raising(error):
    def question(_):
        raise error

    return question


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (FileError("a.stl", ["is odd", "is even"]), ["is odd", "is even"]),
        (CadError("a.stl: no shape"), ["no shape"]),
        (MemoryError(), ["takes more memory than it should; it may be damaged"]),
        (IndexError("\x1b[31mred\n" + 400 * "x"), "cannot be read: IndexError: ?[31mred xxx"),
    ],
)
def test_what_libraries_raise_is_a_problem(error, said, monkeypatch):
    monkeypatch.setitem(foreign_reader.QUESTIONS, "figures", raising(error))
    problems = foreign_reader.answer("figures", Path("a.stl")).facts["problems"]
    if isinstance(said, list):
        assert problems == said
    else:
        assert problems[0].startswith(said)
        assert len(problems[0]) < 400


def test_a_missing_library_is_named_by_the_child_too(tmp_path, monkeypatch):
    error = ImportError("No module named 'OCP'", name="OCP")
    monkeypatch.setitem(foreign_reader.QUESTIONS, "figures", raising(error))
    answer = foreign_reader.answer("figures", Path("a.stl"))
    assert answer.facts["missing"] == "OCP"
    monkeypatch.setattr(foreign, "unpacked", lambda _: answer)
    monkeypatch.setattr(foreign, "started", lambda _: subprocess.Popen(["true"], stdout=-1))
    with pytest.raises(ImportError, match="OCP"):
        foreign.ask("figures", written(tmp_path, ".stl"))


def figures_of(monkeypatch, tmp_path, suffix, **changed):
    path = written(tmp_path, suffix)
    told = dict(foreign_reader.answer("figures", path).facts) | changed
    monkeypatch.setattr(foreign, "ask", lambda *_: Answer(told, {}))
    return checks.check_file(path)


def test_numbers_that_are_none_are_problems(monkeypatch, tmp_path):
    nan, inf = float("nan"), float("inf")
    found = figures_of(
        monkeypatch, tmp_path, ".step", volume_m3=nan, bounds_m=[[0, 0, 0], [1, inf, 1]]
    )
    assert found.figures["volume_m3"] is None
    assert set(found.problems) == {
        "its volume is no finite number",
        "its bounds is no finite number",
    }
    json.dumps(found.figures, allow_nan=False)


def test_a_solid_turned_inside_out_is_a_problem(monkeypatch, tmp_path):
    found = figures_of(monkeypatch, tmp_path, ".step", volume_m3=-1.0)
    assert found.problems == ("encloses no volume",)


def test_files_beyond_all_use_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(foreign, "LARGEST", 100)
    with pytest.raises(FileError, match="bytes, allowed are 100"):
        foreign.kind_of(written(tmp_path, ".stl"))
    os.mkfifo(tmp_path / "pipe.stl")
    with pytest.raises(FileError, match="is no file"):
        foreign.kind_of(tmp_path / "pipe.stl")


@pytest.mark.parametrize(
    ("vertices", "faces", "said"),
    [
        ([[0, 0, 0]], [[0, 1, 0]], "names vertex 1, allowed are 0 to 0"),
        ([[0, 0, 0]], [[0, -1, 0]], "names vertex -1"),
        ([[0, 0, np.nan]] * 3, [[0, 1, 2]], "no numbers"),
        ([[0, 0, 1e30]] * 3, [[0, 1, 2]], "farther away"),
        ([[0, 0, 0]], np.zeros((0, 3), int), "no triangles"),
    ],
)
def test_triangles_of_a_file_are_looked_at(vertices, faces, said):
    with pytest.raises(FileError, match=said):
        mesh_files.sound(Path("a.ply"), np.array(vertices, float), np.array(faces))


def test_no_file_beside_a_mesh_is_opened(tmp_path, monkeypatch):
    path = tmp_path / "a.obj"
    path.write_text(f"mtllib {tmp_path}/secret\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    os.mkfifo(tmp_path / "secret")  # who opens it waits for ever
    assert len(mesh_files.read(path).faces) == 1


def test_triangles_of_a_plane_are_refused(tmp_path, forked):
    """A wavefront file whose vertices have lost a coordinate, as an editor may leave it."""
    path = tmp_path / "flat.obj"
    path.write_text("v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n")
    with pytest.raises(FileError, match="points of 2 coordinates, 3 are needed"):
        comparison.surface_of(path)
