import inspect
import zipfile
from dataclasses import fields, replace
from xml.etree import ElementTree

import numpy as np
import pytest
import pyvista
from numpy.testing import assert_allclose
from vtkmodules.vtkIOGeometry import vtkSTLReader

import bladegen as bg
from bladegen.cad import exchange, shapes
from bladegen.errors import ExportError, SizeError, ToleranceError
from bladegen.exports import exporters
from bladegen.exports.options import Kind, Options
from bladegen.exports.products import Products
from bladegen.exports.registry import FORMATS, Format
from bladegen.surface import mesh, mesh_files
from bladegen.surface.grids.grid import Spacing
from bladegen.surface.regions import REGIONS
from bladegen.surface.tips import flat_tip, round_tip

MESHES = [".stl", ".regions.stl", ".ply", ".glb", ".obj", ".3mf", ".vtp"]


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)


@pytest.fixture(scope="module")
def made(blade):
    return mesh.from_blade(blade, stations=60)


def read(path):
    """A mesh file as vertices and faces, VTP by pyvista and others by trimesh."""
    if path.suffix == ".vtp":
        data = pyvista.read(path)
        return mesh_files.to_trimesh(mesh.TriangleMesh(data.points, data.regular_faces))
    return mesh_files.read(path)


@pytest.mark.parametrize("suffix", MESHES)
def test_meshes_read_back_with_the_same_box_and_volume(blade, made, suffix, tmp_path):
    path = bg.export(blade, tmp_path / f"blade{suffix}", stations=60)
    again = read(path)
    scale = 1000.0 if suffix == ".3mf" else 1.0
    assert again.is_watertight
    assert len(again.faces) == len(made.faces)
    bounds = [made.vertices.min(axis=0), made.vertices.max(axis=0)]
    assert_allclose(again.bounds, scale * np.array(bounds), atol=1e-4 * scale)
    assert_allclose(again.volume, scale**3 * made.volume, rtol=1e-5)
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("suffix", [".stl", ".regions.stl", ".ply", ".obj", ".vtp"])
def test_millimetres_are_a_thousand_times_as_many(blade, suffix, tmp_path):
    metre = read(bg.export(blade, tmp_path / f"m{suffix}", stations=20))
    milli = read(bg.export(blade, tmp_path / f"mm{suffix}", stations=20, unit="mm"))
    assert_allclose(milli.extents, 1000 * metre.extents, rtol=1e-5)


def test_files_state_their_unit(blade, tmp_path):
    stl = bg.export(blade, tmp_path / "a.stl", stations=20, unit="mm").read_bytes()
    assert stl[:80].startswith(f"bladegen {bg.__version__} nrel5mw, unit: mm, source ".encode())
    obj = bg.export(blade, tmp_path / "a.obj", stations=20).read_text()
    assert "\n# bladegen nrel5mw, unit: m\n" in obj


@pytest.mark.parametrize("suffix", [".stl", ".regions.stl", ".ply", ".glb", ".obj"])
def test_the_same_blade_gives_the_same_bytes(blade, suffix, tmp_path):
    first, second = (
        bg.export(blade, tmp_path / f"{name}{suffix}", stations=20).read_bytes() for name in "ab"
    )
    assert first == second


@pytest.mark.parametrize("suffix", [".obj", ".vtp", ".regions.stl"])
def test_vtk_finds_the_regions(blade, made, suffix, tmp_path):
    path = bg.export(blade, tmp_path / f"a{suffix}", stations=60)
    if suffix == ".regions.stl":
        reader = vtkSTLReader()
        reader.SetFileName(str(path))
        reader.ScalarTagsOn()
        reader.Update()
        found = pyvista.wrap(reader.GetOutput()).compute_cell_sizes()
        number = np.array(found["STLSolidLabeling"]).astype(int)
        lines = path.read_text().splitlines()
        for word in ("solid ", "endsolid "):
            groups = [line[len(word) :] for line in lines if line.startswith(word)]
            groups[-1] = groups[-1].partition("; bladegen")[0]  # what the file is made from
            assert groups == [name.replace(" ", "_") for name in REGIONS[:5]]
    else:
        found = pyvista.read(path).compute_cell_sizes()
    if suffix == ".obj":
        number = np.array(found["GroupIds"]).astype(int)
        groups = [line[2:] for line in path.read_text().splitlines() if line.startswith("g ")]
        assert groups == [name.replace(" ", "_") for name in REGIONS[:5]]
        number -= number.min()
    elif suffix == ".vtp":
        number = found["region"]
        assert list(pyvista.read(path).field_data["regions"]) == list(REGIONS)
    corners = made.vertices[made.faces]
    sides = corners[:, 1:] - corners[:, :1]
    areas = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    wanted = np.bincount(made.regions, areas)
    assert_allclose(np.bincount(number, np.abs(found["Area"])), wanted, rtol=1e-5)


def test_normals_of_regions_look_outward(blade, made, tmp_path):
    path = bg.export(blade, tmp_path / "a.regions.stl", stations=60)
    lines = path.read_text().splitlines()
    rows = [line.split()[-3:] for line in lines if line.startswith(("facet", "vertex"))]
    facets = np.array(rows, dtype=float).reshape(-1, 4, 3)
    across = np.cross(facets[:, 2] - facets[:, 1], facets[:, 3] - facets[:, 1])
    length = np.linalg.norm(across, axis=1)
    assert np.sum(facets[:, 0] * across, axis=1) == pytest.approx(length, rel=1e-4, abs=1e-6)
    flux = np.sum(facets[:, 1:].mean(axis=1) * across) / 6.0
    assert_allclose(flux, made.volume, rtol=1e-6)


def test_3mf_gives_each_region_a_material(blade, made, tmp_path):
    named = replace(blade, definition=replace(blade.definition, name='a<b> & "ö"'))
    path = bg.export(named, tmp_path / "a.3mf", stations=60)
    with zipfile.ZipFile(path) as package:
        model = ElementTree.fromstring(package.read("3D/3dmodel.model"))
    core = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
    (materials,) = model.iter(f"{core}basematerials")
    assert [base.get("name") for base in materials] == list(REGIONS)
    triangles = list(model.iter(f"{core}triangle"))
    corners = [[int(one.get(key)) for key in ("v1", "v2", "v3")] for one in triangles]
    assert np.array_equal(corners, made.faces)
    assert np.array_equal([int(one.get("p1")) for one in triangles], made.regions)
    assert {one.get("pid") for one in triangles} == {materials.get("id")}
    (body,) = model.iter(f"{core}object")
    assert body.get("name") == 'a<b> & "ö"'


GRIDS = [name for name, row in FORMATS.items() if row.kind is Kind.grid]


@pytest.mark.parametrize("suffix", GRIDS)
def test_grids_by_suffix(blade, suffix, tmp_path):
    spacing = Spacing(around=33, along=9, edge=4, leading_edge=0.02, trailing_edge=0.02, root=0.1)
    first, second = (
        bg.export(blade, tmp_path / f"{name}{suffix}", spacing=spacing).read_bytes()
        for name in "ab"
    )
    assert len(first) > 10_000
    assert first == second


@pytest.mark.parametrize("tip", [flat_tip, round_tip])
def test_points_of_a_vtp_file_say_where_they_are(blade, tip, tmp_path):
    path = exporters.export(blade, tmp_path / "a.vtp", stations=40, tip=tip, unit="mm")
    found = pyvista.read(path)
    eta, where = np.unique(found["eta"], return_inverse=True)
    landmark = np.argmin(np.abs(blade.u - found["u"][:, None]), axis=1)
    assert_allclose(blade.u[landmark], found["u"], atol=1e-12)
    sections = blade.sections(eta)
    off = np.linalg.norm(found.points / 1e3 - sections[where, landmark], axis=1)
    on_arcs = off > 1e-6
    assert len(eta) == 40
    assert np.all(found["eta"][on_arcs] == 1.0)
    assert np.any(on_arcs) == (tip is round_tip)
    assert off.max() < 0.2 * np.ptp(sections[-1], axis=0).max()  # of the tip's chord


def test_sections_by_suffix(blade, tmp_path):
    path = bg.export(blade, tmp_path / "blade.sections.csv", stations=20)
    table = np.genfromtxt(path, delimiter=",", names=True)
    sections = blade.sections(blade.stations(20)).reshape(-1, 3)
    assert np.array_equal(np.stack([table[f"{c}_m"] for c in "xyz"], axis=1), sections)


def test_a_round_tip_is_on_meshes_and_grids_alike(blade):
    spacing = Spacing(around=33, along=9, edge=8, leading_edge=0.02, trailing_edge=0.02, root=0.1)
    options = Options(stations=20, tip=round_tip, spacing=spacing)
    products = Products(blade, options)
    tops = [products.mesh.vertices[:, 2].max()]
    tops.append(max(block.points[..., 2].max() for block in products.grid.blocks))
    assert min(tops) > 1.001 * blade.length
    assert_allclose(*tops, rtol=1e-4)


def test_step_by_suffix(blade, tmp_path):
    path = bg.export(blade, tmp_path / "blade.stp", sections=40)
    assert shapes.is_valid(exchange.read_step(path))


def test_a_solid_that_misses_its_tolerance_is_kept_aside(blade, tmp_path, monkeypatch):
    monkeypatch.setattr("bladegen.surface.fitting.MAX_POLES", 1000)
    with pytest.raises(ToleranceError, match=r"mm off the blade .* allowed is 0.01 mm; kept as"):
        bg.export(blade, tmp_path / "blade.step", tolerance=1e-5)
    assert [p.name for p in tmp_path.iterdir()] == ["blade.out-of-tolerance.step"]


def test_products_are_made_once(blade):
    products = Products(blade, Options(stations=20))
    assert products.mesh is products.mesh


@pytest.mark.parametrize("name", ["blade.xyz", "blade", "blade.step.gz"])
def test_unknown_suffixes_are_refused(blade, name, tmp_path):
    with pytest.raises(ExportError, match=r"allowed are \.step, \.stp, \.iges"):
        bg.export(blade, tmp_path / name)


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ({"unit": "inch"}, "unit: got 'inch', allowed are m, mm"),
        ({"tolerance": 0.0}, "tolerance: got 0 m"),
        ({"tolerance": float("nan")}, "tolerance: got nan, must be finite"),
    ],
)
def test_wrong_options_are_refused(blade, option, message, tmp_path):
    with pytest.raises(ExportError, match=message):
        bg.export(blade, tmp_path / "blade.stl", **option)


def test_a_failing_writer_leaves_nothing(blade, tmp_path, monkeypatch):
    def fail(products, path):
        path.write_bytes(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setitem(FORMATS, ".stl", Format(Kind.triangles, "broken", fail))
    with pytest.raises(ExportError, match="No space left"):
        bg.export(blade, tmp_path / "blade.stl")
    assert list(tmp_path.iterdir()) == []


def test_a_solid_larger_than_allowed_is_kept_aside(blade, tmp_path):
    products = Products(blade, Options(tolerance=5e-3, sections=30, largest=9000))
    with pytest.raises(
        SizeError, match=r"takes \d\.\d\d MB at 5 mm, allowed are 0\.009 MB"
    ) as raised:
        exporters.write(products, tmp_path / "a.step")
    assert raised.value.kept == tmp_path / "a.too-large.step"
    assert [path.name for path in tmp_path.iterdir()] == ["a.too-large.step"]
    exporters.write(products, tmp_path / "a.stl")  # the promise is about solids
    assert (tmp_path / "a.stl").stat().st_size > 9000


def test_the_options_of_export_are_named_and_their_defaults_those_of_options():
    given = inspect.signature(bg.export).parameters
    for entry in fields(exporters.Options):
        assert entry.name in given
        assert f"    {entry.name}" in bg.export.__doc__
        if entry.name not in ("spacing", "extrusion", "tip"):
            assert given[entry.name].default == entry.default
    assert "numpy" not in str(inspect.signature(bg.export))
