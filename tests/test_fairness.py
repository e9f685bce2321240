"""Curvatures are those of surfaces that are known, and stripes those of exact normals."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import bladegen as bg
from bladegen.blade.blade import Blade
from bladegen.blade.edges import AsGiven
from bladegen.blade.planform import normal_to_axis
from bladegen.cad import exchange, solids
from bladegen.cli import commands
from bladegen.definition.blade_definition import Airfoil, BladeDefinition, ReferenceAxis, Station
from bladegen.definition.distribution import Distribution, cubic_spline
from bladegen.errors import BladegenError, RenderError
from bladegen.measures import checks, fairness
from bladegen.surface import mesh
from bladegen.views import zebra
from strategies import by_day, circle

ETA = np.linspace(0.02, 0.98, 25)
U = fairness.LINES
LENGTH = 40.0
flat = Distribution.constant


def pipe(chord=None, axis=None):
    """A round pipe about its axis, of this diameter over span."""
    stations = tuple(Station(eta, Airfoil("circle", circle(401))) for eta in (0.0, 1.0))
    straight = ReferenceAxis(flat(0.0), flat(0.0), Distribution([0.0, 1.0], [0.0, LENGTH]))
    definition = BladeDefinition(
        "pipe",
        stations,
        flat(2.0) if chord is None else chord,
        flat(0.0),
        axis or straight,
        pitch_axis=flat(0.5),
    )
    return Blade.from_definition(
        definition, planes=normal_to_axis, trailing_edge=AsGiven(), landmarks=201
    )


def outward(blade, eta, u):
    """Unit vectors from the axis to points of a pipe."""
    arms = blade.sections(eta, u) - blade.axis(eta)[:, None]
    return arms / np.linalg.norm(arms, axis=-1, keepdims=True)


def test_a_straight_pipe_is_straight_along_and_round_around():
    made = pipe()
    assert_allclose(fairness.spanwise(made, ETA, U), 0.0, atol=1e-7)
    assert_allclose(fairness.chordwise(made, ETA)[:, 5:-5], -2.0, atol=2e-3)
    assert_allclose(fairness.normals(made, ETA, U), outward(made, ETA, U), atol=1e-4)
    found = fairness.fairness(made)
    assert found.jump[0] < 1e-6
    assert found.spanwise < 1e-4


def test_a_bent_pipe_has_the_curvature_of_its_torus():
    """Normal curvature along the long way round a torus: cos t / (R + r cos t), hollow positive."""
    angle, radius = 0.8, LENGTH / 0.8
    eta = np.linspace(0.0, 1.0, 401)
    arc = ReferenceAxis(
        Distribution(eta, radius * (1.0 - np.cos(angle * eta)), cubic_spline),
        flat(0.0),
        Distribution(eta, radius * np.sin(angle * eta), cubic_spline),
    )
    made = pipe(axis=arc)
    # x points to the arc's centre: seen from outside the side there is hollow
    toward = np.stack([np.cos(angle * ETA), 0 * ETA, -np.sin(angle * ETA)], axis=-1)
    t = np.sum(outward(made, ETA, U) * toward[:, None], axis=-1)
    wanted = t / (radius - t)
    assert_allclose(fairness.spanwise(made, ETA, U), wanted, atol=2e-4)
    assert_allclose(fairness.normals(made, ETA, U), outward(made, ETA, U), atol=1e-4)


def test_the_mirror_image_has_mirrored_normals():
    made = bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)
    own, mirrored = (fairness.normals(one, ETA, U) for one in (made, made.mirror_image()))
    assert_allclose(mirrored[:, ::-1], own * (1.0, -1.0, 1.0), atol=1e-6)  # u runs back
    curved = [fairness.spanwise(one, ETA, U) for one in (made, made.mirror_image())]
    assert_allclose(curved[1][:, ::-1], curved[0], atol=1e-6)


def test_a_jump_of_curvature_is_found_where_it_is_and_as_large():
    """Radius r(z): no bend before the middle, one of r'' = 2 a / L^2 behind it."""
    bend = 0.8

    def half_bent(_grid, _values):
        def spline(eta, nu=0):
            past = np.maximum(np.asarray(eta) - 0.5, 0.0)
            return (2.0 + bend * past**2, 2.0 * bend * past, 2.0 * bend * (past > 0.0))[nu]

        return spline

    made = pipe(Distribution([0.0, 0.5, 1.0], [2.0, 2.0, 2.0 + bend / 4.0], half_bent))
    jump, eta = fairness.fairness(made).jump
    assert_allclose(eta, 0.5)
    assert_allclose(jump, bend / LENGTH**2, rtol=2e-2)


@pytest.mark.parametrize("name", by_day("iea15mw"))
def test_a_fair_planform_takes_the_jumps_of_curvature_away(name):
    given, fair = (
        fairness.fairness(
            bg.Blade.from_definition(bg.read(name), landmarks=101, path="spline", fair_planform=how)
        )
        for how in (None, bg.PlanformFairing())
    )
    assert fair.jump[0] < 0.1 * given.jump[0]
    assert fair.spanwise < 0.8 * given.spanwise
    assert_allclose(fair.chordwise, given.chordwise, rtol=0.02)


def test_check_says_how_fair_a_blade_is():
    made = bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101)
    figures = checks.check_blade(made).figures
    creases = dict(figures["creases_deg"])
    assert len(creases) == len(made.eta) - 2
    assert_allclose(max(creases.values()), figures["crease_deg"], atol=1e-4)
    # the chord falls from 1.47 m to 0.5 m over the last half per cent of the span
    assert_allclose(figures["curvature_jump_at_eta"], 0.995)
    assert 0.5 < figures["curvature_jump_per_m"] < 1.5


@pytest.fixture
def coarse(monkeypatch):
    monkeypatch.setattr(zebra, "SPANS", 201)
    monkeypatch.setattr(zebra, "AROUND", 41)
    monkeypatch.setattr(zebra, "SIZE", (600, 600))


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101, path="spline")


@pytest.mark.usefixtures("coarse", "foreign_here")
def test_stripes_of_a_step_file_are_those_of_its_blade(blade, tmp_path):
    from scipy.spatial import KDTree

    exchange.write_step(solids.solid(blade, tolerance=3e-4), tmp_path / "one.step")
    (own,) = zebra.sheets_of(blade)
    assert_allclose(np.linalg.norm(own.normals, axis=-1), 1.0)
    faces = zebra.sheets_of(tmp_path / "one.step")
    sides = [sheet for sheet in faces if np.ptp(sheet.points[..., 2]) > 0.9 * blade.length]
    points, normals = (
        np.concatenate([getattr(sheet, name).reshape(-1, 3) for sheet in sides[:2]])
        for name in ("points", "normals")
    )
    distance, nearest = KDTree(points).query(own.points.reshape(-1, 3)[::37])
    near = distance < 0.02
    assert near.sum() > 50
    cosine = np.sum(normals[nearest[near]] * own.normals.reshape(-1, 3)[::37][near], axis=-1)
    assert np.median(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))) < 0.5
    assert np.mean(cosine > 0.99) > 0.9


@pytest.mark.usefixtures("coarse")
def test_check_draws_zebra_stripes(tmp_path):
    from PIL import Image

    picture = tmp_path / "stripes.png"
    result = CliRunner().invoke(commands.app, ["check", "nrel5mw", "--zebra", str(picture)])
    assert result.exit_code == 0
    assert f"wrote {picture}" in result.output.replace("\n", "")
    pixels = np.asarray(Image.open(picture).convert("L"), dtype=float)
    assert pixels.shape == (600, 600)
    assert 0.03 < (pixels < 80).mean() < 0.5
    assert bg.__version__ in Image.open(picture).text["bladegen"]


def test_what_has_no_normals_has_no_stripes(blade, tmp_path, monkeypatch):
    monkeypatch.setattr(
        zebra, "surface_of", lambda _: type("Side", (), {"surface": _surface(blade)})
    )
    with pytest.raises(RenderError, match="holds triangles"):
        zebra.sheets_of(tmp_path / "one.stl")
    answer = CliRunner().invoke(
        commands.app, ["check", "nrel5mw", "dtu10mw", "--zebra", str(tmp_path / "x.png")]
    )
    assert isinstance(answer.exception, BladegenError)
    assert "stripes are drawn on one file" in str(answer.exception)


def test_check_makes_a_definition_as_it_is_told_and_takes_files_as_they_are(tmp_path):
    def checked(*words):
        return CliRunner().invoke(commands.app, ["check", *words])

    jumps = [
        json.loads(checked("dtu10mw", "--json", "--path", "spline", *how).output)
        for how in ((), ("--fair-planform", "0.1%"))
    ]
    assert all(one["crease_deg"] < 0.02 for one in jumps)
    assert jumps[1]["curvature_jump_per_m"] < 0.2 * jumps[0]["curvature_jump_per_m"]
    (tmp_path / "one.stl").write_text("solid\nendsolid\n")
    for words, said in (
        ((str(tmp_path / "one.stl"), "--path", "geodesic"), "is no definition"),
        (("dtu10mw", "nrel5mw", "--path", "geodesic"), "made as the other one was"),
    ):
        assert said in str(checked(*words).exception)


def _surface(blade):
    from bladegen.measures import surfaces

    return surfaces.of_mesh(mesh.from_blade(blade, stations=20))


def test_breaks_are_all_points_of_distributions_and_stations(blade):
    definition = blade.definition
    breaks = np.array([eta for eta, _ in fairness.fairness(blade).jumps])
    for grid in (definition.chord.grid[1:-1], definition.axis.x.grid[1:-1], blade.eta[1:-1]):
        assert np.abs(breaks[:, None] - grid).min(axis=0).max() <= fairness.APART
    assert not np.any((breaks <= 0.0) | (breaks >= 1.0))
