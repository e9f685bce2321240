import pytest
from hypothesis import given
from hypothesis import strategies as st

from bladegen.errors import BladegenError
from bladegen.texts import metres


@given(st.floats(1e-6, 1e3), st.sampled_from([("um", 1e-6), ("mm", 1e-3), ("cm", 1e-2), ("m", 1)]))
def test_a_number_with_a_unit(number, unit):
    name, factor = unit
    for text in (f"{number!r}{name}", f" {number!r} {name} "):
        assert metres(text, "x") == pytest.approx(number * factor, rel=1e-12)


@pytest.mark.parametrize("text", ["", "3", "mm", "-1mm", "1 inch", "1mm2", "nan mm", "1,5mm"])
def test_anything_else_is_refused(text):
    with pytest.raises(BladegenError, match=r"tolerance: got .* such as 0.3mm"):
        metres(text, "tolerance")
