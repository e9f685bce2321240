"""What new users type by mistake: each ends in one line that names it and the next step."""

import pytest
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands
from bladegen.cli.options import common
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
    "info iea15mw --airfoils nowhere": "nowhere: is no folder, must be one of airfoil files",
    "perturb iea15mw -o o": "nothing is to change; give --pga",
    "perturb iea15mw -o o --space bundled --pga 0,0,0,0": "in the shell that without --space",
    "check nowhere.step": "nowhere.step",
    "convert IEA15MW o.yaml": "did you mean iea15mw",
    "studio IEA15MW --no-browser": "did you mean iea15mw",
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
    # coordinates
    "perturb iea15mw -o o --pga 0.1,0.1,0.1": "t: got 3 coordinates (--pga), the space has 4 modes",
    "perturb iea15mw -o o --pga 0.9,0,0,0": "--allow-extrapolation",
    "perturb iea15mw -o o --pga '[0.01,0,0,0]'": "pga: got '[0.01,0,0,0]'",
    "perturb iea15mw -o o --pga 0.01;0;0;0": "numbers with commas between, such as 0.1,0,0,0",
    "perturb iea15mw -o o --pga 0,0,0,0@50": "got knots at 50, must increase within 0 (root) to 1",
    "perturb iea15mw -o o --pga 0,0,0,0@50%": "pga: got '50%' behind @, must be a span fraction",
    "perturb iea15mw -o o --pga 0,0,0,0 --pga 0,0,0,0": "must end in @ETA",
    "perturb iea15mw -o o --pga 0,0,0,0@0.5 --pga 0,0,0@0.6": "pga: got 4 and 3 coordinates",
    # amounts and windows
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
    # looking
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
    "perturb iea15mw -o o --twist 2deg": "--twist",
    "perturb iea15mw -o o --thickness 1,05": "--thickness",
    "family iea15mw -o o --count 1e3": "--count",
    "info iea15mw nrel5mw": "nrel5mw",
    "lst": "list",
}


@pytest.fixture
def typed(tmp_path, monkeypatch):
    """Type a command in a folder with some files; every blade is one that is made already."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    for name in ("blade.yaml", "notes.txt", "folder/myblade.yaml"):
        (tmp_path / name).write_text("a: 1\n")

    def blade(_making, source, *_):
        return BLADE if source in bg.bundled() else bg.read(source)

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
    assert USAGE[line] in result.output


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
