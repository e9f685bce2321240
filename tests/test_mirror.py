"""The mirror image of a blade: everything that is written of it is mirrored, and says so."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cad import shapes, solids
from bladegen.cad.rotor import rotor_of
from bladegen.cli import commands
from bladegen.cli.options import common
from bladegen.errors import ExportError
from bladegen.exports.options import Options
from bladegen.exports.products import Products
from bladegen.families.family import Family
from bladegen.families.folder import FamilyFolder, read_manifest
from bladegen.families.order import Order
from bladegen.measures import checks, properties
from bladegen.measures.spanwise import spanwise
from bladegen.surface import fitting, mesh, mesh_files
from bladegen.surface.grids.grid import Spacing
from bladegen.surface.grids.grid import from_blade as grid_of
from bladegen.surface.tips import flat_tip, round_tip
from bladegen.views import preview
from bladegen.views.rendering.blade_scene import scene_of

FLIP = np.array([1.0, -1.0, 1.0])


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101)


@pytest.fixture(scope="module")
def image(blade):
    return blade.mirror_image()


def test_sections_are_mirrored_and_go_round_the_same_way(blade, image):
    eta = np.linspace(0.0, 1.0, 7)
    assert_allclose(image.sections(eta), blade.sections(eta)[:, ::-1] * FLIP, atol=0)
    u = np.linspace(0.0, 1.0, 33)
    assert_allclose(image.sections(eta, u), blade.sections(eta, u)[:, ::-1] * FLIP, atol=0)
    assert_allclose(image.axis(eta), blade.axis(eta) * FLIP, atol=0)
    assert_allclose(image.mirror_image().sections(eta), blade.sections(eta), atol=0)
    assert (image.name, image.mirror_image().name) == ("iea15mw-mirrored", "iea15mw")
    assert properties.volume(image) == properties.volume(blade)
    assert checks.check_blade(image).problems == ()


@pytest.mark.parametrize("tip", [flat_tip, round_tip])
def test_meshes_are_mirrored_and_look_outward(blade, image, tip):
    one, two = (mesh.from_blade(b, stations=40, tip=tip) for b in (blade, image))
    assert two.volume == pytest.approx(one.volume, rel=1e-12)
    assert_allclose(two.vertices.min(axis=0), (one.vertices * FLIP).min(axis=0), atol=1e-12)
    assert_allclose(two.vertices.max(axis=0), (one.vertices * FLIP).max(axis=0), atol=1e-12)
    figures = checks.mesh_figures(mesh_files.to_trimesh(two))
    assert figures["watertight"]
    assert figures["outward"]


def test_a_solid_is_mirrored_and_its_faces_keep_their_names(blade, image):
    one, two = (solids.solid(b, tolerance=5e-3, sections=30) for b in (blade, image))
    assert two.volume == pytest.approx(one.volume, rel=1e-12)
    assert shapes.is_valid(two.shape)
    assert {name for name, _ in one.faces} == {name for name, _ in two.faces}
    assert two.deviation.maximum == pytest.approx(one.deviation.maximum, rel=1e-6)
    boxes = [
        {name: checks.solid_figures(face, quick=True)["bounds_m"] for name, face in s.faces}
        for s in (one, two)
    ]
    for name, (low, high) in boxes[0].items():
        mirrored = [[low[0], -high[1], low[2]], [high[0], -low[1], high[2]]]
        assert_allclose(boxes[1][name], mirrored, atol=2e-6)
    assert two.name == "iea15mw-mirrored"


def test_a_grid_is_mirrored_and_its_blocks_keep_their_names(blade, image):
    spacing = Spacing(around=33, along=9, edge=4, leading_edge=0.02, trailing_edge=0.02, root=0.1)
    one, two = ({b.name: b for b in grid_of(b, spacing).blocks} for b in (blade, image))
    assert one.keys() == two.keys()
    for name, block in one.items():
        points, mirrored = (
            np.unique(p.reshape(-1, 3).round(9), axis=0)
            for p in (two[name].points, block.points * FLIP)
        )
        assert_allclose(points, mirrored, atol=1e-8)
        assert two[name].family == block.family


def test_a_solid_is_measured_on_the_sides_that_it_names(image):
    found, deviation = fitting.fitted(image, 5e-3, sections=30)
    assert [part.face for part in deviation.parts][:2] == ["pressure side", "suction side"]
    assert found.volume() > 0


def test_what_cannot_hold_a_mirror_image_says_so(image, tmp_path):
    for suffix in (".yaml", ".dat", ".htc", ".csv", ".xlsx"):
        with pytest.raises(ExportError, match="mirror: blade definitions have y to the trailing"):
            bg.export(image, tmp_path / f"a{suffix}")
    family = bg.family(image, None, count=2, bounds={"twist": (0.0, 0.1)})
    with pytest.raises(ExportError, match="mirror: blade definitions have y to the trailing"):
        Order(family, tmp_path, ("stl", "yaml"))
    assert list(tmp_path.iterdir()) == []


def test_the_command_mirrors_every_file_without_a_hub_radius(tmp_path):
    command = ["build", "dtu10mw", "-o", str(tmp_path), "--mirror", "--landmarks", "101"]
    asked = ["stl", "ply", "vtp", "sections.csv", "p3d"]
    asked = [word for suffix in asked for word in ("--format", suffix)]
    done = CliRunner().invoke(commands.app, [*command, *asked, "--stations", "45"])
    assert done.exit_code == 0, done.output
    assert "mirror image" in done.output
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {
        f"dtu10mw-mirrored.{suffix}"
        for suffix in ("stl", "ply", "vtp", "sections.csv", "p3d", "report.json", "spanwise.csv")
    }
    report = json.loads((tmp_path / "dtu10mw-mirrored.report.json").read_text())
    assert report["blade"] == "dtu10mw-mirrored"
    assert report["settings"]["mirrored"]
    plain = bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)
    bg.export(plain, tmp_path / "plain.stl", stations=45)
    one, two = (mesh_files.read(tmp_path / name) for name in ("plain.stl", "dtu10mw-mirrored.stl"))
    assert_allclose(two.bounds[:, 1], -one.bounds[::-1, 1], atol=1e-6)
    assert two.volume == pytest.approx(one.volume, rel=1e-6)
    refused = CliRunner().invoke(commands.app, [*command, "--format", "yaml"])
    assert isinstance(refused.exception, ExportError)


def test_pictures_say_it(blade, image):
    assert scene_of(image).title == "IEA 15 MW, mirrored"
    assert scene_of(blade).title == "IEA 15 MW"


def test_a_rotor_of_mirror_images_is_the_mirrored_rotor(blade, image):
    products = [Products(b, Options(stations=20)) for b in (blade, image)]
    one, two = products[0].mesh, products[1].mesh
    assert_allclose(np.sort(two.vertices[:, 1]), np.sort(-one.vertices[:, 1]), atol=1e-12)
    assert rotor_of(image) == rotor_of(blade)  # its blades are mirrored already


def test_views_show_the_mirror_image_and_its_baseline(blade, monkeypatch, tmp_path):
    shown = []
    monkeypatch.setattr(common.Making, "blade", lambda *_: blade)

    def picture(*given, **named):
        shown.append((given, named))
        Image.new("RGB", (8, 8)).save(given[1])

    monkeypatch.setattr(preview, "picture", picture)
    words = ["preview", "iea15mw", "--mirror", "--twist", "1", "--screenshot"]
    done = CliRunner().invoke(commands.app, [*words, str(tmp_path / "a.png")])
    assert done.exit_code == 0, repr(done.exception)
    ((one, _), named) = shown[0]
    assert one.mirrored
    assert named["baseline"].mirrored
    assert named["baseline"].changes == ()
    assert one.name == "iea15mw-perturbed-mirrored"


def test_figures_over_span_are_those_of_the_blade(blade, image):
    eta = np.linspace(0.0, 1.0, 9)
    one, two = spanwise(blade, eta), spanwise(image, eta)
    for name, values in one.items():
        assert_allclose(two[name], -values if name == "y_m" else values, atol=1e-12, err_msg=name)


def test_a_family_of_a_mirror_image_is_the_family_mirrored(blade, image):
    space = bg.ShapeSpace.bundled()
    asked = {"count": 3, "seed": 5, "bounds": {"twist": (-0.05, 0.05)}, "spans": 20}
    one, two = (bg.family(b, space, **asked) for b in (blade, image))
    assert isinstance(two, Family)
    places = np.arange(3)
    plain, mirrored = (f.block(places, dtype=np.float32, measured=True) for f in (one, two))
    assert mirrored.batch.sections.dtype == np.float32
    wanted = plain.batch.sections[:, :, ::-1] * FLIP.astype(np.float32)
    assert_allclose(mirrored.batch.sections, wanted, atol=0)
    for what in ("chord", "twist", "relative_thickness", "measures"):
        assert_allclose(getattr(mirrored.batch, what), getattr(plain.batch, what), atol=0)
    assert two.name(1) == "iea15mw-00001-mirrored"
    variant = two[1]
    assert (variant.name, variant.mirrored) == (two.name(1), True)
    assert_allclose(variant.sections(two.eta), mirrored.batch.sections[1], atol=2e-5)
    assert two.table()["name"].to_pylist()[2] == two.name(2)


def test_the_command_mirrors_a_family(tmp_path, blade, monkeypatch):
    monkeypatch.setattr(common.Making, "blade", lambda *_: blade)
    words = "family iea15mw --mirror --space none --vary twist=-1:1 --count 2 --spans 16"
    words += f" --format stl --stations 20 -o {tmp_path}"
    done = CliRunner().invoke(commands.app, words.split())
    assert done.exit_code == 0, repr(done.exception)
    assert "iea15mw-mirrored" in done.output
    rows = read_manifest(FamilyFolder(tmp_path), ("name", "stl_file", "volume_m3"))
    assert list(rows["name"]) == ["iea15mw-00000-mirrored", "iea15mw-00001-mirrored"]
    assert list(rows["stl_file"]) == [f"blades/{name}.stl" for name in rows["name"]]
    solid = mesh_files.read(tmp_path / rows["stl_file"][0])
    assert solid.vertices[:, 1].min() < -3  # the trailing edge lies at -y
    assert solid.volume > 0
