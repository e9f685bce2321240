"""Blade definitions: distributions keep their promises, bad values are refused by name."""

import csv
import dataclasses
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from bladegen.definition.blade_definition import (
    Airfoil,
    BladeDefinition,
    Distribution,
    ReferenceAxis,
    Station,
)
from bladegen.definition.by_thickness import stations_by_thickness
from bladegen.errors import DefinitionError
from bladegen.support.arrays import Array
from strategies import circle, ellipse

GOLDEN = Path(__file__).parent / "golden" / "dtu10mw"


def rows(table: str) -> list[dict[str, str]]:
    with (GOLDEN / f"{table}.csv").open(newline="") as stream:
        return list(csv.DictReader(stream))


@st.composite
def tables(draw: st.DrawFn) -> tuple[Array, Array]:
    """A grid within [0, 1] and values on it."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    count = draw(st.integers(2, 30))
    steps = rng.uniform(0.1, 1.0, count + 1)
    grid = np.cumsum(steps)[:-1] / np.sum(steps)
    if draw(st.booleans()):
        grid = (grid - grid[0]) / (grid[-1] - grid[0])
    return grid, rng.normal(size=count) * 10.0 ** draw(st.integers(-3, 3))


@given(tables())
def test_a_distribution_passes_through_its_points(table):
    grid, values = table
    assert_allclose(Distribution(grid, values)(grid), values, rtol=0, atol=1e-12 * np.ptp(values))


@given(tables(), st.booleans())
def test_monotone_values_stay_monotone(table, falling):
    grid, values = table
    values = np.sort(values)[:: -1 if falling else 1]
    dense = Distribution(grid, values)(np.linspace(0, 1, 500))
    steps = np.diff(dense) * (-1 if falling else 1)
    assert steps.min() >= -1e-12 * np.ptp(values)


@given(tables())
def test_a_distribution_stays_between_its_neighbours(table):
    grid, values = table
    inside = np.linspace(grid[0], grid[-1], 300)
    i = np.clip(np.searchsorted(grid, inside, side="right") - 1, 0, len(grid) - 2)
    low, high = np.minimum(values[i], values[i + 1]), np.maximum(values[i], values[i + 1])
    result, slack = Distribution(grid, values)(inside), 1e-12 * np.ptp(values)
    assert np.all((low - slack <= result) & (result <= high + slack))


@given(tables(), st.floats(-1, 2))
def test_ends_are_held_and_level(table, eta):
    grid, values = table
    quantity = Distribution(grid, values)
    if not grid[0] <= eta <= grid[-1]:
        assert_allclose(quantity(eta), values[0] if eta < grid[0] else values[-1], rtol=1e-12)
        assert quantity(eta, nu=1) == 0


@given(tables())
def test_a_batch_equals_its_parts_and_inputs_are_left_alone(table):
    grid, values = table
    before = grid.copy(), values.copy()
    quantity = Distribution(grid, values)
    eta = np.linspace(-0.1, 1.1, 24).reshape(2, 3, 4)
    assert_array_equal(quantity(eta).ravel(), [quantity(one) for one in eta.ravel()])
    assert_array_equal(grid, before[0])
    assert_array_equal(values, before[1])
    assert not quantity.grid.flags.writeable
    grid[:] = 0
    assert quantity.grid[-1] > 0


def test_derivatives_agree_with_differences():
    quantity = Distribution([0.0, 0.3, 0.7, 1.0], [1.0, 2.0, 1.5, 0.2])
    eta, h = np.linspace(0.01, 0.99, 37), 1e-6
    difference = (quantity(eta + h) - quantity(eta - h)) / (2 * h)
    assert_allclose(quantity(eta, nu=1), difference, atol=1e-4)


def test_denormal_steps_are_no_steps():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        values = Distribution([0.0, 0.3, 0.6, 1.0], [0.0, 5e-324, 1e-323, 1.0])([0.1, 0.5, 0.9])
    assert np.all((values >= 0.0) & (values <= 1.0))


def test_a_constant_and_a_spline_of_ones_own():
    assert_array_equal(Distribution.constant(3.5)([0.0, 0.4, 1.0]), [3.5, 3.5, 3.5])

    def steps(grid, values):
        return lambda eta, nu=0: values[np.searchsorted(grid, eta, side="right") - 1]

    quantity = Distribution([0.0, 0.5, 1.0], [1.0, 2.0, 3.0], spline=steps)
    assert_array_equal(quantity([0.0, 0.49, 0.5, 1.0]), [1.0, 1.0, 2.0, 3.0])


@pytest.mark.parametrize(
    ("grid", "values", "said"),
    [
        ([0.0, 1.0], [1.0], "one length, got 2 and 1"),
        ([[0.0, 1.0]], [[1.0, 2.0]], "one length"),
        ([0.5], [1.0], "1 grid points, at least 2 are needed"),
        ([0.0, np.nan], [1.0, 2.0], r"grid\[1\] is nan, must be finite"),
        ([0.0, 1.0], [1.0, np.inf], r"values\[1\] is inf, must be finite"),
        ([0.0, 1.1], [1.0, 2.0], "grid runs 0 to 1.1, allowed is 0 to 1"),
        ([-0.1, 1.0], [1.0, 2.0], "grid runs -0.1 to 1, allowed is 0 to 1"),
        ([0.0, 0.6, 0.5, 1.0], [1.0] * 4, r"got 0.6 then 0.5 \(entries 1 and 2\)"),
        ([0.0, 0.5, 0.5, 1.0], [1.0] * 4, r"got 0.5 then 0.5 \(entries 1 and 2\)"),
        ([0.0, 1e-300, 1.0], [0.0, 1.0, 2.0], r"must not jump, got 0 at 0 and 1 only 1e-300 on"),
        ([0.0, 0.5, 1.0], [-1e308, 1e308, 0.0], "must not jump"),
    ],
)
def test_a_bad_distribution_is_refused(grid, values, said):
    with pytest.raises(DefinitionError, match=said):
        Distribution(grid, values)


@pytest.mark.parametrize(
    ("coordinates", "said"),
    [
        (np.zeros((5, 3)), r"'a': coordinates must be rows of x and y, got shape \(5, 3\)"),
        (np.zeros(6), r"got shape \(6,\)"),
        (np.zeros((2, 2)), "'a': 2 points, allowed are 3 to 5000"),
        (np.zeros((5001, 2)), "'a': 5001 points, allowed are 3 to 5000"),
        ([[1.0, 0.0], [0.0, np.nan], [1.0, 0.0]], r"'a': point 1 is \(0.0, nan\), must be finite"),
    ],
)
def test_a_bad_airfoil_is_refused(coordinates, said):
    with pytest.raises(DefinitionError, match=said):
        Airfoil("a", coordinates)


def definition(**changes) -> BladeDefinition:
    line = Distribution.constant(0.0)
    parts = {
        "name": "small",
        "stations": (
            Station(0.0, Airfoil("circle", circle())),
            Station(1.0, Airfoil("thin", ellipse(0.2))),
        ),
        "chord": Distribution([0.0, 1.0], [2.0, 1.0]),
        "twist": line,
        "axis": ReferenceAxis(line, line, Distribution([0.0, 1.0], [0.5, 20.5])),
        "pitch_axis": Distribution([0.0, 1.0], [0.5, 0.25]),
    }
    return BladeDefinition(**{**parts, **changes})


def test_offsets_of_either_kind():
    by_fraction = definition()
    assert_allclose(by_fraction.offset_y([0.0, 1.0]), [1.0, 0.25])
    assert_array_equal(by_fraction.offset_x(np.zeros((2, 3))), np.zeros((2, 3)))
    by_length = definition(
        pitch_axis=None,
        section_offset_y=Distribution([0.0, 1.0], [1.0, 0.25]),
        section_offset_x=Distribution.constant(0.1),
    )
    assert_allclose(by_length.offset_y([0.0, 1.0]), [1.0, 0.25])
    assert_allclose(by_length.offset_x([0.0, 1.0]), [0.1, 0.1])


def test_length_and_axis():
    blade = definition()
    assert blade.length == 20.0
    assert blade.axis(np.zeros((4, 5))).shape == (4, 5, 3)
    assert_allclose(blade.axis([0.0, 0.5, 1.0]), [[0, 0, 0.5], [0, 0, 10.5], [0, 0, 20.5]])
    assert_allclose(blade.axis(0.3, nu=1), [0, 0, 20])


def test_a_definition_is_frozen():
    with pytest.raises(dataclasses.FrozenInstanceError):
        definition().name = "other"


AIRFOIL = Airfoil("circle", circle())
LINE = Distribution.constant(0.0)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"stations": (Station(0.0, AIRFOIL),)}, "small: 1 stations, at least 2 are needed"),
        (
            {"stations": tuple(Station(eta, AIRFOIL) for eta in (0.0, 0.5, 0.5))},
            "stations must increase strictly within 0 to 1, got 0, 0.5, 0.5",
        ),
        (
            {"stations": tuple(Station(eta, AIRFOIL) for eta in (0.0, 1e-300, 1.0))},
            "stations must increase strictly within 0 to 1, got 0, 1e-300, 1",
        ),
        (
            {"stations": (Station(0.0, AIRFOIL), Station(1.2, AIRFOIL))},
            "strictly within 0 to 1, got 0, 1.2",
        ),
        ({"stations": (Station(-0.1, AIRFOIL), Station(1.0, AIRFOIL))}, "got -0.1, 1"),
        ({"stations": (Station(np.nan, AIRFOIL), Station(1.0, AIRFOIL))}, "got nan, 1"),
        ({"pitch_axis": None}, "exactly one of section_offset_y and pitch_axis"),
        ({"section_offset_y": LINE}, "exactly one of section_offset_y and pitch_axis"),
        (
            {"chord": Distribution([0.0, 0.5, 1.0], [1.0, -2.0, 1.0])},
            r"chord must be positive, at least 1e-06 m, got -2 at eta = 0.5 \(entry 1\)",
        ),
        ({"chord": Distribution([0.0, 1.0], [2.0, 5e-324])}, "at least 1e-06 m, got 4.94066e-324"),
        (
            {"relative_thickness": LINE},
            "relative_thickness must be positive, at least 1e-06 of chord, got 0",
        ),
        (
            {"axis": ReferenceAxis(LINE, LINE, Distribution([0.0, 0.4, 1.0], [0.0, 5.0, 4.0]))},
            "z must increase from root to tip, got 5 then 4 m at eta = 0.4 and 1",
        ),
        (
            {"axis": ReferenceAxis(LINE, LINE, Distribution([0.0, 0.4, 1.0], [0, 1e-320, 4.0]))},
            "z must increase from root to tip, got 0 then",
        ),
    ],
)
def test_a_bad_definition_is_refused(changes, said):
    with pytest.raises(DefinitionError, match=said):
        definition(**changes)


def test_the_dtu_10_mw_stations_stand_where_its_thickness_meets_its_airfoils():
    spanwise = rows("spanwise")
    rthick = Distribution(
        [float(row["span_fraction"]) for row in spanwise],
        [float(row["rthick_percent"]) / 100 for row in spanwise],
    )
    airfoils = [
        (float(row["nominal_relative_thickness"]), Airfoil(row["airfoil"], circle()))
        for row in rows("airfoil_list")
        if row["in_schedule"] == "yes"
    ]
    stations = stations_by_thickness(airfoils, rthick)
    published = rows("airfoil_schedule")
    del published[1]  # the second cylinder comes from another table
    assert [s.airfoil.name for s in stations] == [row["airfoil"] for row in published]
    positions = [float(row["span_fraction"]) for row in published]
    assert_allclose([s.eta for s in stations], positions, atol=1e-9, rtol=0)


@given(st.floats(-5e-5, 5e-5), st.booleans())
def test_ripples_and_ends_are_met(ripple, held):
    """The thickest and thinnest airfoils may differ from the ends by a ripple, not by more."""
    grid = [0.1, 0.3, 0.7, 0.9] if held else [0.0, 0.3, 0.7, 1.0]
    rthick = Distribution(grid, [0.9, 0.5, 0.3 + ripple, 0.3])
    airfoils = [(t, Airfoil(f"{t}", ellipse(t))) for t in (0.3, 0.9 + ripple, 0.5)]
    stations = stations_by_thickness(airfoils, rthick)
    names = [station.airfoil.name for station in stations]
    assert list(dict.fromkeys(names)) == [f"{0.9 + ripple}", "0.5", "0.3"]
    assert stations[names.index("0.5")].eta == pytest.approx(0.3, abs=1e-9)
    assert (stations[0].eta, stations[-1].eta) == (0.0, 1.0)


@pytest.mark.parametrize("thickness", [0.2, 0.95])
def test_an_airfoil_that_the_thickness_does_not_meet_is_refused(thickness):
    rthick = Distribution([0.0, 1.0], [0.9, 0.3])
    with pytest.raises(DefinitionError, match=f"{thickness:g} is not met .* from 0.9 to 0.3"):
        stations_by_thickness([(thickness, AIRFOIL), (0.5, AIRFOIL)], rthick)
