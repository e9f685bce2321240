import numpy as np
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.curves import polygons
from bladegen.measures.properties import volume
from bladegen.surface import mesh, mesh_files


def rectangle(width, height, x=0.0, y=0.0):
    return np.array([[x, y], [x + width, y], [x + width, y + height], [x, y + height]])


@given(st.floats(0.1, 10), st.floats(0.1, 10), st.floats(-5, 5), st.floats(-5, 5))
def test_rectangles(width, height, x, y):
    found = dict(
        zip(polygons.MEASURES, polygons.measure(rectangle(width, height, x, y)), strict=True)
    )
    wanted = {
        "area": width * height,
        "centroid_x": x + width / 2,
        "centroid_y": y + height / 2,
        "inertia_xx": width * height**3 / 12,
        "inertia_yy": height * width**3 / 12,
        "inertia_xy": 0.0,
        "perimeter": 2 * (width + height),
    }
    for name, value in wanted.items():
        assert_allclose(found[name], value, rtol=1e-9, atol=1e-9)


def test_a_triangle_has_a_product_of_inertia():
    found = polygons.measure(np.array([[0.0, 0], [3, 0], [0, 2]]))
    assert_allclose(found[:6], [3, 1, 2 / 3, 2 / 3, 1.5, -0.5], atol=1e-12)


@given(st.floats(0, 2 * np.pi))
def test_turning_keeps_area_and_the_sum_of_inertias(angle):
    c, s = np.cos(angle), np.sin(angle)
    points = rectangle(3, 1, 2, 1)
    one, two = polygons.measure(np.stack([points, points @ np.array([[c, s], [-s, c]])]))
    assert_allclose(one[[0, 6]], two[[0, 6]])
    assert_allclose(one[3] + one[4], two[3] + two[4])
    assert_allclose(one[3] * one[4] - one[5] ** 2, two[3] * two[4] - two[5] ** 2)


def test_a_box_has_the_volume_and_area_that_it_has():
    base = np.column_stack([rectangle(2, 3)[::-1], np.zeros(4)])  # clockwise
    sections = np.stack([base + np.array([0, 0, z]) for z in (0.0, 1.0, 4.0)])
    found = polygons.volume_and_area(sections[None])
    assert_allclose(found[0], 24)
    assert_allclose(found[1], 2 * (6 + 8 + 12))


def test_blades_are_measured_as_trimesh_measures_them():
    for name in bg.bundled():
        blade = bg.Blade.from_definition(bg.read(name))
        sections = blade.sections(blade.stations(300))
        (found,), (area,) = polygons.volume_and_area(sections[None])
        solid = mesh_files.to_trimesh(mesh.surface(sections))
        assert isinstance(solid, trimesh.Trimesh)
        assert_allclose(found, solid.volume, rtol=2e-5)
        assert_allclose(area, solid.area, rtol=2e-5)
        assert_allclose(found, volume(blade), rtol=1e-4)
