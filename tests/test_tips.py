import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.blade.blade import Blade
from bladegen.cad import solids
from bladegen.formats.reading import read
from bladegen.surface.tips import arcs, flat_tip, on_arcs, round_tip
from strategies import SEEDS, by_day, definitions

W = np.linspace(0.0, 1.0, 9)


def sides(seed, count=4):
    """Opposite points and the directions in which sides arrive there."""
    return np.random.default_rng(seed).normal(size=(4, count, 3))


@given(SEEDS)
def test_arcs_run_from_side_to_side_and_leave_both_tangentially(seed):
    suction, pressure, along, opposite = sides(seed)
    poles = round_tip(suction, pressure, along, opposite)
    assert_allclose(on_arcs(poles, np.zeros(4)), suction, atol=1e-14)
    assert_allclose(on_arcs(poles, np.ones(4)), pressure, atol=1e-14)
    start, end = poles[:, 1] - poles[:, 0], poles[:, 2] - poles[:, 3]
    assert_allclose(np.cross(start, along), 0, atol=1e-12)
    assert_allclose(np.cross(end, opposite), 0, atol=1e-12)
    assert np.all(np.sum(start * along, axis=1) > 0)


@given(SEEDS, st.floats(0.01, 100.0))
def test_lengths_of_directions_do_not_count_and_sizes_scale(seed, factor):
    suction, pressure, along, opposite = sides(seed)
    poles = round_tip(suction, pressure, along, opposite)
    assert_allclose(round_tip(suction, pressure, factor * along, opposite), poles, atol=1e-12)
    scaled = round_tip(factor * suction, factor * pressure, along, opposite)
    assert_allclose(scaled, factor * poles, rtol=1e-9, atol=1e-9)


def test_parallel_sides_are_joined_by_half_a_circle():
    up = np.array([[0.0, 0.0, 2.0]])
    poles = round_tip(np.array([[1.0, 0, 5]]), np.array([[-1.0, 0, 5]]), up, up)
    points = on_arcs(poles, np.linspace(0, 1, 101)[None].T)[:, 0]
    radii = np.linalg.norm(points - [0, 0, 5], axis=1)
    assert_allclose(radii, 1.0, atol=0.02)
    assert_allclose(points[50], [0, 0, 6], atol=1e-12)


@given(definitions())
def test_arcs_of_a_blade_start_on_its_last_section(definition):
    blade = Blade.from_definition(definition, landmarks=51)
    poles, last = arcs(blade, round_tip), blade.sections(1.0)
    assert arcs(blade, flat_tip) is None
    assert_allclose(poles[:, 0], last[:26], atol=1e-12)
    assert_allclose(poles[:, 3], last[:24:-1], atol=1e-12)
    assert_allclose(poles[-1], np.broadcast_to(last[25], (4, 3)), atol=1e-9)


@pytest.mark.parametrize("name", by_day("iea15mw"))
def test_arcs_lie_on_the_solid_s_tip(name):
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
    from OCP.BRepExtrema import BRepExtrema_DistShapeShape
    from OCP.gp import gp_Pnt

    blade = Blade.from_definition(read(name))
    tip = dict(solids.solid(blade, tolerance=1e-3, tip=round_tip).faces)["tip"]
    points = 1e3 * on_arcs(arcs(blade, round_tip)[5::60, None], W[None, 2:-1:3])
    for point in points.reshape(-1, 3).tolist():
        vertex = BRepBuilderAPI_MakeVertex(gp_Pnt(*point)).Vertex()
        assert BRepExtrema_DistShapeShape(vertex, tip).Value() < 0.05
