import numpy as np
from numpy.testing import assert_allclose

from bladegen.grid_quality import areas, corner_angles, skewness, stretching


def cells(x, y, shear=0.0):
    """Points on a plane, x + shear y and y."""
    x, y = np.meshgrid(x, y, indexing="ij")
    return np.stack([x + shear * y, y, np.ones_like(x)], axis=-1)


def test_rectangles_have_right_angles_and_no_skewness():
    points = cells([0, 1, 3], [0, 2])
    assert_allclose(corner_angles(points), np.pi / 2)
    assert_allclose(skewness(points), 0, atol=1e-15)
    assert_allclose(areas(points), [[2], [4]])


def test_parallelograms_are_skewed_by_their_angle():
    points = cells([0, 1], [0, 1], shear=1.0)
    assert_allclose(np.degrees(np.sort(corner_angles(points)[0, 0])), [45, 45, 135, 135])
    assert_allclose(skewness(points), 0.5)
    assert_allclose(areas(points), 1)


def test_collapsed_and_folded_cells_are_told():
    points = cells([0, 1], [0, 1])
    points[1, 1] = [0.2, 0.2, 1]
    assert skewness(points).max() > 1
    points[1, 1] = points[1, 0]
    assert_allclose(skewness(points), 1)


def test_stretching_is_the_worst_ratio_either_way():
    assert_allclose(stretching(cells([0, 1, 3, 4], [0, 1, 2.5])), 2)
    assert stretching(cells([0, 1], [0, 1])) == 1
