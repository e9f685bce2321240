"""Polars: blending, and laws of their extension and of estimates."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.airfoils.polars import BORROWED, Polar, blended
from bladegen.airfoils.viterna import extended, normal_moment
from bladegen.definition import estimates
from bladegen.definition.blade_definition import Airfoil, Station
from bladegen.errors import BladegenError, DefinitionError
from bladegen.formats.common.document import Node, Notes
from bladegen.formats.common.polars import polars as read_polars
from bladegen.formats.windio.yaml_file import load_yaml
from strategies import circle, naca, tenth


def polar(lift: float = 1.0, **changes) -> Polar:
    alpha = np.linspace(-np.pi, np.pi, 9)
    return Polar(alpha, lift * np.sin(alpha), 0.1 + 0 * alpha, -0.1 * np.sin(alpha), **changes)


def test_polars_are_checked():
    with pytest.raises(DefinitionError, match="alpha must increase"):
        replace(polar(), alpha=np.zeros(9))
    with pytest.raises(DefinitionError, match="cl has shape"):
        replace(polar(), cl=np.zeros(3))
    with pytest.raises(DefinitionError, match="cd holds a value that is not finite"):
        replace(polar(), cd=np.full(9, np.nan))


@given(st.floats(0.0, 1.0))
def test_a_blend_lies_between_and_says_where_it_is_from(weight):
    one, other = polar(1.0, reynolds=1e6), polar(2.0, reynolds=3e6)
    (mixed,) = blended([one], [other], weight, f"{BORROWED}: both")
    assert_allclose(mixed.cl, (1.0 + weight) * one.cl, atol=1e-14)
    assert mixed.reynolds == (
        1e6 if weight < 0.5 else 3e6
    )  # few numbers: WISDEM has a table of each
    assert mixed.is_borrowed
    assert not one.is_borrowed
    (nearer,) = blended([one], [replace(other, configuration="rough")], weight, "x")
    assert_allclose(nearer.cl, (one if weight < 0.5 else other).cl)


@st.composite
def attached(draw):
    """A polar from stall to stall, as a network or a tunnel gives it."""
    low, high = draw(st.floats(-0.4, -0.08)), draw(st.floats(0.08, 0.4))
    alpha = np.linspace(low, high, draw(st.integers(3, 30)))
    slope, zero = draw(st.floats(3.0, 7.0)), draw(st.floats(-0.07, 0.07))
    drag = draw(st.floats(0.004, 0.05)) + draw(st.floats(0.0, 2.0)) * alpha**2
    return alpha, slope * (alpha - zero), drag, np.full(len(alpha), draw(st.floats(-0.2, 0.1)))


@given(attached(), st.floats(1.0, 60.0))
def test_an_extended_polar_is_whole_continuous_and_periodic(part, ratio):
    alpha, *curves = extended(*part, aspect_ratio=ratio)
    assert_allclose([alpha[0], alpha[-1]], [-np.pi, np.pi])
    assert np.all(np.diff(alpha) > 0)
    inner = np.isin(alpha, part[0])
    for whole, own in zip(curves, part[1:], strict=True):
        assert_allclose(whole[inner], own, rtol=0, atol=1e-14)  # the given part stays
        assert whole[0] == pytest.approx(whole[-1], abs=1e-12)
    assert np.all(curves[1] >= part[2].min() - 1e-15)
    assert_allclose(curves[0][[0, -1]], 0.0, atol=1e-12)
    quarter = np.argmin(np.abs(alpha - 0.5 * np.pi))
    assert curves[1][quarter] == pytest.approx(1.11 + 0.018 * min(ratio, 50.0), abs=1e-9)
    assert curves[0][quarter] == pytest.approx(0.0, abs=1e-9)


@given(attached())
def test_the_first_step_beyond_stall_is_small(part):
    """No jump: what Viterna's formulas give at stall is the stall itself."""
    alpha, cl, cd, cm = extended(*part)
    start, end = np.searchsorted(alpha, [part[0][0], part[0][-1]])
    for curve in (cl, cd, cm):
        for i in (start - 1, end):
            rate = abs(curve[i + 1] - curve[i]) / (alpha[i + 1] - alpha[i])
            assert rate < 40.0 * (1.0 + np.abs(curve).max())


@given(st.floats(0.1, 0.4), st.floats(3.0, 7.0), st.floats(0.005, 0.05))
def test_a_symmetric_section_has_odd_lift_and_moment(stall, slope, drag):
    alpha = np.linspace(-stall, stall, 21)
    alpha, cl, cd, cm = extended(alpha, slope * alpha, drag + alpha**2, np.zeros(21))
    assert_allclose(alpha, -alpha[::-1], atol=1e-15)
    assert_allclose(cl, -cl[::-1], atol=1e-12)
    assert_allclose(cd, cd[::-1], atol=1e-12)
    assert_allclose(cm, -cm[::-1], atol=1e-12)


def test_a_plate_across_the_flow_has_its_force_at_half_chord():
    quarter = np.array([0.5 * np.pi])
    assert_allclose(normal_moment(quarter, np.zeros(1), np.array([2.0])), -0.5)


# ---- estimates --------------------------------------------------------------------------------

SYMMETRIC = Airfoil("symmetric", naca(0.18, 0.0, 0.0))


def test_an_estimate_says_what_it_is_and_obeys_thin_airfoil_theory():
    pytest.importorskip("neuralfoil")
    made = estimates.estimated(SYMMETRIC, 6e6)
    assert made.source.startswith("estimate: NeuralFoil")
    assert "Viterna" in made.source
    small = np.radians(np.array([-4.0, 4.0]))
    slope = np.diff(made.at(small)[0])[0] / np.diff(small)[0]
    assert 0.85 * 2 * np.pi < slope < 1.2 * 2 * np.pi
    assert_allclose(made.cl, -np.interp(-made.alpha, made.alpha, made.cl), atol=0.02)
    assert 0.003 < made.at(np.zeros(1))[1][0] < 0.02
    turned = estimates.estimated(replace(SYMMETRIC, coordinates=SYMMETRIC.coordinates[::-1]), 6e6)
    assert_allclose(turned.cl, made.cl, atol=1e-6)


def test_thick_sections_go_over_to_a_cylinder():
    pytest.importorskip("neuralfoil")
    round_ = estimates.estimated(Airfoil("circle", circle()), 5e6)
    assert_allclose(round_.cl, 0.0, atol=1e-9)
    assert_allclose(round_.cd, estimates.CYLINDER_DRAG, atol=1e-9)
    thick = estimates.estimated(Airfoil("thick", naca(0.6, 0.02, 0.0)), 5e6)
    assert "thinned to 40 %, mixed with 33 % of a cylinder" in thick.source


def test_forces_act_between_the_quarter_of_an_airfoil_and_the_half_of_a_cylinder():
    pytest.importorskip("neuralfoil")
    thin, thick = SYMMETRIC, Airfoil("thick", naca(0.7, 0.0, 0.0))
    definition = replace(
        bg.read("nrel5mw"),
        stations=(
            Station(0.0, Airfoil("circle", circle())),
            Station(0.5, thick),
            Station(1.0, thin),
        ),
    )
    made, _ = estimates.with_polars(definition, "estimate")
    centres = [station.airfoil.aerodynamic_center for station in made.stations]
    assert_allclose(centres, [0.5, 0.375, 0.25], atol=2e-3)


def test_a_baseline_can_be_estimated_as_its_variant_is():
    pytest.importorskip("neuralfoil")
    known = with_polars(tenth(), 4e6)
    known = replace(known, stations=(known.stations[0], known.stations[-1]))
    kept, _ = estimates.with_polars(known, "estimate")
    made, said = estimates.with_polars(known, "estimate-all")
    assert kept.stations[-1].airfoil.polars == known.stations[-1].airfoil.polars
    assert made.stations[-1].airfoil.polars[0].source.startswith("estimate: NeuralFoil")
    assert made.stations[-1].airfoil.polars[0].reynolds == 4e6
    assert "2 airfoils with an estimate" in str(said[0])


def test_a_blade_without_polars_is_estimated_at_few_reynolds_numbers():
    bare = bg.read("nrel5mw")
    eta = np.linspace(0.05, 1.0, 60)
    numbers = [
        estimates.reynolds_at(bare, Station(place, bare.stations[-1].airfoil)) for place in eta
    ]
    assert len(set(numbers)) < 12
    rotor = (bare.rotor.hub_radius + eta * bare.length) / (bare.rotor.hub_radius + bare.length)
    assert_allclose(numbers, bare.chord(eta) * rotor * 80.0 / 1.46e-5, rtol=0.13)


def with_polars(definition, known):
    stations = tuple(
        Station(s.eta, replace(s.airfoil, polars=(polar(reynolds=known),)))
        for s in definition.stations
    )
    return replace(definition, stations=stations)


def test_policies(monkeypatch):
    bare = bg.read("nrel5mw")
    known = with_polars(bare, 4e6)
    same, said = estimates.with_polars(known, "keep")
    assert same == known or same.stations[0].airfoil.polars == known.stations[0].airfoil.polars
    assert not said
    gone, _ = estimates.with_polars(known, "none")
    assert not any(station.airfoil.polars for station in gone.stations)
    _, said = estimates.with_polars(bare, "keep")
    assert "8 airfoils have none" in str(said[0])
    with pytest.raises(
        BladegenError, match="got 'guess', allowed are estimate, estimate-all, keep"
    ):
        estimates.with_polars(bare, "guess")
    monkeypatch.setattr(estimates, "available", lambda: False)
    with pytest.raises(BladegenError, match=r"pip install 'bladegen\[aero\]'"):
        estimates.with_polars(bare, "estimate")


def test_reynolds_numbers_are_those_of_polars_or_of_the_chord():
    bare = bg.read("nrel5mw")
    tip = estimates.reynolds_at(bare, bare.stations[-1])
    assert tip == pytest.approx(float(bare.chord(1.0)) * 80.0 / 1.46e-5, rel=0.13)
    known = with_polars(bare, 4e6)
    assert estimates.reynolds_at(known, known.stations[3]) == 4e6


def test_a_variant_has_estimates_of_its_own_or_the_marked_ones_of_its_baseline(
    tmp_path, monkeypatch
):
    pytest.importorskip("neuralfoil")
    monkeypatch.setattr(estimates, "MODEL", "xxsmall")  # quick
    blade = bg.Blade.from_definition(with_polars(tenth(), 4e6))
    variant = blade.perturbed(thickness=1.05, name="variant")
    said = bg.write(variant, tmp_path / "kept.yaml", polars="keep")
    assert "with polars of the baseline, not of their own shape" in " ".join(map(str, said))
    kept = bg.read(tmp_path / "kept.yaml")
    assert kept.stations[-1].airfoil.polars[0].is_borrowed
    assert not kept.stations[0].airfoil.polars[0].is_borrowed  # the root was left alone
    with pytest.raises(BladegenError, match="reynolds: got 5, allowed is 1e4 to 1e9"):
        bg.write(kept, tmp_path / "made.yaml", polars="estimate", reynolds=5.0)
    told = []
    said = bg.write(
        kept, tmp_path / "made.yaml", polars="estimate", reynolds=7e6, progress=told.append
    )
    assert "with an estimate: NeuralFoil" in " ".join(map(str, said))
    assert any("estimating the polar of variant-" in text for text in told)
    made = bg.read(tmp_path / "made.yaml").stations[-1].airfoil
    assert made.polars[0].reynolds == 7e6
    assert made.polars[0].source.startswith("estimate: NeuralFoil")
    assert made.aerodynamic_center == 0.25
    assert_allclose(made.polars[0].alpha[[0, -1]], [-np.pi, np.pi])
    windio = pytest.importorskip("windIO")
    document, _ = load_yaml(tmp_path / "made.yaml")
    document["airfoils"] = document["airfoils"][::4]  # the schema is slow, and all are made alike
    windio.validate(document, "turbine/turbine_schema")


def entry(**changes):
    curve = {"grid": [-180.0, 0.0, 180.0], "values": [0.0, 1.0, 0.0]}
    row = {"re": 1e6, "cl": curve, "cd": curve, "cm": curve, "eta_e": 0.9}
    return {"polars": [{"re_sets": [{**row, **changes}]}]}


def test_curves_on_grids_of_their_own_are_brought_to_one():
    notes = Notes()
    fine = {"grid": [-180.0, -90.0, 0.0, 180.0], "values": [0.0, 0.2, 0.4, 0.0]}
    (made,) = read_polars(Node(entry(cd=fine), "a", notes))
    assert_allclose(np.degrees(made.alpha), fine["grid"])
    assert_allclose(made.cl, [0.0, 0.5, 1.0, 0.0])
    assert_allclose(made.cd, fine["values"])
    assert made.parameters == (("eta_e", 0.9),)
    assert made.configuration == "default"
    assert not notes.findings


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"cm": None}, "a.polars[0].re_sets[0].cm: is missing"),
        ({"cl": {"grid": [0.0, 1.0], "values": [1.0]}}, "cl: 2 angles and 1 values"),
        ({"cl": {"grid": [0.0, 0.0, 1.0], "values": [1.0, 1.0, 1.0]}}, "cl: angles must increase"),
        ({"re": "many"}, "re: got 'many'"),
        ({"eta_e": [1]}, "eta_e: got a list of 1"),
    ],
)
def test_polars_that_cannot_be_read_are_left_out_and_said(changes, said):
    notes = Notes()
    assert read_polars(Node(entry(**changes), "a", notes)) == ()
    assert not notes.problems
    assert said in str(notes.findings[0])
    assert "left out" in str(notes.findings[0])
