import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.errors import PerturbationError
from bladegen.studio.checks.concavity import hollows
from bladegen.studio.choices.difference import left
from bladegen.studio.controls import MODES
from bladegen.studio.model import Baseline
from bladegen.studio.page.drawing.modes import mode
from bladegen.studio.state import State

SPACE = bg.ShapeSpace.bundled()
MOVED = State(
    "nrel5mw", (0.03, -0.02, 0.01, 0.005), None, thickness=1.05, camber=0.98, twist=1.5, prebend=0.5
)
STATES = [
    State("nrel5mw"),
    MOVED,
    replace(MOVED, window=(0.3, 0.6), chord=1.1),
    State("nrel5mw", prebend=1.6, at=0.25),
]


@pytest.fixture(scope="module")
def baseline():
    return Baseline("nrel5mw", bg.Blade.from_definition(bg.read("nrel5mw")), SPACE)


def status(scene):
    return {check.what: check.status for check in scene.checks}


@pytest.mark.parametrize("state", STATES)
def test_what_is_shown_is_the_blade_that_is_exported(baseline, state):
    scene, blade = baseline.scene(state), baseline.variant(state)
    assert_allclose(scene.sections, blade.sections(scene.eta), rtol=0, atol=1e-7)
    assert_allclose(scene.curves.chord, blade.chord(scene.eta), rtol=1e-9)
    assert_allclose(np.radians(scene.curves.twist), blade.twist(scene.eta), rtol=0, atol=1e-9)
    assert_allclose(scene.curves.prebend, blade.axis(scene.eta)[:, 0], rtol=0, atol=1e-9)
    thickness = blade.relative_thickness(scene.eta)
    assert_allclose(scene.curves.thickness, 100 * thickness, rtol=0, atol=1e-4)
    assert scene.valid


@pytest.mark.parametrize("at", [0.0, 0.37, 1.0])
def test_any_hundredth_of_the_span_can_be_looked_at(baseline, at):
    scene = baseline.scene(replace(MOVED, at=at))
    assert scene.eta[scene.place] == pytest.approx(at, abs=1e-12)
    blade = baseline.variant(MOVED)
    assert_allclose(scene.placed, blade.sections(at)[:, 1::-1], rtol=0, atol=1e-7)
    assert_allclose(baseline.at(at).sections, baseline.blade.sections(scene.eta), atol=1e-7)


def test_a_section_is_upright_and_of_unit_chord(baseline):
    scene = baseline.scene(replace(MOVED, at=0.6))
    edge = 0.5 * (scene.profile[0] + scene.profile[-1])
    assert_allclose(edge, [1.0, 0.0], rtol=0, atol=1e-3)
    middle = len(scene.profile) // 2
    assert scene.profile[middle // 2, 1] > 0 > scene.profile[middle + middle // 2, 1]
    lengths = (
        np.linalg.norm(np.diff(scene.profile, axis=0), axis=1) * scene.curves.chord[scene.place]
    )
    in_space = np.diff(scene.sections[scene.place], axis=0)
    assert_allclose(lengths, np.linalg.norm(in_space, axis=1), rtol=0, atol=1e-6)


def test_deviation_is_nothing_at_rest_and_outward_when_thicker(baseline):
    assert not baseline.scene(State("nrel5mw")).deviation.any()
    thick, thin = (baseline.scene(State("nrel5mw", thickness=s)).deviation for s in (1.1, 0.9))
    assert thick.max() > 0.05
    assert thick.min() > -0.1 * thick.max()
    assert_allclose(thin, -thick, rtol=0, atol=1e-4)  # but for edges opened to 2 mm


def test_a_bend_moves_the_suction_side_out_and_the_pressure_side_in():
    baseline = Baseline("iea15mw", bg.Blade.from_definition(bg.read("iea15mw")), SPACE)
    tip = baseline.scene(State("iea15mw", prebend=0.5)).deviation[-20]
    axis = baseline.blade.axis(np.array([baseline.eta[-20]]))[0, 0]
    quarter = len(tip) // 4
    assert tip[quarter] == pytest.approx(-0.5 * axis, rel=0.2)
    assert tip[-quarter] == pytest.approx(0.5 * axis, rel=0.2)


def test_checks_find_what_makes_a_variant_unusable(baseline):
    rng = np.random.default_rng(5)
    bad = State("nrel5mw")
    while status(baseline.scene(bad))["Valid"] == "good":
        bad = bad.drawn(SPACE, rng, 1.0)
    scene = baseline.scene(bad)
    assert not scene.valid
    assert "crosses itself" in scene.checks[0].figure
    with pytest.raises(PerturbationError, match="crosses itself"):
        baseline.variant(bad)


def test_far_shapes_are_odd_not_bad(baseline):
    scene = baseline.scene(State("nrel5mw", (0.242, 0.0, 0.06, 0.05)))
    assert status(scene)["Shape in data"] == "odd"
    near = baseline.scene(State("nrel5mw", (0.01, 0.0, 0.0, 0.0)))
    assert status(near)["Shape in data"] == "good"


def test_odd_sections_are_shown_and_can_be_had(baseline):
    state = State("nrel5mw", (-0.04, -0.1, 0.06, -0.01))
    scene = baseline.scene(state)
    found = {check.what: check for check in scene.checks}
    assert found["Airfoils"].status == "odd"
    assert "has a " in found["Airfoils"].figure
    assert scene.valid
    assert baseline.variant(state).findings[len(baseline.blade.findings) :]


@pytest.mark.parametrize(
    ("part", "change"),
    [
        ("rigid", {"twist": 3.0, "prebend": 1.6}),
        ("affine", {"twist": 3.0, "prebend": 1.6, "thickness": 1.1, "chord": 1.1, "camber": 1.04}),
    ],
)
def test_a_part_of_the_difference_that_is_not_asked_for_is_not_coloured(part, change):
    baseline = Baseline("dtu10mw", bg.Blade.from_definition(bg.read("dtu10mw")), SPACE)
    state = State("dtu10mw", off=part, **change)
    some = abs(baseline.scene(state).deviation)
    whole = abs(baseline.scene(replace(state, off="all")).deviation)
    far = whole.max(axis=1) > 0.01
    assert np.median(some[far].max(axis=1) / whole[far].max(axis=1)) < 0.01  # edges stay as wide
    shaped = replace(state, t=(0.05, 0.0, 0.0, 0.0))
    assert abs(baseline.scene(shaped).deviation).max() > 0.05


def test_motions_and_affine_maps_are_taken_out_exactly():
    rng = np.random.default_rng(2)
    flat = rng.normal(size=(3, 50, 2))
    frames = np.linalg.qr(rng.normal(size=(2, 3, 3, 3)))[0]
    frames *= np.sign(np.linalg.det(frames))[..., None, None]
    rest = flat @ frames[0][:, :2] + rng.normal(size=(3, 1, 3))
    moved = (rest - 1.0) @ frames[1] + 2.0
    assert_allclose(left(moved, rest, "rigid"), 0.0, atol=1e-12)
    mapped = (flat @ rng.normal(size=(3, 2, 2))) @ frames[1][:, :2]
    assert_allclose(left(mapped, rest, "affine"), 0.0, atol=1e-11)
    assert abs(left(mapped, rest, "rigid")).max() > 0.1
    assert_allclose(left(moved, rest, "all"), moved - rest, atol=0)


def test_what_comes_near_its_limit_is_said_before_it_is_odd(baseline):
    """Along a way that ends odd, a check is good, then near, then odd, and never goes back."""
    ranks = {"good": 0, "near": 1, "odd": 2, "bad": 3}
    for what, t in (
        ("Shape in data", (0.0, 0.0, 0.0, 0.0604)),
        ("Nose radius", (-0.05, -0.1, 0.08, -0.03)),
        ("Airfoils", (0.16, 0.0, 0.0, 0.0)),
    ):
        seen = [
            ranks[status(baseline.scene(State("nrel5mw", tuple(np.multiply(t, share)))))[what]]
            for share in np.linspace(0.0, 1.0, 21)
        ]
        assert seen == sorted(seen)
        assert {0, 1, 2} <= set(seen)


def test_concavity_is_what_an_outline_turns_back():
    around = np.linspace(0.0, 2.0 * np.pi, 401)
    circle = np.stack([np.cos(around), np.sin(around), 0.0 * around], axis=-1)
    dent = circle * np.where(np.abs(around - 4.2) < 0.4, 0.97, 1.0)[:, None]
    dent[:, 2] = 3.0
    (plain, _), (suction, pressure) = hollows(circle[None])[0], hollows(dent[None])[0]
    assert plain == suction == 0.0
    assert pressure > np.radians(20.0)
    mirrored = hollows(dent[None] * [1.0, -1.0, 1.0])[0]
    assert_allclose(mirrored, [suction, pressure], atol=1e-12)


def test_a_mode_is_shown_around_the_section_looked_at(baseline):
    state = replace(MOVED, at=0.6)
    profiles, step = baseline.peek(state, 1)
    assert step == pytest.approx(float(np.sqrt(SPACE.variances[1])))
    assert_allclose(profiles[1], baseline.scene(state).profile, rtol=0, atol=1e-12)
    moved = replace(state, t=(0.03, -0.02 + step, 0.01, 0.005))
    assert_allclose(profiles[2], baseline.scene(moved).profile, rtol=0, atol=1e-12)
    root = ET.fromstring(mode(profiles, "aft loading", step))
    assert [path.get("class") for path in root.iter("path")] == ["less", "before", "more"]


@pytest.mark.parametrize("name", ["nrel5mw", "iea15mw"])
@pytest.mark.parametrize("at", [0.6, 0.8])
def test_modes_do_what_they_are_called(name, at):
    """Modes are named for the bundled space; what the names say is measured on sections."""
    blade = Baseline(name, bg.Blade.from_definition(bg.read(name)), SPACE)
    x = np.linspace(0.005, 0.995, 199)

    def figures(profile):
        half = len(profile) // 2
        upper = np.interp(x, *profile[: half + 1][::-1].T)
        lower = np.interp(x, *profile[half:].T)
        thickness, camber = upper - lower, 0.5 * (upper + lower)
        nose = np.interp(0.01, x, thickness)
        return upper.max(), camber[x > 0.75].mean(), x[np.argmax(upper)], nose

    for k, (figure, sign) in enumerate([(0, 1), (1, 1), (2, -1), (3, -1)]):
        profiles, _ = blade.peek(State(name, at=at), k)
        less, _, more = (figures(profile)[figure] for profile in profiles)
        assert sign * (more - less) > 0.0, MODES[k]


def test_draws_are_sound(baseline):
    rng = np.random.default_rng(1)
    for _ in range(5):
        state = baseline.drawn(State("nrel5mw", at=0.2, window=(0.1, 0.3)), rng)
        assert all(check.status in ("good", "near") for check in baseline.scene(state).checks)
        assert (state.blade, state.at, state.window) == ("nrel5mw", 0.2, (0.1, 0.3))
        baseline.variant(state)


def test_a_packet_holds_the_surface_and_the_deviation(baseline):
    scene = baseline.scene(MOVED)
    packet = scene.packet()
    k, n, place = np.frombuffer(packet, "<u4", 3)
    points = np.frombuffer(packet, "<f4", 3 * k * n, 12).reshape(k, n, 3)
    off = np.frombuffer(packet, "<f4", k * n, 12 + 12 * k * n).reshape(k, n)
    assert len(packet) == 12 + 16 * k * n
    assert (n, place) == (101, scene.place)
    assert_allclose(points[:, [0, n // 2, -1]], scene.sections[:, [0, 200, -1]], rtol=1e-6)
    assert_allclose(off, scene.deviation[:, ::4], atol=1e-6)


def test_names_of_files(baseline):
    assert baseline.stem(State("nrel5mw")) == "nrel5mw"
    assert baseline.stem(MOVED) == baseline.variant(MOVED).name == "nrel5mw-variant"
