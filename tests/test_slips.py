"""What new users type by mistake: each ends in one line that names it and the next step."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands
from bladegen.cli.options import common, fairing, parsing
from bladegen.cli.options.slips import instead_of
from bladegen.errors import BladegenError

BLADE = bg.Blade.from_definition(bg.read("iea15mw"))
SLIPS = {
    # the blade
    "info IEA15MW": "did you mean iea15mw",
    "info iea-15mw": "did you mean iea15mw",
    "info dtu10": "did you mean dtu10mw",
    "info NREL5MW.yaml": "did you mean nrel5mw",
    "info blad.yaml": "did you mean blade.yaml",
    "info folder/myblade.yml": "did you mean folder/myblade.yaml",
    "info folder": "folder: is a folder, must be a file, such as myblade.yaml",
    "info ''": "must be the name of a bundled blade, or a file's path",
    "info notes.txt": "has the suffix '.txt', allowed are .yaml",
    "info zzz": "bundled blades are dtu10mw, iea15mw, nrel5mw",
    "check IEA15MW": "did you mean iea15mw",
    "check folder": "is a folder, must be a file",
    "info iea15mw --airfoils nowhere": "nowhere: is no folder, must be one with airfoil files",
    "perturb iea15mw -o o": "nothing is to change; give --pga",
    "perturb iea15mw -o o --space bundled --pga 0,0,0,0": "in the shell that without --space",
    "check nowhere.step": "nowhere.step",
    "convert IEA15MW o.yaml": "did you mean iea15mw",
    "studio IEA15MW --no-browser": "did you mean iea15mw",
    "info deutsch.csv": "write chord for 'Sehne', twist for 'Verwindung', airfoil for 'Profil'",
    "info allemand.csv": "write chord for 'Profiltiefe', twist for 'Verwindung'",
    "info french.csv": "write r for 'rayon', chord for 'corde', twist for 'vrillage'",
    "info glued.csv": "glued.csv: row 2, chord: got '3.5-0.456', must be a number",
    "perturb iea15mw -o o --twist 1 --space notes.txt": "notes.txt: is no shape space",
    "perturb iea15mw -o o --twist 1 --space folder": "folder: is no regular file",
    "convert iea15mw o.yaml --into folder": "folder: is a folder, must be the file of a model",
    "convert iea15mw o.yaml --into notes": "notes: has no suffix, must be the file of a model",
    "check nowhere.stl": "nowhere.stl: is no file",
    "check solids/blad.stp": "solids/blad.stp: is no file; did you mean solids/blade.step?",
    "info iea15mw --airfoils folders": "folders: is no folder, must be one with airfoil files; "
    "did you mean folder?",
    "perturb iea15mw -o o --twist 1 --space solids/spce.npz": "did you mean solids/space.npz?",
    "convert iea15mw nowhere/o.yaml": "there is no folder nowhere; mkdir -p nowhere",
    "convert iea15mw nowhere/o.dat": "there is no folder nowhere; mkdir -p nowhere",
    # formats
    "build iea15mw -o o --format stepp": "did you mean step?",
    "build iea15mw -o o --format step,stlx": "format: got 'stlx'",
    "build iea15mw -o o --format jpeg": "no format has the suffix '.jpeg', allowed are .step",
    "build iea15mw -o o --format ,": "format: got ''",
    "family iea15mw -o o --format step;doc": "format: got 'doc'",
    "convert iea15mw o.yaml --to windIO": "did you mean windio",
    "convert iea15mw o.step": "suffix '.step', allowed are .yaml",
    # lengths
    "build iea15mw -o o --tolerance 0.3": "tolerance: got '0.3', must be a length with its unit",
    "build iea15mw -o o --tolerance 0,3mm": "such as 0.3mm",
    "build iea15mw -o o --tolerance 3in": "(um, mm, cm, m)",
    "build iea15mw -o o --tolerance -1mm": "tolerance: got '-1mm'",
    "build iea15mw -o o --tolerance 1m": "allowed is 1e-06 to 0.05 m (0.001 to 50 mm)",
    "build iea15mw -o p --tolerance 0,3mm": "did you mean 0.3mm?",
    "build iea15mw -o o --tolerance 0.3MM": "did you mean 0.3mm?",
    "build iea15mw -o o --tolerance 0.3\u03bcm": "did you mean 0.3um?",
    "build iea15mw -o o --trailing-edge 2": "such as 2mm, given or sharp",
    "build iea15mw -o o --trailing-edge 2,5mm": "did you mean 2.5mm?",
    "build iea15mw -o o --trailing-edge 2mm,1": "2mm,1%",
    "build iea15mw -o o --trailing-edge -2mm": "trailing-edge: got '-2mm', must be a length",
    "build iea15mw -o o --rotor --hub-radius 4": "hub-radius: got '4', must be a length with its",
    "build iea15mw -o o --rotor --hub-radius 4,5m": "such as 2m; did you mean 4.5m?",
    "build iea15mw -o o --rotor --precone 4grad": "must be an angle in degrees (4, 4deg)",
    "build iea15mw -o o --fairing 1%": "fairing: got '1%', must be a share of the chord",
    # coordinates
    "perturb iea15mw -o o --pga 0.1,0.1,0.1": "t: got 3 coordinates (--pga), the space has 4 modes",
    "perturb iea15mw -o o --pga 0.9,0,0,0": "--allow-extrapolation",
    "perturb iea15mw -o o --pga '[0.01,0,0,0]'": "pga: got '[0.01,0,0,0]'",
    "perturb iea15mw -o o --pga 0.01;0;0;0": "numbers with commas between, such as 0.1,0,0,0",
    "perturb iea15mw -o o --pga 0,0,0,0@50": "got knots at 50, must increase within 0 (root) to 1",
    "perturb iea15mw -o o --pga 0,0,0,0@50%": "pga: got '50%' behind @, must be a span fraction",
    "perturb iea15mw -o o --pga 0,0,0,0 --pga 0,0,0,0": "must end in @ETA",
    "perturb iea15mw -o o --pga 0,0,0,0@0.5 --pga 0,0,0@0.6": "pga: got 4 and 3 coordinates",
    "perturb iea15mw -o o --pga nan,0,0,0": "pga: got 'nan,0,0,0', must be numbers with commas",
    # amounts and windows
    "perturb iea15mw -o o --window 10%,50% --twist 1": "must be two span fractions from 0 (root)",
    "perturb iea15mw -o o --window 0.1:0.5 --twist 1": "with a comma between, such as 0.1,0.3",
    "perturb iea15mw -o o --window 20m,80m --twist 1": "window: got '20m,80m', must be two span",
    "perturb iea15mw -o o --thickness 0": "thickness: got 0, allowed is 0.2 to 5",
    "perturb iea15mw -o o --thickness -1": "thickness: got -1, allowed is 0.2 to 5",
    "perturb iea15mw -o o --twist 100": "(100 deg), allowed is -0.7854 rad (-45 deg)",
    "perturb iea15mw -o o --window 0.3 --twist 1": "window: got '0.3'",
    "perturb iea15mw -o o --window 0.5,0.2 --twist 1": "window: got 0.5 to 0.2, must rise within 0",
    "perturb iea15mw -o o --window 10,50 --twist 1": "window: got 10 to 50, must rise",
    "perturb iea15mw -o o --space nowhere.npz --pga 0,0,0,0": "nowhere.npz",
    # families
    "family iea15mw -o o --count 0": "count: got 0, allowed is 1 to 10000000",
    "family iea15mw -o o --count -5": "count: got -5",
    "family iea15mw -o o --seed -1": "seed: got -1, must not be negative",
    "family iea15mw -o o --design Sobol": "did you mean sobol",
    "family iea15mw -o o --design random": "design: got 'random', allowed are sobol",
    "family iea15mw -o o --vary thickness=0.9,1.1": "must be NAME=LOW:HIGH",
    "family iea15mw -o o --vary thickness=1.1:0.9": "bounds are 1.1 to 0.9, must not fall",
    "family iea15mw -o o --vary thicknes=0.9:1.1": "did you mean thickness",
    "family iea15mw -o o --vary twist=-100:100": "(-100 deg)",
    "family iea15mw -o o --reach 2": "reach: got 2, allowed is more than 0 and at most 1",
    "family iea15mw -o o --spans 3": "stations: got 3, at least",
    "family iea15mw -o o --invalid drop": "invalid: got 'drop', allowed are redraw, keep",
    "family iea15mw -o o --jobs 0 --count 2 --spans 16": "jobs: got 0",
    "family iea15mw -o o --table nowhere.csv": "nowhere.csv",
    "family iea15mw -o o --vary t1=-10%:10%": "vary: got 't1=-10%:10%', must be NAME=LOW:HIGH",
    "family iea15mw -o o --vary twist=-2deg:2deg": "or twist=-2:2 in degrees",
    "family iea15mw -o o --vary thickness=0,9:1,1": "in numbers with decimal points",
    # looking
    "preview iea15mw --gif x.gif --sweep t1=0.1": "sweep: got 't1=0.1', must be NAME=LOW:HIGH",
    "preview iea15mw --screenshot folder": "suffix '', allowed are .png; such as folder.png",
    "preview --compare iea15mw nrel5mw --mirror": "compare: takes two files or blades",
    "plot iea15mw -o x.jpg": "allowed are .png, .svg, .pdf; such as x.png",
    "preview iea15mw --sweep t1=0:0.1": "needs --gif or --mp4",
    "preview": "bladegen list",
    "space info nowhere.npz": "nowhere.npz",
}
USAGE = {
    "build iea15mw": "--output",
    "build iea15mw -o o --formats step": "--format",
    "build iea15mw -o o --tolerence 1mm": "--tolerance",
    "build iea15mw -o o --path linear": "geodesic",
    "build iea15mw -o o --landmarks 401.5": "--landmarks",
    "perturb iea15mw -o o --twist 2deg": "'--twist': got '2deg', must be a number with a decimal",
    "perturb iea15mw -o o --twist=0,1rad": "such as 5.72958",
    "perturb iea15mw -o o --thickness 1,05": "a decimal point, 1 for no change; such as 1.05",
    "perturb iea15mw -o o --chord 5%": "got '5%', must be a factor with a decimal point, 1 for no "
    "change; such as 1.05",
    "perturb iea15mw -o o --thickness=-5%": "such as 0.95",
    "perturb iea15mw -o o --camber 105%": "such as 1.05",
    "evaluate iea15mw --efficiency 95%": "without a unit; such as 0.95",
    "perturb iea15mw -o o --thickness 110%": "such as 1.1",
    "perturb iea15mw -o o --pga 0.1 0 0 0": "commas between, without blanks, such as 0.1,0,0,0",
    "family iea15mw -o o --count 1e3": "'--count': got '1e3', must be a whole number, in digits "
    "alone; such as 1000",
    "family iea15mw -o o --count 1,000": "such as 1000",
    "family iea15mw -o o --count 10.5": "got '10.5', must be a whole number",
    "family iea15mw -o o --count ten": "got 'ten', must be a whole number",
    "family iea15mw -o o --reach 50%": "such as 0.5",
    "family iea15mw -o o --vary thickness 0.9:1.1": "one word, such as thickness=0.9:1.1",
    "build iea15mw -o o --stations=3.000,5": "got '3.000,5', must be a whole number",
    "build iea15mw -o o --trailing-edge 2 mm": "has no blank before its unit, such as 2mm",
    "build iea15mw -o o --format .step .stl": "commas between, without blanks, such as step,stl",
    "space build -o s.npz --count 1e3": "such as 1000",
    "studio iea15mw --port abc": "'--port': got 'abc', must be a whole number",
    "help": "bladegen -h lists commands",
    "help build": "bladegen build -h options",
    "info iea15mw nrel5mw": "nrel5mw",
    "lst": "list",
}


TABLES = {
    "deutsch.csv": "Radius;Sehne;Verwindung;Profil\n0;3,5;13,3;a\n61,5;1,4;0,1;b\n",
    "allemand.csv": "Radius [m];Profiltiefe [m];Verwindung [\u00b0]\n0;3,5;13,3\n61,5;1,4;0,1\n",
    "french.csv": "rayon,corde,vrillage\n0,3.5,13\n61.5,1.4,0.1\n",
    "glued.csv": "r,chord,twist\n0,3.5-0.456,13\n61.5,1.4,0.1\n",
}


@pytest.fixture
def typed(tmp_path, monkeypatch):
    """Type a command in a folder with some files; every blade is one that is made already."""
    monkeypatch.chdir(tmp_path)
    for name in ("folder", "solids"):
        (tmp_path / name).mkdir()
    for name in (
        "blade.yaml", "notes.txt", "folder/myblade.yaml", "solids/blade.step", "solids/space.npz"
    ):  # fmt: skip
        (tmp_path / name).write_text("a: 1\n")

    for name, text in TABLES.items():
        (tmp_path / name).write_text(text, encoding="utf-8")

    def blade(making, source, *_):
        if source not in bg.bundled():
            return bg.read(source)
        fairing.chord_share(making.fairing, "fairing")
        return BLADE.with_trailing_edge(parsing.finish(making.trailing_edge))

    monkeypatch.setattr(common.Making, "blade", blade)
    return lambda line: CliRunner().invoke(commands.app, line)


@pytest.mark.parametrize("line", SLIPS)
def test_a_slip_is_answered_in_a_line_that_says_what_to_type(typed, line):
    error = typed(line).exception
    assert isinstance(error, BladegenError), repr(error)
    assert SLIPS[line] in str(error)
    assert "\n" not in str(error)


@pytest.mark.parametrize("line", USAGE)
def test_usage_errors_name_the_option_that_is_meant(typed, line):
    result = typed(line)
    assert result.exit_code == 2
    assert USAGE[line] in " ".join(result.output.split())


def test_formats_may_come_with_commas_dots_and_capitals():
    assert common.suffixes_of(["STEP, .stl", "sections.csv"]) == (
        "step",
        "stl",
        "sections.csv",
    )
    assert common.suffixes_of(["stl", "stl"]) == ("stl",)
    assert common.suffixes_of(None) == ()


def test_choices_are_taken_in_any_case(typed):
    result = typed("build iea15mw -o o --path Spline --tip ROUND --unit MM --format zzz")
    assert "format: got 'zzz'" in str(result.exception)


def test_words_are_taken_in_any_case(typed):
    result = typed("build iea15mw -o o --trailing-edge Sharp --fairing OFF --rotor --precone 95")
    assert "precone 95 deg, allowed is -45 to 45 deg" in str(result.exception)


@given(st.integers(-(10**6), 10**6))
def test_the_whole_number_that_is_meant_is_offered(value):
    for typed in (f"{value}.0", f"{value},0", f"{value:e}" if abs(value) < 10**6 else f"{value}.0"):
        assert instead_of(typed, whole=True).endswith(f"; such as {value}") or not value
    if abs(value) >= 1000:
        assert instead_of(f"{value:,}", whole=True).endswith(f"; such as {value}")


@given(st.floats(-1e5, 1e5).map(lambda value: float(f"{value:.5g}")))
def test_the_number_that_is_meant_is_offered(value):
    typed = f"{value:f}".replace(".", ",")
    offered = instead_of(typed, whole=False).rpartition("; such as ")[2]
    assert float(offered) == pytest.approx(float(f"{value:f}"), rel=1e-5)
