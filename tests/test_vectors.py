"""Products of vectors are numpy's, bit by bit."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from bladegen.curves.vectors import cross, dots, lengths


@given(st.integers(0, 2**31), st.integers(0, 4), st.booleans())
def test_products_of_vectors_are_those_of_numpy(seed, count, turned):
    one, other = np.random.default_rng(seed).normal(size=(2, 3, count, 3))
    other = other[:, :1] if turned else np.ascontiguousarray(other.swapaxes(0, 1)).swapaxes(0, 1)
    assert_array_equal(cross(one, other), np.cross(one, other))
    assert_array_equal(dots(one, other), np.sum(one * other, axis=-1))
    assert_array_equal(lengths(one), np.linalg.norm(one, axis=-1))
