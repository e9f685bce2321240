"""The surface from root circle to trailing edge is smooth over span, whatever the finish."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.blade.edges import AsGiven, MinimumThickness, Sharp
from bladegen.measures.smoothness import creases

BLADES = {name: bg.Blade.from_definition(bg.read(name), path="spline") for name in bg.bundled()}
FINISHES = [AsGiven(), MinimumThickness(0.002), MinimumThickness(0.02), Sharp()]


def widths(blade, eta):
    """Edge widths [m] of finished sections."""
    sections = blade.sections(eta)
    return np.linalg.norm(sections[:, 0] - sections[:, -1], axis=-1)


@pytest.mark.parametrize("finish", FINISHES, ids=repr)
@pytest.mark.parametrize("name", bg.bundled())
def test_no_finish_makes_a_crease_at_a_station(name, finish):
    blade = BLADES[name].with_trailing_edge(finish)
    _, angle = creases(blade)
    assert np.degrees(angle.max()) < 0.02


@pytest.mark.parametrize("name", bg.bundled())
def test_the_edge_as_given_opens_from_the_root_circle_without_a_kink(name):
    blade = BLADES[name].with_trailing_edge(AsGiven())
    first = blade.eta[2]  # the first lifting airfoil
    eta = np.linspace(0.0, first, 400)
    width = widths(blade, eta) / blade.chord(eta)
    slope = np.diff(width) / np.diff(eta)
    jump = np.abs(np.diff(slope)).max()
    coarse = np.diff(width[::4]) / np.diff(eta[::4])
    assert jump < 0.4 * np.abs(np.diff(coarse)).max() + 1e-9  # C1: jumps shrink with the step
    assert np.all(np.diff(width) * np.sign(width[-1] - width[0]) > -1e-9)


@pytest.mark.parametrize("name", bg.bundled())
def test_edges_are_as_thick_as_asked_and_flatbacks_stay(name):
    eta = np.linspace(0.0, 1.0, 301)
    given = widths(BLADES[name].with_trailing_edge(AsGiven()), eta)
    for minimum in (0.002, 0.02):
        finished = widths(BLADES[name].with_trailing_edge(MinimumThickness(minimum)), eta)
        assert finished.min() > minimum - 1e-9
        thick = given > minimum + 1e-4
        assert_allclose(finished[thick], given[thick], atol=1e-9)
    assert widths(BLADES[name].with_trailing_edge(Sharp()), eta).max() < 1e-12


@pytest.mark.parametrize("finish", FINISHES, ids=repr)
def test_finishing_leaves_the_front_half_alone(finish):
    eta = np.linspace(0.0, 1.0, 41)
    blade = BLADES["iea15mw"]
    front = slice(120, 281)
    bare = blade.planform.place(blade.profiles(eta), eta)
    assert_allclose(
        blade.with_trailing_edge(finish).sections(eta)[:, front], bare[:, front], atol=1e-12
    )
