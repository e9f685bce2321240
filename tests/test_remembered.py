"""A surface in the making asks a blade once for each of its sections."""

from collections import Counter

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal

import bladegen as bg
from bladegen.airfoils.slopes import SplineSlopes
from bladegen.blade.blade import Blade
from bladegen.blade.remembered import Remembered
from bladegen.surface import fitting

BLADE = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)
U = BLADE.u[::2]


class Counted:
    """A blade that keeps what it was asked for."""

    u, sides = BLADE.u, BLADE.sides

    def __init__(self):
        self.asked = []

    def sections(self, eta, u=None):
        self.asked.append((eta.tolist(), u is None))
        return BLADE.sections(eta, u)


def test_sections_are_made_once():
    counted = Counted()
    known = Remembered(counted)
    first = known.sections(np.array([0.5, 0.2, 0.5]), U)
    assert_array_equal(first, BLADE.sections([0.5, 0.2], U)[[0, 1, 0]])
    again = known.sections(np.array([0.2, 0.3, 0.5]), U)
    assert_array_equal(again[[0, 2]], first[[1, 0]])
    assert_array_equal(again[1], BLADE.sections([0.3], U)[0])
    assert_array_equal(known.sections(np.array([0.2])), BLADE.sections([0.2]))
    assert counted.asked == [([0.5, 0.2], False), ([0.3], False), ([0.2], True)]


def test_a_fit_makes_no_section_twice_and_the_same_net(monkeypatch):
    asked, plain = Counter(), Blade.sections

    def sections(blade, eta, u=None):
        asked.update((span, u.tobytes()) for span in np.ravel(eta) if u is not None)
        return plain(blade, eta, u)

    spans = np.array([0.0, 1.0])
    monkeypatch.setattr(Blade, "sections", sections)
    net, deviation = fitting.fitted(BLADE, 1e-3, spans=spans)
    once = len(asked), sum(asked.values())
    asked.clear()
    monkeypatch.setattr(fitting, "Remembered", lambda blade: blade)
    other, again = fitting.fitted(BLADE, 1e-3, spans=spans)
    assert once[0] == len(asked)
    assert once[1] < 0.7 * sum(asked.values())
    assert_array_equal(net.v_knots, other.v_knots)
    assert_allclose(net.poles, other.poles, rtol=0.0, atol=1e-9)
    assert abs(deviation.maximum - again.maximum) < 1e-9


def test_matrices_to_places_that_are_asked_for_again_are_kept():
    slopes = SplineSlopes.at(BLADE.u)
    assert slopes.values(U) is slopes.values(U.copy())
    assert slopes.values(U, 1) is not slopes.values(U)
    assert_allclose(slopes.values(BLADE.u), np.eye(len(BLADE.u)), atol=1e-12)
    assert_array_equal(slopes.values(BLADE.u, 1), slopes.matrix)
