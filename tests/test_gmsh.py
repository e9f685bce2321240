"""gmsh makes closed surface meshes of our STEP files at the first try, without any mending.

Two densities and the default files are measured in benchmarks/gmsh_meshing.py.
"""

import gmsh
import numpy as np
import pytest
from numpy.testing import assert_allclose

from bladegen import cad, cad_files
from bladegen.blade import Blade
from bladegen.mesh import TriangleMesh
from bladegen.readers import bundled, read
from bladegen.tips import flat_tip, round_tip

SIZE = 500.0  # mm


def meshed(path):
    """Mesh a STEP file's surface: the volumes found, triangles in metres, qualities a face."""
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE)
        gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.synchronize()
        volumes = gmsh.model.getEntities(3)
        gmsh.model.mesh.generate(2)
        tags, points, _ = gmsh.model.mesh.getNodes()
        place = np.zeros(int(tags.max()) + 1, dtype=int)
        place[tags.astype(int)] = np.arange(len(tags))
        faces, qualities = [], []
        for _, face in gmsh.model.getEntities(2):
            (kind,), (elements,), (nodes,) = gmsh.model.mesh.getElements(2, face)
            assert kind == 2, "triangles only"
            faces.append(place[nodes.astype(int)].reshape(-1, 3))
            qualities.append(np.array(gmsh.model.mesh.getElementQualities(elements, "gamma")))
    finally:
        gmsh.finalize()
    return volumes, TriangleMesh(points.reshape(-1, 3) / 1e3, np.concatenate(faces)), qualities


@pytest.mark.parametrize("name", bundled())
@pytest.mark.parametrize("tip", [flat_tip, round_tip])
def test_gmsh_meshes_the_surface_of_one_volume(name, tip, tmp_path):
    solid = cad.solid(Blade.from_definition(read(name)), tolerance=1e-3, tip=tip)
    cad_files.write_step(solid, tmp_path / "blade.step")
    volumes, made, qualities = meshed(tmp_path / "blade.step")
    assert len(volumes) == 1
    edges = np.concatenate([made.faces[:, [i, (i + 1) % 3]] for i in range(3)])
    forward = edges @ [len(made.vertices), 1]
    assert len(np.unique(forward)) == len(forward), "no edge twice the same way"
    assert np.array_equal(np.sort(forward), np.sort(edges @ [1, len(made.vertices)]))
    assert len(made.vertices) - len(made.faces) / 2 == 2, "a sphere's Euler characteristic"
    assert 4_000 < len(made.faces) < 15_000
    assert_allclose(made.volume, solid.volume, rtol=0.02)
    assert_allclose(made.area, solid.area, rtol=0.01)
    assert min(qualities[0].min(), qualities[1].min()) > 0.3, "suction and pressure side"
    assert min(quality.min() for quality in qualities) > 0, "no triangle without an area"
