import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.interpolate import Akima1DInterpolator

import bladegen as bg
from bladegen.airfoils.landmarks import landmarks
from bladegen.blade.lofting.geodesics import GeodesicPath, SectionSpline
from bladegen.blade.lofting.parameters import Parameter
from bladegen.blade.lofting.paths import geodesic_path, spline_path
from bladegen.blade.lofting.splines import NOISE, SplinePath
from bladegen.blade.lofting.velocities import EASED, SLOW, Paces, blended, three_point
from bladegen.definition.blade_definition import Distribution
from bladegen.shapes import affine, grassmann
from strategies import SEEDS, circle, maps, naca, random_points, random_tangent

KNOTS = np.array([0.0, 0.2, 0.5, 0.6, 1.0])
SHAPES = np.stack(
    [landmarks(xy, 101) for xy in (circle(), circle(), naca(0.4, 0, 0.01), naca(0.2, 0.03, 0.003))]
    + [landmarks(naca(0.2, 0.03, 0.003), 101)]
)
X, M, b = affine.standardise(SHAPES)
SPAN = Parameter(KNOTS)
MAKERS = pytest.mark.parametrize("maker", [geodesic_path, spline_path])


@MAKERS
def test_paths_pass_through_their_stations(maker):
    path, maps_ = maker(SPAN, X, M)
    assert_allclose(path(KNOTS) @ maps_, X @ M, atol=1e-12)


@MAKERS
def test_paths_stay_on_the_manifold(maker):
    points = maker(SPAN, X, M)[0](np.linspace(0, 1, 57))
    assert_allclose(points.mT @ points, np.broadcast_to(np.eye(2), (57, 2, 2)), atol=1e-12)


@MAKERS
def test_identical_neighbours_are_constant(maker):
    path, _ = maker(SPAN, X, M)
    for first, last in ((0.0, 0.2), (0.6, 1.0)):
        between = path(np.linspace(first, last, 11))
        assert_allclose(between, np.broadcast_to(between[:1], between.shape), atol=1e-13)


@MAKERS
def test_a_batch_equals_its_parts(maker):
    path, _ = maker(SPAN, X, M)
    q = np.linspace(0, 1, 23)
    assert_allclose(path(q), np.concatenate([path(q[i : i + 1]) for i in range(23)]), atol=1e-13)


@MAKERS
@given(seed=SEEDS)
def test_paths_do_not_depend_on_representatives(maker, seed):
    turns = np.linalg.qr(np.random.default_rng(seed).normal(size=(5, 2, 2))).Q
    turns *= np.sign(np.linalg.det(turns))[:, None, None] * [[1.0, 1.0], [1.0, 1.0]]
    turns[:, :, 0] *= np.sign(np.linalg.det(turns))[:, None]
    q = np.linspace(0, 1, 9)
    plain, turned = maker(SPAN, X, M)[0](q), maker(SPAN, X @ turns, turns.mT @ M)[0](q)
    assert_allclose(plain @ plain.mT, turned @ turned.mT, atol=1e-9)


@given(SEEDS)
def test_between_two_stations_the_path_is_the_geodesic(seed):
    rng = np.random.default_rng(seed)
    start = random_points(rng, 1, 12)[0]
    end = grassmann.exp(start, random_tangent(rng, start, 0.8))
    path = GeodesicPath(np.array([0.0, 2.0]), np.stack([start, grassmann.align(start, end)]))
    middle = path(np.array([1.0]))[0]
    wanted = grassmann.exp(start, 0.5 * grassmann.log(start, end))
    assert_allclose(middle, wanted, atol=1e-12)
    assert_allclose(path.distances[-1], grassmann.distance(start, end), atol=1e-12)


def test_speed_along_the_geodesic_path_is_continuous():
    path, _ = geodesic_path(SPAN, X, M)
    h = 1e-6
    for knot in KNOTS[1:-1]:
        before, at, after = path(knot + np.array([-h, 0.0, h]))
        speeds = grassmann.distance(before, at) / h, grassmann.distance(at, after) / h
        assert speeds[0] == pytest.approx(speeds[1], abs=1e-4)


def test_the_spline_path_has_no_kink():
    path, _ = spline_path(SPAN, X, M)
    h = 1e-6
    for knot in KNOTS[1:-1]:
        before, at, after = path(knot + np.array([-h, 0.0, h]))
        assert_allclose((at - before) / h, (after - at) / h, atol=1e-3)


def test_a_spline_path_of_two_stations_is_the_geodesic():
    path, _ = spline_path(Parameter(np.array([0.0, 1.0])), X[1:3], M[1:3])
    geodesic, _ = geodesic_path(Parameter(np.array([0.0, 1.0])), X[1:3], M[1:3])
    q = np.linspace(0, 1, 7)
    assert np.max(grassmann.distance(path(q), geodesic(q))) < 1e-10


@given(st.lists(maps(), min_size=3, max_size=3), SEEDS)
def test_section_splines_pass_through_and_never_become_singular(M, seed):
    M = np.stack(M)
    M = np.stack([M[0], M[0] @ affine.twist(np.array(0.4)), M[2]])
    knots, b = np.array([0.0, 0.3, 1.0]), np.random.default_rng(seed).normal(size=(3, 2))
    spline = SectionSpline(knots, M, b)
    at, shift = spline(knots)
    assert_allclose(at, M, atol=1e-10)
    assert_allclose(shift, b, atol=1e-12)
    for first, last in ((0, 1), (1, 2)):
        between = spline(np.linspace(knots[first], knots[last], 31))[0]
        assert np.linalg.det(between).min() > 0
        log_stretch, ends = affine.polar(between)[1], affine.polar(M[[first, last]])[1]
        assert np.all(log_stretch >= ends.min(axis=0) - 1e-9)
        assert np.all(log_stretch <= ends.max(axis=0) + 1e-9)


def test_without_thickness_the_parameter_is_span():
    parameter = Parameter(KNOTS)
    q = np.linspace(0, 1, 11)
    assert_allclose(parameter(q), q, atol=1e-15)
    assert_allclose(parameter.knots, KNOTS, atol=1e-15)


def test_with_thickness_shape_follows_it():
    thickness = Distribution(np.array([0.0, 0.2, 0.5, 1.0]), np.array([1.0, 1.0, 0.4, 0.2]))
    parameter = Parameter(np.array([0.0, 0.2, 0.6, 1.0]), thickness)
    assert np.all(np.diff(parameter.knots) > 0)
    assert_allclose(parameter(parameter.stations), parameter.knots, atol=1e-15)
    eta = np.linspace(0.2, 1.0, 41)
    assert_allclose(np.diff(parameter(eta)), -np.diff(thickness(eta)), atol=1e-14)


def test_ripples_of_the_thickness_do_no_harm():
    grid = np.linspace(0, 1, 41)
    values = np.maximum(1.0 - 2.0 * grid, 0.241) + 1e-5 * (-1.0) ** np.arange(41)
    parameter = Parameter(np.array([0.1, 0.3, 0.7, 1.0]), Distribution(grid, values))
    q = parameter(np.linspace(0, 1, 2001))
    assert np.all(np.isfinite(q))
    assert q.min() == parameter.knots[0]
    assert q.max() == parameter.knots[-1]
    assert np.min(np.diff(q)) > -1e-4


@given(st.integers(2, 9), SEEDS)
def test_velocities_along_a_line_are_akimas_with_squared_weights(count, seed):
    rng = np.random.default_rng(seed)
    apart = rng.uniform(0.1, 1.0, count)
    rates = rng.uniform(-1.0, 1.0, count)
    direction = np.array([[0.6], [0.8]])
    V = rates[:, None, None] * direction
    found = np.sum(blended(V, V, V[:-1], V[1:], np.ones(count + 1)) * direction, axis=(1, 2))
    for k in range(2, count - 1):
        bends = (rates[k - 1] - rates[k - 2]) ** 2, (rates[k + 1] - rates[k]) ** 2
        wanted = (bends[1] * rates[k - 1] + bends[0] * rates[k]) / sum(bends)
        assert found[k] == pytest.approx(wanted, abs=1e-12)
    knots = np.append(0.0, np.cumsum(apart))
    values = np.append(0.0, np.cumsum(rates * apart))
    akima = Akima1DInterpolator(knots, values)(knots, 1)
    if count > 1:  # beyond the ends both go on in the same way
        for k in (0, -1):
            assert found[k] == pytest.approx(akima[k], abs=1e-9)


def test_where_nothing_moves_velocities_are_zero():
    still = np.zeros((3, 5, 2))
    assert_allclose(blended(still, still, still[:-1], still[1:], np.ones(4)), 0.0, atol=0)


@given(st.integers(3, 9), SEEDS)
def test_three_point_slopes_are_those_of_parabolas(count, seed):
    rng = np.random.default_rng(seed)
    knots = np.cumsum(rng.uniform(0.1, 1.0, count))
    c = rng.normal(size=3)
    slopes = three_point(np.diff(knots), np.polyval(c, knots)[:, None], np.ones(count))
    assert_allclose(slopes[:, 0], np.polyval(np.polyder(c), knots), atol=1e-9)


@given(st.lists(maps(), min_size=4, max_size=4), SEEDS)
def test_maps_of_the_spline_path_never_become_singular(M, seed):
    rng = np.random.default_rng(seed)
    parameter = Parameter(np.concatenate([[0.0], np.cumsum(rng.uniform(1e-3, 1.0, 3))]))
    path, maps_ = spline_path(parameter, X[1:], np.stack(M))
    spline = path.maps(maps_, rng.normal(size=(4, 2)))
    assert_allclose(spline(parameter.knots)[0], maps_, atol=1e-10)
    q = np.linspace(parameter.knots[0], parameter.knots[-1], 301)
    assert np.linalg.det(spline(q)[0]).min() > 0


@pytest.mark.parametrize(
    "thickness", [(1.0, 1.0, 0.5, 0.3, 0.3), (1.0, 0.98, 0.5, 0.35, 0.2), (0.9, 1.0, 0.4, 0.4, 0.6)]
)
def test_over_span_sections_of_the_spline_path_have_no_corner(thickness):
    grid = np.array([0.0, 0.02, 0.3, 0.5, 0.6, 1.0])  # not the stations': it moves at each of them
    values = np.interp(grid, (0.0, 0.02, 0.3, 0.55, 1.0), thickness)
    parameter = Parameter(np.array([0.0, 0.02, 0.3, 0.55, 1.0]), Distribution(grid, values))
    path, maps_ = spline_path(parameter, X, M)
    spline, h = path.maps(maps_, b), 1e-7

    def sections(eta):
        q = parameter(eta)
        return affine.restore(path(q), *spline(q))

    for station in parameter.stations[1:-1]:
        beside = sections(station + h * np.array([-2.0, -1.0, 0.0, 1.0, 2.0]))
        steps = np.diff(beside, axis=0) / h
        assert np.abs(steps[2] - steps[1]).max() < 5 * SLOW + 1e-3


def test_beside_equally_thick_stations_the_path_slows_down_and_does_not_stop_before():
    speeds = np.array([[1.0, 1.0, 1.0, 1.0], [1.0, 1.0, 0.5, 1.0]])
    paces = Paces(np.array([0.0, 1.0, 2.0, 3.0]), speeds, np.array([True, False, False]))
    assert_allclose(paces.pace, [1.0, 1.0, 0.5, 1.0])
    q = np.linspace(1.0, 2.0, 401)[:-1]
    _, fraction = paces(q)
    assert np.all(np.diff(fraction) > 0)
    free = q >= 1.0 + EASED
    assert_allclose(fraction[free], q[free] - 1.0, atol=1e-14)
    assert (fraction[1] - fraction[0]) / (q[1] - q[0]) < 0.05


@given(st.integers(0, 3), SEEDS)
def test_velocities_do_not_depend_on_how_fast_the_parameter_runs(station, seed):
    rng = np.random.default_rng(seed)
    factor, values = rng.uniform(0.2, 5.0), np.cumsum(rng.normal(size=(5, 1)), axis=0)
    apart, stretch = rng.uniform(0.1, 1.0, 4), np.ones(4)
    stretch[station:] = factor  # the parameter runs faster from a station on
    pace = np.ones(5)
    pace[station] = factor if station else 1.0
    before = np.insert(stretch, 0, stretch[0])
    plain = three_point(apart, values, np.ones(5))
    assert_allclose(three_point(apart * stretch, values, pace) * before[:, None], plain, atol=1e-9)
    V = np.diff(values, axis=0)[:, None] / apart[:, None, None]
    fast = V / stretch[:, None, None]
    found = blended(fast, fast, fast[:-1], fast[1:], pace)
    wanted = blended(V, V, V[:-1], V[1:], np.ones(5))
    assert_allclose(found * before[:, None, None], wanted, atol=1e-9)


@given(SEEDS)
def test_neighbours_that_differ_by_noise_are_one_shape(seed):
    rng = np.random.default_rng(seed)
    near = grassmann.exp(X[2], 0.5 * NOISE * random_tangent(rng, X[2], 1.0))
    path = SplinePath(KNOTS, np.stack([X[1], X[2], near, X[3], X[1]]))
    between = path(np.linspace(KNOTS[1], KNOTS[2], 21))
    assert grassmann.distance(between, between[:1]).max() < NOISE


@given(SEEDS)
def test_a_geodesic_through_the_stations_is_kept(seed):
    rng = np.random.default_rng(seed)
    start = random_points(rng, 1, 12)[0]
    along = random_tangent(rng, start, 1.0)
    at = np.array([0.0, 0.1, 0.4, 0.6, 1.0])
    points = grassmann.exp(start[None], at[:, None, None] * along)
    q = np.linspace(0.0, 1.0, 23)
    wanted = grassmann.exp(start[None], q[:, None, None] * along)
    assert grassmann.distance(SplinePath(at, points)(q), wanted).max() < 1e-7


def test_the_spline_path_is_the_same_from_tip_to_root():
    knots = np.cumsum([0.0, 0.2, 0.3, 0.1, 0.4])
    chained = affine.cluster(X, M)[0]
    forth = SplinePath(knots, chained)
    back = SplinePath(1.0 - knots[::-1], chained[::-1])
    q = np.linspace(0.0, 1.0, 31)
    assert grassmann.distance(forth(q), back(1.0 - q)).max() < 1e-7


@MAKERS
def test_paths_hold_their_ends_beyond_the_stations(maker):
    path, _ = maker(Parameter(KNOTS + 1.0), X, M)
    first, last = path(KNOTS[[0, -1]] + 1.0)
    assert np.all(np.isfinite(path(np.array([1.0 + 1e-9, 2.0 - 1e-9]))))
    assert_allclose(path(np.array([1.0]))[0], first, atol=0)
    assert_allclose(path(np.array([2.0]))[0], last, atol=0)


@MAKERS
@pytest.mark.parametrize("k", range(4))
def test_paths_run_from_each_station_to_the_next(maker, k):
    path, _ = maker(SPAN, X, M)
    start, end = path(KNOTS[[k, k + 1]])
    whole = grassmann.distance(start, end)
    between = path(np.linspace(KNOTS[k], KNOTS[k + 1], 9))
    assert np.all(grassmann.distance(between, start[None]) <= whole + 1e-3)
    assert_allclose(between[0], start, atol=1e-14)
    assert_allclose(between[-1], end, atol=1e-14)


def test_mirrored_representatives_do_not_mirror_the_spline_path():
    path, maps_ = spline_path(SPAN, X, M)
    assert np.all(np.linalg.det(maps_) * np.linalg.det(M) > 0)
    for k in (0, -1):
        assert np.linalg.det(path(KNOTS)[k].T @ X[k]) > 0


def test_the_parameter_holds_its_ends_beyond_the_stations():
    thickness = Distribution(np.array([0.0, 0.5, 1.0]), np.array([1.0, 0.4, 0.2]))
    for ruling in (None, thickness):
        parameter = Parameter(np.array([0.1, 0.5, 0.9]), ruling)
        q = parameter(np.array([0.0, 0.05, 0.1, 0.9, 0.95, 1.0]))
        assert_allclose(q[:3], parameter.knots[0], atol=0)
        assert_allclose(q[3:], parameter.knots[-1], atol=0)


def test_the_parameter_stays_between_its_stations_where_thickness_overshoots():
    grid = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    thickness = Distribution(grid, np.array([0.6, 0.7, 0.2, 0.1, 0.3]))
    parameter = Parameter(np.array([0.0, 0.5, 1.0]), thickness)
    eta = np.linspace(0, 1, 201)
    q = parameter(eta)
    low, middle, high = parameter.knots
    assert np.all((q[eta <= 0.5] >= low) & (q[eta <= 0.5] <= middle))
    assert np.all((q[eta >= 0.5] >= middle) & (q[eta >= 0.5] <= high))
    assert q[50] == low  # thicker than both ends: at the thick one
    assert q[150] == middle  # thinner than the middle, which is the thin end here


def test_segments_of_equal_thickness_follow_the_span():
    thickness = Distribution(np.array([0.0, 0.5, 0.6, 1.0]), np.array([0.4, 0.4, 0.4, 0.2]))
    parameter = Parameter(np.array([0.0, 0.5, 1.0]), thickness)
    assert_allclose(parameter.knots, [0.0, 0.5, 0.7], atol=1e-15)
    eta = np.linspace(0.0, 0.5, 11)
    assert_allclose(parameter(eta), eta, atol=1e-15)


@pytest.mark.parametrize("name", bg.bundled())
def test_the_spline_predicts_left_out_stations_better_than_the_geodesics_and_any_blend(
    name, monkeypatch
):
    """docs/guide.md: the lowest median of the four, in relative thickness."""
    monkeypatch.syspath_prepend(str(Path(__file__).parents[1] / "benchmarks"))
    from paths import missed

    medians = {
        way: np.median(off)
        for way, off in missed(bg.Blade.from_definition(bg.read(name)), True).items()
    }
    assert min(medians, key=medians.get) == "spline"
    sys.modules.pop("paths"), sys.modules.pop("figures")
