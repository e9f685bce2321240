import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cad import exchange, solids
from bladegen.cli import commands
from bladegen.errors import BladegenError, FileError
from bladegen.measures import surfaces
from bladegen.surface import mesh
from bladegen.surface.mesh import TriangleMesh
from bladegen.views.comparison import Side, compared, surface_of

pytestmark = pytest.mark.usefixtures("foreign_here")


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)


@pytest.fixture(scope="module")
def own(blade):
    """The blade's own surface."""
    return surface_of(blade)


@pytest.fixture(scope="module")
def triangles(blade):
    return mesh.from_blade(blade, stations=60)


@pytest.fixture(scope="module")
def solid(blade):
    return solids.solid(blade, tolerance=1e-3)


@pytest.fixture(scope="module")
def step(solid, tmp_path_factory):
    path = tmp_path_factory.mktemp("solid") / "one.step"
    exchange.write_step(solid, path)
    return path


def side(triangles, name="a mesh", **known):
    return Side(name, surfaces.of_mesh(triangles), **known)


def scaled(triangles, factor):
    return TriangleMesh(triangles.vertices * factor, triangles.faces)


def test_a_surface_is_no_distance_from_itself(triangles):
    found = compared(side(triangles), side(triangles))
    assert found.figures["maximum_mm"] < 1e-6
    assert found.notes == ()


def test_a_shifted_box_is_as_far_as_it_was_shifted():
    import trimesh

    box = trimesh.creation.box((2.0, 3.0, 40.0))
    one = TriangleMesh(box.vertices, box.faces)
    found = compared(side(scaled(one, 1.01)), side(one))
    corner = np.linalg.norm([0.01, 0.015, 0.2])  # outside: as far as the corners are apart
    assert_allclose(found.of_one, corner, rtol=1e-6)
    assert_allclose(found.of_other, -0.01, rtol=1e-6)  # inside: to the nearest face
    assert_allclose(found.figures["maximum_mm"], 1000 * corner, rtol=1e-6)


def test_bands_tell_where(triangles):
    moved = np.array(triangles.vertices)
    outer = moved[:, 2] > 0.75 * moved[:, 2].max()
    moved[outer, 0] += 0.02
    found = compared(side(TriangleMesh(moved, triangles.faces)), side(triangles))
    bands = found.bands()
    assert len(bands) == 10
    assert bands[2]["maximum_mm"] < 1e-6
    assert 10 < bands[-2]["maximum_mm"] <= 20.0 + 1e-6


def test_a_solid_is_as_far_from_its_blade_as_the_build_measured(own, solid, step):
    found = compared(surface_of(step), own)
    wanted = 1e3 * solid.deviation.maximum
    assert_allclose(found.figures["maximum_mm"], wanted, atol=0.01)
    assert found.notes == ()


def test_a_solid_that_was_moved_is_as_far_as_it_was_moved(solid):
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
    from OCP.gp import gp_Trsf, gp_Vec

    move = gp_Trsf()
    move.SetTranslation(gp_Vec(0.0, 0.0, 1.0))
    moved = BRepBuilderAPI_Transform(solid.shape, move).Shape()
    from bladegen.cad import face_patches

    one, two = (surfaces.of_faces(face_patches.faces(s)[0]) for s in (solid.shape, moved))
    found = compared(Side("one", one), Side("two", two))
    assert_allclose(found.figures["maximum_mm"], 1.0, atol=1e-4)  # at the flat ends


UNITLESS = {"measured": False}
DEFINED = {"defined": True}


@pytest.mark.parametrize(
    ("first", "second", "length", "said"),
    [
        ((1000.0, UNITLESS), (1.0, DEFINED), 86.4, "the first names no unit"),
        ((1.0, {}), (1000.0, UNITLESS), 86.4, "the second names no unit"),
        ((1000.0, UNITLESS), (1.0, UNITLESS), 86.4, "the first names no unit"),
        ((1e-3, {}), (1.0, DEFINED), 86.4, "the first is a thousandth of the second"),
        ((1.0, DEFINED), (1e-3, {}), 86.4, "the second is a thousandth of the first"),
        ((1000.0, {}), (1.0, DEFINED), 86.4, "the first is a thousand times the second"),
        ((1e-3, UNITLESS), (1.0, DEFINED), 86.4, "the first is a thousandth of the second"),
    ],
)
def test_a_factor_of_a_thousand_is_said(triangles, first, second, length, said):
    pair = (
        side(scaled(triangles, factor), name, **known)
        for name, (factor, known) in zip(("the first", "the second"), (first, second), strict=True)
    )
    found = compared(*pair)
    assert said in found.notes[0]
    assert found.figures["maximum_mm"] < 1e-6
    assert_allclose(found.bands()[-1]["to_z_m"], length, rtol=0.01)


@pytest.mark.parametrize("factor", [40.0, 25.4, 900.0, 1020.0, 1e6])
@pytest.mark.parametrize("known", [UNITLESS, {}])
def test_any_other_size_is_compared_as_it_is(triangles, factor, known):
    small = side(scaled(triangles, 1.0 / factor), "the model", **known)
    found = compared(small, side(triangles, "the blade", **DEFINED))
    assert "the blade is" in found.notes[0]
    assert "compared as they are" in found.notes[0]
    length = 1e3 * (1.0 - 1.0 / factor) * triangles.vertices[:, 2].max()
    assert_allclose(found.figures["maximum_mm"], length, rtol=0.01)


def test_files_say_their_unit(blade, tmp_path):
    for suffix, known in ((".stl", False), (".3mf", True), (".glb", True), (".vtp", False)):
        found = surface_of(bg.export(blade, tmp_path / f"a{suffix}", stations=12))
        assert found.measured is known
        assert found.name == f"the {suffix[1:].upper()} file a{suffix}"
        assert_allclose(found.surface.size, 86.4, rtol=0.01)


def test_check_compares_two_and_draws(blade, tmp_path):
    from PIL import Image

    bg.export(blade, tmp_path / "a.stl", stations=60)
    bg.export(blade.perturbed(chord_scale=1.02), tmp_path / "b.stl", stations=60)
    picture = tmp_path / "apart.png"
    runner = CliRunner()
    files = [str(tmp_path / "a.stl"), str(tmp_path / "b.stl")]
    result = runner.invoke(commands.app, ["check", *files, "--screenshot", str(picture)])
    assert result.exit_code == 0, result.output
    assert "RMS" in result.output
    assert np.asarray(Image.open(picture).convert("L"), dtype=float).std() > 5
    figures = json.loads(runner.invoke(commands.app, ["check", *files, "--json"]).output)
    root = blade.chord(0.0) / 2 * 0.02 * 1000
    assert figures["maximum_mm"] > root
    assert len(figures["bands"]) == 10


def test_check_says_first_what_the_rest_rests_on(step, tmp_path):
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
    from OCP.gp import gp_Pnt, gp_Trsf
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

    shrink = gp_Trsf()
    shrink.SetScale(gp_Pnt(0, 0, 0), 1e-3)
    writer = STEPControl_Writer()
    shape = BRepBuilderAPI_Transform(exchange.read(step), shrink, True).Shape()
    writer.Transfer(shape, STEPControl_AsIs)
    writer.Write(str(tmp_path / "small.step"))
    result = CliRunner().invoke(commands.app, ["check", str(tmp_path / "small.step"), "dtu10mw"])
    assert result.exit_code == 0
    said = result.output.splitlines()[0]
    assert said.startswith("note: the STEP file small.step is a thousandth of the definition")
    assert "86.37" in result.output


@pytest.mark.parametrize("name", ["none.stl", "text.txt"])
def test_what_has_no_surface_is_refused(tmp_path, name):
    if name.endswith("txt"):
        (tmp_path / name).write_text("x")
    with pytest.raises(FileError):
        surface_of(tmp_path / name)


def test_a_surface_of_no_numbers_is_refused(step, monkeypatch):
    from bladegen.measures import foreign

    honest = foreign.ask("surface", step)
    for name, value, said in (
        ("0/poles", np.nan, "no numbers"),
        ("0/weights", 0.0, "no numbers"),
        ("0/poles", 1e300, r"a number of 1e\+300 in its surface, allowed is 1e\+09"),
    ):
        arrays = dict(honest.arrays) | {"0/weights": np.ones(honest.arrays["0/poles"].shape[:2])}
        arrays[name] = np.full_like(arrays[name], value)
        monkeypatch.setattr(foreign, "ask", lambda *_, a=arrays: foreign.Answer(honest.facts, a))
        with pytest.raises(FileError, match=said):
            surface_of(step)


def test_faces_that_are_lost_are_said(step, blade, monkeypatch):
    from bladegen.measures import foreign

    honest = foreign.ask("surface", step)
    told = foreign.Answer(honest.facts | {"lost": 2}, honest.arrays)
    monkeypatch.setattr(foreign, "ask", lambda *_: told)
    assert surface_of(step).remarks == ("one.step: 2 of its faces could not be read",)


def test_a_picture_needs_two():
    result = CliRunner().invoke(commands.app, ["check", "dtu10mw", "--screenshot", "x.png"])
    assert isinstance(result.exception, BladegenError)


def test_the_name_of_a_definition_is_its_files(own):
    assert own.name == f"the definition {Path(bg.read('dtu10mw').source).name}"
