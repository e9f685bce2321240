import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from bladegen.curves.roots import ITERATIONS, bracketed


def counted(functions):
    """Return functions of places as `bracketed` takes them, and how often each was called."""
    calls = np.zeros(len(functions), dtype=int)

    def values(place, rows):
        calls[rows] += 1
        return np.array([functions[row](x) for row, x in zip(rows, place, strict=True)])

    return values, calls


def ends(functions):
    """Return their values at 0 and at 1."""
    return tuple(np.array([f(x) for f in functions]) for x in (0.0, 1.0))


@given(
    root=st.floats(0.01, 0.99),
    steep=st.floats(1.0, 1e4),
    bend=st.floats(-0.9, 0.9),
)
def test_smooth_functions_fall_through_zero_where_it_is_found(root, steep, bend):
    def falls(x):
        return steep * (root - x) * (1.0 + bend * x)

    values, calls = counted([falls])
    place = bracketed(values, *ends([falls]), 1e-11)
    assert abs(falls(place[0])) <= 1e-11 or abs(place[0] - root) <= 1e-12
    assert calls[0] <= 20


@given(jump=st.floats(0.01, 0.99), above=st.floats(1e-2, 1e3), below=st.floats(1e-2, 1e3))
def test_a_jump_is_approached_from_both_sides_until_the_steps_are_up(jump, above, below):
    def falls(x):
        return above if x < jump else -below

    values, calls = counted([falls])
    place = bracketed(values, *ends([falls]), 1e-11)
    assert 0.0 < place[0] < 1.0
    assert calls[0] <= ITERATIONS


def test_functions_do_not_know_of_each_other():
    functions = [
        lambda x: 0.3 - x,
        lambda x: 2.5 if x < 0.12 else -1e-2,
        lambda x: -1.0 - x,
        lambda x: 2.0 - x,
        lambda x: 0.2 - x**3,
    ]
    together = bracketed(counted(functions)[0], *ends(functions), 1e-11)
    alone = [bracketed(counted([f])[0], *ends([f]), 1e-11)[0] for f in functions]
    assert together.tolist() == alone
    assert together[2:4].tolist() == [0.0, 1.0]
