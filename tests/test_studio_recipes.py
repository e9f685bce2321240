import shlex
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands
from bladegen.cli.options.fairing import planform_fairing
from bladegen.exports.options import Options
from bladegen.measures import checks
from bladegen.studio.choices.delivery import Delivery
from bladegen.studio.choices.loft import Loft
from bladegen.studio.library import Entry, Library
from bladegen.studio.model import Baseline
from bladegen.studio.recipes import python, shell
from bladegen.studio.state import State

ENTRY = Entry("nrel5mw", "nrel5mw", "nrel5mw", "nrel5mw")
MOVED = State("nrel5mw", (-0.03, 0.0, 0.01, -0.005), (0.1, 0.3), 1.05, 0.98, 1.1, -1.5, 0.5)
STATES = [State("nrel5mw"), MOVED, replace(MOVED, t=(0.0,) * 4, window=None)]
GEODESIC = State("nrel5mw", loft=Loft("geodesic", fair=True))


@pytest.fixture(scope="module")
def baseline():
    blade = bg.Blade.from_definition(bg.read("nrel5mw"))
    return Baseline("nrel5mw", blade, bg.ShapeSpace.bundled())


@pytest.mark.parametrize("state", STATES)
def test_the_script_makes_the_same_blade(baseline, state, monkeypatch):
    written = {}
    monkeypatch.setattr(bg, "export", lambda blade, path: written.update({path: blade}))
    exec(compile(python(state, ENTRY, baseline.stem(state)), "recipe", "exec"), {})
    ((path, blade),) = written.items()
    assert path == f"{baseline.stem(state)}.step"
    eta = np.linspace(0.0, 1.0, 12)
    assert_allclose(blade.sections(eta), baseline.variant(state).sections(eta), rtol=0, atol=0)
    assert blade.name == baseline.stem(state)


def test_how_the_blade_is_made_is_in_the_script_and_the_command():
    script = python(GEODESIC, ENTRY, "x").replace("'", '"')
    assert ', path="geodesic", fair_planform=bg.PlanformFairing())' in script
    words = shlex.split(shell(GEODESIC, ENTRY, "x"))
    assert words[words.index("--path") + 1] == "geodesic"
    asked = words[words.index("--fair-planform") + 1]
    assert planform_fairing(asked, "fair-planform") == bg.PlanformFairing()


def test_how_files_are_is_in_the_script_and_the_command():
    state = replace(STATES[0], files=Delivery("mm", 0.25))
    words = shlex.split(shell(state, ENTRY, "x"))
    assert words[words.index("--unit") + 1] == "mm"
    assert words[words.index("--tolerance") + 1] == "0.25mm"
    assert "unit='mm', tolerance=0.25e-3)" in python(state, ENTRY, "x")
    assert state.files.options.tolerance == pytest.approx(2.5e-4)
    assert STATES[0].files.options == Options()


@pytest.mark.parametrize("loft", [Loft(), GEODESIC.loft])
def test_the_script_makes_the_blade_that_is_shown(loft, tmp_path, monkeypatch):
    state = replace(STATES[0], loft=loft)
    shown = Library(tmp_path).baseline("nrel5mw", loft).variant(state)
    written = []
    monkeypatch.setattr(bg, "export", lambda blade, path: written.append(blade))
    exec(compile(python(state, ENTRY, "x"), "recipe", "exec"), {})
    eta = np.linspace(0.0, 1.0, 12)
    assert_allclose(written[0].sections(eta), shown.sections(eta), rtol=0, atol=0)


def test_the_command_makes_the_same_blade(baseline, tmp_path):
    state = MOVED
    words = shlex.split(shell(state, ENTRY, baseline.stem(state)))
    assert words[0] == "bladegen"
    words[words.index("out/")] = str(tmp_path)
    done = CliRunner().invoke(commands.app, [*words[1:], "--format", "stl", "--stations", "30"])
    assert done.exit_code == 0, done.output
    made = checks.check_file(tmp_path / f"{baseline.stem(state)}.stl").figures
    own = bg.export(baseline.variant(state), tmp_path / "own.stl", stations=30)
    assert made["volume"] == pytest.approx(checks.check_file(own).figures["volume"], rel=1e-6)


def test_names_with_blanks_and_quotes_are_one_word():
    entry = replace(ENTRY, named="my 'blade'; rm -rf.yaml", airfoils="my 'foils'")
    words = shlex.split(shell(STATES[0], entry, "x"))
    assert words[2] == entry.named
    assert words[words.index("--airfoils") + 1] == entry.airfoils
    code = python(STATES[0], entry, "x")
    assert compile(code, "recipe", "exec")
    assert f"bg.read({entry.named!r}, airfoils={entry.airfoils!r})" in code
