"""Redefinition: a definition that files can hold gives the perturbed blade again."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.airfoils.landmarks import contour
from bladegen.airfoils.polars import Polar
from bladegen.definition.blade_definition import Distribution, Station
from bladegen.formats.common import redefinition
from bladegen.formats.common.redefinition import redefined, sampled

T = (0.06, -0.05, 0.03, 0.02)


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("nrel5mw"))


def test_an_unperturbed_blade_is_its_definition(blade):
    assert redefined(blade) is blade.definition


@given(st.floats(0.5, 3.0), st.floats(1e-6, 1e-3))
def test_sampling_keeps_its_tolerance(speed, tolerance):
    def wave(eta):
        return np.sin(speed * np.pi * eta)

    made = sampled(wave, np.array([0.0, 1.0]), tolerance)
    eta = np.linspace(0.0, 1.0, 3001)
    assert np.max(np.abs(made(eta) - wave(eta))) < 1.5 * tolerance


def distance(wanted, got):
    """From points (k, n, 3) to the polylines through `wanted`, both [m]."""
    start, along = wanted[:, None, :-1], np.diff(wanted, axis=1)[:, None]
    to = got[:, :, None] - start
    square = np.maximum(np.sum(along**2, axis=-1), 1e-30)
    at = np.clip(np.sum(to * along, axis=-1) / square, 0.0, 1.0)
    return np.min(np.linalg.norm(to - at[..., None] * along, axis=-1), axis=-1)


@pytest.mark.parametrize(
    "change",
    [
        {"t": T, "space": True},
        pytest.param(
            {"thickness": 1.1, "camber": 1.03, "chord": 1.05, "twist": 0.05, "prebend_scale": 1.2},
            marks=pytest.mark.nightly,
        ),
        {"t": (0.02, 0.02, 0.0, 0.0), "space": True, "thickness": 0.95, "chord_scale": 1.1},
    ],
)
def test_the_definition_of_a_perturbed_blade_gives_it_again(blade, change):
    change = dict(change)
    space = bg.ShapeSpace.bundled() if change.pop("space", False) else None
    variant = blade.perturbed(space, change.pop("t", ()), **change, name="variant")
    definition = redefined(variant, tolerance=2e-3)
    again = bg.Blade.from_definition(definition)
    assert again.name == "variant"
    eta = np.linspace(0.0, 1.0, 41)
    got, wanted = again.sections(eta)[:, ::4], variant.sections(eta)
    assert distance(wanted, got).max() < 2e-3
    assert np.diff([station.eta for station in definition.stations]).min() >= 5e-4
    assert_allclose(again.chord(eta), variant.chord(eta), rtol=0, atol=2e-4)
    assert "stations" in definition.findings[-1].message
    root = definition.stations[0].airfoil
    assert root is blade.definition.stations[0].airfoil  # the window leaves round roots alone
    for station in definition.stations:
        if station.airfoil.name.startswith("variant-"):
            own = contour(station.airfoil.coordinates).landmarks(again.u)
            shape = variant.profiles(station.eta)
            wanted = contour(shape - [shape[:, 0].min(), 0.0]).landmarks(again.u)
            assert station.airfoil.coordinates[:, 0].min() == 0.0
            assert_allclose(own, wanted, rtol=0, atol=2e-6)


def test_without_a_thickness_distribution_the_airfoils_own_carries_it(blade):
    plain = bg.Blade.from_definition(replace(blade.definition, relative_thickness=None))
    variant = plain.perturbed(thickness=1.1)
    definition = redefined(variant, tolerance=2e-3)
    assert definition.relative_thickness is not None
    again = bg.Blade.from_definition(definition)
    eta = np.linspace(0.0, 1.0, 31)
    assert distance(variant.sections(eta), again.sections(eta)[:, ::4]).max() < 3e-3


def test_a_pitch_axis_takes_the_noses_too_and_tolerances_end_somewhere(blade, monkeypatch):
    from bladegen.formats.common import redefinition

    centred = replace(
        blade.definition, pitch_axis=Distribution.constant(0.35), section_offset_y=None
    )
    plain = bg.Blade.from_definition(centred)
    space = bg.ShapeSpace.bundled()
    variant = plain.perturbed(space, (-0.04, 0.06, -0.02, 0.03), chord_line="paper")
    definition = redefined(variant, tolerance=5e-3)
    assert definition.section_offset_y is None
    again = bg.Blade.from_definition(definition)
    eta = np.linspace(0.0, 1.0, 31)
    assert distance(variant.sections(eta), again.sections(eta)[:, ::4]).max() < 7e-3
    assert abs(definition.pitch_axis(1.0) - 0.35) > 1e-3  # the nose has moved
    monkeypatch.setattr(redefinition, "MOST_STATIONS", 10)
    coarse = redefined(variant, tolerance=1e-6)
    assert len(coarse.stations) <= 10
    left = coarse.findings[-1].message.partition("where they are up to ")[2]
    assert float(left.split()[0]) > 1e-3  # mm, and it says so


def test_a_variant_blends_the_polars_of_its_baseline_by_thickness(blade):
    alpha = np.array([-np.pi, 0.0, np.pi])

    def known(station, k):
        lift = Polar(alpha, np.array([0.0, float(k), 0.0]), 0 * alpha, 0 * alpha)
        return Station(station.eta, replace(station.airfoil, polars=(lift,)))

    definition = blade.definition
    stations = tuple(known(station, k) for k, station in enumerate(definition.stations))
    for thickness in (definition.relative_thickness, None):
        base = replace(definition, stations=stations, relative_thickness=thickness)
        variant = bg.Blade.from_definition(base).perturbed(thickness=1.02, name="v")
        made = redefined(variant, tolerance=5e-3).stations
        etas = [station.eta for station in stations]
        for station in made:
            (polar,) = station.airfoil.polars
            place = np.interp(station.eta, etas, np.arange(len(etas)))
            assert np.floor(place) - 1e-9 <= polar.cl[1] <= np.ceil(place) + 1e-9
            if station.airfoil.name.startswith("v-"):
                assert polar.is_borrowed


@given(st.floats(-0.02, 0.02), st.floats(-1e-3, 1e-3))
def test_a_point_that_slid_along_a_blunt_nose_has_not_left_it(slid, apart):
    angle = np.linspace(0.0, np.pi, 201)
    nose = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    moved = (1.0 + apart) * np.stack([np.cos(angle + slid), np.sin(angle + slid)], axis=-1)
    off = redefinition._from_curve(nose, moved - nose)
    assert_allclose(off[2:-2], abs(apart), rtol=0, atol=3e-5)


def test_the_centre_of_forces_moves_evenly_between_airfoils(blade):
    definition = blade.definition
    ends = (0.5, 0.25)
    stations = tuple(
        replace(
            station,
            airfoil=replace(station.airfoil, aerodynamic_center=ends[station.eta > 0.15]),
        )
        for station in definition.stations
    )
    base = replace(definition, stations=stations)
    variant = bg.Blade.from_definition(base).perturbed(thickness=1.02, name="v")
    centres = [s.airfoil.aerodynamic_center for s in redefined(variant, tolerance=1e-3).stations]
    assert np.all(np.diff(centres) <= 0)
    assert len(set(centres)) > 4


def test_what_is_left_is_said_with_its_place():
    eta = np.array([0.0, 0.5, 0.501, 1.0])
    said = redefinition._left(np.array([4e-4, 3e-3, 2e-4]), eta, 5e-4)
    assert said == (
        "sections between stations within 0.5 mm (at most 0.4) but over 0.1 % of the span, where "
        "they are up to 3 mm off (eta = 0.5000 to 0.5010)"
    )
    assert redefinition._left(np.array([4e-4, 1e-4, 2e-4]), eta, 5e-4) == (
        "sections between stations within 0.4 mm"
    )
    assert "but over 1e+02 % of the span" in redefinition._left(np.full(3, 1.0), eta, 5e-4)
