from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.blade.blade import Blade
from bladegen.blade.planform import (
    Planform,
    flange_to_axis,
    normal_to_axis,
    normal_to_z,
    placement,
    root_end,
)
from bladegen.definition.blade_definition import (
    Airfoil,
    BladeDefinition,
    Distribution,
    ReferenceAxis,
    Station,
)
from bladegen.formats.bundled import bundled
from bladegen.formats.reading import read
from strategies import circle, definitions

ETA = np.linspace(0.0, 1.0, 33)


def line(*values: float) -> Distribution:
    return Distribution(np.linspace(0, 1, len(values)), np.array(values))


@given(definitions())
def test_frames_are_rotations_normal_to_the_axis(definition):
    frames = normal_to_axis(definition.axis)(ETA)
    assert_allclose(frames @ frames.mT, np.broadcast_to(np.eye(3), (33, 3, 3)), atol=1e-12)
    assert_allclose(np.linalg.det(frames), 1.0, atol=1e-12)
    tangent = definition.axis(ETA, 1)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    assert_allclose(frames[:, 2], tangent, atol=1e-12)


@given(definitions())
def test_frames_do_not_roll(definition):
    eta = np.linspace(0.0, 1.0, 4001)
    frames = normal_to_axis(definition.axis)(eta)
    step = np.diff(frames, axis=0)
    roll = np.sum(step[:, 0] * frames[:-1, 1], axis=1)  # turn of x toward y a step
    turning = np.linalg.norm(step[:, 2], axis=1)
    assert np.abs(roll.sum()) < 1e-3 * max(turning.sum(), 1e-6)


def test_frames_of_a_bent_axis_turn_about_y_only():
    axis = ReferenceAxis(line(0.0, -1.0, -4.0), line(0.0, 0.0), line(0.0, 50.0, 100.0))
    frames = normal_to_axis(axis)(ETA)
    assert_allclose(frames[:, 1], np.broadcast_to([0.0, 1.0, 0.0], (33, 3)), atol=1e-12)


@pytest.mark.parametrize("root", [0.0, 0.02])
@pytest.mark.parametrize("way", ["prebend", "sweep"])
def test_frames_of_an_axis_in_a_plane_are_those_carried_along_it(root, way):
    """All but no sweep, or prebend, carries them step by step."""
    bent, hair = line(0.0, -1.0, 2.0, -4.0), line(0.0, 1e-9, 0.0, 0.0)
    z, still = line(0.0, 30.0, 60.0, 100.0), line(0.0, 0.0)
    both = [ReferenceAxis(bent, y, z) for y in (still, hair)]
    if way == "sweep":
        both = [ReferenceAxis(axis.y, axis.x, axis.z) for axis in both]
    at_once, carried = (flange_to_axis(axis, root)(ETA) for axis in both)
    assert_allclose(at_once, carried, atol=1e-9)
    assert np.max(np.abs(at_once - np.eye(3))) > 0.05


@given(definitions(), st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=4))
def test_frames_under_factors_of_the_prebend_are_those_of_each_axis(definition, factors):
    axis, scale = definition.axis, np.array(factors)
    for planes in (flange_to_axis, normal_to_axis, normal_to_z):
        frames = Planform(definition, planes).frames
        bent = frames.bent(scale, ETA)
        swept = np.ptp(axis.y.values) > 0.0 < np.ptp(axis.x.values)
        assert (bent is None) == (swept and planes is not normal_to_z)
        if bent is None:
            continue
        bends = [replace(axis.x, values=factor * axis.x.values) for factor in scale]
        axes = [ReferenceAxis(x, axis.y, axis.z) for x in bends]
        own = np.stack([replace(frames, axis=one)(ETA) for one in axes])
        assert_allclose(np.broadcast_to(bent, own.shape), own, atol=1e-12)


@pytest.mark.parametrize("values", [(0.0, 1.0, 100.0), (0.0, 99.0, 100.0)])
def test_an_axis_whose_spline_starts_or_ends_at_rest_has_frames(values):
    axis = ReferenceAxis(line(0.0, 0.0), line(0.0, 0.0), line(*values))
    assert not axis(ETA[[0, -1]], 1).any(axis=1).all()
    assert_allclose(normal_to_axis(axis)(ETA), np.broadcast_to(np.eye(3), (33, 3, 3)), atol=1e-12)


def test_a_root_whose_axis_rises_from_rest_and_leans_is_a_flange():
    axis = ReferenceAxis(line(0.0, 1.0, 3.0), line(0.0, 0.0), line(0.0, 1.0, 100.0))
    assert axis(0.0, 1)[2] == 0.0 != axis(0.0, 1)[0]
    assert_allclose(flange_to_axis(axis, 0.02)(np.zeros(1))[0], np.eye(3), atol=1e-15)


def test_frames_normal_to_z_stay():
    axis = ReferenceAxis(line(0.0, -4.0), line(0.0, 1.0), line(0.0, 100.0))
    assert_allclose(normal_to_z(axis)(ETA), np.broadcast_to(np.eye(3), (33, 3, 3)))


ROOTS = st.floats(1e-4, 0.05)


@given(definitions(), ROOTS)
def test_the_root_is_normal_to_z_and_sections_past_it_to_the_axis(definition, root):
    frames = flange_to_axis(definition.axis, root)
    assert_allclose(frames(np.zeros(1))[0], np.eye(3), atol=1e-15)
    past = np.union1d(ETA[root <= ETA], root)
    normals = normal_to_axis(definition.axis)(past)[:, 2]
    assert_allclose(frames(past)[:, 2], normals, atol=1e-12)


@given(definitions(), ROOTS)
def test_planes_turn_monotonely_and_nowhere_jump(definition, root):
    """Slopes against z are shares of the axis' own, which rise from none to all."""
    eta = np.linspace(0.0, root, 33)
    normals = flange_to_axis(definition.axis, root)(eta)[:, 2]
    own = definition.axis(eta, 1)
    sizes = np.hypot(own[:, 0], own[:, 1]) / own[:, 2]
    tilts = np.hypot(normals[:, 0], normals[:, 1]) / normals[:, 2]
    shares = tilts[sizes > 1e-6] / sizes[sizes > 1e-6]
    assert np.all(np.diff(shares) >= -1e-7)
    assert np.all((shares >= 0.0) & (shares <= 1.0 + 1e-7))


def test_the_turn_has_no_corner_at_either_end():
    """On a straight leaning axis the tilt is the weight itself, flat and straight at both ends."""
    root, slope, step = 0.04, 0.1, 1e-4
    axis = ReferenceAxis(line(0.0, slope * 50.0), line(0.0, 0.0), line(0.0, 50.0))
    for end, inward in ((0.0, 1.0), (root, -1.0)):
        eta = end + inward * step * np.arange(3)
        normals = flange_to_axis(axis, root)(eta)[:, 2]
        share = normals[:, 0] / normals[:, 2] / slope
        first, second = share[1] - share[0], share[2] - 2.0 * share[1] + share[0]
        cubic = (step / root) ** 3
        assert abs(first) <= 10.0 * cubic
        assert abs(second) <= 60.0 * cubic


@pytest.mark.parametrize("path", ["straight", "leaning"])
def test_a_straight_cylinder_is_a_cylinder(path):
    """To the part of it that an ellipse in its plane is from a circle: r (1 - cos) of the slope."""
    lean = 0.0 if path == "straight" else 0.01
    axis = ReferenceAxis(line(0.0, lean * 50.0), line(0.0, 0.0), line(0.0, 50.0))
    u = np.linspace(0.0, 2.0 * np.pi, 33)
    round_ = np.stack([0.5 + 0.5 * np.cos(u), 0.5 * np.sin(u)], axis=-1)
    eta = np.linspace(0.0, 1.0, 101)
    pipe = blade(axis=axis, pitch_axis=line(0.5, 0.5))
    points = Planform(pipe).place(np.broadcast_to(round_, (101, 33, 2)), eta)
    along = np.array([lean, 0.0, 1.0]) / np.hypot(lean, 1.0)
    distance = np.linalg.norm(points - (points @ along)[..., None] * along, axis=-1)
    assert_allclose(distance, 1.0, atol=1e-12 + lean**2 / 2.0)
    assert_allclose(points[0, :, 2], 0.0, atol=1e-15)


@pytest.mark.parametrize("name", bundled())
def test_the_root_face_is_a_flange(name):
    made = Blade.from_definition(read(name), landmarks=101)
    (root,) = made.sections([0.0])
    assert_allclose(root[:, 2], 0.0, atol=1e-14)
    assert made.sections(np.linspace(0.0, 0.05, 101))[..., 2].min() >= -1e-14
    past = np.linspace(root_end(made.definition), 1.0, 50)
    assert_allclose(
        made.planform.frames(past)[:, 2], normal_to_axis(made.definition.axis)(past)[:, 2]
    )


def test_planes_turn_over_the_same_span_however_many_stations_there_are():
    """Files of nodes have many airfoils, round ones and others, where a definition has two."""
    definition = read("iea15mw")
    first, second, *others = definition.stations
    middle = Station(0.01, first.airfoil)
    nearly = Station(0.03, Airfoil("oval", first.airfoil.coordinates * [1.0, 0.99]))
    for stations in ((first, *others), (first, middle, second, nearly, *others)):
        assert root_end(replace(definition, stations=stations)) == root_end(definition) == 0.02
    assert root_end(replace(definition, stations=tuple(others))) == 0.0


def blade(**changes) -> BladeDefinition:
    round_ = Airfoil("circle", circle())
    fields = {
        "name": "test",
        "stations": (Station(0.0, round_), Station(1.0, round_)),
        "chord": line(2.0, 2.0),
        "twist": line(0.3, 0.3),
        "axis": ReferenceAxis(line(0.1, 0.1), line(0.2, 0.2), line(0.0, 50.0)),
        "pitch_axis": line(0.4, 0.4),
    }
    return BladeDefinition(**{**fields, **changes})


def test_the_published_placement_formula():
    """X = Xa + c (y cos t + (x - p) sin t), Y = Ya + c ((x - p) cos t - y sin t)."""
    points = np.array([[[0.0, 0.0], [1.0, 0.0], [0.3, 0.1]]])
    placed = Planform(blade()).place(points, np.array([0.5]))[0]
    c, t, p = 2.0, 0.3, 0.4
    for (x, y), (X, Y, Z) in zip(points[0], placed, strict=True):
        assert_allclose(X, 0.1 + c * (y * np.cos(t) + (x - p) * np.sin(t)))
        assert_allclose(Y, 0.2 + c * ((x - p) * np.cos(t) - y * np.sin(t)))
        assert_allclose(Z, 25.0)


def test_positive_twist_moves_the_leading_edge_upwind():
    nose, tail = Planform(blade()).place(np.array([[[0.0, 0.0], [1.0, 0.0]]]), np.array([0.5]))[0]
    assert nose[0] < tail[0]


def test_suction_is_x_and_trailing_edge_is_y():
    shape = np.array([[[0.5, 0.1], [1.0, 0.0], [0.0, 0.0]]])
    upper, tail, nose = Planform(blade(twist=line(0.0, 0.0))).place(shape, np.array([0.0]))[0]
    assert upper[0] > nose[0]
    assert tail[1] > nose[1]


def test_offsets_in_metres_are_those_of_fractions():
    points = np.array([[[0.0, 0.0], [1.0, 0.0]]])
    by_fraction = Planform(blade()).place(points, np.array([0.5]))
    in_metres = blade(pitch_axis=None, section_offset_y=line(0.8, 0.8))
    assert_allclose(Planform(in_metres).place(points, np.array([0.5])), by_fraction, atol=1e-14)


def test_section_offset_x_shifts_to_the_suction_side():
    points = np.array([[[0.0, 0.0], [1.0, 0.0]]])
    straight = blade(twist=line(0.0, 0.0))
    lifted = blade(twist=line(0.0, 0.0), section_offset_x=line(0.05, 0.05))
    shift = Planform(lifted).place(points, np.array([0.5])) - Planform(straight).place(
        points, np.array([0.5])
    )
    assert_allclose(shift, np.broadcast_to([0.05, 0.0, 0.0], (1, 2, 3)), atol=1e-14)


def test_an_axis_that_does_not_reach_the_ends_keeps_its_direction():
    short = Distribution(np.array([0.1, 0.9]), np.array([0.0, 50.0]))
    axis = ReferenceAxis(line(0.0, 0.0), line(0.0, 0.0), short)
    assert_allclose(normal_to_axis(axis)(ETA), np.broadcast_to(np.eye(3), (33, 3, 3)), atol=1e-12)


def placed_by_pgl(local, axis, twist):
    """Rotate sections (k, n, 2) by PGL's own routine; its x is ours of -y, its y ours of x."""
    lofted = pytest.importorskip("PGLW.main.loftedblade").LoftedBladeSurface
    surface = object.__new__(lofted)
    surface.x, surface.y, surface.z = -axis[:, 1], axis[:, 0], axis[:, 2]
    surface.rot_z = -np.degrees(twist)
    surface.ni_span, surface.ni_chord = local.shape[:2]
    surface.analytic_grad, surface.rot_order = True, np.array([2, 1, 0])
    surface.rotorder_sweep, surface.shear_sweep = True, False
    surface.flag_twist_corr = "PGL"
    flat = np.zeros((surface.ni_chord, surface.ni_span, 3))
    flat[..., 0], flat[..., 1] = -local[..., 1].T, local[..., 0].T
    turned = surface._rotate(flat)
    return np.stack([turned[..., 1], -turned[..., 0], turned[..., 2]], axis=-1).swapaxes(0, 1)


@pytest.mark.parametrize(
    ("prebend", "sweep", "allowed_deg"),
    [(-4.0, 0.0, 1e-5), (0.0, 6.0, 1e-4), (-6.0, 4.0, 0.004), (-8.0, 8.0, 0.03)],
)
def test_agrees_with_pglw(prebend, sweep, allowed_deg):
    """PGL too places sections normal to the axis, and corrects the twist for the tilt.

    With prebend or sweep alone both are the same.  With both, PGL holds the chord to the
    direction of rotation, we let it follow the axis without roll: 0.003 degrees apart at the
    tip for slopes of -0.12 and 0.12, 0.02 for -0.16 and 0.24.
    """
    eta = np.linspace(0, 1, 201)
    curve = [
        Distribution(eta, values) for values in (prebend * eta**2, sweep * eta**3, 100.0 * eta)
    ]
    bent = blade(axis=ReferenceAxis(*curve), pitch_axis=line(0.0, 0.0))
    points = np.broadcast_to([[0.0, 0.0], [1.0, 0.0], [0.3, 0.1]], (201, 3, 2))
    ours = Planform(bent, normal_to_axis).place(points, eta)
    theirs = placed_by_pgl(2.0 * points[..., ::-1], bent.axis(eta), bent.twist(eta))
    chords = [p[:, 1] - p[:, 0] for p in (ours, theirs)]
    angle = np.linalg.norm(np.cross(*chords), axis=1) / 4.0
    assert np.degrees(angle.max()) < allowed_deg
    assert np.abs(ours - theirs).max() < 2.1 * np.radians(allowed_deg)


def test_placing_a_batch_of_any_shape_equals_placing_its_parts():
    rng = np.random.default_rng(5)
    shape = (2, 3)
    chord, twist = rng.uniform(1.0, 2.0, shape), rng.uniform(-1.0, 1.0, shape)
    offset, axis = rng.normal(size=(*shape, 2)), rng.normal(size=(*shape, 3))
    frames = np.linalg.qr(rng.normal(size=(*shape, 3, 3))).Q
    axes, start = placement(chord, twist, offset, axis, frames)
    assert axes.shape == (*shape, 2, 3)
    assert start.shape == (*shape, 3)
    for at in np.ndindex(shape):
        parts = placement(chord[at], twist[at], offset[at], axis[at], frames[at])
        assert_allclose(axes[at], parts[0], atol=1e-15)
        assert_allclose(start[at], parts[1], atol=1e-15)
