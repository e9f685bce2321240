"""Readers: what real files hold, and what every kind of bad file is answered."""

import copy
import math
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import BladegenError, FileError
from bladegen.formats import reading
from bladegen.formats.common.document import Node, Notes, Range
from bladegen.formats.reading import BY_AIRFOILS
from bladegen.formats.windio import yaml_file
from strategies import circle, ellipse, few

DELETE = object()
SHAPE = "components.blade.outer_shape"
SHAPE_1 = "components.blade.outer_shape_bem"
AXIS = "components.blade.reference_axis"
Document = dict[str, Any]


def airfoil(name: str, points: np.ndarray, thickness: float) -> Document:
    coordinates = {"x": points[:, 0].tolist(), "y": points[:, 1].tolist()}
    return {"name": name, "rthick": thickness, "coordinates": coordinates}


def windio2() -> Document:
    """A small blade: a circle and two ellipses, a grid of its own for every quantity."""
    return {
        "windIO_version": "2.0",
        "name": "a small blade",
        "assembly": {"number_of_blades": 2, "rotor_diameter": 44.0},
        "components": {
            "hub": {"diameter": 2.0, "cone_angle": 3.0},
            "drivetrain": {"outer_shape": {"uptilt": 6.0}},
            "blade": {
                "reference_axis": {
                    "x": {"grid": [0.0, 0.5, 1.0], "values": [0.0, 0.1, -1.0]},
                    "y": {"grid": [0.0, 1.0], "values": [0.0, 0.0]},
                    "z": {"grid": [0.0, 1.0], "values": [0.0, 20.0]},
                },
                "outer_shape": {
                    "airfoils": [
                        {"name": "circle", "spanwise_position": 0.0},
                        {"name": "thick", "spanwise_position": 0.4},
                        {"name": "thin", "spanwise_position": 1.0},
                    ],
                    "chord": {"grid": [0.0, 0.2, 0.6, 1.0], "values": [1.0, 1.5, 1.2, 0.4]},
                    "twist": {"grid": [0.0, 0.3, 1.0], "values": [12.0, 9.0, -1.0]},
                    "section_offset_y": {
                        "grid": [0.0, 0.2, 0.6, 1.0],
                        "values": [0.5, 0.6, 0.36, 0.12],
                    },
                    "rthick": {"grid": [0.0, 0.4, 1.0], "values": [1.0, 0.5, 0.2]},
                },
            },
        },
        "airfoils": [
            airfoil("circle", circle(41), 1.0),
            airfoil("thick", ellipse(0.5, 61), 0.5),
            airfoil("thin", ellipse(0.2, 81), 0.2),
        ],
    }


def windio1() -> Document:
    """The same blade in windIO 1."""
    two = windio2()
    shape, blade = two["components"]["blade"]["outer_shape"], two["components"]["blade"]
    return {
        "name": "a small blade",
        "assembly": two["assembly"],
        "components": {
            "hub": {"diameter": 2.0, "cone_angle": math.radians(3.0)},
            "nacelle": {"drivetrain": {"uptilt": math.radians(6.0)}},
            "blade": {
                "outer_shape_bem": {
                    "airfoil_position": {
                        "grid": [item["spanwise_position"] for item in shape["airfoils"]],
                        "labels": [item["name"] for item in shape["airfoils"]],
                    },
                    "chord": shape["chord"],
                    "twist": {
                        "grid": shape["twist"]["grid"],
                        "values": [math.radians(angle) for angle in shape["twist"]["values"]],
                    },
                    "pitch_axis": {"grid": [0.0, 0.2, 0.6, 1.0], "values": [0.5, 0.4, 0.3, 0.3]},
                    "rthick": shape["rthick"],
                    "reference_axis": blade["reference_axis"],
                }
            },
        },
        "airfoils": [
            {
                "name": item["name"],
                "relative_thickness": item["rthick"],
                "coordinates": item["coordinates"],
            }
            for item in two["airfoils"]
        ],
    }


def steps(path: str) -> list[str | int]:
    return [int(step) if step.isdigit() else step for step in re.findall(r"[^.\[\]]+", path)]


def at(document: Any, path: str) -> Any:
    for step in steps(path):
        document = document[step]
    return document


def put(document: Any, path: str, value: Any) -> None:
    *way, last = steps(path)
    for step in way:
        document = document[step]
    if value is DELETE:
        del document[last]
    else:
        document[last] = value


def changed(document: Document, *changes: tuple[str, Any]) -> Document:
    document = copy.deepcopy(document)
    for path, value in changes:
        put(document, path, value)
    return document


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "blade.yaml"


def read(document: Any, path: Path) -> BladeDefinition:
    text = document if isinstance(document, bytes) else yaml.dump(document, Dumper=DUMPER).encode()
    path.write_bytes(text)
    return reading.read(path)


DUMPER = getattr(yaml, "CSafeDumper", yaml.SafeDumper)


def refusal(document: Any, path: Path) -> FileError:
    with pytest.raises(FileError) as raised:
        read(document, path)
    message = str(raised.value)
    assert "\n" not in message
    assert message.startswith(f"{path}: ")
    return raised.value


def findings(definition: BladeDefinition) -> str:
    return "\n".join(map(str, definition.findings))


# ---- what is read -----------------------------------------------------------------------------


def test_both_versions_of_windio_read_alike(path):
    one, two = read(windio1(), path), read(windio2(), path)
    assert one.findings == two.findings == ()
    assert one.pitch_axis is not None
    assert two.section_offset_y is not None
    for key in ("chord", "twist", "relative_thickness"):
        first, second = getattr(one, key), getattr(two, key)
        assert_array_equal(first.grid, second.grid)
        assert_allclose(first.values, second.values, rtol=4e-16)
    grid = two.section_offset_y.grid
    assert_allclose(one.offset_y(grid), two.offset_y(grid), rtol=1e-15)
    eta = np.linspace(0, 1, 11)
    assert_array_equal(one.axis(eta), two.axis(eta))
    assert_array_equal(one.offset_x(eta), np.zeros(11))
    for first, second in zip(one.stations, two.stations, strict=True):
        assert (first.eta, first.airfoil.name) == (second.eta, second.airfoil.name)
        assert first.airfoil.relative_thickness == second.airfoil.relative_thickness
        assert_array_equal(first.airfoil.coordinates, second.airfoil.coordinates)
    assert_allclose(one.rotor.cone, two.rotor.cone)
    assert_allclose(one.rotor.tilt, two.rotor.tilt)


def test_units_names_and_facts(path):
    definition = read(windio2(), path)
    assert (definition.name, definition.description) == ("blade", "a small blade")
    assert definition.source == str(path)
    assert_allclose(np.degrees(definition.twist.values), [12.0, 9.0, -1.0])
    rotor = definition.rotor
    assert (rotor.blades, rotor.hub_radius, rotor.diameter) == (2, 1.0, 44.0)
    assert_allclose([rotor.cone, rotor.tilt], np.radians([3.0, 6.0]))
    assert definition.length == 20.0


@pytest.mark.parametrize("within", ["hub", "hub.outer_shape_bem"])
@pytest.mark.parametrize("tilt", ["drivetrain.uptilt", "outer_shape_bem.uptilt_angle"])
def test_windio_1_keeps_hub_and_tilt_in_two_places(path, within, tilt):
    document = changed(
        windio1(),
        ("components.hub", DELETE),
        ("components.nacelle", DELETE),
    )
    for place, value in (
        (f"{within}.diameter", 5.0),
        (f"{within}.cone_angle", 0.04),
        (f"{within}.drag_coefficient", 0.5),
        (f"nacelle.{tilt}", 0.1),
    ):
        holder = document["components"]
        *keys, last = place.split(".")
        for key in keys:
            holder = holder.setdefault(key, {})
        holder[last] = value
    rotor = read(document, path).rotor
    assert (rotor.hub_radius, rotor.cone, rotor.tilt, rotor.hub_drag) == (2.5, 0.04, 0.1, 0.5)


def test_only_the_shape_is_needed(path):
    document = changed(
        windio2(),
        ("assembly", DELETE),
        ("components.hub", DELETE),
        ("components.drivetrain", DELETE),
        ("name", DELETE),
        ("windIO_version", DELETE),
        (f"{SHAPE}.rthick", DELETE),
        (f"{AXIS}.x", DELETE),
        (f"{AXIS}.y", None),
        *((f"airfoils[{i}].rthick", DELETE) for i in range(3)),
    )
    definition = read(document, path)
    assert definition.rotor == type(definition.rotor)()
    assert definition.relative_thickness is None
    assert definition.description == ""
    assert_array_equal(definition.axis([0.0, 1.0]), [[0, 0, 0], [0, 0, 20]])
    assert findings(definition).splitlines() == [
        f"{AXIS}: x is not given; taken as 0",
        f"{AXIS}: y is not given; taken as 0",
        str(BY_AIRFOILS),
    ]


def test_a_rotor_diameter_of_zero_is_not_stated(path):
    assert read(changed(windio2(), ("assembly.rotor_diameter", 0)), path).rotor.diameter is None


def test_section_offset_x_is_read(path):
    offset = {"grid": [0.0, 1.0], "values": [0.1, 0.3]}
    definition = read(changed(windio2(), (f"{SHAPE}.section_offset_x", offset)), path)
    assert_allclose(definition.offset_x([0.0, 0.5, 1.0]), [0.1, 0.2, 0.3])


def test_a_lofted_surface_is_passed_over_and_said(path):
    surface = {"grid": [0.0, 1.0], **{key: [[0.0, 1.0]] * 2 for key in "xyz"}}
    document = changed(windio2(), ("components.blade.outer_shape.surface", surface))
    assert "outer_shape.surface: is passed over" in findings(read(document, path))
    assert "surface" not in findings(read(windio2(), path))


def test_airfoils_outside_the_schedule_are_of_no_concern(path):
    document = windio2()
    document["airfoils"].append({"name": "unused", "coordinates": "broken"})
    document["airfoils"].append(copy.deepcopy(document["airfoils"][-1]))
    assert len(read(document, path).stations) == 3


@pytest.mark.parametrize("turned", [(), (0,), (1, 2), (0, 1, 2)])
def test_either_orientation_and_both_in_one_file(path, turned):
    document = windio2()
    for i in turned:
        for axis in "xy":
            document["airfoils"][i]["coordinates"][axis].reverse()
    definition = read(document, path)
    expected = at(document, "airfoils[1].coordinates.y")
    assert_array_equal(definition.stations[1].airfoil.coordinates[:, 1], expected)
    mixed = len(turned) in (1, 2)
    assert ("run both ways round" in findings(definition)) == mixed
    if mixed:
        names = ", ".join(("circle", "thick", "thin")[i] for i in turned)
        assert findings(definition).endswith(f"pressure side first in {names}")


def test_repeated_points_are_dropped_and_said(path):
    document = windio2()
    coordinates = document["airfoils"][1]["coordinates"]
    clean = {axis: list(values) for axis, values in coordinates.items()}
    for axis in "xy":
        coordinates[axis][5:5] = [coordinates[axis][5]] * 2
        coordinates[axis].append(coordinates[axis][-1])
    definition = read(document, path)
    assert findings(definition) == "airfoils[1].coordinates: 3 repeated points dropped"
    assert_array_equal(definition.stations[1].airfoil.coordinates[:, 0], clean["x"])
    assert_array_equal(definition.stations[1].airfoil.coordinates[:, 1], clean["y"])


def test_an_open_trailing_edge_stays_open(path):
    document = windio2()
    for axis in "xy":
        del document["airfoils"][2]["coordinates"][axis][0]
        document["airfoils"][2]["coordinates"][axis].pop()
    points = read(document, path).stations[2].airfoil.coordinates
    assert len(points) == 79
    assert np.any(points[0] != points[-1])


def test_a_trailing_edge_that_is_listed_once_is_closed_and_said(path):
    document = windio2()
    for axis in "xy":
        document["airfoils"][2]["coordinates"][axis].pop()
    definition = read(document, path)
    points = definition.stations[2].airfoil.coordinates
    assert len(points) == 81
    assert_array_equal(points[0], points[-1])
    assert "airfoils[2].coordinates: the edge point (1, 0) is listed once" in findings(definition)


def test_a_neighbour_that_stands_twice_is_taken_once(path):
    document = windio2()
    schedule = at(document, f"{SHAPE}.airfoils")
    schedule.insert(1, dict(schedule[1]))
    definition = read(document, path)
    assert [station.eta for station in definition.stations] == [0.0, 0.4, 1.0]
    assert "airfoils[2]: thick stands twice at 0.4; taken once" in findings(definition)


def test_identical_neighbours_at_different_stations_are_kept(path):
    document = windio2()
    at(document, f"{SHAPE}.airfoils").insert(1, {"name": "circle", "spanwise_position": 0.05})
    assert [s.eta for s in read(document, path).stations] == [0.0, 0.05, 0.4, 1.0]


def test_stations_are_held_to_root_and_tip(path):
    document = changed(
        windio2(),
        (f"{SHAPE}.airfoils[0].spanwise_position", 0.1),
        (f"{SHAPE}.airfoils[2].spanwise_position", 0.9),
    )
    definition = read(document, path)
    assert [(s.eta, s.airfoil.name) for s in definition.stations] == [
        (0.0, "circle"),
        (0.1, "circle"),
        (0.4, "thick"),
        (0.9, "thin"),
        (1.0, "thin"),
    ]
    assert "airfoils[0]: circle at 0.1 is held to the root" in findings(definition)
    assert "airfoils[2]: thin at 0.9 is held to the tip" in findings(definition)


def test_grids_that_end_early_hold_their_end_values(path):
    document = changed(windio2(), (f"{SHAPE}.chord.grid", [0.1, 0.2, 0.6, 0.9]))
    definition = read(document, path)
    assert_allclose(definition.chord([0.0, 1.0]), [1.0, 0.4])
    assert "chord: grid runs 0.1 to 0.9; beyond it the end value is held" in findings(definition)


def test_grids_that_leave_the_span_by_rounding_are_cut(path):
    document = changed(windio2(), (f"{SHAPE}.chord.grid", [-1e-17, 0.2, 0.6, 1.0000000002]))
    definition = read(document, path)
    assert_array_equal(definition.chord.grid, [0.0, 0.2, 0.6, 1.0])
    assert "chord.grid: leaves 0 to 1 by rounding; cut" in findings(definition)


def test_repeated_grid_entries_are_dropped_if_their_values_agree(path):
    chord = {"grid": [0.0, 0.5, 0.5, 1.0], "values": [1.0, 2.0, 2.0, 0.5]}
    definition = read(changed(windio2(), (f"{SHAPE}.chord", chord)), path)
    assert_array_equal(definition.chord.grid, [0.0, 0.5, 1.0])
    assert "chord: 1 repeated entries dropped" in findings(definition)


def test_airfoils_without_positions_stand_where_the_thickness_meets_theirs(path):
    document = changed(
        windio2(),
        *((f"{SHAPE}.airfoils[{i}].spanwise_position", DELETE) for i in range(3)),
        ("airfoils[1].rthick", DELETE),  # then its coordinates tell: 0.5 up to their spacing
    )
    stations = read(document, path).stations
    assert [s.airfoil.name for s in stations] == ["circle", "thick", "thin"]
    assert_allclose([s.eta for s in stations], [0.0, 0.4, 1.0], atol=2e-3)


def test_a_stated_thickness_that_is_off_by_more_than_a_percent_is_said(path):
    definition = read(changed(windio2(), ("airfoils[1].rthick", 0.48)), path)
    assert findings(definition) == (
        "airfoils[1].rthick: thick is stated 0.48 thick; its coordinates give 0.5"
    )


def test_contours_that_turn_back_in_x_are_read(path):
    """A blunt trailing edge with a corner behind x = 1, and a nose with a vertical piece."""
    document = windio2()
    x, y = (document["airfoils"][2]["coordinates"][axis] for axis in "xy")
    x[0], x[-1] = 0.999, 0.999
    y[0], y[-1] = 0.001, -0.001
    x[40:41], y[40:41] = [0.0, 0.0], [0.001, -0.001]
    assert len(read(document, path).stations[2].airfoil.coordinates) == 82


def test_numbers_are_those_of_yaml_1_2(path):
    text = yaml.dump(windio2(), Dumper=DUMPER)
    text = (
        text.replace("- 12.0", "- 1.2E1").replace("- 9.0", "- 9e+00").replace("- -1.0", "- -1e-3")
    )
    text = text.replace("- 20.0", "- 2e1").replace("- 0.4\n", "- .4\n").replace("- 0.36", "- 36E-2")
    definition = read(text.encode(), path)
    assert_allclose(np.degrees(definition.twist.values), [12.0, 9.0, -0.001])
    assert_array_equal(definition.axis.x.values, [0.0, 0.1, -0.001])
    assert definition.length == 20.0


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("5e-05", 5e-5),
        ("1E3", 1000.0),
        ("-1e-3", -0.001),
        ("+7", 7),
        ("-.5", -0.5),
        ("1.", 1.0),
        ("010", 10),
        ("1_000", "1_000"),
        ("1:30", "1:30"),
        ("2020-13-45", "2020-13-45"),
        ("no", "no"),
        ("true", True),
        ("~", None),
        ("", None),
        ("-.inf", -math.inf),
        ("'5'", "5"),
        ("!!str 5", "5"),
        ("!!float 5", 5),
        ("! 5", "5"),
        ("|-\n  5", "5"),
        ("[]", []),
        ("{}", {}),
        ("9" * 500, math.inf),
    ],
)
def test_scalars(text, value):
    (read_value,) = yaml_file.parse_yaml(f"a: {text}\n")[0].values()
    assert read_value == value
    assert type(read_value) is type(value)


def test_aliases_share_and_do_not_grow(path):
    levels = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    levels += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 40)]
    value, _ = yaml_file.parse_yaml("\n".join(levels))
    assert value["a39"][0] is value["a38"]
    assert "holds no blade that is known" in str(refusal("\n".join(levels).encode(), path))
    axis = "grid: [0, 1], values: [0, 0]"
    text = yaml.dump(windio2(), Dumper=DUMPER).encode() + f"spare: {{{axis}}}".encode()
    assert read(text, path).length == 20.0
    assert yaml_file.parse_yaml("a: &x 5\nb: *x")[0] == {"a": 5, "b": 5}


def test_a_key_given_twice_is_said(path):
    text = yaml.dump(windio2(), Dumper=DUMPER).encode() + b"name: again\n"
    definition = read(text, path)
    assert definition.description == "again"
    assert "key 'name' again; the last one holds" in findings(definition)
    assert str(definition.findings[0]).startswith("line ")


@pytest.mark.parametrize("suffix", [".yaml", ".yml", ".YAML", ".json"])
def test_suffixes(tmp_path, suffix):
    assert read(windio2(), tmp_path / f"blade{suffix}").name == "blade"


def test_every_turbine_of_windio_is_read():
    examples = pytest.importorskip("windIO.examples.turbine")
    home = Path(examples.__file__).parent
    for name, length in (("IEA-15-240-RWT", 117.0), ("IEA-22-280-RWT", 137.8)):
        definition = reading.read(home / f"{name}.yaml")
        assert_allclose(definition.length, length, rtol=1e-9)
    ours, theirs = reading.read("iea15mw"), reading.read(home / "IEA-15-240-RWT.yaml")
    assert_array_equal(ours.chord.values, theirs.chord.values)
    assert_array_equal(ours.twist.values, theirs.twist.values)
    eta = np.linspace(0, 1, 201)
    assert_allclose(ours.offset_y(eta), theirs.offset_y(eta), atol=2e-4)  # they went linearly


def test_without_libyaml_the_same_is_read(path, monkeypatch):
    document = windio2()
    fast = read(document, path)
    monkeypatch.setattr(yaml_file, "_LOADER", yaml.SafeLoader)
    slow = read(document, path)
    assert_array_equal(fast.chord.values, slow.chord.values)
    assert fast.rotor == slow.rotor


def test_reading_does_not_import_scipy():
    code = (
        "import sys; from bladegen.formats.reading import read; read('iea15mw');"
        "sys.exit('scipy' in sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=Path(reading.__file__).parents[2])


# ---- what is refused --------------------------------------------------------------------------

BAD_VALUES: list[tuple[str, str, Any, list[str]]] = [
    # name, place, value, what the message says
    ("chord negative", f"{SHAPE}.chord.values[3]", -1.2, ["-1.2", "1e-06 to 100 m"]),
    ("chord zero", f"{SHAPE}.chord.values[0]", 0, ["got 0", "1e-06 to 100 m"]),
    ("chord in millimetres", f"{SHAPE}.chord.values[1]", 1500.0, ["1500.0", "1e-06 to 100 m"]),
    ("chord as text", f"{SHAPE}.chord.values[2]", "wide", ["'wide'", "must be a number"]),
    ("quoted number", f"{SHAPE}.chord.values[2]", "1.5", ["'1.5'", "must be a number"]),
    ("boolean", f"{SHAPE}.chord.values[2]", True, ["True", "must be a number"]),
    ("null entry", f"{SHAPE}.chord.values[2]", None, ["nothing", "must be a number"]),
    ("nested list", f"{SHAPE}.chord.values[2]", [1.0, 2.0], ["a list of 2", "must be a number"]),
    ("mapping entry", f"{SHAPE}.chord.values[2]", {"a": 1}, ["a mapping of 1", "a number"]),
    ("not a number", f"{SHAPE}.chord.values[2]", math.nan, ["nan", "must be a number"]),
    ("infinite", f"{SHAPE}.chord.values[2]", math.inf, ["inf", "1e-06 to 100 m"]),
    ("huge integer", f"{SHAPE}.chord.values[2]", 10**390, ["1000", "1e-06 to 100 m"]),
    ("text for a list", f"{SHAPE}.chord.values", "1, 2", ["'1, 2'", "must be a list"]),
    ("number for a list", f"{SHAPE}.chord.grid", 0.5, ["0.5", "must be a list"]),
    ("empty list", f"{SHAPE}.chord.grid", [], ["0 entries", "1 to 100000"]),
    ("number for a mapping", f"{SHAPE}.chord", 3.0, ["3.0", "must be a mapping"]),
    ("grid above 1", f"{SHAPE}.chord.grid[3]", 1.1, ["1.1", "0 to 1 (root to tip)"]),
    ("grid below 0", f"{SHAPE}.chord.grid[0]", -0.1, ["-0.1", "0 to 1 (root to tip)"]),
    ("grid of texts", f"{SHAPE}.chord.grid[0]", "root", ["'root'", "must be a number"]),
    ("grid falls", f"{SHAPE}.chord.grid[2]", 0.1, ["0.1 after 0.2", "must increase"]),
    ("grid repeats", f"{SHAPE}.chord.grid[2]", 0.2, ["0.2 after 0.2", "must increase"]),
    ("twist in degrees too far", f"{SHAPE}.twist.values[0]", 120, ["120", "-90 to 90 deg"]),
    ("axis falls", f"{AXIS}.z.values", [20.0, 0.0], ["0 after 20", "must increase"]),
    ("axis too far", f"{AXIS}.x.values[2]", 1e9, ["1000000000.0", "-1000 to 1000 m"]),
    ("thickness in percent", f"{SHAPE}.rthick.values[1]", 50.0, ["50.0", "above 0 to 1.05"]),
    ("offset too far", f"{SHAPE}.section_offset_y.values[1]", 1e4, ["10000.0", "1000 m"]),
    ("position outside", f"{SHAPE}.airfoils[1].spanwise_position", 1.4, ["1.4", "0 to 1 (root"]),
    ("position as text", f"{SHAPE}.airfoils[1].spanwise_position", "mid", ["'mid'", "a number"]),
    ("airfoil's name a list", f"{SHAPE}.airfoils[1].name", [], ["a list of 0", "must be a text"]),
    ("airfoils a mapping", "airfoils", {"a": 1}, ["a mapping of 1", "must be a list"]),
    ("airfoil a text", "airfoils[1]", "thick", ["'thick'", "must be a mapping"]),
    ("coordinates a list", "airfoils[1].coordinates", [1, 2], ["a list of 2", "must be a mapping"]),
    ("coordinate as text", "airfoils[1].coordinates.x[3]", "o", ["'o'", "-0.5 to 1.5 chords"]),
    ("coordinate far off", "airfoils[1].coordinates.y[3]", 7.5, ["7.5", "-1 to 1 chords"]),
    ("airfoil's thickness", "airfoils[1].rthick", 30.0, ["30.0", "above 0 to 1.05"]),
    ("hub a text", "components.hub.diameter", "big", ["'big'", "0 to 1000 m"]),
    ("too many blades", "assembly.number_of_blades", 400, ["400", "1 to 10"]),
    ("cone beyond upright", "components.hub.cone_angle", 1e3, ["1000.0", "-90 to 90 deg"]),
    ("blade a list", "components.blade", [1], ["a list of 1", "mapping"]),
]


@pytest.mark.parametrize(
    ("place", "value", "said"), [row[1:] for row in BAD_VALUES], ids=[row[0] for row in BAD_VALUES]
)
def test_a_bad_value_is_refused_with_place_value_and_what_is_allowed(path, place, value, said):
    error = refusal(changed(windio2(), (place, value)), path)
    (problem,) = [p for p in error.problems if p.startswith(place)]
    for words in said:
        assert words in problem


MISSING = [
    f"{SHAPE}.chord",
    f"{SHAPE}.twist",
    f"{SHAPE}.section_offset_y",
    f"{SHAPE}.airfoils",
    f"{SHAPE}.chord.grid",
    f"{SHAPE}.chord.values",
    f"{SHAPE}.airfoils[0].name",
    f"{AXIS}.z",
    AXIS,
    SHAPE,
    "components.blade",
    "components",
    "airfoils",
    "airfoils[1].name",
    "airfoils[1].coordinates",
    "airfoils[1].coordinates.y",
]


@pytest.mark.parametrize("place", MISSING)
@pytest.mark.parametrize("value", [DELETE, None])
def test_what_is_missing_is_named(path, place, value):
    error = refusal(changed(windio2(), (place, value)), path)
    assert f"{place}: is missing, must be given" in error.problems


@pytest.mark.parametrize(
    "place", ["airfoil_position", "airfoil_position.labels", "pitch_axis", "reference_axis"]
)
def test_what_is_missing_in_windio_1_is_named(path, place):
    error = refusal(changed(windio1(), (f"{SHAPE_1}.{place}", DELETE)), path)
    assert f"{SHAPE_1}.{place}: is missing, must be given" in error.problems


def bow_tie() -> Document:
    x = [1.0, 0.75, 0.5, 0.25, 0.0, 0.25, 0.5, 0.75, 1.0]
    y = [0.05, 0.1, 0.1, -0.1, 0.0, 0.1, -0.1, -0.1, -0.05]
    return {"x": x, "y": y}


def zigzag() -> Document:
    x = [1.0, 0.5, 0.6, 0.0, 0.6, 0.5, 1.0]
    y = [0.1, 0.1, 0.2, 0.0, 0.12, -0.1, -0.1]
    return {"x": x, "y": y}


BAD_SHAPES: list[tuple[str, list[tuple[str, Any]], list[str]]] = [
    (
        "lengths differ",
        [(f"{SHAPE}.chord.values", [1.0, 2.0])],
        [f"{SHAPE}.chord: grid has 4 entries and values 2, must be alike"],
    ),
    (
        "one grid point",
        [(f"{SHAPE}.chord", {"grid": [0.5], "values": [1.0]})],
        [f"{SHAPE}.chord.grid: has 1 entry, at least 2 that differ are needed"],
    ),
    (
        "both offsets",
        [(f"{SHAPE}.pitch_axis", {"grid": [0, 1], "values": [0.5, 0.4]})],
        [f"{SHAPE}: got both pitch_axis and section_offset_y, allowed is one of them"],
    ),
    (
        "unknown airfoil",
        [(f"{SHAPE}.airfoils[1].name", "S809")],
        [f"{SHAPE}.airfoils[1]: got airfoil 'S809', allowed are those of airfoils: circle, thick"],
    ),
    (
        "two airfoils of one name",
        [("airfoils[2].name", "thick"), (f"{SHAPE}.airfoils[2].name", "thick")],
        ["airfoils[2]: name 'thick' is that of airfoils[1], must be unique"],
    ),
    (
        "stations fall",
        [(f"{SHAPE}.airfoils[2].spanwise_position", 0.3)],
        [f"{SHAPE}.airfoils[2]: thin at 0.3 follows 0.4, must increase"],
    ),
    (
        "two airfoils at one station",
        [(f"{SHAPE}.airfoils[2].spanwise_position", 0.4)],
        [f"{SHAPE}.airfoils[2]: thin at 0.4 follows 0.4, must increase"],
    ),
    (
        "position missing for one",
        [(f"{SHAPE}.airfoils[1].spanwise_position", DELETE)],
        [f"{SHAPE}.airfoils[1]: spanwise_position is missing; allowed is"],
    ),
    (
        "no position and no thickness",
        [(f"{SHAPE}.airfoils[{i}].spanwise_position", DELETE) for i in range(3)]
        + [(f"{SHAPE}.rthick", DELETE)],
        [f"{SHAPE}.airfoils[{i}]: spanwise_position is missing" for i in range(3)],
    ),
    (
        "thickness never met",
        [(f"{SHAPE}.airfoils[{i}].spanwise_position", DELETE) for i in range(3)]
        + [(f"{SHAPE}.rthick.values", [1.0, 0.5, 0.3])],
        [f"{SHAPE}.airfoils[0]: spanwise_position is missing, and airfoil 'thin': relative"],
    ),
    (
        "coordinates of two lengths",
        [("airfoils[0].coordinates.x", [1.0, 0.0, 1.0])],
        ["airfoils[0].coordinates: x has 3 entries and y 41, must be alike"],
    ),
    (
        "too few points",
        [("airfoils[0].coordinates", {"x": [1.0, 0.0, 0.0], "y": [0.0, 0.0, 0.0]})],
        ["airfoils[0].coordinates: has 2 points that differ, allowed are 3 to 5000"],
    ),
    (
        "short chord",
        [("airfoils[0].coordinates", {"x": [0.5, 0.0, 0.5], "y": [0.1, 0.0, -0.1]})],
        ["airfoils[0].coordinates: x spans 0.5, allowed is 0.9 to 1.1"],
    ),
    (
        "starts at the leading edge",
        [("airfoils[0].coordinates", {"x": [0.0, 1.0, 0.5], "y": [0.0, 0.0, -0.1]})],
        ["airfoils[0].coordinates: does not run from trailing edge to trailing edge"],
    ),
    (
        "flat",
        [("airfoils[0].coordinates", {"x": [1.0, 0.0, 1.0], "y": [0.0, 0.0, 0.0]})],
        ["airfoils[0].coordinates: the contour is 0 thick, allowed is above 0 to 1.05 of the"],
    ),
    (
        "sides change places",
        [("airfoils[0].coordinates", bow_tie())],
        ["airfoils[0].coordinates: the contour crosses itself near (0."],
    ),
    (
        "a side crosses itself",
        [("airfoils[0].coordinates", zigzag())],
        ["airfoils[0].coordinates: the contour crosses itself near (0.", "must not"],
    ),
]


@pytest.mark.parametrize(
    ("changes", "said"), [row[1:] for row in BAD_SHAPES], ids=[row[0] for row in BAD_SHAPES]
)
def test_values_that_do_not_fit_together_are_refused(path, changes, said):
    error = refusal(changed(windio2(), *changes), path)
    for words in said:
        assert words in str(error)


@pytest.mark.parametrize(
    ("place", "value", "said"),
    [
        ("twist.values[0]", 13.3, "got 13.3, allowed is -1.5708 to 1.5708 rad"),
        ("pitch_axis.values[0]", 2.6, "got 2.6, allowed is -1 to 2 of the chord"),
        ("airfoil_position.labels", ["circle"], "grid has 3 entries and labels 1, must be alike"),
        ("airfoil_position.labels[1]", None, "got nothing, must be a text"),
        ("airfoil_position.grid[1]", 7, "got 7, allowed is 0 to 1 (root to tip)"),
        ("airfoil_position.labels[1]", "S1", "got airfoil 'S1', allowed are those of airfoils"),
    ],
)
def test_windio_1_is_refused_alike(path, place, value, said):
    error = refusal(changed(windio1(), (f"{SHAPE_1}.{place}", value)), path)
    assert any(p.startswith(SHAPE_1) and said in p for p in error.problems)


def test_all_problems_are_reported_at_once(path):
    changes = [row[1:3] for row in BAD_VALUES if row[0] in ("chord negative", "axis falls")]
    changes += [("airfoils[2].coordinates", bow_tie()), (f"{SHAPE}.twist", DELETE)]
    changes += [("components.hub.diameter", "big")]
    error = refusal(changed(windio2(), *changes), path)
    assert len(error.problems) == 5
    assert ": 5 problems: " in str(error)


def test_a_list_that_is_wrong_all_over_is_said_in_a_few_words(path):
    error = refusal(changed(windio2(), ("airfoils[1].coordinates.x", ["a"] * 61)), path)
    assert len(error.problems) == 6
    assert error.problems[-1] == "airfoils[1].coordinates.x: 56 more entries like these"


def test_a_file_that_is_wrong_all_over_is_said_in_a_hundred_problems(path):
    document = changed(windio2(), (f"{SHAPE}.airfoils", [{"name": f"a{i}"} for i in range(300)]))
    error = refusal(document, path)
    assert len(error.problems) == 101
    assert error.problems[-1] == "and 200 more problems"
    document["airfoils"] = [{"name": f"b{i}"} for i in range(300)]
    assert "b1, b10" in str(refusal(document, path))
    assert "and 270 more" in refusal(document, path).problems[0]


BAD_FILES: list[tuple[str, bytes, str]] = [
    ("empty", b"", "is empty, must hold a turbine"),
    ("a comment only", b"# nothing\n", "is empty"),
    ("a text", b"hello", "holds no blade that is known, must hold components.blade.outer_shape"),
    ("a list", b"[1, 2]", "(windIO 2) or components.blade.outer_shape_bem (windIO 1)"),
    ("another document", b"a: 1", "holds no blade that is known"),
    ("version only", b"windIO_version: '2.0'", "components: is missing, must be given"),
    ("version 1 only", b"windIO_version: '1.0'\ncomponents: {}", "components.blade: is missing"),
    ("garbage", bytes(range(256)), "is no YAML"),
    ("latin-1", "name: Böe".encode("latin-1"), "is no YAML"),
    (
        "a tab",
        b"a:\n\tb: 3",
        "that cannot start any token (line 2, column 1): a tab indents it, YAML takes blanks",
    ),
    ("a syntax error", b"a: [1, 2\nb: 3", "is no YAML: did not find expected ',' or ']'"),
    ("its line", b"a: [1, 2\nb: 3", "(line 2, column 2)"),
    ("a tab", b"a:\n\t- 1", "cannot start any token (line 2, column 1)"),
    (
        "two documents",
        b"a: 1\n---\nb: 2",
        "a second document starts, one a file is allowed (line 2",
    ),
    ("python objects", b"a: !!python/name:os.system x", "python/name:os.system' is not allowed"),
    ("tagged lists", b"a: !!set {x}", "set' is not allowed (line 1, column 4)"),
    ("merge keys", b"a: &a {b: 1}\nc: {<<: *a}", "merge keys (<<) are not supported (line 2"),
    ("an unknown alias", b"a: *b", "alias *b names nothing that ends above it (line 1, column 4)"),
    ("a list in itself", b"a: &a [*a]", "alias *a names nothing that ends above it"),
    ("a list for a key", b"? [1, 2]\n: 3", "a key must be a text (line 1, column 3)"),
    ("an alias for a key", b"a: &a [1]\n? *a\n: 3", "a key must be a text (line 2"),
    ("brackets", b"[" * 500, "nested more than 64 deep (line 1, column 65)"),
    ("far too many brackets", b"[" * 200_000, " nest"),  # some libyaml refuse these by themselves
    ("braces", b"{a: " * 200_000, "nested more than 64 deep"),
    ("dashes", b"- " * 200_000, "nested more than 64 deep"),
]


@pytest.mark.parametrize(
    ("content", "said"), [row[1:] for row in BAD_FILES], ids=[row[0] for row in BAD_FILES]
)
def test_a_file_that_is_no_blade_is_refused(path, content, said):
    assert said in str(refusal(content, path))


def test_without_libyaml_deep_files_are_refused_too(path, monkeypatch):
    monkeypatch.setattr(yaml_file, "_LOADER", yaml.SafeLoader)
    assert "nested more than 64 deep" in str(refusal(b"[" * 1_000, path))


def test_size_and_number_of_values_are_bounded(path, monkeypatch):
    monkeypatch.setattr(yaml_file, "MAX_VALUES", 10)
    assert "more than 10 values" in str(refusal(b"[1,1,1,1,1,1,1,1,1,1,1]", path))
    monkeypatch.setattr(yaml_file, "MAX_BYTES", 2**20)
    assert "is larger than 1 MB" in str(refusal(b" " * 2**21, path))


@pytest.mark.parametrize("name", ["iea16mw", "../blades/iea15mw", "/dev/null", "x" * 5000, "a\0b"])
def test_what_is_neither_blade_nor_file_is_answered_with_the_bundled_names(name):
    with pytest.raises(FileError, match="bundled blades are dtu10mw, iea15mw, nrel5mw") as raised:
        reading.read(name)
    assert raised.value.source == name


@pytest.mark.parametrize(("name", "words"), [("", "name of a bundled blade"), (".", "is a folder")])
def test_no_name_and_a_folder_are_answered_with_what_to_give(name, words):
    with pytest.raises(FileError, match=words):
        reading.read(name)


def test_other_suffixes_are_refused(tmp_path):
    with pytest.raises(FileError, match=r"has the suffix '\.step', allowed are \.yaml, \.yml"):
        read(windio2(), tmp_path / "blade.step")


def test_a_file_that_may_not_be_read_is_refused(path, monkeypatch):
    def refuse(*args, **kwargs):
        raise PermissionError(13, "Permission denied")

    path.write_text("a: 1", encoding="utf-8")
    monkeypatch.setattr(os, "open", refuse)
    with pytest.raises(FileError, match="cannot be read: Permission denied"):
        reading.read(path)
    monkeypatch.undo()
    with pytest.raises(yaml_file.YamlError, match="no regular file"):
        yaml_file.load_yaml(path.parent)


def test_what_lies_behind_something_missing_is_not_asked_for_again():
    notes = Notes()
    node = Node({"a": 1}, "", notes)["b"]["c"]
    assert node.number(Range(0, 1)) is node.numbers(Range(0, 1)) is node.text() is None
    assert node.members() == []
    assert notes.problems == ["b: is missing, must be given"]


def test_a_name_like_the_one_that_is_missing_is_named():
    notes = Notes()
    _ = Node({"referense_axis": 1, "chord": 2}, "blade", notes)["reference_axis"]
    assert notes.problems == [
        "blade.reference_axis: is missing, must be given; 'referense_axis' stands there"
    ]


# ---- whatever a file holds, the answer is a definition or a BladegenError ---------------------

ODD = st.one_of(
    st.sampled_from([None, True, -1, 0, 1, 2, 0.5, 1e308, -1e-300, 10**390, math.nan, math.inf]),
    st.sampled_from(["", "abc", "5e-05", "circle", "x" * 99]),
    st.sampled_from([[], {}, [[1.0]], [None], {"grid": 1}, [0.0, 1.0]]),
    st.floats(-2, 2),
    st.lists(st.floats(-0.1, 1.1), max_size=5),
)


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    members = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    return [path, *(place for key, member in members for place in places(member, (*path, key)))]


PLACES = {version: places(make()) for version, make in ((1, windio1), (2, windio2))}


@settings(max_examples=few(100), deadline=None)
@given(st.data(), st.sampled_from([1, 2]))
def test_any_change_of_a_good_document_gives_a_definition_or_an_error(tmp_path_factory, data, v):
    document = {1: windio1, 2: windio2}[v]()
    for _ in range(data.draw(st.integers(1, 3))):
        place = data.draw(st.sampled_from(PLACES[v][1:]))
        holder = document
        try:
            for key in place[:-1]:
                holder = holder[key]
            if data.draw(st.booleans()):
                holder[place[-1]] = data.draw(ODD)
            else:
                del holder[place[-1]]
        except (KeyError, IndexError, TypeError):
            continue  # an earlier change took this place away
    answer(yaml.dump(document, Dumper=DUMPER).encode(), tmp_path_factory)


TEXT = yaml.dump(windio2(), Dumper=DUMPER).encode()


@settings(max_examples=few(100), deadline=None)
@given(st.data())
def test_any_change_of_a_good_text_gives_a_definition_or_an_error(tmp_path_factory, data):
    start = data.draw(st.integers(0, len(TEXT)))
    length = data.draw(st.integers(0, 40))
    odd = data.draw(
        st.one_of(st.binary(max_size=12), st.text("[]{}&*!|>?:-,'\" \n\tax01.", max_size=8))
    )
    odd = odd.encode() if isinstance(odd, str) else odd
    answer(TEXT[:start] + odd + TEXT[start + length :], tmp_path_factory)


def answer(text: bytes, tmp_path_factory: pytest.TempPathFactory) -> None:
    path = tmp_path_factory.getbasetemp() / "odd.yaml"
    path.write_bytes(text)
    try:
        given = reading.read(path).source
    except BladegenError as error:
        given = str(error)
    assert given.startswith(str(path))
