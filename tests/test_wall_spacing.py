"""Heights of first cells against the wall units that they are made of, and other friction laws."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.errors import GeometryError
from bladegen.surface.wall_spacing import first_height, friction


@given(st.floats(1e5, 1e8), st.floats(0.1, 8.0), st.floats(0.5, 300.0))
def test_the_height_gives_back_its_y_plus(reynolds, chord, y_plus):
    speed, density = 70.0, 1.225
    viscosity = speed * chord / reynolds
    stress = friction(reynolds) * 0.5 * density * speed**2
    height = first_height(reynolds, chord, y_plus)
    assert_allclose(height * np.sqrt(stress / density) / viscosity, y_plus, rtol=1e-12)


def test_the_friction_is_near_other_laws_for_flat_plates():
    reynolds = np.geomspace(1e6, 1e8, 20)
    white = 0.455 / np.log(0.06 * reynolds) ** 2  # F. M. White, Viscous Fluid Flow
    assert_allclose(friction(reynolds), white, rtol=0.05)


def test_a_batch_equals_its_parts():
    reynolds, chord = np.array([[1e6], [1e7]]), np.array([1.0, 2.0, 3.0])
    batch = first_height(reynolds, chord, 1.0)
    one = [[first_height(r, c, 1.0) for c in chord] for r in reynolds[:, 0]]
    assert_allclose(batch, one, rtol=1e-15)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ((1e7, 0.0, 1.0), "chord: got 0 m"),
        ((1e7, 1.0, -1.0), "y\\+: got -1"),
        ((1e7, 1.0, np.nan), "y\\+: got nan"),
        ((10.0, 1.0, 1.0), "Reynolds number: got 10, allowed are 10000 to 1e\\+09"),
    ],
)
def test_what_makes_no_height_is_refused(values, said):
    with pytest.raises(GeometryError, match=said):
        first_height(*values)
