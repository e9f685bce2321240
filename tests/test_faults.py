"""Full disks, folders without the right to write, kill -9, two writers, missing libraries.

Real commands in processes of their own (`zygote`).  Whatever happens, what lies in a folder under
its final name is whole, and what is said is one line.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bladegen as bg

SMALL = ("--landmarks", "51", "--stations", "40", "--tolerance", "50mm")
ALIKE = ("glb", "ply", "obj", "3mf", "vtp", "brep", "iges", "p3d", "vtu")
FORMATS = (  # one of each kind on every run, those that are written alike at night
    *("stl", "step", "png", "cgns"),
    *(pytest.param(suffix, marks=pytest.mark.nightly) for suffix in ALIKE),
)
KILLS = pytest.mark.parametrize("kills", [1, pytest.param(6, marks=pytest.mark.nightly)])


@pytest.fixture(scope="module")
def mesh(tmp_path_factory) -> Path:
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=21)
    return bg.export(blade, tmp_path_factory.mktemp("made") / "a.stl", stations=30)


def refused(answer: dict[str, Any], *words: str) -> None:
    """The command ended with 1 and one line that says why, behind what it noted at its start."""
    assert answer["status"] == 1, answer["err"]
    *notes, why = answer["err"].splitlines()
    assert all(note.startswith("note: ") for note in notes), answer["err"]
    assert why.startswith("bladegen: "), answer["err"]
    for word in words:
        assert word in why


def is_whole(path: Path) -> bool:
    """Tell whether a file is all that its format wants, by its own account of its end."""
    data = path.read_bytes()
    match path.suffix:
        case ".stl":
            return len(data) == 84 + 50 * int.from_bytes(data[80:84], "little")
        case ".glb":
            return data[:4] == b"glTF" and len(data) == int.from_bytes(data[8:12], "little")
        case ".ply":
            head, _, body = data.partition(b"end_header\n")
            counts = [int(line.split()[-1]) for line in head.splitlines() if b"element" in line]
            return len(body) == 12 * counts[0] + 13 * counts[1]
        case ".step":
            return data.rstrip().endswith(b"END-ISO-10303-21;")
        case ".iges":
            return data.splitlines()[-1][72:73] == b"T"
        case ".png":
            return data.endswith(b"IEND\xaeB\x60\x82")
        case ".json":
            return bool(json.loads(data))
        case ".csv":
            rows = [line for line in data.splitlines() if not line.startswith(b"#")]
            return len({row.count(b",") for row in rows}) == 1 and data[-1:] == b"\n"
        case ".npz":
            return bg.ShapeSpace.load(path).dimension > 0
    raise AssertionError(path)


def shown(folder: Path) -> list[Path]:
    """Files under final names; what a killed run leaves besides is hidden."""
    return sorted(path for path in folder.iterdir() if not path.name.startswith("."))


# ---- full disk ----------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_full_disk_leaves_no_file(command, suffix, tmp_path):
    answer = command("build", "nrel5mw", "-o", tmp_path, "--format", suffix, *SMALL, limit=6_000)
    refused(answer, "written")
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_leaves_no_half_rotor(command, tmp_path):
    args = ("build", "nrel5mw", "-o", tmp_path, "--format", "stl", "--rotor", *SMALL[:4])
    answer = command(*args, "--tolerance", "2mm", limit=250_000)
    refused(answer, "rotor.step: cannot be written")
    assert [path.name for path in tmp_path.iterdir()] == ["nrel5mw.stl"]
    assert is_whole(tmp_path / "nrel5mw.stl")


def test_a_full_disk_keeps_what_was_there(command, tmp_path):
    assert command("build", "nrel5mw", "-o", tmp_path, "--format", "stl", *SMALL)["status"] == 0
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    for args in (("build", "nrel5mw"), ("perturb", "nrel5mw", "--chord", 1.1, "--name", "nrel5mw")):
        answer = command(*args, "-o", tmp_path, "--format", "stl", *SMALL, limit=6_000)
        refused(answer, "cannot be written")
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_disk_that_is_full_at_the_report_is_said(command, tmp_path):
    asked = ("--format", "stl", "--landmarks", 5, "--stations", 40, "--trailing-edge", "given")
    assert command("build", "nrel5mw", "-o", tmp_path / "whole", *asked)["status"] == 0
    sizes = {path.suffix: path.stat().st_size for path in (tmp_path / "whole").iterdir()}
    small, large = sizes[".stl"], sizes[".json"]
    assert small + 600 < large
    answer = command("build", "nrel5mw", "-o", tmp_path / "full", *asked, limit=small + 500)
    refused(answer, "cannot be written")
    assert all(is_whole(path) for path in (tmp_path / "full").iterdir())
    assert not list((tmp_path / "full").glob("*.json"))


OTHERS = {
    "space build": ("space", "build", "-o", "{}/a.npz", "--count", 2, "--landmarks", 101),
    "space plot": ("space", "plot", "-o", "{}/a.png"),
    "preview": ("preview", "nrel5mw", "--screenshot", "{}/a.png", "--landmarks", 51),
    "check": ("check", "{mesh}", "{mesh}", "--screenshot", "{}/a.png"),
    "convert": ("convert", "nrel5mw", "{}/a.yaml"),
    "convert to a table": ("convert", "nrel5mw", "{}/a.xlsx"),
}


def filled(name: str, folder: Path, mesh: Path) -> list[str]:
    return [str(word).format(folder, mesh=mesh) for word in OTHERS[name]]


@pytest.mark.parametrize("name", OTHERS)
def test_a_full_disk_leaves_nothing_of_other_commands(command, name, mesh, tmp_path):
    refused(command(*filled(name, tmp_path, mesh), limit=4_000), "cannot be written")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("suffix", "limit"), [(".dat", 9_000), (".htc", 2_000), (".csv", 1_500)])
def test_a_full_disk_leaves_no_main_file_of_several(command, suffix, limit, tmp_path):
    refused(
        command("convert", "nrel5mw", tmp_path / f"a{suffix}", limit=limit), "cannot be written"
    )
    assert not (tmp_path / f"a{suffix}").exists()
    assert not [path for path in tmp_path.rglob("*") if path.name.startswith(".")]


# ---- no right to write --------------------------------------------------------------------------


@pytest.fixture
def locked(tmp_path):
    folder = tmp_path / "locked"
    folder.mkdir(mode=0o555)
    yield folder
    folder.chmod(0o755)


@pytest.mark.parametrize("name", OTHERS)
def test_a_folder_without_the_right_to_write_is_said(command, name, mesh, locked):
    refused(
        command(*filled(name, locked, mesh), plain=True), "cannot be written: Permission denied"
    )
    assert list(locked.iterdir()) == []


@pytest.mark.parametrize("inside", ["", "deeper"])
@pytest.mark.parametrize("args", [("build",), ("perturb", "--chord", "1.1"), ("family",)])
def test_a_target_without_the_right_to_write_is_said(command, args, inside, locked):
    more = ("--count", "2") if args[0] == "family" else ("--format", "stl", *SMALL)
    target = locked / inside
    answer = command(args[0], "nrel5mw", *args[1:], "-o", target, *more, plain=True)
    refused(answer, "Permission denied")
    assert list(locked.iterdir()) == []


# ---- kill -9 ------------------------------------------------------------------------------------

MANY = [word for suffix in ("stl", "glb", "ply", "step") for word in ("--format", suffix)]


@KILLS
def test_a_run_killed_at_any_time_leaves_whole_files(command, tmp_path, kills):
    build = ("build", "nrel5mw", *MANY, *SMALL)
    whole = command(*build, "-o", tmp_path / "whole")
    assert whole["status"] == 0, whole["err"]
    names = [path.name for path in shown(tmp_path / "whole")]
    left = []
    for number, share in enumerate(np.linspace(0.2, 0.9, kills)):
        target = tmp_path / str(number)
        command(*build, "-o", target, kill=share * whole["seconds"])
        made = shown(target) if target.exists() else []
        assert all(is_whole(path) for path in made), made
        left.append(len(made))
    assert min(left) < len(names)  # some were killed in time
    again = command(*build, "-o", tmp_path / "0")  # what is left is in nobody's way
    assert again["status"] == 0, again["err"]
    assert [path.name for path in shown(tmp_path / "0")] == names


@KILLS
def test_a_space_killed_while_written_is_whole_or_not_there(command, tmp_path, kills):
    build = ("space", "build", "--count", 20, "--landmarks", 201)
    spent = command(*build, "-o", tmp_path / "whole.npz")["seconds"]
    for number, share in enumerate(np.linspace(0.6, 1.0, kills)):
        path = tmp_path / f"{number}.npz"
        command(*build, "-o", path, kill=share * spent)
        assert not path.exists() or is_whole(path)


@KILLS
def test_a_conversion_killed_at_any_time_is_whole_where_it_has_its_main_file(
    command, tmp_path, kills
):
    (tmp_path / "whole").mkdir()
    done = command("convert", "nrel5mw", tmp_path / "whole" / "a.dat")
    assert done["status"] == 0, done["err"]
    for number, share in enumerate(np.linspace(0.4, 0.95, kills)):
        target = tmp_path / str(number) / "a.dat"
        target.parent.mkdir()
        command("convert", "nrel5mw", target, kill=share * done["seconds"])
        if target.exists():
            assert bg.read(target).length == pytest.approx(61.5)


# ---- two writers --------------------------------------------------------------------------------


def test_two_writers_of_one_blade_do_not_mix(command, tmp_path):
    def job(landmarks: int, **how: Any) -> dict[str, Any]:
        args = ["build", "nrel5mw", "-o", tmp_path, *MANY, "--stations", 40, "--tolerance", "50mm"]
        return {"args": [*map(str, args), "--landmarks", str(landmarks)], **how}

    answers = command.together(job(51), job(61), job(71))
    done = [n for n, answer in zip((51, 61, 71), answers, strict=True) if answer["status"] == 0]
    assert done
    for answer in answers:
        if answer["status"]:
            refused(answer, "another run is writing nrel5mw there")
    assert all(is_whole(path) for path in tmp_path.iterdir())
    report = json.loads((tmp_path / "nrel5mw.report.json").read_text())
    assert report["settings"]["landmarks"] in done
    for entry in report["files"]:
        assert (tmp_path / entry["name"]).stat().st_size == entry["bytes"]


def test_two_writers_of_two_blades_share_a_folder(command, tmp_path):
    jobs = [
        {"args": ["build", name, "-o", str(tmp_path), "--format", "stl", *SMALL]}
        for name in ("nrel5mw", "iea15mw")
    ]
    assert [answer["status"] for answer in command.together(*jobs)] == [0, 0]
    assert len(list(tmp_path.iterdir())) == 6


def test_two_writers_of_one_space_leave_one_whole(command, tmp_path):
    path = tmp_path / "a.npz"
    jobs = [
        {"args": ["space", "build", "-o", str(path), "--count", count, "--landmarks", "101"]}
        for count in ("3", "4")
    ]
    assert [answer["status"] for answer in command.together(*jobs)] == [0, 0]
    assert is_whole(path)
    assert list(tmp_path.iterdir()) == [path]


# ---- missing libraries --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("library", "args"),
    [
        ("OCP", ("build", "nrel5mw", "-o", "{}", "--format", "step", *SMALL)),
        pytest.param(
            "OCP",
            ("perturb", "nrel5mw", "--chord", 1.1, "-o", "{}", "--format", "brep", *SMALL),
            marks=pytest.mark.nightly,
        ),
        ("OCP", ("check", "{step}")),
        ("trimesh", ("build", "nrel5mw", "-o", "{}", "--format", "stl", *SMALL)),
        pytest.param("trimesh", ("check", "{mesh}"), marks=pytest.mark.nightly),
        ("trimesh", ("check", "{mesh}", "nrel5mw")),
        pytest.param(
            "pyvista",
            ("build", "nrel5mw", "-o", "{}", "--format", "vtp", *SMALL),
            marks=pytest.mark.nightly,
        ),
        pytest.param(
            "pyvista",
            ("build", "nrel5mw", "-o", "{}", "--format", "png", *SMALL),
            marks=pytest.mark.nightly,
        ),
        ("pyvista", ("preview", "nrel5mw", "--screenshot", "{}/a.png")),
        ("cadquery", ("build", "nrel5mw", "-o", "{}", "--format", "stl", "--rotor", *SMALL)),
        ("matplotlib", ("space", "plot", "-o", "{}/a.png")),
        ("scipy", ("info", "nrel5mw", "--json")),
        ("zarr", ("family", "nrel5mw", "-o", "{}", "--count", 2, "--spans", 16)),
        ("pyarrow", ("family", "nrel5mw", "-o", "{}", "--count", 2, "--spans", 16)),
        ("distributed", ("family", "nrel5mw", "-o", "{}", "--count", 2, "--dask", "tcp://a:1")),
    ],
)
def test_a_missing_library_is_named(command, library, args, mesh, tmp_path):
    step = tmp_path.parent / "any.step"
    step.write_text("")
    words = [str(word).format(tmp_path, mesh=mesh, step=step) for word in args]
    answer = command(*words, hidden=[library])
    if library == "scipy":  # reading needs none
        assert answer["status"] == 0, answer["err"]
        return
    refused(answer, library, "pip install")
    if args[0] == "family":  # a folder to go on with, but not a manifest
        assert not (tmp_path / "manifest.parquet").exists()
    else:
        assert {path.suffix for path in tmp_path.iterdir()} <= {".stl"}
