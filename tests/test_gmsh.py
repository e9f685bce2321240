"""gmsh makes closed surface meshes of our STEP files at the first try, without any mending.

Two densities and the default files are measured in benchmarks/gmsh_meshing.py.
"""

import meshing
import numpy as np
import pytest
from numpy.testing import assert_allclose

from bladegen.blade.blade import Blade
from bladegen.cad import exchange, solids
from bladegen.formats.bundled import bundled
from bladegen.formats.reading import read
from bladegen.surface.mesh import TriangleMesh
from bladegen.surface.tips import flat_tip, round_tip

SIZE = 500.0  # mm


NIGHTLY = pytest.mark.nightly
NAMES = [n if n == "nrel5mw" else pytest.param(n, marks=NIGHTLY) for n in bundled()]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("tip", [flat_tip, round_tip])
def test_gmsh_meshes_the_surface_of_one_volume(name, tip, tmp_path):
    solid = solids.solid(Blade.from_definition(read(name)), tolerance=1e-3, tip=tip)
    exchange.write_step(solid, tmp_path / "blade.step")
    found = meshing.found(tmp_path / "blade.step", SIZE)
    assert found.volumes == 1
    made, qualities = TriangleMesh(found.vertices / 1e3, found.faces), found.qualities
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
