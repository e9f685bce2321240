import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.airfoils.landmarks import landmark_parameters, landmarks
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.edges import AsGiven, MinimumThickness, Sharp
from bladegen.cli.options.parsing import finish
from bladegen.errors import BladegenError, GeometryError
from strategies import airfoils, circle

U = landmark_parameters(401)


@given(airfoils(), st.floats(0.3, 6.0), st.floats(0.0, 0.01))
def test_a_minimum_thickness_is_kept_and_nothing_else_changes(xy, chord, minimum):
    profile = landmarks(xy, 401)[None]
    finished = MinimumThickness(minimum)(profile, np.array([chord]))
    gap = profile[0, 0, 1] - profile[0, -1, 1]
    new_gap = finished[0, 0, 1] - finished[0, -1, 1]
    assert_allclose(new_gap * chord, max(gap * chord, minimum), atol=1e-12)
    before, after = (SectionSplines(U).fit(p) for p in (profile, finished))
    assert_allclose(after.chord, before.chord, atol=1e-6)
    front = profile[0, :, 0] < 0.5
    assert_allclose(finished[0, front], profile[0, front], atol=0)
    if gap * chord >= minimum:
        assert_allclose(finished, profile, atol=1e-15)


def test_a_circle_stays_a_circle_to_a_micrometre():
    profile, chord = landmarks(circle(721), 401)[None], np.array([5.2])
    finished = MinimumThickness(0.002)(profile, chord)
    radius = np.linalg.norm(finished[0] - [0.5, 0.0], axis=1) * chord
    assert_allclose(radius, 2.6, atol=1e-6)


@given(airfoils())
def test_sides_do_not_cross_behind_an_opened_edge(xy):
    profile = landmarks(xy, 401)[None]
    finished = MinimumThickness(0.01)(profile, np.array([1.0]))[0]
    half = 0.5 * (finished[:80, 1] - finished[:-81:-1, 1])
    assert np.all(half >= 0.005 - 1e-12)


@given(airfoils())
def test_sharp_edges_are_closed_and_meet_only_there(xy):
    profile = landmarks(xy, 401)[None]
    finished = Sharp()(profile, np.array([1.0]))[0]
    assert_allclose(finished[0], [1.0, 0.5 * (profile[0, 0, 1] + profile[0, -1, 1])], atol=1e-12)
    assert_allclose(finished[0], finished[-1], atol=1e-15)


@given(airfoils(), st.floats(-1e-4, 1e-4), st.floats(-1e-4, 0.0))
def test_ends_beside_or_past_each_other_meet_in_a_sharp_edge(xy, behind, apart):
    profile = landmarks(xy, 401)[None].copy()
    profile[0, -1] = profile[0, 0] + [behind, -apart]
    finished = Sharp()(profile, np.array([1.0]))[0]
    assert_allclose(finished[0], profile[0, [0, -1]].mean(axis=0), atol=1e-15)
    assert_allclose(finished[0], finished[-1], atol=1e-15)
    assert_allclose(finished[1:-1], profile[0, 1:-1], atol=1e-15)


@given(airfoils(), st.floats(0.001, 0.02), st.floats(0.05, 0.9), st.floats(0.82, 0.98))
def test_a_tail_thinner_than_its_edge_is_closed_without_crossing(xy, edge, waist, at):
    profile = landmarks(xy, 401)[None].copy()
    half = np.interp(profile[0, :200, 0], [0.5, at, 1.0], [0.02, waist * edge, edge])
    behind = profile[0, :200, 0] > 0.5
    middle = 0.5 * (profile[0, :200] + profile[0, :-201:-1])
    for side, sign in ((slice(None, 200), 1.0), (slice(None, -201, -1), -1.0)):
        profile[0, side][behind] = (middle + np.stack([0 * half, sign * half], axis=-1))[behind]
    finished = Sharp()(profile, np.array([1.0]))[0]
    closed = 0.5 * (finished[:200, 1] - finished[:-201:-1, 1])
    assert_allclose(closed[0], 0.0, atol=1e-15)
    assert np.all(closed[1:][behind[1:]] > 0)
    assert_allclose(finished[~(finished[:, 0] > 0.5)], profile[0][~(profile[0, :, 0] > 0.5)])


def test_as_given_changes_nothing():
    profile = landmarks(circle(), 401)[None]
    assert AsGiven()(profile, np.array([1.0])) is profile


@pytest.mark.parametrize("edge", [MinimumThickness(0.02), Sharp(), AsGiven()])
def test_inputs_are_left_untouched(edge):
    profile = landmarks(circle(), 401)[None]
    kept = profile.copy()
    edge(profile, np.array([1.0]))
    assert_allclose(profile, kept, atol=0)


@given(airfoils(), st.floats(0.01, 6.0), st.floats(0.0, 0.01), st.floats(0.001, 0.03))
def test_a_share_of_the_chord_bounds_what_is_added(xy, chord, minimum, most):
    profile = landmarks(xy, 401)[None]
    rule = MinimumThickness(minimum, most)
    finished = rule(profile, np.array([chord]))
    gap = profile[0, 0, 1] - profile[0, -1, 1]
    new_gap = finished[0, 0, 1] - finished[0, -1, 1]
    assert_allclose(new_gap, max(gap, min(minimum / chord, most)), atol=1e-12)
    assert rule.width(np.array([chord]))[0] <= most


def test_an_edge_is_not_thicker_than_its_section():
    profile = landmarks(circle(721), 401)[None] * [1.0, 0.2]
    for thickness in (0.019, 0.199):
        MinimumThickness(thickness)(profile, np.ones(1))
    with pytest.raises(GeometryError, match=r"got 201mm, more than the thickness of 200 mm of the"):
        MinimumThickness(0.201)(profile, np.ones(1))
    with pytest.raises(GeometryError, match=r"whose chord is 0\.05 m; .* --trailing-edge 2mm,1%"):
        MinimumThickness(0.02)(np.repeat(profile, 2, axis=0), np.array([1.0, 0.05]))


@pytest.mark.parametrize("text", ["given", "sharp", "2mm,1%", "5mm", "0.3mm,2.5%"])
def test_rules_are_written_as_they_are_read(text):
    assert str(finish(text)) == text


@pytest.mark.parametrize("text", ["2", "2mm,1", "2mm,0%", "2mm,101%", "blunt", "2mm,x%", ","])
def test_other_words_for_edges_are_refused(text):
    with pytest.raises(BladegenError, match="trailing-edge: got"):
        finish(text)
