import json

import pytest

import bladegen as bg
from bladegen.cad import exchange, shapes
from bladegen.errors import ExportError, ToleranceError
from bladegen.exports.build import build, report_path
from bladegen.exports.options import Options
from bladegen.families.order import Order
from bladegen.surface.tips import round_tip
from bladegen.views.tables import report_rows


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("nrel5mw"))


@pytest.fixture(scope="module")
def folder(blade, tmp_path_factory):
    target = tmp_path_factory.mktemp("out") / "deep"
    said = []
    build(blade, target, progress=said.append)
    assert said
    return target


def test_the_default_files_are_made(folder):
    suffixes = {".step", ".stl", ".glb", ".png", ".json", ".csv"}
    assert {path.suffix for path in folder.iterdir()} == suffixes
    assert all(path.name.startswith("nrel5mw.") for path in folder.iterdir())
    assert (folder / "nrel5mw.combs.png").stat().st_size > 10_000


def test_the_report_meets_the_design(folder):
    report = json.loads(report_path(folder, "nrel5mw").read_text())
    figures, solid = report["figures"], report["solid"]
    assert figures["stations_missed_by_chord"] < 1e-9
    assert figures["chord_error_relative"] < 1e-9
    assert figures["twist_error_deg"] < 1e-7
    assert figures["thickness_error"] < 1e-9
    assert solid["solids"] == 1
    assert solid["valid"]
    assert solid["closed"]
    assert solid["deviation_mm"]["maximum"] < 0.3
    assert solid["deviation_mm"]["rms"] < 0.03
    faces = solid["deviation_mm"]["faces"]
    assert list(faces) == solid["face_names"]
    assert max(one["maximum"] for one in faces.values()) == solid["deviation_mm"]["maximum"]
    assert 0 < figures["airfoils_moved_by_chord"] <= 1.0000001e-5
    assert {one["airfoil"] for one in report["airfoils"]} >= {"Cylinder1", "DU21_A17"}
    assert abs(solid["volume_against_sections"]) < 1e-5
    assert abs(solid["volume_change_on_reading"]) < 1e-6
    assert solid["tip_volume_m3"] == 0.0
    for mesh in report["meshes"].values():
        assert mesh["watertight"]
        assert mesh["outward"]
        assert mesh["degenerate_triangles"] == 0
        assert abs(mesh["volume"] / solid["volume_m3"] - 1) < 1e-4
    assert report["settings"]["landmarks"] == 401
    assert report["versions"]["numpy"]
    assert set(report["seconds"]) >= {"step", "stl", "glb", "png"}
    sizes = {entry["name"]: entry["bytes"] for entry in report["files"]}
    assert sizes == {name: (folder / name).stat().st_size for name in sizes}


def test_the_volume_in_the_report_is_that_of_the_solid_with_its_tip(tmp_path):
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=201)
    options = Options(tip=round_tip, tolerance=1e-3)
    report = build(blade, tmp_path, formats=["step"], options=options)
    solid = report["solid"]
    assert abs(solid["volume_against_sections"]) < 1e-5  # up to the last section
    by_occt = shapes.volume(exchange.read(tmp_path / "nrel5mw.step")) / 1e9
    assert solid["tip_volume_m3"] > 5e-5 * solid["volume_m3"]
    assert abs(by_occt / solid["volume_m3"] - 1) < 5e-6


def test_grids_are_measured_in_the_report(tmp_path):
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)
    report = build(blade, tmp_path, formats=["p3d", "cgns", "sections.csv"])
    names = {path.name for path in tmp_path.iterdir()}
    assert {"nrel5mw.p3d", "nrel5mw.cgns", "nrel5mw.sections.csv"} < names
    grid = report["grid"]
    assert grid["blocks"] == len(grid["by_block"]) == 5
    assert grid["cells"] > 30_000
    assert grid["interface_gap_m"] == 0
    assert grid["worst_skewness"] < 0.7
    assert grid["largest_jump"] < 1.3
    assert 0 < grid["spacing"]["tip"] < 1e-5
    assert report["settings"]["grid"]["around"] == 289
    rows = dict(report_rows(report))
    assert rows["grid"] == f"{grid['cells']} cells in 5 blocks, which match point to point"


def test_a_missed_tolerance_is_said_and_the_rest_is_made(tmp_path, monkeypatch):
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)
    monkeypatch.setattr("bladegen.surface.fitting.MAX_POLES", 1000)
    with pytest.raises(ToleranceError):
        build(blade, tmp_path, formats=["step", "stl"], options=Options(tolerance=1e-5))
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {
        "nrel5mw.out-of-tolerance.step",
        "nrel5mw.stl",
        "nrel5mw.report.json",
        "nrel5mw.spanwise.csv",
    }


@pytest.mark.parametrize("suffix", ["inp", "structure.step"])
def test_a_blade_without_layers_is_refused_before_anything_is_made(tmp_path, suffix):
    bare = bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)
    with pytest.raises(ExportError, match="has no webs and layers, of which a s"):
        build(bare, tmp_path, formats=["stl", suffix])
    assert list(tmp_path.iterdir()) == []
    family = bg.family(bare, bg.ShapeSpace.bundled(), count=1)
    with pytest.raises(ExportError, match="has no webs and layers, of which a s"):
        Order(family, tmp_path / "family", formats=(suffix,))


def test_an_unknown_format_is_refused_before_anything_is_made(blade, tmp_path):
    with pytest.raises(ExportError, match=r"'\.doc', allowed are"):
        build(blade, tmp_path, formats=["stl", "doc"])
    assert list(tmp_path.iterdir()) == []
