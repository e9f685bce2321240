"""From surfaces to blades: laws of the fit, and blades that come back."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.curves.crossing import crossing_sections
from bladegen.errors import BladegenError, GeometryError
from bladegen.fitting import measuring
from bladegen.fitting.clouds.axis import along
from bladegen.fitting.clouds.coordinates import about
from bladegen.fitting.clouds.reading import is_cloud, points_of
from bladegen.fitting.clouds.surface import surface_of_points
from bladegen.fitting.like import model_like, parameters_of
from bladegen.fitting.measuring import Sections, uncrossed
from bladegen.fitting.placing.copies import one_of_copies
from bladegen.fitting.placing.finding import found
from bladegen.fitting.placing.pose import Pose
from bladegen.fitting.sections import outlines
from bladegen.fitting.sections.chains import area_of
from bladegen.fitting.sections.cutting import Cutter
from bladegen.measures import surfaces
from bladegen.surface.mesh import TriangleMesh, from_blade

SPANS = np.array([0.12, 0.3, 0.5, 0.75, 0.9])


@pytest.fixture(scope="session")
def dtu():
    return bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)


@pytest.fixture(scope="session")
def coarse(dtu):
    """The DTU 10 MW blade, which is bent upwind, as triangles that miss it by millimetres."""
    return from_blade(dtu, stations=70)


@pytest.fixture(scope="session")
def fitted(coarse):
    return bg.fit(coarse, tolerance=0.02, name="dtu", samples=600)


def chord_lines(blade, eta):
    """Chord and twist of the chord line, by the definition of both, of dense sections."""
    points = blade.profiles(eta)
    curves = SectionSplines(blade.u).fit(points)
    away = curves.trailing_edge - curves.leading_edge
    twist = blade.twist(eta) + np.arctan2(away[:, 1], away[:, 0])
    return curves.chord * blade.chord(eta), twist


def test_a_blade_comes_back_from_its_triangles(dtu, fitted):
    eta = np.linspace(0.1, 0.98, 60)
    chord, twist = chord_lines(dtu, eta)
    made = fitted.definition
    assert_allclose(made.length, dtu.length, atol=2e-3)
    assert_allclose(made.chord(eta), chord, atol=5e-3)
    assert_allclose(np.degrees(made.twist(eta)), np.degrees(twist), atol=0.15)
    assert_allclose(made.axis(eta)[:, 0], dtu.axis(eta)[:, 0], atol=0.02)
    assert fitted.held
    assert fitted.figures["percentile_99_mm"] < 8.0
    assert not fitted.pose.mirrored


def test_what_is_fitted_is_measured_from_the_source_itself(dtu, fitted):
    """Residuals say how far the source lies: moved outward, its points are farther by the move."""
    mesh = fitted.surface.mesh
    assert_allclose(mesh.vertices, fitted.pose(mesh.vertices), atol=1e-9)
    assert len(fitted.points) == len(fitted.residuals) == len(fitted.spans)
    assert sum(len(band) for band in fitted.bands()) > 0


def test_stations_are_fewer_where_more_is_allowed(fitted):
    from bladegen.fitting.stations import fewest

    length = fitted.definition.length
    counts = [
        len(fewest(fitted.sections, length, tolerance, name="a")) for tolerance in (0.003, 0.03)
    ]
    assert counts[0] > counts[1] >= 3


rotations = st.tuples(*[st.floats(-np.pi, np.pi)] * 3)


def turned(angles):
    from scipy.spatial.transform import Rotation

    return Rotation.from_euler("xyz", angles).as_matrix()


def sections_of(mesh, *, metres=1.0, frame="blade"):
    surface = surfaces.of_mesh(mesh)
    pose = found(surface, "it", metres=metres, unit=None, frame=frame)
    placed = pose.surface(surface)
    length = float(placed.mesh.vertices[:, 2].max())
    axis = measuring.axis_of(np.array([0.0, 1.0]), np.zeros(2), length)
    return pose, measuring.measured(Cutter(placed).cuts, axis, SPANS, name="it")


@pytest.fixture(scope="session")
def known(coarse):
    return sections_of(coarse)[1]


@given(rotations, st.tuples(*[st.floats(-50, 50)] * 3), st.booleans())
def test_a_turned_moved_mirrored_copy_is_the_same_blade(coarse, known, angles, move, mirror):
    image = np.diag([1.0, -1.0 if mirror else 1.0, 1.0])
    vertices = coarse.vertices @ image @ turned(angles) + move
    pose, sections = sections_of(TriangleMesh(vertices, coarse.faces))
    assert pose.mirrored == mirror
    assert_allclose(sections.chord, known.chord, atol=1e-6)
    assert_allclose(sections.twist, known.twist, atol=1e-6)
    assert_allclose(sections.prebend, known.prebend, atol=1e-6)
    assert_allclose(sections.offset, known.offset, atol=1e-6)
    assert_allclose(sections.airfoils, known.airfoils, atol=1e-6)
    assert_allclose(pose.back(pose(vertices)), vertices, atol=1e-8)


@pytest.mark.parametrize(("unit", "scale"), [("m", 1.0), ("mm", 1e-3), ("in", 0.0254)])
def test_units_are_found_or_believed(coarse, unit, scale):
    mesh = TriangleMesh(coarse.vertices / scale, coarse.faces)
    surface = surfaces.of_mesh(mesh)
    pose = found(surface, "it", metres=None, unit=None if unit != "in" else unit)
    assert pose.scale == scale
    assert unit in pose.said[0]
    if unit == "in":  # 3.4 m of millimetres
        guessed = found(surface, "it", metres=None, unit=None)
        assert guessed.scale == 1e-3
        assert "it would be 86.5 m long: --unit in" in guessed.said[0]


def test_a_file_whose_metres_are_called_millimetres_is_told_of(coarse):
    small = surfaces.of_mesh(TriangleMesh(coarse.vertices * 1e-3, coarse.faces))
    pose = found(small, "it", metres=1.0, unit=None)
    assert "m long: if its millimetres are metres, --unit m" in pose.said[0]


@pytest.mark.parametrize("axes", [np.eye(3), np.eye(3)[[2, 0, 1]], np.diag([-1.0, -1.0, 1.0])])
def test_axes_of_the_file_are_kept_by_any_names(coarse, dtu, axes):
    """So the pitch axis and the zero of the twist stay those of the file."""
    mesh = TriangleMesh(coarse.vertices @ axes, coarse.faces)
    pose, sections = sections_of(mesh, frame="auto")
    assert_allclose(pose.axes, axes.T, atol=0)
    assert_allclose(pose.origin, 0.0, atol=1e-9)
    assert sections.twist[-1] < np.radians(1.0)


def wedge(chord, twist, length=20.0, rows=81):
    """A straight blade of cambered wedges with blunt edges, by formulas of its own."""
    t = np.concatenate([np.linspace(1, 0, 60) ** 2, np.linspace(0, 1, 60)[1:] ** 2])
    side = np.concatenate([np.ones(60), -np.ones(59)])
    half = 0.3 * np.sqrt(t) * (1 - t) + 0.01 * t
    foil = np.stack([t, side * half + 0.2 * t * (1 - t)], axis=1)
    z = np.linspace(0.0, 1.0, rows)
    c, b = chord(z)[:, None], twist(z)[:, None]
    a, h = c * (foil[:, 0] - 0.3), c * foil[:, 1]
    points = np.stack(
        [h * np.cos(b) + a * np.sin(b), a * np.cos(b) - h * np.sin(b), z[:, None] * length + 0 * a],
        axis=-1,
    )
    n = len(foil)
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(n), indexing="ij")
    p, q = i * n + j, i * n + (j + 1) % n
    faces = np.concatenate(
        [np.stack([p, q, q + n], -1).reshape(-1, 3), np.stack([p, q + n, p + n], -1).reshape(-1, 3)]
    )
    return TriangleMesh(points.reshape(-1, 3), faces)


@given(st.floats(0.3, 0.9), st.floats(0.0, 0.3), st.floats(-0.05, 0.05))
def test_chord_and_twist_are_those_of_plain_formulas(taper, washout, pitch):
    """Of a mesh that no code of this package made, open at both ends."""

    def chord(z):
        return 2.0 - 2.0 * (1.0 - taper) * z

    def twist(z):
        return pitch + washout * (1.0 - z) ** 2

    surface = surfaces.of_mesh(wedge(chord, twist))
    axis = measuring.axis_of(np.array([0.0, 1.0]), np.zeros(2), 20.0)
    found_ = measuring.measured(Cutter(surface).cuts, axis, SPANS, name="wedge")
    width = 0.02 * chord(SPANS)
    assert_allclose(found_.chord, chord(SPANS), atol=2e-3)
    assert_allclose(found_.twist, twist(SPANS), atol=2e-3)
    edge = (found_.airfoils[:, 0] - found_.airfoils[:, -1])[:, 1] * found_.chord
    assert_allclose(edge, width, atol=1e-3)


def box(*sizes):
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    faces = [
        [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ]  # fmt: skip
    return TriangleMesh(corners * sizes, np.array(faces))


def two(mesh, scale=0.9):
    vertices = np.concatenate([mesh.vertices, scale * mesh.vertices + np.array([8.0, 0.0, 0.0])])
    return TriangleMesh(vertices, np.concatenate([mesh.faces, mesh.faces + len(mesh.vertices)]))


def test_what_is_no_blade_is_one_line(coarse):
    half = replace(coarse, faces=coarse.faces[::2], regions=None)
    for mesh, said in (
        (box(1.0, 1.1, 1.2), "must be at least 3 times as long as wide"),
        (box(1.0, 1.1, 40.0), "none is the trailing edge"),
        (two(coarse), "leave one blade in the file"),
        (half, "is the surface whole"),
    ):
        with pytest.raises(GeometryError, match=said) as raised:
            bg.fit(mesh, name="it")
        assert "\n" not in str(raised.value)


def test_one_of_several_copies_is_taken(coarse):
    alone, said = one_of_copies(two(coarse, 1.0))
    assert len(alone.faces) == len(coarse.faces)
    assert_allclose(alone.volume, coarse.volume, rtol=1e-12)
    assert "2 copies of a blade, and 0 other parts" in said[0]
    assert one_of_copies(coarse) == (coarse, ())
    assert one_of_copies(two(coarse, 0.9))[1] == ()


@pytest.mark.parametrize("suffix", [".xyz", ".csv", ".ply"])
def test_points_come_from_files(tmp_path, suffix, foreign_here):
    import trimesh

    points = np.random.default_rng(3).normal(size=(50, 3))
    path = tmp_path / f"scan{suffix}"
    if suffix == ".ply":
        trimesh.PointCloud(points).export(path)
    else:
        mark = "," if suffix == ".csv" else " "
        np.savetxt(path, points, delimiter=mark, header="x,y,z" if mark == "," else "", comments="")
    assert is_cloud(path)
    assert_allclose(points_of(path), points, atol=1e-6)


def test_points_that_are_none_are_one_line(tmp_path):
    path = tmp_path / "a.xyz"
    path.write_text("nothing\n")
    with pytest.raises(BladegenError, match="holds three numbers x, y, z"):
        bg.fit(path)
    with pytest.raises(GeometryError, match="100 points, at least 2000 are needed"):
        bg.fit(np.random.default_rng(1).normal(size=(100, 3)))
    with pytest.raises(GeometryError, match="must be a slender body"):
        bg.fit(np.random.default_rng(1).normal(size=(5000, 3)))


def test_a_cloud_with_noise_and_holes_is_smoothed(dtu, coarse):
    """Against the blade itself, by distances that the fit does not use."""
    import trimesh

    from bladegen.measures import distances

    rng = np.random.default_rng(5)
    fine = trimesh.Trimesh(coarse.vertices, coarse.faces, process=False)
    points, _ = trimesh.sample.sample_surface(fine, 60_000, seed=2)
    points = points + 0.003 * rng.normal(size=points.shape)
    for centre in points[rng.integers(len(points), size=20)]:
        points = points[np.linalg.norm(points - centre, axis=1) > 1.0]
    cloud = surface_of_points(points, "scan")
    assert cloud.noise == pytest.approx(0.003, rel=0.4)
    some = cloud.mesh.vertices.reshape(360, 480, 3)[20:-20:20, ::24].reshape(-1, 3)
    off = np.abs(distances.signed(some, surfaces.of_mesh(coarse)))
    assert np.percentile(off, 90) < 0.015


def crossed_at(rows, count=40):
    """Return sections of an ellipse, some of them bent into eights."""
    turn = 2.0 * np.pi * np.linspace(0.0, 1.0, 101)
    ring = np.stack([0.5 + 0.5 * np.cos(turn), 0.1 * np.sin(turn)], axis=-1)
    airfoils = np.tile(ring, (count, 1, 1)) * (1.0 + 1e-3 * np.arange(count))[:, None, None]
    airfoils[rows] = np.stack([ring[:, 0], 0.1 * np.sin(2.0 * turn)], axis=-1)
    one = np.arange(float(count))
    return Sections(
        np.linspace(0.0, 1.0, count), *(one + k for k in range(4)), airfoils, one, one > 0, one,
        one, one > 0, one,
    )  # fmt: skip


def test_sections_of_a_cloud_that_cross_have_the_shape_of_a_neighbour():
    """A fit of a scan with 2 mm of noise was refused when it was written: its tip crossed."""
    given = crossed_at([37, 38, 39])
    made, said = uncrossed(given, "scan")
    assert crossing_sections(made.airfoils) == []
    assert_allclose(made.airfoils[:37], given.airfoils[:37], atol=0)
    assert_allclose(made.airfoils[37:], given.airfoils[[36, 36, 36]], atol=0)
    assert_allclose(made.chord, given.chord, atol=0)
    assert "3 sections of the points' surface, of eta = 0.9487 to 1.0000, cross" in said[0]
    assert uncrossed(crossed_at([]), "scan")[1] == ()
    with pytest.raises(GeometryError, match="20 of 40 sections of the points' surface cross"):
        uncrossed(crossed_at(list(range(20))), "scan")


def test_coordinates_of_clouds_go_both_ways(coarse):
    points = coarse.vertices[coarse.vertices[:, 2] > 0.5]
    ellipses = about(coarse.vertices[coarse.vertices[:, 2] > 0.0])
    rho, phi = ellipses.flattened(points)
    assert_allclose(ellipses.points(rho, phi, points[:, 2]), points, atol=1e-9)


def test_arguments_are_looked_at(coarse):
    for wrong, said in (
        ({"tolerance": 0.0}, "must be positive"),
        ({"unit": "furlong"}, "allowed are m, mm"),
        ({"frame": "mine"}, "allowed are auto, file, blade"),
    ):
        with pytest.raises(BladegenError, match=said):
            bg.fit(coarse, **wrong)


@given(st.integers(6, 60), st.floats(0.1, 10.0), st.floats(-3.0, 3.0))
def test_circles_are_found(count, radius, middle):
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    points = middle + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    centre, size = outlines.circle_of(points)
    assert_allclose(centre, middle, atol=1e-9 * (1 + radius))
    assert_allclose(size, radius, rtol=1e-9)
    assert outlines.is_round(points)
    assert area_of(points) > 0


def test_a_pose_goes_both_ways():
    pose = Pose(1e-3, turned((0.1, 0.2, 0.3)), np.array([1.0, 2.0, 3.0]))
    points = np.arange(12.0).reshape(4, 3)
    assert_allclose(pose.back(pose(points)), points, atol=1e-9)
    assert not pose.mirrored


def test_parameters_of_a_variant_are_found_with_their_covariance(dtu):
    """From points of the variant at spans and places that the model does not use."""
    space = bg.ShapeSpace.bundled()
    kinds = ("pga", "thickness", "chord", "twist")
    model = bg.ParametricBlade(dtu, space, kinds, np.linspace(0.2, 0.95, 40))
    truth = np.array([0.02, -0.01, 0.01, 0.005, 1.03, 1.02, 0.01])
    variant = dtu.perturbed(
        space, truth[:4], thickness=1.03, chord=1.02, twist=0.01, allow_odd=True
    )
    rng = np.random.default_rng(4)
    places = np.sort(np.concatenate([rng.uniform(0.03, 0.45, 20), rng.uniform(0.55, 0.97, 20)]))
    points = variant.sections(np.sort(rng.uniform(0.2, 0.95, 16)), places).reshape(-1, 3)
    points = points + 1e-3 * rng.normal(size=points.shape)
    found_ = parameters_of(points, model)
    assert_allclose(found_.x, truth, atol=2e-3)
    assert np.all(np.abs(found_.x - truth) < 8.0 * found_.deviations + 5e-4)
    assert found_.rms < 2e-3
    assert [row["name"] for row in found_.rows()] == list(model.names)
    with pytest.raises(BladegenError, match="at least 70 are needed for 7 parameters"):
        parameters_of(points[:20], model)
    with pytest.raises(BladegenError, match="must be a BladeDefinition"):
        model_like("iea15mw")


def test_leading_edges_pass_from_nose_to_nose_without_a_jump():
    """Two ends of a blunt nose change places half way; chord lines must not turn at once."""
    from bladegen.airfoils.landmarks import landmark_parameters
    from bladegen.fitting.measuring import LANDMARKS, Sections
    from bladegen.fitting.noses import with_steady_noses

    eta = np.linspace(0.0, 1.0, 81)
    airfoils, twists = [], []
    for tilt in 0.01 * (eta - 0.5):  # of a nose that is flat, 30 % of the chord high
        phi = np.linspace(-0.15, 0.15, 61)
        x = phi / 0.15
        far = 0.995 + 0.0006 * (1.0 - np.cos(4.0 * x)) + tilt * phi - 0.004 * x**8
        psi = np.concatenate([np.linspace(-1.2, -0.16, 50), phi, np.linspace(0.16, 1.2, 50)])
        edge = np.interp(np.abs(psi[:50]), [0.16, 1.2], [0.985, 0.05])
        r = np.concatenate([edge, far, edge[::-1]])
        points = np.stack([1.0 - r * np.cos(psi), -r * np.sin(psi)], axis=1)
        points = np.concatenate([[[1.0, 0.01]], points, [[1.0, -0.01]]])
        own = outlines.landmarks_of(
            outlines.Outline(points, True), landmark_parameters(LANDMARKS), None
        )
        curves = SectionSplines(landmark_parameters(LANDMARKS)).fit(own[None])
        away = curves.trailing_edge[0] - curves.leading_edge[0]
        turn = np.arctan2(away[1], away[0])
        c, s = np.cos(turn), np.sin(turn)
        airfoils.append((own - curves.leading_edge[0]) @ np.array([[c, -s], [s, c]]) / curves.chord)
        twists.append(turn)
    zero = np.zeros(81)
    flags = np.zeros(81, dtype=bool)
    own = SectionSplines(landmark_parameters(LANDMARKS)).fit(np.stack(airfoils))
    sections = Sections(
        eta, 4.0 + zero, np.array(twists), zero + 1.0, zero, np.stack(airfoils),
        own.relative_thickness, flags, zero, zero, flags, zero,
    )  # fmt: skip

    def turns(some):  # of the middle landmarks, by which sections are joined
        nose = some.airfoils[:, LANDMARKS // 2]
        return np.diff(some.twist + np.arctan2(-nose[:, 1], 1.0 - nose[:, 0]))

    assert np.abs(turns(sections)).max() > 0.15
    steady = with_steady_noses(sections, 40.0, 5e-4)
    assert np.abs(turns(steady)).max() < 0.07
    curves = SectionSplines(landmark_parameters(LANDMARKS)).fit(steady.airfoils)
    assert_allclose(curves.chord, 1.0, atol=1e-6)
    assert_allclose(steady.chord, sections.chord, atol=6e-3)  # noses are cut back, not grown
    assert np.all(steady.chord <= sections.chord + 1e-9)


def test_a_base_that_slants_along_the_chord_is_a_side():
    """Else readers refuse the airfoil: its ends lie a tenth of the chord apart in x."""
    for slant, width in ((0.04, 0.2), (0.15, 0.0)):
        ring = np.array([[1.0, 0.0], [1.0 - slant, 0.2], [0.2, 0.15], [0.0, 0.0], [0.2, -0.1]])
        ends = np.concatenate([ring, ring[:1]])
        fine = np.concatenate(
            [a + (b - a) * np.linspace(0, 1, 30)[:-1, None] for a, b in itertools.pairwise(ends)]
        )
        opened = outlines.edge_of(fine, np.array([1.0, 0.0]))
        assert opened.cornered
        assert opened.width == pytest.approx(np.hypot(width, slant if width else 0.0), abs=1e-9)


@given(rotations, st.tuples(*[st.floats(-50, 50)] * 3))
def test_a_cloud_lies_along_the_normal_of_its_root_rim_with_holes_in_it(cloud, angles, move):
    """The longest axis leans by 1.7 degrees: metres of prebend at the tip."""
    turn = turned(angles)
    axes, start, by_rim = along(cloud @ turn + move, "scan")
    assert by_rim
    assert np.degrees(np.arccos(min(1.0, (turn @ axes[:, 2])[2]))) < 0.1
    assert_allclose((np.zeros(3) @ turn + move) @ axes - start, 0.0, atol=0.1)


@pytest.fixture(scope="module")
def cloud(coarse):
    import trimesh

    mesh = trimesh.Trimesh(coarse.vertices, coarse.faces, process=False)
    points, _ = trimesh.sample.sample_surface(mesh, 60_000, seed=2)
    points = points + 0.003 * np.random.default_rng(5).normal(size=points.shape)
    for y in (2.6, -2.6):  # at the rim
        points = points[np.linalg.norm(points - [0.0, y, 0.2], axis=1) > 1.0]
    return points


def test_a_hull_of_a_blade_is_told_of(coarse):
    from scipy.spatial import ConvexHull

    assert not any(
        "hull" in said for said in found(surfaces.of_mesh(coarse), "it", metres=1.0, unit=None).said
    )
    hull = ConvexHull(coarse.vertices)
    corners = coarse.vertices[hull.simplices]
    out = np.linalg.det(corners - coarse.vertices.mean(axis=0)) > 0.0
    faces = np.where(out[:, None], hull.simplices, hull.simplices[:, ::-1])
    pose = found(
        surfaces.of_mesh(TriangleMesh(coarse.vertices, faces)), "it", metres=1.0, unit=None
    )
    assert any("convex hull of a blade" in said for said in pose.said)
