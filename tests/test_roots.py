import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.curves.roots import HALVED, ITERATIONS, bracketed


def counted(functions):
    """Return functions of places as `bracketed` takes them, and how often each was called."""
    calls = np.zeros(len(functions), dtype=int)

    def values(place, rows):
        calls[rows] += 1
        return np.array([functions[row](x) for row, x in zip(rows, place, strict=True)])

    return values, calls


@given(
    root=st.floats(0.01, 0.99),
    steep=st.floats(1.0, 1e4),
    bend=st.floats(-0.9, 0.9),
)
def test_smooth_functions_fall_through_zero_where_it_is_found(root, steep, bend):
    def falls(x):
        return steep * (root - x) * (1.0 + bend * x)

    values, calls = counted([falls])
    place, either = bracketed(values, 1, 1e-11)
    assert not either[0]
    assert abs(falls(place[0])) <= 1e-11 or abs(place[0] - root) <= 1e-12
    assert calls[0] <= 20


@given(
    jump=st.floats(0.01, 0.99),
    above=st.floats(1e-2, 1e3),
    below=st.floats(1e-2, 1e3),
    slope=st.floats(0.0, 0.5),
)
def test_jumps_are_found_in_few_calls_and_taken_on_the_side_nearer_to_zero(
    jump, above, below, slope
):
    """False position alone took 60 calls, and stopped 4e-4 away from a jump of 2.5 and -1e-3."""

    def falls(x):
        return above + slope * (jump - x) if x < jump else -below - slope * (x - jump)

    values, calls = counted([falls])
    place, _ = bracketed(values, 1, 1e-11)
    assert_allclose(place[0], jump, rtol=0, atol=2 * HALVED)
    assert calls[0] < 40 < ITERATIONS
    if abs(above - below) > 2 * slope * HALVED:
        assert (place[0] < jump) == (above < below)


def test_functions_do_not_know_of_each_other():
    functions = [
        lambda x: 0.3 - x,
        lambda x: 2.5 if x < 0.12 else -1e-2,
        lambda x: -1.0 - x,
        lambda x: 2.0 - x,
        lambda x: 0.2 - x**3,
    ]
    together, _ = bracketed(counted(functions)[0], len(functions), 1e-11)
    alone = [bracketed(counted([f])[0], 1, 1e-11)[0][0] for f in functions]
    assert together.tolist() == alone
    assert together[2:4].tolist() == [0.0, 1.0]


def test_where_both_ends_would_do_it_says_so():
    place, either = bracketed(counted([lambda x: x - 0.5])[0], 1, 1e-11)
    assert (place[0], bool(either[0])) == (0.0, True)
