"""The IEA 15 MW and the DTU 10 MW from the figures of other tools' published files."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from published_formats import GOLDEN, column, hawc2, openfast, windio

import bladegen as bg
from bladegen.definition import estimates
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.conventions import slope_degrees
from bladegen.formats.reading import BY_AIRFOILS
from bladegen.support.arrays import Array


def line(definition: BladeDefinition, z: Array, fraction: float) -> Array:
    """The point at a fraction of the chord, by the formula of the published comparisons."""
    eta = np.interp(z, definition.axis.z.values, definition.axis.z.grid)
    chord, twist, axis = definition.chord(eta), definition.twist(eta), definition.axis(eta)
    ahead = fraction * chord - definition.offset_y(eta)
    return axis + np.stack([ahead * np.sin(twist), ahead * np.cos(twist), 0.0 * z], axis=-1)


def test_openfast_gives_the_bundled_blade_to_the_last_digits(tmp_path):
    made, bundled = bg.read(openfast(tmp_path)), bg.read("iea15mw")
    assert made.format == "OpenFAST"
    eta = made.chord.grid
    assert len(eta) == 50
    for name in ("chord", "twist"):
        assert_allclose(getattr(made, name)(eta), getattr(bundled, name)(eta), rtol=0, atol=1e-14)
    assert_allclose(made.offset_y(eta), bundled.offset_y(eta), rtol=0, atol=1e-14)
    axis, own = made.axis(eta), bundled.axis(eta)
    assert_allclose(axis[:, :2], own[:, :2], rtol=0, atol=1e-14)
    # BlSpn ends 0.07 mm before the tip, on purpose: the last node must not stand on it
    assert_allclose(axis[:, 2], own[:, 2], rtol=0, atol=6.9e-5)
    z = axis[:, 2]
    for fraction in (0.25, 0.5, 0.75):
        apart = line(made, z, fraction) - line(bundled, z, fraction)
        assert np.abs(apart).max() < 7e-5  # 0.07 mm of span, times the slope of the chord there


def test_the_main_input_leads_to_the_same_blade(tmp_path):
    blade = openfast(tmp_path)
    one, other = bg.read(blade), bg.read(tmp_path / "AeroDyn15.dat")
    assert_allclose(one.axis(one.chord.grid), other.axis(one.chord.grid), rtol=0, atol=0)
    assert [s.airfoil.name for s in one.stations] == [s.airfoil.name for s in other.stations]
    assert other.name == "AeroDyn15"


def test_a_given_folder_of_airfoils_is_taken_in_the_order_of_afid(tmp_path):
    blade = openfast(tmp_path)
    (tmp_path / "AeroDyn15.dat").unlink()
    one, other = bg.read(blade), bg.read(blade, airfoils=tmp_path / "Airfoils")
    assert one.stations[-1].airfoil.name == other.stations[-1].airfoil.name == "AF49_Coords"
    assert_allclose(one.axis(one.chord.grid), other.axis(one.chord.grid), rtol=0, atol=0)


def test_the_curve_angle_is_that_of_the_published_file():
    span, curve = (column("iea15mw/openfast_blade", name) for name in ("bl_spn_m", "bl_crv_ac_m"))
    published = column("iea15mw/openfast_blade", "bl_crv_ang_deg")
    assert_allclose(slope_degrees(curve, span), published, rtol=0, atol=0.03)


def test_our_aerodyn_file_has_the_published_figures_where_both_have_nodes(tmp_path):
    """With the published aerodynamic centres, the columns of the file are the published ones."""
    bundled = bg.read("iea15mw")
    reader = bg.read(openfast(tmp_path))
    path = tmp_path / "ours.dat"
    bg.write(bundled, path)
    ours = np.array([line.split()[:6] for line in path.read_text().splitlines()[6:]], dtype=float)
    span = column("iea15mw/openfast_blade", "bl_spn_m")[:-1]
    at = [int(np.argmin(np.abs(ours[:, 0] - z))) for z in span]
    z, _twist, chord = ours[at, 0], np.radians(ours[at, 4]), ours[at, 5]
    assert_allclose(z, span, rtol=0, atol=6.9e-5)
    for name, values in (("bl_twist_deg", ours[at, 4]), ("bl_chord_m", chord)):
        assert_allclose(values, column("iea15mw/openfast_blade", name)[:-1], rtol=0, atol=1e-13)
    # outboard both refer to the quarter chord
    outer = z > 0.6 * z[-1]
    for name, k in (("bl_crv_ac_m", 1), ("bl_swp_ac_m", 2)):
        published = column("iea15mw/openfast_blade", name)[:-1]
        assert_allclose(ours[at, k][outer], published[outer], rtol=0, atol=1e-13)
    assert reader.chord.grid.size == 50
    assert estimates.QUARTER == 0.25
    assert estimates.force_centre(0.2) == 0.25


def test_hawc2_gives_the_bundled_blade_within_its_interpolation(tmp_path):
    airfoils = GOLDEN / "iea15mw" / "airfoils"
    made, bundled = bg.read(hawc2(tmp_path, "iea15mw"), airfoils=airfoils), bg.read("iea15mw")
    assert made.format == "HAWC2"
    z = made.axis.z.values
    eta = z / z[-1]
    assert z[-1] == 117.0 == pytest.approx(bundled.length, abs=1e-12)
    assert np.degrees(np.abs(made.twist(eta) - bundled.twist(eta))).max() < 0.039
    # its twist is linear between the grid points that both have: there the digits agree
    own = np.interp(eta, bundled.twist.grid, bundled.twist.values)
    assert np.degrees(np.abs(made.twist(eta) - own)).max() < 5e-5
    for fraction in (0.25, 0.5):
        assert np.abs(line(made, z, fraction) - line(bundled, z, fraction)).max() < 2.1e-3
    assert_allclose(made.axis.x(eta), bundled.axis.x(eta), rtol=0, atol=1.4e-3)
    assert_allclose(made.axis.y(eta), 0.0, atol=0)
    ae = made.chord.grid
    apart = np.abs(made.chord(ae) - bundled.chord(ae))
    assert apart[ae < 0.99].max() < 4.2e-3
    assert apart.max() < 0.017  # at r = 116.5 m: that release has no grid points in the tip
    assert np.abs(made.relative_thickness(ae) - bundled.relative_thickness(ae)).max() < 1.1e-3
    named = {s.airfoil.name: s.eta for s in made.stations}
    for station in bundled.stations[2:8]:  # the outermost approaches its thickness too slowly
        assert abs(named[station.airfoil.name] - station.eta) < 4e-3


def test_hawc2_gives_the_dtu_blade_up_to_its_tip(tmp_path):
    airfoils = GOLDEN / "dtu10mw" / "airfoils"
    made, bundled = bg.read(hawc2(tmp_path, "dtu10mw"), airfoils=airfoils), bg.read("dtu10mw")
    z = made.axis.z.values
    inner = z < 0.97 * z[-1]
    eta = z / bundled.length
    assert np.degrees(np.abs(made.twist.values - bundled.twist(eta))).max() < 0.103
    half = np.abs(line(made, z, 0.5) - line(bundled, z, 0.5))
    assert half[:, 0].max() < 2.7e-3
    assert half[:, 1].max() < 9.1e-3
    assert_allclose(made.chord(eta[inner]), bundled.chord(eta[inner]), rtol=0, atol=0.01)


@pytest.mark.parametrize("turbine", ["iea15mw", "dtu10mw"])
def test_without_airfoils_the_message_says_what_to_give(tmp_path, turbine):
    with pytest.raises(bg.BladegenError, match=r"no folder turbine_htc_airfoils.*--airfoils DIR"):
        bg.read(hawc2(tmp_path, turbine))


@pytest.mark.parametrize("version", [1, 2])
def test_windio_gives_the_bundled_blade_to_the_last_digits(tmp_path, version):
    made, bundled = bg.read(windio(tmp_path / "turbine.yaml", version)), bg.read("iea15mw")
    assert made.format == f"windIO {version}"
    assert [str(finding) for finding in made.findings] == [str(BY_AIRFOILS)] * (version == 1)
    eta = np.union1d(bundled.chord.grid, np.linspace(0.0, 1.0, 501))
    for name, atol in (("chord", 0.0), ("twist", 1e-16), ("axis", 0.0)):
        mine, theirs = getattr(made, name)(eta), getattr(bundled, name)(eta)
        assert_allclose(mine, theirs, rtol=0, atol=atol)
    if version == 2:
        assert_allclose(
            made.relative_thickness(eta), bundled.relative_thickness(eta), rtol=0, atol=0
        )
    else:
        assert made.relative_thickness is None  # windIO 1 has none; the airfoils' own hold
    assert len(made.stations) == len(bundled.stations)
    for one, other in zip(made.stations, bundled.stations, strict=True):
        assert (one.eta, one.airfoil.name) == (other.eta, other.airfoil.name)
        assert one.airfoil.relative_thickness == other.airfoil.relative_thickness
        assert one.airfoil.aerodynamic_center == other.airfoil.aerodynamic_center
        assert_allclose(one.airfoil.coordinates, other.airfoil.coordinates, rtol=0, atol=0)


def test_the_axis_in_the_chord_of_windio_differs_between_points_alone(tmp_path):
    one, two = (bg.read(windio(tmp_path / f"{v}.yaml", v)) for v in (1, 2))
    bundled = bg.read("iea15mw")
    fine, points = np.linspace(0.0, 1.0, 5_001), one.pitch_axis.grid
    # a product of two splines is not the spline of the product, but at the points of both
    assert_allclose(one.offset_y(points), bundled.offset_y(points), rtol=0, atol=1e-14)
    assert np.abs(one.offset_y(fine) - bundled.offset_y(fine)).max() < 1.1e-3
    assert_allclose(two.offset_y(points), bundled.offset_y(points), rtol=0, atol=1e-14)
    inner = fine < 0.95
    assert_allclose(two.offset_y(fine[inner]), bundled.offset_y(fine[inner]), rtol=0, atol=1e-14)
    # the three points that only the chord has: there the published figure is of another spline
    assert np.abs(two.offset_y(fine) - bundled.offset_y(fine)).max() < 2e-4
