from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.airfoils.landmarks import landmarks
from bladegen.blade.blade import Blade
from bladegen.blade.edges import AsGiven, MinimumThickness, Sharp
from bladegen.errors import GeometryError
from bladegen.formats.bundled import bundled
from bladegen.formats.reading import read
from bladegen.surface import mesh, mesh_files
from bladegen.surface.regions import REGIONS
from bladegen.surface.tips import flat_tip, on_arcs, round_tip
from strategies import SEEDS, definitions, ellipse


def cylinder(n=201, k=5, thickness=0.5, gap=0):
    """An elliptic cylinder of length 3; `gap` landmarks are cut off at either end."""
    shape = landmarks(ellipse(thickness, 721), n + 2 * gap)
    shape = shape[gap : len(shape) - gap]
    z = np.linspace(0, 3, k)
    flat = np.broadcast_to(shape[None, :, ::-1], (k, n, 2))
    return np.concatenate([flat, np.broadcast_to(z[:, None, None], (k, n, 1))], axis=-1)


def edges_are_shared_by_two(faces):
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    forward = {tuple(edge) for edge in edges.tolist()}
    return len(forward) == len(edges) and all((b, a) in forward for a, b in forward)


def euler_characteristic(made):
    edges = 3 * len(made.faces) // 2
    return len(made.vertices) - edges + len(made.faces)


def least_height(made):
    """The smallest height of any triangle over its longest side."""
    corners = made.vertices[made.faces]
    sides = np.roll(corners, -1, axis=1) - corners
    longest = np.linalg.norm(sides, axis=2).max(axis=1)
    return np.min(np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / longest)


@cache
def whole(name):
    """A bundled blade as it is unless something else is asked for."""
    return Blade.from_definition(read(name))


EDGES = AsGiven(), Sharp(), MinimumThickness(0.01)


@given(definitions(), st.sampled_from(EDGES), st.sampled_from([flat_tip, round_tip]))
def test_blades_of_any_edge_and_tip_are_closed_and_face_outward(definition, edge, tip):
    blade = Blade.from_definition(definition, landmarks=51, trailing_edge=edge)
    made = mesh.from_blade(blade, stations=30, tip=tip)
    assert edges_are_shared_by_two(made.faces)
    assert euler_characteristic(made) == 2
    assert made.volume > 0
    assert set(np.unique(made.faces)) == set(range(len(made.vertices)))


@pytest.mark.parametrize("gap", [0, 3])
def test_volume_and_area_of_a_cylinder(gap):
    made = mesh.surface(cylinder(gap=gap, n=401))
    assert edges_are_shared_by_two(made.faces)
    if gap == 0:
        assert_allclose(made.volume, np.pi * 0.5 / 4 * 3, rtol=2e-4)
    fine = mesh.surface(cylinder(gap=4 * gap, n=1601))
    assert_allclose(made.volume, fine.volume, rtol=5e-3)
    assert_allclose(made.area, fine.area, rtol=5e-3)


@given(SEEDS)
def test_rigid_motions_change_nothing(seed):
    rng = np.random.default_rng(seed)
    turn = np.linalg.qr(rng.normal(size=(3, 3))).Q
    turn[:, 0] *= np.linalg.det(turn)
    sections = cylinder(n=51)
    made, moved = mesh.surface(sections), mesh.surface(sections @ turn + rng.normal(size=3))
    assert_allclose(moved.volume, made.volume, rtol=1e-12)
    assert_allclose(moved.area, made.area, rtol=1e-12)


def test_sharp_and_blunt_in_one_blade():
    sections = cylinder(n=51, gap=2).copy()
    sections[2:, -1] = sections[2:, 0]
    made = mesh.surface(sections)
    assert edges_are_shared_by_two(made.faces)
    assert euler_characteristic(made) == 2
    assert len(made.vertices) == 5 * 51 - 3


def pointed(sections):
    sections[-1] = sections[-1].mean(axis=0)


def knife_edged(sections):
    sections[-1, :26] = sections[-1, 25:][::-1]


def with_a_landmark_twice(sections):
    sections[:, 10] = sections[:, 9]


def with_a_landmark_twice_in_one_section(sections):
    sections[2, 10] = sections[2, 9]


def with_a_section_twice(sections):
    sections[3] = sections[2]


def with_all_of_it(sections):
    sections[:2] = sections[0].mean(axis=0)
    sections[3, 20:24] = sections[3, 20]
    sections[-2:] = sections[-1]


@pytest.mark.parametrize(
    "spoil",
    [
        pointed,
        knife_edged,
        with_a_landmark_twice,
        with_a_landmark_twice_in_one_section,
        with_a_section_twice,
        with_all_of_it,
    ],
)
@pytest.mark.parametrize("gap", [0, 2])
def test_landmarks_that_coincide_leave_no_degenerate_triangle(spoil, gap):
    sections = cylinder(n=51, k=7, gap=gap).copy()
    spoil(sections)
    made = mesh.surface(sections)
    assert edges_are_shared_by_two(made.faces)
    assert euler_characteristic(made) == 2
    assert made.volume > 0
    assert least_height(made) > 1e-6


@pytest.mark.parametrize("name", bundled())
@pytest.mark.parametrize("edge", [AsGiven(), Sharp(), MinimumThickness(0.002)])
@pytest.mark.parametrize("tip", [flat_tip, round_tip])
def test_blades_have_no_degenerate_triangle(name, edge, tip):
    blade = whole(name).with_trailing_edge(edge)
    assert least_height(mesh.from_blade(blade, tip=tip)) > mesh.SAME_POINT


def test_a_rounded_tip_adds_the_volume_of_half_an_ellipsoid():
    sections = cylinder(n=801, k=3, thickness=0.3)
    suction, pressure = sections[-1, :401], sections[-1, :399:-1]
    poles = round_tip(suction, pressure, *2 * [np.broadcast_to([0.0, 0.0, 1.0], (401, 3))])
    across = on_arcs(poles[:, None], np.linspace(0, 1, 65)[None])
    added = mesh.surface(sections, across).volume - mesh.surface(sections).volume
    assert_allclose(added, 2 / 3 * np.pi * 0.5 * 0.15 * 0.15, rtol=0.03)


def test_the_default_is_a_quarter_of_a_million_triangles():
    assert 230_000 < len(mesh.from_blade(whole("iea15mw")).faces) < 250_000


@pytest.mark.parametrize("name", bundled())
def test_trimesh_agrees(name):
    made = mesh.from_blade(whole(name), stations=100)
    other = mesh_files.to_trimesh(made)
    assert other.is_watertight
    assert other.is_winding_consistent
    assert_allclose(other.volume, made.volume, rtol=1e-9)
    assert_allclose(other.area, made.area, rtol=1e-9)
    assert_allclose(mesh_files.to_trimesh(made, scale=1e3).volume, 1e9 * made.volume, rtol=1e-9)


@pytest.mark.parametrize("tip", [flat_tip, round_tip])
@pytest.mark.parametrize("mirrored", [False, True])
def test_triangles_know_their_regions(tip, mirrored):
    blade = whole("dtu10mw").mirror_image() if mirrored else whole("dtu10mw")
    made = mesh.from_blade(blade, stations=60, tip=tip)
    names = [REGIONS[number] for number in np.unique(made.regions)]
    assert names == list(REGIONS[: 5 if tip is flat_tip else 6])
    corners = made.vertices[made.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outward = [normals[made.regions == number].sum(axis=0) for number in range(5)]
    assert outward[0][0] > 0 > outward[1][0], "the suction side looks downwind"
    assert outward[2][1] * (-1 if mirrored else 1) > 0, "trailing edges lie at +y"
    assert outward[3][2] < 0 < outward[4][2]
    heights = corners[..., 2][made.regions == 3]
    assert np.ptp(heights) < 0.01 * blade.length
    places = made.places[made.faces]
    first = places[made.regions == (1 if mirrored else 0)]
    assert first[..., 1].max() <= 0.5


def test_values_cannot_be_written():
    made = mesh.surface(cylinder(n=51))
    for array in (made.vertices, made.faces):
        with pytest.raises(ValueError, match="read-only"):
            array[0, 0] = 1


@pytest.mark.parametrize("shape", [(1, 51, 3), (4, 50, 3), (4, 3, 3)])
def test_grids_that_are_none_are_refused(shape):
    with pytest.raises(GeometryError, match="allowed are at least 2 sections"):
        mesh.surface(np.zeros(shape))
