from dataclasses import replace

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose

from bladegen.blade.blade import Blade
from bladegen.cad import exchange, shapes, solids
from bladegen.cad.rotor import rotor_of, write_glb, write_step
from bladegen.errors import CadError
from bladegen.formats.reading import read
from bladegen.surface import mesh


@pytest.fixture(scope="module")
def blade():
    return Blade.from_definition(read("iea15mw"), landmarks=101)


def test_blades_stand_around_the_hub_and_lean_upwind(blade):
    rotor = rotor_of(blade)
    rotations, shifts = rotor.placements()
    assert_allclose(rotations @ rotations.mT, np.broadcast_to(np.eye(3), (3, 3, 3)), atol=1e-15)
    assert_allclose(np.linalg.det(rotations), 1)
    assert_allclose(np.linalg.norm(shifts, axis=1), 3.97)
    tips = rotations @ [0.0, 0.0, blade.length] + shifts
    assert np.all(tips[:, 0] < 0)
    assert_allclose(tips[:, 0], -np.sin(rotor.cone) * (blade.length + 3.97))
    assert tips[0, 2] > 0
    around = np.arctan2(tips[:, 1], tips[:, 2])
    assert_allclose(np.sort(np.mod(np.diff(around), 2 * np.pi)), [2 * np.pi * 2 / 3] * 2)


@pytest.mark.parametrize(("mirrored", "sense"), [(False, 1.0), (True, -1.0)])
def test_leading_edges_go_first_clockwise_seen_from_upwind(blade, tmp_path, mirrored, sense):
    """Seen along +x with z up, right is -y: clockwise motion of the upper blade is to -y."""
    rotor = rotor_of(blade, mirrored=mirrored)
    write_glb(rotor, mesh.from_blade(blade, stations=40), tmp_path / "r.glb")
    scene = trimesh.load_scene(tmp_path / "r.glb")
    assert set(scene.graph.transforms.children["rotor"]) == {
        "blade 1",
        "blade 2",
        "blade 3",
        "spinner",
    }
    upright = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])  # glTF has y up
    for name in ("blade 1", "blade 2", "blade 3"):
        regions = []
        for node in scene.graph.transforms.children[name]:
            matrix, geometry = scene.graph[node]
            part = scene.geometry[geometry]
            regions.append(trimesh.Trimesh(part.vertices, part.faces).apply_transform(matrix))
        assert len(regions) == 5
        solid = trimesh.util.concatenate(regions).apply_transform(upright)
        solid.merge_vertices()
        assert solid.is_watertight
        assert solid.volume > 0
        middle = 0.6 * (blade.length + 3.97)
        points = solid.vertices
        radius = np.linalg.norm(points[:, 1:], axis=1)
        ring = points[np.abs(radius - middle) < 0.03 * middle]
        angle = np.arctan2(-ring[:, 1], ring[:, 2])  # clockwise from the top, seen from upwind
        centre = np.angle(np.mean(np.exp(1j * angle)))
        offset = np.angle(np.exp(1j * (angle - centre)))
        # the thick side of a section is its leading side
        front = np.ptp(ring[offset > 0.5 * offset.max(), 0])
        back = np.ptp(ring[offset < 0.5 * offset.min(), 0])
        assert (front - back) * sense > 0


def test_a_spinner_has_no_sides_of_a_blade(blade, tmp_path):
    write_glb(rotor_of(blade), mesh.from_blade(blade, stations=40), tmp_path / "r.glb")
    children = trimesh.load_scene(tmp_path / "r.glb").graph.transforms.children
    assert len(children["blade 1"]) == 5
    assert len(children.get("spinner", ["its own"])) == 1


def test_the_assembly_has_named_parts_that_are_valid(blade, tmp_path):
    solid = solids.solid(blade, sections=40)
    rotor = rotor_of(blade)
    path = tmp_path / "rotor.step"
    write_step(rotor, solid, path)
    text = path.read_text()
    for name in ("blade 1", "blade 2", "blade 3", "spinner"):
        assert f"'{name}'" in text
    shape = exchange.read(path)
    assert shapes.is_valid(shape)
    from OCP.TopAbs import TopAbs_SOLID
    from OCP.TopExp import TopExp_Explorer

    found, explorer = [], TopExp_Explorer(shape, TopAbs_SOLID)
    while explorer.More():
        found.append(shapes.volume(explorer.Current()) / 1e9)
        explorer.Next()
    assert len(found) == 4
    assert_allclose(found[:3], solid.net.volume(), rtol=1e-5)


def test_without_a_hub_radius_there_is_no_rotor(blade):
    facts = replace(blade.definition.rotor, hub_radius=None)
    bare = replace(blade, definition=replace(blade.definition, rotor=facts))
    with pytest.raises(CadError, match="names no hub radius"):
        rotor_of(bare)
    facts = replace(blade.definition.rotor, blades=0)
    with pytest.raises(CadError, match="0 blades"):
        rotor_of(replace(blade, definition=replace(blade.definition, rotor=facts)))


def test_hub_radius_and_cone_can_be_given(blade):
    facts = replace(blade.definition.rotor, hub_radius=None, cone=None)
    bare = replace(blade, definition=replace(blade.definition, rotor=facts))
    assert rotor_of(bare, hub_radius=2.0).cone == 0.0
    rotor = rotor_of(blade, hub_radius=5.0, cone=0.05)
    assert (rotor.hub_radius, rotor.cone) == (5.0, 0.05)
    assert rotor_of(blade, cone=0.0).hub_radius == 3.97
    tip = rotor.placements()[0][0] @ [0.0, 0.0, blade.length] + rotor.placements()[1][0]
    assert_allclose(np.linalg.norm(tip), blade.length + 5.0)
    assert_allclose(tip[0], -(blade.length + 5.0) * np.sin(0.05))
    with pytest.raises(CadError, match="precone 90 deg, allowed is -45 to 45 deg"):
        rotor_of(blade, cone=np.pi / 2)
    with pytest.raises(CadError, match="hub radius 1000 m, allowed is up to the blade's length"):
        rotor_of(blade, hub_radius=1000.0)
