import meshing
import numpy as np
import pytest
from numpy.testing import assert_allclose
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.IGESControl import IGESControl_Controller, IGESControl_Writer
from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Controller, STEPControl_Writer
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

from bladegen.blade.blade import Blade
from bladegen.cad import exchange, occt, shapes, solids
from bladegen.cad.solids import Solid
from bladegen.cad.triangles import triangulated
from bladegen.errors import CadError
from bladegen.formats.reading import read
from bladegen.measures import checks
from bladegen.surface import mesh_files
from bladegen.surface.tips import flat_tip, round_tip

pytestmark = pytest.mark.usefixtures("foreign_here")


@pytest.fixture(scope="module")
def solid():
    return solids.solid(Blade.from_definition(read("dtu10mw"), landmarks=101), sections=60)


WRITERS = {
    ".step": exchange.write_step,
    ".iges": exchange.write_iges,
    ".brep": exchange.write_brep,
}
BOTH = pytest.mark.parametrize("suffix", WRITERS)


@BOTH
def test_solids_are_read_again_whole(solid, tmp_path, suffix):
    path = tmp_path / f"blade{suffix}"
    WRITERS[suffix](solid, path)
    shape = exchange.read(path)
    figures = checks.solid_figures(shape, quick=True)
    assert figures["valid"]
    assert figures["closed"]
    assert figures["one_solid"]
    again = shapes.quick_volume(shape)
    assert_allclose(again, shapes.quick_volume(solid.shape), rtol=1e-6)


@BOTH
def test_gmsh_reads_them_as_one_volume_in_millimetres(solid, tmp_path, suffix):
    path = tmp_path / f"blade{suffix}"
    WRITERS[suffix](solid, path)
    found = meshing.found(path)
    assert found.volumes == 1
    assert_allclose(found.box[5], 1000 * solid.net.poles[..., 2].max(), rtol=1e-3)


def curves_on_surfaces(shape):
    """Distances of edges from their curves on faces over their tolerance, as FreeCAD's check."""
    faces, found = TopExp_Explorer(shape, TopAbs_FACE), []
    while faces.More():
        face = TopoDS.Face_s(faces.Current())
        faces.Next()
        surface, edges = BRepAdaptor_Surface(face, False), TopExp_Explorer(face, TopAbs_EDGE)
        while edges.More():
            edge = TopoDS.Edge_s(edges.Current())
            edges.Next()
            if BRep_Tool.Degenerated_s(edge):
                continue
            curve, flat = BRepAdaptor_Curve(edge), BRepAdaptor_Curve2d(edge, face)
            for t in np.linspace(curve.FirstParameter(), curve.LastParameter(), 200).tolist():
                on = surface.Value(*flat.Value(t).Coord())
                found.append(curve.Value(t).Distance(on) / BRep_Tool.Tolerance_s(edge))
    return np.array(found)


@BOTH
@pytest.mark.parametrize("tip", [flat_tip, round_tip])
def test_edges_lie_on_the_faces_of_files(tmp_path, suffix, tip):
    made = solids.solid(Blade.from_definition(read("dtu10mw"), landmarks=101), sections=60, tip=tip)
    path = tmp_path / f"blade{suffix}"
    WRITERS[suffix](made, path)
    assert curves_on_surfaces(exchange.read(path)).max() < 0.5


def test_the_schema_is_what_was_asked_for(solid, tmp_path):
    for schema, name in (("ap242", "AP242_MANAGED_MODEL"), ("ap214", "AUTOMOTIVE_DESIGN")):
        path = tmp_path / f"{schema}.step"
        exchange.write_step(solid, path, schema=schema)
        assert name in path.read_text()[:2000]
        assert checks.solid_figures(exchange.read(path), quick=True)["valid"]


def test_triangles_of_a_shape_lie_on_it(solid):
    triangles = triangulated(solid.shape, 0.002)
    welded = mesh_files.to_trimesh(triangles)
    welded.merge_vertices()
    assert_allclose(welded.volume, solid.net.volume(), rtol=1e-3)
    low, high = triangles.vertices.min(axis=0), triangles.vertices.max(axis=0)
    assert_allclose(high[2], solid.net.poles[..., 2].max(), atol=1e-4)
    assert np.all(low < high)


@BOTH
def test_other_files_are_refused(tmp_path, suffix):
    path = tmp_path / f"no{suffix}"
    path.write_text("nothing of the kind\n")
    with pytest.raises(CadError, match="OCCT can read"):
        exchange.read(path)


def test_times_that_are_none_are_refused(solid, tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "9" * 30)
    for write in (exchange.write_step, exchange.write_iges):
        with pytest.raises(CadError, match="SOURCE_DATE_EPOCH: got 999"):
            write(solid, tmp_path / "a")
    assert list(tmp_path.iterdir()) == []


@pytest.fixture(scope="module")
def box():
    """A solid of 1 by 2 by 3 m."""
    shape = BRepPrimAPI_MakeBox(1000.0, 2000.0, 3000.0).Shape()
    return Solid(shape, (), None, None, 0.0, "box")


@pytest.fixture
def setting():
    """Settings of OCCT, which belong to the process, and are put back."""
    STEPControl_Controller.Init_s()
    names = "write.step.unit", "xstep.cascade.unit"
    before = [Interface_Static.CVal_s(name) for name in names]
    yield Interface_Static.SetCVal_s
    for name, value in zip(names, before, strict=True):
        Interface_Static.SetCVal_s(name, value)


@pytest.mark.parametrize("unit", ["INCH", "FT", "M", "CM", "MM", "UM"])
def test_files_are_read_in_their_own_unit(box, tmp_path, setting, unit):
    setting("write.step.unit", unit)
    with occt.quietly():
        step = STEPControl_Writer()
        step.Transfer(box.shape, STEPControl_AsIs)
        step.Write(str(tmp_path / "a.step"))
        IGESControl_Controller.Init_s()
        iges = IGESControl_Writer(unit, exchange.SOLIDS_MODE)
        iges.AddShape(box.shape)
        iges.ComputeModel()
        iges.Write(str(tmp_path / "a.iges"))
    for name in ("a.step", "a.iges"):
        shape = exchange.read(tmp_path / name)
        assert shapes.quick_volume(shape) == pytest.approx(6e9, rel=1e-9)


@pytest.mark.parametrize("suffix", [".step", ".iges"])
def test_the_unit_of_others_in_the_process_changes_nothing(box, tmp_path, setting, suffix):
    path = tmp_path / f"a{suffix}"
    setting("xstep.cascade.unit", "M")
    WRITERS[suffix](box, path)
    within = shapes.quick_volume(exchange.read(path))
    assert Interface_Static.CVal_s("xstep.cascade.unit") == "M"
    setting("xstep.cascade.unit", "MM")
    assert shapes.quick_volume(exchange.read(path)) == pytest.approx(6e9, rel=1e-9)
    assert within == pytest.approx(6e9, rel=1e-9)


def test_check_takes_a_file_in_inches_for_what_it_is(box, tmp_path, setting):
    setting("write.step.unit", "INCH")
    with occt.quietly():
        step = STEPControl_Writer()
        step.Transfer(box.shape, STEPControl_AsIs)
        step.Write(str(tmp_path / "a.step"))
    figures = checks.check_file(tmp_path / "a.step").figures
    assert figures["volume_m3"] == pytest.approx(6.0, rel=1e-9)
    assert_allclose(figures["bounds_m"], [[0, 0, 0], [1, 2, 3]], atol=1e-6)
