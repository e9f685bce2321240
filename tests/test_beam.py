"""Beam properties as files of ElastoDyn and BeamDyn, and the modes that these need."""

import csv
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import bladegen as bg
from bladegen.blade.layup.beam.modes import POWERS, bending, polynomial, torsion
from bladegen.blade.layup.beam.properties import BeamProperties
from bladegen.cli import commands
from bladegen.errors import ExportError, MissingLibraryError
from bladegen.exports import marks
from bladegen.exports.build import build
from bladegen.exports.options import Options
from bladegen.exports.products import Products
from bladegen.exports.registry import FORMATS
from bladegen.formats.openfast.beams import DAMPING, frequencies

ROOTS = np.array([1.875104069, 4.694091133, 7.854757438])  # of cos x cosh x = -1
GOLDEN = Path(__file__).parent / "golden" / "iea15mw" / "elastodyn_blade.csv"
SUFFIXES = ("elastodyn_blade.dat", "beamdyn_blade.dat", "beamdyn.dat", "beam.csv")


@pytest.fixture(scope="module")
def beam():
    """The published table of the IEA 15 MW, on an axis that bends upwind, with made-up matrices."""
    with GOLDEN.open(newline="") as stream:
        rows = np.array([[*map(float, row)] for row in [*csv.reader(stream)][1:]])
    eta, pitch_axis, twist, mass, flap, edge = rows.T
    axis = np.stack([-4.0 * eta**2, 0.0 * eta, 117.0 * eta], axis=-1)
    rng = np.random.default_rng(3)
    halves = rng.normal(size=(2, len(eta), 6, 6))
    stiffness, inertia = halves + np.swapaxes(halves, 2, 3) + 20.0 * np.eye(6)
    return BeamProperties(
        eta, axis, pitch_axis, twist, mass, flap, edge, 0.1 * edge, 1e9 * mass, stiffness, inertia
    )


@pytest.fixture
def solved(monkeypatch, beam):
    """WISDEM's answer without WISDEM."""
    monkeypatch.setattr("bladegen.exports.products.beam_properties", lambda _: beam)
    monkeypatch.setattr("bladegen.exports.products.require_solver", lambda: None)


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("iea15mw"), landmarks=51)


@given(st.floats(1.0, 200.0), st.floats(1e3, 1e12), st.floats(0.1, 1e4))
def test_an_even_beam_swings_as_the_textbook_has_it(length, stiff, mass):
    along, even = np.array([0.0, 0.3, 1.0]) * length, np.ones(3)
    found, shapes = bending(along, stiff * even, mass * even, 3)
    wanted = ROOTS**2 / (2.0 * np.pi * length**2) * np.sqrt(stiff / mass)
    assert_allclose(found, wanted, rtol=1e-5)
    wanted_torsion = np.sqrt(stiff / mass) / (4.0 * length)
    assert_allclose(torsion(along, stiff * even, mass * even), wanted_torsion, rtol=1e-4)
    assert_allclose(shapes[:, -1], 1.0)
    for root, shape in zip(ROOTS, shapes, strict=True):
        x = root * np.linspace(0.0, 1.0, shapes.shape[1])
        share = (np.cosh(root) + np.cos(root)) / (np.sinh(root) + np.sin(root))
        exact = np.cosh(x) - np.cos(x) - share * (np.sinh(x) - np.sin(x))
        assert_allclose(shape, exact / exact[-1], atol=2e-4)


def test_a_wedge_swings_as_kirchhoff_found():
    """A wedge of linear width and even height: f = 7.16 sqrt(EI / m) / (2 pi L^2)."""
    along = np.linspace(0.0, 2.0, 40)
    share = 1.0 - along / 2.0 + 1e-6
    found, _ = bending(along, 5.0 * share, 3.0 * share, 1)
    assert_allclose(found, 7.157 / (2.0 * np.pi * 4.0) * np.sqrt(5.0 / 3.0), rtol=1e-3)


@given(st.lists(st.floats(-3.0, 3.0), min_size=4, max_size=4))
def test_a_polynomial_is_found_again(factors):
    wanted = np.append(factors, 1.0 - sum(factors))
    shape = np.linspace(0.0, 1.0, 201)[:, None] ** POWERS @ wanted
    assert_allclose(polynomial(shape), wanted, atol=1e-6)


def test_the_iea_15_mw_has_the_frequencies_of_its_table(beam):
    """0.525 and 0.714 Hz with its twist (docs/structure.md)."""
    flap, edge, twisted = frequencies(beam)
    assert_allclose([flap, edge], [0.54, 0.73], rtol=0.04)
    assert twisted > 1.0 / 117.0


def numbers(line):
    return [float(word) for word in line.split()]


def entries(lines):
    """What lines such as ``1.0  AdjBlMs - ...`` say, by name."""
    said = [line.split(" - ")[0].rsplit(maxsplit=1) for line in lines if " - " in line]
    return {name: value for value, name in (pair for pair in said if len(pair) == 2)}


@pytest.mark.parametrize("version", [4, 5])
def test_files_hold_the_beam(beam, blade, solved, tmp_path, version):
    products = Products(blade, Options(openfast=version))
    for suffix in SUFFIXES:
        bg.exports.exporters.write(products, tmp_path / f"a.{suffix}")
    lines = {name: (tmp_path / f"a.{name}").read_text().splitlines() for name in SUFFIXES}
    count = len(beam.eta)
    for name in SUFFIXES[:3]:
        assert lines[name][0].startswith("---")
        assert max(map(len, lines[name][2:])) < 200

    found = lines["elastodyn_blade.dat"]
    told = entries(found)
    assert int(told["NBlInpSt"]) == count
    assert float(told["BldEdDmp1"]) == DAMPING
    assert found[3].split()[1] == "NBlInpSt"
    table = np.array([numbers(line) for line in found[16 : 16 + count]])
    columns = [beam.eta, beam.pitch_axis, beam.twist, beam.mass, beam.flap, beam.edge]
    wanted = np.stack(columns if version == 4 else [columns[0], *columns[2:]], axis=-1)
    assert_allclose(table, wanted, rtol=1e-8, atol=1e-12)
    assert found[14].split() == [
        *("BlFract", *["PitchAxis"] * (version == 4), "StrcTwst", "BMassDen", "FlpStff", "EdgStff")
    ]
    for name in ("BldFl1Sh", "BldFl2Sh", "BldEdgSh"):
        assert_allclose(sum(float(told[f"{name}({i})"]) for i in range(2, 7)), 1.0, atol=1e-8)

    found = lines["beamdyn_blade.dat"]
    assert numbers(found[8])[1] == numbers(found[8])[3]  # edgewise
    start = 10 + 3 * (version == 5)
    assert found[start - 1].startswith("---------------------- DISTRIBUTED")
    rows = [numbers(line) for line in found[start:]]
    assert [len(row) for row in rows] == [1, *[6] * 6, 0, *[6] * 6, 0] * count
    places = np.array(rows[::15], dtype=float)[:, 0]
    assert (places[0], places[-1]) == (0.0, 1.0)
    assert all(one < two for one, two in pairwise(places))
    for k in (0, count // 2, count - 1):
        assert_allclose(rows[15 * k + 1 : 15 * k + 7], beam.stiffness[k], rtol=1e-8)
        assert_allclose(rows[15 * k + 8 : 15 * k + 14], beam.inertia[k], rtol=1e-8)

    found = lines["beamdyn.dat"]
    told = entries(found)
    assert told["BldFile"] == '"a.beamdyn_blade.dat"'
    assert ("UsePitchAct" in told) == (version == 4)
    heads = next(k for k, line in enumerate(found) if "kp_xr" in line)
    points = np.array([numbers(line) for line in found[heads + 2 : heads + 2 + count]])
    assert_allclose(points, np.column_stack([beam.axis, beam.twist]), rtol=1e-8, atol=1e-12)

    names, _, *rows = csv.reader(lines["beam.csv"])
    table = np.array(rows, dtype=float)
    assert_allclose(table[:, names.index("flap_Nm2")], beam.flap, rtol=1e-8)
    assert_allclose(table[:, names.index("K34")], beam.stiffness[:, 2, 3], rtol=1e-8)
    for suffix in SUFFIXES:
        made = products.made_from(FORMATS[f".{suffix}"].kind, f".{suffix}")
        assert marks.read(tmp_path / f"a.{suffix}") == made
        assert ("openfast", str(version)) in made.settings


def test_a_build_reports_on_the_beam(beam, blade, solved, tmp_path):
    report = build(blade, tmp_path, formats=SUFFIXES)
    assert report["beam"]["mass_kg"] == pytest.approx(beam.whole_mass)
    assert report["beam"]["mass_of_layers_kg"] == pytest.approx(blade.layup.mass)
    assert report["beam"]["flap_hz"] == pytest.approx(frequencies(beam)[0])
    assert [one for one in report["remarks"] if "damping is no result" in one] != []


def test_without_wisdem_nothing_is_made_and_it_is_said_what_to_install(
    blade, tmp_path, monkeypatch
):
    monkeypatch.setattr("bladegen.blade.layup.beam.precomp.find_spec", lambda _: None)
    with pytest.raises(MissingLibraryError, match=r"pip install 'bladegen\[wisdem\]'"):
        build(blade, tmp_path, formats=["stl", "beamdyn.dat"])
    assert list(tmp_path.iterdir()) == []
    asked = ["build", "iea15mw", "-o", str(tmp_path / "out"), "--format", "elastodyn_blade.dat"]
    done = CliRunner().invoke(commands.app, asked)
    assert done.exit_code == 1
    assert "bladegen[wisdem]" in str(done.exception or done.output)


def test_what_cannot_be_is_said(blade, tmp_path):
    with pytest.raises(ExportError, match="openfast: got 3, allowed are 5, and 4"):
        Options(openfast=3)
    bare = bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=51)
    with pytest.raises(ExportError, match="no webs and layers, of which a table of beam prop"):
        build(bare, tmp_path, formats=["beam.csv"])
