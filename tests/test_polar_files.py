"""Polars in the files of OpenFAST and HAWC2: what goes out, and what comes back."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from shutil import copytree
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from refusals import findings, problems
from typer.testing import CliRunner

import bladegen as bg
from bladegen.airfoils.polars import BORROWED, Polar
from bladegen.cli import commands
from bladegen.definition.blade_definition import Airfoil, BladeDefinition, Distribution, Station
from bladegen.definition.blending import Between, between, completed, of_their_own
from bladegen.errors import ExportError
from bladegen.formats.common.document import Notes
from bladegen.formats.hawc2.polar_reading import profile_sets as read_sets
from bladegen.formats.into import with_polars_of, write_into
from bladegen.formats.openfast.polar_reading import Columns
from bladegen.formats.openfast.polar_reading import polars as read_tables
from strategies import few, naca, tenth

ALPHA = np.radians(np.arange(-180.0, 181.0, 20.0))


def polar(lift: float = 1.0, **changes) -> Polar:
    """A polar with the lift of a plate."""
    drag = 0.01 + lift * np.sin(ALPHA) ** 2
    return Polar(ALPHA, lift * np.sin(2.0 * ALPHA), drag, -0.1 * lift * np.sin(ALPHA), **changes)


@cache
def with_polars(*reynolds: float | None, whole: bool = False, **changes: Any) -> BladeDefinition:
    """A bundled blade, small or `whole`, the lift of its airfoils growing from root to tip."""
    plain = bg.read("nrel5mw") if whole else tenth()
    made: dict[str, Airfoil] = {}
    for k, station in enumerate(plain.stations):
        own = tuple(polar(1.0 + 0.1 * k, reynolds=re, **changes) for re in reynolds)
        made.setdefault(station.airfoil.name, replace(station.airfoil, polars=own))
    stations = tuple(Station(s.eta, made[s.airfoil.name]) for s in plain.stations)
    return replace(plain, stations=stations)


def lift(definition: BladeDefinition, eta: float, alpha: float = np.radians(20.0)) -> float:
    """The lift at an angle, blended as the blade's polars are."""
    (found, *_) = between(definition, eta).polars()
    return float(found.at(np.array([alpha]))[0][0])


# ---- between airfoils ----------------------------------------------------------------------------


@given(st.floats(0.0, 1.0))
def test_polars_between_stations_follow_the_thickness(eta):
    blade = with_polars(4e6)
    place = between(blade, eta)
    assert blade.relative_thickness is not None
    ends = [a.relative_thickness or 1.0 for a in (place.one, place.other)]
    here = float(blade.relative_thickness(eta))
    assert (1.0 - place.weight) * ends[0] + place.weight * ends[1] == pytest.approx(here, abs=2e-3)
    parts = [a.polars[0].at(ALPHA)[0] for a in (place.one, place.other)]
    mixed = place.polars()[0].at(ALPHA)[0]
    assert_allclose(mixed, (1.0 - place.weight) * parts[0] + place.weight * parts[1], atol=1e-12)


def test_a_station_keeps_its_own_polars_and_blends_bear_the_worst_mark():
    blade = with_polars(4e6)
    for station in blade.stations:
        assert between(blade, station.eta).polars() is station.airfoil.polars
    plain, guess, lent = (
        Airfoil(source, naca(0.2, 0, 0), polars=(polar(source=source),))
        for source in ("tunnel", "estimate: by hand", f"{BORROWED}, not of this shape: x")
    )
    (mixed,) = Between(plain, guess, 0.25).polars()
    assert mixed.source == (
        "estimate: by hand; between tunnel and estimate: by hand, 25 % of the latter"
    )
    assert mixed.is_estimate
    assert Between(guess, lent, 0.9).polars()[0].is_borrowed
    (same,) = Between(plain, replace(plain, name="other"), 0.5).polars()
    assert same.source == "tunnel; between tunnel and other, 50 % of the latter"
    assert Between(plain, replace(plain, polars=()), 0.5).polars() == ()
    assert of_their_own(plain.polars)
    assert not of_their_own(())
    assert not any(of_their_own(one.polars) for one in (guess, lent))


@given(st.floats(-60.0, -4.0), st.floats(4.0, 60.0))
def test_a_completed_polar_reaches_round_and_keeps_what_was_given(low, high):
    alpha = np.radians(np.linspace(low, high, 30))
    part = Polar(alpha, 5.0 * alpha, 0.01 + alpha**2, 0 * alpha, source="tunnel")
    whole = completed(part)
    assert_allclose(whole.alpha[[0, -1]], [-np.pi, np.pi], rtol=0, atol=0)
    for one, other in zip(whole.at(alpha), (part.cl, part.cd, part.cm), strict=True):
        assert_allclose(one, other, atol=1e-12)
    assert whole.source.startswith("tunnel; Viterna beyond ")
    assert completed(whole) is whole


def test_a_table_that_all_but_reaches_round_is_drawn_out_without_a_word():
    alpha = np.radians(np.array([-179.5, 0.0, 179.5]))
    part = Polar(alpha, np.array([0.1, 0.2, 0.3]), np.ones(3), np.zeros(3))
    whole = completed(part)
    assert_allclose(whole.cl, [0.1, 0.1, 0.2, 0.3, 0.3])
    assert whole.source == ""
    half = completed(Polar(alpha[1:], np.array([0.2, 0.3]), np.ones(2), np.zeros(2)))
    assert_allclose(half.cl[[0, -1]], [0.2, 0.3])
    assert half.source == "end values beyond 0 to 179.5 deg"


# ---- OpenFAST ------------------------------------------------------------------------------------


def rows_of(path: Path) -> list[tuple[str, str]]:
    """The values of an airfoil file with their labels, as AeroDyn reads them."""
    lines = [line.split() for line in path.read_text().splitlines() if line[:1] != "!"]
    return [(words[1], words[0]) for words in lines if len(words) > 1 and not words[1][0].isdigit()]


def test_airfoil_files_have_aerodyns_layout(tmp_path):
    blade = with_polars(9e6, 3e6, parameters=(("aoa0", -2.5), ("eta_e", 1.0)))
    bg.write(blade, tmp_path / "blade.dat")
    folder = tmp_path / "blade_dat_airfoils"
    found = rows_of(folder / "blade_AF009.dat")
    labels = [label for label, _ in found if not label.startswith("-")]
    head = ["InterpOrd", "RelThickness", "NonDimArea", "NumCoords", "BL_file", "NumTabs"]
    assert labels[:6] == head
    constants = (
        *("alpha0", "alpha1", "alpha2", "eta_e", "C_nalpha", "T_f0", "T_V0", "T_p", "T_VL"),
        *("b1", "b2", "b5", "A1", "A2", "A5", "S1", "S2", "S3", "S4", "Cn1", "Cn2", "St_sh"),
        *("Cd0", "Cm0", "k0", "k1", "k2", "k3", "k1_hat", "x_cp_bar", "UACutout", "filtCutOff"),
    )
    assert labels[6:] == ["Re", "UserProp", "InclUAdata", *constants, "NumAlf"] * 2
    values = dict(found)
    assert values["NumCoords"] == '@"blade_AF009_Coords.txt"'
    assert [value for label, value in found if label == "Re"] == ["3.0", "9.0"]
    assert (values["alpha0"], values["eta_e"], values["alpha1"]) == ("-2.5", "1.0", "DEFAULT")
    assert values["NumAlf"] == str(len(ALPHA))
    part = (tmp_path / "blade_AeroDyn_part.dat").read_text()
    assert "2                       AFTabMod" in part
    assert part.count("blade_dat_airfoils/blade_AF") == len(list(folder.glob("*_Coords.txt")))
    assert '"blade.dat"             ADBlFile(3)' in part


def test_polars_come_back_from_openfast(tmp_path):
    blade = with_polars(9e6, 3e6, parameters=(("aoa0", -2.5), ("cn1", 1.5)), source="tunnel")
    bg.write(blade, tmp_path / "blade.dat")
    again = bg.read(tmp_path / "blade.dat")
    assert not [finding for finding in again.findings if "polars" in str(finding)]
    for eta in (0.0, 0.1, 0.3, 0.65, 1.0):
        assert lift(again, eta) == pytest.approx(lift(blade, eta), abs=0.01)
    mine, own = again.stations[-1].airfoil, blade.stations[-1].airfoil
    assert [p.reynolds for p in mine.polars] == [3e6, 9e6]
    assert_allclose(mine.polars[1].alpha, own.polars[0].alpha, rtol=0, atol=1e-15)
    assert_array_equal(mine.polars[1].cm, own.polars[0].cm)
    assert dict(mine.polars[1].parameters) == {"aoa0": -2.5, "cn1": 1.5}
    assert mine.polars[0].source == "tunnel"
    assert mine.aerodynamic_center == pytest.approx(own.aerodynamic_center)


def test_published_polars_bring_their_reference_point(tmp_path):
    blade = with_polars(4e6)
    centres = {station.airfoil.aerodynamic_center for station in blade.stations}
    assert centres == {0.5, 0.275}
    bg.write(blade, tmp_path / "own.dat")
    said = (tmp_path / "own_dat_airfoils" / "own_AF030_Coords.txt").read_text().splitlines()
    assert float(said[3].split()[0]) == 0.275
    bg.write(with_polars(4e6, source="estimate: x"), tmp_path / "made.dat")
    said = (tmp_path / "made_dat_airfoils" / "made_AF030_Coords.txt").read_text().splitlines()
    assert float(said[3].split()[0]) == 0.25


def test_nodes_of_one_shape_and_two_polars_have_two_files(tmp_path):
    plain = with_polars(4e6)
    root = plain.stations[0].airfoil
    stations = (plain.stations[0], Station(0.01, replace(root, polars=(polar(9.0),))))
    bg.write(replace(plain, stations=(*stations, *plain.stations[1:])), tmp_path / "blade.dat")
    again = bg.read(tmp_path / "blade.dat")
    assert lift(again, 0.01) == pytest.approx(9.0 * np.sin(np.radians(40.0)))
    assert lift(again, 0.0) == pytest.approx(np.sin(np.radians(40.0)))


def test_an_unknown_reynolds_number_stays_unknown(tmp_path):
    bg.write(with_polars(None), tmp_path / "blade.dat")
    text = (tmp_path / "blade_dat_airfoils" / "blade_AF001.dat").read_text()
    assert "! reynolds: unknown" in text
    assert bg.read(tmp_path / "blade.dat").stations[0].airfoil.polars[0].reynolds is None
    first, other = polar(configuration="clean"), polar(2.0, configuration="rough")
    plain = tenth()
    two = tuple(Station(s.eta, replace(s.airfoil, polars=(first, other))) for s in plain.stations)
    said = bg.write(replace(plain, stations=two), tmp_path / "blade.dat")
    assert "of the first configuration alone: Cylinder1, " in " ".join(map(str, said))
    assert bg.read(tmp_path / "blade.dat").stations[0].airfoil.polars[0].configuration == "clean"


@pytest.mark.parametrize("suffix", ["csv", "xlsx"])
def test_a_format_without_polars_says_that_they_are_left_out(tmp_path, suffix):
    def said(blade, **asked):
        findings = bg.write(blade, tmp_path / f"blade.{suffix}", **asked)
        return [str(one) for one in findings if str(one).startswith("polars: ")]

    (line,) = said(with_polars(4e6))
    assert line.startswith("polars: have no place in spanwise table (")
    assert line.endswith("; left out")
    assert said(tenth()) == []
    assert said(tenth(), polars="keep") == said(tenth(), polars="none") == []
    assert said(tenth(), polars="estimate") == [line]


@pytest.mark.parametrize("suffix", ["yaml", "dat"])
@pytest.mark.parametrize("policy", [None, "estimate"])
def test_a_blade_from_a_table_keeps_the_polars_of_the_model(tmp_path, suffix, policy):
    blade = with_polars(4e6)
    model, table = tmp_path / f"model.{suffix}", tmp_path / "table.csv"
    bg.write(blade, model)
    main = model
    if suffix == "dat":
        main = tmp_path / "main.dat"
        part = (tmp_path / "model_AeroDyn_part.dat").read_text()
        main.write_text(f"------- AERODYN INPUT FILE ----\ntitle\n{part}")
    bg.write(bg.read(model), table)
    words = [str(word) for word in ("convert", table, tmp_path / f"new.{suffix}", "--into", main)]
    result = CliRunner().invoke(commands.app, words + ["--polars", str(policy)] * bool(policy))
    assert result.exit_code == 0, result.output
    before = {s.airfoil.name: s.airfoil.polars for s in bg.read(model).stations}
    assert f"{len(before)} airfoils of {main.name} keep theirs" in " ".join(result.output.split())
    after = bg.read(tmp_path / f"new.{suffix}")
    assert all(not s.airfoil.polars[0].is_estimate for s in after.stations)
    assert lift(after, 0.0) == pytest.approx(lift(blade, 0.0))
    assert lift(after, 1.0) == pytest.approx(lift(blade, 1.0))


def test_an_airfoil_of_another_shape_takes_no_polars_of_its_name(tmp_path):
    blade, model = with_polars(4e6), tmp_path / "model.yaml"
    bg.write(blade, model)
    (first, *others) = blade.stations
    bare = replace(first.airfoil, polars=())
    moved = replace(bare, coordinates=bare.coordinates * [1.0, 0.9])
    changed = replace(blade, stations=(Station(0.0, moved), *others))
    assert with_polars_of(changed, model) == (changed, ())
    changed = replace(blade, stations=(Station(0.0, bare), *others))
    found, (said,) = with_polars_of(changed, model)
    assert str(said) == "polars: 1 airfoil of model.yaml keeps its own"
    assert found.stations[0].airfoil.polars[0].reynolds == 4e6
    assert with_polars_of(changed, tmp_path / "none.yaml") == (changed, ())


def test_nodes_of_aerodyn_are_as_many_as_are_asked_for(tmp_path):
    blade = with_polars(4e6)
    said = " ".join(map(str, bg.write(blade, tmp_path / "blade.dat", nodes=30)))
    assert "BlSpn: 30 nodes for all quantities" in said
    made = bg.read(tmp_path / "blade.dat")
    eta = np.linspace(0.0, 1.0, 30)
    assert len(made.chord.grid) == 30
    assert_allclose(made.chord.grid, eta, atol=1e-9)
    assert_allclose(made.chord.values, blade.chord(eta), rtol=1e-12)
    assert_allclose(made.twist.values, blade.twist(eta), atol=1e-12)
    main = tmp_path / "main.dat"
    part = (tmp_path / "blade_AeroDyn_part.dat").read_text()
    main.write_text(f"------- AERODYN INPUT FILE ----\ntitle\n{part}")
    write_into(blade, main, tmp_path / "new.dat", nodes=20)
    assert len(bg.read(tmp_path / "new.dat").chord.grid) == 20


@pytest.mark.parametrize(
    ("suffix", "nodes", "told"),
    [
        ("dat", 9, "nodes: got 9, allowed are 10 to 400"),
        ("dat", 401, "nodes: got 401, allowed are 10 to 400"),
        ("yaml", 30, "nodes: got 30, only AeroDyn's blades have nodes of their own"),
    ],
)
def test_nodes_that_cannot_be_are_refused(tmp_path, suffix, nodes, told):
    with pytest.raises(ExportError, match=told):
        bg.write(tenth(), tmp_path / f"blade.{suffix}", nodes=nodes)
    assert list(tmp_path.iterdir()) == []


def test_polars_that_go_leave_no_files_behind(tmp_path):
    blade = with_polars(4e6)
    for suffix in ("dat", "htc"):
        bg.write(blade, tmp_path / f"blade.{suffix}")
    bg.write(blade, tmp_path / "blade.dat", polars="none")
    bg.write(blade, tmp_path / "blade.htc", polars="none")
    left = {path.name for path in tmp_path.rglob("*") if path.is_file()}
    assert not left & {"blade_AeroDyn_part.dat", "blade_AF001.dat", "blade_pc.dat"}
    assert not any(s.airfoil.polars for s in bg.read(tmp_path / "blade.dat").stations)
    some = replace(blade, stations=(tenth().stations[0], *blade.stations[1:]))
    for suffix in ("dat", "htc"):
        said = " ".join(map(str, bg.write(some, tmp_path / f"blade.{suffix}")))
        assert "polars are not written: Cylinder1 have none" in said


TABLE = """! source: a tunnel
! configuration: rough
1.5  Re
0 UserProp
False InclUAdata
3 NumAlf
-180 0 1 0
0 0.5 0.01 -0.1
180 0 1 0
"""


def test_tables_of_others_are_read():
    text = TABLE.replace("0 0.5 0.01 -0.1", "0 -0.1 0.01 0.5 ! a comment").splitlines()
    notes = Notes()
    (made,) = read_tables(text, "file", notes, Columns(1, 4, 3, 2))
    assert (made.cl[1], made.cm[1], made.reynolds) == (0.5, -0.1, 1.5e6)
    assert (made.source, made.configuration) == ("a tunnel", "rough")
    (bare,) = read_tables(TABLE.splitlines(), "file", notes, Columns(cm=0))
    assert not bare.cm.any()
    assert not notes.findings
    assert read_tables(["no tables"], "file", notes) == ()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("3 NumAlf", "many NumAlf", "NumAlf: got 'many', allowed is 2 to 10000"),
        ("3 NumAlf", "4 NumAlf", "the last table ends 1 rows before NumAlf"),
        ("0 0.5 0.01", "0 x 0.01", "row 2 of a table: got '0 x 0.01 -0.1', must be 4 numbers"),
        ("0 0.5 0.01", "0 500 0.01", "Cl: allowed is -100 to 100"),
        ("180 0 1 0\n", "181 0 1 0\n", "alpha: allowed is -180"),
        ("0 0.5", "-180 0.5", "alpha must increase strictly"),
        ("1.5 ", "1e9 ", "Re: got 1e+09 millions"),
    ],
)
def test_tables_that_cannot_be_read_are_left_out_and_said(old, new, said):
    assert old in TABLE
    notes = Notes()
    text = "180 0 1 0\n".join(TABLE.replace(old, new, 1).rsplit("180 0 1 0\n", 1))
    if old == "180 0 1 0\n":
        text = "181 0 1 0\n".join(TABLE.rsplit(old, 1))
    assert read_tables(text.splitlines(), "file", notes) == ()
    assert said in str(notes.findings[0])
    assert "file: polars left out" in str(notes.findings[0])


# ---- a turbine's .fst file ----------------------------------------------------------------------


@pytest.fixture(scope="module")
def model(tmp_path_factory) -> Path:
    """A model in the folders of published ones: files of several turbines in a folder beside."""
    folder = tmp_path_factory.mktemp("model")
    (folder / "Shared").mkdir()
    (folder / "Land").mkdir()
    bg.write(with_polars(4e6), folder / "Shared" / "blade.dat")
    part = (folder / "Shared" / "blade_AeroDyn_part.dat").read_text()
    for name in ('"blade.dat"', '"blade_dat_airfoils'):
        part = part.replace(name, f'"../Shared/{name[1:]}')
    (folder / "Land" / "AeroDyn.dat").write_text(part)
    (folder / "Land" / "ElastoDyn.dat").write_text(
        "2 NumBl - blades\n7.65 TipRad - m\n1.5 HubRad - m\n-2.5 PreCone(1) - deg\n"
        "-5.0 ShftTilt - deg\n"
    )
    (folder / "Land" / "turbine.fst").write_text(
        "--- OpenFAST INPUT FILE ---\n2 CompAero - aerodynamics\n"
        '"ElastoDyn.dat"    EDFile    - structure\n"AeroDyn.dat"  AeroFile - aerodynamics\n'
    )
    return folder


@pytest.fixture
def turbine(model, tmp_path) -> Path:
    """The model's .fst file, in a folder of its own."""
    copytree(model, tmp_path / "model")
    return tmp_path / "model" / "Land" / "turbine.fst"


def test_a_turbine_file_leads_to_its_blade(turbine):
    made = bg.read(turbine)
    assert (made.name, made.format) == ("turbine", "OpenFAST")
    assert (made.rotor.blades, made.rotor.hub_radius, made.rotor.diameter) == (2, 1.5, 15.3)
    assert made.rotor.cone == pytest.approx(np.radians(2.5))
    assert made.rotor.tilt == pytest.approx(np.radians(5.0))
    assert lift(made, 0.5) == pytest.approx(lift(with_polars(4e6), 0.5), abs=0.01)
    assert "TipRad" not in findings(made)
    result = CliRunner().invoke(commands.app, ["info", str(turbine)])
    assert result.exit_code == 0, result.output


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        ("turbine.fst", '"AeroDyn.dat"', '"../../x.dat"', "AeroFile: got '../../x.dat', must be"),
        ("turbine.fst", '"AeroDyn.dat"', '"unused"', "AeroFile: got 'unused', must be AeroDyn's"),
        ("turbine.fst", '"AeroDyn.dat"', '"ElastoDyn.dat"', "(with ADBlFile(1))"),
        ("turbine.fst", "AeroFile", "Aero", "AeroFile: got 'nothing'"),
        ("AeroDyn.dat", '"../Shared/blade.dat', '"../../blade.dat', "ADBlFile(1): got '../../bl"),
        ("AeroDyn.dat", '"../Shared/blade_dat_', '"../../b_', "AFNames, entry 1: '../../b_"),
    ],
)
def test_turbine_files_lead_nowhere_else(tmp_path, turbine, file, old, new, said):
    for name in ("x.dat", "blade.dat"):
        (tmp_path / name).write_text("secret")
    edit(turbine.with_name(file), old, new)
    assert said in problems(turbine)


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        ("turbine.fst", "ElastoDyn.dat", "../../x.dat", "EDFile: '../../x.dat' is no file in "),
        ("ElastoDyn.dat", "7.65 TipRad", "9.65 TipRad", "TipRad, HubRad: of ElastoDyn are 8.15 m"),
        ("ElastoDyn.dat", "1.5 HubRad", "-1 HubRad", "EDFile, HubRad: got '-1', allowed is 0 to"),
        ("ElastoDyn.dat", "-5.0 ShftTilt", "-5.0 Tilt", "EDFile, ShftTilt: is missing; passed"),
    ],
)
def test_what_is_odd_in_a_rotor_is_said(turbine, file, old, new, said):
    edit(turbine.with_name(file), old, new)
    assert said in findings(bg.read(turbine))


def test_an_empty_blade_file_is_refused(turbine):
    (turbine.parent.parent / "Shared" / "blade.dat").write_text("")
    assert "columns: BlSpn, BlCrvAC, BlSwpAC" in problems(turbine)


def test_chords_of_all_but_nothing_are_refused(tmp_path):
    bg.write(tenth(), tmp_path / "blade.dat")
    (tmp_path / "blade_ElastoDyn_twist.dat").unlink()
    lines = (tmp_path / "blade.dat").read_text().splitlines()
    chord = lines[15].split()[5]
    edit(tmp_path / "blade.dat", chord, "5e-324")
    assert "chord must be positive, at least" in problems(tmp_path / "blade.dat")


def test_columns_of_airfoil_tables_are_those_of_the_main_input(turbine):
    path = turbine
    edit(path.with_name("AeroDyn.dat"), "4                       InCol_Cm", "0 InCol_Cm")
    assert not bg.read(path).stations[3].airfoil.polars[0].cm.any()
    edit(path.with_name("AeroDyn.dat"), "0 InCol_Cm", "99 InCol_Cm")
    assert bg.read(path).stations[3].airfoil.polars[0].cm.any()


def test_a_blade_goes_back_into_a_model(turbine):
    """Out of the model, changed, and back: all other lines of the main input stay."""
    run, main = CliRunner().invoke, turbine.with_name("AeroDyn.dat")
    edit(main, "True                    UseBlCm", "False UseBlCm - kept")
    main.write_bytes(main.read_bytes().replace(b"\n", b"\r\n").replace(b"- kept", b"- kept \xb0"))
    changed = with_polars(4e6, 8e6)
    source = turbine.with_name("variant.yaml")
    bg.write(replace(changed, chord=Distribution.constant(0.2)), source)
    result = run(commands.app, ["convert", str(source), str(main), "--into", str(main)])
    assert result.exit_code == 0, result.output
    assert "structure" in result.output
    written = main.read_bytes()
    assert b"False UseBlCm - kept \xb0 " in written
    assert written.count(b"\n") == written.count(b"\r\n")
    text = written.decode("latin-1")
    assert "2                       AFTabMod" in text
    assert "../shared" not in text.lower()
    made = bg.read(turbine)
    assert made.chord(0.5) == pytest.approx(0.2)
    assert lift(made, 0.5) == pytest.approx(lift(changed, 0.5), abs=0.01)
    assert made.rotor.hub_radius == 1.5
    said = write_into(changed, main, turbine.parent.parent / "new.dat")
    assert any("names other files as from" in str(finding) for finding in said)


def test_what_no_blade_goes_into_is_refused(turbine):
    other = turbine.with_name("ElastoDyn.dat")
    with pytest.raises(bg.BladegenError, match="is no main input of AeroDyn: NumAFfiles, AFNames"):
        write_into(with_polars(4e6), other, other)
    main = turbine.with_name("AeroDyn.dat")
    before = main.read_text()
    with pytest.raises(bg.BladegenError, match="needs polars, Cylinder1, Cylinder2"):
        write_into(tenth(), main, main)
    assert main.read_text() == before


# ---- HAWC2 ---------------------------------------------------------------------------------------


def published(sets: list[list[tuple[float, float]]]) -> str:
    """A pc file as people write them: sets of (thickness, lift)."""
    lines = [f"{len(sets)} sets"]
    for profiles in sets:
        lines.append(f"{len(profiles)} profiles")
        for k, (thickness, height) in enumerate(profiles):
            lines.append(f"{k + 1} 3 {thickness} Some foil (Re=12x10^6)")
            lines += ["-180 0 0.1 0", f"0 {height} 0.1 0", "180 0 0.1 0", ""]
    return "\n".join(lines)


def pc(path: Path) -> list[list[tuple[float, np.ndarray]]]:
    """The sets of a pc file by a reader of its own: thickness and table of each profile."""
    lines = iter(path.read_text().splitlines())
    sets = []
    for _ in range(int(next(lines).split()[0])):
        profiles = []
        for k in range(int(next(lines))):
            number, rows, thickness = next(lines).split()[:3]
            assert int(number) == k + 1
            table = [[float(word) for word in next(lines).split()] for _ in range(int(rows))]
            profiles.append((float(thickness), np.array(table)))
        sets.append(profiles)
    assert next(lines, None) is None
    return sets


def hawc2_lift(folder: Path, eta: float, alpha: float = 20.0) -> float:
    """The lift that HAWC2 finds: linear in radius for the thickness, in thickness for lift."""
    rows = np.loadtxt(folder / "blade_ae.dat", skiprows=2)
    radius = eta * rows[-1, 0]
    thickness = np.interp(radius, rows[:, 0], rows[:, 2])
    number = int(rows[np.searchsorted(rows[:, 0], radius, side="right") - 1, 3])
    profiles = pc(folder / "blade_pc.dat")[number - 1]
    heights = [np.interp(alpha, table[:, 0], table[:, 1]) for _, table in profiles]
    return float(np.interp(thickness, [thick for thick, _ in profiles], heights))


def test_hawc2_finds_the_polars_that_the_blade_has(tmp_path):
    blade = with_polars(4e6, whole=True)
    bg.write(blade, tmp_path / "blade.htc")
    assert "pc_filename ./blade_pc.dat ;" in (tmp_path / "blade.htc").read_text()
    for eta in np.linspace(0.03, 1.0, 30):
        assert hawc2_lift(tmp_path, eta) == pytest.approx(lift(blade, float(eta)), abs=2e-3)
    for profiles in pc(tmp_path / "blade_pc.dat"):
        thicknesses = [thickness for thickness, _ in profiles]
        assert np.all(np.diff(thicknesses) > 0)
        assert 100.0 in thicknesses
        for _, table in profiles:
            assert_array_equal(table[[0, -1], 0], [-180.0, 180.0])
    rows = np.loadtxt(tmp_path / "blade_ae.dat", skiprows=2)
    for number, profiles in enumerate(pc(tmp_path / "blade_pc.dat"), start=1):
        used = rows[rows[:, 3] == number, 2]
        assert used.min() >= profiles[0][0]
        assert used.max() <= profiles[-1][0] + 1e-9


def test_polars_come_back_from_hawc2(tmp_path):
    blade = with_polars(9e6, 3e6, source="of the baseline, not of this shape: x")
    said = " ".join(map(str, bg.write(blade, tmp_path / "blade.htc")))
    assert "of several Reynolds numbers the one nearest the chord's" in said
    again = bg.read(tmp_path / "blade.htc")
    assert "polars" not in findings(again)
    for mine, own in zip(again.stations, blade.stations, strict=True):
        (only,) = mine.airfoil.polars
        assert only.reynolds in (9e6, 3e6)
        assert only.is_borrowed
        assert_allclose(only.at(ALPHA)[0], own.airfoil.polars[0].cl, rtol=0, atol=1e-12)
        assert mine.airfoil.aerodynamic_center == 0.25


@settings(max_examples=few(5), deadline=None)
@given(st.lists(st.sampled_from([0.18, 0.21, 0.3, 0.4, 0.6, 1.0]), min_size=2, max_size=5))
def test_thickness_may_turn_and_stay(tmp_path_factory, thicknesses):
    """Whatever the thickness does, each station gets its own polar."""
    folder = tmp_path_factory.mktemp("pc")
    plain = tenth()
    grid = np.linspace(0.0, 1.0, len(thicknesses))
    airfoils = [
        Airfoil(f"foil {k}", naca(0.2, 0.0, 0.0), 0.2, (polar(1.0 + k, reynolds=4e6),))
        for k in range(len(grid))
    ]
    blade = replace(
        plain,
        stations=tuple(Station(float(e), a) for e, a in zip(grid, airfoils, strict=True)),
        relative_thickness=Distribution(grid, np.array(thicknesses)),
    )
    bg.write(blade, folder / "blade.htc")
    again = bg.read(folder / "blade.htc")
    for k, station in enumerate(again.stations):
        found = station.airfoil.polars[0].at(ALPHA)[0]
        assert_allclose(found, polar(1.0 + k).cl, rtol=0, atol=1e-9)
    for profiles in pc(folder / "blade_pc.dat"):
        assert len(profiles) > 1
        assert np.all(np.diff([thickness for thickness, _ in profiles]) > 0)


def test_moments_go_about_the_quarter_chord(tmp_path):
    """A cylinder's drag acts at half chord: about the quarter chord it has a moment."""
    plain = tenth()
    ends = np.radians([-180.0, 180.0])
    drag = Polar(ends, np.zeros(2), np.full(2, 0.5), np.zeros(2), reynolds=1e6)
    stations = tuple(
        Station(s.eta, replace(s.airfoil, polars=(drag,), aerodynamic_center=0.5))
        for s in plain.stations
    )
    said = bg.write(replace(plain, stations=stations), tmp_path / "blade.htc")
    assert "moments brought to the quarter chord: Cylinder1" in " ".join(map(str, said))
    table = pc(tmp_path / "blade_pc.dat")[0][-1][1]
    assert_allclose(table[:, 3], -0.25 * 0.5 * np.sin(np.radians(table[:, 0])), atol=1e-12)
    guess = replace(drag, source="estimate: x")
    stations = tuple(Station(s.eta, replace(s.airfoil, polars=(guess,))) for s in plain.stations)
    bg.write(replace(plain, stations=stations), tmp_path / "blade.htc")
    assert not pc(tmp_path / "blade_pc.dat")[0][-1][1][:, 3].any()


def edited(folder: Path, text: str, number: int = 1) -> BladeDefinition:
    """A blade in HAWC2's files with another pc file, and that set at all stations."""
    bg.write(with_polars(4e6), folder / "blade.htc")
    (folder / "blade_pc.dat").write_text(text)
    ae = (folder / "blade_ae.dat").read_text().splitlines()
    rows = [" ".join([*line.split()[:3], str(number)]) for line in ae[2:]]
    (folder / "blade_ae.dat").write_text("\n".join([*ae[:2], *rows]))
    return bg.read(folder / "blade.htc")


def test_pc_files_of_others_are_read(tmp_path):
    known = [(12.0, 0.2), (21.0, 1.0), (40.0, 2.0), (100.0, 0.0)]
    made = edited(tmp_path, published([[(1.0, 9.0), (2.0, 9.0)], known]), 2)
    heights = [float(s.airfoil.polars[0].at(np.zeros(1))[0][0]) for s in made.stations]
    assert made.relative_thickness is not None
    thickness = 100.0 * made.relative_thickness(np.array([s.eta for s in made.stations]))
    assert_allclose(heights, np.interp(thickness, *np.array(known).T), atol=1e-2)
    assert "Some foil (Re=12x10^6)" in made.stations[-1].airfoil.polars[0].source
    odd = [(12.0, 0.2), (18.0, 1.0), (19.5, 1.0), (65.0, 1.0), (100.0, 0.0)]
    said = findings(edited(tmp_path, published([odd])))
    assert "profiles as thick as no airfoil are left out: 19.5 %, 65 %" in said
    said = findings(edited(tmp_path, published([[(12.0, 0.2), (30.0, 1.0)]])))
    assert "pc: holds no polars as thick as " in said
    assert "holds no polars as thick as" in findings(edited(tmp_path, published([known]), 7))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("1 sets", "0 sets", "line 1, number of sets: got '0', allowed is 1 to 1000"),
        ("2 profiles", "x", "line 2, number of profiles of a set: got 'x'"),
        ("2 profiles", "3 profiles", "the file ends early"),
        ("1 3 20", "1 3 200.5", "line 3: thickness 200.5, allowed is 0 to 200 %"),
        ("1 3 20", "1 3 100", "thickness 100 follows 100, must increase within a set"),
        ("1 3 20", "1 3", "line 3: must be number, rows (2 to 10000), thickness"),
        ("0 0.5 0.1 0", "0 0.5 0.1", "line 5: must be alpha, Cl, Cd, Cm"),
        ("0 0.5 0.1 0", "0 nan 0.1 0", "line 3: allowed are angles from -180 to 180 deg"),
        ("0 0.5 0.1 0", "-180 0.5 0.1 0", "line 3: alpha must increase strictly"),
    ],
)
def test_pc_files_that_cannot_be_read_are_left_out_and_said(tmp_path, old, new, said):
    text = published([[(20.0, 0.5), (100.0, 0.0)]]).replace("1 3 20.0", "1 3 20")
    assert old in text
    path = tmp_path / "pc.dat"
    path.write_text(text.replace(old, new, 1))
    notes = Notes()
    assert read_sets(path, notes) == []
    assert said in str(notes.findings[0])
    assert not notes.problems


def test_a_pc_file_out_of_reach_is_said(tmp_path):
    bg.write(with_polars(4e6), tmp_path / "blade.htc")
    edit(tmp_path / "blade.htc", "./blade_pc.dat", "../blade_pc.dat")
    made = bg.read(tmp_path / "blade.htc")
    assert "pc_filename: '../blade_pc.dat' is no file of this model" in findings(made)
    assert not made.stations[0].airfoil.polars
    notes = Notes()
    assert read_sets(tmp_path, notes) == []
    assert "is no regular file" in str(notes.findings[0])


HTC = """; a turbine
begin new_htc_structure;
  begin main_body;
    name hub1 ;
    begin c2_def;
      nsec 2 ;
      sec 1 0.0 0.0 0.0 0.0 ;
      sec 2 0.0 0.0 2.8 0.0 ;
    end c2_def ;
  end main_body;
  begin main_body;
    begin timoschenko_input ;
      filename ./data/st.dat ;
    end timoschenko_input ;
{c2_def}
    name Blade1 ;
  end main_body;
end new_htc_structure;
begin aero ;
  link 1 mbdy_c2_def Blade1 ;
  ae_filename ./data/old_ae.dat ;
  pc_filename ./data/old_pc.dat ;
  tiploss_method 1 ;
  ae_sets 2 2 2 ;
end aero ;
exit ;
"""


def test_a_blade_goes_back_into_an_htc_file(tmp_path):
    """Its c2_def and the names of its files change, all other lines stay."""
    for name in ("htc", "data"):
        (tmp_path / name).mkdir()
    bg.write(with_polars(4e6), tmp_path / "old.htc")
    lines = (tmp_path / "old.htc").read_text().splitlines()
    start, end = (next(k for k, s in enumerate(lines) if w in s) for w in ("c2_def;", "end c2_def"))
    own = HTC.format(c2_def="\n".join(lines[start : end + 1]))
    path = tmp_path / "htc" / "turbine.htc"
    path.write_bytes(own.replace("\n", "\r\n").encode() + b"; stig \xf8ye method\r\n")
    changed = replace(with_polars(4e6, 8e6), twist=Distribution.constant(0.1))
    said = " ".join(map(str, write_into(changed, path, path)))
    assert "st of the blade is that of the blade before" in said
    written = path.read_bytes()
    assert written.endswith(b"; stig \xf8ye method\r\n")
    assert written.count(b"\n") == written.count(b"\r\n")
    text = written.decode("latin-1").splitlines()
    assert text[:8] == own.splitlines()[:8]
    for line in own.splitlines():
        if "sec" not in line:
            assert (line in text) == ("old_" not in line and "ae_sets" not in line), line
    assert "  ae_filename ./htc/turbine_blade_ae.dat ;" in text
    folder = tmp_path / "htc" / "turbine_blade_htc_airfoils"
    again = bg.read(path)
    assert again.twist(0.5) == pytest.approx(0.1)
    assert lift(again, 0.5) == pytest.approx(lift(changed, 0.5), abs=2e-3)
    assert {p.name for p in path.parent.iterdir()} == {
        *("turbine.htc", "turbine_blade_ae.dat", "turbine_blade_pc.dat", folder.name)
    }
    with pytest.raises(bg.BladegenError, match="HAWC2 needs polars, Cylinder1, Cylinder2"):
        write_into(tenth(), path, path)
    path.write_text("begin aero ;\nend aero ;\n")
    with pytest.raises(bg.BladegenError, match="no blade with c2_def"):
        write_into(changed, path, path)
    (tmp_path / "htc" / "body.htc").write_text(own[: own.index("begin aero")])
    path.write_text("continue_in_file ./body.htc ;\n" + own[own.index("begin aero") :])
    with pytest.raises(bg.BladegenError, match="name the file that it continues in"):
        write_into(changed, path, path)
    body = path.with_name("body.htc")
    said = " ".join(map(str, write_into(changed, body, body)))
    assert "is not all in this file; give it ae_filename ./htc/body_blade_ae.dat" in said


# ---- on the command line -------------------------------------------------------------------------


def test_the_option_polars_rules_openfast_and_hawc2(tmp_path, monkeypatch):
    pytest.importorskip("neuralfoil")
    monkeypatch.setattr("bladegen.definition.estimates.MODEL", "xxsmall")  # quick
    run, source = CliRunner().invoke, str(tmp_path / "plain.csv")
    plain = tenth()
    bg.write(replace(plain, stations=(plain.stations[2], plain.stations[-1])), source)
    for suffix in ("dat", "htc"):
        target = str(tmp_path / f"blade.{suffix}")
        result = run(commands.app, ["convert", source, target, "--polars", "estimate"])
        assert result.exit_code == 0, result.output
        said = " ".join(result.output.split())
        assert ("blade_AeroDyn_part.dat" if suffix == "dat" else "sets in blade_pc.dat") in said
        made = bg.read(target)
        assert all(s.airfoil.polars[0].is_estimate for s in made.stations)
        result = run(commands.app, ["convert", source, target, "--polars", "keep"])
        assert "polars are not written: there are none" in " ".join(result.output.split())
        assert not any(s.airfoil.polars for s in bg.read(target).stations)
