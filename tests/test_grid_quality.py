import numpy as np
from numpy.testing import assert_allclose

from bladegen.surface.grids.grid import Block, Grid, Interface
from bladegen.surface.grids.grid_quality import (
    areas,
    collapsed,
    corner_angles,
    grid_figures,
    scaled_jacobian,
    skewness,
    stretching,
)


def cells(x, y, shear=0.0):
    """Points on a plane, x + shear y and y."""
    x, y = np.meshgrid(x, y, indexing="ij")
    return np.stack([x + shear * y, y, np.ones_like(x)], axis=-1)


def test_rectangles_have_right_angles_and_no_skewness():
    points = cells([0, 1, 3], [0, 2])
    assert_allclose(corner_angles(points), np.pi / 2)
    assert_allclose(skewness(points), 0, atol=1e-15)
    assert_allclose(scaled_jacobian(points), 1)
    assert_allclose(areas(points), [[2], [4]])


def test_parallelograms_are_skewed_by_their_angle():
    points = cells([0, 1], [0, 1], shear=1.0)
    assert_allclose(np.degrees(np.sort(corner_angles(points)[0, 0])), [45, 45, 135, 135])
    assert_allclose(skewness(points), 0.5)
    assert_allclose(scaled_jacobian(points), np.sqrt(0.5))
    assert_allclose(areas(points), 1)


def test_collapsed_and_folded_cells_are_told():
    points = cells([0, 1], [0, 1])
    points[1, 1] = [0.2, 0.2, 1]
    assert skewness(points).max() > 1
    assert scaled_jacobian(points).max() < 0
    assert not collapsed(points).any()
    points[1, 1] = points[1, 0]
    assert_allclose(skewness(points), 1)
    assert collapsed(points).all()


def test_stretching_is_the_worst_ratio_either_way():
    assert_allclose(stretching(cells([0, 1, 3, 4], [0, 1, 2.5])), 2)
    assert stretching(cells([0, 1], [0, 1])) == 1


def test_figures_tell_folded_cells_and_blocks_that_do_not_match():
    left, right = cells([0, 1], [0, 1, 2]), cells([0, 1], [2, 3, 4])
    left[1, 1] = [1, 2.5, 1]
    right[0, 0] = [0, 2.25, 1]
    blocks = [
        Block(name, name, points, points[..., 0], points[..., 1])
        for name, points in (("left", left), ("right", right))
    ]
    joint = Interface(0, 1, (0, 2), (1, 2), (0, 0), (1, 0), (1, 2))
    figures = grid_figures(Grid("two", tuple(blocks), (joint,)))
    assert figures["folded_cells"] == figures["by_block"]["left"]["folded_cells"] == 1
    assert figures["worst_skewness"] > 1
    assert figures["smallest_scaled_jacobian"] < 0
    assert figures["corner_angles_deg"][1] > 180
    assert figures["collapsed_cells"] == 0
    assert figures["interface_gap_m"] == 0.25
    assert figures["cells"] == 4
