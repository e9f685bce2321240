"""Readers of OpenFAST and HAWC2 files: every kind of bad file is answered with its place."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from published_formats import GOLDEN, hawc2, openfast
from refusals import findings, problems

import bladegen as bg
from bladegen.errors import FileError
from bladegen.formats.common import text_file
from bladegen.formats.hawc2.model import finder
from strategies import STEADY, tenth


def edit(path: Path, old: str, new: str, count: int = 1) -> Path:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, count))
    return path


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("BlSwpAC", "BlSwp", "columns: BlSwpAC missing"),
        ("50 NumBlNds", "some NumBlNds", "NumBlNds: got 'some', allowed are whole numbers"),
        ("50 NumBlNds", "nan NumBlNds", "NumBlNds: got 'nan', allowed are whole numbers"),
        ("50 NumBlNds", "60 NumBlNds", "line 57: must be row 51 of the 60"),
        ("5.208839941579524e+00", "-5", "line 8, BlChord: got '-5', allowed is above 0 to 100 m"),
        ("5.208839941579524e+00", "wide", "line 8, BlChord: got 'wide', must be a number"),
        ("5.208839941579524e+00 2", "5.2", "line 8: must be row 2 of the 50"),
        ("2.387753704536792e+00", "0.0", "row 2, BlSpn: got 0 after 0, must increase"),
        ("499999999999999e-01 50", "499999999999999e-01 80", "BlAFID: got 80, allowed are 1 to 50"),
    ],
)
def test_aerodyn_blade_files_tell_what_is_wrong(tmp_path, old, new, said):
    path = openfast(tmp_path)
    text = path.read_text()
    if old.startswith("4999"):
        old, new = "4.999999999999998e-01 50", "4.999999999999998e-01 80"
    assert old in text
    path.write_text(text.replace(old, new, 1))
    assert said in problems(path)


def test_many_wrong_entries_of_a_column_are_counted(tmp_path):
    path = openfast(tmp_path)
    lines = path.read_text().splitlines()
    bad = [
        line.replace(line.split()[5], "0", 1) if k >= 6 else line for k, line in enumerate(lines)
    ]
    path.write_text("\n".join(bad))
    assert "BlChord: 45 more entries are not above 0" in problems(path)


def test_a_main_input_tells_what_it_misses(tmp_path):
    openfast(tmp_path)
    main = tmp_path / "AeroDyn15.dat"
    edit(main, '"Airfoils/Polar_01.dat"', '"../Polar_01.dat"')
    assert "AFNames, entry 2: '../Polar_01.dat' is no file in" in problems(main)
    edit(main, '"blade.dat" ADBlFile(1)', '"/etc/blade.dat" ADBlFile(1)')
    assert "ADBlFile(1): got '/etc/blade.dat', must be a file in" in problems(main)


def test_airfoil_files_of_openfast_tell_what_is_wrong(tmp_path):
    path = openfast(tmp_path)
    folder = tmp_path / "Airfoils"
    edit(folder / "Polar_00.dat", "AF00_Coords.txt", "../../AF00_Coords.txt")
    (folder / "AF01_Coords.txt").write_text("0 NumCoords\n")
    text = (folder / "AF02_Coords.txt").read_text().splitlines()
    (folder / "AF02_Coords.txt").write_text("\n".join([*text[:2], "7 0", *text[3:]]))
    said = problems(path)
    assert "Polar_00.dat, NumCoords: '../../AF00_Coords.txt' is no file in Airfoils" in said
    assert "AF01_Coords.txt: holds no coordinates (0 points)" in said
    assert "AF02_Coords.txt: reference point (7, 0)" in said


def test_a_file_without_reference_point_has_the_quarter_chord(tmp_path):
    path = openfast(tmp_path)
    folder = tmp_path / "shapes"
    folder.mkdir()
    for k in range(50):
        name = "circular" if k < 2 else "FFA-W3-211"
        rows = (GOLDEN / "iea15mw" / "airfoils" / f"{name}.csv").read_text().replace(",", " ")
        (folder / f"{k}.txt").write_text(rows)
    made = bg.read(path, airfoils=folder)
    assert len(made.stations) == 50
    assert made.offset_y(0.9) / made.chord(0.9) == pytest.approx(0.335, abs=2e-3)
    (folder / "49.txt").unlink()
    assert "BlAFID: got 50, allowed are 1 to 49" in problems(path, airfoils=folder)


def test_nodes_that_share_an_airfoil_keep_its_ends(tmp_path):
    path = openfast(tmp_path)
    lines = path.read_text().splitlines()
    for k in range(6, 56):
        lines[k] = " ".join([*lines[k].split()[:6], "1" if k < 10 else "30"])
    path.write_text("\n".join(lines))
    made = bg.read(path)
    assert len(made.stations) == 4
    assert made.stations[1].airfoil is made.stations[0].airfoil


def test_a_twist_table_of_another_blade_is_passed_over(tmp_path):
    path = tmp_path / "blade.dat"
    bg.write(tenth(), path)
    assert "no reference axis" not in findings(bg.read(path))
    table = tmp_path / "blade_ElastoDyn_twist.dat"
    table.write_text("\n".join(table.read_text().splitlines()[:-1]))
    assert "is of another blade (BlFract differs); passed over" in findings(bg.read(path))


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        ("parts.htc", "name blade1", "name wing", "must be the one that aero links to, or named"),
        ("parts.htc", "3.513081e+00", "1.0", "parts.htc, line 16, c2_def z: got 1 after 2.34226"),
        ("parts.htc", "3.513081e+00", "far", "c2_def z: got 'far', must be a number"),
        ("parts.htc", "3.513081e+00", "", "c2_def: must be rows of sec, number, x, y, z, twist"),
        (
            "turbine.htc",
            "./data/ae.dat",
            "../../data/ae.dat",
            "ae_filename: got '../../data/ae.dat'",
        ),
        ("turbine.htc", "ae_sets 1 1 1", "ae_sets 4 4 4", "ae.dat: holds no set 4"),
        ("ae.dat", "1 30 r,c", "1 40 r,c", "ae.dat, line 33: must be radius, chord"),
        ("ae.dat", "5.226951603677118e+00", "-1", "ae.dat, line 4, chord: got '-1', allowed"),
        ("ae.dat", "4.128435627827585e+00", "0", "ae.dat, line 4, radius: got 0 after 0"),
    ],
)
def test_hawc2_files_tell_what_is_wrong(tmp_path, file, old, new, said):
    path = hawc2(tmp_path, "iea15mw")
    edit(next(tmp_path.rglob(file)), old, new)
    assert said in problems(path, airfoils=GOLDEN / "iea15mw" / "airfoils")


def test_hawc2_findings_tell_what_was_passed_over(tmp_path):
    path = hawc2(tmp_path, "iea15mw")
    edit(path, "begin aero ;", "continue_in_file ../../secret.htc ;\nbegin aero ;")
    edit(tmp_path / "data" / "ae.dat", "e+01 1\n", "e+01 2\n")
    edit(tmp_path / "data" / "ae.dat", " 1.171835883386072e+02", " 1.301835883386072e+02")
    made = bg.read(path, airfoils=GOLDEN / "iea15mw" / "airfoils")
    said = findings(made)
    assert "continue_in_file ../../secret.htc lies outside of the model's folders" in said
    assert "names several polar sets" in said
    assert "ends at 130.184 m, c2_def is 117.18" in said


def test_a_model_may_continue_in_the_folder_beside_it(tmp_path):
    """As the published onshore model of the IEA 15 MW does; further away it may not."""
    for name in ("onshore", "turbine"):
        (tmp_path / name).mkdir()
    whole = hawc2(tmp_path / "turbine", "iea15mw")
    airfoils = GOLDEN / "iea15mw" / "airfoils"
    before = bg.read(whole, airfoils=airfoils)
    (tmp_path / "onshore" / "htc").mkdir()
    path = tmp_path / "onshore" / "htc" / "onshore.htc"
    for file in whole.parent.glob("*.htc"):
        file.write_text(file.read_text().replace(" ./", " ../turbine/"))
    path.write_text(f"continue_in_file ../turbine/htc/{whole.name} ;\n")
    made = bg.read(path, airfoils=airfoils)
    assert made.chord(0.3) == before.chord(0.3)
    path = path.rename(tmp_path / "onshore" / "onshore.htc")
    with pytest.raises(bg.BladegenError, match="no blade with c2_def"):
        bg.read(path, airfoils=airfoils)


@pytest.mark.parametrize("folder", ["htc/_master", "htc/dlc12/wsp08", "hawcstab2", "HTC"])
def test_an_htc_file_may_lie_deeper_in_its_model(tmp_path, folder):
    """Of the published models, those of IEA 3.4 and 22 MW have htc/_master, IEA 10 hawcstab2."""
    path = hawc2(tmp_path, "iea15mw")
    airfoils = GOLDEN / "iea15mw" / "airfoils"
    wanted = bg.read(path, airfoils=airfoils)
    deeper = tmp_path / folder / "master.htc"
    deeper.parent.mkdir(parents=True, exist_ok=True)
    path.rename(deeper)
    made = bg.read(deeper, airfoils=airfoils)
    assert made.length == wanted.length
    assert made.chord(0.3) == wanted.chord(0.3)


def test_a_lone_htc_file_leads_nowhere_above_its_folder(tmp_path):
    path = hawc2(tmp_path, "iea15mw")
    (tmp_path / "lone").mkdir()
    for file in path.parent.glob("*.htc"):
        file.rename(tmp_path / "lone" / file.name)
    path.parent.rmdir()
    (tmp_path / "data").rename(tmp_path / "private")
    lone = edit(tmp_path / "lone" / "turbine.htc", "./data/", "./private/")
    edit(lone, "./htc/", "./")
    assert "ae_filename: got './private/ae.dat', must be a file of this model" in problems(lone)


ORIENTATION = """
begin new_htc_structure ;
begin orientation ;
  begin base ;
  mbdy tower ;
  inipos 0.0 0.0 0.0 ;
  mbdy_eulerang 0.0 0.0 0.0 ;
  end base ;
  begin relative ;
    mbdy1 tower last ;
    mbdy2 shaft 1 ;
    mbdy2_eulerang 90.0 0.0 0.0 ;
    mbdy2_eulerang 5.0 0.0 0.0 ;
  end relative ;
  begin relative ;
    body1 shaft last ;
    body2 hub1 1 ;
    body2_eulerang -90.0 0.0 0.0 ;
    body2_eulerang 0.0 180.0 0.0 ;
    body2_eulerang 2.5 0.0 0.0 ;
  end relative ;
  begin relative ;
    mbdy1 hub1 last ;
    mbdy2 blade1 1 ;
    mbdy2_eulerang 0.0 0.0 0.0 ;
  end relative ;
end orientation ;
end new_htc_structure ;
begin aero ;"""


def test_the_rotor_of_a_hawc2_model_is_read(tmp_path):
    path = hawc2(tmp_path, "iea15mw")
    airfoils = GOLDEN / "iea15mw" / "airfoils"
    bare = bg.read(path, airfoils=airfoils).rotor
    assert (bare.hub_radius, bare.cone, bare.tilt) == (None, None, None)
    edit(path, "begin aero ;", ORIENTATION)
    edit(path, "nblades 3", "nblades 2")
    rotor = bg.read(path, airfoils=airfoils).rotor
    assert rotor.blades == 2
    assert rotor.hub_radius == 3.97
    assert_allclose([rotor.cone, rotor.tilt], np.radians([2.5, 5.0]), rtol=0, atol=1e-14)
    edit(path, "body2_eulerang 2.5 0.0 0.0", "body2_eulerang [cone] 0.0 0.0")
    rotor = bg.read(path, airfoils=airfoils).rotor
    assert (rotor.hub_radius, rotor.cone) == (3.97, None)


def test_names_of_a_model_at_the_top_of_a_disk_lead_below_it_only(monkeypatch):
    reached = []

    def referred(name, bases, below=None):
        reached.append((bases, below))

    monkeypatch.setattr("bladegen.formats.hawc2.model.referred", referred)
    for path in ("/models/one/htc/a.htc", "/one/htc/a.htc", "/htc/a.htc"):
        finder(Path(path))("b.htc")
    one = [Path("/one/htc"), Path("/one")]
    assert reached[0][1] == Path("/models")
    assert reached[1:] == [(one, Path("/one")), ([Path("/htc")], None)]


def test_an_htc_file_that_continues_in_itself_ends(tmp_path):
    path = hawc2(tmp_path, "iea15mw")
    edit(path, "; a turbine", "continue_in_file ./htc/turbine.htc ;")
    made = bg.read(path, airfoils=GOLDEN / "iea15mw" / "airfoils")
    assert "nests too deep; passed over" in findings(made)


def test_the_ae_file_may_lie_beside_the_htc_file(tmp_path):
    path = hawc2(tmp_path, "iea15mw")
    edit(path, "ae_filename ./data/ae.dat ;", "")
    (tmp_path / "data" / "ae.dat").rename(path.with_name("turbine_ae.dat"))
    assert bg.read(path, airfoils=GOLDEN / "iea15mw" / "airfoils").format == "HAWC2"


def test_airfoils_that_no_section_is_as_thick_as_are_left_out(tmp_path):
    path = hawc2(tmp_path, "dtu10mw")
    made = bg.read(path, airfoils=GOLDEN / "iea15mw" / "airfoils")
    assert "FFA-W3-211 (0.211)" in findings(made)
    folder = tmp_path / "thin"
    folder.mkdir()
    source = GOLDEN / "iea15mw" / "airfoils" / "FFA-W3-211.csv"
    (folder / "thin.csv").write_text(source.read_text())
    assert "airfoils: none is" in problems(path, airfoils=folder)


def test_an_empty_folder_of_airfoils_is_said_to_be_empty(tmp_path):
    (tmp_path / "none").mkdir()
    path = openfast(tmp_path)
    said = problems(path, airfoils=tmp_path / "none")
    assert "holds no airfoil files (.txt, .dat, .csv, .afl)" in said
    assert "1 to 0" not in said


@pytest.mark.parametrize(("suffix", "mark"), [(".dat", "AeroDyn"), (".htc", "main_body")])
def test_other_files_of_the_suffix_are_refused(tmp_path, suffix, mark):
    path = tmp_path / f"other{suffix}"
    path.write_text("something else\n")
    assert mark in problems(path)


def test_files_that_are_too_large_or_gone_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(text_file, "MAX_BYTES", 1000)
    assert "is larger than" in problems(openfast(tmp_path))
    assert text_file.head(tmp_path) == ""
    with pytest.raises(FileError, match="is no regular file"):
        text_file.read_lines(tmp_path)


WORDS = ["", "-1", "nan", "inf", "1e400", "word", "begin", "end", ";", "\0", '"', "9" * 400, "0"]


@pytest.mark.parametrize("format_", ["dat", "htc", "csv", "index"])
def test_damaged_files_are_refused_with_a_line_of_their_own(tmp_path, format_):
    rng = np.random.default_rng(11)
    made = tmp_path / f"blade.{'csv' if format_ == 'index' else format_}"
    bg.write(tenth(), made)
    damaged = made if format_ != "index" else tmp_path / "blade_csv_airfoils" / "index.csv"
    lines = damaged.read_text().splitlines()
    refused: list[str] = []
    for _ in range(20 if STEADY else 40):
        broken = list(lines)
        for k in rng.integers(0, len(broken), 3):
            mark = "," if damaged.suffix == ".csv" else " "
            words = broken[k].split(mark)
            words[rng.integers(len(words))] = WORDS[rng.integers(len(WORDS))]
            broken[k] = mark.join(words) if rng.random() < 0.8 else ""
        damaged.write_text("\n".join(broken))
        try:
            bg.read(made)
        except FileError as error:
            refused.extend(error.problems)
    assert len(refused) > (3 if STEADY else 10)
    assert not any("\n" in problem for problem in refused)
