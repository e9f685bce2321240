"""What a fit says of sources that are no blade, not one, not whole or in another unit."""

import itertools

import numpy as np
import pytest

import bladegen as bg
from bladegen.errors import BladegenError, GeometryError
from bladegen.fitting import sources
from bladegen.fitting.placing.finding import found
from bladegen.measures import foreign, surfaces
from bladegen.surface.mesh import TriangleMesh, from_blade, surface


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=61)


@pytest.fixture(scope="module")
def mesh(blade):
    return from_blade(blade, stations=50)


def together(*meshes):
    """Meshes as one, in as many parts."""
    starts = np.cumsum([0, *(len(one.vertices) for one in meshes)])
    faces = [one.faces + start for one, start in zip(meshes, starts, strict=False)]
    return TriangleMesh(np.concatenate([one.vertices for one in meshes]), np.concatenate(faces))


def linked(*meshes):
    """Meshes as one part: triangles join their first vertices."""
    whole = together(*meshes)
    starts = np.cumsum([0, *(len(one.vertices) for one in meshes)])[:-1]
    links = [[a, b, b + 1] for a, b in itertools.pairwise(starts)]
    return TriangleMesh(whole.vertices, np.concatenate([whole.faces, links]))


def rotor(mesh):
    """Three blades and a tower, as a list."""
    found = []
    for angle in 2.0 * np.pi * np.arange(3) / 3.0:
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])
        found.append(TriangleMesh((np.array([0.0, 0.0, 1.5]) + mesh.vertices) @ turn, mesh.faces))
    around = np.linspace(0.0, 2.0 * np.pi, 41)[:-1]
    ring = np.stack([8.0 + 3.0 * np.cos(around), 3.0 * np.sin(around)], axis=1)
    rings = [np.column_stack([ring, np.full(40, z)]) for z in (-90.0, -45.0, 0.0)]
    tower = surface(np.stack([np.concatenate([one, one[:1]]) for one in rings]))
    return [*found, tower]


def test_a_rotor_gives_one_of_its_blades_and_in_one_piece_says_what_to_do(mesh):
    side, _, _ = sources.source_of(together(*rotor(mesh)), None, None)
    assert len(side.surface.mesh.faces) == len(mesh.faces)
    assert "3 copies of a blade, and 1 other parts: the first copy is taken" in side.remarks[0]
    with pytest.raises(GeometryError, match=r"leave one blade in the file|3 times as long") as told:
        bg.fit(linked(*rotor(mesh)), name="rotor")
    assert "\n" not in str(told.value)


def test_a_surface_that_crosses_itself_is_told_of(blade):
    eta = blade.stations(50)
    sections = blade.sections(eta).copy()
    deep = np.exp(-(((eta - 0.55) / 0.1) ** 2))[:, None] * np.exp(-(((blade.u - 0.7) / 0.08) ** 2))
    sections[..., 0] += 1.2 * deep  # the pressure side, through the suction side
    with pytest.raises(GeometryError, match=r"the surface crosses itself: .* repair it") as told:
        bg.fit(surface(sections), name="it")
    assert "\n" not in str(told.value)


def answered(monkeypatch, mesh, scale, sheets=0):
    """Let a STEP file hold one face, a mesh."""
    arrays = {
        "0/vertices": scale * mesh.vertices,
        "0/triangles": np.asarray(mesh.faces),
        "0/uv": np.zeros((len(mesh.vertices), 2)),
        "0/sign": np.array(1.0),
    }
    answer = foreign.Answer({"metres": 1.0, "lost": 0, "sheets": sheets}, arrays)
    monkeypatch.setattr(foreign, "ask", lambda *_: answer)


def test_metres_that_are_called_millimetres_end_in_a_line_that_says_what_to_type(
    monkeypatch, tmp_path, mesh
):
    answered(monkeypatch, mesh, 1e-3)
    path = tmp_path / "small.step"
    path.touch()
    with pytest.raises(GeometryError, match=r"is 0\.0615 m long.*--unit m;"):
        bg.fit(path)
    side, _, _ = sources.source_of(path, None, "m")
    assert side.surface.size == pytest.approx(61.5, abs=0.1)
    assert "its millimetres are taken to be m, as asked" in side.remarks[0]
    side, _, _ = sources.source_of(path, None, "mm")
    assert side.surface.size == pytest.approx(0.0615, abs=1e-4)


def test_sheets_beside_a_solid_are_left_out_and_said(monkeypatch, tmp_path, mesh):
    answered(monkeypatch, mesh, 1.0, sheets=2)
    path = tmp_path / "inside.step"
    path.touch()
    side, _, _ = sources.source_of(path, None, None)
    assert side.remarks == ("inside.step: 2 sheets beside its solid, such as webs, are left out",)


@pytest.mark.nightly
def test_a_blade_with_its_structure_is_fitted_by_its_solid(tmp_path):
    path = tmp_path / "nrel5mw.structure.step"
    bg.export(bg.Blade.from_definition(bg.read("nrel5mw")), path, tolerance=1e-3)
    fitted = bg.fit(path, tolerance=1e-2)
    assert fitted.held
    assert any("3 sheets beside its solid" in str(one) for one in fitted.findings)  # 2 webs, inner


@pytest.mark.parametrize("degrees", [3.0, 8.0])
def test_a_root_that_is_cut_at_a_slant_does_not_turn_the_pitch_axis(degrees):
    """Against the axis that the blade has; by circles it is as good as these are, 0.3 degrees."""
    import pyvista as pv
    from scipy.spatial.transform import Rotation

    whole = from_blade(bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101), stations=70)
    lean = np.radians(degrees)
    poly = pv.PolyData.from_regular_faces(whole.vertices, whole.faces)
    normal = (np.sin(lean), 0.0, np.cos(lean))
    left = poly.clip(normal=normal, origin=(0.0, 0.0, 1.0), invert=False)
    left = left.extract_surface(algorithm=None).triangulate()
    turn = Rotation.from_euler("xyz", [0.3, 0.7, 1.1]).as_matrix()
    faces = np.asarray(left.faces).reshape(-1, 4)[:, 1:]
    surface = surfaces.of_mesh(TriangleMesh(np.asarray(left.points, dtype=float) @ turn.T, faces))

    def posed(root):
        pose = found(surface, "it", metres=1.0, unit=None, frame="blade", root=root)
        return pose, np.degrees(np.arccos(min(1.0, pose.axes[:, 2] @ turn[:, 2])))

    pose, off = posed("circles")
    assert off < 0.35
    assert pose(surface.mesh.vertices)[:, 2].min() < -0.5 * lean  # z = 0 is where it is whole
    assert any("the blade begins where it is whole" in one for one in pose.said)
    assert posed("flange")[1] == pytest.approx(degrees, abs=1e-3)
    doubted, off = posed("auto")
    if degrees > 4.0:
        assert off < 0.35
    else:  # roots of blades lean as much: it cannot be known, and is said
        assert off == pytest.approx(degrees, abs=1e-3)
        assert any("if it is no flange but a cut, --root circles" in one for one in doubted.said)


def test_a_doubtful_flange_is_none_where_the_axes_of_the_file_are_taken():
    leaning = from_blade(bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101), stations=100)

    def said(frame):
        pose = found(surfaces.of_mesh(leaning), "it", metres=1.0, unit=None, frame=frame)
        return " ".join(pose.said)

    assert "2.0 degrees off the axis of its circles" in said("blade")
    assert "--root circles" not in said("auto")


def test_what_breaks_off_inside_is_one_line_with_the_file(monkeypatch, mesh):
    from bladegen.fitting import fit as module

    def broken(*_, **__):
        raise GeometryError("polar: a linear map is singular")

    monkeypatch.setattr(module, "fewest", broken)
    with pytest.raises(GeometryError, match=r"it: its sections make no blade \(polar: .*one whole"):
        bg.fit(mesh, name="it", tolerance=0.05)
    with pytest.raises(BladegenError, match="allowed are auto, file, blade"):
        bg.fit(mesh, frame="mine")
