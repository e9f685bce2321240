"""GLB files: y up, named nodes with materials and normals, as the format and trimesh have them."""

import json
import struct

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose

import bladegen as bg
from bladegen.blade.edges import Sharp
from bladegen.surface import mesh_files
from bladegen.surface.regions import COLOURS, REGIONS
from bladegen.surface.tips import flat_tip, round_tip


def tree_of(path):
    content = path.read_bytes()
    (size,) = struct.unpack_from("<I", content, 12)
    return json.loads(content[20 : 20 + size])


@pytest.fixture(scope="module")
def blade():
    return bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101)


@pytest.fixture(scope="module", params=[flat_tip, round_tip])
def made(request, blade, tmp_path_factory):
    path = tmp_path_factory.mktemp("glb") / "a.glb"
    return bg.export(blade, path, stations=60, tip=request.param), request.param


def test_regions_are_nodes_with_materials_of_their_own(made):
    path, tip = made
    names = list(REGIONS[: 5 if tip is flat_tip else 6])
    tree = tree_of(path)
    assert [node["name"] for node in tree["nodes"]] == ["iea15mw", *names]
    assert tree["nodes"][0]["children"] == list(range(1, len(names) + 1))
    assert [material["name"] for material in tree["materials"]] == names
    scene = trimesh.load_scene(path)
    for name in names:
        colour = scene.geometry[scene.graph[name][1]].visual.material.baseColorFactor[:3]
        linear = (np.array(COLOURS[name]) / 255 + 0.055) / 1.055
        assert_allclose(colour / 255.0, linear**2.4, atol=0.01)
    assert tree["asset"]["extras"]["bladegen"].startswith("bladegen ")


def test_y_is_up_and_nodes_are_closed_together(blade, made):
    path, tip = made
    whole = trimesh.load_scene(path).to_mesh()
    bare = trimesh.Trimesh(whole.vertices, whole.faces)
    bare.merge_vertices()
    assert bare.is_watertight
    assert_allclose(bare.bounds[1][1], blade.mesh(stations=60, tip=tip).bounds[1][2], rtol=1e-5)
    again = mesh_files.read(path)
    assert_allclose(again.bounds, blade.mesh(stations=60, tip=tip).bounds, atol=1e-5)
    assert again.is_watertight


@pytest.mark.parametrize("sharp", [False, True])
def test_normals_are_those_of_the_surface(blade, tmp_path, sharp):
    blade = blade.with_trailing_edge(Sharp()) if sharp else blade
    path = bg.export(blade, tmp_path / "a.glb", stations=150)
    scene = trimesh.load_scene(path)
    for name in ("suction side", "pressure side", "root", "tip"):
        part = scene.geometry[scene.graph[name][1]]
        given = np.array(part.vertex_normals)
        assert_allclose(np.linalg.norm(given, axis=1), 1.0, atol=1e-5)
        bare = trimesh.Trimesh(part.vertices, part.faces, process=False)
        meeting = np.sum(given[bare.faces] * bare.face_normals[:, None], axis=-1)
        assert np.percentile(meeting, 0.5) > 0.9
        assert meeting.min() > 0.3
    nose = [scene.geometry[scene.graph[f"{n} side"][1]] for n in ("suction", "pressure")]
    tables = [
        {tuple(v): n for v, n in zip(p.vertices.tolist(), p.vertex_normals, strict=True)}
        for p in nose
    ]
    shared = [v for v in tables[0] if v in tables[1]]
    along = [float(tables[0][v] @ tables[1][v]) for v in shared]
    edge = 150 if sharp else 0
    assert sum(cosine > 1 - 1e-5 for cosine in along) >= len(shared) - edge >= 140
