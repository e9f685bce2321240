import json
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

import bladegen
from bladegen import cli
from bladegen.errors import BladegenError

RUN = CliRunner()


def run(*arguments):
    return RUN.invoke(cli.app, [str(argument) for argument in arguments])


def main(*arguments):
    """The command as users call it, in a process of its own."""
    command = [sys.executable, "-c", "from bladegen.cli import main; main()", *map(str, arguments)]
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
    assert names == {"nrel5mw.stl", "nrel5mw.ply", "nrel5mw.report.json"}
    assert "watertight" in result.output
    report = json.loads((tmp_path / "nrel5mw.report.json").read_text())
    assert report["settings"]["path"] == "spline_path"
    assert report["settings"]["mesh_unit"] == "mm"


def test_build_that_misses_its_tolerance_ends_with_1(tmp_path, monkeypatch):
    monkeypatch.setattr("bladegen.net.MAX_SECTIONS", 20)
    monkeypatch.setattr("bladegen.net.FIRST_SECTIONS", 20)
    result = run("build", "nrel5mw", "-o", tmp_path, "--format", "step", "--tolerance", "0.001mm")
    assert isinstance(result.exception, BladegenError)
    assert "out-of-tolerance" in str(result.exception)


@pytest.mark.parametrize("edge", ["given", "sharp", "5mm"])
def test_preview_writes_pictures(edge, tmp_path):
    png = tmp_path / "a.png"
    result = run(
        "preview", "nrel5mw", "--screenshot", png, "--landmarks", 101,
        "--trailing-edge", edge,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    assert png.stat().st_size > 10_000


def test_preview_opens_a_window(monkeypatch):
    shown = []
    monkeypatch.setattr("bladegen.preview.show", shown.append)
    assert run("preview", "nrel5mw", "--landmarks", 51).exit_code == 0
    assert shown[0].name == "nrel5mw"


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


def test_check_of_something_unsound_ends_with_1(tmp_path):
    path = tmp_path / "open.stl"
    path.write_text(
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid a\n"
    )
    done = main("check", path)
    assert done.returncode == 1
    assert "watertight" in done.stdout
    assert done.stderr.startswith("bladegen: ")
    assert "is not watertight" in done.stderr


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
def test_errors_are_one_line_and_exit_code_1(arguments, words, tmp_path):
    done = main(*arguments)
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1
    assert done.stderr.startswith("bladegen: ")
    for word in words:
        assert word in done.stderr


def test_usage_errors_have_exit_code_2():
    assert main("build").returncode == 2
    assert main("frobnicate").returncode == 2
    assert main("build", "nrel5mw", "-o", ".", "--path", "cubic").returncode == 2


def test_version_and_help():
    assert main("--version").stdout == f"bladegen {bladegen.__version__}\n"
    assert "build" in main("--help").stdout


def test_an_interrupt_is_said_shortly(monkeypatch, capsys):
    def interrupt():
        raise KeyboardInterrupt

    monkeypatch.setattr(cli, "app", interrupt)
    with pytest.raises(SystemExit, match="130"):
        cli.main()
    assert capsys.readouterr().err == "bladegen: interrupted\n"
