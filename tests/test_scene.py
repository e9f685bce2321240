import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.errors import RenderError
from bladegen.surface import mesh
from bladegen.views.rendering import blade_scene, scene
from bladegen.views.rendering.cameras import ANGLE, VIEWS, View, camera, perspective
from bladegen.views.rendering.drawing import cuts, polylines, shaded, signed_distances


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)


@given(radius=st.floats(0.5, 5.0), other=st.floats(0.5, 5.0), bend=st.floats(-0.9, 0.9))
def test_mean_curvature_of_a_cylinder_on_any_grid(radius, other, bend):
    """On a circular cylinder it is 1 / (2 r), whatever the spacing of the grid."""
    rng = np.random.default_rng(5)
    u = np.linspace(0.0, 1.0, 201) + 0.001 * bend * np.sin(2 * np.pi * np.linspace(0, 1, 201))
    eta = np.sort(rng.uniform(size=30))
    angle = 2 * np.pi * u  # from the trailing edge (+y) over the suction side (+x)
    points = np.stack(
        np.broadcast_arrays(radius * np.sin(angle), radius * np.cos(angle), other * eta[:, None]),
        axis=-1,
    )
    found = blade_scene.mean_curvature(points, eta, u)
    assert_allclose(found[:, 5:-5], 0.5 / radius, rtol=5e-3)


def test_mean_curvature_of_a_sphere_and_of_its_inside():
    eta, u = np.linspace(0.2, 0.8, 61), np.linspace(0.1, 0.9, 101)
    polar, angle = np.pi * (1 - eta)[:, None], 2 * np.pi * u
    points = 3.0 * np.stack(
        np.broadcast_arrays(
            np.sin(polar) * np.sin(angle), np.sin(polar) * np.cos(angle), np.cos(polar)
        ),
        axis=-1,
    )
    inner = slice(2, -2), slice(2, -2)
    assert_allclose(blade_scene.mean_curvature(points, eta, u)[inner], 1 / 3, rtol=5e-3)
    mirrored = points * [1.0, -1.0, 1.0]
    assert_allclose(blade_scene.mean_curvature(mirrored, eta, u)[inner], -1 / 3, rtol=5e-3)


def test_a_root_of_nrel_5_mw_is_curved_as_its_radius(blade):
    found = blade_scene.scene_of(blade, sections=80)
    root = found.surface.vertices[:, 2] < 1.0
    values = found.field("curvature").values[root]
    assert np.median(values) == pytest.approx(1 / blade.chord(0.0), rel=0.01)


def test_fields_belong_to_vertices_and_distances_have_the_baselines_sign(blade):
    thicker = blade.perturbed(thickness=1.2)
    found = blade_scene.scene_of(thicker, blade, sections=60)
    field = found.field("distance")
    assert len(field.values) == len(found.surface.vertices)
    assert field.values.max() > 50  # mm; a fifth of some hundred millimetres on either side
    assert np.abs(field.values[found.surface.vertices[:, 2] < 1.0]).max() < 1.0
    assert field.low == -field.high
    assert found.names == ("wireframe", "sections", "stations", "frame", "baseline")
    back = blade_scene.scene_of(blade, thicker, sections=60).field("distance")
    assert np.median(back.values) < 0 < np.median(field.values)


def test_without_a_baseline_there_are_no_distances(blade):
    found = blade_scene.scene_of(blade, sections=60)
    assert [field.name for field in found.fields] == ["curvature"]
    with pytest.raises(RenderError, match="colour: got 'distance', allowed are plain"):
        found.field("distance")


def test_a_perturbed_blade_says_so(blade):
    found = blade_scene.scene_of(blade.perturbed(twist=0.01, name="turned"), blade, sections=60)
    assert found.title == "NREL 5 MW; perturbed: twist 0.573 deg"
    assert "61.5 m long" in found.caption


@given(st.lists(st.floats(-5, 5), min_size=8, max_size=8), st.floats(0.1, 1.0))
def test_colours_reach_a_round_number_above_most_of_the_area(values, share):
    box = mesh.TriangleMesh(
        np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, -1).T.astype(float),
        np.array([[0, 1, 2], [3, 4, 5], [6, 7, 0]]),
    )
    values = np.array(values)
    reach = scene.reach_of(values, box, share)
    digit = reach / 10 ** np.floor(np.log10(reach) + 1e-9)
    assert min(abs(digit - d) for d in (1, 2, 4, 5)) < 1e-6
    assert reach <= max(10 * np.abs(values).max(), scene.UNMOVED)
    assert scene.reach_of(values, box, 1.0) >= np.abs(values).max() * (1 - 1e-6)


def test_a_page_takes_fewer_landmarks_and_keeps_ends_and_nose():
    assert [blade_scene.thinning(n, 201) for n in (101, 201, 401, 801, 203, 403)] == [
        1,
        1,
        2,
        4,
        1,
        1,
    ]


@given(st.sampled_from(sorted(VIEWS)), st.floats(0.4, 4.0), st.integers(0, 1000))
def test_a_camera_sees_all_points_and_none_too_small(name, aspect, seed):
    points = np.random.default_rng(seed).normal(size=(40, 3)) * [2.0, 3.0, 40.0]
    view = VIEWS[name]
    eye, focus, up = camera(points, view, aspect)
    distance = np.linalg.norm(eye - focus)
    towards = (eye - focus) / distance
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(towards, right)])
    seen = (points - focus) @ axes.T
    depth = distance - (0 if view.parallel else (points - focus) @ towards)
    place = seen / np.tan(np.radians(ANGLE / 2)) / np.reshape(depth, (-1, 1)) / [aspect, 1.0]
    assert np.abs(place).max() <= 1.0
    assert np.abs(place).max() > 0.85


@given(st.floats(0.4, 4.0), st.integers(0, 1000))
def test_perspective_shows_in_parallel_what_the_camera_sees(aspect, seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(40, 3)) * [2.0, 3.0, 40.0]
    view = VIEWS["oblique"]
    eye, focus, up = camera(points, view, aspect)
    towards = (eye - focus) / np.linalg.norm(eye - focus)
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(towards, right), towards], axis=1)
    there = (points - eye) @ axes
    expected = there[:, :2] / -there[:, 2:] / np.tan(np.radians(ANGLE / 2))
    seen = perspective(points, view, aspect)
    found, normals = seen(points, np.broadcast_to(towards, points.shape))
    assert_allclose(found[:, :2], expected, atol=1e-9)
    assert_allclose(normals, np.broadcast_to([0.0, 0.0, 1.0], points.shape), atol=1e-12)
    assert_allclose([found[:, 2].min(), found[:, 2].max()], [-1.0, 1.0], atol=1e-9)
    nearer = np.argsort(there[:, 2])
    assert np.all(np.diff(found[nearer, 2]) >= 0.0)
    a, b = points[:2]
    line = seen(np.linspace(a, b, 9), np.linspace(a, b, 9))[0]
    along = (line - line[0]) @ (line[-1] - line[0]) / np.sum((line[-1] - line[0]) ** 2)
    assert_allclose(line, line[0] + along[:, None] * (line[-1] - line[0]), atol=1e-9)


def test_views_have_the_root_at_the_left_but_the_tips():
    for name, view in VIEWS.items():
        right = np.cross(view.up, view.towards)
        assert (right[2] > 0) == (name != "tip")
        assert isinstance(view, View)


def test_cuts_lie_on_the_surface(blade):
    shown = mesh.from_blade(blade, stations=40)
    lines = cuts(shown)
    assert lines.shape[1:] == (2, 3)
    ends = mesh.TriangleMesh(lines.reshape(-1, 3), np.arange(6 * (len(lines) // 3)).reshape(-1, 3))
    assert np.abs(signed_distances(ends, shown)).max() < 1e-5
    assert len(np.unique(np.round(lines[..., 2], 6))) == 41


def test_polylines_keep_their_points():
    groups = (np.arange(24.0).reshape(2, 4, 3), np.arange(9.0).reshape(1, 3, 3))
    found = polylines(groups)
    assert found.n_cells == 3
    assert_allclose([cell.points for cell in found.cell][:2], groups[0])


def test_shading_splits_edges_and_keeps_values(blade):
    found = blade_scene.scene_of(blade, sections=40)
    shown = shaded(found.surface, found.fields)
    assert shown.n_points > len(found.surface.vertices)
    assert shown.n_cells == len(found.surface.faces)
    assert_allclose(np.linalg.norm(shown["Normals"], axis=1), 1.0, atol=1e-5)
    assert set(np.unique(shown["curvature"])) == set(np.unique(found.fields[0].values))
