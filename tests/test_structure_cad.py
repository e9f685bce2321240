"""Structure in CAD: skin cut where layers end, webs, inner surface, one STEP assembly."""

import json
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import bladegen as bg
from bladegen.blade.edges import Sharp
from bladegen.cad import exchange, shapes, solids
from bladegen.cad.structure.assembly import inside, write_structure
from bladegen.cad.structure.inner_part import inner_part
from bladegen.cad.structure.zones import bays_of
from bladegen.cli import commands
from bladegen.definition.structure.positions import Arc
from bladegen.errors import ExportError
from bladegen.exports.options import Options
from bladegen.exports.products import Products
from bladegen.measures.checks import solid_figures
from bladegen.surface.fitting import fitted
from bladegen.surface.inner import inner
from bladegen.surface.tips import round_tip
from strategies import STEADY

LAYERS = ["Spar_Cap_SS", "LE_reinforcement", "TE_reinforcement_PS", "TE_SS_filler"]


def blade_of(name):
    definition = bg.read(name) if isinstance(name, str) else name
    return bg.Blade.from_definition(definition, landmarks=101)


@pytest.fixture(
    scope="module", params=["iea15mw", pytest.param("nrel5mw", marks=pytest.mark.nightly)]
)
def made(request):
    blade = blade_of(request.param)
    solid = solids.solid(blade, tolerance=5e-3)
    return blade, solid, inside(solid, blade.layup)


def test_the_skin_is_the_solid_cut(made):
    _, solid, parts = made
    assert shapes.is_valid(parts.skin.shape)
    assert_allclose(shapes.volume(parts.skin.shape) / 1e9, solid.volume, rtol=1e-6)
    assert_allclose(shapes.area(parts.skin.shape) / 1e6, solid.area, rtol=3e-5)  # OCCT's quadrature


def test_faces_have_the_areas_of_layers_and_webs(made):
    """Against the layers' own widths over the span, which know of no faces."""
    blade, _, parts = made
    eta = np.linspace(0.0, 1.0, 4001)
    laid, structure = blade.layup.at(eta), blade.definition.structure
    along = np.linalg.norm(blade.definition.axis(eta, 1), axis=-1)
    width = np.where(laid.thickness > 0.0, laid.width, 0.0)
    wanted = {
        layer.name: np.trapezoid(own * along, eta)
        for layer, own in zip(structure.layers, width, strict=True)
        if not layer.web
    }
    wanted |= {
        web.name: np.trapezoid(height * along, eta)
        for web, height in zip(structure.webs, laid.web_height, strict=True)
    }
    assert parts.areas.keys() == wanted.keys()
    for name, area in wanted.items():
        assert_allclose(parts.areas[name], area, rtol=0.01, err_msg=name)
    assert all(str(said).startswith("inner surface: limited") for said in parts.findings)
    edges = [name for name, *_ in parts.skin.pieces if name.startswith("trailing edge")]
    both = [one.name for one in structure.layers if one.name.startswith("TE_reinforcement")]
    assert f"trailing edge: {' + '.join(both)} 1" in edges


def test_lines_that_part_all_at_once_stay_in_order():
    """Two edges side by side, of which one turns back: cubics through few spans cross there."""
    from scipy.interpolate import PchipInterpolator

    def edge(*values):
        return Arc(bg.Distribution([0.0, 0.3, 0.4, 0.5, 1.0], values))

    plain = bg.read("iea15mw")
    skin = plain.structure.layers[0]
    layers = (
        replace(skin, name="one", start=edge(*[0.1] * 5), end=edge(0.20, 0.205, 0.218, 0.2, 0.19)),
        replace(skin, name="two", start=edge(0.20, 0.206, 0.22, 0.25, 0.29), end=edge(*[0.4] * 5)),
    )
    structure = replace(plain.structure, webs=(), layers=layers)
    layup = blade_of(replace(plain, structure=structure)).layup
    coarse = np.linspace(0.0, 1.0, 11)
    bays = bays_of(layup, coarse)
    for bay in bays:
        fine = np.linspace(bay.v[0], bay.v[-1], 2001)
        lines = PchipInterpolator(bay.v, bay.lines, axis=1)(fine)
        assert np.diff(lines, axis=0).min() > 2e-4
    assert sum(len(bay.v) for bay in bays) > len(coarse)  # more were put between


def test_webs_stand_on_the_skin(made):
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
    from OCP.BRepExtrema import BRepExtrema_DistShapeShape
    from OCP.BRepMesh import BRepMesh_IncrementalMesh

    _, _, parts = made
    assert parts.webs
    faces = [face for name, face, _ in parts.skin.pieces if ": " in name]
    for web in parts.webs:
        assert shapes.is_valid(web.shape)
        BRepMesh_IncrementalMesh(web.shape, 100.0)
        corners = shapes.members(web.shape, "vertex")
        assert len(corners) >= 4
        for corner in corners[:4]:
            point = BRepBuilderAPI_MakeVertex(_place(corner)).Vertex()
            assert min(BRepExtrema_DistShapeShape(point, face).Value() for face in faces) < 0.02


def _place(vertex):
    from OCP.BRep import BRep_Tool
    from OCP.TopoDS import TopoDS

    return BRep_Tool.Pnt_s(TopoDS.Vertex_s(vertex))


def test_the_inner_surface_is_a_sheet_inside_of_the_skin(made):
    parts = made[2]
    assert shapes.is_valid(parts.inner.shape)
    sides = ["suction side", "pressure side", "trailing edge"]
    assert [name for name, *_ in parts.inner.pieces] == [f"inner surface: {one}" for one in sides]
    edges = shapes.members(parts.inner.shape, "edge")
    met = [a for a, b in combinations(edges, 2) if a.IsSame(b)]
    assert (len(edges), len(met)) == (12, 3)  # the nose's, and both of the strip
    figures = parts.wall
    skin = [face for name, face, _ in parts.skin.pieces if name not in ("root", "tip")]
    outer = sum(map(shapes.area, skin)) / 1e6
    assert 0.95 * outer < figures["area_m2"] < 0.995 * outer
    assert_allclose(figures["wall_m3"], figures["layers_m3"], rtol=0.025)
    assert 0.0 < figures["without_room_m3"] < 0.015 * figures["layers_m3"]
    assert figures["deviation_m"] <= 1e-3
    assert (figures["from_eta"], figures["to_eta"]) == (0.0, 1.0)


@pytest.mark.parametrize("edge", ["sharp", "cut"])
def test_an_inner_surface_that_is_closed_or_cut_is_valid(made, edge, monkeypatch):
    blade = made[0]
    if edge == "sharp":
        blade = blade.with_trailing_edge(Sharp())
    else:  # as if it crossed itself at root and tip
        monkeypatch.setattr(inner, "crossing_spans", lambda _, net, eta: np.abs(eta - 0.5) > 0.421)
    net = fitted(blade, 5e-3)[0]
    part, figures, found = inner_part(net, blade.layup, 5e-3)
    assert shapes.is_valid(part.shape)
    assert len(part.pieces) == (2 if edge == "sharp" else 3)
    ends = figures["from_eta"], figures["to_eta"]
    said = f"it goes from eta = {ends[0]:.3f} to {ends[1]:.3f}"
    if edge == "cut":
        assert_allclose(ends, [0.08, 0.92], atol=1e-9)
        assert said in str(found[-1])
    assert ends[1] > 0.9


def test_bays_end_where_webs_do_and_lines_do_not_cross(made):
    blade, solid, _ = made
    bays = bays_of(blade.layup, solid.net.v)
    ends = np.array([bay.v[0] for bay in bays] + [1.0])
    for web in blade.definition.structure.webs:
        for end in web.extent:
            assert np.abs(ends - end).min() < 5e-3
    for bay in bays:
        assert np.all(np.diff(bay.lines, axis=0) > 0.0)
        assert_allclose(bay.lines[bay.nose], 0.5)
        assert all(0 < a < bay.nose < b for a, b in bay.feet.values())


@pytest.mark.nightly
def test_a_mirror_image_has_the_same_zones(made):
    blade, _, parts = made
    other = blade.mirror_image()
    again = inside(solids.solid(other, tolerance=5e-3), other.layup)
    assert shapes.is_valid(again.skin.shape)
    for name, area in parts.areas.items():
        assert_allclose(again.areas[name], area, rtol=1e-3, err_msg=name)
    assert {name for name, *_ in again.skin.pieces} == {name for name, *_ in parts.skin.pieces}


def test_the_file_is_one_solid_with_named_faces_and_sheets(made, tmp_path):
    blade, solid, parts = made
    for name in "a" if STEADY else "ab":
        path = tmp_path / f"{name}.step"
        write_structure(parts, blade.name, path, timestamp="2026-01-02T03:04:05")
    assert path.read_bytes() == (tmp_path / "a.step").read_bytes()
    text = "".join(path.read_text().split())  # lines break within names
    for part in (*parts.webs, parts.skin, parts.inner):
        assert f"PRODUCT('{''.join(part.name.split())}'" in text
    for name, *_ in (*parts.skin.pieces, *parts.inner.pieces):
        assert f"ADVANCED_FACE('{''.join(name.split())}'" in text
    figures = solid_figures(exchange.read(path))
    assert [figures[key] for key in ("solids", "closed", "valid")] == [1, True, True]
    assert figures["sheets_beside"] == len(parts.webs) + 1
    assert_allclose(figures["volume_m3"], solid.volume, rtol=1e-6)


def test_a_command_writes_it_beside_the_solid_and_check_reads_it(tmp_path, foreign_here):
    words = f"perturb iea15mw -o {tmp_path} --thickness 1.03 --landmarks 101 --tolerance 10mm"
    run = CliRunner().invoke(commands.app, [*words.split(), "--format", "step", "--structure"])
    assert run.exit_code == 0, run.output
    path = tmp_path / "iea15mw-perturbed.structure.step"
    report = json.loads((tmp_path / "iea15mw-perturbed.report.json").read_text())
    assert set(LAYERS) <= report["structure"]["faces_m2"].keys()
    assert report["structure"]["inner_surface"]["wall_m3"] > 50.0
    assert any("inner surface: limited" in said for said in report["remarks"])
    run = CliRunner().invoke(commands.app, ["check", str(path)])
    assert run.exit_code == 0, run.output
    assert "sheets beside" in run.output


def test_what_cannot_be_had_is_said(tmp_path):
    bare = blade_of("dtu10mw")
    with pytest.raises(ExportError, match="has no webs and layers, of which a structure in CAD"):
        bg.export(bare, tmp_path / "a.structure.step")


@pytest.mark.parametrize("name", ["nrel5mw", pytest.param("iea15mw", marks=pytest.mark.nightly)])
def test_a_round_tip_closes_the_skin(name):
    products = Products(blade_of(name), Options(tip=round_tip, tolerance=5e-3))
    skin, solid = products.inside.skin, products.solid
    figures = solid_figures(skin.shape)
    assert [figures[key] for key in ("solids", "closed", "valid")] == [1, True, True]
    assert solid.tip_volume > 0.0
    assert_allclose(shapes.volume(skin.shape) / 1e9, solid.volume, rtol=1e-6)
    assert {label for label, *_ in skin.pieces} >= {"tip", "root"}
    assert_allclose(solid_figures(solid.shape)["bounds_m"], figures["bounds_m"], atol=1e-5)
    assert products.inside.webs
