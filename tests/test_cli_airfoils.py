"""`--airfoils DIR`: every command that reads a blade takes the shapes that its file only names."""

import json
import pickle
import shutil

import pytest
from numpy.testing import assert_array_equal
from refusals import findings
from test_readers_tables import TABLE, airfoils
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands as cli
from bladegen.errors import BladegenError
from bladegen.families.identity import fingerprint
from bladegen.families.order import Order
from bladegen.views import contact_sheet

READING = {
    "info",
    "check",
    "convert",
    "build",
    "perturb",
    "family",
    "preview",
    "plot",
    "studio",
} | {"evaluate", "label"}
CALLS = [
    "info BLADE --json",
    "check BLADE",
    "check BLADE BLADE --json",
    "convert BLADE OUT/a.yaml",
    "evaluate BLADE --hub-radius 2m --json",
    "build BLADE -o OUT --format sections.csv --landmarks 101",
    "perturb BLADE -o OUT --twist 1 --format sections.csv --landmarks 101",
    "plot BLADE -o OUT/a.svg --what planform --landmarks 101",
    "preview BLADE --html OUT/a.html --landmarks 101",
    "preview --compare BLADE BLADE --html OUT/a.html --landmarks 101",
]
FAMILY = (
    "family BLADE -o OUT/f --seed 3 --spans 12 --space none --vary chord=0.9:1.1 --count 2 --jobs 1"
)


@pytest.fixture
def run(tmp_path):
    """Call a command on a table whose airfoils are in a folder elsewhere, ``shapes``."""
    blade = tmp_path / "in" / "blade.csv"
    blade.parent.mkdir()
    blade.write_text(TABLE, encoding="utf-8")
    airfoils(tmp_path / "shapes")

    def called(words, *more):
        places = {"BLADE": str(blade), "OUT": str(tmp_path)}
        given = [word.replace("OUT", places["OUT"]) for word in [*words.split(), *map(str, more)]]
        return CliRunner().invoke(cli.app, [places.get(word, word) for word in given])

    return called


def test_every_command_that_reads_a_blade_has_the_option():
    known = {
        name: next((p for p in cli.command_of(name).params if "--airfoils" in p.opts), None)
        for name in cli.SUMMARIES
    }
    assert {name for name, option in known.items() if option} == READING
    assert len({option.help for option in known.values() if option}) == 1


@pytest.mark.parametrize("words", CALLS)
def test_commands_take_the_shapes_from_the_folder(run, tmp_path, words):
    result = run(words)
    assert isinstance(result.exception, BladegenError)
    assert "name one (--airfoils DIR)" in str(result.exception)
    result = run(words, "--airfoils", tmp_path / "shapes")
    assert result.exit_code == 0, result.output
    if "convert" in words:
        made = bg.read(tmp_path / "a.yaml")
        assert [s.airfoil.name for s in made.stations] == ["circle", "naca"]
    elif "build" in words:
        assert (tmp_path / "blade.sections.csv").is_file()
    elif "check BLADE BLADE" in words:
        assert json.loads(result.output)["maximum_mm"] < 1e-6  # rounding, 6e-8


def test_shapes_that_a_file_holds_itself_are_kept_and_said(tmp_path):
    made = bg.read("nrel5mw", airfoils=tmp_path)
    assert f"airfoils: are in the file itself; {tmp_path} is passed over" in findings(made)
    assert fingerprint(made) == fingerprint(bg.read("nrel5mw"))


def test_a_family_goes_on_with_the_same_shapes_only(run, tmp_path, monkeypatch):
    monkeypatch.setattr(contact_sheet, "contact_sheet", lambda *_: "not drawn")
    folder = ("--airfoils", tmp_path / "shapes")
    assert "--airfoils DIR" in str(run(FAMILY).exception)
    assert run(FAMILY, *folder).exit_code == 0
    result = run(FAMILY, *folder, "--resume")
    assert result.exit_code == 0, result.output
    assert "2, 0 of them made now" in result.output
    labelling = "label OUT/f mass --blade BLADE"
    assert "--airfoils DIR" in str(run(labelling).exception)
    assert "mass needs layers" in str(run(labelling, *folder).exception)
    foil = tmp_path / "shapes" / "naca.dat"
    foil.write_text(foil.read_text().replace("1.000000000", "0.999000000"))
    result = run(FAMILY, *folder, "--resume")
    assert "holds another family (blade_fingerprint" in str(result.exception)


def test_workers_are_handed_the_shapes_and_need_no_folder(tmp_path):
    path = tmp_path / "blade.csv"
    path.write_text(TABLE, encoding="utf-8")
    blade = bg.Blade.from_definition(bg.read(path, airfoils=airfoils(tmp_path / "shapes")))
    order = Order(bg.family(blade, count=2, bounds={"chord": (0.9, 1.1)}), tmp_path / "f")
    sent = pickle.dumps(order)
    path.unlink()
    shutil.rmtree(tmp_path / "shapes")
    taken = pickle.loads(sent)
    assert taken.identity == order.identity
    assert_array_equal(
        taken.family.variant(1).sections([0.5]), order.family.variant(1).sections([0.5])
    )
