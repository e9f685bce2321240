import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.surface.grids.grid import Block, Grid, Interface
from bladegen.surface.grids.joints import heights, jump_figures, jumps

SIZES = st.floats(1e-3, 10.0)


def cells(x, y, shear=0.0):
    """Points on a plane, x + shear y and y."""
    x, y = np.meshgrid(x, y, indexing="ij")
    return np.stack([x + shear * y, y, np.ones_like(x)], axis=-1)


def pair(left, right, joint):
    """Two blocks of such points that share an edge."""
    made = [
        Block(name, name, points, points[..., 0], points[..., 1])
        for name, points in (("left", left), ("right", right))
    ]
    return Grid("two", tuple(made), (joint,))


STRAIGHT = Interface(0, 1, (0, 2), (3, 2), (0, 0), (3, 0), (1, 2))


@given(SIZES, SIZES, st.floats(-3.0, 3.0))
def test_heights_are_normal_to_the_edge_whatever_the_shear(own, other, shear):
    x = [0.0, 1.0, 3.0, 4.0]
    left, right = (
        cells(x, [-1.0 - own, -own, 0.0], shear),
        cells(x, [0.0, other, other + 1], -shear),
    )
    grid = pair(left, right, STRAIGHT)
    for found, true in zip(heights(grid, STRAIGHT), (own, other), strict=True):
        assert_allclose(found, true, rtol=1e-9)
    assert_allclose(jumps(grid, STRAIGHT), max(own / other, other / own), rtol=1e-9)


@pytest.mark.parametrize("reverse", [False, True])
def test_an_edge_is_followed_from_either_end_and_along_either_index(reverse):
    x = np.array([0.0, 1.0, 3.0, 4.0])
    left = cells(x, [-2.0, 0.0])
    left[:, 0, 1] = -1.0 - x  # higher and higher
    right = cells(x, [0.0, 1.0])
    right[:, 1, 1] = 2.0 + 2.0 * x
    donor = np.swapaxes(right[::-1], 0, 1) if reverse else right
    ends = ((0, 3), (0, 0)) if reverse else ((0, 0), (3, 0))
    joint = Interface(0, 1, (0, 1), (3, 1), *ends, (-2, 1) if reverse else (1, 2))
    grid = pair(left, donor, joint)
    assert np.array_equal(*grid.along(joint))
    assert_allclose(jumps(grid, joint), 2.0)


def test_figures_name_blocks_and_count_points_where_cells_have_no_height():
    x = [0.0, 1.0, 3.0, 4.0]
    left, right = cells(x, [-2, -1.0, 0.0]), cells(x, [0.0, 3.0, 5.0])
    left[0, :, :] = left[0, -1]  # a triangle
    right[-1, 1, 1] = 1.5
    figures = jump_figures(pair(left, right, STRAIGHT))
    assert figures["collapsed_edge_points"] == 1
    assert figures["largest_jump"] == 3.0
    assert figures["median_jump"] == 3.0
    assert figures["largest_and_median_jump_between"] == {"left - right": [3.0, 3.0]}
