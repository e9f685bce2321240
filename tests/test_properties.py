from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.airfoils.landmarks import landmark_parameters, landmarks
from bladegen.blade.blade import Blade
from bladegen.blade.edges import AsGiven
from bladegen.blade.planform import normal_to_axis, normal_to_z
from bladegen.definition.blade_definition import Distribution, ReferenceAxis
from bladegen.formats.bundled import bundled
from bladegen.formats.reading import read
from bladegen.measures.properties import area_moments, volume
from strategies import airfoils, ellipse

U = landmark_parameters(401)


@given(st.floats(0.1, 1.0), st.floats(-3, 3), st.floats(-3, 3))
def test_area_and_moments_of_an_ellipse(thickness, dx, dy):
    shape = landmarks(ellipse(thickness, 721), 401) + np.array([dx - 0.5, dy])
    area, moments = area_moments(U, shape[None])
    assert_allclose(area[0], np.pi * thickness / 4, rtol=1e-6)
    assert_allclose(moments[0], area[0] * np.array([dx, dy]), atol=1e-6)


@given(airfoils())
def test_an_open_edge_is_closed_by_a_straight_line(xy):
    shape = landmarks(xy, 401)
    x, y = shape.T
    polygon = 0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)
    assert_allclose(area_moments(U, shape[None])[0][0], polygon, rtol=2e-4)


def bent_pipe(angle: float, planes) -> Blade:
    """A circular pipe of radius 1 along an arc of radius 40: Pappus gives its volume."""
    definition = read("nrel5mw")
    eta = np.linspace(0, 1, 201)
    axis = ReferenceAxis(
        Distribution(eta, 40 * (1 - np.cos(angle * eta))),
        Distribution.constant(0.0),
        Distribution(eta, 40 * np.sin(angle * eta)),
    )
    round_ = definition.stations[1]
    flat = Distribution.constant
    return Blade.from_definition(
        replace(
            definition,
            stations=tuple(replace(round_, eta=eta) for eta in (0.0, 1.0)),
            chord=flat(2.0),
            twist=flat(0.3),
            section_offset_y=flat(1.0),
            relative_thickness=None,
            axis=axis,
        ),
        planes=planes,
        trailing_edge=AsGiven(),
        landmarks=201,
    )


def test_pappus():
    pipe = volume(bent_pipe(1.0, normal_to_axis))
    assert_allclose(pipe, np.pi * 40 * 1.0, rtol=1e-4)


def test_sheared_pipe_has_the_volume_of_its_height():
    pipe = volume(bent_pipe(0.5, normal_to_z))
    assert_allclose(pipe, np.pi * 40 * np.sin(0.5), rtol=1e-4)


@pytest.mark.parametrize("name", bundled())
def test_volume_is_that_of_a_fine_mesh(name):
    from bladegen.surface import mesh

    blade = Blade.from_definition(read(name))
    exact = volume(blade)
    fine = np.array([mesh.from_blade(blade, stations=k).volume for k in (300, 600)])
    assert np.all(np.abs(fine / exact - 1) < 1e-4)
