"""Distributions of coordinates: their densities, what they hold, and what shapes they give."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial import ConvexHull

import bladegen as bg
from bladegen.airfoils.landmarks import uniform
from bladegen.blade.variants.designs import DISTRIBUTED, Design
from bladegen.blade.variants.factors import factors
from bladegen.curves.crossing import crossing_sections
from bladegen.errors import DesignError, MissingLibraryError, SpaceError
from bladegen.formats.baselines import baselines
from bladegen.shapes.cst import fit, shapes
from bladegen.shapes.database import build_space
from bladegen.shapes.shape_space import FILES
from bladegen.shapes.statistics.distributions import KINDS
from bladegen.shapes.statistics.ellipsoids import smallest

UNIFORM = ("box", "ellipsoid", "hull")


@cache
def space(name="paper"):
    return bg.ShapeSpace.bundled(name)


@cache
def distribution(kind, name="paper", sound=False):
    return space(name).distribution(kind, sound=sound)


@pytest.mark.parametrize("kind", KINDS)
def test_what_a_distribution_draws_it_contains(kind):
    made = distribution(kind)
    drawn = made.sample(2000, np.random.default_rng(3))
    assert drawn.shape == (2000, 4)
    assert np.isfinite(made.log_prob(drawn)).all()
    inside = made.contains(drawn)
    assert inside.all() if kind in UNIFORM else inside.mean() > 0.98
    assert made.contains(space().coordinates).all()
    assert_array_equal(drawn, made.sample(2000, np.random.default_rng(3)))
    assert made.sample(0, np.random.default_rng(3)).shape == (0, 4)


@pytest.mark.parametrize("kind", KINDS)
def test_densities_integrate_to_one(kind):
    made, box = distribution(kind), distribution("box")
    wide = 1.6 * (box.density.high - box.density.low)
    middle = 0.5 * (box.density.high + box.density.low)
    points = middle + wide * (np.random.default_rng(5).random((40_000, 4)) - 0.5)
    assert_allclose(np.exp(made.log_prob(points)).mean() * wide.prod(), 1.0, atol=0.12)


@pytest.mark.parametrize("kind", KINDS)
@given(st.integers(0, 2**31), st.sampled_from([(), (3,), (2, 2)]))
def test_batches_are_their_parts(kind, seed, lead):
    t = np.random.default_rng(seed).normal(scale=0.08, size=(*lead, 4))
    made = distribution(kind)
    flat = t.reshape(-1, 4)
    each = [made.log_prob(one) for one in flat]
    assert_allclose(made.log_prob(t), np.reshape(each, lead), atol=1e-9)
    assert_array_equal(made.contains(t), np.reshape([made.contains(one) for one in flat], lead))
    assert made.log_prob(t).shape == lead


@pytest.mark.parametrize("kind", ["gaussian", "mixture"])
def test_normal_draws_have_the_datas_mean_and_covariance(kind):
    drawn = distribution(kind).sample(20_000, np.random.default_rng(1))
    spread = np.sqrt(np.diag(np.cov(space().coordinates.T)))
    assert_allclose(
        drawn.mean(axis=0) / spread, space().coordinates.mean(axis=0) / spread, atol=0.1
    )
    found, wanted = (
        np.cov(one.T) / np.outer(spread, spread) for one in (drawn, space().coordinates)
    )
    assert_allclose(found, wanted, atol=0.12)


def test_gaussians_are_scipys():
    from scipy.stats import multivariate_normal

    data = space().coordinates
    theirs = multivariate_normal(data.mean(axis=0), np.cov(data.T, bias=True))
    assert_allclose(distribution("gaussian").log_prob(data[:9]), theirs.logpdf(data[:9]), rtol=1e-9)


def test_mixtures_have_the_datas_likelihood():
    """They follow the data better than one normal distribution, and far better than a box."""
    means = {kind: distribution(kind).log_prob(space().coordinates).mean() for kind in KINDS}
    assert means["mixture"] > means["gaussian"] + 0.3
    assert means["gaussian"] > means["box"]


def test_a_hulls_volume_is_scipys():
    volume = ConvexHull(space().coordinates).volume
    assert_allclose(np.exp(-distribution("hull").log_prob(np.zeros(4))), volume, rtol=1e-6)
    fourths = distribution("hull").sample(4000, np.random.default_rng(2))
    box = distribution("box")
    by_box = box.sample(16_000, np.random.default_rng(2))
    within = by_box[distribution("hull").contains(by_box)]
    assert_allclose(fourths.mean(axis=0), within.mean(axis=0), atol=3e-3)
    assert_allclose(np.cov(fourths.T), np.cov(within.T), atol=2e-4)


@given(st.integers(0, 10**6), st.integers(1, 5), st.integers(8, 60))
def test_the_smallest_ellipsoid_holds_all_and_touches_enough(seed, r, count):
    """A necessary condition of the least volume: weighted normals at points of contact balance."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(count, r)) @ rng.normal(size=(r, r)) + rng.normal(size=r)
    centre, A = smallest(points)
    size = np.linalg.norm((points - centre) @ A.T, axis=1)
    assert size.max() <= 1 + 1e-12
    touching = np.count_nonzero(size > 1 - 1e-3)
    assert touching >= min(r + 1, 2)
    shift = rng.normal(size=r)
    again, B = smallest(points * 3.0 + shift)  # affine maps carry it along
    assert_allclose(again, centre * 3.0 + shift, atol=1e-4 * np.abs(points).max())
    assert_allclose(np.linalg.det(B) * 3.0**r, np.linalg.det(A), rtol=1e-3)


def test_smallest_ellipsoids_of_known_shapes():
    cube = np.array(np.meshgrid(*[[-1.0, 1.0]] * 3)).reshape(3, -1).T
    centre, A = smallest(cube * [1.0, 2.0, 3.0] + 5.0)
    assert_allclose(centre, [5.0] * 3, atol=1e-5)
    assert_allclose(A.T @ A, np.diag([1.0, 1 / 4, 1 / 9]) / 3.0, atol=1e-5)
    simplex = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    centre, A = smallest(simplex)
    assert_allclose(centre, [1 / 3, 1 / 3], atol=1e-5)
    assert_allclose(np.linalg.norm((simplex - centre) @ A.T, axis=1), 1.0, atol=1e-5)
    with pytest.raises(SpaceError, match="do not span 2 dimensions"):
        smallest(np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]))


@pytest.mark.parametrize("kind", KINDS)
def test_only_sound_shapes_are_drawn_where_only_such_are_asked_for(kind):
    made = distribution(kind, sound=True)
    t = made.sample(120, np.random.default_rng(4))
    assert len(t) == 120
    assert not crossing_sections(space().decode(t))
    assert made.contains(t).all() or kind not in UNIFORM
    plain = distribution(kind)
    drawn = plain.sample(300, np.random.default_rng(4))
    crossing = np.zeros(300, dtype=bool)
    crossing[crossing_sections(space().decode(drawn))] = True
    assert_array_equal(np.isneginf(made.log_prob(drawn)), crossing)
    assert abs(made.share - (1 - crossing.mean())) < 0.08
    kept = drawn[~crossing]
    assert_allclose(made.log_prob(kept), plain.log_prob(kept) - np.log(made.share))


@pytest.mark.parametrize("kind", KINDS)
def test_the_sound_space_gives_sound_shapes_wherever_its_data_lie(kind):
    """The paper says so of its own space: a constant edge and even landmarks make it true."""
    made = distribution(kind, "sound")
    t = made.sample(2000, np.random.default_rng(6))
    share = space("sound").sound(t).mean()
    assert share == 1.0 if kind in UNIFORM else share > 0.995
    assert distribution(kind, "paper").sample(1, np.random.default_rng(0)).shape == (1, 4)


def test_all_data_of_the_sound_space_are_sound():
    made = space("sound")
    assert made.sound(made.coordinates[::4]).all()
    low, high = made.lower, made.upper
    rng = np.random.default_rng(7)
    start = np.where(rng.uniform(size=(100, 4)) < 0.5, low, high)
    sweeps = start[:, None] + np.linspace(0, 1, 11)[:, None] * (low + high - 2 * start)[:, None]
    assert made.sound(sweeps).mean() > 0.97
    assert space("paper").sound(sweeps).shape == (100, 11)


@pytest.mark.nightly
def test_the_sound_space_can_be_built_again():
    made, _ = build_space(baselines(), seed=2022, edge=0.01, spacing=uniform, sound=True)
    assert_allclose(made.coordinates, space("sound").coordinates, atol=1e-7)
    assert made.about == space("sound").about


def test_spaces_are_built_without_shapes_that_cross():
    few = dict(list(baselines().items())[:4])
    made, _ = build_space(few, seed=1, count=60, modes=2, n=101, sound=True)
    assert "that cross themselves" in made.about
    plain, _ = build_space(few, seed=1, count=60, modes=2, n=101)
    assert len(made.coordinates) < len(plain.coordinates) == 240


def test_open_edges_are_a_wedge_on_both_sides():
    few = np.stack([fit(bg.Blade.from_definition(bg.read("dtu10mw")).profiles([0.9])[0])[0]] * 2)
    u = np.linspace(0.0, 1.0, 101)
    opened, sharp = shapes(few, u, edge=0.02), shapes(few, u)
    assert_allclose(opened[:, 0] - opened[:, -1], [[0.0, 0.02]] * 2, atol=1e-12)
    assert_allclose(opened[:, 50], sharp[:, 50], atol=2e-3)
    for side, sign in ((slice(0, 50), 1), (slice(51, None), -1)):
        x, y = opened[0, side].T
        order = np.argsort(sharp[0, side][:, 0])
        there = np.interp(x, sharp[0, side][order, 0], sharp[0, side][order, 1])
        assert_allclose(y - there, sign * 0.01 * x, atol=2e-3)


@pytest.mark.parametrize("kind", DISTRIBUTED)
def test_designs_follow_distributions(kind):
    what = factors(space(), {"thickness": (0.9, 1.1)}, reach=0.5)
    design = Design.of(what, kind, 500, 7, space())
    values = design.values
    inside = space().distribution(DISTRIBUTED[kind][0]).contains(values[:, :4] / 0.5)
    assert inside.mean() > 0.98
    assert_allclose(values[:, 4].mean(), 1.0, atol=0.02)
    assert_array_equal(design.at(np.array([7, 3])), values[[7, 3]])
    assert not np.array_equal(design.redrawn(np.array([7]), 1)[0], values[7])
    assert_array_equal(Design.of(what, kind, 9, 7, space()).values, values[:9])
    held = factors(space(), {"t2": (0.01, 0.01)})
    assert_allclose(Design.of(held, kind, 5, 7, space()).values[:, 1], 0.01)
    with pytest.raises(DesignError, match="follows the data of a shape space"):
        Design.of(what, kind, 5, 7)


def test_what_cannot_be_is_refused(monkeypatch):
    with pytest.raises(SpaceError, match="allowed are box, ellipsoid, gaussian, mixture, hull"):
        space().distribution("cube")
    with pytest.raises(SpaceError, match="count: got -1"):
        distribution("box").sample(-1, np.random.default_rng(0))
    with pytest.raises(SpaceError, match=r"rng: got -7, must be .* or a seed"):
        distribution("box").sample(1, -7)
    with pytest.raises(SpaceError, match=r"t: got the shape \(3,\), must be \(\.\.\., 4\)"):
        distribution("box").contains([0.0, 0.0, 0.0])
    with pytest.raises(SpaceError, match="allowed are paper, sound"):
        bg.ShapeSpace.bundled("round")
    monkeypatch.setitem(__import__("sys").modules, "sklearn", None)
    monkeypatch.setitem(__import__("sys").modules, "sklearn.mixture", None)
    fewer = replace(space(), coordinates=space().coordinates[:100])
    with pytest.raises(MissingLibraryError, match="scikit-learn"):
        fewer.distribution("mixture")


def test_bundled_spaces_are_named_files():
    for name in FILES:
        assert bg.ShapeSpace.load(name) == bg.ShapeSpace.bundled(name)


@pytest.mark.parametrize("of", [space, lambda: distribution("ellipsoid")])
def test_a_seed_draws_what_its_generator_does(of):
    assert_array_equal(of().sample(5, 7), of().sample(5, np.random.default_rng(7)))
    assert not np.array_equal(of().sample(5), of().sample(5))
