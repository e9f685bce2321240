from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.definition.blade_definition import Airfoil, Distribution, Station, pchip
from bladegen.formats import writing
from bladegen.measures.checks import check_blade
from bladegen.measures.inflections import DEPTH, bends, inflections
from strategies import naca

GRID = np.linspace(0.0, 1.0, 401)
WIDTHS = (0.02, 0.03, 0.06, 0.07)  # of flatbacks over span, in chords


@given(st.floats(0.01, 1.0), st.floats(-3.0, 3.0), st.floats(-1.0, 1.0))
def test_a_wave_bends_as_often_as_it_does_and_lines_do_not_count(depth, slope, shift):
    wave = depth * np.cos(4.0 * np.pi * GRID) + slope * GRID + shift
    found = bends(GRID, wave, 0.1 * depth)
    assert [sense for *_, sense, _ in found] == [-1, 1, -1, 1, -1]
    inflections_at = [GRID[first] for first, *_ in found[1:]]
    assert_allclose(inflections_at, [0.125, 0.375, 0.625, 0.875], atol=0.01)
    assert bends(GRID, wave, 3.0 * depth) == []


@pytest.mark.parametrize(("seed", "depth"), [(1, 0.01), (2, 1.0), (3, 0.1)])
def test_noise_bends_nothing(seed, depth):
    noise = 0.02 * depth * np.random.default_rng(seed).uniform(-1.0, 1.0, len(GRID))
    found = bends(GRID, depth * GRID**2 + noise, 0.1 * depth)
    assert [sense for *_, sense, _ in found] == [1]


def flatback(definition, widths=WIDTHS):
    """One airfoil all along but for its edge's width."""
    places = np.linspace(0.0, 1.0, len(widths))
    foils = [Airfoil(f"foil{i}", naca(0.3, 0.02, width)) for i, width in enumerate(widths)]
    return replace(
        definition,
        stations=tuple(Station(float(e), f) for e, f in zip(places, foils, strict=True)),
        relative_thickness=Distribution.constant(0.3),
    )


def dented(knots, values):
    """A spline of widths with a dent in the middle."""
    spline, middle = pchip(knots, values), 0.5 * (knots[1] + knots[2])
    reach = 0.3 * (knots[2] - knots[1])

    def widths(q, nu=0):
        away = np.clip((np.asarray(q) - middle) / reach, -1.0, 1.0)
        return spline(q, nu) - 0.02 * (1.0 - away**2) ** 2

    return widths


@pytest.mark.parametrize("path", ["geodesic", "spline"])
def test_a_dent_is_found_where_it_is_and_no_other(path):
    blade = bg.Blade.from_definition(flatback(bg.read("dtu10mw")), landmarks=101, path=path)
    assert inflections(blade) == []
    found = inflections(replace(blade, edge_width=dented))
    assert found[0].quantity == "trailing edge's width"
    for one in found:
        assert 1.0 / 3.0 < one.eta < 2.0 / 3.0
        assert one.depth > DEPTH


def test_findings_say_what_and_where():
    made = bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101)
    made = replace(made, edge_width=dented)
    findings = check_blade(made).figures["findings"]
    assert any("edge's width has an inflection over span" in text for text in findings)


def test_a_bend_that_lies_elsewhere_is_no_other_bend():
    """The definition's own inflection is not told of where its path only moves it."""
    blade = bg.Blade.from_definition(flatback(bg.read("dtu10mw")), landmarks=101)

    def moved(knots, values):
        spline = pchip(knots, values)
        return lambda q, nu=0: spline(np.clip(np.asarray(q) ** 1.1, knots[0], knots[-1]), nu)

    assert inflections(replace(blade, edge_width=moved)) == []


@pytest.mark.parametrize(
    "name",
    ["iea15mw", *(pytest.param(n, marks=pytest.mark.nightly) for n in ("dtu10mw", "nrel5mw"))],
)
def test_a_converted_copy_has_no_inflection_that_its_source_has_not(name, tmp_path):
    """OpenFAST's files have a station at every node; the sources have no inflection."""
    writing.write(bg.read(name), tmp_path / "copy.dat", format="openfast")
    assert inflections(bg.Blade.from_definition(bg.read(tmp_path / "copy.dat"))) == []
