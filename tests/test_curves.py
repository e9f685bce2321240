"""Curves of a blade as CAD: named, closed, on the solid's surface, as OCCT and gmsh read them."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_EDGE, TopAbs_SHELL
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS
from scipy.interpolate import make_interp_spline
from test_cad_names import components, document_of

import bladegen as bg
from bladegen.blade.edges import Sharp
from bladegen.cad import exchange, solids
from bladegen.cad.curves import curves, write_curves
from bladegen.definition.blade_definition import Distribution


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)


@pytest.fixture(scope="module")
def solid(blade):
    return solids.solid(blade, sections=60)


@pytest.fixture(scope="module")
def parts(blade, solid):
    return {part.name: part.shape for part in curves(solid, blade)}


def edges_of(shape):
    explorer, found = TopExp_Explorer(shape, TopAbs_EDGE), []
    while explorer.More():
        found.append(TopoDS.Edge_s(explorer.Current()))
        explorer.Next()
    return found


def points_of(edge, count=12):
    """Points [m] along an edge."""
    curve = BRepAdaptor_Curve(edge)
    at = np.linspace(curve.FirstParameter(), curve.LastParameter(), count)
    return np.array([curve.Value(t).Coord() for t in at.tolist()]) / 1e3


def test_all_curves_lie_on_the_solid(solid, parts):
    shell = TopExp_Explorer(solid.shape, TopAbs_SHELL).Current()
    rng = np.random.default_rng(1)
    for name, shape in parts.items():
        if name.endswith("axis"):
            continue
        for edge in edges_of(shape)[:2]:
            for point in rng.permutation(points_of(edge))[:1].tolist():
                vertex = BRepBuilderAPI_MakeVertex(gp_Pnt(*(1e3 * c for c in point))).Vertex()
                assert BRepExtrema_DistShapeShape(vertex, shell).Value() < 1e-6, name


def test_stations_are_closed_loops_at_the_blade_s_stations(blade, solid, parts):
    loops = [shape for name, shape in parts.items() if name.startswith("station")]
    assert len(loops) == len(blade.eta)
    for loop, eta in zip(loops, blade.eta, strict=True):
        assert BRep_Tool.IsClosed_s(loop)
        first, second, line = edges_of(loop)
        ends = [points_of(edge, 2) for edge in (first, second, line)]
        assert_allclose(ends[0][1], ends[1][0], atol=1e-10)
        assert_allclose(ends[2], [ends[1][1], ends[0][0]], atol=1e-10)
        corners = blade.sections([eta])[0][[0, 50, -1]]
        off = np.abs(np.array([ends[0][0], ends[0][1], ends[1][1]]) - corners).max()
        assert off <= solid.deviation.maximum + 1e-9


def test_edges_and_axes_are_the_blade_s(blade, solid, parts):
    for name, number in (
        ("leading edge", 50),
        ("trailing edge, suction side", 0),
        ("trailing edge, pressure side", -1),
    ):
        (edge,) = edges_of(parts[name])
        ends = points_of(edge, 2)
        assert_allclose(ends, blade.sections([0.0, 1.0])[:, number], atol=1e-9)
    (edge,) = edges_of(parts["reference axis"])
    along = BRepAdaptor_Curve(edge)
    eta = np.linspace(0.0, 1.0, 101)
    found = np.array([along.Value(t).Coord() for t in eta.tolist()]) / 1e3
    assert_allclose(found, blade.axis(eta), atol=1e-9)
    (edge,) = edges_of(parts["pitch axis"])
    assert_allclose(points_of(edge, 2), [[0, 0, 0], [0, 0, blade.length]], atol=1e-12)


def test_an_axis_of_straight_pieces_keeps_its_corners(blade, solid):
    def linear(grid, values):
        return make_interp_spline(grid, values, k=1)

    grid = np.array([0.0, 0.4, 1.0])
    axis = replace(blade.definition.axis, y=Distribution(grid, [0.0, 0.0, 2.0], spline=linear))
    bent = bg.Blade.from_definition(replace(blade.definition, axis=axis), landmarks=51)
    made = {part.name: part.shape for part in curves(solid, bent)}
    (edge,) = edges_of(made["reference axis"])
    along = BRepAdaptor_Curve(edge)
    found = [along.Value(t).Coord() for t in (0.3, 0.4, 0.7, 1.0)]
    assert_allclose(np.array(found) / 1e3, bent.axis([0.3, 0.4, 0.7, 1.0]), atol=1e-9)


def test_a_sharp_edge_is_one_curve_and_loops_close_without_a_line(blade):
    sharp = blade.with_trailing_edge(Sharp())
    made = {part.name: part.shape for part in curves(solids.solid(sharp, sections=40), sharp)}
    assert "trailing edge" in made
    loop = next(shape for name, shape in made.items() if name.startswith("station 2"))
    assert len(edges_of(loop)) == 2
    assert BRep_Tool.IsClosed_s(loop)


def test_files_name_each_curve(blade, solid, parts, tmp_path):
    for name in ("a.curves.step", "b.curves.step"):
        write_curves(solid, blade, tmp_path / name, timestamp="2026-01-02T03:04:05")
    path = tmp_path / "a.curves.step"
    assert path.read_bytes() == (tmp_path / "b.curves.step").read_bytes()
    names, products = components(document_of(path))
    assert names == products == list(parts)
    assert names[0] == "station 1, eta 0.0000"
    assert len(edges_of(exchange.read(path))) == sum(len(edges_of(p)) for p in parts.values())


GMSH = """
import sys, gmsh
gmsh.initialize(interruptible=False)
gmsh.option.setNumber("General.Terminal", 0)
gmsh.model.occ.importShapes(sys.argv[1], highestDimOnly=False)
gmsh.model.occ.synchronize()
print(len(gmsh.model.getEntities(1)), *gmsh.model.getBoundingBox(-1, -1))
"""


def test_gmsh_reads_the_curves(blade, parts, tmp_path):
    path = bg.export(blade, tmp_path / "a.curves.step", sections=60)
    run = [sys.executable, "-c", GMSH, str(path)]
    said = subprocess.run(run, capture_output=True, text=True, check=True).stdout.split()
    assert int(said[0]) == sum(len(edges_of(shape)) for shape in parts.values())
    top = blade.sections([1.0])[..., 2].max()
    assert float(said[6]) == pytest.approx(1e3 * top, abs=1.0)


def test_build_writes_them_if_asked(tmp_path, command):
    words = "build nrel5mw --landmarks 51 --tolerance 20mm --format csv --curves -o"
    done = command(*words.split(), tmp_path)
    assert done["status"] == 0, done["err"]
    text = (tmp_path / "nrel5mw.curves.step").read_text()
    assert "PRODUCT('leading edge'" in text
    assert "bladegen " in text.partition("ENDSEC;")[0]
