import base64
import io
import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from IPython.core.formatters import DisplayFormatter
from PIL import Image

import bladegen as bg


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101)


def test_a_notebook_shows_table_and_picture(blade):
    data, _ = DisplayFormatter().format(blade)
    assert data["text/plain"] == "<Blade iea15mw: 117.0 m, 10 stations, 101 landmarks>"
    page = data["text/html"]
    assert "<td style='text-align:left'>117.00 m</td>" in page
    encoded = re.search(r"base64,([A-Za-z0-9+/=]+)'", page)[1]
    image = np.asarray(Image.open(io.BytesIO(base64.b64decode(encoded))).convert("L"))
    assert image.shape[1] > 500
    assert image.std() > 1
    assert len(page) < 200_000


def test_names_are_escaped_and_changes_named(blade):
    variant = blade.perturbed(thickness=1.1, name="<b>")
    shown = replace(
        variant, definition=replace(variant.definition, description="<i>")
    )._repr_html_()
    assert "<i>" not in shown
    assert "&lt;b&gt;" in shown
    assert "thickness 1.1" in shown


def test_definitions_spaces_and_families_show_tables(blade):
    space = bg.ShapeSpace.bundled()
    definition = replace(blade.definition, description="<i>")
    for value, words in (
        (definition, ("117.00 m", "FFA-W3-211", "&lt;i&gt;", "windIO 2")),
        (space, ("401", "t4", "rad")),
        (replace(space, coordinates=np.zeros((0, 4))), ("t4", "%")),
        (bg.family(blade, space, count=3), ("iea15mw", "ellipsoid", "t1", "redraw")),
    ):
        data, _ = DisplayFormatter().format(value)
        assert len(data["text/plain"]) < 200
        assert data["text/html"].startswith("<table>")
        assert "<i>" not in data["text/html"]
        assert all(word in data["text/html"] for word in words)


def test_plot_shows_a_picture_in_a_notebook(blade, monkeypatch):
    shown = []
    kernel = type("Shell", (), {"kernel": object()})()
    monkeypatch.setattr("IPython.get_ipython", lambda: kernel)
    monkeypatch.setattr("IPython.display.display", shown.append)
    blade.plot()
    image = Image.open(io.BytesIO(shown[0].data))
    assert image.size[0] > 500


def test_a_plain_blade_loads_nothing_that_draws():
    code = (
        "import sys, bladegen as bg;"
        "b = bg.Blade.from_definition(bg.read('nrel5mw'), landmarks=51); repr(b);"
        "assert not {'matplotlib', 'bladegen.views.notebook', 'pyvista'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
