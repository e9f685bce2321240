import os
import signal
import subprocess
import sys
import time
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from zipfile import ZipFile

import pytest
from processes import gone_within, running
from test_readers_tables import TABLE, airfoils

from bladegen.errors import StudioError
from bladegen.exports.options import Kind
from bladegen.exports.registry import FORMATS, Format
from bladegen.measures import checks
from bladegen.studio.choices.delivery import Delivery
from bladegen.studio.process import Worker
from bladegen.studio.state import State
from bladegen.studio.worker import GROUPS, Job, formats, grouped, load, make

LONG = 600.0  # s; far more than is needed, for machines that are busy
STUDIO = """
import os, time
from bladegen.studio.process import Worker
from bladegen.studio.worker import load

if __name__ == "__main__":
    print(Worker(load).begin().submit(os.getpid).result(), flush=True)
    time.sleep(3600)
"""
MOVED = State("nrel5mw", (0.03, -0.02, 0.01, 0.005), thickness=1.05)


def test_each_format_is_offered_once_and_solids_first():
    offered = list(formats())
    assert offered[:3] == [".step", ".stl", ".glb"]
    assert set(offered) <= set(FORMATS)
    again = {name for name, row in FORMATS.items() if row.description.startswith("the same as")}
    assert sorted(offered) == sorted(set(FORMATS) - again)


def test_formats_stand_in_groups_of_what_they_are_for():
    assert set(GROUPS) == set(Kind)
    found = grouped()
    assert list(found)[:3] == ["CAD", "Meshes", "CFD grids"]
    assert {suffix for rows in found.values() for suffix in rows} == set(formats())
    assert ".cgns" in found["CFD grids"]
    assert ".htc" in found["Aeroelastic and structural tools"]


def test_a_job_makes_its_file_and_says_what_it_does(tmp_path):
    job = Job("nrel5mw", replace(MOVED, files=Delivery("mm")), ".stl", str(tmp_path))
    made = make(job)
    assert made.path == str(tmp_path / "nrel5mw-variant.stl")
    assert not made.remark
    assert job.told.read_text() == "meshing"
    found = checks.check_file(tmp_path / "nrel5mw-variant.stl")
    assert not found.problems
    assert found.figures["volume"] > 1e10  # mm3


def test_a_format_of_several_files_comes_as_one_archive(tmp_path, monkeypatch):
    def write(products, path):
        path.write_text(products.blade.name)
        (path.parent / "airfoils").mkdir()
        (path.parent / "airfoils" / "a.dat").write_text("1 0")

    monkeypatch.setitem(FORMATS, ".many", Format(Kind.triangles, "several files", write))
    made = make(Job("nrel5mw", MOVED, ".many", str(tmp_path)))
    with ZipFile(made.path) as archive:
        assert sorted(archive.namelist()) == ["airfoils/a.dat", "nrel5mw-variant.many"]
        assert archive.read("nrel5mw-variant.many") == b"nrel5mw-variant"


def test_a_missed_tolerance_is_a_remark(tmp_path, monkeypatch):
    monkeypatch.setattr("bladegen.surface.fitting.MAX_POLES", 1000)
    made = make(Job("nrel5mw", MOVED, ".step", str(tmp_path)))
    assert made.path.endswith("nrel5mw-variant.out-of-tolerance.step")
    assert "off the blade" in made.remark
    assert str(tmp_path) not in made.remark


def test_a_job_takes_shapes_from_a_folder(tmp_path):
    path, folder = tmp_path / "mine.csv", airfoils(tmp_path / "shapes")
    path.write_text(TABLE)
    state = State("mine", (0.0,) * 4, twist=1.0)
    target = tmp_path / "out"
    target.mkdir()
    made = make(Job(str(path), state, ".sections.csv", str(target), str(folder)))
    assert made.path.endswith("mine-variant.sections.csv")
    with pytest.raises(StudioError, match="--airfoils DIR"):
        make(Job(str(path), state, ".sections.csv", str(target)))


def test_a_job_that_cannot_be_done_is_one_error(tmp_path):
    with pytest.raises(StudioError, match="neither a bundled blade nor a file"):
        make(Job("gone.yaml", State("x"), ".stl", str(tmp_path)))


def test_a_process_that_died_is_replaced(tmp_path):
    worker = Worker(load)
    try:
        pool = worker.begin()
        victim = pool.submit(os.getpid).result(timeout=LONG)
        os.kill(victim, signal.SIGKILL)
        with pytest.raises(BrokenProcessPool):
            pool.submit(os.getpid).result(timeout=LONG)
        made = worker.submit(make, Job("nrel5mw", MOVED, ".stl", str(tmp_path))).result(
            timeout=LONG
        )
        assert made.path.endswith(".stl")
        with pytest.raises(StudioError, match="neither a bundled blade"):
            worker.submit(make, Job("gone", MOVED, ".stl", str(tmp_path))).result(timeout=LONG)
        last = worker.begin().submit(os.getpid).result(timeout=LONG)
        worker.begin().submit(time.sleep, 3600)
    finally:
        worker.end()
        worker.end()
    assert gone_within(LONG, [last])


def test_a_process_ends_with_its_killed_studio(tmp_path):
    script = tmp_path / "studio.py"
    script.write_text(STUDIO)
    with subprocess.Popen([sys.executable, script], stdout=subprocess.PIPE) as studio:
        maker = int(studio.stdout.readline())
        assert running(maker)
        studio.kill()
        assert gone_within(LONG, [maker])
        assert studio.stdout.read() == b""  # nobody holds the pipe any more
