"""`bladegen convert` as users call it."""

from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands
from bladegen.cli.terminal import print_findings

RUN = CliRunner()


def run(*arguments):
    return RUN.invoke(commands.app, [str(argument) for argument in arguments])


def test_convert_says_what_it_read_and_wrote_and_what_is_lost(tmp_path):
    result = run("convert", "nrel5mw", tmp_path / "one.yaml", "--to", "windio1")
    assert result.exit_code == 0, result.output
    assert "windIO 2" in result.output
    assert "windIO 1" in result.output
    assert "note: pitch_axis: section_offset_y over chord" in result.output
    assert bg.read(tmp_path / "one.yaml").format == "windIO 1"


def test_convert_refuses_before_it_reads(tmp_path):
    result = run("convert", "nosuch", tmp_path / "a.step")
    assert "suffix '.step'" in str(result.exception)
    assert not list(tmp_path.iterdir())


def test_a_variant_leaves_as_windio_by_perturb(tmp_path):
    result = run(
        "perturb", "nrel5mw", "-o", tmp_path, "--thickness", 1.05, "--format", "yaml",
        "--polars", "none", "--stations", 40, "--name", "v",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    assert "note: perturbed airfoils: " in result.output
    definition = bg.read(tmp_path / "v.yaml")
    assert definition.stations[-1].airfoil.name == "v-10000"
    assert definition.stations[-1].airfoil.relative_thickness > 0.185


def test_convert_puts_a_blade_into_a_turbine(tmp_path):
    run("convert", "nrel5mw", tmp_path / "full.yaml")
    result = run(
        "convert", "dtu10mw", tmp_path / "new.yaml", "--into", tmp_path / "full.yaml",
        "--polars", "none",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    assert "order, comments and anchors kept" in " ".join(result.output.split())
    made = bg.read(tmp_path / "new.yaml")
    assert made.length == bg.read("dtu10mw").length
    assert made.rotor.hub_radius == bg.read("nrel5mw").rotor.hub_radius
    result = run(
        "convert", "dtu10mw", tmp_path / "x.yaml", "--into", tmp_path / "full.yaml", "--to", "x"
    )
    assert "leave one of --to, --into out" in str(result.exception)


def test_convert_writes_airfoil_files_into_a_folder(tmp_path):
    result = run("convert", "nrel5mw", tmp_path / "foils")
    assert result.exit_code == 0, result.output
    assert "chord, twist, axis and places left out" in result.output
    assert len(list((tmp_path / "foils").glob("*.dat"))) == 8


def test_findings_of_one_kind_are_cut_short(capsys):
    alike = [
        f"eta = {k / 100}: side {k} has a dent, {k / 9:.2f} % of the chord deep" for k in range(9)
    ]
    print_findings([*alike, "polars: 9 airfoils with an estimate"])
    lines = capsys.readouterr().out.splitlines()
    assert lines[:3] == [f"note: {text}" for text in alike[:3]]
    assert lines[3:] == [
        "note: and 6 more like the last", "note: polars: 9 airfoils with an estimate"
    ]  # fmt: skip
