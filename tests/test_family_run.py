import json
import os
import signal
import subprocess
import sys
import time
from functools import cache

import numpy as np
import pyarrow.parquet as pq
import pytest
import zarr
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from processes import children, gone_within

import bladegen as bg
from bladegen.cad import exchange, shapes
from bladegen.errors import BladegenError, FamilyError, PerturbationError
from bladegen.exports.options import Options
from bladegen.families.family import BLOCK
from bladegen.families.folder import FamilyFolder
from bladegen.families.manifest_rows import sections_digest
from bladegen.families.order import Order
from bladegen.families.processes import in_processes
from bladegen.families.run import run
from bladegen.families.storage.layout import FILES, block_of, home_of
from bladegen.measures import checks
from bladegen.measures.properties import volume
from bladegen.measures.spanwise import built
from bladegen.support.files import digest_of
from bladegen.surface import mesh_files

LONG = 600.0  # s; far more than is needed, for machines that are busy
SPANS = 16
COUNT = 3 * BLOCK + 9
COARSE = Options(tolerance=5e-3, stations=60)  # quick to make


@cache
def planned(count=COUNT, seed=7, **options):
    blade = bg.Blade.from_definition(bg.read("dtu10mw"))
    return bg.family(blade, bg.ShapeSpace.bundled(), count=count, seed=seed, spans=SPANS, **options)


@cache
def small(count):
    """A family whose files are quick to make."""
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=121)
    bounds = {"chord": (0.9, 1.1), "twist": (-0.02, 0.02)}
    return bg.family(blade, None, count=count, seed=7, spans=SPANS, bounds=bounds, design="box")


def whole(folder):
    """What must be the same of two runs: the manifest's bytes, and the sections."""
    return (folder / "manifest.parquet").read_bytes(), np.asarray(sections(folder))


def sections(folder):
    return zarr.open_group(folder / "sections.zarr", mode="r")["sections"]


def same(one, two):
    assert one[0] == two[0]
    assert_array_equal(one[1], two[1])


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    """A family made by one process without any interruption."""
    target = tmp_path_factory.mktemp("family") / "whole"
    told = []
    assert run(Order(planned(), target), progress=told.append) == COUNT
    assert told == [0, 64, 128, 192, COUNT]
    return target


def test_the_manifest_says_what_the_variants_are(reference):
    table = pq.read_table(reference / "manifest.parquet").to_pydict()
    assert table["index"] == list(range(COUNT))
    assert table["name"][10] == "dtu10mw-00010"
    assert all(table["valid"])
    stored = sections(reference)
    assert stored.shape == (COUNT, SPANS, 401, 3)
    assert stored.dtype == np.float32
    family = planned()
    for place in (0, 1, 77, COUNT - 1):
        variant = family.variant(place)
        assert_allclose(stored[place], variant.sections(family.eta), rtol=0, atol=1e-5)
        assert table["sections_sha256"][place] == sections_digest(stored[place])
        t = variant.changes[-1]["pga"][0]
        assert_allclose([table[f"t{j + 1}"][place] for j in range(4)], t, rtol=0, atol=1e-15)
        assert_allclose(table["volume_m3"][place], volume(variant), rtol=0.02)  # few sections
        assert_allclose(table["section_chord_m"][place], variant.chord(family.eta))
        # both are measured on the points that are written: here on landmarks, there on their curve
        twist = np.degrees(built(variant, family.eta)[1])
        assert_allclose(table["section_twist_deg"][place], twist, rtol=0, atol=0.01)


@given(st.integers(1, 60_000_000), st.sampled_from([2, 64]))
def test_no_folder_of_a_long_family_has_ten_thousand_entries(count, least):
    """A million variants put 15,625 shards into one folder."""
    block = block_of(count, least)
    assert -(-count // block) < 10_000
    assert block == least or -(-count // (block // 2)) >= 10_000  # no larger than it takes
    for formats, together in ((1, 1000), (3, 1000), (4, 100), (30, 100)):
        start = min(count, 99_000) // together * together
        assert len({home_of(start + i, formats) for i in range(together)}) == 1
        assert home_of(start, formats) != home_of(start + together, formats)
        assert formats * FILES * together + 999 < 10_000  # files of the first, folders of the rest


def test_long_families_hold_the_same_in_larger_shards(tmp_path, monkeypatch):
    """A block of more variants than are made at once; a store that is there keeps its own."""
    run(Order(small(100), tmp_path / "plain"))
    monkeypatch.setattr("bladegen.families.order.block_of", lambda count, least: 96)
    assert run(Order(small(100), tmp_path / "long"), jobs=2) == 100
    assert_array_equal(sections(tmp_path / "long")[:], sections(tmp_path / "plain")[:])
    tables = [pq.read_table(tmp_path / name / "manifest.parquet") for name in ("long", "plain")]
    assert tables[0].equals(tables[1])
    assert sections(tmp_path / "long").shards[0] == 96
    assert run(Order(small(130), tmp_path / "plain"), append=True) == 130 - 64
    assert sections(tmp_path / "plain").shards[0] == BLOCK
    monkeypatch.setattr("bladegen.families.additions.growth.MOST", 3)
    with pytest.raises(FamilyError, match="has 64 variants in a shard, and a folder holds 3 shard"):
        run(Order(small(200), tmp_path / "plain"), append=True)


def test_files_of_many_variants_lie_in_folders_of_their_own(tmp_path, monkeypatch):
    home = "bladegen.families.order.home_of"
    monkeypatch.setattr(home, lambda place, formats: f"{place // 2:03d}" if place > 1 else "")
    told = []
    run(Order(small(3), tmp_path / "fam", ("p3d",), options=COARSE), foretold=told.append)
    files = pq.read_table(tmp_path / "fam" / "manifest.parquet")["p3d_file"].to_pylist()
    own = ["nrel5mw-00000", "nrel5mw-00001", "001/nrel5mw-00002"]
    assert files == [f"blades/{name}.p3d" for name in own]
    sizes = [(tmp_path / "fam" / file).stat().st_size for file in files]
    assert told[0].needed > sizes[0] > 1000


def test_sections_say_where_they_are(reference):
    group = zarr.open_group(reference / "sections.zarr", mode="r")
    assert_array_equal(group["eta"], planned().eta)
    assert_array_equal(group["u"], planned().blade.u)
    assert group.attrs["unit"] == "m"
    assert not (reference / "parts").exists()


def test_properties_are_those_of_the_sections(reference):
    table = pq.read_table(reference / "manifest.parquet").to_pydict()
    family = planned()
    variant = family.variant(5)
    finished = variant.trailing_edge(variant.profiles(family.eta), variant.chord(family.eta))
    from bladegen.curves import polygons

    wanted = polygons.measure(finished * variant.chord(family.eta)[:, None, None])
    assert_allclose(table["section_area_m2"][5], wanted[:, 0], rtol=1e-6)
    assert_allclose(table["section_inertia_xx_m4"][5], wanted[:, 3], rtol=1e-6)
    assert_allclose(table["section_perimeter_m"][5], wanted[:, 6], rtol=1e-6)


@pytest.mark.parametrize("jobs", [2, pytest.param(5, marks=pytest.mark.nightly)])
def test_threads_make_the_same_family(reference, tmp_path, jobs):
    assert run(Order(planned(), tmp_path / "jobs"), jobs=jobs) == COUNT
    same(whole(tmp_path / "jobs"), whole(reference))


@pytest.fixture(scope="module")
def with_files(tmp_path_factory):
    """A family with files made by one process without any interruption."""
    target = tmp_path_factory.mktemp("family") / "files"
    assert run(Order(small(9), target, ("glb",), options=COARSE)) == 9
    return target


def test_processes_make_the_same_files_though_one_is_killed(with_files, tmp_path, monkeypatch):
    """Two of them have blocks of their own already where there are three variants or four."""
    given, killed = [], []

    def told(order, left, jobs):
        given.append((len(left), jobs))
        return in_processes(order, left, jobs)

    def kill(done):
        if done and not killed:
            import multiprocessing

            child = multiprocessing.active_children()[0]
            os.kill(child.pid, signal.SIGKILL)
            killed.append(done)

    monkeypatch.setattr("bladegen.families.run.in_processes", told)
    order = Order(small(9), tmp_path / "jobs", ("glb",), options=COARSE)
    assert run(order, jobs=2, progress=kill) == 9
    assert killed
    same(whole(tmp_path / "jobs"), whole(with_files))
    assert given[0] == (5, 2)


def test_a_cluster_makes_the_same_family(reference, tmp_path):
    distributed = pytest.importorskip("distributed")
    here = {"n_workers": 1, "threads_per_worker": 1, "dashboard_address": None}
    with (
        distributed.LocalCluster(processes=False, **here) as cluster,
        distributed.Client(cluster) as client,
    ):
        run(Order(planned(), tmp_path / "dask"), client=client)
    same(whole(tmp_path / "dask"), whole(reference))


@pytest.mark.nightly
def test_a_killed_worker_of_a_cluster_changes_nothing(reference, tmp_path):
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        pids = list(client.run(os.getpid).values())
        killed = []

        def kill(done):
            if done and not killed:
                os.kill(pids[0], signal.SIGKILL)
                killed.append(done)

        run(Order(planned(), tmp_path / "dask"), client=client, progress=kill)
    assert killed
    same(whole(tmp_path / "dask"), whole(reference))


COMMAND = [
    sys.executable,
    "-c",
    "from bladegen.cli.commands import main; main()",
    "family",
    "dtu10mw",
]
ASKED = ["--count", str(COUNT), "--seed", "7", "--spans", str(SPANS)]


def start(target, *more):
    return subprocess.Popen(
        [*COMMAND, "-o", str(target), *ASKED, *more],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


STOPS = (signal.SIGTERM, signal.SIGKILL, signal.SIGINT)


@pytest.mark.parametrize(
    ("jobs", "stops"),
    [
        ("2", [signal.SIGKILL]),
        pytest.param("1", STOPS, marks=pytest.mark.nightly),
        pytest.param("2", STOPS, marks=pytest.mark.nightly),
    ],
)
def test_runs_killed_at_any_point_leave_no_workers_and_go_on(
    reference, command, tmp_path, jobs, stops
):
    target = tmp_path / "killed"
    rng = np.random.default_rng([int(jobs), 5])
    for how in stops:
        more = ["--resume"] if (target / "family.json").exists() else []
        process = start(target, "--jobs", jobs, *more)
        deadline = time.monotonic() + LONG
        already = len(list(target.glob("parts/*.parquet")))
        while process.poll() is None and time.monotonic() < deadline:
            if len(list(target.glob("parts/*.parquet"))) > already:
                break
            time.sleep(0.01)
        time.sleep(rng.uniform(0.0, 0.15))
        workers = children(process.pid)
        process.send_signal(how)
        process.wait(timeout=LONG)
        assert gone_within(LONG, workers)
        _, err = process.communicate(timeout=LONG)  # nobody holds its pipes
        if process.returncode == 128 + how:
            words = "interrupted" if how == signal.SIGINT else "terminated"
            *notes, last = err.splitlines()
            assert last == f"bladegen: {target}: the same command with --resume goes on; {words}"
            assert all(note.startswith("note: still to be made: ") for note in notes)
            assert not list(target.glob(".*.lock"))
        if (target / "manifest.parquet").exists():
            break
    done = command("family", "dtu10mw", "-o", target, *ASKED, "--jobs", jobs, "--resume")
    assert done["status"] == 0, done["err"]
    assert f"{COUNT}," in done["out"]
    same(whole(target), whole(reference))
    assert not list(target.glob("sections.zarr/**/*.partial"))
    assert run(Order(planned(), target), resume=True) == 0


@pytest.mark.nightly  # by day: killed at any point, above
def test_runs_killed_while_they_write_files_leave_no_workers_and_go_on(command, tmp_path):
    target, count = tmp_path / "killed", 6
    asked = ["--count", str(count), "--spans", str(SPANS), "--format", "glb", "--stations", "40"]
    process = subprocess.Popen([*COMMAND, "-o", str(target), *asked, "--jobs", "2"])
    deadline = time.monotonic() + LONG
    while process.poll() is None and time.monotonic() < deadline:
        if list(target.glob("parts/*.parquet")):
            break
        time.sleep(0.01)
    workers = children(process.pid)
    process.kill()
    process.wait(timeout=LONG)
    assert gone_within(LONG, workers)
    done = command("family", "dtu10mw", "-o", target, *asked, "--jobs", "2", "--resume")
    assert done["status"] == 0, done["err"]
    table = pq.read_table(target / "manifest.parquet").to_pydict()
    assert table["index"] == list(range(count))
    made = [name != "" for name in table["glb_file"]]
    assert sum(made) > count // 2
    assert made == [problem == "" for problem in table["glb_problem"]]
    for name, digest in zip(table["glb_file"], table["glb_sha256"], strict=True):
        assert name == "" or digest_of(target / name) == digest


def test_a_full_disk_is_one_line_and_the_run_goes_on(reference, command, tmp_path):
    target = tmp_path / "full"
    limit = 4 * SPANS * 401 * 3 * 40  # less than the sections of a block
    done = command("family", "dtu10mw", "-o", target, *ASKED, limit=limit)
    assert done["status"] == 1
    assert "cannot be written" in done["err"]
    assert len(done["err"].strip().splitlines()) == 1
    assert not (target / "manifest.parquet").exists()
    assert run(Order(planned(), target), resume=True) == COUNT
    same(whole(target), whole(reference))


def test_another_family_in_the_folder_is_refused(reference):
    with pytest.raises(BladegenError, match=r"another family \(seed: 7 there, 8 asked for"):
        run(Order(planned(seed=8), reference), resume=True)
    with pytest.raises(BladegenError, match="--resume goes on"):
        run(Order(planned(), reference))
    with pytest.raises(BladegenError, match="dtype"):
        run(Order(planned(), reference, dtype="float64"), resume=True)


def test_a_family_already_whole_is_left_as_it_is(reference):
    before = whole(reference)
    assert run(Order(planned(), reference), resume=True) == 0
    same(whole(reference), before)


def test_a_damaged_or_foreign_folder_is_refused(tmp_path):
    (tmp_path / "family.json").write_text("{")
    with pytest.raises(BladegenError, match="holds another family"):
        run(Order(planned(), tmp_path))
    (tmp_path / "family.json").unlink()
    (tmp_path / "manifest.parquet").write_text("")
    with pytest.raises(BladegenError, match=r"without family\.json"):
        run(Order(planned(), tmp_path))


def test_two_runs_in_one_folder_are_refused(tmp_path):
    place = FamilyFolder(tmp_path)
    with place.alone(), pytest.raises(BladegenError, match="another run is writing"):
        run(Order(planned(), tmp_path))


def test_variants_that_fold_between_their_sections_are_listed_without_files(tmp_path, monkeypatch):
    def folded(blade, **_):
        if blade.name.endswith("1"):
            raise PerturbationError(f"{blade.name}: the section at eta = 0.5 crosses itself")
        return blade

    monkeypatch.setattr(bg.Blade, "require_sound", folded)
    run(Order(small(3), tmp_path, ("stl", "glb"), options=COARSE))
    table = pq.read_table(tmp_path / "manifest.parquet").to_pydict()
    for kind in ("stl", "glb"):
        assert [bool(name) for name in table[f"{kind}_file"]] == [True, False, True]
        assert "crosses itself" in table[f"{kind}_problem"][1]
        assert table[f"{kind}_sha256"][1] == table[f"{kind}_problem"][0] == ""


def test_files_of_each_variant_are_written_and_listed(tmp_path):
    family = small(2)
    run(Order(family, tmp_path / "one", ("step", "stl"), options=COARSE))
    table = pq.read_table(tmp_path / "one" / "manifest.parquet").to_pydict()
    assert table["step_problem"] == ["", ""]
    for place, name in enumerate(table["step_file"]):
        path = tmp_path / "one" / name
        assert table["step_sha256"][place] == digest_of(path)
        assert shapes.is_valid(exchange.read_step(path))
        figures = checks.mesh_figures(mesh_files.read(path.with_suffix(".stl")))
        assert figures["watertight"]
        assert_allclose(
            mesh_files.read(path.with_suffix(".stl")).volume,
            volume(family.variant(place)),
            rtol=1e-3,
        )


def test_marked_variants_have_no_files(tmp_path):
    asked = {"bounds": {"t1": (5.0, 6.0)}, "invalid": "keep", "spans": SPANS}
    family = bg.family(planned().blade, bg.ShapeSpace.bundled(), count=2, **asked)
    run(Order(family, tmp_path, ("stl",)))
    table = pq.read_table(tmp_path / "manifest.parquet").to_pydict()
    assert table["valid"] == [False, False]
    assert table["stl_file"] == ["", ""]
    assert "arrives at t1 = " in table["reason"][0]
    assert table["reason"][0]


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda path: Order(planned(), path, ("doc",)), "suffix"),
        (lambda path: Order(planned(), path, dtype="int"), "dtype"),
        (lambda path: run(Order(planned(), path), jobs=0), "jobs"),
    ],
)
def test_what_cannot_be_ordered_is_refused(tmp_path, make, said):
    with pytest.raises(BladegenError, match=said):
        make(tmp_path)


def test_the_identity_is_readable(reference):
    found = json.loads((reference / "family.json").read_text())
    assert found["seed"] == 7
    assert found["count"] == COUNT
    assert found["factors"]["t1"][0] < 0 < found["factors"]["t1"][1]
