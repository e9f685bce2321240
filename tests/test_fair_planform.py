"""A fair planform is C2, as near to the given one as it says, and none so near is fairer."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.cli.options.fairing import planform_fairing
from bladegen.definition.distribution import Distribution, cubic_spline, pchip
from bladegen.definition.fair_planform import fair_planform, faired
from bladegen.errors import BladegenError, DefinitionError
from bladegen.exports.provenance import blade_settings
from bladegen.formats.common.redefinition import TOLERANCE, redefined
from strategies import by_day, definitions, few

FAIRING = bg.PlanformFairing()
SPANS = np.linspace(0.0, 1.0, 4001)
BOUND = 1e-3


@pytest.fixture(scope="module", params=by_day("iea15mw"))
def pair(request):
    definition = bg.read(request.param)
    return definition, fair_planform(definition, FAIRING)


def quantities(definition):
    """Distributions by name, those that are not given left out."""
    names = ("chord", "twist", "section_offset_y", "pitch_axis", "relative_thickness")
    found = {name: getattr(definition, name) for name in names}
    found |= {name: getattr(definition.axis, name) for name in "xyz"}
    return {name: one for name, one in found.items() if one is not None}


def jumps(quantity):
    """Jumps of the second derivative at the inner points of a distribution's grid."""
    inner, step = quantity.grid[1:-1], 1e-3 * np.diff(quantity.grid).min()
    after, before = (quantity(inner + side * step, 2) for side in (1.0, -1.0))
    thirds = [np.abs(quantity(inner + side * step, 3)) for side in (1.0, -1.0)]
    return np.abs(after - before) - 2.0 * step * np.maximum(*thirds)


def test_a_fair_planform_lies_as_near_as_it_says_at_points_and_between(pair):
    definition, fair = pair
    chord = definition.chord(SPANS)
    bounds = {"twist": FAIRING.twist, "pitch_axis": BOUND, "relative_thickness": BOUND}
    for name, quantity in quantities(definition).items():
        off = np.abs(quantities(fair)[name](SPANS) - quantity(SPANS))
        assert np.all(off <= 1.02 * bounds.get(name, BOUND * chord)), name


def test_curvature_does_not_jump_and_varies_less(pair):
    definition, fair = pair
    for name, quantity in quantities(definition).items():
        made = quantities(fair)[name]
        if made is quantity:  # a straight line
            assert_allclose(quantity(SPANS, 2), 0.0, atol=1e-6)
            continue
        middle = np.linspace(0.03, 0.95, 2001)
        size = np.abs(made(middle, 2)).max()
        assert jumps(made).max() < 1e-6 * size
        assert jumps(quantity).max() > 0.01 * size
        varied = [np.abs(np.diff(one(middle, 2))).sum() for one in (quantity, made)]
        assert varied[1] < 0.65 * varied[0], name


def test_what_must_stay_stays(pair):
    definition, fair = pair
    ends = np.array([0.0, 1.0])
    for name, quantity in quantities(definition).items():
        assert_allclose(quantities(fair)[name](ends), quantity(ends), atol=1e-12)
    stations = [station.eta for station in definition.stations]
    thickness = [one.relative_thickness(stations) for one in (definition, fair)]
    assert_allclose(*thickness, atol=1e-12)
    assert np.all(fair.axis(SPANS, 1)[:, 2] > 0.0)


def test_the_finding_says_by_how_much_it_moved(pair):
    definition, fair = pair
    said = str(fair.findings[-1])
    assert said.startswith("planform: faired within 0.1%,0.02deg: chord by at most ")
    moved = 1e3 * np.abs(fair.chord(SPANS) - definition.chord(SPANS)).max()
    figure = float(said.partition("chord by at most ")[2].partition(" mm")[0])
    assert_allclose(figure, moved, rtol=0.06)


@settings(deadline=None, max_examples=few(12))
@given(
    st.lists(st.floats(0.1, 1.0), min_size=1, max_size=12),
    st.lists(st.floats(-1.0, 1.0), min_size=13, max_size=13),
    st.floats(1e-3, 1e-1),
)
def test_any_distribution_is_held_and_no_knot_can_make_it_fairer_by_2_percent(steps, values, size):
    ends = np.insert(np.cumsum(steps), 0, 0.0)
    grid = ends / ends[-1]
    quantity = Distribution(grid, np.array(values[: len(grid)]))
    made = faired(quantity, lambda eta: np.full(eta.shape, size))
    assert np.abs(made(SPANS) - quantity(SPANS)).max() <= 1.02 * size
    if made is quantity:
        return

    def energy(at):
        third = cubic_spline(made.grid, at)(0.5 * (made.grid[1:] + made.grid[:-1]), nu=3)
        return np.sum(third**2 * np.diff(made.grid))

    least = energy(made.values)
    within = quantity(made.grid)
    for k in range(1, len(made.grid) - 1):
        for shift in (-0.05 * size, 0.05 * size):
            other = made.values.copy()
            other[k] += shift
            held = abs(other[k] - within[k]) <= 0.9 * size
            if held and quantity.values.min() <= other[k] <= quantity.values.max():
                assert energy(other) >= 0.98 * least


@settings(deadline=None, max_examples=few(10))
@given(definitions())
def test_any_definition_can_be_faired(definition):
    fair = fair_planform(definition, FAIRING)
    assert fair.stations == definition.stations
    off = np.abs(fair.chord(SPANS) - definition.chord(SPANS))
    assert np.all(off <= 1.02 * BOUND * definition.chord(SPANS))


def test_a_definition_without_thickness_gets_a_fair_one_of_its_airfoils():
    definition = replace(bg.read("nrel5mw"), relative_thickness=None)
    thickness = fair_planform(definition, FAIRING).relative_thickness
    assert thickness.spline is cubic_spline
    made = bg.Blade.from_definition(definition, landmarks=101, fair_planform=FAIRING)
    assert_allclose(made.definition.relative_thickness(SPANS), thickness(SPANS), atol=1e-12)


def test_a_blade_says_that_its_planform_was_made_fair():
    definition = bg.read("dtu10mw")
    made = bg.Blade.from_definition(definition, landmarks=101, fair_planform=FAIRING)
    assert made.fair_planform == FAIRING
    assert any("faired within" in str(finding) for finding in made.findings)
    assert blade_settings(made)["fair_planform"] == "0.1%,0.02deg"
    assert made.perturbed(twist=0.01).fair_planform == FAIRING
    plain = bg.Blade.from_definition(definition, landmarks=101)
    assert plain.fair_planform is None
    assert "fair_planform" not in blade_settings(plain)
    near = np.abs(made.sections(SPANS[::40]) - plain.sections(SPANS[::40]))
    assert 1e-3 < near.max() < 4.0 * BOUND * definition.chord.values.max()


def test_what_is_written_of_a_fair_planform_reads_as_the_same(tmp_path):
    made = bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101, fair_planform=FAIRING)
    for quantity in quantities(redefined(made)).values():
        assert quantity.spline is pchip
    bg.write(made, tmp_path / "fair.yaml")
    again = bg.Blade.from_definition(bg.read(tmp_path / "fair.yaml"), landmarks=101)
    spans = np.linspace(0.0, 1.0, 301)
    assert np.abs(again.sections(spans) - made.sections(spans)).max() < TOLERANCE


def test_bounds_as_they_are_typed():
    assert planform_fairing("off", "fair-planform") is None
    assert planform_fairing("0.1%", "fair-planform") == FAIRING
    made = planform_fairing("0.25%,0.5deg", "fair-planform")
    assert_allclose([made.chord, made.twist], [2.5e-3, np.radians(0.5)])
    assert str(made) == "0.25%,0.5deg"
    assert planform_fairing(str(FAIRING), "fair-planform") == FAIRING


@pytest.mark.parametrize("text", ["", "0.1", "on", "%", "0.1%,", "0.1%,wide", "nan%", "0.1%;1deg"])
def test_other_texts_are_refused(text):
    with pytest.raises(BladegenError, match=r"fair-planform: got .*must be"):
        planform_fairing(text, "fair-planform")


@pytest.mark.parametrize(
    ("how", "said"),
    [
        ({"chord": 0.0}, r"fair_planform: chord: got 0, allowed is more than 0 to 0.05"),
        ({"chord": 0.1}, r"fair_planform: chord: got 0.1"),
        ({"twist": 0.5}, r"fair_planform: twist: got 0.5"),
        ({"twist": "wide"}, r"fair_planform: twist"),
    ],
)
def test_bounds_that_no_fairing_has_are_refused(how, said):
    with pytest.raises(DefinitionError, match=said):
        bg.PlanformFairing(**how)
