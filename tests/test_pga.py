import os

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.airfoils.landmarks import clustered, cosine, landmark_parameters, landmarks
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.errors import GeometryError, SpaceError
from bladegen.formats.baselines import baselines
from bladegen.shapes import affine, grassmann
from bladegen.shapes.shape_space import ShapeSpace
from strategies import SEEDS, random_points, random_tangent


def cloud(seed, count=60, n=21, r=3, noise=0.0):
    """Shapes on an r-dimensional geodesic submanifold, in any representatives."""
    rng = np.random.default_rng([5, seed])
    base = random_points(rng, 1, n)[0]
    directions = np.linalg.qr(
        random_tangent(rng, np.stack([base] * r), 1.0).reshape(r, -1).T
    ).Q.T.reshape(r, n, 2)
    t = rng.normal(size=(count, r)) * [0.2, 0.1, 0.05][:r]
    tangents = np.tensordot(t, directions, axes=1)
    tangents += noise * random_tangent(rng, np.stack([base] * count), 1.0)
    turns = np.linalg.qr(rng.normal(size=(count, 2, 2))).Q
    return grassmann.exp(base, tangents) @ turns


@given(SEEDS)
def test_modes_are_orthonormal_and_horizontal(seed):
    space = ShapeSpace.fit(cloud(seed), modes=3)
    flat = space.modes.reshape(3, -1)
    assert_allclose(flat @ flat.T, np.eye(3), atol=1e-12)
    assert_allclose(space.mean.T @ space.modes, 0, atol=1e-12)
    assert_allclose(space.mean.T @ space.mean, np.eye(2), atol=1e-13)


@given(SEEDS)
def test_decode_of_encode_returns_shapes_of_the_manifold(seed):
    space = ShapeSpace.fit(cloud(seed, noise=0.01), modes=3)
    learned = space.decode(space.coordinates[:7])
    again = space.decode(space.encode(learned))
    assert np.max(grassmann.distance(learned, again)) < 1e-9
    assert_allclose(space.encode(space.mean), 0, atol=1e-14)


@given(SEEDS)
def test_coordinates_do_not_depend_on_representatives(seed):
    points = cloud(seed)
    turns = np.linalg.qr(np.random.default_rng(seed).normal(size=(len(points), 2, 2))).Q
    space = ShapeSpace.fit(points, modes=2)
    assert_allclose(space.encode(points @ turns), space.coordinates, atol=1e-12)
    other = ShapeSpace.fit(points @ turns, modes=2)
    assert_allclose(other.variances[:2], space.variances[:2], rtol=1e-8)
    assert grassmann.distance(other.mean, space.mean) < 1e-9


@given(SEEDS)
def test_variances_are_those_of_the_coordinates(seed):
    points = cloud(seed)
    space = ShapeSpace.fit(points, modes=3)
    covariance = space.coordinates.T @ space.coordinates / len(points)
    assert_allclose(covariance, np.diag(space.variances[:3]), atol=1e-12)
    assert np.all(np.diff(space.variances) <= 1e-15)
    assert_allclose(space.variance_ratio.sum(), 1.0)


def test_against_plain_pca_of_the_logs():
    points = cloud(4, noise=0.02)
    space = ShapeSpace.fit(points, modes=3)
    logs = np.stack([grassmann.log(space.mean, p) for p in points]).reshape(len(points), -1)
    assert np.abs(logs.mean(axis=0)).max() < 1e-10
    singular, directions = np.linalg.svd(logs, full_matrices=False)[1:]
    assert_allclose(space.variances[:10], singular[:10] ** 2 / len(points), rtol=1e-9)
    overlap = np.abs(np.sum(directions[:3] * space.modes.reshape(3, -1), axis=1))
    assert_allclose(overlap, 1.0, atol=1e-8)


@given(SEEDS, st.integers(1, 200))
def test_samples_lie_in_the_ellipsoid_of_the_data(seed, count):
    space = ShapeSpace.fit(cloud(3), modes=3)
    drawn = space.sample(count, np.random.default_rng(seed))
    spread = np.sqrt(space.variances[:3])
    reach = np.linalg.norm(space.coordinates / spread, axis=1).max()
    assert drawn.shape == (count, 3)
    assert np.linalg.norm(drawn / spread, axis=1).max() <= reach + 1e-12
    assert np.array_equal(drawn, space.sample(count, np.random.default_rng(seed)))


@given(SEEDS)
def test_carried_tangents_keep_inner_products(seed):
    points = cloud(seed)
    space = ShapeSpace.fit(points, modes=3)
    s, t = np.random.default_rng(seed).normal(size=(2, 5, 3))
    carried_s, carried_t = (space.carried(x, points[:5]) for x in (s, t))
    assert_allclose(np.sum(carried_s * carried_t, axis=(1, 2)), np.sum(s * t, axis=1), atol=1e-10)
    assert_allclose(points[:5].mT @ carried_s, 0, atol=1e-12)


def test_a_space_returns_from_its_file(tmp_path):
    space = ShapeSpace.fit(cloud(1), modes=2, about="a test; größer")
    space.save(tmp_path / "space.npz")
    again = ShapeSpace.load(tmp_path / "space.npz")
    for name in ("u", "mean", "modes", "variances", "coordinates"):
        assert np.array_equal(getattr(again, name), getattr(space, name))
    assert again.about == space.about


def test_damaged_and_foreign_files_are_refused(tmp_path):
    space = ShapeSpace.fit(cloud(1), modes=2)
    path = tmp_path / "space.npz"
    space.save(path)
    whole = path.read_bytes()
    arrays = dict(np.load(path))
    for name, changed, message in (
        ("mean", arrays["mean"] * 1.1, "damaged"),
        ("version", np.array(99), "version 99, allowed is 2, .*bladegen space build"),
        ("version", np.array([1, 1]), "version"),
    ):
        np.savez(path, **{**arrays, name: changed})
        with pytest.raises(SpaceError, match=message):
            ShapeSpace.load(path)
    for content in (b"", b"nonsense", whole[: len(whole) // 2]):
        path.write_bytes(content)
        with pytest.raises(SpaceError, match=r"is no shape space|cannot be read"):
            ShapeSpace.load(path)
    np.savez(path, mean=np.array([{"a": 1}], dtype=object))
    with pytest.raises(SpaceError, match="is no shape space"):
        ShapeSpace.load(path)
    with pytest.raises(SpaceError, match="is no file"):
        ShapeSpace.load(tmp_path / "nowhere.npz")


def as_g2aero_keeps_it(space, affine, more=3):
    """What G2Aero's Grassmann_PGAspace.save_to_file writes: pressure side first, all modes."""
    rng = np.random.default_rng(4)
    n = len(space.mean)
    others = rng.normal(size=(more, n, 2))
    others -= space.mean @ (space.mean.T @ others)
    basis = np.concatenate([space.modes, others]).reshape(-1, 2 * n).T
    basis = np.linalg.qr(basis)[0] * np.sign(np.diag(np.linalg.qr(basis)[1]))
    small = 1e-5 * rng.normal(size=(len(space.coordinates), more)) * 0.5 ** np.arange(more)
    return {
        "Vh": basis.T.reshape(-1, n, 2)[:, ::-1].reshape(-1, 2 * n),
        "karcher_mean": space.mean[::-1],
        "M_mean": affine,
        "b_mean": np.array([0.5, 0.0]),
        "coords": np.concatenate([space.coordinates, small], axis=1),
    }


def test_spaces_of_g2aero_are_read(tmp_path):
    space = ShapeSpace.bundled()
    points = landmarks(bg.read("iea15mw").stations[-1].airfoil.coordinates, 401)
    mean, affine = np.linalg.qr(points - points.mean(axis=0))
    modes = space.modes - mean @ (mean.T @ space.modes)
    modes = np.linalg.qr(modes.reshape(4, -1).T)[0].T.reshape(4, 401, 2)
    space = ShapeSpace(space.u, mean, modes, space.variances, space.coordinates)
    path = tmp_path / "PGA_space.npz"
    np.savez(path, **as_g2aero_keeps_it(space, affine))
    found = ShapeSpace.load(path)
    assert found.about == "G2Aero, PGA_space.npz: the first 4 of 7 modes"
    t = space.coordinates[::4000]
    assert_allclose(grassmann.distance(found.decode(t), space.decode(t)), 0.0, atol=1e-7)
    assert_allclose(found.u, space.u, atol=1e-4)  # where ours lie on that shape
    assert_allclose(found.variances[:4], space.variances[:4], rtol=0.05)
    found.save(tmp_path / "ours.npz")
    again = ShapeSpace.load(tmp_path / "ours.npz").at(space.u)
    assert_allclose(grassmann.distance(again.decode(t), space.decode(t)), 0.0, atol=1e-3)


@pytest.mark.parametrize("count", [300, 301])
def test_spaces_of_g2aero_on_evenly_divided_contours_are_read(tmp_path, count):
    """The wind airfoils that come with G2Aero have 500 landmarks, none of them at the nose."""
    coordinates = bg.read("iea15mw").stations[-1].airfoil.coordinates
    points = landmarks(coordinates, 4001)
    share = np.append(0.0, np.linalg.norm(np.diff(points, axis=0), axis=1).cumsum())
    even = np.linspace(0.0, share[-1], count)
    contour = np.stack([np.interp(even, share, axis) for axis in points.T], axis=-1)
    mean, affine = np.linalg.qr(contour - contour.mean(axis=0))
    bump = np.stack([np.zeros(count), np.sin(np.pi * even / share[-1]) ** 2], axis=-1)
    mode = bump - bump.mean(axis=0)
    mode -= mean @ (mean.T @ mode)
    mode /= np.linalg.norm(mode)
    data = np.random.default_rng(3).normal(size=(50, 1)) * 0.01
    space = ShapeSpace(np.linspace(0.0, 1.0, count), mean, mode[None], np.array([1e-4]), data)
    path = tmp_path / "PGA_space.npz"
    np.savez(path, **as_g2aero_keeps_it(space, affine, more=0))
    found = ShapeSpace.load(path)
    ours = np.interp(even, share, landmark_parameters(4001))  # where ours lie on that shape
    assert_allclose(found.u, ours, atol=5e-4)
    wanted = landmarks(coordinates, 201)
    plain = np.linalg.qr(wanted - wanted.mean(axis=0))[0]
    at = found.at(bg.Blade.from_definition(bg.read("iea15mw"), landmarks=201).u)
    assert float(grassmann.distance(at.mean, plain)) < 3e-3


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"M_mean": None}, "is a space of G2Aero's without M_mean"),
        ({"shape_mean": np.zeros((9, 2))}, r"G2Aero's space of affine parts .SPD."),
        ({"karcher_mean": np.eye(2)}, r"G2Aero's space of affine parts"),
        ({"Vh": np.zeros((3, 9))}, r"must be .r, 2 n., .n, 2. and .m, r., n at least 5"),
        ({"karcher_mean": np.array([{"a": 1}], dtype=object)}, "is no shape space"),
        ({"coords": np.full((4, 2), np.nan)}, "finite numbers"),
    ],
)
def test_broken_spaces_of_g2aero_are_refused_in_a_line(tmp_path, change, said):
    space = ShapeSpace.fit(cloud(1), modes=2)
    arrays = as_g2aero_keeps_it(space, np.eye(2), more=1) | change
    path = tmp_path / "space.npz"
    np.savez(path, **{name: value for name, value in arrays.items() if value is not None})
    with pytest.raises(SpaceError, match=said) as told:
        ShapeSpace.load(path)
    assert "\n" not in str(told.value)


def test_files_that_are_too_large_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("bladegen.support.archive.MAX_BYTES", 10)
    (tmp_path / "big.npz").write_bytes(b"x" * 11)
    with pytest.raises(SpaceError, match="larger than 10 bytes"):
        ShapeSpace.load(tmp_path / "big.npz")


def test_a_space_is_a_regular_file(tmp_path):
    os.mkfifo(tmp_path / "space.npz")
    with pytest.raises(SpaceError, match="is no regular file"):
        ShapeSpace.load(tmp_path / "space.npz")


@pytest.mark.parametrize("modes", [0, -1, 60, 1000])
def test_impossible_numbers_of_modes_are_refused(modes):
    with pytest.raises(SpaceError, match=f"modes: got {modes}, allowed is 1 to"):
        ShapeSpace.fit(cloud(1), modes=modes)


def test_wrong_coordinates_are_refused():
    space = ShapeSpace.fit(cloud(1), modes=2)
    with pytest.raises(SpaceError, match="got 3 coordinates, the space has 2"):
        space.decode([0.0, 0.0, 0.0])
    with pytest.raises(SpaceError, match="got 1 coordinates"):
        space.decode(0.0)
    with pytest.raises(SpaceError, match="finite"):
        space.decode([0.0, np.nan])
    assert space.outside([0.0, 0.0]) is None
    assert "t2 = 9, allowed is" in space.outside([0.0, 9.0])


def test_a_mean_that_does_not_converge_is_said(monkeypatch):
    monkeypatch.setattr("bladegen.shapes.learning.STEPS", 1)
    with pytest.raises(GeometryError, match="not converged after 1 steps"):
        ShapeSpace.fit(cloud(1), modes=2)


def test_the_bundled_space_is_the_paper_s():
    space = ShapeSpace.bundled()
    assert len(space.coordinates) == 16_000
    assert space.dimension == 4
    assert len(space.u) == 401
    assert 0.93 < space.variance_ratio[:4].sum() < 0.97  # "rapid decay"; 95 % in FIELD's set
    assert_allclose(space.mean.T @ space.modes, 0, atol=1e-12)
    assert_allclose(space.coordinates.mean(axis=0), 0, atol=1e-9)


@pytest.mark.parametrize("n", [4, 20, 21])
def test_any_number_of_landmarks_can_be_learned_from(n):
    points = random_points(np.random.default_rng(0), 1, n)
    near = grassmann.exp(points, random_tangent(np.random.default_rng(1), points.repeat(9, 0), 0.2))
    space = ShapeSpace.fit(near, modes=2)
    assert space.u.shape == (n,)
    assert_allclose(space.encode(space.decode([0.1, -0.05])), [0.1, -0.05], atol=1e-12)


def test_modes_along_which_nothing_varies_are_refused():
    points = random_points(np.random.default_rng(2), 1, 12)
    with pytest.raises(SpaceError, match="got 1, the shapes vary in 0 directions only"):
        ShapeSpace.fit(np.repeat(points, 5, axis=0), modes=1)


@pytest.mark.parametrize("spacing", [clustered, cosine])
def test_a_coordinate_moves_a_contour_alike_whatever_its_landmarks(spacing):
    """A blade of other landmarks, perturbed, is the perturbed blade at these landmarks."""
    space, t, eta = bg.ShapeSpace.bundled(), [0.06, -0.05, 0.03, 0.02], np.array([0.3, 0.9])
    definition = bg.read("iea15mw")
    fine = bg.Blade.from_definition(definition)
    other = bg.Blade.from_definition(definition, landmarks=201, spacing=spacing)
    wanted = fine.perturbed(space, t).profiles(eta, other.u)
    moved = np.abs(wanted - fine.profiles(eta, other.u)).max()
    assert moved > 0.02
    assert_allclose(other.perturbed(space, t).profiles(eta), wanted, atol=0.01 * moved)


def test_modes_pass_the_leading_edge_as_they_pass_their_other_landmarks():
    """Slopes in u change there by no more than beside it: by ten times as much once."""
    space = bg.ShapeSpace.bundled()
    nose = len(space.u) // 2
    for column in (space.mean, *space.modes):
        slopes = np.diff(column, axis=0) / np.diff(space.u)[:, None]
        changes = np.linalg.norm(np.diff(slopes, axis=0), axis=1)[nose - 5 : nose + 4]
        assert changes[4] < 1.2 * changes.max(where=np.arange(9) != 4, initial=0.0)


def test_a_perturbed_nose_is_as_round_as_its_sides_make_it():
    blade, space = bg.Blade.from_definition(bg.read("nrel5mw")), bg.ShapeSpace.bundled()
    odd = {"allow_odd": True, "allow_extrapolation": True}
    variant = blade.perturbed(space, [-0.1, 0.0, 0.0, 0.0], **odd)
    curve = SectionSplines(blade.u).fit(variant.profiles(np.array([0.3])))
    u = 0.5 + 1e-3 * np.linspace(-1.0, 1.0, 9)
    _, d1, d2 = (v[0] for v in curve.at(u[None]))
    turn = (d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0]) / np.hypot(*d1.T) ** 3
    low, high = np.sort(turn[[0, -1]])
    assert np.all((turn > 0.9 * low) & (turn < 1.1 * high))


def test_an_evaluated_space_encodes_what_it_decodes_and_keeps_its_bounds(tmp_path):
    space = bg.ShapeSpace.bundled()
    assert space.at(space.u) is space
    other = space.at(landmark_parameters(101))
    t = np.array([[0.06, -0.05, 0.03, 0.02], [0.0, 0.1, 0.0, -0.1]])
    assert_allclose(other.encode(other.decode(t)), t, atol=1e-12)
    assert_allclose(other.mean.T @ other.mean, np.eye(2), atol=1e-12)
    assert_allclose(other.mean.sum(axis=0), 0.0, atol=1e-12)
    assert_allclose(other.lower, space.lower)
    with pytest.raises(SpaceError, match="save the space that was learned"):
        other.save(tmp_path / "other.npz")
    with pytest.raises(SpaceError, match="5 landmarks are too few for 4 modes"):
        space.at(landmark_parameters(5))


def test_a_coarse_space_serves_its_own_landmarks_alone():
    shapes = np.stack([landmarks(xy, 21) for xy in baselines().values()])
    coarse = bg.ShapeSpace.fit(affine.standardise(shapes)[0], modes=2)
    with pytest.raises(SpaceError, match=r"its 21 landmarks are too coarse .*--landmarks 21"):
        coarse.at(landmark_parameters(401))
