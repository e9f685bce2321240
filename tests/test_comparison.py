import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import bladegen as bg
from bladegen import cad, cad_files, cli, mesh
from bladegen.comparison import compared, surface_of
from bladegen.errors import BladegenError, FileError
from bladegen.mesh import TriangleMesh


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)


@pytest.fixture(scope="module")
def surface(blade):
    return mesh.from_blade(blade, stations=60)


def test_a_surface_is_no_distance_from_itself(surface):
    found, note = compared(surface, surface)
    assert found.figures["maximum_mm"] < 1e-6
    assert note == ""


def test_a_shifted_box_is_as_far_as_it_was_shifted():
    import trimesh

    box = trimesh.creation.box((2.0, 3.0, 40.0))
    one = TriangleMesh(box.vertices, box.faces)
    other = TriangleMesh(box.vertices * 1.01, box.faces)
    found, _ = compared(other, one)
    corner = np.linalg.norm([0.01, 0.015, 0.2])  # outside: as far as the corners are apart
    assert_allclose(found.of_one, corner, rtol=1e-6)
    assert_allclose(found.of_other, -0.01, rtol=1e-6)  # inside: to the nearest face
    assert_allclose(found.figures["maximum_mm"], 1000 * corner, rtol=1e-6)


def test_bands_tell_where(surface):
    moved = np.array(surface.vertices)
    outer = moved[:, 2] > 0.75 * moved[:, 2].max()
    moved[outer, 0] += 0.02
    found, _ = compared(TriangleMesh(moved, surface.faces), surface)
    bands = found.bands()
    assert len(bands) == 10
    assert bands[2]["maximum_mm"] < 1e-6
    assert 10 < bands[-2]["maximum_mm"] <= 20.0 + 1e-6


def test_millimetres_are_noticed(surface):
    large = TriangleMesh(surface.vertices * 1000.0, surface.faces)
    for pair, which in (((large, surface), "first"), ((surface, large), "second")):
        found, note = compared(*pair)
        assert found.figures["maximum_mm"] < 1e-6
        assert which in note


def test_a_solid_lies_on_its_mesh(blade, surface, tmp_path):
    cad_files.write_step(cad.solid(blade, sections=60), tmp_path / "one.step")
    bg.export(blade, tmp_path / "two.stl")
    one, two = (surface_of(tmp_path / name) for name in ("one.step", "two.stl"))
    found, _ = compared(one, two)
    assert found.figures["rms_mm"] < 3.0
    assert found.figures["maximum_mm"] < 20.0


def test_check_compares_two_and_draws(blade, tmp_path):
    from PIL import Image

    bg.export(blade, tmp_path / "a.stl")
    bg.export(blade.perturbed(chord_scale=1.02), tmp_path / "b.stl")
    picture = tmp_path / "apart.png"
    runner = CliRunner()
    files = [str(tmp_path / "a.stl"), str(tmp_path / "b.stl")]
    result = runner.invoke(cli.app, ["check", *files, "--screenshot", str(picture)])
    assert result.exit_code == 0, result.output
    assert "RMS" in result.output
    assert np.asarray(Image.open(picture).convert("L"), dtype=float).std() > 5
    figures = json.loads(runner.invoke(cli.app, ["check", *files, "--json"]).output)
    root = blade.chord(0.0) / 2 * 0.02 * 1000
    assert figures["maximum_mm"] > root
    assert len(figures["bands"]) == 10


@pytest.mark.parametrize("name", ["none.stl", "text.txt"])
def test_what_has_no_surface_is_refused(tmp_path, name):
    if name.endswith("txt"):
        (tmp_path / name).write_text("x")
    with pytest.raises(FileError):
        surface_of(tmp_path / name)


def test_a_picture_needs_two():
    result = CliRunner().invoke(cli.app, ["check", "dtu10mw", "--screenshot", "x.png"])
    assert isinstance(result.exception, BladegenError)
