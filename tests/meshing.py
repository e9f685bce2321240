"""gmsh, in a process of its own: it sets SIGPIPE back to what ends a process without a word.

    python meshing.py FILE FOUND.npz [SIZE]

reads a CAD file and says what gmsh finds in it; with a size, it meshes its surface besides.
"""

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bladegen.support.arrays import Array, Indices


@dataclass(frozen=True, eq=False)
class Found:
    """What gmsh finds: volumes, the box around the first [mm], and the mesh of its faces [mm].

    Names are those of volumes, colours those of faces, 0 to 255.
    """

    volumes: int
    names: tuple[str, ...]
    colours: Indices
    box: Array
    vertices: Array
    faces: Indices
    qualities: tuple[Array, ...]


def found(path: Path, size: float | None = None) -> Found:
    """Let gmsh read a CAD file and, with a size of triangles [mm], mesh its surface."""
    target = path.with_suffix(".npz")
    words = [str(path), str(target), *([] if size is None else [str(size)])]
    done = subprocess.run(
        [sys.executable, __file__, *words], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    with np.load(target) as held:
        qualities = np.split(held["qualities"], np.cumsum(held["counts"])[:-1])
        return Found(
            len(held["names"]),
            tuple(held["names"].tolist()),
            held["colours"],
            held["box"],
            held["vertices"],
            held["faces"],
            tuple(qualities),
        )


def main(path: str, target: str, size: str = "") -> None:
    """Run gmsh and save what it finds."""
    import gmsh

    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Geometry.OCCImportLabels", 1)
    gmsh.model.occ.importShapes(path)
    gmsh.model.occ.synchronize()
    volumes = gmsh.model.getEntities(3)
    box = gmsh.model.getBoundingBox(*volumes[0])
    points, faces, qualities = np.zeros(0), [np.zeros((0, 3), dtype=int)], [np.zeros(0)]
    if size:
        gmsh.option.setNumber("Mesh.MeshSizeMax", float(size))
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
    np.savez(
        target,
        names=[gmsh.model.getEntityName(*volume) for volume in volumes],
        colours=[gmsh.model.getColor(*face)[:3] for face in gmsh.model.getEntities(2)],
        box=box,
        vertices=points.reshape(-1, 3),
        faces=np.concatenate(faces),
        qualities=np.concatenate(qualities),
        counts=[len(quality) for quality in qualities],
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
