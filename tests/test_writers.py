"""Writers: what is written is read back the same, within what the format can hold."""

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from numpy.testing import assert_allclose, assert_array_equal

import bladegen as bg
from bladegen.airfoils.landmarks import oriented
from bladegen.airfoils.polars import Polar
from bladegen.definition.blade_definition import Airfoil, BladeDefinition, Distribution, Station
from bladegen.errors import ExportError, FileError
from bladegen.formats import writing
from bladegen.formats.airfoils.reading import read_airfoil, read_folder
from bladegen.formats.common.redefinition import redefined
from bladegen.formats.into import write_into
from bladegen.formats.windio import turbine_file
from bladegen.formats.windio.yaml_file import load_yaml
from strategies import airfoils, by_day, definitions, few, naca

ETA = np.linspace(0.0, 1.0, 401)
WINDIO = ("windio2", "windio1")


def assert_alike(one: BladeDefinition, other: BladeDefinition, offset: float = 0.0) -> None:
    """Two definitions hold the same blade; offsets within so many metres."""
    for name in ("chord", "twist"):
        assert_allclose(getattr(one, name)(ETA), getattr(other, name)(ETA), rtol=0, atol=1e-12)
    assert_allclose(one.axis(ETA), other.axis(ETA), rtol=0, atol=1e-12)
    assert_allclose(one.offset_y(ETA), other.offset_y(ETA), rtol=0, atol=offset + 1e-12)
    if one.relative_thickness is not None and other.relative_thickness is not None:
        assert_allclose(
            one.relative_thickness(ETA), other.relative_thickness(ETA), rtol=0, atol=1e-12
        )
    assert [s.eta for s in one.stations] == [s.eta for s in other.stations]
    for mine, yours in zip(one.stations, other.stations, strict=True):
        assert_array_equal(mine.airfoil.coordinates, yours.airfoil.coordinates)
    assert one.rotor.blades == other.rotor.blades
    for name in ("hub_radius", "diameter", "cone", "tilt"):
        mine, yours = getattr(one.rotor, name), getattr(other.rotor, name)
        assert mine == yours or mine == pytest.approx(yours, rel=1e-14)


@pytest.mark.parametrize("name", ["nrel5mw", "iea15mw", "dtu10mw"])
def test_a_bundled_blade_goes_through_windio_and_comes_back(tmp_path, name):
    first = bg.read(name)
    measured = {"airfoil Cylinder2: rthick"} if name == "nrel5mw" else set()
    assert {finding.where for finding in bg.write(first, tmp_path / "two.yaml")} == {
        "hub.cd",
        "polars",
        *measured,
    }
    second = bg.read(tmp_path / "two.yaml")
    assert second.format == "windIO 2"
    assert_alike(first, second)
    said = bg.write(second, tmp_path / "one.yaml", format="windio1")
    assert "section_offset_y over chord at " in str(said[-1])
    third = bg.read(tmp_path / "one.yaml")
    assert third.format == "windIO 1"
    assert_alike(first, third, offset=6e-7)
    assert third.section_offset_y is None


@settings(max_examples=few(5), deadline=None)
@given(definitions(thickness=True))
def test_any_blade_goes_through_windio_and_comes_back(tmp_path_factory, definition):
    folder = tmp_path_factory.mktemp("writers")
    bg.write(definition, folder / "one.yaml", format="windio1")
    assert_alike(definition, bg.read(folder / "one.yaml"))
    bg.write(definition, folder / "two.yaml", format="windio2")
    assert_alike(definition, bg.read(folder / "two.yaml"), offset=6e-7)


def test_what_windio_1_cannot_hold_is_said(tmp_path):
    definition = replace(bg.read("nrel5mw"), section_offset_x=Distribution.constant(0.02))
    said = bg.write(definition, tmp_path / "one.yaml", format="windio1")
    assert "up to 0.02 m, has no place in windIO 1; left out" in " ".join(map(str, said))
    bg.write(definition, tmp_path / "two.yaml")
    assert_allclose(bg.read(tmp_path / "two.yaml").offset_x(ETA), 0.02)


def test_windio_2_must_have_a_thickness_and_is_given_that_of_the_airfoils(tmp_path):
    plain = replace(bg.read("nrel5mw"), relative_thickness=None)
    said = bg.write(plain, tmp_path / "two.yaml")
    assert "rthick: windIO 2 must have one; that of the airfoils, PCHIP over span" in " ".join(
        map(str, said)
    )
    blade = bg.Blade.from_definition(plain)
    written = bg.read(tmp_path / "two.yaml").relative_thickness
    assert written is not None
    assert_allclose(written(ETA), blade.relative_thickness(ETA), rtol=0, atol=1e-9)
    centred = replace(plain, pitch_axis=Distribution.constant(0.3), section_offset_y=None)
    said = bg.write(centred, tmp_path / "one.yaml", format="windio1")
    assert [one.where for one in said] == ["polars", "turbine"]
    assert bg.read(tmp_path / "one.yaml").relative_thickness is None


def test_x_beyond_the_chord_and_thickness_beyond_one_are_brought_within_the_schema(tmp_path):
    points = naca(0.2, 0.02, 0.01) * 1.002 - [0.001, 0.0]
    thick = Distribution(np.array([0.0, 1.0]), np.array([1.001, 0.2]))
    definition = replace(
        bg.read("nrel5mw"),
        stations=(Station(0.0, Airfoil("a", points, 1.001)), Station(1.0, Airfoil("a", points))),
        relative_thickness=thick,
    )
    said = " ".join(map(str, bg.write(definition, tmp_path / "two.yaml")))
    assert "2 with x up to 0.001 outside of 0 to 1, which windIO does not allow: moved" in said
    assert "1.001 is above 1" in said
    document, _ = load_yaml(tmp_path / "two.yaml")
    x = np.array(document["airfoils"][0]["coordinates"]["x"])
    assert x.min() == 0.0
    assert x.max() == 1.0
    assert document["airfoils"][0]["rthick"] == 1.0


def test_airfoils_of_one_name_and_two_shapes_are_kept_apart(tmp_path):
    first, second = (Airfoil("a", naca(t, 0.02, 0.0)) for t in (0.3, 0.2))
    stations = (Station(0.0, first), Station(0.5, second), Station(1.0, first))
    bg.write(replace(bg.read("nrel5mw"), stations=stations), tmp_path / "two.yaml")
    back = bg.read(tmp_path / "two.yaml").stations
    assert [station.airfoil.name for station in back] == ["a", "a-2", "a"]
    for mine, yours in zip(stations, back, strict=True):
        assert_array_equal(mine.airfoil.coordinates, yours.airfoil.coordinates)


def test_formats_are_found_by_name_and_suffix(tmp_path):
    assert writing.format_of(tmp_path / "a.YML").name == "windio2"
    assert writing.format_of(tmp_path / "a.yaml", "windio1").title == "windIO 1"
    with pytest.raises(ExportError, match="format: got 'plot3d', allowed are windio2, windio1"):
        bg.write(bg.read("nrel5mw"), tmp_path / "a.yaml", format="plot3d")
    with pytest.raises(ExportError, match=r"suffix '\.step', allowed are \.yaml, \.yml"):
        bg.write(bg.read("nrel5mw"), tmp_path / "a.step")
    with pytest.raises(ExportError, match="cannot be written"):
        bg.write(bg.read("nrel5mw"), tmp_path / "missing" / "a.yaml")


def test_every_version_that_is_read_is_written():
    titles = {row.title for row in writing.FORMATS}
    assert {version.name for version in turbine_file.VERSIONS} <= titles
    assert {row.name for row in writing.FORMATS} >= set(WINDIO)


# ---- back into a full turbine file ------------------------------------------------------------

TURBINE = """\
# a turbine
windIO_version: '2.0'   # text, not a number
name: full
assembly: {number_of_blades: 3, rotor_diameter: 44.0}
components:
    hub: {diameter: 2.0, cone_angle: 3.0, cd: 0.5}
    blade:
        # its axis
        reference_axis:
            x: {grid: &g [0.0, 1.0], values: [0.0, -1.0]}
            y: {grid: *g, values: [0.0, 0.0]}
            z: {grid: *g, values: [0.0, 20.0]}
        outer_shape:
            chord: &c {grid: [0.0, 0.5, 1.0], values: [2.0, 1.5, 0.5]}
            twist: {grid: *g, values: [10.000000000000002, -1.0]}
            section_offset_y: {grid: *g, values: [1.0, 0.2]}
            rthick: {grid: *g, values: [0.3, 0.2]}
            airfoils:
              - {name: a, spanwise_position: 0.0, configuration: [clean, rough], weight: [0.5, 0.5]}
              - {name: b, spanwise_position: 1.0, configuration: [clean], weight: [1.0]}
        structure:   # untouched
            width: *c
            tiny: [-7.427228791550719e-05, 9.71445146547012e-17, .inf, 1_000]
airfoils:
  - name: a
    note: kept
    coordinates: {x: [XA], y: [YA]}
  - name: b
    coordinates: {x: [XB], y: [YB]}
control: {supervisory: {Vin: 3.0}}
"""


@pytest.fixture
def turbine(tmp_path):
    text = TURBINE
    for letter, points in (("A", naca(0.3, 0.02, 0.0)), ("B", naca(0.2, 0.02, 0.0))):
        for axis, column in (("X", points[:, 0]), ("Y", points[:, 1])):
            text = text.replace(axis + letter, ", ".join(map(repr, column.tolist())))
    path = tmp_path / "turbine.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_blade_put_back_unchanged_leaves_the_file_as_it_was(turbine, tmp_path):
    said = write_into(bg.read(turbine), turbine, tmp_path / "again.yaml")
    assert load_yaml(tmp_path / "again.yaml")[0] == load_yaml(turbine)[0]
    assert [str(finding) for finding in said] == [
        "turbine file: this is the blade that it holds; nothing replaced"
    ]
    text = (tmp_path / "again.yaml").read_text(encoding="utf-8")
    for comment in ("# a turbine", "# text, not a number", "# its axis", "# untouched"):
        assert comment in text
    assert "-7.427228791550719e-05, 9.71445146547012e-17, .inf, 1_000" in text


def test_a_blade_put_back_unchanged_leaves_all_bytes(turbine, tmp_path):
    """Anchors that stand twice, as in IEA 10 MW's file, and spaces that nobody would write."""
    text = turbine.read_text(encoding="utf-8")
    odd = "odd:   {one: &id1 [1.0], two: *id1, three: &id1 [2.0],   four: *id1}\n\n\n"
    turbine.write_text(text + odd, encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        write_into(bg.read(turbine), turbine, tmp_path / "again.yaml")
    assert (tmp_path / "again.yaml").read_bytes() == turbine.read_bytes()


def test_only_the_blade_is_changed_and_aliases_of_it_are_kept(turbine, tmp_path):
    blade = bg.Blade.from_definition(bg.read(turbine))
    variant = blade.perturbed(thickness=1.1, chord_scale=1.2, name="variant")
    definition = redefined(variant, tolerance=5e-3)
    said = write_into(definition, turbine, tmp_path / "full.yaml")
    old, new = (load_yaml(path)[0] for path in (turbine, tmp_path / "full.yaml"))
    told = [str(finding) for finding in said]
    assert "added: variant-" in " ".join(told)
    assert "replaced: outer_shape.airfoils, outer_shape.chord, outer_shape.section_offset_y" in (
        " ".join(told)
    )
    assert told[-1] == "components.blade: kept: structure, made for the blade before"
    assert "airfoils of the blade, without which WISDEM stops (variant-" in told[-2]
    for key in ("windIO_version", "name", "assembly", "control"):
        assert new[key] == old[key]
    assert new["airfoils"][:2] == old["airfoils"]
    assert new["components"]["hub"] == old["components"]["hub"]
    assert new["components"]["blade"]["structure"] == old["components"]["blade"]["structure"]
    shape = new["components"]["blade"]["outer_shape"]
    assert_allclose(shape["chord"]["values"], [2.4, 1.8, 0.6])
    assert_alike(definition, bg.read(tmp_path / "full.yaml"))
    again = write_into(bg.read(tmp_path / "full.yaml"), turbine, turbine)  # in its own place
    assert len(again) == len(said)
    assert load_yaml(turbine)[0] == new


def test_other_polars_of_a_known_airfoil_are_put_in_and_asked_for(turbine, tmp_path):
    definition = bg.read(turbine)
    alpha = np.radians([-180.0, -10.0, 0.0, 12.5, 180.0])
    polar = Polar(alpha, np.sin(alpha), 0.01 + alpha**2, 0.0 * alpha, 3e6, source="estimate")
    foil = replace(definition.stations[0].airfoil, polars=(polar,), aerodynamic_center=0.3)
    changed = replace(definition, stations=(Station(0.0, foil), definition.stations[1]))
    said = write_into(changed, turbine, turbine)
    assert "1 get other polars, their shapes as they were: a" in str(said[0])
    document, _ = load_yaml(turbine)
    assert document["airfoils"][0]["note"] == "kept"
    assert document["airfoils"][0]["aerodynamic_center"] == 0.3
    schedule = document["components"]["blade"]["outer_shape"]["airfoils"]
    assert schedule[0]["configuration"] == ["default"]  # those it asked for are no longer there
    assert schedule[0]["weight"] == [1.0]
    assert schedule[1]["configuration"] == ["clean"]
    before = turbine.read_bytes()
    write_into(bg.read(turbine), turbine, turbine)
    assert turbine.read_bytes() == before


def test_escaped_characters_stay_escaped(turbine):
    text = turbine.read_text(encoding="utf-8")
    turbine.write_text(text + 'comments: "45\\xB0 \\u2014 glass"\n', encoding="utf-8")
    before = turbine.read_bytes()
    write_into(bg.read("nrel5mw"), turbine, turbine)
    assert before.splitlines()[-1] == turbine.read_bytes().splitlines()[-1]


def test_an_airfoil_of_the_same_name_and_another_shape_is_replaced(turbine, tmp_path):
    definition = bg.read(turbine)
    foil = replace(definition.stations[0].airfoil, coordinates=naca(0.3, 0.03, 0.0))
    stations = (Station(0.0, foil), definition.stations[1])
    said = write_into(replace(definition, stations=stations), turbine, turbine)
    assert "airfoil a: the turbine file has another of that name; replaced" in str(said[0])
    document, _ = load_yaml(turbine)
    assert document["airfoils"][0]["note"] == "kept"
    schedule = document["components"]["blade"]["outer_shape"]["airfoils"]
    assert schedule[0]["configuration"] == ["clean", "rough"]
    assert_array_equal(bg.read(turbine).stations[0].airfoil.coordinates, foil.coordinates)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("a: 1", "holds no blade"),
        ("[" * 100, "nested more than 64 deep"),
        ("windIO_version: '2.0'\ncomponents: {}", "components.blade: is missing"),
        (
            "components: {blade: {outer_shape: {}, outer_shape: {}}}",
            "cannot be kept as it is: while constructing a mapping",
        ),
        ("components: {blade: {outer_shape: {}}}", "airfoils: is missing, must be a list"),
    ],
)
def test_a_file_that_is_no_turbine_takes_no_blade(tmp_path, content, said):
    path = tmp_path / "bad.yaml"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(FileError, match=said):
        write_into(bg.read("nrel5mw"), path, tmp_path / "out.yaml")
    assert not (tmp_path / "out.yaml").exists()


# ---- the windIO package as an oracle ----------------------------------------------------------


@pytest.mark.parametrize("name", by_day("iea15mw"))
def test_what_is_written_passes_the_schema_of_windio(tmp_path, name):
    windio = pytest.importorskip("windIO")
    path = tmp_path / "two.yaml"
    said = bg.write(bg.read(name), path)
    assert "hub.cd: windIO 2 must have one and none is known; 0 is written" in map(str, said)
    windio.validate(load_yaml(path)[0], "turbine/turbine_schema")


def test_a_windio_1_file_is_what_the_converter_of_windio_takes(tmp_path):
    converters = pytest.importorskip("windIO.converters.windIO2windIO")
    definition = bg.read("iea15mw")
    bg.write(definition, tmp_path / "one.yaml", format="windio1")
    converter = converters.v1p0_to_v2p0(str(tmp_path / "one.yaml"), str(tmp_path / "two.yaml"))
    document, _ = load_yaml(tmp_path / "one.yaml")
    document = converter.convert_blade_reference_axis(document)
    document["components"]["blade"]["outer_shape_bem"]["chord"]["values"] = np.array(
        document["components"]["blade"]["outer_shape_bem"]["chord"]["values"]
    )
    shape = converter.convert_blade_outer_shape(document)["components"]["blade"]["outer_shape"]
    assert_allclose(shape["twist"]["values"], np.degrees(definition.twist.values), rtol=1e-14)
    offset = definition.offset_y(np.array(shape["section_offset_y"]["grid"]))
    assert_allclose(shape["section_offset_y"]["values"], offset, rtol=0, atol=1e-3)


def test_a_full_turbine_of_windio_keeps_polars_and_everything_else(tmp_path):
    windio = pytest.importorskip("windIO")
    home = Path(pytest.importorskip("windIO.examples.turbine").__file__).parent
    turbine = home / "IEA-15-240-RWT.yaml"
    definition = bg.read(turbine)
    assert all(station.airfoil.polars for station in definition.stations)
    bg.write(definition, tmp_path / "two.yaml")
    windio.validate(load_yaml(tmp_path / "two.yaml")[0], "turbine/turbine_schema")
    for mine, yours in zip(
        definition.stations, bg.read(tmp_path / "two.yaml").stations, strict=True
    ):
        for one, other in zip(mine.airfoil.polars, yours.airfoil.polars, strict=True):
            assert_array_equal(one.cl, other.cl)
            assert one.parameters == other.parameters
            assert one.reynolds == other.reynolds
    write_into(definition, turbine, tmp_path / "full.yaml")
    assert (tmp_path / "full.yaml").read_bytes() == turbine.read_bytes()


@pytest.mark.parametrize("version", WINDIO)
def test_polars_come_back_in_both_versions(tmp_path, version):
    alpha = np.radians([-180.0, -10.0, 0.0, 12.5, 180.0])
    polar = Polar(
        alpha, 2 * np.sin(alpha), 0.01 + alpha**2, -0.1 * np.sin(alpha), 3e6, "clean", "a tunnel"
    )
    foil = Airfoil("a", naca(0.2, 0.02, 0.0), 0.2, (polar, replace(polar, reynolds=9e6)), 0.25)
    definition = replace(bg.read("nrel5mw"), stations=(Station(0.0, foil), Station(1.0, foil)))
    bg.write(definition, tmp_path / "a.yaml", format=version)
    back = bg.read(tmp_path / "a.yaml").stations[0].airfoil
    assert back.aerodynamic_center == 0.25
    assert [p.reynolds for p in back.polars] == [3e6, 9e6]
    for one, other in zip(foil.polars, back.polars, strict=True):
        assert (other.configuration, other.source) == ("clean", "a tunnel")
        for part in ("alpha", "cl", "cd", "cm"):
            assert_allclose(getattr(one, part), getattr(other, part), rtol=0, atol=1e-13)
    text = (tmp_path / "a.yaml").read_text().replace("-180.0", "-900.0").replace("-3.14", "-31.4")
    (tmp_path / "bad.yaml").write_text(text)
    bad = bg.read(tmp_path / "bad.yaml")
    assert not bad.stations[0].airfoil.polars
    assert "polars: left out: airfoils[0].polars" in " ".join(map(str, bad.findings))


# ---- airfoil files ----------------------------------------------------------------------------


@pytest.mark.parametrize("layout", ["selig", "lednicer"])
@given(xy=airfoils())
def test_an_airfoil_goes_to_a_file_and_comes_back(tmp_path_factory, layout, xy):
    path = tmp_path_factory.mktemp("foil") / "a.dat"
    bg.write_airfoil(Airfoil("an airfoil\n of ours", xy), path, layout=layout)
    assert path.read_text(encoding="utf-8").startswith("an airfoil of ours\n")
    assert_allclose(read_airfoil(path), oriented(xy), rtol=0, atol=1e-10)


@pytest.mark.parametrize("layout", ["selig", "lednicer"])
def test_a_blade_gives_a_folder_of_airfoil_files(tmp_path, layout):
    definition = bg.read("iea15mw")
    (said,) = bg.write(definition, tmp_path / "foils", format=layout)
    assert "8 airfoils" in str(said)
    files, unusable = read_folder(tmp_path / "foils")
    assert not unusable
    for station in definition.stations:
        wanted = oriented(station.airfoil.coordinates)
        assert_allclose(files[station.airfoil.name], wanted, rtol=0, atol=1e-10)


def test_airfoil_names_become_files_that_differ(tmp_path):
    first, second = Airfoil("../a", naca(0.3, 0.02, 0.0)), Airfoil("a", naca(0.2, 0.02, 0.0))
    stations = (Station(0.0, first), Station(1.0, second))
    bg.write(replace(bg.read("nrel5mw"), stations=stations), tmp_path / "foils")
    assert {path.name for path in (tmp_path / "foils").glob("*.dat")} == {"a.dat", "a-2.dat"}
    with pytest.raises(ExportError, match="layout: got 'xfoil', allowed are selig, lednicer"):
        bg.write_airfoil(first, tmp_path / "a.dat", layout="xfoil")
