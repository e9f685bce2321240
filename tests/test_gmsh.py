"""gmsh makes closed surface meshes of our STEP files at the first try, without any mending.

Two densities and the default files are measured in benchmarks/gmsh_meshing.py.
"""

import json
import subprocess
import sys
from pathlib import Path

import meshing
import numpy as np
import pytest
from numpy.testing import assert_allclose

from bladegen.blade.blade import Blade
from bladegen.cad import exchange, shapes, solids
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


NAMING = """
import json, re, sys
from pathlib import Path

import gmsh

code = next(
    block
    for block in re.findall(r"```python\\n(.*?)```", Path(sys.argv[2]).read_text(), re.S)
    if "addPhysicalGroup" in block
)
gmsh.initialize()
gmsh.option.setNumber("General.Verbosity", 1)
gmsh.model.occ.importShapes(sys.argv[1])
gmsh.model.occ.synchronize()
exec(code)
areas = {}
for dimension, group in gmsh.model.getPhysicalGroups():
    own = gmsh.model.getEntitiesForPhysicalGroup(dimension, group)
    name = gmsh.model.getPhysicalName(dimension, group)
    areas[name] = [gmsh.model.occ.getMass(dimension, int(tag)) for tag in own]
print(json.dumps(areas))
"""


@pytest.mark.parametrize("tip", [flat_tip, round_tip])
def test_the_docs_name_faces_in_gmsh_by_their_colours(tip, tmp_path):
    solid = solids.solid(Blade.from_definition(read("nrel5mw")), tolerance=1e-3, tip=tip)
    exchange.write_step(solid, tmp_path / "blade.step")
    docs = Path(__file__).parents[1] / "docs" / "grids.md"
    command = [sys.executable, "-c", NAMING, tmp_path / "blade.step", docs]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    found = json.loads(done.stdout.splitlines()[-1])
    wanted = {}
    for name, face in solid.faces:
        key = "trailing_edge" if "trailing" in name else name.replace(" ", "_")
        wanted.setdefault(key, []).append(shapes.area(face))
    assert set(found) == set(wanted)
    for name, areas in wanted.items():
        assert_allclose(sorted(found[name]), sorted(areas), rtol=0.02)
