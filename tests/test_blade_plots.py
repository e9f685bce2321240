import numpy as np
import pytest
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.cli.view import What
from bladegen.errors import ExportError
from bladegen.shapes import grassmann
from bladegen.surface.grids.grid import Spacing
from bladegen.views.plots import blade_plots, layup_plot, path_plot, volume_plot


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)


@pytest.fixture(scope="module")
def variant(blade):
    return blade.perturbed(
        bg.ShapeSpace.bundled(), [0.03, 0, 0, 0], thickness=1.05, twist=0.02, name="changed"
    )


def lines(axis, style="-"):
    return [line for line in axis.lines if line.get_linestyle() == style]


def test_the_planform_shows_the_definitions_curves(blade, variant):
    drawn = blade_plots.planform(variant, blade)
    by_label = {axis.get_ylabel(): axis for axis in drawn.axes}
    eta = np.linspace(0, 1, blade_plots.SPANS)
    for label, values in (
        ("chord, m", variant.chord(eta)),
        ("twist, deg", np.degrees(variant.twist(eta))),
        ("prebend x, m", variant.axis(eta)[:, 0]),
    ):
        solid = lines(by_label[label])[0]
        assert_allclose(solid.get_xdata(), eta)
        assert_allclose(solid.get_ydata(), values)
    dashed = lines(by_label["twist, deg"], "--")[0]
    assert_allclose(dashed.get_ydata(), np.degrees(blade.twist(eta)))
    assert "sweep y, m" not in by_label


def test_a_swept_blade_shows_its_sweep(blade):
    from dataclasses import replace

    axis = blade.definition.axis
    swept = bg.Distribution([0.0, 1.0], [0.0, 3.0])
    definition = replace(blade.definition, axis=replace(axis, y=swept))
    drawn = blade_plots.planform(bg.Blade.from_definition(definition, landmarks=101))
    shown = next(axis for axis in drawn.axes if axis.get_ylabel() == "sweep y, m")
    assert lines(shown)[0].get_ydata()[-1] == 3.0


def test_the_path_shows_distances_and_coordinates(blade):
    away, speed, coordinates, _ = path_plot.path(blade).axes
    space = bg.ShapeSpace.bundled()
    eta = np.linspace(0, 1, path_plot.SHAPES)
    for k, line in enumerate(lines(coordinates)):
        assert_allclose(line.get_ydata(), space.encode(blade.shapes(eta)[1])[:, k])
    stations = blade.shapes(np.unique(blade.eta))[1]
    known = [stations[0]]
    for point in stations[1:]:
        if grassmann.distance(known[-1], point) > 1e-9:
            known.append(point)
    mean = grassmann.karcher_mean(np.array(known))
    assert_allclose(
        lines(away)[0].get_ydata(), grassmann.distance(mean, blade.shapes(eta)[1]), atol=1e-9
    )
    # the integral of the speed is no less than the distance of the ends
    length = np.sum(lines(speed)[0].get_ydata()) / (path_plot.SHAPES - 1)
    assert length >= grassmann.distance(stations[0], stations[-1])


def test_other_landmarks_have_no_coordinates_in_the_bundled_space():
    drawn = path_plot.path(bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101))
    assert any("needs 401 landmarks" in text.get_text() for text in drawn.axes[2].texts)
    assert not drawn.axes[2].lines


def test_the_curvature_of_the_round_root_is_two_over_its_chord(blade):
    profiles = blade.profiles(np.array([0.0]))
    bend = blade_plots._section_curvature(blade, profiles)
    assert np.median(bend) == pytest.approx(2.0, rel=0.02)


def test_sections_are_shown_at_each_station(blade, variant):
    metres, chords, standard = blade_plots.sections(variant, blade).axes
    stations = len(np.unique(blade.eta))
    for axis in (metres, chords, standard):
        assert (len(lines(axis)), len(lines(axis, "--"))) == (stations, stations)
    shape = np.stack(lines(standard)[0].get_data(), axis=-1)
    assert_allclose(shape.T @ shape, np.eye(2), atol=1e-12)


def test_thickness_agrees_with_the_blade(blade):
    first = blade_plots.thickness(blade).axes[0]
    eta = np.linspace(0, 1, blade_plots.SPANS)
    assert_allclose(lines(first)[0].get_ydata(), 100 * blade.relative_thickness(eta), atol=1e-9)


def test_the_command_line_knows_all_plots_and_no_more():
    assert [one.value for one in What] == [*blade_plots.PLOTS, "all"]


@pytest.mark.parametrize("name", blade_plots.PLOTS)
def test_figures_name_the_blade_and_touch_no_global_state(name, blade, variant, monkeypatch):
    from matplotlib import pyplot

    few_points = Spacing(around=65, along=21, edge=8)
    monkeypatch.setattr(volume_plot, "SPACING", few_points)
    before = pyplot.get_fignums()
    drawn = blade_plots.PLOTS[name].draw(variant, blade)
    assert "perturbed: t 0.03, 0, 0, 0, thickness 1.05, twist" in drawn.get_suptitle()
    assert all(axis.get_ylabel() for axis in drawn.axes)
    assert pyplot.get_fignums() == before


def polygon(patch):
    x, y = patch.get_xy().T
    return 0.5 * abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1)))


def test_layers_are_drawn_as_thick_and_as_wide_as_they_are(blade):
    drawn = blade_plots.layup(blade)
    strips, *rows = drawn.axes
    assert {web.name for web in blade.definition.structure.webs} <= {
        text.get_text().strip() for text in strips.texts
    }
    laid = blade.layup.at(np.array(layup_plot.SHOWN))
    for k, pair in enumerate(zip(rows[::2], rows[1::2], strict=True)):
        areas = [sum(map(polygon, axis.patches)) for axis in pair]
        own = float((laid.width * laid.thickness)[:, k].sum())
        assert_allclose(areas[0], own, rtol=0.05)  # they are shorter inside of the skin
        assert_allclose(areas[1], layup_plot.TIMES * own, rtol=0.2)


def test_a_blade_without_layers_is_not_drawn_with_any():
    bare = bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)
    assert "layup" not in blade_plots.drawable(bare)
    with pytest.raises(ExportError, match="has no webs and layers to be drawn"):
        blade_plots.layup(bare)
