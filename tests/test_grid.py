from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.blade.blade import Blade
from bladegen.blade.edges import AsGiven, MinimumThickness, Sharp
from bladegen.errors import GeometryError
from bladegen.formats.bundled import bundled
from bladegen.formats.reading import read
from bladegen.surface import mesh
from bladegen.surface.grids.grid import Spacing, from_blade
from bladegen.surface.grids.grid_files import welded
from bladegen.surface.grids.grid_quality import areas, corner_angles, grid_figures, skewness
from bladegen.surface.tips import arcs, flat_tip, on_arcs, round_tip
from strategies import definitions, few

TIPS = flat_tip, round_tip
SMALL = Spacing(around=65, along=17, edge=4, leading_edge=5e-3, trailing_edge=5e-3, tip=0.01)


@pytest.fixture(scope="module", params=bundled())
def blade(request):
    return Blade.from_definition(read(request.param))


@pytest.fixture(scope="module", params=TIPS)
def grid(blade, request):
    return from_blade(blade, tip=request.param)


def normals(points):
    """The cells' normals, by their diagonals."""
    return np.cross(points[1:, 1:] - points[:-1, :-1], points[:-1, 1:] - points[1:, :-1])


def enclosed(grid):
    """The volume inside a grid and its flat root, by the divergence theorem, and its area."""
    total, area, start = 0.0, 0.0, grid.blocks[0].points[0, 0]
    rims = []
    for block in grid.blocks:
        a, b = block.points[:-1, :-1] - start, block.points[1:, :-1] - start
        c, d = block.points[1:, 1:] - start, block.points[:-1, 1:] - start
        for p, q, r in ((a, b, c), (a, c, d)):
            total += np.sum(p * np.cross(q, r)) / 6
            area += 0.5 * np.linalg.norm(np.cross(q - p, r - p), axis=-1).sum()
        if block.family != "tip":
            rims.append(block.points[0])
    root = np.concatenate(rims) - start
    total += np.sum(np.cross(root[:-1], root[1:]) @ root.mean(axis=0)) / 6
    return total, area


def test_blocks_are_named_as_the_solid_s_faces(grid):
    names = ["suction side", "pressure side", "trailing edge", "tip rim", "tip core"]
    assert [block.name for block in grid.blocks] == names
    assert [block.family for block in grid.blocks] == [*names[:3], "tip", "tip"]


def test_points_lie_on_the_blade_s_own_sections(blade, grid):
    for block in grid.blocks[:2]:
        eta, u = block.eta[:, 0], block.u[0]
        whole = (
            np.concatenate([u, 1 - u[-2::-1]]) if u[0] == 0 else np.concatenate([1 - u[:0:-1], u])
        )
        own = slice(None, len(u)) if u[0] == 0 else slice(len(u) - 1, None)
        assert_allclose(block.points, blade.sections(eta, whole)[:, own], atol=1e-9)


def test_blocks_match_bit_for_bit_and_their_transforms_are_turns(grid):
    assert len(grid.interfaces) == 11
    for joint in grid.interfaces:
        own, other = grid.along(joint)
        assert len(own) > 2
        assert np.array_equal(own, other)
        matrix = np.zeros((2, 2))
        for axis, to in enumerate(joint.transform):
            matrix[abs(to) - 1, axis] = np.sign(to)
        assert np.linalg.det(matrix) == 1
        step = np.subtract(joint.stop, joint.start)
        assert np.array_equal(matrix @ step, np.subtract(joint.donor_stop, joint.donor_start))


def test_every_edge_but_the_root_is_an_interface_once(grid):
    """Each cell's edge belongs to two cells, to one at the root: the grid is closed there only."""
    first, cells = welded(grid)
    points = np.concatenate([block.points.reshape(-1, 3) for block in grid.blocks])[first]
    edges = np.concatenate([cells[:, [i, (i + 1) % 4]] for i in range(4)])
    forward, backward = (edges @ turn for turn in ([len(first), 1], [1, len(first)]))
    assert len(np.unique(forward)) == len(forward)
    open_ = edges[~np.isin(forward, backward)]
    assert len(open_) == grid.spacing.around - 1 + grid.spacing.edge
    root = np.concatenate([b.points[0] for b in grid.blocks if b.family != "tip"])
    assert {tuple(p) for p in points[open_.reshape(-1)]} == {tuple(p) for p in root}


def test_no_cell_is_folded_or_flat_and_all_face_outward(grid):
    for block in grid.blocks:
        assert corner_angles(block.points).min() > 0
        assert areas(block.points).min() > 1e-8
        assert block.points.flags.writeable is False
    outward = [(0, 1), (0, -1), (1, 1), (2, 1), (2, 1)]
    for block, (axis, sign) in zip(grid.blocks, outward, strict=True):
        assert np.sum(normals(block.points)[..., axis]) * sign > 0


def test_cells_are_no_more_skewed_or_stretched_than_documented(grid):
    for block in grid.blocks:
        limit = 0.9 if block.name == "trailing edge" else 0.65
        assert skewness(block.points).max() < limit
    figures = grid_figures(grid)
    assert figures["largest_stretching"] < 1.3
    assert figures["folded_cells"] == 0


def test_spacings_are_as_asked_for(blade, grid):
    lifting = grid.blocks[0].eta[:, 0] > 0.3
    for block, nose, edge in ((grid.blocks[0], -1, 0), (grid.blocks[1], 0, -1)):
        lengths = np.linalg.norm(np.diff(block.points[lifting], axis=1), axis=-1)
        shares = lengths / lengths.sum(axis=1, keepdims=True)
        assert_allclose(shares[:, nose], grid.spacing.leading_edge, rtol=0.06)
        assert_allclose(shares[:, edge], grid.spacing.trailing_edge, rtol=0.06)
    axis = blade.axis(grid.blocks[0].eta[:, 0])
    steps = np.linalg.norm(np.diff(axis, axis=0), axis=-1)
    assert_allclose(steps[-1], grid.spacing.tip * steps.sum(), rtol=0.03)
    assert_allclose(steps[0], grid.spacing.root * steps.sum(), rtol=0.03)


def test_volume_and_area_are_the_mesh_s(blade, grid):
    tip = round_tip if grid.blocks[3].points[..., 2].max() > 1.0001 * blade.length else flat_tip
    made = mesh.from_blade(blade, tip=tip)
    volume, area = enclosed(grid)
    root = mesh.surface(np.repeat(blade.sections(np.zeros(1)), 2, axis=0)).area / 2
    assert_allclose(volume, made.volume, rtol=1e-3)
    assert_allclose(area, made.area - root, rtol=1e-3)


def test_a_round_tip_s_points_lie_on_its_arcs(blade):
    spacing = replace(SMALL, edge=8)
    rim = from_blade(blade, spacing, round_tip).blocks[-2]
    j = 6  # aft of the nose lines run along arcs' places (e, w) one by one
    e = 0.5 - rim.u[1, j]
    side = np.array([0.0, 0.5 - e, 0.5])
    poles = arcs(blade, round_tip, np.concatenate([side, 1 - side[-2::-1]]))[1]
    assert_allclose(on_arcs(poles, np.array(0.125)), rim.points[1, j], atol=1e-9)


def test_a_flat_tip_is_plane(blade):
    for block in from_blade(blade, SMALL).blocks[-2:]:
        flat = block.points.reshape(-1, 3) - block.points[0, 0]
        assert np.linalg.svd(flat, compute_uv=False)[2] < 1e-9


@settings(max_examples=few(15))
@given(
    definitions(),
    st.sampled_from(TIPS),
    st.sampled_from([4, 6, 8, 12]),
    st.floats(1e-3, 1e-2),
    st.sampled_from([Sharp(), MinimumThickness(0.01)]),
)
def test_any_blade_makes_a_sound_grid(definition, tip, edge, spacing, finish):
    blade = Blade.from_definition(definition, landmarks=51, trailing_edge=finish)
    made = from_blade(blade, replace(SMALL, edge=edge, leading_edge=spacing), tip)
    assert all(np.array_equal(*made.along(joint)) for joint in made.interfaces)
    assert len(made.blocks) == (4 if finish == Sharp() else 5)
    for block in made.blocks[-2:]:
        sound = block.points[:, 1:-1] if block.name == "tip rim" else block.points[:, 1:]
        assert corner_angles(sound).min() > 0
    assert max(skewness(block.points).max() for block in made.blocks) <= 1
    figures = grid_figures(made)
    assert figures["interface_gap_m"] == 0
    assert figures["cells"] == sum((b.eta[1:, 1:]).size for b in made.blocks)


def test_an_edge_sharp_in_part_is_refused():
    given_ = Blade.from_definition(read("nrel5mw"), trailing_edge=AsGiven())
    with pytest.raises(GeometryError, match="sharp at some spans and blunt at others"):
        from_blade(given_, SMALL)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"around": 256}, "grid around: got 256, allowed are odd numbers from 25"),
        ({"around": 23}, "grid around: got 23"),
        ({"edge": 5}, "grid edge: got 5, allowed are even numbers from 4"),
        ({"edge": 2}, "grid edge: got 2"),
        ({"along": 4}, "grid along: got 4, at least 5"),
        ({"leading_edge": 0.1}, "leading-edge spacing: got 0.1"),
        ({"trailing_edge": 0.0}, "trailing-edge spacing: got 0,"),
        ({"tip": -1.0}, "tip spacing: got -1"),
        ({"root": 0.1}, "root spacing: got 0.1"),
    ],
)
def test_spacings_that_cannot_be_are_refused(change, message):
    with pytest.raises(GeometryError, match=message):
        Spacing(**change)
