import copy
import pickle
from dataclasses import replace

import numpy as np
import pytest

import bladegen as bg
from bladegen.exports.options import Options
from bladegen.exports.provenance import fingerprint
from bladegen.support.values import equal, hashed
from bladegen.surface import mesh
from bladegen.surface.grids import grid

SPACE = bg.ShapeSpace.bundled()
DEFINITION = bg.read("iea15mw")
BLADE = bg.Blade.from_definition(DEFINITION, landmarks=101)
STATION = DEFINITION.stations[-1]
VALUES = {
    "airfoil": STATION.airfoil,
    "station": STATION,
    "distribution": DEFINITION.chord,
    "axis": DEFINITION.axis,
    "rotor": DEFINITION.rotor,
    "definition": DEFINITION,
    "faded": BLADE.perturbed(twist=0.01).definition,
    "constant": bg.Coordinates.constant([0.1, 0.0, 0.0, 0.0]),
    "knots": bg.Coordinates([0.4, 0.6], np.zeros((2, 4))),
    "window": bg.Window(0.1, 0.3),
    "finding": bg.Finding("chord", "looks odd"),
    "space": SPACE,
    "deformation": BLADE.perturbed(SPACE, [0.01, 0.0, 0.0, 0.0]).deformations[0],
    "options": Options(),
}
MADE = {
    "blade": BLADE,
    "variant": BLADE.perturbed(SPACE, [0.01, 0.0, 0.0, 0.0], thickness=1.02),
    "family": bg.family(BLADE, SPACE, count=3),
    "design": bg.family(BLADE, SPACE, count=3).design,
    "factors": bg.family(BLADE, SPACE, count=3).design.what,
    "shape": BLADE.shape,
    "planform": BLADE.planform,
    "frames": BLADE.planform.frames,
    "path": BLADE.shape_path,
    "splines": BLADE.splines,
    "contour": BLADE.contours[0],
    "mesh": mesh.from_blade(BLADE, stations=20),
    "grid": grid.from_blade(BLADE, grid.Spacing(around=65, along=33)),
    "spacing": grid.Spacing(),
}
EACH = pytest.mark.parametrize("name", VALUES)


@EACH
def test_equal_values_are_equal_and_have_one_hash(name):
    value = VALUES[name]
    twin = pickle.loads(pickle.dumps(value))
    assert twin == value
    assert twin is not value
    assert hash(twin) == hash(value)
    assert len({value, twin}) == 1
    assert value != object()


def test_files_that_are_read_twice_are_equal_and_fingerprints_tell_the_same():
    again = bg.read("iea15mw")
    assert again == DEFINITION
    assert fingerprint(again) == fingerprint(DEFINITION)


@pytest.mark.parametrize(
    "change",
    [
        {"name": "other"},
        {"chord": bg.Distribution.constant(3.0)},
        {"stations": (*DEFINITION.stations[:-1], bg.Station(0.99, STATION.airfoil))},
        {"relative_thickness": None},
    ],
    ids=str,
)
def test_values_that_differ_in_a_field_are_not_equal(change):
    assert replace(DEFINITION, **change) != DEFINITION


def test_what_was_computed_counts_in_no_comparison():
    one, two = (bg.Distribution([0.0, 1.0], [2.0, 1.0]) for _ in range(2))
    one(0.5)
    assert one == two
    assert hash(one) == hash(two)
    assert one != bg.Distribution([0.0, 1.0], [2.0, 1.5])
    assert bg.Distribution([0.0, 1.0], [0.0, 1.0]) == bg.Distribution([-0.0, 1.0], [-0.0, 1.0])
    assert hash(bg.Distribution([0.0, 1.0], [0.0, 1.0])) == hash(
        bg.Distribution([-0.0, 1.0], [-0.0, 1.0])
    )


def test_perturbing_twice_alike_gives_equal_definitions():
    asked = {"twist": 0.01, "chord": 1.02, "prebend_scale": 1.1}
    assert BLADE.perturbed(**asked).definition == BLADE.perturbed(**asked).definition
    assert BLADE.perturbed(**asked).definition != BLADE.perturbed(twist=0.01).definition


def test_stations_given_as_a_list_become_a_tuple():
    definition = replace(DEFINITION, stations=list(DEFINITION.stations))
    assert definition == DEFINITION
    assert hash(definition) == hash(DEFINITION)


@pytest.mark.parametrize("name", [*VALUES, *MADE])
def test_every_value_is_shown_in_one_short_line(name):
    shown = repr((VALUES | MADE)[name])
    assert type((VALUES | MADE)[name]).__name__ in shown
    assert len(shown) < 300
    assert shown.isprintable()


def test_names_act_on_no_terminal():
    airfoil = replace(STATION.airfoil, name="foil\x1b[31m\nx")
    definition = replace(DEFINITION, name="blade\x1b[31m\nx")
    for value in (airfoil, definition, bg.Station(0.5, airfoil)):
        assert repr(value).isprintable()


def test_what_is_said_is_what_there_is():
    assert repr(STATION.airfoil) == "<Airfoil FFA-W3-211: 200 points, 21.1 % thick>"
    assert repr(bg.Coordinates.constant([0.1, -0.02])) == "<Coordinates t = 0.1, -0.02>"
    assert repr(Options(unit="mm")) == "Options(unit='mm')"
    assert repr(DEFINITION).startswith("<BladeDefinition iea15mw: 117.0 m, 10 stations, 8 airfoils")


def test_other_kinds_are_not_compared():
    assert equal(DEFINITION.chord, 1.0) is NotImplemented
    assert hashed(DEFINITION.chord) == hashed(copy.deepcopy(DEFINITION.chord))
