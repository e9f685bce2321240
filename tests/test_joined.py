"""What is made quickly is what the plain formulas give: columns, slopes nearby, measures kept."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import bladegen as bg
from bladegen.airfoils.chord_lines import ChordLines
from bladegen.airfoils.landmarks import cosine, landmark_parameters, landmarks, uniform
from bladegen.airfoils.section_curves import SectionCurves
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.airfoils.slopes import SplineSlopes
from bladegen.blade.changes.affine_change import AffineChange
from bladegen.blade.edges import AsGiven, MinimumThickness, Sharp
from bladegen.blade.lofting.carried import Carried
from bladegen.blade.lofting.paths import PATHS as PATHMAKERS
from bladegen.curves.cubics import Cubics
from bladegen.shapes import affine, grassmann
from strategies import airfoils, definitions, few

PATHS = pytest.mark.parametrize("path", ["geodesic", "spline"])
SPACE = bg.ShapeSpace.bundled()
ETA = np.linspace(0.0, 1.0, 23)
SPACINGS = st.sampled_from([cosine, uniform])


@pytest.fixture(scope="module", params=["geodesic", "spline"])
def blade(request):
    return bg.Blade.from_definition(bg.read("iea15mw"), path=request.param)


@given(st.sampled_from([5, 9, 51, 101, 201]), SPACINGS, st.integers(0, 2**31), st.data())
def test_slopes_around_landmarks_are_those_of_the_whole_spline(n, spacing, seed, data):
    slopes = SplineSlopes(landmark_parameters(n, spacing))
    planes = np.random.default_rng(seed).normal(size=(2, 3, n))
    rows = np.array([2, 0, 2, 1])
    places = np.array([data.draw(st.integers(1, n - 2)) for _ in rows])
    wanted = slopes.all(planes)[:, rows[:, None], places[:, None] + np.arange(-1, 2)]
    assert_allclose(slopes.around(planes, rows, places), wanted, atol=1e-13 * n * n)


@given(airfoils(), st.sampled_from([51, 101, 401]))
def test_the_thickest_place_is_the_one_that_a_search_finds(xy, n):
    curves = SectionSplines(landmark_parameters(n)).fit(landmarks(xy, n)[None])
    along = curves.trailing_edge - curves.leading_edge
    along = along / np.linalg.norm(along, axis=-1, keepdims=True)
    axes = np.stack([along, along[:, ::-1] * (-1.0, 1.0)], axis=-1)
    searched = Cubics(curves.u, curves.points @ axes, curves.slopes @ axes).height
    assert_allclose(curves.thickness, searched, atol=1e-13)


@PATHS
@settings(max_examples=few(8))
@given(definitions(), st.integers(0, 2**31))
def test_sections_are_those_of_the_path_and_measured_as_if_alone(path, definition, seed):
    loft = bg.Blade.from_definition(definition, landmarks=101, path=path).shape.loft
    eta = np.random.default_rng(seed).uniform(size=9)
    as_blended = replace(loft, edge_width=None).sections(eta).curves
    assert_allclose(as_blended.points, affine.restore(*loft.at(eta)), atol=1e-13)
    joined = loft.sections(eta)
    curves = joined.curves
    alone = loft.splines.fit(np.array(curves.points))
    assert_allclose(curves.leading_edge, alone.leading_edge, atol=1e-13)
    assert_allclose(curves.thickness, alone.thickness, atol=1e-13)
    known, (A, c, lines) = curves.sizing(joined.ruling), ChordLines.sized(alone, joined.ruling)
    assert_allclose(known.A, A, atol=1e-11)
    assert_allclose(known.c, c, atol=1e-11)
    assert_allclose(ChordLines.sized(curves, joined.ruling)[2].nose, lines.nose, atol=1e-11)


def test_sizes_are_remembered_where_an_edge_that_is_opened_leaves_them(monkeypatch):
    loft = bg.Blade.from_definition(bg.read("nrel5mw")).shape.loft
    loft.sections(ETA[:1])  # edges of the stations are measured with the first
    asked, plain = [], SectionCurves._sizing
    monkeypatch.setattr(
        SectionCurves,
        "_sizing",
        lambda own, thickness: asked.append(len(own.points)) or plain(own, thickness),
    )
    joined = loft.sections(ETA)
    whole, some = asked
    assert (whole, 0 < some < whole // 2) == (len(ETA), True)
    joined.curves.normalising(joined.ruling)
    joined.curves.normalising(np.array(joined.ruling))
    assert asked == [whole, some, whole]


def test_deformed_sections_are_those_of_transport_and_geodesic(blade):
    X, M, _ = blade.shape.loft.sections(ETA).standardised
    t = np.random.default_rng(5).normal(size=(len(ETA), SPACE.dimension)) * 0.02
    change = Carried.to(SPACE, X).change(t, M)
    wanted = (grassmann.exp(X, SPACE.carried(t, X)) - X) @ M
    assert_allclose(change, wanted, atol=1e-14)
    assert not Carried.to(SPACE, X).change(0.0 * t, M).any()


def test_what_was_asked_for_before_changes_no_bit(blade):
    way = {maker: name for name, maker in PATHMAKERS.items()}[blade.path]
    fresh = bg.Blade.from_definition(blade.definition, path=way)
    t = [0.02, -0.01, 0.01, 0.0]
    for other in (ETA, ETA[::-1] ** 2, ETA):
        variant = blade.perturbed(SPACE, t, allow_odd=True, allow_extrapolation=True)
        variant.sections(other)
        blade.sections(other)
    assert_array_equal(blade.sections(ETA), fresh.sections(ETA))
    again = fresh.perturbed(SPACE, t, allow_odd=True, allow_extrapolation=True)
    assert_array_equal(variant.sections(ETA), again.sections(ETA))


@pytest.mark.parametrize("n", [51, 401])
@pytest.mark.parametrize("edge", [MinimumThickness(0.01), Sharp(), AsGiven()])
def test_some_landmarks_are_those_of_the_whole_sections(n, edge):
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=n, trailing_edge=edge)
    some = np.union1d(np.arange(0, n, 7), n - 1 - np.arange(0, n, 7))
    watched = blade.placed(blade.shape.at_landmarks(ETA, some), ETA)
    assert_allclose(watched, blade.sections(ETA)[:, some], rtol=0, atol=1e-13)


@PATHS
@pytest.mark.parametrize("edge", [MinimumThickness(0.01), Sharp(), AsGiven()])
def test_no_spans_have_no_sections(path, edge):
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), path=path, trailing_edge=edge)
    variant = blade.perturbed(SPACE, [0.01, 0.0, 0.0, 0.0], thickness=1.1)
    for one in (blade, variant):
        assert one.sections([]).shape == (0, 401, 3)
        assert one.profiles(np.zeros((0, 3)), np.linspace(0.0, 1.0, 9)).shape == (0, 3, 9, 2)
        assert one.relative_thickness([]).shape == (0,)


@given(st.integers(0, 2**31), st.floats(0.6, 1.6))
@settings(max_examples=few(8))
@example(3, 1.0)  # a stretch gives sections near 64 % another nose
def test_chord_lines_under_a_stretch_are_those_of_the_stretched_sections(seed, factor):
    t = 0.02 * np.random.default_rng(seed).normal(size=SPACE.dimension)
    baseline = bg.Blade.from_definition(bg.read("dtu10mw"))
    change = AffineChange(thickness=factor)
    shape = baseline.untested(SPACE, t, change, allow_extrapolation=True).shape
    eta = np.linspace(0.1, 0.3, 101)
    curves, thickness = shape.deformed(eta), shape.wanted_thickness(eta)
    A, c, quick = ChordLines.sized(curves, thickness)
    measured = ChordLines.of(curves.mapped(A, c))
    assert_allclose(quick.nose, measured.nose, atol=1e-12)
    assert_allclose(quick.edge, measured.edge, atol=1e-12)
    assert_array_equal(quick.alone, measured.alone)
