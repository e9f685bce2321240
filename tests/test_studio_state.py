from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bladegen.blade.lofting.paths import PATHS
from bladegen.errors import StudioError
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.studio.choices.delivery import Delivery
from bladegen.studio.choices.loft import Loft
from bladegen.studio.controls import AFFINE, AT, controls
from bladegen.studio.state import History, State, from_query, to_query
from strategies import few

SPACE = ShapeSpace.bundled()
KNOWN = controls(SPACE)


def on_grid(control):
    """Numbers that a control allows."""
    steps = int((control.high - control.low) / control.step)
    return st.integers(0, steps).map(lambda k: control.parsed(control.low + k * control.step))


@st.composite
def states(draw):
    t = tuple(draw(on_grid(KNOWN[f"t{k + 1}"])) for k in range(SPACE.dimension))
    window = draw(st.none() | st.tuples(*[on_grid(KNOWN["start"])] * 2).map(sorted).map(tuple))
    rest = {control.name: draw(on_grid(control)) for control in (*AFFINE, AT)}
    rest["loft"] = Loft(draw(st.sampled_from(list(PATHS))), draw(st.booleans()))
    return State(draw(st.sampled_from(["iea15mw", "my-blade-0123"])), t, window, **rest)


@given(states())
def test_a_link_holds_the_state(state):
    query = to_query(state)
    assert from_query(query, KNOWN, "other") == state
    assert from_query("?".join(["", query])[1:], KNOWN, "other") == state


def test_the_shortest_link_names_the_blade_alone():
    assert to_query(State("nrel5mw")) == "blade=nrel5mw"
    assert from_query("", KNOWN, "dtu10mw") == State("dtu10mw")


@pytest.mark.parametrize(
    ("query", "words"),
    [
        ("thickness=9", "thickness: got 9, allowed is 0.8 to 1.2"),
        ("twist=nan", "twist: got nan, allowed is -5 to 5 deg"),
        ("camber=high", "camber: got high, allowed is 0.9 to 1.1"),
        ("t=0,0", "got 2 coordinates, must be 4"),
        ("t=0,0,0,1", "shape 4: got 1, allowed is -0.064 to 0.06"),
        ("window=0.5", "must be two span fractions"),
        ("window=0.5,0.2", "got 0.5 to 0.2, must rise"),
        ("path=straight", "path: got 'straight', allowed are spline, geodesic"),
        ("fair=no", "link: fair: got 'no', allowed is yes"),
        ("off=some", "off: got 'some', allowed are all, rigid, affine"),
        ("unit=ft", "unit: got 'ft', allowed are m, mm"),
        ("tolerance=none", "tolerance: got nan, allowed is 0.001 to 50 mm"),
        ("tolerance=99", "tolerance: got 99, allowed is 0.001 to 50 mm"),
        ("start=0.5", "'start' is unknown"),
        ("<script>=1", "is unknown, allowed are blade, t, window"),
        ("at=" + "1" * 3000, "allowed are 2000"),
    ],
)
def test_links_say_what_is_not_allowed(query, words):
    with pytest.raises(StudioError) as caught:
        from_query(query, KNOWN, "iea15mw")
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@given(st.sampled_from(sorted(KNOWN)), st.floats(0, 1))
def test_controls_keep_their_grid_and_bounds(name, share):
    control = KNOWN[name]
    low, high = float(control.low), float(control.high)
    value = control.parsed(low + share * (high - low))
    assert low <= value <= high
    assert control.parsed(value) == value
    assert float(f"{value:.{control.places}f}") == value


def test_shape_controls_stay_within_the_data():
    for k in range(SPACE.dimension):
        control = KNOWN[f"t{k + 1}"]
        ends = np.zeros((2, SPACE.dimension))
        ends[:, k] = float(control.low), float(control.high)
        assert SPACE.outside(ends) is None


@given(states(), st.sampled_from(sorted(set(KNOWN) - {"start", "end"})), st.data())
def test_setting_one_number_sets_no_other(state, name, data):
    value = data.draw(on_grid(KNOWN[name]))
    other = state.having(KNOWN[name], value)
    assert other.value(name) == value
    assert other.having(KNOWN[name], state.value(name)) == state


@given(states())
def test_reset_keeps_blade_and_section_alone(state):
    plain = state.reset()
    assert not plain.changed
    assert (plain.blade, plain.at, plain.window) == (state.blade, state.at, None)


@settings(max_examples=few(10))
@given(st.integers(0, 2**32 - 1), st.floats(0.05, 1.0))
def test_draws_lie_within_the_data_and_the_sliders(seed, reach):
    state = State("x", window=(0.2, 0.4)).drawn(SPACE, np.random.default_rng(seed), reach)
    assert SPACE.outside(np.array(state.t)) is None
    spread = SPACE.extent * np.sqrt(SPACE.variances[:4])
    assert np.linalg.norm(state.t / spread) <= reach + 0.05
    assert state.window == (0.2, 0.4)
    assert from_query(to_query(state), KNOWN, "x") == state


@given(st.lists(states(), min_size=1, max_size=6))
def test_undo_goes_back_and_redo_forth_again(moves):
    history = History(State("iea15mw"))
    for state in moves:
        history = history.moved(state)
    end = history
    for _ in moves:
        history = history.undo()
    assert history.present == replace(State("iea15mw"), at=history.present.at)
    assert not history.before
    for _ in moves:
        history = history.redo()
    assert history.present == end.present
    assert history.redo() == history


def test_one_drag_is_one_step_and_the_section_is_none():
    thickness = KNOWN["thickness"]
    start = State("iea15mw")
    history = History(start)
    for value in (1.01, 1.02, 1.03):
        history = history.moved(history.present.having(thickness, value), "thickness")
    assert len(history.before) == 1
    history = history.paused().moved(history.present.having(thickness, 1.1), "thickness")
    assert len(history.before) == 2
    history = history.moved(replace(history.present, at=0.3))
    assert len(history.before) == 2
    back = history.undo()
    assert (back.present.thickness, back.present.at) == (1.03, 0.3)
    assert back.moved(start.having(thickness, 0.9)).undone == ()
    assert history.moved(history.present) is history


def test_what_is_seen_and_how_files_are_is_no_step_and_stays():
    files = Delivery("mm", 0.5)
    seen = replace(State("nrel5mw"), off="affine", files=files, beside="dtu10mw")
    words = "blade=nrel5mw&off=affine&unit=mm&tolerance=0.5&beside=dtu10mw"
    assert to_query(seen) == words
    assert from_query(to_query(seen), KNOWN, "iea15mw") == seen
    thick = replace(seen, thickness=1.1)
    history = History(State("nrel5mw", thickness=1.1)).moved(thick)
    assert not history.before
    assert history.present == thick
    history = history.moved(thick.reset())
    assert (history.present.off, history.present.files) == (thick.off, thick.files)
    other = replace(history.present, off="rigid")
    assert history.moved(other).undo().present == replace(thick, off="rigid")
