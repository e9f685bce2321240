"""The most lift over drag that shape coordinates give a section, as the studio looks for it."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from bladegen.errors import StudioError
from bladegen.neuralfoil import coefficients
from bladegen.studio.results.optimum import Wish, _Run, bounds, optimise
from bladegen.studio.results.question import Question
from bladegen.studio.state import State

STATE = State("iea15mw", (0.02, 0.01, 0.0, 0.0), thickness=1.05, twist=1.0, prebend=1.5, at=0.7)


@pytest.fixture
def wish(tmp_path):
    return Wish(Question("iea15mw", None, STATE), str(tmp_path), 6.0, 9e6)


def sectional(state, wish):
    """Lift over drag as one has it without the model, from the blade of a state."""
    blade = wish.question.baseline.variant(state)
    points = np.repeat(blade.profiles(np.array([state.at])), 3, axis=0)
    found = coefficients(points, wish.angles, wish.reynolds).values
    return float(np.mean(found[:, 0] / found[:, 1]))


def test_what_is_found_is_better_within_all_limits_and_not_odd(wish):
    found = optimise(wish)
    assert replace(found.state, t=STATE.t) == STATE
    assert found.before == pytest.approx(sectional(STATE, wish), rel=1e-6)
    assert found.after == pytest.approx(sectional(found.state, wish), rel=1e-6)
    assert found.after > 1.02 * found.before
    low, high = bounds(wish.question.baseline, STATE, wish.reach)
    assert np.all((low - 5e-4 <= found.state.t) & (found.state.t <= high + 5e-4))
    assert {check.status for check in wish.question.baseline.scene(found.state).checks} <= {
        "good",
        "near",
    }
    area = _Run.of(wish).area
    assert area(np.array(found.state.t))[0] < 1.025 * area(np.array(STATE.t))[0]
    assert wish.progress[0] == found.evaluations


@pytest.mark.nightly
def test_gradients_are_those_of_differences(wish):
    run, t, step = _Run.of(wish), np.array(STATE.t), 1e-5
    for figure in (run.ratio, run.area):
        slope = figure(t)[1]
        for k in range(len(t)):
            moved = step * np.eye(len(t))[k]
            difference = (figure(t + moved)[0] - figure(t - moved)[0]) / (2 * step)
            assert_allclose(slope[k], difference, rtol=1e-4, atol=1e-5 * abs(slope).max())


def test_a_run_that_is_cancelled_changes_nothing(wish):
    wish.cancel()
    found = optimise(wish)
    assert found.cancelled
    assert found.state == STATE


def test_room_ends_where_a_section_leaves_the_data(wish):
    baseline = wish.question.baseline
    low, high = bounds(baseline, STATE, 1.0)
    for k in range(len(low)):
        for end, out in ((low[k], -0.002), (high[k], 0.002)):
            t = np.zeros(len(low))
            t[k] = 0.999 * end
            assert not baseline._left(replace(STATE, t=tuple(t))).any()
            t[k] = end + out
            assert baseline._left(replace(STATE, t=tuple(t))).any()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"at": 0.02}, "shapes do not change at 2 % of the span"),
        ({"at": 0.2}, "NeuralFoil knows sections of up to 40 %"),
    ],
)
def test_where_there_is_nothing_to_optimise_is_said(wish, change, words):
    asked = replace(wish.question, state=replace(STATE, **change))
    with pytest.raises(StudioError, match=words):
        optimise(replace(wish, question=asked))


def test_wishes_have_limits(wish):
    with pytest.raises(StudioError, match=r"reach: got 2, allowed is 0\.05 to 1"):
        replace(wish, reach=2.0)
