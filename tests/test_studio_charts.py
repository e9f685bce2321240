import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.studio.model import Baseline
from bladegen.studio.page.charts import planform, section
from bladegen.studio.page.drawing.svg import ticks
from bladegen.studio.state import State


@pytest.fixture(scope="module")
def scenes():
    blade = bg.Blade.from_definition(bg.read("nrel5mw"))
    baseline = Baseline("nrel5mw", blade, bg.ShapeSpace.bundled())
    state = State("nrel5mw", thickness=1.2, chord=1.1, twist=3.0, at=0.4)
    return baseline.scene(state), baseline.at(0.4)


def paths(svg, kind):
    root = ET.fromstring(svg)
    box = [float(word) for word in root.get("viewBox").split()]
    found = [
        np.array(re.findall(r"-?[0-9.]+", path.get("d")), dtype=float).reshape(-1, 2)
        for path in root.iter("path")
        if path.get("class") == kind
    ]
    for points in found:
        assert np.all(points >= 0)
        assert np.all(points <= box[2:])
    return found


@pytest.mark.parametrize("placed", [False, True])
def test_a_section_is_drawn_to_scale_over_the_baseline(scenes, placed):
    scene, plain = scenes
    svg = section(scene, plain, placed=placed)
    (now,), (before,) = paths(svg, "now"), paths(svg, "before")
    given, rest = (s.placed if placed else s.profile for s in scenes)
    scale = np.ptp(now[:, 0]) / np.ptp(given[:, 0])
    assert_allclose(np.ptp(now[:, 1]) / np.ptp(given[:, 1]), scale, rtol=0.02)
    assert_allclose(np.ptp(before[:, 1]) / np.ptp(rest[:, 1]), scale, rtol=0.02)
    assert now[np.argmax(given[:, 1]), 1] == now[:, 1].min()  # up is up
    label = ET.fromstring(svg).get("aria-label")
    assert f"chord {scene.curves.chord[scene.place]:.3f} m" in label
    assert "40 % of the span" in label


def test_plots_over_span_rise_where_their_quantity_does(scenes):
    scene, plain = scenes
    svg = planform(scene, plain)
    now, before = paths(svg, "now"), paths(svg, "before")
    assert len(now) == len(before) == 4
    for points, name in zip(now, ("chord", "twist", "thickness", "prebend"), strict=True):
        values = getattr(scene.curves, name)
        if np.ptp(values):
            assert np.corrcoef(points[:, 1], -values)[0, 1] > 0.999
    assert before[0][50, 1] > now[0][50, 1]  # less chord stands lower
    assert len(paths(svg, "mark")) == 4


@given(st.floats(-1e4, 1e4), st.floats(1e-3, 1e4))
def test_ticks_are_few_round_and_inside(low, length):
    found = ticks(low, low + length)
    assert 1 <= len(found) <= 6
    assert found == sorted(found)
    slack = 1e-6 * (abs(low) + length)
    assert all(low - slack <= value <= low + length + slack for value in found)
