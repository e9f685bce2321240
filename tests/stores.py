"""Families in S3 and Google Cloud Storage, on servers of packages that answer as those do.

Not collected by itself: servers and clients lie in an environment of their own
(`tests/test_object_stores.py`).
"""

import json
import os
import socket
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import bladegen as bg
from bladegen.families.order import Order
from bladegen.families.run import run

KEYS = {"AWS_ACCESS_KEY_ID": "key", "AWS_SECRET_ACCESS_KEY": "secret", "AWS_REGION": "us-east-1"}
VARY = {"chord": (0.9, 1.1), "twist": (-0.02, 0.02)}


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def counting_from_the_end(storage):
    """Teach the emulator ranges such as ``bytes=-16``, which Cloud Storage knows and it ignores."""
    from gcp_storage_emulator.server import Request

    plain = Request.get_header

    def header(request, key, default=None):
        value = plain(request, key, default)
        if key == "range" and str(value).startswith("bytes=-"):
            names = request.params["bucket_name"], request.params["object_id"]
            size = len(storage.get_file(*names))
            value = f"bytes={max(0, size - int(value[7:]))}-{size - 1}"
        return value

    Request.get_header = header


@pytest.fixture(scope="module")
def bucket(request):
    """Start the server of a store, make a bucket there, and return its address."""
    import fsspec

    port = free_port()
    if request.param == "s3":
        from moto.server import ThreadedMotoServer

        server = ThreadedMotoServer("127.0.0.1", port)
        os.environ.update(KEYS, AWS_ENDPOINT_URL=f"http://127.0.0.1:{port}")
    else:
        from gcp_storage_emulator.server import create_server

        server = create_server("127.0.0.1", port, in_memory=True)
        counting_from_the_end(server._storage)
        os.environ["STORAGE_EMULATOR_HOST"] = f"http://127.0.0.1:{port}"
        os.environ["GCSFS_EXPERIMENTAL_ZB_HNS_SUPPORT"] = "false"  # asks Google what buckets are
    server.start()
    fsspec.filesystem(request.param).mkdir("blades")
    yield f"{request.param}://blades"
    server.stop()


def planned(count):
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=121)
    return bg.family(blade, None, count=count, seed=7, spans=16, bounds=VARY, design="box")


class KilledError(Exception):
    """What ends a run in the middle."""


def killed(done):
    if done:
        raise KilledError


@pytest.mark.parametrize("bucket", ["s3", "gs"], indirect=True)
def test_a_family_in_a_store_is_that_of_a_folder(bucket, tmp_path):
    """Made, stopped, gone on with, added to and labelled there; read by all that reads folders."""
    place = f"{bucket}/made/family"
    with pytest.raises(KilledError):
        run(Order(planned(150), place), progress=killed)
    assert run(Order(planned(150), place), resume=True, jobs=2) == 150 - 64
    assert run(Order(planned(200), place), append=True) == 200 - 128
    assert run(Order(planned(200), tmp_path / "family")) == 200
    there, here = bg.load_family(place), bg.load_family(tmp_path / "family")
    assert (there.path / "manifest.parquet").read_bytes() == (
        here.path / "manifest.parquet"
    ).read_bytes()
    assert there.names == here.names
    for name in ("sections", "chord", "split", "name"):
        assert np.array_equal(there[name][:], here[name][:])
    shuffled = [b["variant"] for b in there.batches(("variant",), 32, rng=np.random.default_rng(0))]
    assert sorted(np.concatenate(shuffled).tolist()) == list(range(200))
    assert there[3].volume == here[3].volume
    assert there.dataset().sizes == here.dataset().sizes
    added = bg.load_family(place)
    from bladegen.families.additions.later_labels import add_labels

    assert add_labels(added, ("mass",)) == 200
    assert np.isfinite(bg.load_family(place)["mass"][:]).all()


@pytest.mark.parametrize("bucket", ["s3", "gs"], indirect=True)
def test_commands_take_families_of_stores(bucket, tmp_path):
    def typed(*words):
        command = [sys.executable, "-m", "bladegen", *map(str, words)]
        done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, check=False)
        return done.returncode, done.stdout + done.stderr

    place = f"{bucket}/typed"
    made = typed(
        *("family", "nrel5mw", "-o", place, "--count", 3, "--spans", 16, "--reach", 0.2),
        *("--format", "stl", "--jobs", 2),
    )
    assert made[0] == 0, made[1]
    code, shown = typed("info", place, "--json")
    assert code == 0, shown
    assert json.loads(shown)["variants"] == 3
    files = bg.load_family(place)["stl_file"][:]
    assert all((bg.load_family(place).path / file).stat().st_size > 1e5 for file in files)
    code, said = typed("build", f"{place}/2", "-o", "out", "--format", "stl")
    assert code == 0, said
    assert Path(tmp_path, "out/nrel5mw-00002.stl").exists()
    code, said = typed("family", "nrel5mw", "-o", f"{bucket}-not-there/fam", "--count", 2)
    assert code == 1
    assert said.startswith("bladegen: ")
    assert said.count("\n") == 1
    assert "bucket" in said
