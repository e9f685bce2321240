from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import bladegen as bg
from bladegen.airfoils.landmarks import landmark_parameters, landmarks
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.lofting import edge_widths as lofting
from bladegen.blade.lofting.edge_widths import Wedges
from bladegen.curves.sides import sides
from bladegen.errors import GeometryError
from bladegen.measures.smoothness import edge_bulges, edge_widths
from bladegen.shapes import grassmann
from strategies import airfoils, circle, definitions, few, naca

U = landmark_parameters(401)
SPLINES = SectionSplines(U)
PATHS = pytest.mark.parametrize("path", ["geodesic", "spline"])


@given(airfoils(), st.floats(0.0, 0.06))
def test_a_wedge_gives_the_width_and_keeps_chord_thickness_and_nose(xy, width):
    profile = landmarks(xy, 401)[None]
    A, c = SPLINES.normalising(profile, None)
    profile = profile @ A + c[:, None]
    before = SPLINES.fit(profile)
    opened = profile + Wedges.to(before, np.array([width]))(profile)
    after = SPLINES.fit(opened)
    assert_allclose(after.edge_width, width, atol=1e-14)
    assert_allclose(after.trailing_edge, before.trailing_edge, atol=1e-14)
    assert_allclose(after.leading_edge, before.leading_edge, atol=1e-9)
    assert_allclose(after.relative_thickness, before.relative_thickness, atol=1e-9)
    ahead = profile[0, :, 0] < 0.5
    assert_allclose(opened[0, ahead], profile[0, ahead], atol=0)


@PATHS
@settings(max_examples=few(8))
@given(definitions())
def test_widths_stay_between_those_of_the_stations(path, definition):
    blade = bg.Blade.from_definition(definition, landmarks=101, path=path)
    ends = blade.splines.fit(blade.profiles(blade.eta)).edge_width
    for k, (start, end) in enumerate(zip(blade.eta[:-1], blade.eta[1:], strict=True)):
        between = blade.splines.fit(blade.profiles(np.linspace(start, end, 9))).edge_width
        assert between.min() > min(ends[k : k + 2]) - 1e-9
        assert between.max() < max(ends[k : k + 2]) + 1e-9


@PATHS
@settings(max_examples=few(8))
@given(definitions())
def test_stations_stay_as_the_path_has_them(path, definition):
    blade = bg.Blade.from_definition(definition, landmarks=101, path=path)
    as_blended = replace(blade, edge_width=None)
    assert_allclose(blade.profiles(blade.eta), as_blended.profiles(blade.eta), atol=1e-12)


@pytest.mark.parametrize(
    ("path", "radians", "chords"), [("geodesic", 2.6e-3, 1.1e-3), ("spline", 3.5e-3, 1.4e-3)]
)
def test_wedges_leave_the_path_by_no_more_than_the_docs_say(path, radians, chords):
    """docs/theory.md and docs/smoothness.md; distances on Gr(n, 2), and of landmarks."""
    eta = np.union1d(np.linspace(0.0, 1.0, 41), [0.077, 0.13, 0.204, 0.26])  # worst of 1,001
    on_path, moved = [], []
    for name in bg.bundled():
        blade = bg.Blade.from_definition(bg.read(name), path=path)
        shapes = blade.shapes(eta)[0]
        on_path.append(grassmann.distance(blade.shape_path(blade.parameter(eta)), shapes).max())
        to = blade.profiles(eta) - replace(blade, edge_width=None).profiles(eta)
        moved.append(np.linalg.norm(to, axis=-1).max())
    assert 0.9 * radians < max(on_path) < radians
    assert 0.9 * chords < max(moved) < chords


@PATHS
@pytest.mark.parametrize("name", bg.bundled())
def test_no_bundled_blade_bulges(name, path):
    assert edge_bulges(bg.Blade.from_definition(bg.read(name), path=path)) == []


def test_edges_that_bulge_between_stations_are_found():
    made = bg.Blade.from_definition(bg.read("iea15mw"), path="spline")
    made = replace(made, edge_width=None)
    bulges = edge_bulges(made)
    eta, excess = bulges[0]
    k = int(np.searchsorted(made.eta, eta)) - 1
    ends = edge_widths(made, made.eta[k : k + 2])
    width = edge_widths(made, np.array([eta]))
    assert_allclose(max(ends.min() - width, width - ends.max()), excess)


def test_a_side_that_ends_ahead_of_mid_chord_is_refused():
    points = landmarks(naca(0.12, 0.0, 0.01), 101)
    points = np.array(points)
    points[0] = [0.3, points[0, 1]]
    curves = SectionSplines(landmark_parameters(101)).fit(points[None])
    with pytest.raises(GeometryError, match=r"ends at 0\.\d+ of its chord, must be behind 0\.5"):
        Wedges.to(curves, np.array([0.01]))


def blunt(width, thickness=0.9, count=301):
    """A body that is half an ellipse ahead and tapers to an edge as wide as `width` behind."""
    x = np.linspace(0.0, 1.0, count) ** 2
    ahead = 0.5 * thickness * np.sqrt(np.clip(1.0 - (x - 0.4) ** 2 / 0.16, 0.0, 1.0))
    f = np.clip((x - 0.4) / 0.6, 0.0, 1.0)
    behind = 0.5 * (thickness + (width - thickness) * f**2)
    half = np.where(x < 0.4, ahead, behind)
    return np.concatenate([np.stack([x, half], 1)[::-1], np.stack([x, -half], 1)[1:]])


def round_to_flatback(width, path, thickness=0.9):
    """A blade that is round at its root and a flatback of this width from 5 % of the span on."""
    definition = bg.read("nrel5mw")
    back = bg.Airfoil("flatback", blunt(width, thickness))
    eta = np.array([0.0, 0.02, 0.05, 1.0])
    foils = [bg.Airfoil("circle", circle(301))] * 2 + [back, back]
    return bg.Blade.from_definition(
        replace(
            definition,
            stations=tuple(bg.Station(*pair) for pair in zip(eta.tolist(), foils, strict=True)),
            relative_thickness=bg.Distribution(eta, np.array([1.0, 1.0, thickness, thickness])),
        ),
        landmarks=201,
        path=path,
    )


def behind(blade, eta):
    """Thickness at 95 % of the chord."""
    upper, lower = sides(blade.profiles(eta), np.array([0.95]))
    return (upper - lower)[:, 0]


@PATHS
def test_a_flatback_grows_out_of_a_circle_without_a_dent_behind(path):
    made = round_to_flatback(0.4, path)
    eta = np.linspace(0.02, 0.05, 61)
    ends = behind(made, eta[[0, -1]])
    dents = [ends.min() - behind(one, eta).min() for one in (replace(made, edge_width=None), made)]
    assert dents[0] > 0.02
    assert dents[1] < 0.4 * dents[0]
    widths = edge_widths(made, eta)
    assert np.all(np.diff(widths) >= -1e-12)
    assert_allclose(widths[[0, -1]], edge_widths(made, made.eta[[1, 2]]), atol=1e-12)
    assert edge_bulges(made) == []


@PATHS
def test_stations_and_edges_that_hardly_differ_know_nothing_of_dents(path, monkeypatch):
    made = round_to_flatback(0.08, path)
    eta = np.linspace(0.0, 1.0, 201)
    before = made.profiles(eta)
    monkeypatch.setattr(lofting, "FILLED", 0.0)
    again = round_to_flatback(0.08, path)
    assert_array_equal(again.profiles(eta), before)
    wide = round_to_flatback(0.4, path)
    monkeypatch.undo()
    assert_allclose(
        round_to_flatback(0.4, path).profiles(wide.eta), wide.profiles(wide.eta), atol=1e-12
    )
