from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.blade.blade import Blade
from bladegen.blade.edges import AsGiven, MinimumThickness, Sharp
from bladegen.errors import GeometryError
from bladegen.formats.reading import read
from bladegen.surface import mesh
from bladegen.surface.grids.grid import Spacing, from_blade
from bladegen.surface.grids.grid_files import welded
from bladegen.surface.grids.grid_quality import (
    areas,
    corner_angles,
    grid_figures,
    scaled_jacobian,
    skewness,
    stretching,
)
from bladegen.surface.tips import arcs, flat_tip, on_arcs, round_tip
from strategies import by_day, definitions, few

TIPS = flat_tip, round_tip
SMALL = Spacing(around=65, along=17, edge=4, leading_edge=5e-3, trailing_edge=5e-3, tip=0.01)


@pytest.fixture(scope="module", params=by_day("iea15mw"))
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
        if block.eta[0, 0] == 0.0:
            rims.append(block.points[0])
    root = np.concatenate(rims) - start
    total += np.sum(np.cross(root[:-1], root[1:]) @ root.mean(axis=0)) / 6
    return total, area


def is_round(grid):
    return any(block.name == "edge ring" for block in grid.blocks)


def test_blocks_are_named_as_the_solid_s_faces(grid):
    names = ["suction side", "pressure side", "trailing edge", "tip rim", "tip core"]
    families = [*names[:3], "tip", "tip"]
    if is_round(grid):
        names[3:3], families[3:3] = ["edge ring", "edge core"], ["trailing edge"] * 2
    assert [block.name for block in grid.blocks] == names
    assert [block.family for block in grid.blocks] == families


def test_points_lie_on_the_blade_s_own_sections(blade, grid):
    for block in grid.blocks[:2]:
        eta, u = block.eta[:, 0], block.u[0]
        whole = (
            np.concatenate([u, 1 - u[-2::-1]]) if u[0] == 0 else np.concatenate([1 - u[:0:-1], u])
        )
        own = slice(None, len(u)) if u[0] == 0 else slice(len(u) - 1, None)
        assert_allclose(block.points, blade.sections(eta, whole)[:, own], atol=1e-9)


def test_blocks_match_bit_for_bit_and_their_transforms_are_turns(grid):
    assert len(grid.interfaces) == (17 if is_round(grid) else 11)
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
    root = np.concatenate([b.points[0] for b in grid.blocks if b.eta[0, 0] == 0.0])
    assert {tuple(p) for p in points[open_.reshape(-1)]} == {tuple(p) for p in root}


def test_no_cell_is_folded_or_flat_and_all_face_outward(grid):
    for block in grid.blocks:
        assert corner_angles(block.points).min() > 0
        assert areas(block.points).min() > 1e-13  # m2: a thousandth of a millimetre across
        assert block.points.flags.writeable is False
    outward = {"suction side": (0, 1), "pressure side": (0, -1), "trailing edge": (1, 1)}
    for block in grid.blocks:
        axis, sign = outward.get(block.family, (2, 1))
        assert np.sum(normals(block.points)[..., axis]) * sign > 0


def test_cells_are_as_good_as_documented(grid):
    for block in grid.blocks:
        assert scaled_jacobian(block.points).min() > 0.45
        if block.name not in {"suction side", "pressure side"}:
            assert stretching(block.points) < 1.5
    for block in grid.blocks[:2]:  # at round roots that open to an edge of 2 mm: see docs/grids.md
        assert stretching(block.points[block.eta[:, 0] > 0.12]) < 1.3
    figures = grid_figures(grid)
    assert figures["folded_cells"] == figures["collapsed_cells"] == 0
    assert figures["largest_stretching"] < 3.5


def distances(points, line):
    """How far points (m, 3) are from a polyline (m, 3) beside them, normal to its own steps."""
    way = np.gradient(line, axis=0)
    off = points - line
    crossed = np.linalg.norm(np.cross(off, way), axis=-1)
    return crossed / np.linalg.norm(way, axis=-1)


def runs(pairs):
    """Pairs of indices, split where the first does not go on by one."""
    breaks = np.flatnonzero(np.diff([i for i, _ in pairs]) != 1) + 1
    return np.split(np.array(pairs), breaks)


def beside_shared_edges(blocks):
    """Heights of cells on both sides of each pair of blocks' edges that have the same points.

    Edges are compared point by point, and found without the grid's own list of interfaces.
    """
    lines = []
    for number, block in enumerate(blocks):
        for p in (block.points, block.points.swapaxes(0, 1)):
            lines += [(number, p[0], p[1]), (number, p[-1], p[-2])]
    for k, (one, edge, inside) in enumerate(lines):
        for other, line, within in lines[k + 1 :]:
            place = {tuple(point): i for i, point in enumerate(line)}
            both = [(i, place[tuple(p)]) for i, p in enumerate(edge) if tuple(p) in place]
            if len(both) > 2 and np.ptp(edge, axis=0).any():
                i, j = np.transpose(max(runs(both), key=len))
                yield one, other, distances(inside[i], edge[i]), distances(within[j], line[j])


def test_cells_are_as_high_on_both_sides_of_all_edges(grid):
    ratios = [np.maximum(a / b, b / a) for _, _, a, b in beside_shared_edges(grid.blocks)]
    assert len(ratios) == len(grid.interfaces)
    assert max(ratio.max() for ratio in ratios) < 1.3
    assert np.median(np.concatenate(ratios)) < 1.02
    figures = grid_figures(grid)
    assert_allclose(figures["largest_jump"], max(ratio.max() for ratio in ratios), rtol=1e-9)


@pytest.mark.parametrize("tip", TIPS)
def test_cells_at_a_sharp_edge_s_tip_are_as_high_too(blade, tip):
    """But where all cells end in one point; where a round root ends in an edge, sides differ."""
    made = from_blade(blade.with_trailing_edge(Sharp()), tip=tip)
    for one, other, a, b in beside_shared_edges(made.blocks):
        sound = np.minimum(a, b) > 1e-9
        ratio = np.maximum(a[sound] / b[sound], b[sound] / a[sound])
        assert np.count_nonzero(~sound) <= 2
        assert ratio.max() < (1.8 if (one, other) == (0, 1) else 1.3)
        assert np.count_nonzero(ratio > 1.3) <= 3


def test_sizes_that_are_given_are_kept_and_their_jumps_are_reported(blade):
    given_ = Spacing(edge=16, trailing_edge=1e-3, tip=2e-4)
    made = from_blade(blade, given_)
    assert made.spacing == given_
    assert grid_figures(made)["largest_jump"] > 2.0


def test_spacings_are_as_asked_for(blade, grid):
    assert grid.spacing.tip is not None
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
    rim = from_blade(blade, replace(SMALL, edge=8), round_tip).blocks[-2]
    for i, j in ((1, 6), (2, 9)):
        e = 0.5 - rim.u[i, j]
        side = np.array([0.0, 0.5 - e, 0.5])
        poles = arcs(blade, round_tip, np.concatenate([side, 1 - side[-2::-1]]))[1]
        w = np.linspace(0.0, 0.5, 20001)
        away = np.linalg.norm(on_arcs(poles[None], w) - rim.points[i, j], axis=-1)
        step = np.linalg.norm(np.diff(on_arcs(poles[None], w), axis=0), axis=-1).max()
        assert away.min() < 0.51 * step


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
    st.booleans(),
)
def test_any_blade_makes_a_sound_grid(definition, tip, edge, spacing, finish, coupled):
    blade = Blade.from_definition(definition, landmarks=51, trailing_edge=finish)
    sizes = replace(SMALL, edge=edge, leading_edge=spacing)
    if coupled:
        sizes = replace(sizes, trailing_edge=None, tip=None)
    made = from_blade(blade, sizes, tip)
    assert all(np.array_equal(*made.along(joint)) for joint in made.interfaces)
    assert len(made.blocks) == (4 if finish == Sharp() else 5 if tip is flat_tip else 7)
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
        ({"around": 256}, "grid around: got 256, allowed are odd numbers from 35"),
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
