from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.blade.blade import Blade
from bladegen.blade.edges import AsGiven, Sharp
from bladegen.cad import exchange, shapes, solids
from bladegen.definition.blade_definition import Distribution
from bladegen.errors import CadError
from bladegen.formats.reading import read
from bladegen.measures import properties
from bladegen.measures.checks import solid_figures
from bladegen.surface.tips import round_tip
from strategies import by_day

FACES = ["suction side", "pressure side", "trailing edge", "root", "tip"]


@pytest.fixture(scope="module", params=by_day("iea15mw"))
def blade(request):
    return Blade.from_definition(read(request.param))


@pytest.fixture(scope="module")
def coarse(blade):
    """The same blade by fewer landmarks, for what holds at any number of them."""
    return Blade.from_definition(blade.definition, landmarks=101)


@pytest.fixture(scope="module")
def solid(blade):
    return solids.solid(blade)


@pytest.fixture(scope="module")
def step(solid, tmp_path_factory):
    path = tmp_path_factory.mktemp("step") / "blade.step"
    exchange.write_step(solid, path)
    return path


def names_in(text):
    """Names of the advanced faces in a STEP file."""
    return [line.split("'")[1] for line in text.splitlines() if "ADVANCED_FACE('" in line]


def test_the_file_is_one_valid_closed_solid_with_the_same_volume(solid, step):
    figures = solid_figures(exchange.read_step(step), quick=True)
    assert figures["one_solid"]
    assert figures["valid"]
    assert figures["closed"]
    assert figures["faces"] == 5
    before = shapes.quick_volume(solid.shape) * 1e-9
    assert_allclose(figures["volume_m3"], before, rtol=1e-9)


def test_the_file_says_its_schema_unit_and_faces(solid, step):
    text = step.read_text()
    assert "AP242" in text
    assert "SI_UNIT(.MILLI.,.METRE.)" in text
    assert names_in(text) == FACES
    assert [name for name, _ in solid.faces] == FACES
    assert step.stat().st_size < 15e6


def test_the_deviation_is_within_the_issue_s_limits(solid):
    assert solid.deviation.maximum < 0.3e-3
    assert solid.deviation.rms < 0.03e-3


def test_occt_finds_points_of_the_blade_on_the_file_s_surface(blade, step):
    """Independent of our own measure: spans and landmarks that the net does not use."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
    from OCP.BRepExtrema import BRepExtrema_DistShapeShape
    from OCP.gp import gp_Pnt
    from OCP.TopAbs import TopAbs_SHELL
    from OCP.TopExp import TopExp_Explorer

    shell = TopExp_Explorer(exchange.read_step(step), TopAbs_SHELL).Current()
    rng = np.random.default_rng(3)
    half = np.sort(rng.uniform(0, 0.5, 3))
    u = np.concatenate([half, 1 - half[::-1]])
    points = 1e3 * blade.sections(rng.uniform(0, 1, 2), u).reshape(-1, 3)
    distances = []
    for point in points.tolist():
        vertex = BRepBuilderAPI_MakeVertex(gp_Pnt(*point)).Vertex()
        distances.append(BRepExtrema_DistShapeShape(vertex, shell).Value())
    assert max(distances) < 0.3


def test_volumes_agree(blade, solid):
    by_sections = properties.volume(blade)
    assert_allclose(solid.net.volume(), by_sections, rtol=5e-6)
    assert solid.volume == solid.net.volume()
    assert_allclose(shapes.volume(solid.shape) / 1e9, by_sections, rtol=1e-5)
    assert_allclose(solid.area, shapes.area(solid.shape) / 1e6, rtol=1e-12)


def test_ends_are_planes(solid):
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.GeomAbs import GeomAbs_Plane

    faces = dict(solid.faces)
    for end in ("root", "tip"):
        assert BRepAdaptor_Surface(faces[end]).GetType() == GeomAbs_Plane


def test_a_round_tip_leaves_one_valid_solid_and_adds_volume(coarse, solid):
    rounded = solids.solid(coarse, sections=60, tip=round_tip)
    figures = solid_figures(rounded.shape, quick=True)
    flat = solid_figures(solids.solid(coarse, sections=60).shape, quick=True)
    assert figures["one_solid"]
    assert figures["valid"]
    assert figures["closed"]
    assert figures["area_m2"] > flat["area_m2"]
    assert figures["bounds_m"][1][2] > flat["bounds_m"][1][2]
    assert rounded.tip_volume > 0 == solid.tip_volume
    assert_allclose(rounded.volume, shapes.volume(rounded.shape) / 1e9, rtol=5e-6)


@pytest.mark.nightly  # the exact volumes of the bundled blades are tested on every run
def test_occt_finds_the_exact_volume_of_a_twisted_variant():
    base = bg.Blade.from_definition(read("iea15mw"), path="spline")
    t = [-0.0924, -0.0263, 0.018, -0.041]
    variant = base.perturbed(
        bg.ShapeSpace.bundled(),
        t,
        thickness=0.91,
        camber=0.955,
        twist=0.0566,
        twist_scale=0.743,
        allow_odd=True,
    )
    made = solids.solid(variant, tolerance=1e-3)
    assert_allclose(shapes.volume(made.shape) / 1e9, made.volume, rtol=1e-5)


def test_a_sharp_edge_is_sewn_without_a_strip(coarse):
    sharp = solids.solid(coarse.with_trailing_edge(Sharp()), sections=80)
    assert [name for name, _ in sharp.faces] == [f for f in FACES if f != "trailing edge"]
    figures = solid_figures(sharp.shape, quick=True)
    assert figures["one_solid"]
    assert figures["valid"]


def test_an_edge_sharp_in_part_is_refused():
    given = Blade.from_definition(read("nrel5mw"), landmarks=101).with_trailing_edge(AsGiven())
    with pytest.raises(CadError, match="sharp at some spans and blunt at others"):
        solids.solid(given, sections=40)


def test_cadquery_can_go_on_from_the_solid():
    blade = Blade.from_definition(read("nrel5mw"), landmarks=101)
    solid = solids.solid(blade, sections=40)
    work = solid.workplane()
    assert work.val().isValid()
    assert_allclose(work.val().BoundingBox().zmax, 61500, atol=30)


def test_swept_blades_make_solids_too(tmp_path):
    definition = read("dtu10mw")
    grid = np.linspace(0, 1, 11)
    swept = replace(
        definition,
        name="swept blåde",
        axis=replace(definition.axis, y=Distribution(grid, 4.0 * grid**3)),
    )
    solid = solids.solid(Blade.from_definition(swept, landmarks=201))
    assert solid.deviation.maximum < 0.3e-3
    exchange.write_step(solid, tmp_path / "swept.step")
    assert solid_figures(exchange.read_step(tmp_path / "swept.step"), quick=True)["valid"]


def test_files_that_are_no_step_are_refused(tmp_path):
    bad = tmp_path / "bad.step"
    bad.write_text("solid nonsense")
    with pytest.raises(CadError, match="not a STEP file"):
        exchange.read_step(bad)


def test_a_folder_that_is_not_there_is_an_error(solid, tmp_path):
    with pytest.raises(CadError, match="could not write"):
        exchange.write_step(solid, tmp_path / "nowhere" / "blade.step")


def test_the_same_solid_with_the_same_time_makes_the_same_file(tmp_path, monkeypatch):
    blade = Blade.from_definition(read("dtu10mw"), landmarks=101)
    solid = solids.solid(blade, sections=40)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    for name in ("one.step", "two.step"):
        exchange.write_step(solid, tmp_path / name)
    one, two = ((tmp_path / name).read_text() for name in ("one.step", "two.step"))
    assert one == two
    assert "'1970-01-02T00:00:00'" in one
    assert "PRODUCT('dtu10mw','dtu10mw'" in one
