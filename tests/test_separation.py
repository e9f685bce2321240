import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from bladegen.airfoils.landmarks import landmarks
from bladegen.curves.separation import graphs, ladders, once_back_and_forth
from strategies import airfoils, circle


def crosses(points):
    """Brute force: every segment against every other, the closing one included."""
    loop = np.concatenate([points, points[:1]])
    a, b = loop[:-1, None], loop[1:, None]
    c, d = loop[None, :-1], loop[None, 1:]

    def side(p, q, r):
        along, to = q - p, r - p
        twice = along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0]
        return np.where(np.abs(twice) <= 1e-14, 0.0, twice)  # closed edges meet to rounding

    return bool(np.any((side(a, b, c) * side(a, b, d) < 0) & (side(c, d, a) * side(c, d, b) < 0)))


@given(airfoils(), st.integers(0, 2**32 - 1), st.floats(0, 0.1))
def test_what_is_proved_is_so(xy, seed, size):
    rng = np.random.default_rng(seed)
    bumps = rng.normal(size=(12, 4, 2)) * size
    u = np.linspace(0, 1, 101)
    waves = np.stack([np.sin((k + 1) * np.pi * u) for k in range(4)], axis=-1)
    contours = landmarks(xy, 101) + waves @ bumps
    sound, crossing = graphs(contours)
    for points, *proofs in zip(contours, ladders(contours), sound, crossing, strict=True):
        crossed = crosses(points)
        assert not (proofs[0] and crossed)
        assert not (proofs[1] and crossed)
        assert not proofs[2] or crossed


@given(airfoils())
def test_airfoils_are_proved_sound_by_graphs(xy):
    points = landmarks(xy, 101)
    closed = abs(points[0, 1] - points[-1, 1]) < 1e-6  # a cusp may be left to the exact test
    assert graphs(points[None])[0][0] or closed


def test_turning_does_not_matter_to_graphs():
    t = np.linspace(0, 2 * np.pi, 101)[:-1]
    thin = np.stack([0.5 * np.cos(t), 0.05 * np.sin(t)], axis=-1)
    turned = np.stack(
        [thin @ np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]]) for a in range(7)]
    )
    assert graphs(turned)[0].all()


def test_a_figure_of_eight_is_not_proved_sound():
    t = np.linspace(0, 2 * np.pi, 100)
    eight = np.stack([np.cos(t), np.sin(2 * t)], axis=-1)[None]
    assert not ladders(eight)[0]
    assert not graphs(eight)[0][0]


@pytest.mark.parametrize(
    ("x", "once"),
    [([1, 0, 0.5], True), ([1, 0, 0.6, 0.4], False), ([0, 1, 0.5, 0.2], True), ([1, 0, 1], True)],
)
def test_going_back_and_forth_is_counted_around_the_loop(x, once):
    assert_array_equal(once_back_and_forth(np.array([x])), [once])


def test_no_contours_are_no_trouble():
    assert graphs(np.zeros((0, 11, 2)))[0].shape == (0,)


def test_a_circle_is_proved_at_once():
    assert ladders(circle(101)[None])[0]
