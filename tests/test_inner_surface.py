"""The inner surface of walls: how deep it lies, that it crosses nothing, and what is said of it."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_sectors import LENGTH, RADIUS, WALL, constant, tube

import bladegen as bg
from bladegen.blade.edges import Sharp
from bladegen.definition.structure.positions import Arc
from bladegen.surface import fitting
from bladegen.surface.inner import inner as made_by
from bladegen.surface.inner import wall as walls
from bladegen.surface.inner.inner import TOLERANCE, crossing_spans, inner_surface
from bladegen.surface.inner.room import FREE, MOST, SLOPES, kept_within, lowered, rooms
from bladegen.surface.inner.wall import Wall

U = np.linspace(0.0, 1.0, 301)
ETA = np.linspace(0.0, 1.0, 41)
NIGHTLY = pytest.mark.nightly


def ellipse(a, b, count=2001):
    """An ellipse (1, count, 3), its inward normals, and its parameters."""
    t = np.linspace(0.0, 2.0 * np.pi, count)
    points = np.stack([a * np.cos(t), b * np.sin(t), 0.0 * t], axis=-1)
    inward = -np.stack([b * np.cos(t), a * np.sin(t), 0.0 * t], axis=-1)
    return points[None], (inward / np.linalg.norm(inward, axis=-1, keepdims=True))[None], t


def test_the_room_of_an_ellipse_is_half_its_width_and_its_nose_s_radius():
    points, inward, t = ellipse(3.0, 1.0)
    room = rooms(points, inward)[0]
    assert_allclose(np.interp(0.5 * np.pi, t, room), 1.0, rtol=1e-6)
    assert_allclose(np.interp(np.pi, t, room), 1.0 / 3.0, rtol=1e-4)  # b^2 / a
    far = points[0] + room[:, None] * inward[0]  # centres lie on the middle line
    assert_allclose(far[:, 1], 0.0, atol=1e-3)


def test_the_base_of_a_trailing_edge_takes_room():
    x = np.linspace(0.0, 1.0, 201)
    points = np.stack([np.r_[2.0 * x, 2.0 - 2.0 * x], np.r_[0.0 * x, 0.0 * x + 1.0]], axis=-1)
    points = np.pad(points, ((0, 0), (0, 1)))[None]  # a box that is open at x = 0
    inward = np.pad(np.r_[0.0 * x + 1.0, 0.0 * x - 1.0][:, None], ((0, 0), (1, 1)))[None]
    room = rooms(points, inward)[0]
    assert room[100] == pytest.approx(0.5, rel=1e-6)
    assert room[5] < 0.1  # the base is seven points


def test_a_sharp_corner_leaves_no_room_and_a_wedge_in_proportion():
    x = np.linspace(0.0, 2.0, 401)[:, None]
    up, down = (np.concatenate([x, way * 0.25 * x, 0.0 * x], axis=1) for way in (1.0, -1.0))
    points = np.concatenate([up, down[::-1]])[None]  # from the corner, and back to it
    normal = np.array([0.25, -1.0, 0.0]) / np.hypot(1.0, 0.25)
    inward = np.repeat([normal, normal * (1.0, -1.0, 1.0)], 401, axis=0)[None]
    room = rooms(points, inward)[0]
    assert room[0] == room[-1] == 0.0
    half = np.arctan(0.25)
    along = x[100:250, 0] / np.cos(half)
    assert_allclose(room[100:250], along * np.tan(half), rtol=1e-3)


def test_a_room_is_lowered_until_it_changes_slowly():
    rng = np.random.default_rng(3)
    room = rng.uniform(0.1, 5.0, (40, 60))
    along = np.sort(rng.uniform(0.0, 10.0, (40, 60)), axis=1)
    span = np.linspace(0.0, 100.0, 40)
    low = lowered(room, along, span)
    assert np.all(low <= room + 1e-12)
    assert low.min() == pytest.approx(room.min())
    assert np.all(np.abs(np.diff(low, axis=0)) <= SLOPES[1] * np.diff(span)[:, None] + 1e-12)
    even = lowered(room, np.tile(along[:1], (40, 1)), span)
    assert np.all(np.abs(np.diff(even, axis=1)) <= SLOPES[0] * np.diff(along[:1]) + 1e-12)


def test_walls_keep_to_their_room():
    depth = np.linspace(0.0, 9.0, 901)
    kept = kept_within(depth, np.ones(901))
    free = depth <= FREE
    assert np.array_equal(kept[free], depth[free])
    assert np.all(np.diff(kept) >= 0.0)
    assert kept.max() <= MOST
    assert np.abs(np.diff(kept, 2)).max() < 2e-3  # no kink
    assert np.array_equal(kept_within(np.array([0.1, 0.0]), np.zeros(2)) < 1e-8, [True, True])


def net_of(blade, tolerance=1e-4):
    return fitting.fitted(blade, tolerance)[0]


def with_walls(blade, *layers):
    """The blade with layers of a thickness from one fraction of the arc to another."""
    made = tuple(
        bg.Layer(f"{i}", "steel", constant(thick), Arc(constant(start)), Arc(constant(end)))
        for i, (thick, start, end) in enumerate(layers)
    )
    structure = replace(blade.definition.structure, layers=made)
    return replace(blade, definition=replace(blade.definition, structure=structure))


def test_a_tube_has_its_inner_radius():
    blade = tube()
    outer = net_of(blade)
    made = inner_surface(outer, blade.layup)
    points = made.net.evaluate(U, ETA)
    assert_allclose(np.linalg.norm(points[..., :2], axis=-1), RADIUS - WALL, atol=2e-4)
    assert_allclose(points[..., 2], np.broadcast_to(ETA[:, None] * LENGTH, (41, 301)), atol=1e-9)
    wanted = np.pi * (2.0 * RADIUS - WALL) * WALL * LENGTH
    assert_allclose(made.volume, wanted, rtol=1e-3)
    assert made.deviation.maximum < 1e-4
    assert made.left_out == pytest.approx(0.0, abs=1e-6)
    assert made.findings == ()


def test_a_tube_of_two_layers_has_both_radii():
    blade = with_walls(tube(), (0.05, 0.0, 1.0), (0.03, 0.2, 0.45))
    points = inner_surface(net_of(blade), blade.layup).net.evaluate(U, ETA)
    radius = np.linalg.norm(points[..., :2], axis=-1)
    turned = np.unwrap(np.arctan2(points[0, :, 1], points[0, :, 0]))
    at = (turned - turned[0]) / (turned[-1] - turned[0])
    thick, thin = (at > 0.23) & (at < 0.42), (at < 0.17) | (at > 0.48)
    assert_allclose(radius[:, thick], RADIUS - 0.08, atol=TOLERANCE)
    assert_allclose(radius[:, thin], RADIUS - 0.05, atol=TOLERANCE)


def test_the_wall_of_a_cone_is_as_thick_along_its_normal():
    blade = tube()
    wide = bg.Distribution([0.0, 1.0], [4.0 * RADIUS, 4.0 * RADIUS - 0.4 * LENGTH * 0.2])
    blade = bg.Blade.from_definition(replace(blade.definition, chord=wide), landmarks=201)
    points = inner_surface(net_of(blade), blade.layup).net.evaluate(U, ETA)
    slope = 0.2 * 0.2  # of the radius over the span
    outer = 2.0 * RADIUS - slope * points[..., 2]
    deep = (outer - np.linalg.norm(points[..., :2], axis=-1)) / np.hypot(1.0, slope)
    assert_allclose(deep, WALL, atol=3e-4)
    assert WALL * (np.hypot(1.0, slope) - 1.0) < 3e-4  # and see the wall of a steep one
    steep = Wall(net_of(blade), blade.layup).at(ETA, U)
    assert_allclose(steep.cosine, 1.0 / np.hypot(1.0, slope), atol=1e-4)


def test_walls_that_fill_their_tube_leave_the_share_that_is_stated():
    blade = with_walls(tube(), (1.5 * RADIUS, 0.0, 1.0))
    made = inner_surface(net_of(blade), blade.layup)
    radius = np.linalg.norm(made.net.evaluate(U, ETA)[..., :2], axis=-1)
    assert_allclose(radius[:, 60:-60], (1.0 - MOST) * RADIUS, atol=5e-3)
    assert made.left_out > np.pi * RADIUS * LENGTH
    said = " ".join(map(str, made.findings))
    assert "limited behind" in said
    assert "limited around the nose" in said
    assert "walls of 2 x 1500 mm in 199" in said


def test_a_sharp_blade_has_one_too():
    plain = bg.read("iea15mw")
    blade = bg.Blade.from_definition(plain, landmarks=101, trailing_edge=Sharp())
    made = inner_surface(net_of(blade, 2e-3), blade.layup)
    assert made.net.v[0] == 0.0
    assert made.net.v[-1] > 0.95
    assert made.net.gaps.max() < 1e-5
    assert_allclose(made.volume, layers_of(blade), rtol=0.04)


@pytest.fixture(
    scope="module",
    params=["iea15mw", *(pytest.param(one, marks=NIGHTLY) for one in ("variant", "nrel5mw"))],
)
def real(request):
    name = request.param
    blade = bg.Blade.from_definition(
        bg.read("iea15mw" if name == "variant" else name), landmarks=101
    )
    if name == "variant":
        blade = blade.perturbed(thickness=0.9, chord_scale=1.05, prebend_scale=1.3)
    outer = net_of(blade, 2e-3)
    return blade, outer, inner_surface(outer, blade.layup)


def layers_of(blade):
    """Volume of the skin's layers by their masses [m3]."""
    structure, masses = blade.layup.structure, blade.layup.layer_masses
    return sum(
        masses[layer.name] / structure.by_name[layer.material].density
        for layer in structure.layers
        if not layer.web
    )


def test_a_blade_s_inner_surface_crosses_nothing(real):
    blade, outer, made = real
    elsewhere = np.linspace(0.0, 1.0, 173)
    assert not crossing_spans(Wall(outer, blade.layup), made.net, elsewhere).any()
    assert (made.net.v[0], made.net.v[-1]) == (0.0, 1.0)


def test_it_lies_where_layers_end(real):
    """At places that it was neither made from nor measured at."""
    (blade, outer, made), rng = real, np.random.default_rng(4)
    assert made.deviation.maximum <= TOLERANCE
    wall = Wall(outer, blade.layup)
    eta, u = np.sort(rng.uniform(size=60)), np.sort(rng.uniform(size=200))
    assert np.abs(made.net.offsets(wall.sections(eta, u), u, eta)).max() < 1.5 * TOLERANCE
    at = wall.at(eta, u)
    free = at.thickness < FREE * at.cosine * at.room
    assert free.mean() > 0.7
    assert_allclose(at.depth[free], at.thickness[free], rtol=1e-12)


def test_the_wall_holds_the_layers(real):
    """Inside of a curved skin it is smaller than widths times thickness: by thickness squared."""
    blade, outer, made = real
    eta, u = np.linspace(0.0, 1.0, 301), np.linspace(0.0, 1.0, 1201)
    at = Wall(outer, blade.layup).at(eta, u)
    turned = np.linalg.norm(np.diff(at.inward, axis=1), axis=-1)
    deep = 0.5 * (at.depth[:, 1:] + at.depth[:, :-1])
    within = np.trapezoid(0.5 * np.sum(deep**2 * turned, axis=1), eta) * blade.length
    assert_allclose(made.volume, layers_of(blade) - made.left_out - within, rtol=0.006)
    assert_allclose(made.volume, layers_of(blade), rtol=0.025)


def test_where_walls_do_not_fit_is_said(real):
    said = [str(finding) for finding in real[2].findings]
    assert said[0].startswith("inner surface: limited behind ")
    assert "% span, to 90 % of the room: walls of 2 x " in said[0]
    assert all("limited" in one for one in said)


def test_a_surface_that_crosses_itself_ends_before(real, monkeypatch):
    blade, outer, _ = real
    monkeypatch.setattr(walls, "kept_within", lambda depth, room: depth)
    made = inner_surface(outer, blade.layup, tolerance=0.02)
    crosses = [str(one) for one in made.findings if "crosses itself" in str(one)]
    assert len(crosses) == 1
    first, last = made.net.v[0], made.net.v[-1]
    assert f"it goes from eta = {first:.3f} to {last:.3f}" in crosses[0]
    assert last - first < 0.9
    wall = Wall(outer, blade.layup)
    spans = np.linspace(0.0, 1.0, made_by.WATCHED[0])
    kept = spans[(spans >= first) & (spans <= last)]
    assert not crossing_spans(wall, made.net, kept).any()


def test_without_any_sound_section_there_is_none(monkeypatch):
    blade = tube()
    monkeypatch.setattr(made_by, "crossing_spans", lambda wall, net, eta: np.ones(len(eta), bool))
    made = inner_surface(net_of(blade, 1e-3), blade.layup)
    assert made.net is None
    assert "it is left out" in str(made.findings[-1])


@pytest.mark.nightly
def test_a_mirror_image_has_the_mirrored_one(real):
    blade, _, made = real
    other = blade.mirror_image()
    mirrored = inner_surface(net_of(other, 2e-3), other.layup)
    assert_allclose(mirrored.volume, made.volume, rtol=1e-6)
    there = mirrored.net.evaluate(1.0 - U[::-1], ETA)[:, ::-1] * (1.0, -1.0, 1.0)
    assert_allclose(there, made.net.evaluate(U, ETA), atol=2e-4)
