import pytest
from hypothesis import given
from hypothesis import strategies as st

from bladegen.errors import BladegenError
from bladegen.texts import coordinates, metres, span_window


@given(st.floats(1e-6, 1e3), st.sampled_from([("um", 1e-6), ("mm", 1e-3), ("cm", 1e-2), ("m", 1)]))
def test_a_number_with_a_unit(number, unit):
    name, factor = unit
    for text in (f"{number!r}{name}", f" {number!r} {name} "):
        assert metres(text, "x") == pytest.approx(number * factor, rel=1e-12)


@pytest.mark.parametrize("text", ["", "3", "mm", "-1mm", "1 inch", "1mm2", "nan mm", "1,5mm"])
def test_anything_else_is_refused(text):
    with pytest.raises(BladegenError, match=r"tolerance: got .* such as 0.3mm"):
        metres(text, "tolerance")


def test_coordinates_and_windows():
    assert coordinates([]) is None
    assert coordinates(["0.1,-2e-2"]).values.tolist() == [[0.1, -0.02]]
    knots = coordinates(["0,0@0.7", "0.1,0@0.5"])
    assert knots.grid.tolist() == [0.5, 0.7]
    assert knots.values.tolist() == [[0.1, 0.0], [0.0, 0.0]]
    window = span_window("0.1,0.3")
    assert (window.start, window.end) == (0.1, 0.3)


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (["a,b"], "pga: got 'a,b', must be numbers"),
        (["1,2@x"], "pga: got 'x'"),
        (["1,2@0.1", "1,2"], "must end in @ETA"),
        (["1,2@0.1", "1@0.2"], "same number"),
    ],
)
def test_wrong_coordinates_are_refused(texts, message):
    with pytest.raises(BladegenError, match=message):
        coordinates(texts)


@pytest.mark.parametrize("text", ["0.1", "a,b", "0.5,0.1", "0.1,0.2,0.3"])
def test_wrong_windows_are_refused(text):
    with pytest.raises(BladegenError, match="window"):
        span_window(text)
