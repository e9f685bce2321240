from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.blade.edges import AsGiven, MinimumThickness
from bladegen.definition.blade_definition import Distribution
from bladegen.errors import BladegenError, FileError
from bladegen.measures import checks
from bladegen.surface import mesh, mesh_files
from strategies import by_day

pytestmark = pytest.mark.usefixtures("foreign_here")


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)


@pytest.mark.parametrize("name", by_day("iea15mw"))
def test_reference_blades_are_sound(name):
    check = checks.check_blade(bg.Blade.from_definition(bg.read(name)))
    assert check.kind == "blade"
    assert check.problems == ()
    assert check.figures["stations_missed_by_chord"] < 1e-9
    assert check.figures["chord_error_relative"] < 1e-9
    assert check.figures["twist_error_deg"] < 1e-9
    assert check.figures["thickness_error"] < 1e-9


def test_a_blade_without_thickness_distribution(blade):
    plain = bg.Blade.from_definition(replace(blade.definition, relative_thickness=None))
    figures = checks.check_blade(plain).figures
    assert figures["thickness_error"] < 1e-9  # the airfoils' own rules
    assert figures["stations_missed_by_chord"] < 1e-9


def test_a_missed_station_is_measured(blade, monkeypatch):
    honest = bg.Blade.profiles
    monkeypatch.setattr(
        bg.Blade, "profiles", lambda self, eta, u=None: honest(self, eta, u) * [1.01, 1.0]
    )
    assert checks.check_blade(blade).figures["stations_missed_by_chord"] > 1e-4


def test_a_wrong_twist_is_measured(blade, monkeypatch):
    honest = type(blade.planform).place
    monkeypatch.setattr(
        type(blade.planform), "place", lambda self, p, eta: honest(self, p * [1.0, -1.0], eta)
    )
    assert checks.check_blade(blade).figures["twist_error_deg"] > 1e-3


def shrunk(definition, factor):
    """A definition with all of its lengths times a factor."""

    def scaled(quantity):
        return None if quantity is None else replace(quantity, values=quantity.values * factor)

    axis = definition.axis
    return replace(
        definition,
        chord=scaled(definition.chord),
        axis=replace(axis, x=scaled(axis.x), y=scaled(axis.y), z=scaled(axis.z)),
        section_offset_x=scaled(definition.section_offset_x),
        section_offset_y=scaled(definition.section_offset_y),
    )


@pytest.mark.parametrize("factor", [0.3, 0.02, 0.002])
def test_a_model_has_the_volume_of_its_scale(blade, factor):
    model = bg.Blade.from_definition(shrunk(blade.definition, factor), landmarks=101)
    figures = checks.check_blade(model).figures
    whole = checks.check_blade(blade).figures["volume_m3"]
    assert figures["volume_m3"] == pytest.approx(whole * factor**3, rel=5e-3)
    assert 0 <= figures["edge_adds_volume"] < 5e-3
    assert any("2 mm would be more" in said for said in figures["findings"]) == (factor < 0.1)


def test_an_edge_that_adds_volume_is_said_and_its_thickness_measured(blade):
    thick = checks.check_blade(blade.with_trailing_edge(MinimumThickness(0.2))).figures
    (said,) = (one for one in thick["findings"] if one.startswith("trailing edge"))
    assert "its finish (200mm) adds" in said
    given_ = checks.check_blade(blade.with_trailing_edge(AsGiven())).figures
    added = thick["volume_m3"] / given_["volume_m3"] - 1
    assert thick["edge_adds_volume"] == pytest.approx(added, rel=0.1)
    assert given_["edge_adds_volume"] == 0.0
    assert thick["thickness_error"] > 1e-8 > given_["thickness_error"]  # splines ring, a little
    stretched = blade.with_trailing_edge(lambda profiles, chord: profiles * [1.0, 1.01])
    error = checks.check_blade(stretched).figures["thickness_error"]
    assert error == pytest.approx(0.01, rel=0.05)  # of a root that is round


def test_sections_that_cross_are_named(blade):
    class Crossing(MinimumThickness):
        def __call__(self, profiles, chord):
            crossed = profiles.copy()
            crossed[3, 10:20, 1] -= 0.5
            return crossed

    check = checks.check_blade(blade.with_trailing_edge(Crossing()))
    assert len(check.problems) == 1
    assert "crosses itself" in check.problems[0]
    assert check.figures["sections_crossing"] == 1


def test_step_files_are_measured(blade, tmp_path):
    check = checks.check_file(bg.export(blade, tmp_path / "blade.step", sections=40))
    assert check.kind == "solid"
    assert check.problems == ()
    assert check.figures["faces"] == 5
    assert_allclose(check.figures["volume_m3"], blade.volume, rtol=1e-3)
    assert_allclose(check.figures["bounds_m"][1][2], 61.5, atol=0.05)


def test_an_open_shell_is_a_problem(tmp_path):
    import cadquery

    face = cadquery.Workplane().box(1, 1, 1).faces(">Z")
    cadquery.exporters.export(cadquery.Workplane(face.val()), str(tmp_path / "face.step"))
    check = checks.check_file(tmp_path / "face.step")
    assert "must be one solid" in check.problems
    assert "is not closed" in check.problems


@pytest.mark.parametrize("suffix", [".stl", ".glb", ".ply"])
def test_mesh_files_are_measured(blade, suffix, tmp_path):
    check = checks.check_file(bg.export(blade, tmp_path / f"blade{suffix}", stations=40))
    assert check.kind == "mesh"
    assert check.problems == ()
    assert check.figures["watertight"]
    assert check.figures["degenerate_triangles"] == 0


@pytest.mark.parametrize(
    ("spoil", "problem"),
    [
        (lambda f: f[1:], "is not watertight"),
        (lambda f: f[:, ::-1], "does not face outward throughout"),
        (lambda f: np.concatenate([f, [[0, 0, 1]]]), "has degenerate triangles"),
    ],
)
def test_broken_meshes_are_problems(blade, spoil, problem, tmp_path):
    made = mesh.from_blade(blade, stations=20)
    broken = mesh.TriangleMesh(made.vertices, spoil(np.array(made.faces)))
    mesh_files.to_trimesh(broken).export(tmp_path / "broken.ply")
    assert problem in checks.check_file(tmp_path / "broken.ply").problems


def test_what_cannot_be_checked_is_refused(tmp_path):
    with pytest.raises(FileError, match=r"suffix '.txt', allowed are .step"):
        checks.check_file(tmp_path / "a.txt")
    with pytest.raises(FileError, match="is no file"):
        checks.check_file(tmp_path / "a.stl")
    for suffix in (".stl", ".glb", ".ply", ".obj", ".3mf"):
        (tmp_path / f"junk{suffix}").write_bytes(b"nonsense" * 20)
        with pytest.raises(BladegenError, match="junk"):
            checks.check_file(tmp_path / f"junk{suffix}")


def test_a_held_twist_is_no_error(blade):
    turned = replace(blade.definition, twist=Distribution.constant(1.0))
    assert checks.check_blade(replace(blade, definition=turned)).figures["twist_error_deg"] < 1e-9


def test_the_twist_is_measured_on_the_points_that_are_written():
    blade = bg.Blade.from_definition(bg.read("dtu10mw"))
    t, space = [0.05, -0.04, 0.03, 0.02], bg.ShapeSpace.bundled()
    spans = np.linspace(0.0, 1.0, 41)
    assert np.degrees(np.abs(checks._twist_error(blade, spans)).max()) < 1e-9
    kept = blade.perturbed(space, t, twist=0.02)
    assert np.degrees(np.abs(checks._twist_error(kept, spans)).max()) < 0.02  # at two noses
    paper = blade.perturbed(space, t, twist=0.02, chord_line="paper")
    assert np.degrees(np.abs(checks._twist_error(paper, spans)).max()) > 0.3
