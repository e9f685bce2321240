import pickle
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from bladegen.airfoils.landmarks import landmarks
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.blade import Blade
from bladegen.blade.edges import AsGiven
from bladegen.blade.planform import normal_to_z
from bladegen.definition.blade_definition import Distribution
from bladegen.errors import DefinitionError
from bladegen.exports.exporters import export
from bladegen.formats.bundled import bundled
from bladegen.formats.reading import read
from bladegen.measures.properties import volume
from bladegen.shapes import affine
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.surface.tips import round_tip
from strategies import SEEDS, definitions, few

N = 101
PATHS = st.sampled_from(["geodesic", "spline"])
SPANS = np.linspace(0, 1, 41)
NAMES = pytest.mark.parametrize("name", bundled())


def unit_chord(blade):
    """The stations' airfoils by their landmarks, brought to unit chord."""
    shapes = np.stack(
        [landmarks(s.airfoil.coordinates, len(blade.u)) for s in blade.definition.stations]
    )
    return shapes / SectionSplines(blade.u).fit(shapes).chord[:, None, None]


@given(definitions(thickness=False), PATHS)
def test_a_blade_passes_through_its_stations(definition, path):
    blade = Blade.from_definition(definition, landmarks=N, path=path, fairing=None)
    assert_allclose(blade.profiles(blade.eta), unit_chord(blade), atol=1e-11)


@given(definitions(thickness=False), PATHS)
def test_a_faired_blade_passes_through_its_faired_stations(definition, path):
    blade = Blade.from_definition(definition, landmarks=N, path=path)
    faired = np.stack([curve.landmarks(blade.u) for curve in blade.contours])
    faired = faired / SectionSplines(blade.u).fit(faired).chord[:, None, None]
    assert_allclose(blade.profiles(blade.eta), faired, atol=1e-11)
    along = np.gradient(faired, axis=1)
    away = unit_chord(blade) - faired
    off = along[..., 0] * away[..., 1] - along[..., 1] * away[..., 0]
    off /= np.linalg.norm(along, axis=-1)
    assert np.abs(off).max() < 3e-5  # between points their splines differ by more than at them


@given(definitions(thickness=True), PATHS)
def test_with_a_thickness_distribution_up_to_a_stretch(definition, path):
    blade = Blade.from_definition(definition, landmarks=N, path=path, fairing=None)
    profiles, airfoils = blade.profiles(blade.eta), unit_chord(blade)
    X, Y = affine.standardise(profiles)[0], affine.standardise(airfoils)[0]
    assert_allclose(X @ X.mT, Y @ Y.mT, atol=1e-10)


@given(definitions(), PATHS)
def test_chord_and_thickness_are_those_of_the_definition(definition, path):
    blade = Blade.from_definition(definition, landmarks=N, path=path)
    curves = SectionSplines(blade.u).fit(blade.profiles(SPANS))
    assert_allclose(curves.chord, 1.0, atol=1e-9)
    assert_allclose(blade.chord(SPANS), definition.chord(SPANS), atol=0)
    assert_allclose(blade.twist(SPANS), definition.twist(SPANS), atol=0)
    if definition.relative_thickness is not None:
        wanted = definition.relative_thickness(SPANS)
        assert_allclose(curves.relative_thickness, wanted, atol=1e-9)


@given(definitions(thickness=False), PATHS)
def test_between_identical_neighbours_nothing_changes(definition, path):
    blade = Blade.from_definition(definition, landmarks=N, path=path)
    circles = blade.profiles(np.linspace(0, blade.eta[1], 9))
    assert_allclose(circles, np.broadcast_to(circles[:1], circles.shape), atol=1e-12)


@given(definitions(), PATHS, SEEDS)
def test_results_do_not_depend_on_representatives(definition, path, seed):
    blade = Blade.from_definition(definition, landmarks=N, path=path)
    turns = np.linalg.qr(np.random.default_rng(seed).normal(size=(len(blade.eta), 2, 2))).Q
    turns[:, :, 0] *= np.linalg.det(turns)[:, None]
    turned = replace(blade, representatives=blade.representatives @ turns, M=turns.mT @ blade.M)
    assert_allclose(turned.profiles(SPANS), blade.profiles(SPANS), atol=1e-9)


@given(definitions(), PATHS)
def test_a_batch_equals_its_parts(definition, path):
    blade = Blade.from_definition(definition, landmarks=N, path=path)
    whole, profiles = blade.sections(SPANS), blade.profiles(SPANS)
    assert_allclose(blade.sections(SPANS.reshape(-1, 1))[:, 0], whole, atol=0)
    for i in (0, 7, 40):
        assert_allclose(blade.sections(SPANS[i]), whole[i], atol=1e-11)
        assert_allclose(blade.profiles(SPANS[i : i + 1])[0], profiles[i], atol=1e-11)


@given(definitions(), PATHS)
def test_points_between_landmarks_lie_on_the_same_sections(definition, path):
    blade = Blade.from_definition(definition, landmarks=N, path=path)
    finer = np.sort(np.concatenate([blade.u, 0.5 * (blade.u[1:] + blade.u[:-1])]))
    assert_allclose(blade.sections(SPANS, finer)[:, ::2], blade.sections(SPANS), atol=1e-8)
    by_splines = replace(blade, contours=None)
    assert_allclose(by_splines.sections(SPANS, finer), blade.sections(SPANS, finer), atol=0.05)


@settings(max_examples=few(15))
@given(definitions(), st.integers(20, 90))
def test_stations_hold_what_they_must_and_increase(definition, count):
    blade = Blade.from_definition(definition, landmarks=N)
    stations = blade.stations(count)
    assert len(stations) == count
    assert np.all(np.diff(stations) > 0)
    assert {0.0, 1.0, *blade.eta} <= set(stations)


def test_stations_crowd_where_the_blade_bends():
    blade = Blade.from_definition(read("iea15mw"), landmarks=N)
    stations = blade.stations(200)
    assert np.median(np.diff(stations[stations < 0.2])) < np.median(np.diff(stations))
    middle = 0.5 * (stations[1:] + stations[:-1])
    straight = 0.5 * (blade.sections(stations[1:]) + blade.sections(stations[:-1]))
    even = np.linspace(0, 1, 200)
    evenly = 0.5 * (blade.sections(even[1:]) + blade.sections(even[:-1]))
    error = np.abs(blade.sections(middle) - straight).max()
    assert error < np.abs(blade.sections(0.5 * (even[1:] + even[:-1])) - evenly).max()


def test_a_straight_prism_gets_even_stations():
    definition = read("nrel5mw")
    flat = Distribution.constant
    cylinder = replace(
        definition,
        stations=tuple(replace(definition.stations[1], eta=eta) for eta in (0.0, 1.0)),
        chord=flat(3.0),
        twist=flat(0.0),
        relative_thickness=None,
        section_offset_y=flat(1.5),
        axis=replace(definition.axis, z=Distribution(np.array([0.0, 1.0]), np.array([0.0, 9.0]))),
    )
    stations = Blade.from_definition(cylinder, landmarks=N).stations(11)
    assert np.diff(stations).max() < 1.01 * np.diff(stations).min()


@NAMES
@pytest.mark.parametrize("path", ["geodesic", "spline"])
def test_reference_blades_meet_the_design(name, path):
    definition = read(name)
    blade = Blade.from_definition(definition, path=path)
    eta = np.random.default_rng(5).uniform(0, 1, 100)
    curves = SectionSplines(blade.u).fit(blade.profiles(eta))
    assert_allclose(curves.chord, 1.0, atol=1e-9)
    assert_allclose(curves.relative_thickness, definition.relative_thickness(eta), atol=1e-9)
    bare = replace(definition, relative_thickness=None)
    plain = Blade.from_definition(bare, path=path, fairing=None)
    assert_allclose(plain.profiles(plain.eta), unit_chord(plain), atol=1e-9)


@NAMES
def test_trailing_edges_keep_their_minimum(name):
    blade = Blade.from_definition(read(name))
    sections = blade.sections(SPANS)
    gap = np.linalg.norm(sections[:, 0] - sections[:, -1], axis=1)
    assert gap.min() > 0.002 - 1e-9
    given_ = blade.with_trailing_edge(AsGiven()).sections(SPANS)
    moved = np.linalg.norm(given_ - sections, axis=-1)
    assert moved.max() < 0.001 + 1e-9


def test_findings_name_the_blunt_base_and_thickness_that_disagrees():
    iea = Blade.from_definition(read("iea15mw"), landmarks=N)
    assert any("SNL-FFA-W3-500" in str(f) and "blunt base" in str(f) for f in iea.findings)
    nrel = Blade.from_definition(read("nrel5mw"), landmarks=N)
    assert any("DU40_A17" in str(f) and "0.405" in str(f) for f in nrel.findings)


def test_arrays_of_a_blade_cannot_be_written():
    blade = Blade.from_definition(read("nrel5mw"), landmarks=N)
    for field in ("u", "eta", "representatives", "M", "b"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(blade, field)[0] = 0.0


def test_wrong_values_are_refused():
    definition = read("nrel5mw")
    with pytest.raises(DefinitionError, match="path: got 'cubic', allowed are spline, geodesic"):
        Blade.from_definition(definition, path="cubic")
    blade = Blade.from_definition(definition, landmarks=N)
    for bad in (-0.1, 1.1, np.nan):
        with pytest.raises(DefinitionError, match=r"allowed is 0 \(root\) to 1 \(tip\)"):
            blade.sections([0.5, bad])
    with pytest.raises(DefinitionError, match="at least 9 are needed"):
        blade.stations(8)


def test_a_variant_shares_what_its_perturbation_does_not_touch():
    blade = Blade.from_definition(read("dtu10mw"), landmarks=N)
    space = ShapeSpace.bundled()
    sections, frames = blade.sections(SPANS), blade.planform.frames
    deformed = blade.perturbed(space, [0.01, 0.0, 0.0, 0.0], thickness=1.02, name="other")
    assert deformed.shape is not blade.shape
    assert deformed.shape.loft is blade.shape.loft
    assert deformed.planform.frames is frames
    wider = blade.perturbed(chord=1.1)
    assert wider.shape.loft is blade.shape.loft
    assert wider.planform.frames is frames
    bent = blade.perturbed(prebend_scale=2.0)
    assert bent.planform.frames is not frames
    assert bent.shape is blade.shape
    assert blade.mirror_image().planform is blade.planform
    assert np.array_equal(blade.sections(SPANS), sections)


def test_parts_of_a_blade_are_changed_by_name_and_one_thickness_rules():
    blade = Blade.from_definition(read("dtu10mw"), landmarks=N)
    bare = replace(blade, edge_width=None)
    assert bare.shape.loft.edge_width is None
    assert bare.planform is blade.planform
    flat = replace(blade, planes=normal_to_z)
    assert flat.planes is normal_to_z
    assert flat.shape is blade.shape
    definition = replace(blade.definition, relative_thickness=None)
    free = replace(blade, definition=definition)
    assert free.definition is definition
    assert free.shape.loft.relative_thickness is None
    assert free.wanted_thickness(SPANS) is None
    with pytest.raises(TypeError, match="unexpected keyword argument 'edge'"):
        replace(blade, edge=None)


def test_pickles_hold_no_caches():
    blade = Blade.from_definition(read("dtu10mw"), landmarks=N)
    before = pickle.dumps(blade)
    sections = blade.sections(SPANS)
    blade.stations()
    assert len(pickle.dumps(blade)) < len(before) + 20_000  # splines of distributions alone
    again = pickle.loads(before)
    assert np.array_equal(again.sections(SPANS), sections)
    assert not {"splines", "parameter", "_joined", "_widths"} & set(
        vars(pickle.loads(before).shape.loft)
    )


@pytest.mark.parametrize("mirrored", [False, True])
def test_points_lie_where_sections_have_them(mirrored):
    blade = Blade.from_definition(read("nrel5mw"), landmarks=N)
    blade = blade.mirror_image() if mirrored else blade
    eta = np.array([0.9, 0.2, 0.5])
    assert_allclose(blade.point(eta[:, None], blade.u), blade.sections(eta), atol=1e-9)
    assert blade.point(0.5, 0.25).shape == (3,)
    assert blade.point(eta, [0.1, 0.7, 0.7]).shape == (3, 3)
    pairs = blade.point(eta, [0.1, 0.7, 0.5])
    assert_allclose(pairs[1], blade.point(0.2, 0.7), atol=1e-9)
    for wrong in ({"eta": 1.1, "u": 0.5}, {"eta": 0.5, "u": -0.1}, {"eta": 0.5, "u": "nose"}):
        with pytest.raises(DefinitionError):
            blade.point(**wrong)


def test_a_blade_meshes_writes_and_measures_itself(tmp_path):
    blade = Blade.from_definition(read("nrel5mw"), landmarks=N)
    made = blade.mesh(stations=150)
    assert isinstance(made, trimesh.Trimesh)
    assert made.is_watertight
    assert_allclose(made.volume, blade.volume, rtol=3e-3)
    assert_allclose(made.bounds[1, 2], blade.axis(1.0)[2], atol=0.1)
    assert blade.volume == volume(blade)
    assert len(blade.mesh(stations=20, tip=round_tip).faces) > len(blade.mesh(stations=20).faces)
    assert blade.export(tmp_path / "a.stl", stations=20, unit="mm") == tmp_path / "a.stl"
    export(blade, tmp_path / "b.stl", stations=20, unit="mm")
    assert (tmp_path / "a.stl").read_bytes() == (tmp_path / "b.stl").read_bytes()
