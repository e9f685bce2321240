import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands
from bladegen.errors import BladegenError, RenderError
from bladegen.families.folder import FamilyFolder, read_manifest
from bladegen.families.order import Order
from bladegen.families.run import run as make
from bladegen.views import contact_sheet, preview

FEW = ("--spans", "16", "--count", "5", "--seed", "3")


def run(*arguments):
    return CliRunner().invoke(commands.app, ["family", "dtu10mw", *map(str, arguments)])


def test_a_family_is_made_and_shown(tmp_path):
    from PIL import Image

    target = tmp_path / "family"
    result = run("-o", target, *FEW, "--vary", "twist=-2:2", "--design", "sobol", "--double")
    assert result.exit_code == 0, result.output
    assert "5 of 5" in result.output
    manifest = read_manifest(FamilyFolder(target), ("name", "twist_deg", "valid"))
    assert manifest["name"][0] == "dtu10mw-00000"
    assert np.abs(manifest["twist_deg"]).max() <= 2.0
    assert FamilyFolder(target).sections.dtype == np.float64
    picture = np.asarray(Image.open(target / "contact.png").convert("L"), dtype=float)
    assert picture.std() > 10
    again = run("-o", target, *FEW, "--vary", "twist=-2:2", "--design", "sobol", "--double")
    assert isinstance(again.exception, BladegenError)
    assert "--resume" in str(again.exception)


def test_a_manifest_is_a_table_of_the_next_family(tmp_path):
    assert run("-o", tmp_path / "one", *FEW, "--reach", "0.5").exit_code == 0
    manifest = tmp_path / "one" / "manifest.parquet"
    assert run("-o", tmp_path / "two", "--table", manifest, "--spans", "16").exit_code == 0
    one, two = (
        read_manifest(FamilyFolder(tmp_path / name), ("t1", "t4", "sections_sha256"))
        for name in ("one", "two")
    )
    assert one["sections_sha256"] == two["sections_sha256"]


def test_affine_parameters_alone_may_vary_on_any_number_of_landmarks(tmp_path):
    result = run("-o", tmp_path / "f", *FEW, "--space", "none", "--vary", "chord=0.9:1.1")
    assert result.exit_code == 0, result.output


def test_variants_that_are_not_sound_are_told_of(tmp_path):
    bad = ("--vary", "t1=5:6", "--invalid", "keep")
    result = run("-o", tmp_path / "f", *FEW, *bad)
    assert result.exit_code == 0, result.output
    assert "0 of 5" in result.output
    assert "note: 5 variants are not sound" in result.output


def test_a_family_of_which_nothing_is_sound_has_failed(tmp_path):
    result = run("-o", tmp_path / "f", *FEW, "--vary", "t1=5:6", "--tries", "2")
    assert result.exit_code == 1, result.output
    said = " ".join(str(result.exception).split())
    assert "none of 5 variants is sound" in said
    assert "--reach" in said


def test_variants_are_drawn_until_they_fulfil_conditions(tmp_path):
    where = "volume > 480 and t1 < 0.05"
    result = run("-o", tmp_path / "f", *FEW, "--reach", "0.5", "--where", where)
    assert result.exit_code == 0, result.output
    assert "5 of 5" in result.output
    manifest = read_manifest(FamilyFolder(tmp_path / "f"), ("volume_m3", "t1", "attempts"))
    assert manifest["volume_m3"].min() > 480
    assert manifest["t1"].max() < 0.05
    assert manifest["attempts"].max() > 1


def test_without_a_renderer_the_sheet_has_no_pictures(tmp_path, monkeypatch):
    def nothing(*_, **__):
        raise RenderError("nothing to render with")

    monkeypatch.setattr(preview, "gallery", nothing)
    result = run("-o", tmp_path / "f", *FEW)
    assert result.exit_code == 0, result.output
    assert "without pictures" in result.output


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (("--design", "grid"), "design: got 'grid'"),
        (("--vary", "height=1:2"), "factor 'height'"),
        (("--jobs", "0"), "jobs: got 0"),
        (("--format", "doc"), "suffix"),
        (("--table", "none.csv"), "leave --count"),
        (("--space", "none"), "nothing varies"),
        (("--where", "volume >"), "where: got 'volume >', must be NAME"),
        (("--where", "mass < 3"), "where: 'mass' is not known while variants are drawn, but t1,"),
        (("--dask", "tcp://127.0.0.1:9"), "no scheduler answers"),
    ],
)
def test_what_cannot_be_is_said_in_one_line(tmp_path, monkeypatch, more, said):
    if "--dask" in more:
        import distributed

        def refused(*_, **__):
            raise OSError("Timed out")

        monkeypatch.setattr(distributed, "Client", refused)
    result = run("-o", tmp_path / "f", *FEW, *more)
    assert isinstance(result.exception, BladegenError)
    assert said in str(result.exception)


def test_a_missing_dask_says_how_to_get_it(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    result = run("-o", tmp_path / "f", *FEW, "--dask", "tcp://127.0.0.1:9")
    assert "pip install 'bladegen[dask]'" in str(result.exception)


def test_many_variants_are_thinned_in_the_overlay(monkeypatch, tmp_path):
    monkeypatch.setattr(contact_sheet, "MOST", 2)
    result = run("-o", tmp_path / "f", *FEW)
    assert "2 of 5 sound variants overlaid" in result.output


def test_variants_are_blades_of_commands(tmp_path):
    """A family's variant could be looked at in Python alone."""
    import trimesh

    def command(*words):
        return CliRunner().invoke(commands.app, [*map(str, words)])

    folder = tmp_path / "fam"
    made = command("family", "nrel5mw", "-o", folder, "--count", 2, "--spans", 12, "--reach", 0.2)
    assert made.exit_code == 0, made.output
    wanted = bg.load_family(folder)[1].volume
    for name in ("1", "nrel5mw-00001"):
        shown = command("build", folder / name, "-o", tmp_path / name, "--format", "stl")
        assert shown.exit_code == 0, shown.output
        mesh = trimesh.load(tmp_path / name / "nrel5mw-00001.stl")
        assert mesh.volume == pytest.approx(wanted, rel=1e-3)
    one = ("build", folder / "1", "-o", tmp_path)
    for words, said in (
        (("preview", folder), "is a family's folder; name one of its variants: "),
        (("preview", folder / "7"), "variant: got 7, allowed is 0 to 1"),
        (("preview", folder / "nrel5mw-00002"), "has no variant 'nrel5mw-00002', but 0 to 1 and"),
        ((*one, "--landmarks", "201"), "with 401 landmarks; leave options out"),
        ((*one, "--path", "geodesic"), "a variant is made as its family was"),
        (("build", "nrel5mw", "-o", "s3://bucket/out"), "must be a folder of this machine"),
    ):
        result = command(*words)
        assert isinstance(result.exception, BladegenError)
        assert said in str(result.exception)
    assert not Path("s3:").exists()


@pytest.mark.nightly
def test_variants_are_blades_of_commands_that_read_definitions(tmp_path):
    """`convert`, `info` and others said that there is no such blade."""
    blade = bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=61)
    bounds = {"chord": (0.9, 0.95)}
    planned = bg.family(blade, count=2, spans=16, bounds=bounds, design="box")
    make(Order(planned, tmp_path / "fam"))

    def command(*words):
        done = CliRunner().invoke(commands.app, [*map(str, words)])
        assert done.exit_code == 0, done.output
        return done.output

    def volume(file):
        return bg.Blade.from_definition(bg.read(tmp_path / file), landmarks=61).volume

    one, keep = tmp_path / "fam" / "1", ("--polars", "keep")
    said = command("convert", one, tmp_path / "one.yaml", "--hub-radius", "3m", *keep)
    assert "a family's variant" in said
    assert bg.read(tmp_path / "one.yaml").rotor.hub_radius == 3.0
    shutil.copy(bg.read("dtu10mw").source, tmp_path / "full.yaml")
    command("convert", one, tmp_path / "turbine.yaml", "--into", tmp_path / "full.yaml", *keep)
    wanted = planned[1].volume
    assert wanted < 0.97 * blade.volume
    assert volume("one.yaml") == pytest.approx(wanted, rel=1e-4)
    assert volume("turbine.yaml") == pytest.approx(wanted, rel=1e-4)
    assert json.loads(command("info", one, "--json"))["blade"] == "dtu10mw-00001"


def test_how_a_family_spreads_is_drawn(tmp_path):
    from PIL import Image

    assert run("-o", tmp_path / "fam", *FEW).exit_code == 0
    pictures = []
    for name, more in (("a.png", ()), ("b.png", ("--where", "attempts >= 1"))):
        words = ["info", str(tmp_path / "fam"), "--plot", str(tmp_path / name), *more]
        shown = CliRunner().invoke(commands.app, words)
        assert shown.exit_code == 0, shown.output
        assert "wrote" in shown.output
        pictures.append(np.asarray(Image.open(tmp_path / name).convert("RGB"), dtype=float))
    orange = [((p[..., 0] > 200) & (p[..., 1] < 130) & (p[..., 2] < 60)).sum() for p in pictures]
    assert orange[0] == 0
    assert orange[1] > 1000  # those that fulfil conditions
    assert pictures[0].std() > 10
    words = ["info", "nrel5mw", "--plot", str(tmp_path / "c.png")]
    assert "plot: is for a family" in str(CliRunner().invoke(commands.app, words).exception)
