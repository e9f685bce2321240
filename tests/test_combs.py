import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.airfoils.landmarks import contour
from bladegen.cli.options.common import Making
from bladegen.errors import BladegenError, ExportError
from bladegen.views.plots import combs
from bladegen.views.plots.style import BASELINE, VARIANT
from strategies import ellipse


@given(st.floats(0.2, 1.0))
def test_an_ellipse_has_its_curvature(thickness):
    teeth = combs.comb(contour(ellipse(thickness, 801)))
    x, y = (teeth.points - [0.5, 0.0]).T
    a, b = 0.5, 0.5 * thickness
    wanted = a * b / (a**2 * (y / b) ** 2 + b**2 * (x / a) ** 2) ** 1.5
    inner = np.abs(x) < 0.45
    assert_allclose(teeth.curvature[inner], wanted[inner], rtol=1e-3)
    outward = np.sum(teeth.normal * (teeth.points - [0.5, 0.0]), axis=1)
    assert np.all(outward > 0)
    assert_allclose(np.linalg.norm(teeth.normal, axis=1), 1.0)


def test_a_picture_and_figures_of_every_airfoil(tmp_path):
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=51)
    names = {station.airfoil.name for station in blade.definition.stations}
    figures = combs.figures(blade)
    assert {one["airfoil"] for one in figures} == names
    assert all(one["moved_by_chord"] <= 1.0000001e-5 for one in figures)
    assert all(one["roughness_faired"] < one["roughness_given"] for one in figures)
    combs.draw(blade, tmp_path / "combs.png")
    assert (tmp_path / "combs.png").read_bytes()[:4] == b"\x89PNG"
    with pytest.raises(ExportError, match="suffix"):
        combs.draw(blade, tmp_path / "combs.txt")


def test_the_figure_shows_the_contours_with_teeth_on_them():
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=51)
    drawn = combs.drawing(blade)
    assert len(drawn.axes) == len(combs.figures(blade))
    for axis, curve in zip(drawn.axes, combs._pairs(blade).values(), strict=True):
        given, faired, line = axis.lines
        assert (given.get_color(), faired.get_color()) == (BASELINE, VARIANT)
        teeth = combs.comb(curve[1])
        assert_allclose(np.stack(line.get_data(), axis=-1), teeth.points)
        tips = np.stack(faired.get_data(), axis=-1)
        shown = np.isfinite(tips[:, 0])
        assert 0.5 < shown.mean() < 1.0
        across = (tips - teeth.points)[shown]
        (dx, dy), (nx, ny) = across.T, teeth.normal[shown].T
        assert_allclose(dx * ny - dy * nx, 0.0, atol=1e-12)


def test_of_many_airfoils_the_roughest_are_drawn_in_their_order(monkeypatch):
    monkeypatch.setattr(combs, "MOST", 3)
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=51)
    figures = sorted(combs.figures(blade), key=lambda one: -one["roughness_given"])[:3]
    drawn = combs.drawing(blade)
    names = [axis.get_title().partition(":")[0] for axis in drawn.axes]
    assert set(names) == {one["airfoil"] for one in figures}
    assert names == [name for name in combs._pairs(blade) if name in names]
    assert "the 3 roughest airfoils" in drawn.get_suptitle()
    assert sum(axis.get_legend() is not None for axis in drawn.axes) == 1


def test_an_unfaired_blade_is_as_rough_as_given():
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=51, fairing=None)
    for one in combs.figures(blade):
        assert one["roughness_faired"] == one["roughness_given"]
        assert one["moved_by_chord"] == 0.0


def test_fairing_is_asked_for_by_its_tolerance_or_off():
    def moved(fairing):
        made = Making(fairing=fairing).blade("iea15mw", 51)
        return max(curve.moved for curve in made.contours)

    assert moved("off") == 0.0
    assert moved("1e-6") <= 1.0000001e-6 < moved("2e-5") <= 2.0000001e-5
    with pytest.raises(BladegenError, match="fairing: got 'no', must be a share of the chord"):
        moved("no")
    with pytest.raises(BladegenError, match=r"fairing: got 0\.5 chord, allowed is"):
        moved("0.5")
