"""Rotors: laws of momentum theory, published rotors, NeuralFoil's polars in batches, energy."""

import json
import subprocess
import sys
from dataclasses import replace
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from test_cli import run
from test_polars import attached

import bladegen as bg
from bladegen.airfoils.viterna import around, extended
from bladegen.blade.aero.elements import Elements, elements_of
from bladegen.blade.aero.energy import HOURS, Conditions, annual_energy, weibull_shares
from bladegen.blade.aero.evaluation import SPANS, evaluated, of_polars
from bladegen.blade.aero.momentum import loads
from bladegen.blade.aero.performance import coefficients, performance
from bladegen.blade.aero.section_polars import GRID, polars_of
from bladegen.blade.blade import Blade
from bladegen.definition import estimates
from bladegen.definition.blade_definition import Airfoil, Rotor
from bladegen.definition.blending import between, completed
from bladegen.errors import BladegenError, MissingLibraryError
from strategies import naca

BETZ = 16.0 / 27.0
PLATE = 2.0 * np.pi * np.sin(GRID) * np.cos(GRID)  # lift without drag


@cache
def blade(name="iea15mw"):
    return Blade.from_definition(bg.read(name), landmarks=101)


@cache
def both():
    return evaluated([blade(), blade().perturbed(thickness=0.95, twist=0.01)])


def rotor(radius, chord, twist, cone=0.0):
    radius = np.asarray(radius)
    whole = [np.broadcast_to(part, radius.shape)[None] for part in (radius, chord, twist, cone)]
    r, c, t, k = (np.ascontiguousarray(part, dtype=np.float64) for part in whole)
    return Elements(np.zeros_like(r), r, c, t, k, np.zeros((1, r.size, 3, 2)), np.zeros_like(r))


def tables(lift, drag, count):
    return tuple(np.broadcast_to(part, (1, count, len(GRID))).copy() for part in (lift, drag))


# ---- momentum theory ---------------------------------------------------------------------------


@given(
    chord=st.floats(0.005, 0.15),
    twist=st.floats(-0.1, 0.4),
    ratio=st.floats(1.0, 12.0),
    drag=st.floats(0.0, 0.05),
    blades=st.integers(1, 5),
)
def test_loads_are_the_momentum_that_the_wake_has_lost_and_gained(
    chord, twist, ratio, drag, blades
):
    given = rotor(np.linspace(0.1, 1.0, 10), chord, twist)
    cl, cd = tables(PLATE, drag + 0.0 * GRID, 10)
    found, case = np.empty((1, 1, 10, 4)), (np.full((1, 1), ratio), np.zeros((1, 1)))
    loads(given.radius, given.chord, given.twist, given.cone, blades, *case, cl, cd, found)
    normal, tangential, a, phi = found[0, 0, 1:-1].T
    r = given.radius[0, 1:-1]
    assert np.all(np.isfinite(found))
    assert_allclose(found[0, 0, [0, -1], :2], 0.0)
    ends = (np.exp(-0.5 * blades * x / np.abs(np.sin(phi))) for x in ((1 - r) / r, (r - 0.1) / 0.1))
    loss = np.prod([2.0 / np.pi * np.arccos(end) for end in ends], axis=0)
    swirl = (1.0 - a) / (ratio * r * np.tan(phi)) - 1.0
    # windmills in light load: momentum theory itself, along the axis and around it
    kept = (a > -0.3) & (a < 0.39) & (phi > 0.02) & (phi < 1.5) & (swirl > -0.5)
    along = 8.0 * np.pi * r * loss * a * (1.0 - a)
    round_ = 8.0 * np.pi * r * loss * swirl * (1.0 - a) * ratio * r
    assert_allclose(blades * normal[kept], along[kept], rtol=1e-5, atol=1e-7)
    assert_allclose(blades * tangential[kept], round_[kept], rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize(
    ("ratio", "power"), [(1.0, 0.416), (2.0, 0.512), (2.5, 0.532), (5.0, 0.570), (7.5, 0.582)]
)
def test_an_ideal_rotor_has_the_power_that_glauert_gives(ratio, power):
    """H. Glauert, Airplane propellers, in W. F. Durand, Aerodynamic theory IV, 1935, table."""
    radius, blades = np.linspace(0.01, 1.0, 1000), 1000
    phi = 2.0 / 3.0 * np.arctan(1.0 / (ratio * radius))
    chord = 8.0 * np.pi * radius / blades * (1.0 - np.cos(phi))  # at a lift of 1
    twist = phi - np.arcsin(1.0 / np.pi) / 2.0
    given = rotor(radius, chord, twist)
    one = np.full((1, 1), ratio)
    found = coefficients(given, tables(PLATE, 0.0 * GRID, 1000), blades, one, 0.0 * one)
    assert_allclose(found[0, 0, 0], power, atol=2e-3)
    assert found[0, 0, 0] < BETZ


def test_many_rotors_are_each_as_one_alone():
    found = both()
    for row in range(2):
        parts = (
            replace(thing, **{key: value[row : row + 1] for key, value in vars(thing).items()})
            for thing in (found.elements, found.polars)
        )
        alone = of_polars(*parts, 3, found.conditions)
        assert_allclose(alone.performance.best, found.performance.best[row : row + 1], rtol=1e-12)
        assert_allclose(alone.energy, found.energy[row : row + 1], rtol=1e-12)


def test_the_optimum_is_the_largest_power_and_pitch_is_twist():
    plain = both()
    best, elements = plain.performance, plain.elements
    parts = plain.polars.extended()
    near = np.array([[-0.1, 0.0, 0.1]]) + best.ratio[:, None]
    for step in (-0.005, 0.0, 0.005):
        found = coefficients(elements, parts, 3, near, best.pitch[:, None] + step)
        assert np.all(found[..., 0] <= best.best[:, :1] + 3e-6)
    turned = replace(elements, twist=elements.twist + 0.01)
    again = coefficients(turned, parts, 3, near, best.pitch[:, None] - 0.01)
    assert_allclose(again, coefficients(elements, parts, 3, near, best.pitch[:, None]), atol=1e-9)


def test_the_optimum_does_not_jump_with_the_grid_that_it_is_looked_for_on():
    """Blades that are twisted as a whole are the same rotors, pitched."""
    plain = both()
    parts, best = plain.polars.extended(), plain.performance
    for turn in np.radians([0.2, 0.5, 0.8]):
        turned = replace(plain.elements, twist=plain.elements.twist + turn)
        again = performance(turned, parts, 3)
        assert_allclose(again.best[:, 0], best.best[:, 0], rtol=1e-5)
        assert_allclose(again.best[:, 2], best.best[:, 2], rtol=1e-3)
        assert_allclose(again.pitch + turn, best.pitch, atol=1e-3)


def test_steps_along_the_span_are_small_enough():
    finer = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0.0, 1.0, 121))
    rotor_ = blade().definition.rotor
    given = [
        elements_of(blade().sections(spans)[None], rotor_.hub_radius, rotor_.cone)
        for spans in (SPANS, finer)
    ]
    best = [
        performance(one, tuple(published(one_spans)), 3).best[0]
        for one, one_spans in zip(given, (SPANS, finer), strict=True)
    ]
    assert_allclose(best[0], best[1], rtol=1e-3)


# ---- published rotors --------------------------------------------------------------------------

# Power and thrust coefficients of the IEA 15 MW at pitch 0, tilt 6 deg and wind shear, by the
# ROSCO toolbox with WISDEM's CCBlade: IEAWindTask37/IEA-15-240-RWT, commit 6b3fd8a,
# OpenFAST/IEA-15-240-RWT/Cp_Ct_Cq.IEA15MW.txt
TABLE = {
    4.0: (0.166524, 0.239062),
    6.0: (0.368855, 0.50032),
    8.0: (0.463986, 0.711681),
    9.0: (0.469256, 0.792686),
    10.0: (0.452466, 0.862272),
    12.0: (0.376832, 0.985517),
}


@cache
def described():
    """The IEA 15 MW with the polars that it was published with."""
    (folder,) = find_spec("windIO").submodule_search_locations
    return bg.read(str(Path(folder) / "examples" / "turbine" / "IEA-15-240-RWT.yaml"))


def published(spans):
    """Lift and drag (1, k, m) of the IEA 15 MW's published polars."""
    polars = [completed(between(described(), float(eta)).polars()[0]) for eta in spans]
    return np.array([[polar.at(GRID)[i] for polar in polars] for i in (0, 1)])[:, None]


def test_the_iea_15_mw_has_the_published_coefficients():
    rotor_ = blade().definition.rotor
    given = elements_of(blade().sections(SPANS)[None], rotor_.hub_radius, rotor_.cone)
    assert_allclose(given.tip_radius, 120.40, atol=0.01)  # cone and prebend lean it upwind
    ratios = np.array([list(TABLE)])
    found = coefficients(given, tuple(published(SPANS)), 3, ratios, 0.0 * ratios)[0, :, :2]
    wanted = np.array(list(TABLE.values()))
    # without tilt and shear there is more power: cos(6 deg) cubed is 1.6 %, shear as much
    assert_allclose(found, wanted, atol=0.026)
    assert np.all(found[1:] > wanted[1:])


@pytest.fixture(scope="module")
def ccblade(tmp_path_factory):
    """A Python that has WISDEM's CCBlade, without WISDEM's hundred packages."""
    folder = tmp_path_factory.mktemp("ccblade")
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    (own,) = folder.glob("lib/python3*/site-packages")
    own.joinpath("ours.pth").write_text(
        "\n".join(p for p in sys.path if p.endswith("site-packages"))
    )
    python = folder / "bin" / "python"
    pip = [python, "-m", "pip", "install", "--quiet", "--no-deps", "wisdem==4.2.9"]
    subprocess.run(pip, check=True)
    return python


@pytest.mark.nightly
@pytest.mark.parametrize("straight", [True, False])
def test_coefficients_are_those_of_ccblade(ccblade, tmp_path, straight):
    cone = 0.0 if straight else blade().definition.rotor.cone
    rotor_ = blade().definition.rotor
    given = elements_of(blade().sections(SPANS)[None], rotor_.hub_radius, cone)
    if straight:
        radius = np.linspace(given.radius[0, 0], given.radius[0, -1], len(SPANS))[None]
        given = replace(given, radius=radius, axial=0.0 * radius, cone=0.0 * radius)
    cl, cd = published(SPANS)
    ratios = np.linspace(3.0, 13.0, 11)
    pitch = np.radians(np.linspace(-2.0, 4.0, 11))
    found = coefficients(given, (cl, cd), 3, ratios[None], pitch[None])[0]
    rows = {name: getattr(given, name)[0] for name in ("axial", "radius", "chord", "twist")}
    file = tmp_path / "rotor.npz"
    cases = {"ratios": ratios, "pitch": pitch, "blades": 3, "cone": cone}
    np.savez(file, **rows, **cases, alpha=GRID, cl=cl[0], cd=cd[0])
    script = [ccblade, Path(__file__).with_name("ccblade.py"), file]
    told = subprocess.run(script, capture_output=True, text=True, check=True).stdout
    theirs = np.array(told.split(), dtype=float).reshape(-1, 3)
    if straight:  # CCBlade's moment is about the rotor's axis, ours about the blade's root
        lever = given.radius[0, 0] / given.radius[0, -1] / 3.0
        assert_allclose(found[:, 2] + lever * found[:, 1], theirs[:, 2], rtol=1e-4)
    # CCBlade takes solidity and losses at radii along the blade, we at those from the axis
    assert_allclose(found[:, :2], theirs[:, :2], rtol=1e-4 if straight else 1.5e-2)


# ---- sections ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["iea15mw", "nrel5mw"])
def test_elements_have_the_blades_chord_twist_and_thickness(name):
    made = blade(name)
    spans = np.linspace(0.2, 1.0, 30)
    found = elements_of(made.sections(spans)[None], 2.0, 0.0)
    assert_allclose(found.chord[0], made.chord(spans), rtol=2e-4)
    assert_allclose(found.twist[0], made.twist(spans), atol=0.01)  # of its airfoils' own lines
    assert_allclose(found.thickness[0], made.relative_thickness(spans), atol=2e-3)
    slope = np.gradient(made.axis(spans)[:, 0], made.axis(spans)[:, 2])
    assert_allclose(np.tan(found.cone[0])[1:-1], -slope[1:-1], atol=2e-3)
    assert np.all(found.outlines[0, :, 25, 1] > found.outlines[0, :, 75, 1])  # suction side first


def test_a_mirror_image_does_the_same():
    found = evaluated([blade(), blade().mirror_image()]).performance
    assert_allclose(found.best[0], found.best[1], rtol=1e-9)


@given(attached(), st.floats(1.0, 60.0))
def test_polars_in_a_batch_are_extended_as_one_is(part, ratio):
    alpha, cl, cd, _ = part
    middle = np.abs(cl[:-1]).max() + 1.0
    cl = cl.copy()
    cl[0], cl[-1] = -middle, middle  # the stalls are at the ends
    whole, lift, drag, _ = extended(alpha, cl, cd, 0.0 * cl, aspect_ratio=ratio)
    found = around(whole, alpha, cl[None], cd[None], aspect_ratio=ratio)
    assert_allclose(found[0][0], lift, atol=1e-12)
    assert_allclose(found[1][0], drag, atol=1e-12)


def test_polars_of_sections_are_those_of_estimates():
    pytest.importorskip("neuralfoil")
    airfoils = [naca(0.18, 0.0, 0.0), naca(0.21, 0.02, 0.4), naca(0.55, 0.0, 0.0)]
    for xy in airfoils:
        wanted = estimates.estimated(Airfoil("a", xy), 6e6)
        points, thickness = estimates._flat(Airfoil("a", xy))
        found = polars_of(points[None], np.array([thickness]), np.array([6e6]))
        cl, cd = found.extended()
        assert_allclose(cl[0], wanted.at(GRID)[0], atol=0.03)
        assert_allclose(cd[0], wanted.at(GRID)[1], atol=0.01)
        assert 0.0 < found.least_confidence[0] <= 1.0


# ---- energy ------------------------------------------------------------------------------------


@given(mean=st.floats(4.0, 12.0), shape=st.floats(1.5, 3.5))
def test_weibull_winds_have_their_mean_and_a_year_is_a_year(mean, shape):
    winds = np.linspace(0.0, 120.0, 4801)
    shares = weibull_shares(winds, mean, shape)
    assert_allclose(shares.sum(), 1.0, atol=1e-9)
    assert_allclose(shares @ (0.5 * (winds[1:] + winds[:-1])), mean, rtol=1e-3)
    assert_allclose(annual_energy(winds, 0.0 * winds + 2.0, mean, shape), 7200.0 * HOURS)


def test_the_cube_of_a_rayleigh_wind_has_its_mean():
    winds = np.linspace(0.0, 60.0, 2401)
    mean = annual_energy(winds, winds**3, 8.0, 2.0) / (3600.0 * HOURS)
    assert_allclose(mean, 6.0 / np.pi * 8.0**3, rtol=1e-3)


def test_rated_power_is_reached_where_it_is_and_energy_follows():
    found = both()
    working, best = found.conditions, found.performance
    disc = np.pi * found.elements.tip_radius**2
    ideal = (working.rated_power / (0.5 * working.air_density * disc * best.best[:, 0])) ** (1 / 3)
    assert np.all(found.rated_wind >= (1.0 - 5e-4) * ideal)  # the tip speed may bind before
    assert_allclose(found.rated_wind, ideal, rtol=0.01)
    assert np.all(found.energy < working.rated_power * 3600.0 * HOURS)
    force = 0.5 * working.air_density * found.rated_wind**2 * disc * found.elements.tip_radius
    assert_allclose(found.root_moment, best.best[:, 2] * force, rtol=0.05)


def test_conditions_come_from_the_file_and_from_what_is_given():
    known = Conditions.of(blade().definition.rotor, 120.4)
    assert known.rated_power == 15e6
    assert known.mean_wind == 10.0  # class I
    assert known.tip_speed == pytest.approx(7.56 * 2 * np.pi / 60 * 120.4, rel=1e-4)
    plain = Conditions.of(Rotor(), 50.0, mean_wind=7.0)
    assert (plain.tip_speed, plain.rated_power, plain.mean_wind) == (80.0, None, 7.0)
    with pytest.raises(BladegenError, match="cut_out: got 3 m/s, must be above"):
        Conditions(cut_out=3.0)
    with pytest.raises(BladegenError, match=r"efficiency: got 1\.2"):
        Conditions(efficiency=1.2)
    with pytest.raises(BladegenError, match="mean_wind: got -1, must be positive"):
        Conditions(mean_wind=-1.0)


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        (
            "rated_power",
            15e12,
            r"got 1\.5e\+07 MW, allowed is up to 1000 MW; --rated-power is in MW",
        ),
        ("tip_speed", 9000.0, "got 9000 m/s, allowed is up to 340 m/s"),
        ("mean_wind", 85.0, "got 85 m/s, allowed is up to 50 m/s"),
        ("air_density", 1225.0, "got 1225 kg/m3, allowed is up to 10 kg/m3"),
        ("cut_in", 300.0, "got 300 m/s, allowed is up to 100 m/s"),
        ("cut_out", 2500.0, "got 2500 m/s, allowed is up to 100 m/s"),
        ("weibull_shape", 200.0, "got 200, allowed is up to 20"),
    ],
)
def test_a_condition_with_a_slip_in_its_unit_is_refused(name, value, told):
    with pytest.raises(BladegenError, match=f"{name}: {told}"):
        Conditions(**{name: value})


# ---- the command -------------------------------------------------------------------------------


def test_a_blade_is_evaluated_beside_its_baseline(tmp_path):
    words = ("evaluate", "nrel5mw", "--twist", "1", "--network", "xxsmall")
    figures = json.loads(run(*words, "--json").output)
    baseline, variant = figures["blades"]
    assert baseline["baseline"]
    assert not variant["baseline"]
    assert variant["pitch_deg"] == pytest.approx(baseline["pitch_deg"] - 1.0, abs=0.2)
    assert len(variant["curve"]["power_coefficient"]) == len(variant["curve"]["tip_speed_ratio"])
    assert figures["conditions"]["rated_power_W"] == 5e6
    shown = run(*words, "--plot", tmp_path / "rotor.svg")
    assert shown.exit_code == 0
    assert (tmp_path / "rotor.svg").stat().st_size > 10_000
    assert max(variant["power_W"]) == 5e6
    assert variant["mass_t"] == pytest.approx(baseline["mass_t"], rel=0.01)
    assert baseline["mass_t"] == pytest.approx(16.43, rel=0.01)
    for word in ("annual energy, GWh", "change", "nrel5mw-perturbed", "Cp, variant"):
        assert word in shown.output


@pytest.mark.parametrize(
    ("power", "told"),
    [
        ("1e-5", "10 W on a rotor of 240.8 m are 0.00022 W/m2, turbines have 150 to 600"),
        ("999", "is not reached up to the cut-out of 25 m/s"),
        ("15", None),
    ],
)
def test_a_rated_power_that_is_no_turbines_is_noted(power, told):
    shown = run("evaluate", "iea15mw", "--network", "xxsmall", "--rated-power", power).output
    assert (f"note: rated power: {told}" in shown) if told else ("note:" not in shown)
    assert "rated wind speed, m/s" in shown


def test_what_is_missing_is_said_in_a_line(monkeypatch):
    words = "evaluate", "dtu10mw", "--network", "xxsmall"
    shown = run(*words)
    assert "give one in MW: --rated-power 10" in shown.output
    assert "rated wind" not in shown.output
    assert "wind at the largest tip speed" in shown.output
    (figures,) = json.loads(run(*words, "--json").output)["blades"]
    assert figures["rated_wind_m_s"] is figures["mass_t"] is None
    ratio, limit = figures["tip_speed_ratio"], figures["tip_speed_wind_m_s"]
    assert ratio * limit == pytest.approx(80.0)
    for words, error in (
        (("--network", "huge"), "network: got 'huge', allowed are xxsmall"),
        (("--hub-radius", "far"), "hub-radius: got 'far'"),
    ):
        result = run("evaluate", "dtu10mw", *words)
        assert isinstance(result.exception, BladegenError)
        assert str(result.exception).startswith(error)
    bare = replace(blade().definition, rotor=Rotor())
    with pytest.raises(BladegenError, match="names no hub radius"):
        evaluated([Blade.from_definition(bare, landmarks=101)])
    monkeypatch.setitem(sys.modules, "neuralfoil", None)
    with pytest.raises(MissingLibraryError, match=r"pip install 'bladegen\[aero\]'"):
        evaluated([blade()])
