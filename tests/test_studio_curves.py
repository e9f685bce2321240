"""Curves over span that are dragged: chord, twist and prebend."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import bladegen as bg
from bladegen.cli import commands
from bladegen.errors import BladegenError, PerturbationError, StudioError
from bladegen.studio import recipes
from bladegen.studio.choices.drawn import KNOTS, UNDRAWN
from bladegen.studio.controls import controls
from bladegen.studio.library import Entry
from bladegen.studio.model import Baseline
from bladegen.studio.state import History, State, from_query, to_query

SPACE = bg.ShapeSpace.bundled()


@pytest.fixture(scope="module")
def baseline():
    return Baseline("iea15mw", bg.Blade.from_definition(bg.read("iea15mw")), SPACE)


@pytest.fixture(scope="module")
def dragged(baseline):
    state = State("iea15mw", (0.01, 0.0, 0.0, 0.0), chord=1.02, twist=0.5, prebend=1.2)
    for name, knot, value in (("chord", 2, 3.9), ("twist", 3, -3.0), ("prebend", 4, -7.0)):
        state = baseline.dragged(state, name, knot, value)
    return state


def test_a_curve_passes_where_it_was_dragged_to(baseline, dragged):
    curves = baseline.scene(dragged).curves
    at = [int(np.argmin(np.abs(baseline.eta - KNOTS[knot]))) for knot in (2, 3, 4)]
    assert curves.chord[at[0]] == pytest.approx(3.9, abs=0.0025)  # steps of 0.001 of the chord
    assert curves.twist[at[1]] == pytest.approx(-3.0, abs=0.006)
    assert curves.prebend[at[2]] == pytest.approx(-7.0, abs=0.006)
    plain = baseline.at(0.5).curves
    root = baseline.eta < 0.02
    for name in ("chord", "twist", "prebend"):
        assert_allclose(getattr(curves, name)[root], getattr(plain, name)[root], atol=0.02)


def test_what_is_shown_is_the_blade_that_is_made(baseline, dragged):
    scene, blade = baseline.scene(dragged), baseline.variant(dragged)
    assert_allclose(scene.sections, blade.sections(baseline.eta), atol=1e-7)
    assert_allclose(scene.curves.prebend, blade.axis(baseline.eta)[:, 0], atol=1e-9)


def test_a_knot_where_nothing_changes_cannot_be_dragged(baseline):
    state = State("iea15mw").within(0.5, 0.9)
    assert baseline.dragged(state, "chord", 0, 1.0) == state
    far = baseline.dragged(State("iea15mw"), "twist", 4, 500.0)
    assert far.curves.twist == (0.0, 0.0, 0.0, 0.0, 10.0)


def test_a_link_holds_the_curves_and_undo_takes_a_drag_back(dragged):
    known = controls(SPACE)
    assert from_query(to_query(dragged), known, "nrel5mw") == dragged
    with pytest.raises(StudioError, match=r"link: over\.twist: got '1,2', must be 5 numbers from"):
        from_query("blade=iea15mw&over.twist=1,2", known, "nrel5mw")
    start = State("iea15mw")
    history = History(start)
    for value in (1.0, 1.1, 1.2):  # of one drag
        history = history.moved(start.dragged("twist", 1, value), "twist 1")
    history = history.paused().moved(history.present.dragged("prebend", 4, -1.0), "prebend 4")
    assert history.undo().present == start.dragged("twist", 1, 1.2)
    assert history.undo().undo().present == start
    assert history.present.reset().curves == UNDRAWN


def test_command_and_script_make_the_blade_that_was_dragged(baseline, dragged, tmp_path):
    entry = Entry("iea15mw", "iea15mw", "iea15mw", "iea15mw")
    words = recipes.shell(dragged, entry, "mine").split()
    assert not any(word.startswith(("--chord", "--twist")) for word in words)
    script = recipes.python(dragged, entry, "mine").replace("bg.export", "made = blade #")
    held = {}
    exec(script, held)
    eta = np.linspace(0.0, 1.0, 21)
    wanted = baseline.variant(dragged).sections(eta)
    assert_allclose(held["blade"].sections(eta), wanted, atol=1e-12)
    words[words.index("-o") + 1] = f"{tmp_path}/"
    result = CliRunner().invoke(commands.app, [*words[1:], "--format", "sections.csv"])
    assert result.exit_code == 0, result.output
    table = np.genfromtxt(tmp_path / "mine.sections.csv", delimiter=",", names=True, comments="#")
    rows = np.array(table[table["eta"] == 1.0].tolist())
    tip = baseline.variant(dragged).sections(np.ones(1))[0]
    assert_allclose(rows[:, -3:], tip, atol=1e-5)


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (["bend=0@0,1@1"], r"over: got 'bend=0@0,1@1', must be NAME=VALUE@ETA"),
        (["chord=1@0,1.1"], r"over: chord: got '1@0,1.1', must be values with their span"),
        (["chord=1@0,1@0.5", "chord=1@0,1@1"], "over: chord is given twice"),
        (["twist=0@0,1@1"], "over: twist is given twice"),
        (["prebend=0@0.5,1@0.5"], "over: prebend: grid must increase strictly"),
    ],
)
def test_curves_that_are_none_are_refused_in_a_line(texts, message):
    from bladegen.cli.options.knots import over_span

    with pytest.raises(BladegenError, match=message):
        over_span(texts, ["twist"])


def test_prebend_is_added_along_the_whole_span():
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)  # has none
    added = bg.Distribution([0.0, 0.5, 1.0], [0.0, -0.4, -2.0])
    bent = blade.perturbed(prebend=added)
    eta = np.linspace(0.0, 1.0, 41)
    assert_allclose(bent.axis(eta)[:, 0], added(eta), atol=1e-12)
    assert_allclose(bent.chord(eta), blade.chord(eta), atol=1e-12)
    middle = bent.sections(np.array([1.0]))[0].mean(axis=0) - blade.sections(np.ones(1))[0].mean(
        axis=0
    )
    assert middle[0] == pytest.approx(-2.0, abs=0.05)
    with pytest.raises(PerturbationError, match=r"prebend: got 1\.0, must be a bladegen"):
        blade.perturbed(prebend=1.0)
