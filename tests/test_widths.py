from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.airfoils.landmarks import landmark_parameters, landmarks
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.lofting.edge_widths import Wedges
from bladegen.errors import GeometryError
from bladegen.measures.smoothness import edge_bulges, edge_widths
from bladegen.shapes import grassmann
from strategies import airfoils, definitions, few, naca

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
    ("path", "radians", "chords"), [("geodesic", 2.6e-3, 1.1e-3), ("spline", 6.6e-3, 2.1e-3)]
)
def test_wedges_leave_the_path_by_no_more_than_the_docs_say(path, radians, chords):
    """docs/theory.md and docs/smoothness.md; distances on Gr(n, 2), and of landmarks."""
    eta = np.union1d(np.linspace(0.0, 1.0, 41), [0.13, 0.196, 0.199, 0.26])  # worst of 1,001
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
