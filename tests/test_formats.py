"""A blade goes out into every format and comes back, within what the format can hold."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from numpy.testing import assert_allclose, assert_array_equal
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands
from bladegen.definition.blade_definition import (
    Airfoil,
    BladeDefinition,
    Distribution,
    ReferenceAxis,
    Rotor,
    Station,
)
from bladegen.definition.conventions import axis_of_line, curve_length, line_of_axis
from bladegen.formats.common.redefinition import redefined
from bladegen.formats.common.resampling import MOST_NODES, common_grid, shape_grid
from bladegen.support.arrays import Array
from strategies import definitions, few, tenth

NAMES = ("dtu10mw", "iea15mw", "nrel5mw")
XLSX = pytest.param("xlsx", marks=pytest.mark.nightly)  # csv's tables again, slowly
FILES = {"openfast": "blade.dat", "hawc2": "blade.htc", "xlsx": "blade.xlsx", "csv": "blade.csv"}
# mm between the surfaces: the largest of the table in docs/formats.md
WITHIN = {"openfast": 0.47, "hawc2": 0.41, "xlsx": 0.41, "csv": 1e-6}
SPANS = np.linspace(0.05, 1.0, 31)
RUN = CliRunner()


def apart(one: Array, other: Array) -> float:
    """The largest distance from points of sections (k, n, 3) to the polygons of others."""
    worst = 0.0
    for points, polygon in zip(one[:, ::5], other, strict=True):
        start, side = polygon[:-1], np.diff(polygon, axis=0)
        to = points[:, None] - start
        square = np.maximum(np.sum(side**2, axis=-1), 1e-30)
        share = np.clip(np.sum(to * side, axis=-1) / square, 0.0, 1.0)
        gap = np.linalg.norm(to - share[..., None] * side, axis=-1).min(axis=1)
        worst = max(worst, float(gap.max()))
    return worst


def surfaces_apart(one: BladeDefinition, other: BladeDefinition, count: int = 61) -> float:
    """How far two blades lie apart at sections between their stations, of one z [mm]."""
    spans = np.linspace(0.0, 1.0, count)
    z = one.axis.z(spans) - one.axis.z(0.0)
    fine = np.linspace(0.0, 1.0, 20_001)
    at = np.interp(z, other.axis.z(fine) - other.axis.z(0.0), fine)
    first = bg.Blade.from_definition(one, landmarks=401).sections(spans)
    second = bg.Blade.from_definition(other, landmarks=401).sections(at)
    return 1e3 * max(apart(first, second), apart(second, first))


def in_format(name: str, format_: str):
    """A case; formats that take seconds are tried with one blade by day."""
    slow = format_ in ("openfast", "xlsx") and (name, format_) != ("iea15mw", "openfast")
    return pytest.param(name, format_, marks=[pytest.mark.nightly] * slow)


@pytest.mark.parametrize(("name", "format_"), [in_format(n, f) for n in NAMES for f in FILES])
def test_a_bundled_blade_comes_back(tmp_path, name, format_):
    first, path = bg.read(name), tmp_path / FILES[format_]
    bg.write(first, path)
    second = bg.read(path)
    assert surfaces_apart(first, second) < WITHIN[format_]
    eta = second.chord.grid
    for quantity in ("chord", "twist"):
        wanted = getattr(first, quantity)(eta)
        assert_allclose(getattr(second, quantity)(eta), wanted, rtol=0, atol=1e-12)
    assert_allclose(second.axis(eta), first.axis(eta), rtol=0, atol=2e-4)
    assert second.length == pytest.approx(first.length, rel=1e-14)


@pytest.mark.parametrize("name", NAMES)
def test_a_csv_file_holds_a_definition_whole(tmp_path, name):
    first = bg.read(name)
    left_out = [] if first.structure is None else ["structure"]
    assert [said.where for said in bg.write(first, tmp_path / "blade.csv")] == left_out
    second = bg.read(tmp_path / "blade.csv")
    for field in ("chord", "relative_thickness", "section_offset_y"):
        mine, own = getattr(second, field), getattr(first, field)
        assert_array_equal(mine.grid, own.grid)
        assert_array_equal(mine.values, own.values)
    assert_array_equal(second.twist.grid, first.twist.grid)
    assert_allclose(second.twist.values, first.twist.values, rtol=1e-15, atol=1e-17)
    for axis in "xyz":
        assert_array_equal(getattr(second.axis, axis).values, getattr(first.axis, axis).values)
    assert [(s.eta, s.airfoil.name) for s in second.stations] == [
        (s.eta, s.airfoil.name) for s in first.stations
    ]
    for mine, own in zip(second.stations, first.stations, strict=True):
        assert_array_equal(mine.airfoil.coordinates, own.airfoil.coordinates)
    assert second.description == first.description
    for field in ("blades", "hub_radius", "diameter"):
        assert getattr(second.rotor, field) == getattr(first.rotor, field)
    assert second.rotor.cone == pytest.approx(first.rotor.cone, rel=1e-15)


@pytest.mark.parametrize("format_", FILES)
@settings(max_examples=few(3), deadline=None, phases=(Phase.generate,))
@given(first=definitions())
def test_any_blade_comes_back(tmp_path_factory, format_, first):
    path = tmp_path_factory.mktemp("formats") / FILES[format_]
    bg.write(first, path)
    second = bg.read(path)
    assert surfaces_apart(first, second, 23) < (2.0 if format_ != "csv" else 1e-3)


@pytest.fixture(scope="module")
def perturbed() -> tuple[BladeDefinition, Array, Array]:
    """The definition of a perturbed NREL 5 MW, and sections of it and of the plain blade."""
    plain = bg.Blade.from_definition(bg.read("nrel5mw"))
    variant = plain.perturbed(
        bg.ShapeSpace.bundled(), [0.04, -0.03, 0.02, 0.01], thickness=1.03, twist=0.02
    )
    return redefined(variant), variant.sections(SPANS), plain.sections(SPANS)


@pytest.mark.parametrize("format_", ["openfast", "hawc2", XLSX, "csv"])
def test_a_perturbed_blade_goes_out(tmp_path, format_, perturbed):
    definition, wanted, plain = perturbed
    path = tmp_path / FILES[format_]
    bg.write(definition, path)
    made = bg.Blade.from_definition(bg.read(path), landmarks=401).sections(SPANS)
    assert 1e3 * max(apart(wanted, made), apart(made, wanted)) < 0.5  # docs/formats.md
    assert 1e3 * apart(plain, made) > 20.0  # the change is in the file


def changed(**changes) -> BladeDefinition:
    """The NREL 5 MW with other parts."""
    return replace(bg.read("nrel5mw"), **changes)


@pytest.mark.parametrize("format_", ["openfast", "hawc2", XLSX, "csv"])
def test_swept_blades_with_offsets_and_no_thickness_come_back(tmp_path, format_):
    plain = bg.read("nrel5mw")
    grid = np.linspace(0.0, 1.0, 5)
    swept = changed(
        axis=replace(plain.axis, y=Distribution(grid, np.array([0.0, 0.1, 0.5, 2.0, 4.0]))),
        section_offset_x=Distribution(grid, np.array([0.0, 0.02, 0.05, 0.03, 0.0])),
        relative_thickness=None,
        rotor=Rotor(),
    )
    path = tmp_path / FILES[format_]
    said = [str(finding) for finding in bg.write(swept, path)]
    again = bg.read(path)
    # docs/formats.md: 2.01 mm where a format has no place for offsets normal to the chord
    promised = {"openfast": 2.01, "hawc2": 2.03, "xlsx": 0.5, "csv": 1e-6}
    assert surfaces_apart(swept, again) < promised[format_]
    if format_ in ("openfast", "hawc2"):
        assert any("section_offset_x" in line for line in said)
        assert not any("rotor" in line for line in said)
        assert_allclose(again.axis.y(grid), swept.axis.y(grid), rtol=0, atol=0.006)


@pytest.mark.parametrize("format_", ["openfast", "hawc2"])
def test_a_blade_swept_beyond_its_chord_is_told_without_our_notes(tmp_path, format_):
    plain = tenth()
    sweep = Distribution(np.array([0.0, 0.5, 1.0]), np.array([0.0, 0.1, 0.6]))
    path = tmp_path / FILES[format_]
    bg.write(replace(plain, axis=replace(plain.axis, y=sweep)), path)
    if format_ == "openfast":
        (tmp_path / "blade_ElastoDyn_twist.dat").unlink()
    else:
        text = path.read_text().splitlines()
        path.write_text("\n".join(line.split("; pitch")[0] for line in text))
    again = bg.read(path)
    assert any("the blade is swept" in str(finding) for finding in again.findings)
    assert again.axis.y(1.0) == pytest.approx(0.6, abs=0.1)


def test_axis_and_line_are_each_other_s_way_back():
    rng = np.random.default_rng(3)
    chord, twist = rng.uniform(1.0, 5.0, 20), rng.uniform(-0.2, 0.3, 20)
    x, y, offset = rng.normal(size=20), rng.normal(size=20), chord * rng.uniform(0.2, 0.5, 20)
    at = line_of_axis(x, y, chord, twist, offset, 0.25)
    back = axis_of_line(*at, chord, twist, 0.25, offset / chord)
    for mine, own in zip((back.x, back.y, back.offset), (x, y, offset), strict=True):
        assert_allclose(mine, own, rtol=0, atol=1e-14)
    at = line_of_axis(x, np.zeros(20), chord, twist, offset, 0.5)
    back = axis_of_line(*at, chord, twist, 0.5)
    assert back.straight
    assert_allclose(back.x, x, rtol=0, atol=1e-14)
    assert_allclose(back.offset, offset, rtol=0, atol=1e-14)


def test_a_line_with_denormal_steps_has_a_length():
    z = np.linspace(0.0, 2.0, 5)
    _, length = curve_length(np.array([0.0, 5e-324, 1e-323, 0.0, 0.0]), np.zeros(5), z)
    assert_allclose(length[-1], 2.0, rtol=1e-12)


def test_the_length_of_a_curve_is_that_of_a_circle():
    z = np.linspace(0.0, 1.0, 41)
    spans, length = curve_length(2.0 - np.sqrt(4.0 - z**2), np.zeros(41), z)
    assert_allclose(length[::16], 2.0 * np.arcsin(z / 2.0), rtol=0, atol=2e-6)
    assert_array_equal(spans[::16], z)


def test_a_common_grid_is_as_coarse_as_the_tolerance_allows():
    definition = bg.read("iea15mw")
    sizes = []
    for tolerance in (1e-2, 1e-3, 2e-4):
        grid, loss = common_grid(definition, tolerance)
        assert loss <= tolerance
        assert np.all(np.diff(grid) > 0)
        assert {s.eta for s in definition.stations} <= set(grid.tolist())
        sizes.append(len(grid))
    assert sizes == sorted(sizes)
    grid, loss = common_grid(definition, 1e-9)
    assert len(grid) <= MOST_NODES
    assert loss > 1e-9
    blade = bg.Blade.from_definition(definition)
    assert set(np.linspace(0.0, 1.0, 5)) < set(shape_grid(blade, np.linspace(0.0, 1.0, 5)).tolist())


def test_grid_points_that_nearly_meet_are_one():
    plain = bg.read("nrel5mw")
    grid = np.array([0.0, 0.5, 1.0 - 1e-8])
    near = replace(plain, twist=Distribution(grid, np.array([0.2, 0.1, 0.0])))
    assert np.diff(common_grid(near)[0]).min() > 1e-7
    assert common_grid(near)[0][-1] == 1.0


@pytest.mark.parametrize("gap", [1e-10, 1e-13, 2**-53])
def test_grids_that_all_but_meet_are_kept_in_a_csv_file(tmp_path, gap):
    eta = np.array([0.0, 0.3, 0.5, 0.8, 1.0])
    near = eta + gap * np.array([0.0, 0.0, 1.0, -1.0, 0.0])
    values = np.array([4.0, 5.0, 4.0, 2.0, 1.0])
    given = changed(chord=Distribution(eta, values), twist=Distribution(near, values / 20.0))
    bg.write(given, tmp_path / "a.csv")
    made = bg.read(tmp_path / "a.csv")
    assert_array_equal(made.chord.grid, eta)
    assert_array_equal(made.twist.grid, near)
    assert_array_equal(made.chord.values, values)


def test_airfoils_of_one_name_and_odd_names_are_kept_apart(tmp_path):
    plain = tenth()
    _first, *_, last = plain.stations
    names = ["=1+1", "foil", "foil", "a/b\x07 [x]", "foil"]
    airfoils = [Airfoil(name, last.airfoil.coordinates) for name in names]
    odd = replace(
        plain,
        stations=tuple(
            Station(float(eta), airfoil)
            for eta, airfoil in zip(np.linspace(0, 1, 5), airfoils, strict=True)
        ),
    )
    for file in ("blade.csv", "blade.xlsx", "blade.htc", "blade.dat"):
        bg.write(odd, tmp_path / file)
        again = bg.read(tmp_path / file)
        assert again.stations[-1].eta == 1.0
    read = [s.airfoil.name for s in bg.read(tmp_path / "blade.csv").stations]
    assert read == ["1+1", "foil", "foil (2)", "a/b [x]", "foil (3)"]
    assert all(path.parent.parent == tmp_path for path in tmp_path.glob("*/*"))


def test_a_shorter_blade_leaves_no_airfoils_of_the_longer_behind(tmp_path):
    path = tmp_path / "blade.dat"
    bg.write(tenth("iea15mw"), path)
    before = len(list((tmp_path / "blade_dat_airfoils").iterdir()))
    bg.write(tenth(), path)
    after = sorted((tmp_path / "blade_dat_airfoils").iterdir())
    assert len(after) < before
    assert len(bg.read(path).stations) >= len(after)


def run(*arguments: object) -> str:
    result = RUN.invoke(commands.app, [str(argument) for argument in arguments])
    assert result.exit_code == 0, (result.output, result.exception)
    return " ".join(result.output.split())


def test_an_openfast_and_a_hawc2_user_convert(tmp_path: Path):
    bg.write(tenth(), tmp_path / "zero.csv")
    said = run("convert", tmp_path / "zero.csv", tmp_path / "one.dat")
    assert "OpenFAST" in said
    assert "polars are not written" in said
    said = run("convert", tmp_path / "one.dat", tmp_path / "two.htc")
    assert "HAWC2 has no shapes" in said
    said = run("convert", tmp_path / "two.htc", tmp_path / "three.csv")
    assert "spanwise table" in said
    third = bg.read(tmp_path / "three.csv")
    assert surfaces_apart(tenth(), third) < 0.5


def test_nodes_for_shapes_leave_no_quantity_off(tmp_path):
    """PCHIP changes with each point of its grid, so those added for shapes are checked too."""
    small = tenth()
    axis = ReferenceAxis(*(scaled(q, 10.0) for q in (small.axis.x, small.axis.y, small.axis.z)))
    whole = replace(small, chord=scaled(small.chord, 10.0), axis=axis)
    said = bg.write(whole, tmp_path / "a.dat")
    assert not [finding for finding in said if finding.where == "read back"]
    (nodes,) = (finding.message for finding in said if finding.where == "BlSpn")
    assert nodes.endswith("at most 0.48 mm off")


def scaled(quantity, factor):
    return Distribution(quantity.grid, factor * quantity.values)
