import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.errors import GeometryError
from bladegen.surface.grids.stretching import two_sided, vinokur

CELLS = st.integers(4, 300)
SHARES = st.floats(1e-3, 1.5)  # of the mean cell


@given(CELLS, SHARES, SHARES)
def test_end_cells_have_the_sizes_asked_for(cells, first, last):
    points = two_sided(cells, first / cells, last / cells)
    assert points.shape == (cells + 1,)
    assert points[0] == 0
    assert points[-1] == 1
    assert np.all(np.diff(points) > 0)
    assert_allclose(np.diff(points)[[0, -1]], [first / cells, last / cells], rtol=1e-6)


@given(CELLS, SHARES, SHARES)
def test_exchanging_the_ends_mirrors_the_points(cells, first, last):
    points = two_sided(cells, first / cells, last / cells)
    mirrored = two_sided(cells, last / cells, first / cells)
    assert_allclose(mirrored, 1 - points[::-1], atol=1e-9)


@given(CELLS)
def test_ends_of_the_mean_size_make_all_cells_alike(cells):
    assert_allclose(two_sided(cells, 1 / cells, 1 / cells), np.linspace(0, 1, cells + 1), atol=1e-9)


@given(st.integers(40, 300), st.floats(0.05, 1.0), st.floats(0.05, 1.0))
def test_cells_grow_and_shrink_once_and_slowly(cells, first, last):
    sizes = np.diff(two_sided(cells, first / cells, last / cells))
    ratios = sizes[1:] / sizes[:-1]
    assert np.all((ratios > 1 / 1.35) & (ratios < 1.35))
    turns = np.diff(np.sign(np.log(ratios[np.abs(np.log(ratios)) > 1e-7])))
    assert np.count_nonzero(turns) <= 1


def test_slopes_are_those_of_the_paper():
    points = vinokur(100_000, np.array([1e-7]), np.array([4e-6]))[0]
    slopes = np.diff(points)[[0, -1]]
    assert_allclose(slopes, [1e-7, 4e-6], rtol=1e-3)


@pytest.mark.parametrize(
    ("cells", "first", "last", "message"),
    [
        (3, 0.1, 0.1, "got 3 cells, at least 4"),
        (10, 0.0, 0.1, "nose: got 0, allowed is more than 0 and up to 0.15"),
        (10, 0.1, 0.2, "edge: got 0.2, allowed"),
        (10, float("nan"), 0.2, "nose: got nan"),
    ],
)
def test_sizes_that_cannot_be_are_refused(cells, first, last, message):
    with pytest.raises(GeometryError, match=message):
        two_sided(cells, first, last, names=("nose", "edge"))
