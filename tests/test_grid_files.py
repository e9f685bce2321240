"""Grids and tables read back by readers that are not ours: VTK, meshio, h5py, scipy, numpy."""

import csv

import h5py
import meshio
import numpy as np
import pytest
import pyvista
from numpy.testing import assert_allclose
from scipy.io import FortranFile

from bladegen.blade.blade import Blade
from bladegen.blade.edges import Sharp
from bladegen.formats.reading import read
from bladegen.surface.grids import grid_files
from bladegen.surface.grids.grid import Spacing, from_blade
from bladegen.surface.tips import round_tip

SPACING = Spacing(around=65, along=33, edge=6, leading_edge=4e-3, tip=1e-3, root=0.02)


@pytest.fixture(scope="module")
def blade():
    return Blade.from_definition(read("iea15mw"), landmarks=101)


@pytest.fixture(scope="module", params=["blunt, round tip", "sharp, flat tip"])
def grid(blade, request):
    if request.param == "blunt, round tip":
        return from_blade(blade, SPACING, round_tip)
    return from_blade(blade.with_trailing_edge(Sharp()), SPACING)


def ordered(block):
    """A block's points with i running fastest, as structured files hold them."""
    return block.points.transpose(1, 0, 2).reshape(-1, 3)


def test_vtk_reads_plot3d_bit_for_bit(grid, tmp_path):
    grid_files.write_plot3d(grid, tmp_path / "a.p3d")
    reader = pyvista.MultiBlockPlot3DReader(tmp_path / "a.p3d")
    reader.auto_detect_format = True
    blocks = reader.read()
    assert len(blocks) == len(grid.blocks)
    for again, block in zip(blocks, grid.blocks, strict=True):
        assert again.dimensions == (*block.eta.shape, 1)
        assert np.array_equal(again.points, ordered(block))


def test_fortran_reads_plot3d_as_unformatted_records(grid, tmp_path):
    grid_files.write_plot3d(grid, tmp_path / "a.p3d", scale=1000.0)
    with FortranFile(tmp_path / "a.p3d") as file:
        (count,) = file.read_ints(np.int32)
        shapes = file.read_ints(np.int32).reshape(count, 3)
        for shape, block in zip(shapes, grid.blocks, strict=True):
            values = file.read_reals(np.float64).reshape(3, *shape[::-1])
            assert_allclose(values[:, 0].transpose(2, 1, 0), 1e3 * block.points, rtol=1e-15)


def test_plot3d_text_holds_every_bit(grid, tmp_path):
    path = tmp_path / "a.fmt"
    grid_files.write_plot3d_text(grid, path)
    numbers = iter(path.read_text().split())
    shapes = [[int(next(numbers)) for _ in range(3)] for _ in range(int(next(numbers)))]
    for shape, block in zip(shapes, grid.blocks, strict=True):
        assert shape == [*block.eta.shape, 1]
        values = np.array([float(next(numbers)) for _ in range(3 * np.prod(shape))])
        assert np.array_equal(values.reshape(3, -1).T, ordered(block))
    assert next(numbers, None) is None
    reader = pyvista.MultiBlockPlot3DReader(path)
    reader.reader.SetBinaryFile(False)
    reader.reader.SetMultiGrid(True)
    for again, block in zip(reader.read(), grid.blocks, strict=True):
        assert_allclose(again.points, ordered(block), atol=1e-5)


def test_vtk_reads_cgns(grid, tmp_path):
    grid_files.write_cgns(grid, tmp_path / "a.cgns")
    reader = pyvista.CGNSReader(tmp_path / "a.cgns")
    reader.reader.SetDoublePrecisionMesh(True)
    base = reader.read()[0]
    assert base.keys() == [f"Zone{b.name.title().replace(' ', '')}" for b in grid.blocks]
    for zone, block in zip(base, grid.blocks, strict=True):
        again = zone["Internal"]
        assert again.dimensions == (*block.eta.shape, 1)
        assert np.array_equal(again.points, ordered(block))


def test_cgns_s_tree_is_as_the_standard_says(grid, tmp_path):
    grid_files.write_cgns(grid, tmp_path / "a.cgns")
    with h5py.File(tmp_path / "a.cgns") as file:
        assert file["CGNSLibraryVersion/ data"][0] == np.float32(3.4)
        labels = {}
        file.visititems(lambda name, node: labels.update(label_of(name, node)))
        base = file["Base"]
        assert base[" data"][:].tolist() == [2, 3]
        units = bytes(base["DimensionalUnits/ data"][:].astype(np.uint8)).decode().split()
        assert units == ["Kilogram", "Meter", "Second", "Kelvin", "Degree"]
        zones = [base[name] for name in base if labels.get(f"Base/{name}") == "Zone_t"]
        assert len(zones) == len(grid.blocks)
        families = {text(zone["FamilyName"]) for zone in zones}
        assert families == {name for name in base if labels.get(f"Base/{name}") == "Family_t"}
        assert "SuctionSide" in families
        for zone in zones:
            assert text(zone["ZoneType"]) == "Structured"
            joints = zone["ZoneGridConnectivity"].values()
            assert joints
            for joint in joints:
                check_joint(zone, joint, base[text(joint)])


def label_of(name, node):
    """A node's label by its path, and that its attributes agree with what it is."""
    if isinstance(node, h5py.Dataset):
        return {}
    assert node.attrs["name"].decode() == name.split("/")[-1]
    kinds = {"int8": "C1", "int32": "I4", "float32": "R4", "float64": "R8"}
    held = kinds[node[" data"].dtype.name] if " data" in node else "MT"
    assert node.attrs["type"].decode() == held
    return {name: node.attrs["label"].decode()}


def text(node):
    return bytes(node[" data"][:].astype(np.uint8)).decode()


def check_joint(zone, joint, donor):
    """Points along both ranges agree, and the transform leads from one to the other."""

    def along(zone, begin, step, count):
        arrays = [zone[f"GridCoordinates/Coordinate{c}/ data"][:] for c in "XYZ"]
        at = [begin + m * step - 1 for m in range(count)]
        return np.array([[array[j, i] for array in arrays] for i, j in at])

    begin, end = joint["PointRange/ data"][:]
    other_begin, other_end = joint["PointRangeDonor/ data"][:]
    transform = joint["Transform/ data"][:]
    matrix = np.zeros((2, 2), dtype=int)
    for axis, to in enumerate(transform):
        matrix[abs(to) - 1, axis] = np.sign(to)
    assert np.array_equal(matrix @ (end - begin) + other_begin, other_end)
    assert np.all(end >= begin)
    step = np.sign(end - begin)
    count = int(np.abs(end - begin).sum()) + 1
    own = along(zone, begin, step, count)
    assert np.array_equal(own, along(donor, other_begin, matrix @ step, count))


@pytest.mark.parametrize("read_back", ["pyvista", "meshio"])
def test_vtu_is_read_with_its_arrays(grid, tmp_path, read_back):
    path = tmp_path / "a.vtu"
    grid_files.write_vtu(grid, path, scale=1000.0)
    if read_back == "pyvista":
        data = pyvista.read(path)
        points, cells = data.points, data.cells_dict[pyvista.CellType.QUAD]
        arrays, marks = data.point_data, data.cell_data
    else:
        data = meshio.read(path)
        points, cells = data.points, data.cells_dict["quad"]
        arrays, marks = data.point_data, {name: part[0] for name, part in data.cell_data.items()}
    start = 0
    for number, block in enumerate(grid.blocks):
        count = block.eta[1:, 1:].size
        own = slice(start, start + count)
        corners = np.stack([block.points[:-1, :-1], block.points[1:, 1:]], axis=2)
        assert_allclose(points[cells[own][:, [0, 2]]], 1e3 * corners.reshape(-1, 2, 3), rtol=1e-14)
        assert_allclose(arrays["eta"][cells[own][:, 0]], block.eta[:-1, :-1].reshape(-1))
        assert set(np.unique(marks["block"][own])) == {number}
        assert np.all(marks[block.family][own] == 1)
        start += count
    assert len(cells) == start
    assert marks["tip"].sum() == sum(b.eta[1:, 1:].size for b in grid.blocks[-2:])
    assert len(np.unique(points, axis=0)) == len(points)


def test_tables_of_sections_hold_every_bit(blade, tmp_path):
    eta = np.array([0.0, 0.3, 1.0])
    sections = blade.sections(eta)
    grid_files.write_sections(eta, blade.u, sections, tmp_path / "a.csv")
    with (tmp_path / "a.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["eta", "landmark", "u", "x_m", "y_m", "z_m"]
    points = np.array([[float(row[c]) for c in ("x_m", "y_m", "z_m")] for row in rows])
    assert np.array_equal(points, sections.reshape(-1, 3))
    assert [row["landmark"] for row in rows[:2]] == ["1", "2"]
    assert float(rows[101]["eta"]) == 0.3
    assert np.array_equal([float(row["u"]) for row in rows[202:]], blade.u)
