import math
import os

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from pyarrow import csv, parquet

from bladegen.cli.options import parsing
from bladegen.cli.options.parsing import coordinates, metres, radians, span_window
from bladegen.errors import BladegenError, FileError
from bladegen.shapes.shape_space import ShapeSpace


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


def test_bounds_are_read_twist_in_degrees():
    bounds = parsing.factor_bounds(["thickness=0.9:1.1", "twist=-2:2"])
    assert bounds["thickness"] == (0.9, 1.1)
    assert_allclose(bounds["twist"], np.radians([-2, 2]))


@pytest.mark.parametrize("text", ["thickness", "thickness=1", "thickness=1:2:3", "t=a:b", "=", ""])
def test_bounds_of_another_form_are_refused(text):
    with pytest.raises(BladegenError):
        parsing.factor_bounds([text])


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_tables_are_read(tmp_path, suffix):
    path = tmp_path / f"plan{suffix}"
    columns = {"t1": [0.1, -0.2], "twist_deg": [1.0, 2.0], "name": ["a", "b"]}
    table = pa.table(columns)
    csv.write_csv(table, path) if suffix == ".csv" else parquet.write_table(table, path)
    design = parsing.factor_table(ShapeSpace.bundled(), path)
    assert design.what.names == ("t1", "twist")
    assert_allclose(design.values, [[0.1, np.radians(1)], [-0.2, np.radians(2)]])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("t1,height\n1,2\n", "got 'height'"),
        ("t1\nx\n", "not a table of numbers"),
        ("t1\n1\n,\n", "not a table|must be a number"),
        ("", "not a table of numbers"),
        ("chord\n99\n", "row 1, chord"),
    ],
)
def test_tables_that_are_none_say_why(tmp_path, text, said):
    path = tmp_path / "plan.csv"
    path.write_text(text)
    with pytest.raises(BladegenError, match=said) as caught:
        parsing.factor_table(ShapeSpace.bundled(), path)
    assert "plan.csv" in str(caught.value)


def test_a_table_that_is_not_there_says_so(tmp_path):
    with pytest.raises(BladegenError, match="cannot be read"):
        parsing.factor_table(None, tmp_path / "none.csv")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_tables_of_spreadsheets_are_read(tmp_path, encoding):
    path = tmp_path / "plan.csv"
    path.write_text("t1;twist_deg;name\n\n0,1;1,5;a\n\n-0,2;2;b\n", encoding=encoding)
    design = parsing.factor_table(ShapeSpace.bundled(), path)
    assert_allclose(design.values, [[0.1, np.radians(1.5)], [-0.2, np.radians(2)]])


@pytest.mark.parametrize("name", ["plan.csv", "plan.parquet"])
def test_a_table_is_a_regular_file(tmp_path, name):
    os.mkfifo(tmp_path / name)
    with pytest.raises(FileError, match="is no regular file"):
        parsing.factor_table(None, tmp_path / name)


@pytest.mark.parametrize(("text", "angle"), [("4", 4.0), ("-2.5deg", -2.5), (" 3 ° ", 3.0)])
def test_angles_are_degrees_unless_they_say_otherwise(text, angle):
    assert radians(text, "precone") == pytest.approx(math.radians(angle))
    assert radians("0.07rad", "precone") == 0.07
    with pytest.raises(BladegenError, match="precone: got '4m', must be an angle"):
        radians("4m", "precone")
