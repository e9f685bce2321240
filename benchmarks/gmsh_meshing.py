"""gmsh's surface meshes of our STEP files, at two densities: are they made, closed, and good?

`python benchmarks/gmsh_meshing.py` takes the default files and light ones (1 mm) of every
blade, with flat and with round tips.  Worst quality is gmsh's gamma, the inscribed over the
circumscribed radius, 1 for an equilateral triangle: over both sides, and over all faces, where
that of a 2 mm trailing edge is as poor as it is narrow.
"""

import tempfile
import time
from pathlib import Path

import gmsh
import numpy as np
from figures import asked, figure

import bladegen as bg
from bladegen.cad import shapes, solids
from bladegen.surface.mesh import TriangleMesh
from bladegen.surface.tips import flat_tip, round_tip

SIZES = 500.0, 100.0  # mm
FILES = {"default": solids.DEFAULT_TOLERANCE, "light": 1e-3}


def main() -> None:
    """Mesh each file at each density."""
    quick = asked(__doc__).quick
    with tempfile.TemporaryDirectory() as folder:
        for name in bg.bundled()[: 1 if quick else None]:
            blade = bg.Blade.from_definition(bg.read(name))
            for tip in (flat_tip, round_tip):
                for label, tolerance in FILES.items():
                    path = Path(folder) / "blade.step"
                    solid = solids.solid(blade, tolerance=tolerance, tip=tip)
                    bg.export(blade, path, tolerance=tolerance, tip=tip)
                    for size in SIZES[: 1 if quick else None]:
                        case = f"{name}, {label}, {tip.__name__[:-4]} tip, {size:g} mm"
                        measure(case, path, size, solid)


def measure(case: str, path: Path, size: float, solid: solids.Solid) -> None:
    """Mesh a file's surface and print how that went."""
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    start = time.process_time()
    gmsh.model.occ.importShapes(str(path))
    gmsh.model.occ.synchronize()
    volumes = len(gmsh.model.getEntities(3))
    gmsh.model.mesh.generate(2)
    spent = time.process_time() - start
    tags, points, _ = gmsh.model.mesh.getNodes()
    place = np.zeros(int(tags.max()) + 1, dtype=int)
    place[tags.astype(int)] = np.arange(len(tags))
    faces, worst = [], []
    for _, face in gmsh.model.getEntities(2):
        _, (elements,), (nodes,) = gmsh.model.mesh.getElements(2, face)
        faces.append(place[nodes.astype(int)].reshape(-1, 3))
        worst.append(float(np.min(gmsh.model.mesh.getElementQualities(elements, "gamma"))))
    gmsh.finalize()
    made = TriangleMesh(points.reshape(-1, 3) / shapes.MILLIMETRES, np.concatenate(faces))
    edges = np.sort(np.concatenate([made.faces[:, [i, (i + 1) % 3]] for i in range(3)]))
    _, times = np.unique(edges, axis=0, return_counts=True)
    for what, value, unit in (
        ("gmsh, processor", spent, "s"),
        ("gmsh, triangles", len(made.faces), ""),
        ("gmsh, volumes", volumes, ""),
        ("gmsh, edges not of two triangles", np.count_nonzero(times != 2), ""),
        ("gmsh, area off by", made.area / solid.area - 1, ""),
        ("gmsh, volume off by", made.volume / solid.volume - 1, ""),
        ("gmsh, worst quality, sides", min(worst[:2]), ""),
        ("gmsh, worst quality, all faces", min(worst), ""),
    ):
        figure(what, case, unit, float(value))


if __name__ == "__main__":
    main()
