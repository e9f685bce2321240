import numpy as np
from hypothesis import given

from bladegen.airfoils.landmarks import landmarks
from bladegen.curves.crossing import crossing_sections, first_crossing
from strategies import airfoils, circle


@given(airfoils())
def test_airfoils_do_not_cross_themselves(xy):
    assert first_crossing(np.asarray(xy)) is None


@given(airfoils())
def test_a_tail_bent_over_is_found(xy):
    crossed = np.array(xy)
    crossed[-1] = [0.5, 2.0 * np.sign(xy[1, 1] - xy[-2, 1])]
    found = first_crossing(crossed)
    assert found is not None
    assert max(found) == len(xy) - 2


def test_lines_that_touch_do_not_cross():
    assert first_crossing(np.array([[0, 0], [1, 0], [1, 1], [0.5, 0.0], [0.0, 1.0]])) is None


def test_a_bow_tie_crosses():
    assert first_crossing(np.array([[0.0, 0], [1, 1], [1, 0], [0, 1]])) == (0, 2)


def test_long_contours_are_tested_in_parts():
    points = circle(1501)[:-1]
    assert first_crossing(points) is None
    points[700] = [1.5, 0.3]
    assert first_crossing(points) is not None


@given(airfoils())
def test_crossing_sections_are_named(xy):
    sound = landmarks(xy, 101)
    swapped = sound.copy()
    swapped[10:20, 1], swapped[-20:-10, 1] = sound[-20:-10, 1][::-1], sound[10:20, 1][::-1]
    folded = sound.copy()
    folded[30:34] = folded[33:29:-1]
    named = crossing_sections(np.stack([sound, swapped, sound, folded]))
    assert 0 not in named
    assert 2 not in named
    assert 1 in named
