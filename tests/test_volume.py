"""Volumes around blades: cells, blocks, files, measured here and by readers that are not ours."""

import os
import re
import shutil
import subprocess
import zipfile
from dataclasses import replace
from itertools import product

import h5py
import numpy as np
import pytest
import pyvista
from numpy.testing import assert_allclose
from test_grid import enclosed

import bladegen as bg
from bladegen.blade.blade import Blade
from bladegen.blade.edges import Sharp
from bladegen.definition.rotor import Rotor
from bladegen.errors import GeometryError
from bladegen.exports.cases.volume_mesh import mesh_of
from bladegen.formats.bundled import bundled
from bladegen.formats.reading import read
from bladegen.surface.grids.grid import Spacing, from_blade
from bladegen.surface.tips import TIPS, flat_tip, round_tip
from bladegen.surface.volumes import volume as volumes
from bladegen.surface.volumes import volume_files
from bladegen.surface.volumes.front import front_of
from bladegen.surface.volumes.volume import Extrusion, volume_of
from bladegen.surface.wall_spacing import first_height
from bladegen.views.tables import volume_rows

COARSE = Spacing(around=65, along=21, edge=8, leading_edge=4e-3, root=0.05)
QUICK = Extrusion(first_height=2e-4, growth=1.3, distance=6.0)
DEBIAN = "/usr/share/openfoam"


@pytest.fixture(scope="module")
def blade():
    return Blade.from_definition(read("nrel5mw"), landmarks=101)


@pytest.fixture(scope="module", params=[flat_tip, round_tip])
def volume(blade, request):
    return volume_of(blade, from_blade(blade, COARSE, request.param), QUICK)


def corners(points):
    """Triple products of the edges at the eight corners of the cells of points (ni, nj, nk, 3)."""
    steps = [np.diff(points, axis=axis) for axis in range(3)]
    for a, b, c in product((slice(None, -1), slice(1, None)), repeat=3):
        i, j, k = steps[0][:, b, c], steps[1][a, :, c], steps[2][a, b]
        yield np.sum(np.cross(i, j) * k, axis=-1)


def sizes(points):
    """Volumes of the cells, each of five tetrahedra cut in both ways."""
    at = {
        (a, b, c): points[a : len(points) - 1 + a, b : points.shape[1] - 1 + b][
            :, :, c : points.shape[2] - 1 + c
        ]
        for a, b, c in product((0, 1), repeat=3)
    }
    total = 0.0
    for turned in (0, 1):
        corner = {key: at[(key[0] ^ turned, *key[1:])] for key in at}
        sign = -1.0 if turned else 1.0
        middle = [corner[key] for key in ((1, 1, 0), (1, 0, 1), (0, 1, 1))]
        tets = [((0, 0, 0), *middle)]
        tets = [
            ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)),
            ((1, 1, 0), (0, 1, 0), (1, 0, 0), (1, 1, 1)),
            ((1, 0, 1), (0, 0, 1), (1, 1, 1), (1, 0, 0)),
            ((0, 1, 1), (1, 1, 1), (0, 0, 1), (0, 1, 0)),
            ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)),
        ]
        for o, p, q, r in tets:
            a, b, c = (corner[key] - corner[o] for key in (p, q, r))
            total = total + sign * np.sum(np.cross(a, b) * c, axis=-1) / 12.0
    return total


def test_every_cell_is_right_handed_at_all_corners(volume):
    for number in range(len(volume.grid.blocks)):
        points = volume.block(number)
        assert points.shape[:3] == volume.shapes[number]
        assert min(corner.min() for corner in corners(points)) > 0.0
        assert sizes(points).min() > 0.0


def test_figures_are_those_measured_here(volume):
    figures = volume.figures
    blocks = [volume.block(number) for number in range(len(volume.grid.blocks))]
    least = min(corner.min() for points in blocks for corner in corners(points))
    assert_allclose(figures["smallest_jacobian_m3"], least, rtol=1e-9)
    assert_allclose(figures["smallest_volume_m3"], min(sizes(p).min() for p in blocks), rtol=0.02)
    assert figures["cells"] == sum(np.prod(np.subtract(p.shape[:3], 1)) for p in blocks)
    assert figures["cells_not_positive"] == 0
    assert 0.1 < figures["smallest_scaled_jacobian"] < 1.0


def test_the_place_of_the_largest_skewness_is_told(blade, volume):
    """A point moved through the layers beyond it skews the cells around it."""
    off, place = volume.figures["largest_skewness_at"]
    away = np.linalg.norm(volume.layers[-2] - volume.layers[0], axis=1)
    assert 0.0 <= off <= away.max()
    assert re.fullmatch(r"the [a-z ]+ at [\d.]+ % span", place)
    layers, (i, j), middle = volume.layers.copy(), (10, 12), len(volume.layers) // 2
    moved = volume.front.numbers[0][i, j]
    layers[middle, moved] += 6.0 * (layers[middle + 1, moved] - layers[middle, moved])
    bent = replace(volume, layers=layers).figures
    eta = 100.0 * volume.grid.blocks[0].eta[[i - 1, i, i + 1], j]
    off, place = bent["largest_skewness_at"]
    assert bent["largest_skewness"] > 1.1 * volume.figures["largest_skewness"]
    side, at = re.fullmatch(r"the (.*) at ([\d.]+) % span", place).groups()
    assert side == volume.grid.blocks[0].name
    assert min(abs(eta - float(at))) < 0.1
    away = np.linalg.norm(layers[[middle, middle + 1], moved] - layers[0, moved], axis=1)
    assert 0.0 < off < away.max()


def test_cells_fill_what_lies_between_wall_far_field_and_root(volume):
    total = sum(sizes(volume.block(number)).sum() for number in range(len(volume.grid.blocks)))
    far = [
        type(block)(block.name, block.family, volume.block(i)[:, :, -1], block.eta, block.u)
        for i, block in enumerate(volume.grid.blocks)
    ]
    outer = type(volume.grid)("far", tuple(far), volume.grid.interfaces)
    assert_allclose(total, enclosed(outer)[0] - enclosed(volume.grid)[0], rtol=2e-3)


def edge_of(points, start, stop):
    """The points (m, nk, 3) over an edge of the wall, from one index pair to another."""
    count = np.abs(np.subtract(stop, start)).max() + 1
    i = np.linspace(start[0], stop[0], count).round().astype(int)
    return points[i, np.linspace(start[1], stop[1], count).round().astype(int)]


def test_the_first_layer_is_the_surface_and_blocks_match_bit_for_bit(volume):
    for number, block in enumerate(volume.grid.blocks):
        assert np.array_equal(volume.block(number)[:, :, 0], block.points)
    for joint in volume.grid.interfaces:
        own = edge_of(volume.block(joint.block), joint.start, joint.stop)
        other = edge_of(volume.block(joint.donor), joint.donor_start, joint.donor_stop)
        assert np.array_equal(own, other)


def test_lines_from_the_root_stay_on_its_plane_and_no_others_reach_it(volume):
    root = volume.front.root
    assert root.sum() == COARSE.around - 1 + COARSE.edge
    assert np.abs(volume.layers[:, root, 2]).max() == 0.0
    assert volume.layers[:, ~root, 2].min() > 0.0


def test_first_cells_are_as_high_as_asked_for(volume):
    for number in range(len(volume.grid.blocks)):
        points = volume.block(number)
        wall = points[:, :, 0]
        normal = np.cross(wall[2:, 1:-1] - wall[:-2, 1:-1], wall[1:-1, 2:] - wall[1:-1, :-2])
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        height = np.sum((points[1:-1, 1:-1, 1] - wall[1:-1, 1:-1]) * normal, axis=-1)
        assert_allclose(np.median(height), QUICK.first_height, rtol=1e-3)
        assert height.min() > 0.85 * QUICK.first_height  # beside edges, where lines turn
        assert height.max() < 1.02 * QUICK.first_height


def test_layers_grow_as_asked_for_and_reach_the_distance(volume):
    steps = np.linalg.norm(np.diff(volume.layers, axis=0), axis=2)
    assert_allclose(np.median(steps[1:] / steps[:-1]), QUICK.growth, rtol=0.03)
    away = np.linalg.norm(volume.layers - volume.layers[0], axis=2)
    assert np.median(away[-1]) >= QUICK.distance > np.median(away[-2])
    assert volume.figures["distance_m"]["median"] == np.median(away[-1])


def test_the_first_height_follows_from_y_plus(blade):
    wanted = first_height(8e6, blade.chord(0.75), 2.0)
    assert Extrusion(y_plus=2.0, reynolds=8e6).height(blade) == wanted
    assert Extrusion().height(blade) == Extrusion.DEFAULT_HEIGHT


def test_without_a_reynolds_number_it_is_that_of_the_rotor_at_its_rated_speed(blade):
    """12.1 turns a minute at 1.5 + 0.75 x 61.5 m, in air of 1.46e-5 m2/s: NREL 5 MW."""
    wanted = 12.1 * np.pi / 30.0 * (1.5 + 0.75 * 61.5) * blade.chord(0.75) / 1.46e-5
    assert_allclose(Extrusion(y_plus=1.0).number(blade), wanted, rtol=1e-6)
    assert_allclose(
        Extrusion(y_plus=1.0).height(blade), first_height(wanted, blade.chord(0.75), 1.0), rtol=1e-6
    )
    made = volume_of(blade, from_blade(blade, COARSE), replace(QUICK, first_height=None, y_plus=9))
    assert_allclose(made.figures["reynolds"], wanted, rtol=1e-6)
    bare = replace(blade, definition=replace(blade.definition, rotor=Rotor()))
    with pytest.raises(GeometryError, match=r"y_plus: got 1 without a Reynolds .* --reynolds 1e7"):
        Extrusion(y_plus=1.0).height(bare)


def test_the_main_figures_are_shown(volume):
    rows = dict(volume_rows(volume.figures))
    assert rows["volume"] == f"{volume.figures['cells']} cells in {len(volume.layers) - 1} layers"
    assert rows["volume's first cells"] == "0.2000 mm high"
    place = [12.3, "the trailing edge at 0.8 % span"]
    worse = {"largest_skewness": 7.09, "largest_skewness_at": place, "reynolds": 1.2e7}
    bad = volume.figures | worse
    assert dict(volume_rows(bad))["volume's largest skewness"] == (
        "7.1, above the 4 that checkMesh allows, 12 m off the trailing edge at 0.8 % span"
    )
    assert "Reynolds number of 1.2e+07" in dict(volume_rows(bad))["volume's first cells"]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"growth": 2.0}, "growth: got 2, allowed is 1.05 to 1.5"),
        ({"smoothing": 0.1}, "smoothing: got 0.1, allowed is 0.5 to 2"),
        ({"first_height": 0.0}, "first_height: got 0 m, must be positive"),
        ({"distance": -1.0}, "distance: got -1 m, must be positive"),
        ({"y_plus": 1.0, "first_height": 1.0}, "first_height, y_plus: both are given"),
    ],
)
def test_extrusions_that_cannot_be_are_refused(change, said):
    with pytest.raises(GeometryError, match=said):
        Extrusion(**change)


def test_a_sharp_edge_is_refused(blade):
    sharp = from_blade(blade.with_trailing_edge(Sharp()), COARSE)
    with pytest.raises(GeometryError, match=r"its trailing edge is sharp.* --trailing-edge 2mm,1%"):
        front_of(sharp)


def test_what_would_fold_is_refused_with_its_place(blade):
    grid = from_blade(blade, COARSE)
    thick = Extrusion(first_height=1.0, growth=1.5, distance=200.0, smoothing=0.5)
    with pytest.raises(
        GeometryError, match=r"would fold in layer 1, 0 m off the .* % span; give a smaller --first"
    ):
        volume_of(blade, grid, thick)
    fine = from_blade(blade, replace(COARSE, around=131))
    with pytest.raises(GeometryError, match=r"fewer points: --grid-around 129 --grid-along 81"):
        volume_of(blade, fine, thick)
    fine = from_blade(blade, replace(COARSE, edge=18))
    with pytest.raises(GeometryError, match=r"across the trailing edge: --grid-edge 16"):
        volume_of(blade, fine, thick)


def test_what_folds_far_out_may_end_before():
    assert volumes._instead(COARSE, 2.04).startswith("--distance 2m, another --smoothing")


def test_a_surface_that_is_folded_is_refused(blade):
    grid = from_blade(blade, COARSE)
    points = grid.blocks[0].points.copy()
    points[9, 9] = points[9, 12]
    bent = replace(grid, blocks=(replace(grid.blocks[0], points=points), *grid.blocks[1:]))
    said = "cells of the suction side are folded on the surface already; give"
    with pytest.raises(GeometryError, match=said):
        front_of(bent)


def test_vtk_reads_plot3d_bit_for_bit(volume, tmp_path):
    volume_files.write_plot3d(volume, tmp_path / "a.p3d")
    reader = pyvista.MultiBlockPlot3DReader(tmp_path / "a.p3d")
    reader.auto_detect_format = True
    for number, again in enumerate(reader.read()):
        points = volume.block(number)
        assert again.dimensions == points.shape[:3]
        assert np.array_equal(again.points, points.transpose(2, 1, 0, 3).reshape(-1, 3))
        assert again.compute_cell_sizes()["Volume"].min() > 0.0


def text(node):
    return bytes(node[" data"][:].astype(np.uint8)).decode()


def test_cgns_joins_blocks_and_covers_the_rest_with_conditions(volume, tmp_path):
    """By 1-to-1 ranges and conditions every face of a block's boundary is named exactly once."""
    volume_files.write_cgns(volume, tmp_path / "a.cgns", note="made here")
    with h5py.File(tmp_path / "a.cgns") as file:
        base = file["Base"]
        assert base[" data"][:].tolist() == [3, 3]
        assert text(base["FarField/FamilyBC"]) == "BCFarfield"
        assert text(base["RootPlane/FamilyBC"]) == "BCSymmetryPlane"
        assert text(base["Tip/FamilyBC"]) == "BCWall"
        for number, block in enumerate(volume.grid.blocks):
            zone = base[f"Zone{block.name.title().replace(' ', '')}"]
            shape = volume.shapes[number]
            assert zone[" data"][0].tolist() == list(shape)
            held = np.stack([zone[f"GridCoordinates/Coordinate{c}/ data"][:] for c in "XYZ"], -1)
            assert np.array_equal(held.transpose(2, 1, 0, 3), volume.block(number))
            cells = np.subtract(shape, 1)
            named = [np.zeros(np.delete(cells, axis), int) for axis in (0, 0, 1, 1, 2, 2)]
            for part in (*zone["ZoneGridConnectivity"].values(), *zone["ZoneBC"].values()):
                begin, end = part["PointRange/ data"][:] - 1
                (axis,) = np.flatnonzero(begin == end)
                a, b = np.delete([begin, end], axis, axis=1).tolist()
                named[2 * axis + (begin[axis] > 0)][a[0] : b[0], a[1] : b[1]] += 1
                if "FamilyName" in part:
                    assert text(part["FamilyName"]) in base
            assert all(np.all(face == 1) for face in named)


def test_openfoam_s_faces_close_every_cell(volume):
    mesh = mesh_of(volume)
    points = mesh.points[mesh.faces]
    area = 0.5 * np.cross(points[:, 2] - points[:, 0], points[:, 3] - points[:, 1])
    inner, cells = len(mesh.neighbour), volume.figures["cells"]
    closed = np.stack([np.bincount(mesh.owner, a, cells) for a in area.T], -1)
    closed -= np.stack([np.bincount(mesh.neighbour, a, cells) for a in area[:inner].T], -1)
    assert np.abs(closed).max() < 1e-12 * np.abs(area).max()
    assert np.all(np.bincount(mesh.owner) + np.bincount(mesh.neighbour, minlength=cells) == 6)
    assert np.all(mesh.owner[:inner] < mesh.neighbour)
    pairs = mesh.owner[:inner] * cells + mesh.neighbour
    assert np.all(np.diff(pairs) > 0)
    assert list(mesh.patches) == [
        *("suction_side", "pressure_side", "trailing_edge", "tip"),
        "far_field",
        "root_plane",
    ]
    kind, start, count = mesh.patches["root_plane"]
    assert kind == "symmetryPlane"
    assert_allclose(area[start : start + count, :2], 0.0, atol=1e-15)
    assert np.all(area[start : start + count, 2] < 0.0)
    assert start + count == len(mesh.faces)


def accepted(case):
    """What checkMesh says of a case, but for the aspect of cells in layers on the wall."""
    environment = {**os.environ, "WM_PROJECT_DIR": os.environ.get("WM_PROJECT_DIR", DEBIAN)}
    said = subprocess.run(
        ["checkMesh", "-case", case, "-constant"],
        env=environment,
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    failed = [line for line in said.splitlines() if line.startswith(" ***")]
    return said, [line for line in failed if "aspect ratio" not in line]


@pytest.mark.skipif(shutil.which("checkMesh") is None, reason="OpenFOAM is not installed")
def test_angles_and_skewness_are_checkmesh_s(blade, tmp_path):
    made = volume_of(blade, from_blade(blade, COARSE), QUICK)
    path = bg.export(blade, tmp_path / "a.volume.foam.zip", spacing=COARSE, extrusion=QUICK)
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path / "case")
    said, _ = accepted(tmp_path / "case")
    most, mean = re.search(r"non-orthogonality Max: (\S+) average: (\S+)", said).groups()
    skewed = re.search(r"Max skewness = ([\d.]+)", said)[1]
    figures = made.figures
    assert_allclose(figures["largest_non_orthogonality_deg"], float(most), rtol=1e-3)
    assert_allclose(figures["mean_non_orthogonality_deg"], float(mean), rtol=1e-3)
    assert_allclose(figures["largest_skewness"], float(skewed), rtol=1e-3)


def exported(name, tip, path):
    """A bundled blade's volume, of the size that docs/grids.md has figures of."""
    blade = Blade.from_definition(read(name))
    spacing = Spacing(around=129, along=81, edge=16, trailing_edge=2e-3)
    extrusion = Extrusion(first_height=1e-4)
    return bg.export(blade, path, tip=TIPS[tip], spacing=spacing, extrusion=extrusion)


FOLDS = pytest.mark.xfail(raises=GeometryError, strict=True, reason="folds off the edge's ring")
AT_DEFAULTS = [
    pytest.param(name, tip, marks=[FOLDS] if (name, tip) == ("iea15mw", "round") else [])
    for name in bundled()
    for tip in TIPS
]


@pytest.mark.nightly
@pytest.mark.parametrize(("name", "tip"), AT_DEFAULTS)
def test_three_blades_at_the_defaults(name, tip):
    blade = Blade.from_definition(read(name))
    made = volume_of(blade, from_blade(blade, tip=TIPS[tip]))
    assert made.figures["cells_not_positive"] == 0
    assert made.figures["smallest_scaled_jacobian"] > 0.0


@pytest.mark.nightly
@pytest.mark.skipif(shutil.which("checkMesh") is None, reason="OpenFOAM is not installed")
@pytest.mark.parametrize("tip", TIPS)
@pytest.mark.parametrize("name", bundled())
def test_checkmesh_finds_no_fault_but_high_aspects(name, tip, tmp_path):
    path = exported(name, tip, tmp_path / "a.volume.foam.zip")
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path / "case")
    said, failed = accepted(tmp_path / "case")
    assert failed == []
    assert "Cell volumes OK." in said
    assert "Face pyramids OK." in said


@pytest.mark.nightly
@pytest.mark.skipif(shutil.which("cgnscheck") is None, reason="cgns-tools is not installed")
@pytest.mark.parametrize("tip", TIPS)
@pytest.mark.parametrize("name", bundled())
def test_cgnscheck_finds_nothing(name, tip, tmp_path):
    path = exported(name, tip, tmp_path / "a.volume.cgns")
    said = subprocess.run(["cgnscheck", path], check=True, capture_output=True, text=True).stdout
    assert "checking complete" in said
    assert "ERROR" not in said.upper().replace("ERRORS: 0", "")
    assert "WARNING" not in said.upper()


@pytest.mark.nightly
@pytest.mark.parametrize("tip", TIPS)
@pytest.mark.parametrize("number", range(20))
def test_twenty_variants(number, tip):
    rng = np.random.default_rng(number)
    names = bundled()
    blade = Blade.from_definition(read(names[number % len(names)])).perturbed(
        thickness=rng.uniform(0.9, 1.1),
        camber=rng.uniform(0.8, 1.2),
        chord=rng.uniform(0.9, 1.1),
        twist_scale=rng.uniform(0.9, 1.1),
        prebend_scale=rng.uniform(0.7, 1.3),
    )
    grid = from_blade(blade, Spacing(around=129, along=81, edge=16), TIPS[tip])
    made = volume_of(blade, grid, Extrusion(first_height=1e-4))
    for block in range(len(grid.blocks)):
        points = made.block(block)
        assert min(corner.min() for corner in corners(points)) > 0.0
        assert sizes(points).min() > 0.0
