"""Rotors as one body: fused, or the sector of one blade."""

import json
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common
from typer.testing import CliRunner

from bladegen.blade.blade import Blade
from bladegen.cad import exchange, rotor_body, shapes, solids
from bladegen.cad.rotor import location, rotor_of, spinner
from bladegen.cli.commands import app
from bladegen.errors import CadError
from bladegen.formats.reading import read

CUBIC = shapes.MILLIMETRES**3


@pytest.fixture(scope="module")
def blade():
    return Blade.from_definition(read("dtu10mw"), landmarks=41)


@pytest.fixture(scope="module")
def solid(blade):
    return solids.solid(blade, sections=20)


@pytest.fixture(scope="module")
def rotor(blade):
    return rotor_of(blade, hub_radius=2.8)


@pytest.fixture(scope="module")
def whole(rotor, solid):
    return rotor_body.fused(rotor, solid)


@pytest.fixture(scope="module")
def third(rotor, solid):
    return rotor_body.sector(rotor, solid)


def test_what_lay_in_two_parts_is_counted_once(rotor, solid, whole):
    """OCCT's own intersection of a blade and the spinner is what the fused body lacks, by blade."""
    rotation, shift = (values[0] for values in rotor.placements())
    blade = solid.part.shape.Moved(location(rotation, shift))
    common = BRepAlgoAPI_Common(spinner(rotor.spinner_radius), blade).Shape()
    assert_allclose(whole.overlap, 3.0 * shapes.volume(common) / CUBIC, rtol=1e-3)
    assert 20.0 < whole.overlap < 100.0


def test_a_sector_is_its_share_of_the_rotor(whole, third):
    assert_allclose(3.0 * third.volume, whole.volume, rtol=1e-6)


def test_both_cuts_are_the_same_outline_turned(third):
    mesh = third.mesh(0.02)
    first, second = (
        mesh.vertices[np.unique(mesh.faces[mesh.regions == third.regions.index(cut)])]
        for cut in rotor_body.CUTS
    )
    for points, sign in ((first, 1.0), (second, -1.0)):
        assert_allclose(
            np.arctan2(points[:, 1], points[:, 2])[points[:, 2] > 0.1], sign * np.pi / 3
        )
    outlines = [
        np.sort(np.hypot(points[:, 1], points[:, 2]).round(6)) for points in (first, second)
    ]
    assert_allclose(outlines[0][[0, -1]], outlines[1][[0, -1]], atol=1e-6)
    assert_allclose(np.ptp(first[:, 0]), np.ptp(second[:, 0]), atol=1e-9)


@pytest.mark.parametrize("kind", ["whole", "third"])
def test_files_hold_one_valid_solid_and_a_closed_surface_by_region(kind, tmp_path, request):
    body = request.getfixturevalue(kind)
    body.write_step(tmp_path / "a.step")
    again = exchange.read(tmp_path / "a.step")
    assert len(shapes.members(again, "solid")) == 1
    assert shapes.is_valid(again)
    assert_allclose(shapes.volume(again) / CUBIC, body.volume, rtol=1e-6)
    text = (tmp_path / "a.step").read_text()
    assert all(f"'{name}'" in text for name in body.regions)
    body.write_regions(tmp_path / "a.stl", deflection=0.02)
    rows = (tmp_path / "a.stl").read_text().splitlines()
    named = [row.removeprefix("solid ") for row in rows if row.startswith("solid ")]
    assert named == [name.replace(" ", "_") for name in body.regions]
    assert len(named) == len(set(named))
    surface = trimesh.load_mesh(tmp_path / "a.stl")
    surface.merge_vertices()
    assert surface.is_watertight
    assert surface.is_winding_consistent
    assert abs(surface.volume - body.volume) < 0.02 * surface.area


def test_a_mirrored_rotor_is_as_large(rotor, solid, whole):
    mirrored = rotor_body.fused(replace(rotor, mirrored=True), solid)
    assert_allclose(mirrored.volume, whole.volume, rtol=1e-6)
    assert mirrored.regions == whole.regions


def test_what_cannot_be_is_said(blade, rotor, solid):
    with pytest.raises(CadError, match=r"reaches .* deg to one side, allowed is 60"):
        rotor_body.sector(replace(rotor, hub_radius=0.5, spinner_radius=3.0), solid)
    with pytest.raises(CadError, match="a rotor of one blade has no sector"):
        rotor_body.sector(replace(rotor, blades=1), solid)
    with pytest.raises(CadError, match="could not fuse"):
        rotor_body.fused(replace(rotor, spinner_radius=1.0), solid)
    with pytest.raises(
        CadError, match="made_as: got 'melted', allowed are assembly, fused, sector"
    ):
        rotor_of(blade, hub_radius=2.8, made_as="melted")


def test_the_command_writes_it_and_says_how_much_was_in_two_parts(tmp_path):
    asked = ["build", "iea15mw", "-o", str(tmp_path), "--format", "stl", "--landmarks", "41"]
    ran = CliRunner().invoke(app, [*asked, "--tolerance", "5mm", "--rotor-as", "sector"])
    assert ran.exit_code == 0, ran.output
    assert {"iea15mw.sector.step", "iea15mw.sector.regions.stl"} <= {
        path.name for path in tmp_path.iterdir()
    }
    body = json.loads((tmp_path / "iea15mw.report.json").read_text())["rotor"]["body"]
    assert body["overlap_m3"] > 3.0
    assert "in two parts" in ran.output
