import json
import math
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

import bladegen
from bladegen.cli import build, commands
from bladegen.errors import BladegenError

RUN = CliRunner()


def run(*arguments):
    return RUN.invoke(commands.app, [str(argument) for argument in arguments])


def main(*arguments):
    """The command as users call it, in a process of its own."""
    command = [
        sys.executable,
        "-c",
        "from bladegen.cli.commands import main; main()",
        *map(str, arguments),
    ]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_list_names_the_bundled_blades():
    result = run("list")
    assert result.exit_code == 0
    for name in bladegen.bundled():
        assert name in result.output


def test_info_shows_stations_and_json_holds_them():
    result = run("info", "nrel5mw")
    assert result.exit_code == 0
    assert "DU40_A17" in result.output
    assert "61.5" in result.output
    figures = json.loads(run("info", "iea15mw", "--json").output)
    assert figures["length_m"] == pytest.approx(117.0)
    assert figures["tip_prebend_m"] == pytest.approx(-4.0)
    assert len(figures["stations"]) == 10


def test_info_without_thickness_distribution(tmp_path):
    import yaml

    document = yaml.safe_load(Path(bladegen.read("nrel5mw").source).read_text())
    del document["components"]["blade"]["outer_shape"]["rthick"]
    (tmp_path / "plain.yaml").write_text(yaml.safe_dump(document))
    assert run("info", tmp_path / "plain.yaml").exit_code == 0


def test_build_makes_what_is_asked_for(tmp_path):
    result = run(
        "build", "nrel5mw", "-o", tmp_path, "--format", "stl", "--format", "ply",
        "--landmarks", 101, "--stations", 40, "--path", "spline", "--unit", "mm", "--planes", "z",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"nrel5mw.stl", "nrel5mw.ply", "nrel5mw.report.json", "nrel5mw.spanwise.csv"}
    assert "watertight" in result.output
    report = json.loads((tmp_path / "nrel5mw.report.json").read_text())
    assert report["settings"]["path"] == "spline_path"
    assert report["settings"]["mesh_unit"] == "mm"


def test_build_makes_grids_as_asked_for(tmp_path):
    result = run(
        "build", "nrel5mw", "-o", tmp_path, "--format", "p3d", "--landmarks", 101, "--tip", "round",
        "--grid-around", 65, "--grid-along", 33, "--grid-edge", 6, "--le-spacing", 0.004,
        "--te-spacing", 0.003, "--tip-spacing", 0.001, "--root-spacing", 0.02,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    report = json.loads((tmp_path / "nrel5mw.report.json").read_text())
    assert report["settings"]["grid"] == {
        "around": 65, "along": 33, "edge": 6, "leading_edge": 0.004, "trailing_edge": 0.003,
        "tip": 0.001, "root": 0.02,
    }  # fmt: skip
    tip = 64 * 2 + 31 * 2 + 6 * 2 + 2 * 2  # rim and core, ring and core under its arc
    assert report["grid"]["cells"] == 32 * (64 + 6) + tip
    refused = run("build", "nrel5mw", "-o", tmp_path, "--format", "p3d", "--le-spacing", 0.5)
    assert "leading-edge spacing: got 0.5, allowed is" in str(refused.exception)


@pytest.mark.parametrize(
    ("formats", "options", "idle"),
    [
        ("cgns", ["--y-plus", "1", "--tip", "round"], ["--y-plus"]),
        ("cgns", ["--unit", "mm"], ["--unit"]),
        ("cgns,p3d", ["--unit", "mm"], []),
        ("step", ["--unit", "mm", "--grid-around", "129", "--light"], ["--unit", "--grid-around"]),
        ("stl", ["--stations", "50", "--tolerance", "1mm"], ["--tolerance"]),
        ("volume.cgns", ["--reynolds", "1e7", "--distance", "2m"], ["--reynolds"]),
        ("volume.cgns", ["--reynolds", "1e7", "--y-plus", "1"], []),
        ("volume.cgns", ["--grid-edge", "16"], []),
        ("volume.cgns", ["--grid-edge", "72"], []),
        ("stl", ["--grid-edge", "16"], ["--grid-edge"]),
        ("yaml", ["--polars", "none", "--element", "2m"], ["--element"]),
    ],
)
def test_options_that_change_no_file_are_named(formats, options, idle, monkeypatch):
    said = []
    monkeypatch.setattr(build, "_build", lambda *_: None)
    monkeypatch.setattr(build, "remark", said.append)
    run("build", "nrel5mw", "-o", "x", "--landmarks", "51", "--format", formats, *options)
    assert [line.partition(":")[0] for line in said] == idle
    assert all(f"none of the files asked for ({formats.replace(',', ', ')})" in s for s in said)


@pytest.mark.parametrize(
    ("formats", "options", "edge"),
    [
        ("cgns", [], 72),
        ("cgns,volume.cgns", [], 16),
        (".VOLUME.P3D", [], 16),
        ("volume.foam.zip", ["--grid-edge", "30"], 30),
        ("p3d", ["--grid-edge", "30"], 30),
    ],
)
def test_volumes_grow_from_fewer_cells_across_the_edge(formats, options, edge, monkeypatch):
    made = []
    monkeypatch.setattr(build, "_build", lambda *given: made.append(given[3]))
    run("build", "nrel5mw", "-o", "x", "--landmarks", "51", "--format", formats, *options)
    assert [one.spacing.edge for one in made] == [edge]


def test_build_that_misses_its_tolerance_ends_with_1(tmp_path, monkeypatch):
    monkeypatch.setattr("bladegen.surface.fitting.MAX_POLES", 1000)
    result = run(
        "build", "nrel5mw", "-o", tmp_path, "--format", "step", "--tolerance", "0.001mm",
        "--landmarks", 101,
    )  # fmt: skip
    assert isinstance(result.exception, BladegenError)
    assert "out-of-tolerance" in str(result.exception)


def test_check_of_a_definition_and_of_a_file(tmp_path):
    result = run("check", "nrel5mw")
    assert result.exit_code == 0
    assert "DU40_A17" in result.output
    stl = bladegen.export(
        bladegen.Blade.from_definition(bladegen.read("nrel5mw"), landmarks=51),
        tmp_path / "a.stl",
        stations=20,
    )
    figures = json.loads(run("check", stl, "--json").output)
    assert figures["watertight"]
    assert figures["problems"] == []


def test_check_of_something_unsound_ends_with_1(command, tmp_path):
    path = tmp_path / "open.stl"
    path.write_text(
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid a\n"
    )
    done = command("check", path)
    assert done["status"] == 1
    assert "watertight" in done["out"]
    assert done["err"].startswith("bladegen: ")
    assert "is not watertight" in done["err"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["info", "no-such-blade"], ["no-such-blade", "iea15mw"]),
        (["build", "nrel5mw", "-o", "/dev/null/x", "--format", "stl"], ["/dev/null/x"]),
        (["build", "nrel5mw", "-o", ".", "--format", "doc"], [".doc", ".step"]),
        (["build", "nrel5mw", "-o", ".", "--landmarks", "100"], ["100", "odd"]),
        (["build", "nrel5mw", "-o", ".", "--tolerance", "3"], ["tolerance", "'3'"]),
        (["check", "nowhere.step"], ["nowhere.step"]),
        (["check", "nowhere.txt"], [".txt", ".stl"]),
    ],
)
def test_errors_are_one_line_and_exit_code_1(command, arguments, words):
    done = command(*arguments)
    assert done["status"] == 1
    assert done["err"].count("\n") == 1
    assert done["err"].startswith("bladegen: ")
    for word in words:
        assert word in done["err"]


def test_usage_errors_have_exit_code_2(command):
    assert command("build")["status"] == 2
    assert command("frobnicate")["status"] == 2
    assert command("build", "nrel5mw", "-o", ".", "--path", "cubic")["status"] == 2


def test_version_and_help():
    assert main("--version").stdout == f"bladegen {bladegen.__version__}\n"
    assert "build" in main("--help").stdout


def test_an_interrupt_is_said_shortly(monkeypatch, capsys):
    def interrupt():
        raise KeyboardInterrupt

    monkeypatch.setattr(commands, "app", interrupt)
    with pytest.raises(SystemExit, match="130"):
        commands.main()
    assert capsys.readouterr().err == "bladegen: interrupted\n"


def test_a_missing_library_is_said_in_a_line(monkeypatch, capsys):
    def unloadable():
        raise ImportError("libGL.so.1: cannot open shared object file\n", name="OCP.gp")

    monkeypatch.setattr(commands, "app", unloadable)
    with pytest.raises(SystemExit, match="1"):
        commands.main()
    said = capsys.readouterr().err
    assert said.startswith("bladegen: this needs OCP, which cannot be imported (libGL.so.1")
    assert "pip install cadquery-ocp" in said
    assert said.count("\n") == 1


def test_perturb_builds_a_variant_and_says_what_was_changed(tmp_path):
    result = run(
        "perturb", "nrel5mw", "-o", tmp_path, "--pga", "0.03,-0.02,0.01,0", "--thickness", 1.05,
        "--twist", 1, "--window", "0.05,0.2", "--format", "stl", "--stations", 60,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    report = json.loads((tmp_path / "nrel5mw-perturbed.report.json").read_text())
    (changes,) = report["changes"]
    assert changes["pga"] == [[0.03, -0.02, 0.01, 0.0]]
    assert changes["thickness"] == 1.05
    assert changes["twist"] == pytest.approx(0.0174533)
    assert changes["window"] == [0.05, 0.2]
    assert (tmp_path / "nrel5mw-perturbed.stl").exists()


def test_perturb_by_affine_parameters_alone_and_names(tmp_path):
    result = run(
        "perturb", "nrel5mw", "-o", tmp_path, "--chord-scale", 1.1, "--name", "../wide",
        "--format", "ply", "--landmarks", 101,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    assert {path.name for path in tmp_path.iterdir()} == {
        "wide.ply",
        "wide.report.json",
        "wide.spanwise.csv",
    }


def test_perturb_beyond_the_bounds_ends_with_1(command, tmp_path):
    done = command("perturb", "nrel5mw", "-o", tmp_path, "--pga", "0.9,0,0,0")
    assert done["status"] == 1
    assert "t1 = 0.9, allowed is" in done["err"]
    assert list(tmp_path.iterdir()) == []


def test_space_commands(tmp_path):
    space = tmp_path / "space.npz"
    result = run("space", "build", "-o", space, "--count", 10, "--landmarks", 101, "--modes", 2)
    assert result.exit_code == 0, result.output
    assert "NACA64_A17" in result.output
    figures = json.loads(run("space", "info", space, "--json").output)
    assert figures["shapes"] == 160
    assert figures["modes"] == 2
    assert "16000" in run("space", "info").output
    for suffix in ("png", "svg"):
        picture = tmp_path / f"space.{suffix}"
        assert run("space", "plot", space, "-o", picture).exit_code == 0
        assert picture.stat().st_size > 10_000
    assert isinstance(run("space", "plot", "-o", tmp_path / "a.doc").exception, BladegenError)
    result = run(
        "perturb", "nrel5mw", "-o", tmp_path, "--space", space, "--pga", "0.01,0",
        "--landmarks", 101, "--format", "stl",
    )  # fmt: skip
    assert result.exit_code == 0, result.output


def test_a_space_from_a_folder_of_airfoils(tmp_path):
    import numpy as np

    from strategies import naca

    folder = tmp_path / "airfoils"
    folder.mkdir()
    for i, thickness in enumerate((0.12, 0.15, 0.18, 0.21)):
        rows = "\n".join(f"{x:.6f} {y:.6f}" for x, y in naca(thickness, 0.01 * i, 0.002))
        (folder / f"foil{i}.dat").write_text(f"FOIL {i}\n{rows}\n")
    out = tmp_path / "own.npz"
    command = ["space", "build", "-o", out, "--airfoils", folder, "--count", 0, "--modes", 2]
    assert run(*command).exit_code == 0
    (folder / "broken.dat").write_text("nothing here")
    refused = run(*command)
    assert isinstance(refused.exception, BladegenError)
    assert "--skip-unusable" in str(refused.exception)
    assert run(*command, "--skip-unusable").exit_code == 0
    assert len(np.load(out)["coordinates"]) == 4
    empty = tmp_path / "empty"
    empty.mkdir()
    nothing = run("space", "build", "-o", out, "--airfoils", empty)
    assert "holds no airfoil files" in str(nothing.exception)


def test_light_solids_are_small_and_say_their_schema(tmp_path):
    result = run(
        "build", "dtu10mw", "-o", tmp_path, "--light", "--step", "ap214", "--format", "step"
    )
    assert result.exit_code == 0, result.output
    assert (tmp_path / "dtu10mw.step").stat().st_size < 2e6
    assert "AUTOMOTIVE_DESIGN" in (tmp_path / "dtu10mw.step").read_text()[:2000]
    report = json.loads((tmp_path / "dtu10mw.report.json").read_text())
    assert report["settings"]["tolerance_mm"] == 1.0
    assert report["solid"]["deviation_mm"]["maximum"] < 1.0
    assert report["figures"]["crease_deg"] > 0
    assert len(report["spanwise"]["area_m2"]) >= 60


def test_hub_radius_and_precone_reach_the_rotor(monkeypatch, tmp_path):
    seen = []
    monkeypatch.setattr(build, "_build", lambda *arguments: seen.append(arguments[-1]))
    words = ("build", "nrel5mw", "-o", tmp_path, "--landmarks", 101)
    done = run(*words, "--rotor", "--hub-radius", "2.5m", "--precone", "4")
    assert done.exit_code == 0
    assert seen[0].hub_radius == 2.5
    assert seen[0].cone == pytest.approx(math.radians(4.0))
    done = run(*words, "--hub-radius", "2.5m")
    assert isinstance(done.exception, BladegenError)
    assert "add --rotor" in str(done.exception)
    assert len(seen) == 1


@pytest.mark.parametrize("name", commands.SUMMARIES)
def test_the_list_of_commands_says_what_their_own_help_says(name):
    help_of_it = " ".join(commands.command_of(name).help.split())
    assert help_of_it.startswith(commands.SUMMARIES[name])
