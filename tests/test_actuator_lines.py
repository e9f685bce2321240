"""Actuator lines against the blade's own sections, the rotor's placements and its polars."""

from dataclasses import replace

import numpy as np
import pytest
from foam_reading import parsed, rows
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.airfoils.polars import Polar
from bladegen.blade.planform import normal_to_z
from bladegen.cad.rotor import rotor_of
from bladegen.cli.commands import app
from bladegen.definition.blade_definition import Station
from bladegen.errors import ExportError
from bladegen.exports import inventory
from bladegen.formats.actuator_lines.elements import ELEMENTS
from bladegen.formats.writing import write

ALPHA = np.radians(np.linspace(-180.0, 180.0, 25))


@pytest.fixture(scope="module")
def definition():
    """The IEA 15 MW, each airfoil with a polar that tells which it is."""
    found = bg.read("iea15mw")
    names = sorted({s.airfoil.name for s in found.stations})

    def known(airfoil):
        k = 1.0 + names.index(airfoil.name)
        polar = Polar(ALPHA, k * np.sin(ALPHA), 0.01 * k + 0 * ALPHA, -0.1 * k + 0 * ALPHA, 1e7)
        return replace(airfoil, polars=(polar,), aerodynamic_center=0.25)

    stations = tuple(Station(s.eta, known(s.airfoil)) for s in found.stations)
    return replace(found, stations=stations)


@pytest.fixture(scope="module")
def foam(definition, tmp_path_factory):
    folder = tmp_path_factory.mktemp("foam") / "al"
    write(definition, folder, format="turbinesfoam")
    return folder


@pytest.fixture(scope="module")
def sowfa(definition, tmp_path_factory):
    folder = tmp_path_factory.mktemp("sowfa") / "sow"
    write(definition, folder, format="sowfa")
    return folder


def turned(vectors, axis, angle):
    """Vectors turned by the right hand about an axis."""
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    along = np.sum(vectors * axis, axis=-1, keepdims=True)
    return c * vectors + s * np.cross(axis, vectors) + (1 - c) * along * axis


@pytest.fixture(scope="module")
def placed(definition):
    """Leading edge and middle of the trailing edge at the elements' ends, rotor frame."""
    blade = bg.Blade.from_definition(definition, landmarks=201, planes=normal_to_z)
    span = definition.axis(np.linspace(0, 1, 4001))[:, 2]
    eta = np.interp(np.linspace(0, span[-1], ELEMENTS + 1), span, np.linspace(0, 1, 4001))
    sections = blade.sections(eta)
    rotation, shift = (part[0] for part in rotor_of(blade).placements())
    edges = np.stack([sections[:, 100], 0.5 * (sections[:, 0] + sections[:, -1])])
    return edges @ rotation.T + shift


def test_elements_lie_on_the_quarter_chord_of_the_sections(foam, placed):
    axial, radius, azimuth, chord, mount, _ = np.array(rows(foam / "elementData")).T
    up = np.tile([0.0, 0.0, 1.0], (len(axial), 1))
    points = radius[:, None] * turned(up, np.array([1.0, 0, 0]), np.radians(azimuth))
    points[:, 0] += axial
    nose, tail = placed
    assert_allclose(points, nose + 0.25 * (tail - nose), atol=0.02)  # thick noses lie aside
    assert_allclose(chord, np.linalg.norm(tail - nose, axis=1), rtol=1e-3)
    assert set(mount) == {0.25}


def test_pitch_turns_the_leading_edge_where_the_section_has_it(foam, placed):
    _, _, azimuth, _, _, pitch = np.array(rows(foam / "elementData")).T
    axis = np.array([1.0, 0.0, 0.0])
    forward = np.tile(np.cross(axis, [0.0, 0.0, 1.0]), (len(pitch), 1))
    chord = turned(forward, axis, np.radians(azimuth))
    span = turned(np.tile([0.0, 0.0, 1.0], (len(pitch), 1)), axis, np.radians(azimuth))
    chord = np.array(
        [
            turned(c[None], s, p[None])[0]
            for c, s, p in zip(chord, span, np.radians(pitch), strict=True)
        ]
    )
    nose, tail = placed
    ahead = (nose - tail) / np.linalg.norm(nose - tail, axis=1, keepdims=True)
    outboard = slice(ELEMENTS // 4, None)
    assert_allclose(chord[outboard, 0], ahead[outboard, 0], atol=6e-3)  # thick noses lie aside
    assert np.sum(chord * ahead, axis=1)[outboard].min() > 0.999
    assert pitch[0] < -15.0
    assert ahead[0, 0] < -0.25  # its leading edge is turned to the wind


def test_profiles_name_tables_that_hold_the_blended_polar(definition, foam):
    words = [w for w in (foam / "elementProfiles").read_text().splitlines() if w[:2] != "//"]
    data = parsed((foam / "profileData").read_text())
    assert len(words) == ELEMENTS
    assert set(words) == set(data)
    assert words[0].startswith("circular")
    assert words[-1] == "FFA-W3-211"
    table = np.array(rows(foam / words[-1]))
    tip = definition.stations[-1].airfoil.polars[0]
    assert_allclose(table.T, [np.degrees(tip.alpha), tip.cl, tip.cd, tip.cm], atol=1e-8)
    assert data[words[-1]] == {"Re": 1e7, "data": ["#include", words[-1]]}
    drags = [np.array(rows(foam / word))[0, 2] for word in words]
    names = sorted({s.airfoil.name for s in definition.stations})
    own = [0.01 * (1 + names.index(s.airfoil.name)) for s in definition.stations]
    assert min(own) <= min(drags) <= max(drags) <= max(own)


def test_sowfa_has_the_figures_of_the_definition(definition, sowfa):
    turbine = parsed((sowfa / "turbineProperties" / "iea15mw").read_text())
    rotor = definition.rotor
    assert (turbine["NumBl"], turbine["HubRad"]) == (3, rotor.hub_radius)
    assert_allclose(turbine["TipRad"], rotor.hub_radius + definition.length, atol=1e-9)
    assert_allclose(turbine["PreCone"], [-np.degrees(rotor.cone)] * 3, rtol=1e-8)
    assert_allclose(turbine["ShftTilt"], -np.degrees(rotor.tilt), rtol=1e-8)
    radius, chord, twist, airfoil = np.array(turbine["BladeData"]).T
    eta = np.interp(
        radius - rotor.hub_radius,
        definition.axis(np.linspace(0, 1, 4001))[:, 2],
        np.linspace(0, 1, 4001),
    )
    assert_allclose(chord, definition.chord(eta), atol=1e-5)
    assert_allclose(np.radians(twist), definition.twist(eta), atol=1e-6)
    assert_allclose(np.diff(radius), definition.length / ELEMENTS, rtol=1e-6)
    names = turbine["Airfoils"]
    assert set(airfoil) == set(range(len(names)))
    assert {p.name for p in (sowfa / "airfoilProperties").iterdir()} == set(names)
    table = np.array(parsed((sowfa / "airfoilProperties" / names[-1]).read_text())["airfoilData"])
    tip = definition.stations[-1].airfoil.polars[0]
    assert_allclose(table.T, [np.degrees(tip.alpha), tip.cl, tip.cd], atol=1e-8)


def test_the_advanced_model_has_thickness_before_the_airfoil(definition, sowfa):
    plain, advanced = (
        np.array(parsed((sowfa / "turbineProperties" / name).read_text())["BladeData"])
        for name in ("iea15mw", "iea15mw_advanced")
    )
    assert np.array_equal(plain, advanced[:, [0, 1, 2, 5]])
    assert_allclose([advanced[0, 3], advanced[-1, 3]], [1.0, 0.21], atol=0.01)
    assert definition.rotor.hub_radius < plain[0, 0]


def test_files_say_what_they_are_made_from(tmp_path, definition):
    from bladegen.exports.definitions import write as write_marked

    write_marked(definition, tmp_path / "al", format="turbinesfoam", command="bladegen convert")
    write_marked(definition, tmp_path / "sow", format="sowfa")
    for file in ("al/elementData", "al/FFA-W3-211", "sow/turbineProperties/iea15mw"):
        assert inventory.made_by(tmp_path / file).blade == "iea15mw"


@pytest.mark.parametrize("name", ["turbinesfoam", "sowfa"])
def test_what_is_missing_is_one_line_that_tells_what_to_type(definition, name, tmp_path):
    with pytest.raises(ExportError, match=r"needs polars.* --polars estimate makes some"):
        write(bg.read("iea15mw"), tmp_path / "a", format=name)
    bare = replace(definition, rotor=replace(definition.rotor, hub_radius=None))
    with pytest.raises(ExportError, match=r"names no hub radius; give one \(--hub-radius LENGTH"):
        write(bare, tmp_path / "b", format=name)
    assert not any(tmp_path.iterdir())


def test_convert_takes_a_hub_radius(definition, tmp_path):
    bg.write(definition, tmp_path / "blade.yaml")
    words = ["convert", str(tmp_path / "blade.yaml"), str(tmp_path / "sow")]
    app([*words, "--to", "sowfa", "--hub-radius", "2m"], standalone_mode=False)
    turbine = parsed((tmp_path / "sow" / "turbineProperties" / "blade").read_text())
    assert turbine["HubRad"] == 2.0
    assert_allclose(turbine["TipRad"], 2.0 + definition.length, atol=1e-6)
