"""Structured grids of any file: read whoever wrote them, and measured as they lie there."""

from itertools import product

import h5py
import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.io import FortranFile

import bladegen as bg
from bladegen.blade.blade import Blade
from bladegen.errors import FileError
from bladegen.measures import checks
from bladegen.measures.blocks import figures, reading
from bladegen.surface.grids import grid_files, grid_quality
from bladegen.surface.grids.grid import Spacing, from_blade
from bladegen.surface.volumes import volume_files
from bladegen.surface.volumes.volume import Extrusion, volume_of

pytestmark = pytest.mark.usefixtures("foreign_here")

SPACING = Spacing(around=65, along=21, edge=8, leading_edge=4e-3, root=0.05)
NODES = np.polynomial.legendre.leggauss(3)


@pytest.fixture(scope="module")
def blade():
    return Blade.from_definition(bg.read("nrel5mw"), landmarks=101)


@pytest.fixture(scope="module")
def grid(blade):
    return from_blade(blade, SPACING)


@pytest.fixture(scope="module")
def volume(blade, grid):
    return volume_of(blade, grid, Extrusion(first_height=2e-4, growth=1.3, distance=6.0))


@pytest.mark.parametrize("suffix", [".p3d", ".fmt", ".cgns"])
def test_our_grids_come_back_bit_for_bit(grid, volume, suffix, tmp_path):
    path, around = tmp_path / f"a{suffix}", tmp_path / f"a.volume{suffix}"
    ways = {
        ".p3d": (grid_files.write_plot3d, volume_files.write_plot3d),
        ".fmt": (grid_files.write_plot3d_text, volume_files.write_plot3d_text),
        ".cgns": (grid_files.write_cgns, volume_files.write_cgns),
    }
    ways[suffix][0](grid, path)
    ways[suffix][1](volume, around)
    for (_, points), block in zip(reading.read(path), grid.blocks, strict=True):
        assert np.array_equal(points[:, :, 0], block.points)
    for number, (_, points) in enumerate(reading.read(around)):
        assert np.array_equal(points, volume.block(number))


@pytest.mark.parametrize("order", "<>")
@pytest.mark.parametrize("real", ["f4", "f8"])
@pytest.mark.parametrize("blanked", [False, True])
def test_plot3d_of_others_is_read(order, real, blanked, tmp_path):
    """In either order of bytes, either precision, with marks of blanked points, of one block."""
    points = np.random.default_rng(1).random((3, 4, 5, 3)).astype(real)
    with FortranFile(tmp_path / "a.p3d", "w", header_dtype=f"{order}u4") as file:
        file.write_record(np.array([3, 4, 5], f"{order}i4"))
        values = points.transpose(3, 2, 1, 0).reshape(-1).astype(f"{order}{real}")
        marks = [np.ones(60, f"{order}i4")] if blanked else []
        file.write_record(values, *marks)
    ((_, found),) = reading.read(tmp_path / "a.p3d")
    assert np.array_equal(found, points)


def test_figures_of_a_surface_are_those_of_the_grid(grid, tmp_path):
    grid_files.write_cgns(grid, tmp_path / "a.cgns")
    found = checks.check_file(tmp_path / "a.cgns")
    wanted = grid_quality.grid_figures(grid)
    assert found.kind == "grid"
    assert found.problems == ()
    for ours, theirs in (("smallest_cell", "smallest_cell_m2"), ("cells", "cells")):
        assert_allclose(found.figures[ours], wanted[theirs])
    for name in ("smallest_scaled_jacobian", "worst_skewness", "largest_stretching"):
        assert_allclose(found.figures[name], wanted[name])
    around = 2 * (SPACING.around - 1) // 2 + SPACING.edge
    assert found.figures["edges_open"] == around  # of the root
    assert found.figures["edges_of_more_than_two"] == 0


def test_figures_of_a_volume_are_those_of_the_volume(volume, tmp_path):
    volume_files.write_plot3d(volume, tmp_path / "a.p3d")
    found, wanted = checks.check_file(tmp_path / "a.p3d").figures, volume.figures
    assert found["cells"] == wanted["cells"]
    assert found["right_handed"]
    assert found["folded_cells"] == 0
    assert_allclose(found["smallest_jacobian"], wanted["smallest_jacobian_m3"], rtol=1e-9)
    scaled = wanted["smallest_scaled_jacobian"]
    assert_allclose(found["smallest_scaled_jacobian"], scaled, rtol=1e-9)
    cells = sum(block.eta[1:, 1:].size for block in volume.grid.blocks)
    root = len(volume.front.rim()) * (len(volume.layers) - 1)
    assert found["faces_open"] == 2 * cells + root  # wall, far field and root plane
    assert found["faces_of_more_than_two"] == 0


def test_volumes_of_cells_are_the_integral_of_the_trilinear_map():
    corners = np.stack(np.meshgrid(*[[0.0, 1.0]] * 3, indexing="ij"), axis=-1)
    corners += 0.2 * np.random.default_rng(3).normal(size=corners.shape)
    total = 0.0
    for place in product(range(3), repeat=3):
        x = 0.5 + 0.5 * NODES[0][list(place)]
        weight = np.prod(0.5 * NODES[1][list(place)])
        hats = np.stack([1.0 - x, x])  # of corner 0 and 1 along each axis
        slopes = np.broadcast_to([[-1.0], [1.0]], (2, 3))
        rows = []
        for axis in range(3):
            a, b, c = (slopes[:, n] if n == axis else hats[:, n] for n in range(3))
            rows.append(np.einsum("i,j,k,ijkc->c", a, b, c, corners))
        total += weight * np.linalg.det(np.array(rows))
    found = figures.figures_of([("one", corners)])
    assert_allclose(found["volume"], total, rtol=1e-12)


def test_a_left_handed_grid_is_one_and_a_folded_one_is_not_sound(tmp_path):
    axes = np.meshgrid(np.arange(4.0), np.arange(3.0), np.arange(3.0), indexing="ij")
    brick = np.stack(axes, axis=-1)
    left = figures.figures_of([("a", brick[::-1])])
    assert (left["right_handed"], left["folded_cells"]) == (False, 0)
    assert_allclose(left["volume"], 12.0)
    bent = brick.copy()
    bent[1, 1, 1] += [1.5, 0.0, 0.0]
    with h5py.File(tmp_path / "a.cgns", "w") as file:
        base = file.create_group("Base")
        base.attrs["label"] = np.bytes_("CGNSBase_t")
        zone = base.create_group("Z")
        zone.attrs["label"] = np.bytes_("Zone_t")
        held = zone.create_group("GridCoordinates")
        held.attrs["label"] = np.bytes_("GridCoordinates_t")
        for axis, name in enumerate("XYZ"):
            held.create_group(f"Coordinate{name}")[" data"] = bent[..., axis].T
    found = checks.check_file(tmp_path / "a.cgns")
    assert found.figures["folded_cells"] > 0
    assert found.problems == ("has folded cells",)


def test_blocks_that_meet_are_told_by_their_faces():
    axes = np.meshgrid(np.arange(4.0), np.arange(3.0), np.arange(3.0), indexing="ij")
    brick = np.stack(axes, axis=-1)
    beside = brick + np.array([3.0, 0.0, 0.0])
    found = figures.figures_of([("a", brick), ("b", beside[:, ::-1, ::-1])])
    assert (found["faces_shared"], found["faces_open"]) == (4, 2 * (4 + 6 + 6) * 2 - 2 * 4)
    apart = figures.figures_of([("a", brick), ("b", beside + np.array([1e-12, 0.0, 0.0]))])
    assert (apart["faces_shared"], apart["faces_open"]) == (0, 64)


def test_a_surface_s_distance_from_its_blade_is_that_of_its_cells(blade, grid, volume, tmp_path):
    from bladegen.views.comparison import compared, surface_of

    grid_files.write_cgns(grid, tmp_path / "a.cgns")
    found = compared(surface_of(tmp_path / "a.cgns"), surface_of(blade)).figures
    assert found["maximum_mm"] < 200.0  # chords of a coarse grid
    volume_files.write_cgns(volume, tmp_path / "b.cgns")
    with pytest.raises(FileError, match="is a volume; distances are those of surfaces"):
        surface_of(tmp_path / "b.cgns")


@pytest.mark.parametrize("keep", [0, 3, 10, 40, 1000, -1])
def test_a_file_that_was_cut_off_is_damaged(grid, keep, tmp_path):
    for suffix, write in ((".p3d", grid_files.write_plot3d), (".cgns", grid_files.write_cgns)):
        write(grid, tmp_path / f"a{suffix}")
        data = (tmp_path / f"a{suffix}").read_bytes()
        (tmp_path / f"a{suffix}").write_bytes(data[:keep])
        if suffix == ".cgns" and keep == -1:
            continue  # HDF5 may not miss a byte
        with pytest.raises(FileError):
            checks.check_file(tmp_path / f"a{suffix}")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "does not begin with a count"),
        ("nan\n", "is no number"),
        ("1\n2 2 1\n1 2 3\n", "has 3 coordinates, its head says 12"),
        ("1\n2 2 1\n" + "inf " * 12, "no finite number"),
        ("1\n2 1 1\n" + "0 " * 6, "is a line of points"),
        ("1\n-2 -2 1\n" + "0 " * 12, "its head says"),
        ("one\n", "is no number"),
        ("999999999999\n", "does not begin with a count"),
    ],
)
def test_text_that_is_no_grid_is_refused(text, said, tmp_path):
    (tmp_path / "a.fmt").write_text(text)
    with pytest.raises(FileError, match=said):
        reading.read(tmp_path / "a.fmt")


def test_openfoam_s_mesh_is_sent_to_checkmesh(tmp_path):
    (tmp_path / "a.volume.foam.zip").write_bytes(b"")
    with pytest.raises(FileError, match=r"suffix '.zip', .*unpack it, and OpenFOAM's checkMesh"):
        checks.check_file(tmp_path / "a.volume.foam.zip")
