"""The same request makes the same bytes: in other processes, with other threads and hash seeds."""

import hashlib
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

FORMATS = ("stl", "glb", "ply", "obj", "3mf", "vtp", "brep", "iges", "step", "structure.step")
RUN = """
import os, sys
from bladegen.cli.commands import app
folder, formats, jobs, later = sys.argv[1], sys.argv[2].split(","), sys.argv[3], sys.argv[4:]
coarse = ["--stations", "40", "--tolerance", "5mm"]
asked = [word for suffix in formats for word in ("--format", suffix)]
def run(*words):
    app(list(words), standalone_mode=False)
def blade(folder):
    run("perturb", "nrel5mw", "--thickness", "1.1", "-o", folder + "/blade", *asked, *coarse,
        "--landmarks", "51")
    run("space", "build", "-o", folder + "/space.npz", "--count", "10", "--landmarks", "101")
def files(folder):
    blade(folder)
    run("family", "nrel5mw", "-o", folder + "/files", "--count", "1", "--seed", "3",
        "--spans", "20", "--format", "step", "--format", "stl", *coarse)
files(folder)
run("family", "dtu10mw", "-o", folder + "/family", "--count", "70", "--seed", "3",
    "--spans", "12", "--jobs", jobs)
del os.environ["SOURCE_DATE_EPOCH"]
for folder in later:
    blade(folder)
"""
LAST = ".report.json"  # holds times by design


def made(folder: Path, *later: Path, threads: int, seed: str, jobs: int) -> Any:
    """Run the commands in a process of its own; in later folders, the first at their own time."""
    environment = os.environ | {"PYTHONHASHSEED": seed, "COLUMNS": "80"}
    environment |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), str(threads))
    environment["SOURCE_DATE_EPOCH"] = "1700000000"
    return subprocess.Popen(
        [sys.executable, "-c", RUN, str(folder), ",".join(FORMATS), str(jobs), *map(str, later)],
        env=environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.fixture(scope="module")
def runs(tmp_path_factory) -> list[dict[str, bytes]]:
    """Files of three runs by name: two with a fixed time, the last at its own time.

    The last is made by the first's process: that processes differ in nothing show the others.
    """
    folders = [tmp_path_factory.mktemp(name) for name in ("one", "two", "three")]
    one, two, three = folders
    processes = [
        made(one, three, threads=1, seed="1", jobs=1),
        made(two, threads=2, seed="2", jobs=2),
    ]
    for process in processes:
        _, err = process.communicate(timeout=3600)
        assert process.returncode == 0, err
    return [
        {
            str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*"))
            if path.is_file()
        }
        for folder in folders
    ]


def differing(one: dict[str, bytes], two: dict[str, bytes]) -> list[str]:
    assert one.keys() == two.keys()
    return [name for name in one if one[name] != two[name]]


def test_meshes_solids_and_manifests_are_the_same(runs):
    changing = [name for name in differing(runs[0], runs[1]) if not name.endswith(LAST)]
    assert changing == []
    assert {f"blade/nrel5mw-perturbed.{suffix}" for suffix in FORMATS} <= runs[0].keys()
    assert "family/manifest.parquet" in runs[0]


def test_without_a_fixed_time_only_time_stamps_differ(runs):
    others = {name: runs[0][name] for name in runs[2]}
    changing = [name for name in differing(others, runs[2]) if not name.endswith(LAST)]
    timed = ("iges", "step", "structure.step")
    assert changing == [f"blade/nrel5mw-perturbed.{suffix}" for suffix in timed]
    stamp = re.compile(rb"20\d\d-\d\d-\d\dT\d\d:\d\d:\d\d|\d+H(20)?\d{6}\.\d{6}")
    for name in changing:
        assert stamp.sub(b"", runs[0][name]) == stamp.sub(b"", runs[2][name])
        assert len(stamp.findall(runs[0][name])) >= 1


def test_reports_differ_in_seconds_alone(runs):
    (name,) = [name for name in runs[0] if name.endswith(LAST)]
    one, two = (json.loads(run[name]) for run in runs[:2])
    assert one.pop("seconds").keys() == two.pop("seconds").keys()
    assert one == two


def test_the_report_names_the_files_as_they_are(runs):
    (name,) = [name for name in runs[0] if name.endswith(LAST)]
    for entry in json.loads(runs[0][name])["files"]:
        content = runs[0][f"blade/{entry['name']}"]
        assert entry["bytes"] == len(content)
        assert entry["sha256"] == hashlib.sha256(content).hexdigest()
