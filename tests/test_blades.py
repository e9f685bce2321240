"""The bundled blades against the published figures, entry by entry."""

import csv
import os
import shutil
import subprocess
import sys
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from numpy.testing import assert_allclose, assert_array_equal
from scipy.interpolate import PchipInterpolator

from bladegen.blade.blade import Blade
from bladegen.definition.blade_definition import BladeDefinition, Distribution, ReferenceAxis
from bladegen.formats.bundled import Facts, bundled, facts, layups
from bladegen.formats.reading import read
from bladegen.support.arrays import Array
from bladegen.views.tables import layup_figures

ROOT = Path(__file__).resolve().parent.parent
GOLDEN = Path(__file__).parent / "golden"
NAMES = ("dtu10mw", "iea15mw", "nrel5mw")
ROUNDING = 4e-16  # one multiplication or division
SAME_SPAN = 1e-6  # the NREL 5 MW's chord grid is rounded to nine digits, its axis grid is not
SPAN = "span_fraction"


def rows(table: str) -> list[dict[str, str]]:
    with (GOLDEN / f"{table}.csv").open(newline="") as stream:
        return list(csv.DictReader(stream))


def column(table: str, name: str) -> Array:
    return np.array([float(row[name]) for row in rows(table)])


def source(name: str) -> str:
    return (ROOT / "blades" / f"{name}.yaml").read_text(encoding="utf-8")


def document(name: str) -> dict:
    """The file as another reader sees it: PyYAML's own safe loader."""
    return yaml.load(source(name), Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))


# one row a quantity: path in the file, table, column, factor from the table's unit to the file's
SPANWISE = {
    "iea15mw": (
        ("outer_shape.chord", "chord", "chord_m", 1.0),
        ("outer_shape.twist", "twist", "twist_deg", 1.0),
        ("outer_shape.rthick", "rthick", "relative_thickness", 1.0),
        ("reference_axis.x", "prebend", "prebend_x_m", 1.0),
        ("reference_axis.y", "sweep", "sweep_y_m", 1.0),
        ("reference_axis.z", "reference_axis_z", "z_m", 1.0),
    ),
    "dtu10mw": (
        ("outer_shape.chord", "spanwise", "chord_m", 1.0),
        ("outer_shape.twist", "spanwise", "rot_z_deg", -1.0),
        ("outer_shape.rthick", "spanwise", "rthick_percent", 0.01),
        ("reference_axis.x", "spanwise", "prebend_y_m", 1.0),
        ("reference_axis.y", "spanwise", "sweep_x_m", 1.0),
        ("reference_axis.z", "spanwise", "z_m", 1.0),
    ),
}
SPANWISE["nrel5mw"] = SPANWISE["iea15mw"]
QUANTITIES = [(name, *row) for name, table in SPANWISE.items() for row in table]


@pytest.mark.parametrize(("name", "path", "table", "label", "factor"), QUANTITIES)
def test_every_spanwise_entry_is_the_published_one(name, path, table, label, factor):
    given = document(name)["components"]["blade"]
    for key in path.split("."):
        given = given[key]
    assert_array_equal(given["grid"], column(f"{name}/{table}", SPAN))
    published = factor * column(f"{name}/{table}", label)
    if abs(factor) == 1:
        assert_array_equal(given["values"], published)
    else:
        assert_allclose(given["values"], published, rtol=ROUNDING, atol=0)


@pytest.mark.parametrize("name", ["iea15mw", "nrel5mw"])
def test_twist_is_the_published_one_in_radians_too(name):
    twist = read(name).twist
    assert_allclose(twist.values, column(f"{name}/twist", "twist_rad"), rtol=ROUNDING, atol=0)


@pytest.mark.parametrize("name", NAMES)
def test_the_offset_is_pitch_axis_times_chord(name):
    tables = ("spanwise", "spanwise") if name == "dtu10mw" else ("pitch_axis", "chord")
    grids = [column(f"{name}/{table}", SPAN) for table in tables]
    pitch_axis, chord = (
        PchipInterpolator(grid, column(f"{name}/{table}", label))
        for grid, table, label in zip(grids, tables, ("pitch_axis_xc", "chord_m"), strict=True)
    )
    offset = document(name)["components"]["blade"]["outer_shape"]["section_offset_y"]
    grid = np.array(offset["grid"])
    for wanted in grids:  # every published point is there
        assert np.abs(grid[:, None] - wanted).min(axis=0).max() < SAME_SPAN
    assert len(grid) <= len(np.union1d(*grids))
    assert_allclose(offset["values"], pitch_axis(grid) * chord(grid), atol=1e-7, rtol=0)
    shared = np.isin(grid, grids[0]) & np.isin(grid, grids[1])
    assert_allclose(
        np.array(offset["values"])[shared],
        (pitch_axis(grid) * chord(grid))[shared],
        rtol=2 * ROUNDING,
        atol=0,
    )


@pytest.mark.parametrize("name", NAMES)
def test_the_schedule_is_the_published_one(name):
    given = document(name)["components"]["blade"]["outer_shape"]["airfoils"]
    published = rows(f"{name}/airfoil_schedule")
    assert [item["name"] for item in given] == [row["airfoil"] for row in published]
    assert [item["spanwise_position"] for item in given] == [float(row[SPAN]) for row in published]


AIRFOILS = [
    (name, row["airfoil"])
    for name in NAMES
    for row in rows(f"{name}/airfoil_list")
    if row.get("in_schedule") != "auxiliary"
]


@pytest.mark.parametrize(("name", "airfoil"), AIRFOILS)
def test_every_coordinate_is_the_published_one(name, airfoil):
    given = {item["name"]: item for item in document(name)["airfoils"]}[airfoil]
    points = np.array([given["coordinates"]["x"], given["coordinates"]["y"]]).T
    table = f"{name}/airfoils/{airfoil}"
    published = np.stack([column(table, "x"), column(table, "y")], axis=1)
    runs_as_published = name == "iea15mw" or airfoil == "Cylinder2"
    assert_array_equal(points, published if runs_as_published else published[::-1])
    x, y = points.T
    assert np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) > 0, "suction side first, as windIO 2"


@pytest.mark.parametrize("name", NAMES)
def test_airfoils_state_what_their_source_states(name):
    published = {row["airfoil"]: row for row in rows(f"{name}/airfoil_list")}
    for given in document(name)["airfoils"]:
        row = published[given["name"]]
        for key, label in (
            ("rthick", "nominal_relative_thickness"),
            ("aerodynamic_center", "aerodynamic_center_xc"),
        ):
            stated = row.get(label) or None
            assert given.get(key) == (None if stated is None else float(stated))
        assert len(given["coordinates"]["x"]) == int(row["n_points"])


@pytest.mark.parametrize(
    ("name", "hub_diameter", "rotor_diameter", "cone", "tilt", "length"),
    [
        ("iea15mw", 7.94, 241.94, 4.0, 6.0, 117.0),
        ("nrel5mw", 3.0, 126.0, 2.5, 5.0, 61.5),
        ("dtu10mw", 5.6, 178.3, 2.5, 5.0, 86.36666666666666),
    ],
)
def test_the_facts_on_the_rotor(name, hub_diameter, rotor_diameter, cone, tilt, length):
    definition = read(name)
    rotor = definition.rotor
    assert rotor.blades == 3
    assert rotor.hub_radius == hub_diameter / 2
    assert rotor.diameter == rotor_diameter
    assert_allclose(np.degrees([rotor.cone, rotor.tilt]), [cone, tilt], rtol=ROUNDING)
    assert_allclose(definition.length, length, rtol=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_reading_changes_no_number(name):
    given, definition = document(name), read(name)
    blade = given["components"]["blade"]
    for key, quantity, factor in (
        ("chord", definition.chord, 1.0),
        ("twist", definition.twist, np.pi / 180),
        ("rthick", definition.relative_thickness, 1.0),
        ("section_offset_y", definition.section_offset_y, 1.0),
    ):
        assert_array_equal(quantity.grid, blade["outer_shape"][key]["grid"])
        expected = np.array(blade["outer_shape"][key]["values"]) * factor
        assert_allclose(quantity.values, expected, rtol=ROUNDING, atol=0)
    for key in "xyz":
        quantity = getattr(definition.axis, key)
        assert_array_equal(quantity.grid, blade["reference_axis"][key]["grid"])
        assert_array_equal(quantity.values, blade["reference_axis"][key]["values"])
    coordinates = {item["name"]: item["coordinates"] for item in given["airfoils"]}
    for station in definition.stations:
        points = station.airfoil.coordinates
        assert_array_equal(points[:, 0], coordinates[station.airfoil.name]["x"])
        assert_array_equal(points[:, 1], coordinates[station.airfoil.name]["y"])


def test_what_is_odd_in_the_bundled_blades_is_said():
    found = {name: [str(finding) for finding in read(name).findings] for name in NAMES}
    assert found["iea15mw"] == []
    (finding,) = found["dtu10mw"]  # its cylinder is cut open
    assert "chord is 0.9985, from x = 0.0000 to 0.9985; stretched by 1.0015" in finding
    (finding,) = found["nrel5mw"]
    assert "DU40_A17 is stated 0.4 thick; its coordinates give 0.4049" in finding


@pytest.mark.parametrize("name", NAMES)
def test_the_files_follow_the_schema_of_windio(name):
    jsonschema = pytest.importorskip("jsonschema")
    schemas = pytest.importorskip("windIO.schemas")
    path = schemas.schemaPath / "turbine" / "turbine_schema.yaml"
    schema = yaml.load(path.read_bytes(), Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    errors = [
        (".".join(map(str, error.absolute_path)), error.message)
        for error in jsonschema.Draft7Validator(schema).iter_errors(document(name))
    ]
    # the sources give no drag coefficient of the hub, and nothing here is made up
    assert errors == [("components.hub", "'cd' is a required property")]


STRUCTURED = ("iea15mw", "nrel5mw")


def without_stated(structure):
    """A structure without the fractions that stand beside its rules."""
    bare = {"stated": (None, None)}
    return [replace(part, **bare) for part in (*structure.webs, *structure.layers)]


def test_the_structure_of_the_iea_15_mw_is_the_published_one():
    home = Path(pytest.importorskip("windIO.examples.turbine").__file__).parent
    own = read("iea15mw").structure
    published = read(home / "IEA-15-240-RWT.yaml").structure
    assert own.webs
    assert without_stated(own) == without_stated(published)
    for mine, theirs in zip(own.layers, published.layers, strict=True):
        for one, other in zip(mine.stated, theirs.stated, strict=True):
            assert (one is None) == (other is None)
            if one is not None:
                assert_allclose(one.values, other.values, atol=5.1e-5)  # to four digits
    theirs = {material.name: material for material in published.materials}
    for material in own.materials:  # free text is not copied
        mine, other = (replace(one, others=()) for one in (material, theirs[material.name]))
        assert mine == other


def test_the_layers_of_the_nrel_5_mw_are_the_published_ones():
    published = rows("nrel5mw/layers")
    layers = read("nrel5mw").structure.layers
    assert [layer.name for layer in layers] == list(dict.fromkeys(r["layer"] for r in published))
    for layer in layers:
        own = [row for row in published if row["layer"] == layer.name]
        grid, values = (np.array([float(r[key]) for r in own]) for key in (SPAN, "thickness_m"))
        assert {row["material"] for row in own} == {layer.material}
        assert_allclose(layer.thickness(grid), values, rtol=1e-14, atol=1e-12)


def test_the_layers_of_the_iea_15_mw_weigh_along_the_span_what_is_published():
    """Its table was made before its layers were changed last: 8 % apart at half of the span."""
    blade = Blade.from_definition(read("iea15mw"), landmarks=201)
    eta = column("iea15mw/mass_per_length", SPAN)
    published = column("iea15mw/mass_per_length", "mass_kg_m")
    laid = blade.layup.at(eta).mass_per_length
    assert_allclose(laid, published, rtol=0.12)
    assert_allclose(np.trapezoid(laid, eta), np.trapezoid(published, eta), rtol=0.03)


@pytest.mark.parametrize("name", STRUCTURED)
def test_what_a_list_shows_of_layers_is_what_they_weigh(name):
    layup = Blade.from_definition(read(name)).layup
    shown = dict(layups()[name])
    assert shown.pop("findings") == [*map(str, (*layup.findings, *layup.remarks))]
    made = layup_figures(layup)
    assert made.keys() == shown.keys()
    for key, value in made.items():
        if isinstance(value, float):
            assert_allclose(shown[key], value, rtol=1e-4)
        elif key == "webs":
            assert shown[key] == value
        else:
            for mine, other in zip(shown[key], value, strict=True):
                assert mine == other | {
                    number: pytest.approx(other[number], rel=1e-4)
                    for number in other
                    if isinstance(other[number], float)
                }


def test_only_blades_with_a_structure_have_layups():
    assert {name for name in NAMES if read(name).structure is not None} == set(layups())
    assert set(layups()) == set(STRUCTURED)


@pytest.mark.parametrize("name", NAMES)
def test_headers_name_source_licence_and_mends_and_no_place_on_a_machine(name):
    header = source(name).split("\nwindIO_version")[0]
    assert all(line.startswith("#") for line in header.splitlines() if line)
    for word in ("Source", "commit", "Derived and mended", "section_offset_y"):
        assert word in header
    assert any(licence in header for licence in ("Apache-2.0", "BSD-3-Clause"))
    assert not any(place in source(name) for place in ("/home", "/tmp", "/work", "\\"))
    assert max(map(len, source(name).splitlines())) <= 110


def test_the_bundled_names():
    assert bundled() == NAMES


def test_what_is_listed_of_the_bundled_blades_is_what_they_hold():
    assert facts() == {name: Facts.of(read(name)) for name in NAMES}


def test_bundled_blades_are_found_in_an_installed_package_too(tmp_path):
    package = tmp_path / "bladegen"
    skipped = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "bladegen", package, ignore=skipped, dirs_exist_ok=True)
    shutil.copytree(ROOT / "blades", package / "blades", dirs_exist_ok=True)
    code = "import bladegen as bg; print(*bg.bundled(), bg.read('dtu10mw').source)"
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.split() == [*NAMES, str(package / "blades" / "dtu10mw.yaml")]
    with (ROOT / "pyproject.toml").open("rb") as stream:
        wheel = tomllib.load(stream)["tool"]["hatch"]["build"]["targets"]["wheel"]
    assert wheel["force-include"] == {"blades": "bladegen/blades"}


def test_a_windio_1_file_of_the_same_figures_reads_alike(tmp_path):
    """IEA 15 MW as its source has it: radians, and the pitch axis on a grid of its own."""

    def spanwise(table: str, label: str) -> dict:
        return {
            "grid": column(f"iea15mw/{table}", SPAN).tolist(),
            "values": column(f"iea15mw/{table}", label).tolist(),
        }

    schedule = rows("iea15mw/airfoil_schedule")
    turbine = {
        "name": "IEA 15 MW",
        "assembly": {"number_of_blades": 3, "rotor_diameter": 241.94},
        "components": {
            "hub": {"diameter": 7.94, "cone_angle": 0.06981317007977318},
            "nacelle": {"drivetrain": {"uptilt": 0.10471975511965978}},
            "blade": {
                "outer_shape_bem": {
                    "airfoil_position": {
                        "grid": [float(row[SPAN]) for row in schedule],
                        "labels": [row["airfoil"] for row in schedule],
                    },
                    "chord": spanwise("chord", "chord_m"),
                    "twist": spanwise("twist", "twist_rad"),
                    "pitch_axis": spanwise("pitch_axis", "pitch_axis_xc"),
                    "rthick": spanwise("rthick", "relative_thickness"),
                    "reference_axis": {
                        "x": spanwise("prebend", "prebend_x_m"),
                        "y": spanwise("sweep", "sweep_y_m"),
                        "z": spanwise("reference_axis_z", "z_m"),
                    },
                }
            },
        },
        "airfoils": [
            {
                "name": row["airfoil"],
                "relative_thickness": float(row["nominal_relative_thickness"]),
                "coordinates": {
                    axis: column(f"iea15mw/airfoils/{row['airfoil']}", axis).tolist()
                    for axis in ("x", "y")
                },
            }
            for row in rows("iea15mw/airfoil_list")
        ],
    }
    path = tmp_path / "iea15mw.yaml"
    path.write_text(yaml.safe_dump(turbine), encoding="utf-8")
    assert_definitions_alike(read(path), read("iea15mw"))


def assert_definitions_alike(first: BladeDefinition, second: BladeDefinition) -> None:
    assert first.name == second.name
    assert first.description == second.description
    assert_allclose(
        [first.rotor.hub_radius, first.rotor.diameter, first.rotor.cone, first.rotor.tilt],
        [second.rotor.hub_radius, second.rotor.diameter, second.rotor.cone, second.rotor.tilt],
        rtol=ROUNDING,
    )
    for one, other in zip(quantities(first), quantities(second), strict=True):
        assert_array_equal(one.grid, other.grid)
        assert_allclose(one.values, other.values, rtol=ROUNDING, atol=0)
    assert second.section_offset_y is not None
    grid = second.section_offset_y.grid
    assert_allclose(first.offset_y(grid), second.offset_y(grid), rtol=1e-14)
    for one, other in zip(first.stations, second.stations, strict=True):
        assert one.eta == other.eta
        assert one.airfoil.name == other.airfoil.name
        assert one.airfoil.relative_thickness == other.airfoil.relative_thickness
        assert_array_equal(one.airfoil.coordinates, other.airfoil.coordinates)


def quantities(definition: BladeDefinition) -> list[Distribution]:
    axis: ReferenceAxis = definition.axis
    assert definition.relative_thickness is not None
    return [
        definition.chord,
        definition.twist,
        definition.relative_thickness,
        axis.x,
        axis.y,
        axis.z,
    ]


def test_a_bundled_blade_is_read_once():
    assert read("nrel5mw") is read("nrel5mw")
