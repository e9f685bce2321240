"""Deviations from a blade: patterns, what is measured of them, and their parts."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands
from bladegen.errors import BladegenError, PerturbationError
from bladegen.fitting.deviations import DeviationMap
from bladegen.fitting.wear.worn import CLOSE
from bladegen.measures import surfaces
from bladegen.surface.mesh import from_blade
from bladegen.views.deviations import write

RUN = CliRunner()


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101, fairing=None)


@pytest.fixture(scope="module")
def eroded(blade):
    return DeviationMap.erosion(blade, start=0.6, width=0.06, depth=0.005)


def test_no_deviation_leaves_every_landmark_where_it_is(blade):
    eta = np.linspace(0.0, 1.0, 60)
    same = DeviationMap(eta, blade.u, np.zeros((60, 101))).applied(blade)
    fine = np.linspace(0.0, 1.0, 611)
    assert_allclose(same.sections(fine), blade.sections(fine), atol=2 * CLOSE)


@pytest.mark.parametrize("name", ["iea15mw", "dtu10mw", "nrel5mw"])
def test_a_dent_leaves_all_the_rest_where_it_is(name):
    """Tips narrow within a metre: between the spans of a map they must be the blade's, too."""
    own = bg.Blade.from_definition(bg.read(name), landmarks=101)
    dent = DeviationMap.dent(own, eta=0.5, u=0.25, size=0.8, depth=0.01)
    hit = own.perturbed(deviation=dent)
    eta = np.linspace(0.0, 1.0, 733)
    off = np.linalg.norm(hit.sections(eta) - own.sections(eta), axis=-1).max(axis=-1)
    near = np.abs(eta - 0.5) < 0.5 / own.length
    assert off[near].max() == pytest.approx(0.01, rel=0.1)
    assert off[~near].max() < 2 * CLOSE
    assert hit.changes[-1]["deviation"]["inward_mm"] == pytest.approx(10.0, rel=0.1)


def test_a_skin_of_many_features_is_meshed_and_measured_as_it_comes():
    """It has more stations than the sections that meshes have by default."""
    own = bg.Blade.from_definition(bg.read("iea15mw"), landmarks=201)
    maps = DeviationMap.waves(own, start=0.3, end=0.9, length=1.2, height=0.002)
    for eta in (0.35, 0.5, 0.6, 0.7, 0.8):
        maps += DeviationMap.dent(own, eta=eta, u=0.25, size=0.8, depth=0.004)
    hit = own.perturbed(deviation=maps)
    assert len(hit.eta) > 300
    assert hit.mesh().is_watertight
    assert surfaces.of_blade(hit).patches


def test_landmarks_move_by_what_the_map_says_and_inward(blade, eroded):
    moved = eroded.applied(blade).sections(eroded.eta) - blade.sections(eroded.eta)
    # edges of 2 mm are finished after the move, within 20 % of the chord from the trailing edge
    front = slice(30, 71)
    far = np.linalg.norm(moved, axis=-1)[:, front]
    worn = eroded.eta > 0.6
    assert_allclose(far[worn], -eroded.values[worn][:, front], atol=2e-6)
    assert far.max() == pytest.approx(0.005, rel=1e-3)
    assert far[~worn].max() < 2 * CLOSE


@pytest.mark.parametrize(("size", "depth", "of"), [(600, 0.01, "size"), (0.6, 10, "depth")])
def test_millimetres_given_for_metres_are_refused(blade, size, depth, of):
    with pytest.raises(BladegenError, match=rf"dent: {of}: got .* lengths are metres"):
        DeviationMap.dent(blade, eta=0.5, u=0.2, size=size, depth=depth)


def test_a_dent_is_as_deep_and_as_wide_as_it_is_said_to_be(blade):
    dent = DeviationMap.dent(blade, eta=0.5, u=0.2, size=0.8, depth=0.01)
    assert -dent.values.min() == pytest.approx(0.01, rel=0.1)
    assert dent.values.max() == 0.0
    points = blade.sections(dent.eta)
    middle = blade.sections(np.array([0.5]), np.array([0.2]))[0, 0]
    away = np.linalg.norm(points - middle, axis=-1)
    assert np.all(dent.values[away > 0.4] == 0.0)


def test_what_is_put_on_is_measured_again(blade, eroded):
    """From triangles of the eroded blade, which know nothing of the map."""
    mesh = from_blade(eroded.applied(blade), stations=160)
    found = DeviationMap.measured(blade, surfaces.of_mesh(mesh), spans=41)
    nose = found.values[:, 50]
    wanted = np.interp(found.eta, eroded.eta, eroded.values[:, 50])
    assert_allclose(nose[1:-1], wanted[1:-1], atol=1.5e-3)
    assert np.abs(found.values[found.eta < 0.55][1:]).max() < 2e-3


def test_parts_are_all_of_it_and_maps_of_sections_are_affine(blade):
    eta = np.linspace(0.3, 1.0, 12)
    profiles = blade.profiles(eta)
    along = np.gradient(profiles, axis=1)
    normal = along[..., ::-1] * [1.0, -1.0]
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    thicker = DeviationMap(eta, blade.u, 0.02 * profiles[..., 1] * normal[..., 1])
    parts = thicker.parts(blade)
    assert_allclose(parts["affine"], thicker.values, atol=1e-12)
    rng = np.random.default_rng(2)
    noise = DeviationMap(eta, blade.u, rng.normal(size=(12, 101)))
    parts = noise.parts(blade)
    assert_allclose(sum(parts.values()), noise.values, atol=1e-12)
    squares = [np.sum(part**2) for part in parts.values()]
    assert squares[2] < np.sum(noise.values**2)


def test_maps_are_looked_at(blade):
    with pytest.raises(BladegenError, match=r"numbers of shape \(2, 3\)"):
        DeviationMap(np.array([0.0, 1.0]), np.array([0.0, 0.5, 1.0]), np.zeros((3, 2)))
    with pytest.raises(BladegenError, match="must rise within 0 to 1"):
        DeviationMap.erosion(blade, start=0.9, end=0.5, width=0.1, depth=0.001)
    far = surfaces.of_mesh(from_blade(blade, stations=12))
    with pytest.raises(BladegenError, match="are frames and units the same"):
        DeviationMap.measured(blade, far.scaled(0.5), spans=5)


def test_check_writes_maps_of_a_scan(blade, tmp_path, foreign_here, monkeypatch):
    from bladegen.fitting.wear import patterns

    monkeypatch.setattr(DeviationMap.measured.__func__, "__kwdefaults__", {"spans": 12})
    assert patterns.SPANS > 12
    scan = bg.export(blade, tmp_path / "scan.stl", stations=30)
    bg.write(bg.read("nrel5mw"), tmp_path / "blade.yaml")
    paths = [tmp_path / f"map.{suffix}" for suffix in ("csv", "vtp", "png")]
    asked = [word for path in paths for word in ("--deviation", str(path))]
    result = RUN.invoke(
        commands.app,
        ["check", str(scan), str(tmp_path / "blade.yaml"), *asked],
    )
    assert result.exit_code == 0, result.output
    assert "deviation rest rms mm" in result.output
    rows = np.loadtxt(paths[0], delimiter=",", skiprows=1)
    assert rows.shape == (12 * 401, 9)
    assert_allclose(rows[:, 6:].sum(axis=1), rows[:, 5], atol=1e-4)
    assert all(path.stat().st_size > 1000 for path in paths)
    result = RUN.invoke(commands.app, ["check", str(scan), "--deviation", str(paths[0])])
    assert "name one as OTHER" in str(result.exception)
    result = RUN.invoke(commands.app, ["check", str(scan), str(scan), "--deviation", str(paths[0])])
    assert "is no definition" in str(result.exception)


def test_a_variant_with_wear_is_the_variant_worn(blade, eroded):
    variant = blade.perturbed(twist=0.02)
    worn = blade.perturbed(twist=0.02, deviation=eroded)
    eta = np.linspace(0.0, 1.0, 40)
    assert_allclose(worn.sections(eta), eroded.applied(variant).sections(eta), atol=0)
    assert worn.changes[0] == variant.changes[0]
    assert_allclose(worn.changes[1]["deviation"]["inward_mm"], 5.0)
    with pytest.raises(PerturbationError, match=r"deviation: got 3, must be a bladegen.Deviation"):
        blade.perturbed(deviation=3)


def test_a_mirror_image_is_worn_alike(blade, eroded):
    eta = np.linspace(0.5, 1.0, 20)
    one = eroded.applied(blade).mirror_image().sections(eta)
    assert_allclose(eroded.applied(blade.mirror_image()).sections(eta), one, atol=1e-12)


def test_waves_have_their_length_and_height():
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), fairing=None)
    maps = DeviationMap.waves(blade, start=0.4, end=0.8, length=0.4, height=0.01)
    at = np.argmin(np.abs(maps.eta - 0.6))
    values = maps.values[at]
    assert_allclose([values.max(), values.min()], [0.005, -0.005], rtol=0.03)
    points = blade.sections(maps.eta[at])
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    crests = arc[1:-1][(values[1:-1] > values[:-2]) & (values[1:-1] > values[2:])]
    inner = np.diff(crests[crests < arc[200] - 0.4])
    assert len(inner) > 3
    assert_allclose(inner, 0.4, atol=0.04)
    assert np.all(maps.values[maps.eta <= 0.4] == 0.0)
    with pytest.raises(BladegenError, match=r"length 0\.01 m is less than 8 landmarks"):
        DeviationMap.waves(blade, start=0.4, length=0.01, height=0.001)


def test_maps_add_up_and_come_back_from_a_table(blade, eroded, tmp_path):
    hit = DeviationMap.dent(blade, eta=0.4, u=0.2, size=1.0, depth=0.01)
    both = eroded + hit
    assert set(both.eta) == {*eroded.eta, *hit.eta}
    at = np.isin(both.eta, hit.eta) & (both.eta < 0.55)
    inside = hit.values[np.isin(hit.eta, both.eta[at])]
    assert_allclose(both.values[at], inside, atol=1e-12)
    path = tmp_path / "map.csv"
    write(both, blade, path)
    again = DeviationMap.read(path)
    assert_allclose(again.values, both.values, atol=1e-9)
    assert_allclose(again.eta, both.eta, atol=1e-6)


@given(st.floats(-4.0, 4.0), st.floats(-4.0, 4.0))
def test_maps_are_scaled_by_numbers(eroded, one, other):
    """A vector space: what is measured on a blade is put on others by halves, or twice."""
    made = one * eroded
    assert_allclose(made.values, one * eroded.values, atol=0.0)
    assert np.array_equal(made.eta, eroded.eta)
    assert_allclose((made * other).values, ((one * other) * eroded).values, atol=1e-12)
    assert_allclose((made + other * eroded).values, ((one + other) * eroded).values, atol=1e-12)
    assert_allclose((np.float64(one) * eroded).values, made.values, atol=0.0)


def test_a_scaled_map_moves_the_skin_by_as_much(blade, eroded):
    eta = np.linspace(0.75, 0.95, 5)
    own = blade.sections(eta)
    full, half = (blade.perturbed(deviation=f * eroded).sections(eta) - own for f in (1.0, 0.5))
    assert np.abs(full).max() > 2e-3
    assert_allclose(half, 0.5 * full, atol=6e-4)  # each is put on within 0.3 mm


@pytest.mark.parametrize("factor", [np.ones(3), float("nan"), "2", True])
def test_maps_are_scaled_by_nothing_else(eroded, factor):
    with pytest.raises(BladegenError, match="deviation"):
        eroded * factor
    with pytest.raises(BladegenError, match="maps add up with"):
        eroded * eroded


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("eta,u\n0,0\n", "has no column deviation_mm"),
        (
            "eta,u,deviation_mm\n0,0,1\n0,1,1\n1,0,1\n",
            "has 3 rows, must have one for each of 2 eta",
        ),
        ("eta,u,deviation_mm\n0,0,x\n", "a row holds no 3 numbers"),
        ("eta,u,deviation_mm\n0,0,nan\n0,1,1\n1,0,1\n1,1,1\n", "must be numbers"),
    ],
)
def test_tables_that_are_no_maps_are_one_line(text, said, tmp_path):
    path = tmp_path / "map.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(BladegenError, match=said):
        DeviationMap.read(path)


def test_commands_put_wear_dents_and_maps_on_the_skin(blade, tmp_path):
    hit = DeviationMap.dent(blade, eta=0.4, u=0.2, size=1.0, depth=0.01)
    write(hit, blade, tmp_path / "map.csv")
    words = f"perturb nrel5mw -o {tmp_path} --landmarks 101 --format sections.csv --name worn"
    more = ["--erosion", "0.6,1,0.06,5mm", "--dent", "0.3,0.7,800mm,8mm"]
    more += ["--deviation", f"{tmp_path}/map.csv", "--deviation-scale", "0.6"]
    run = RUN.invoke(commands.app, [*words.split(), *more])
    assert run.exit_code == 0, run.output
    rows = np.loadtxt(tmp_path / "worn.sections.csv", delimiter=",", skiprows=1)
    own = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)
    eta = np.unique(rows[:, 0])
    off = np.linalg.norm(rows[:, -3:].reshape(len(eta), 101, 3) - own.sections(eta), axis=-1)
    for place, depth in (((0.4, 20), 0.006), ((0.3, 70), 0.008), ((0.8, 50), 0.005)):
        near = np.argmin(np.abs(eta - place[0]))
        about = slice(place[1] - 10, place[1] + 11)
        assert_allclose(off[near, about].max(), depth, rtol=0.15)


@pytest.mark.parametrize(
    ("option", "said"),
    [
        (("--erosion", "0.7,1,4mm"), "must be FROM,TO,WIDTH,DEPTH, such as 0.7,0.98,0.03,4mm"),
        (("--erosion", "0.7,1,3,4mm"), "got a width of 3, must be more than 0 and at most 1"),
        (("--erosion", "0.9,0.7,0.1,4mm"), "start and end must rise within 0 to 1"),
        (("--dent", "0.5,0.2,600,10mm"), "dent: size: got '600', must be a length with its unit"),
        (("--dent", "50,0.2,600mm,10mm"), "the span fraction and the place around"),
        (("--dent", "0.9,0.3,300mm,2m"), "can take: it crosses itself"),
        (("--deviation-scale", "2"), "is for a map: add --deviation MAP.csv"),
    ],
)
def test_slips_are_answered_in_a_line(option, said, tmp_path):
    words = f"perturb nrel5mw -o {tmp_path} --landmarks 101 --format sections.csv"
    run = RUN.invoke(commands.app, [*words.split(), *option])
    assert run.exit_code != 0
    assert said in str(run.exception)
