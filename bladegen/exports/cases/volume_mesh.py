"""OpenFOAM's mesh of a volume around a blade: its faces, and patches for wall, far field and root.

Cells are counted through a layer, then outward; so are points.  See `poly_mesh`.
"""

import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from bladegen.exports.cases.dictionaries import BLADE
from bladegen.exports.cases.poly_mesh import FAR, Patch, PolyMesh, write_mesh
from bladegen.support.arrays import Indices
from bladegen.support.foam import Entries, dictionary
from bladegen.surface.volumes.volume import Volume

__all__ = ["ROOT", "mesh_of", "write_zip"]

FAST = 1  # of zip's levels
SCHEMES = "ddt", "grad", "div", "laplacian", "interpolation", "snGrad"
CONTROL = {
    "application": "checkMesh",
    "startFrom": "startTime",
    "startTime": 0,
    "stopAt": "endTime",
    "endTime": 1,
    "deltaT": 1,
    "writeControl": "timeStep",
    "writeInterval": 1,
}

ROOT = "root_plane"


def mesh_of(volume: Volume) -> PolyMesh:
    """Return the mesh of a volume.

    Walls have the names of the blade's faces, with underscores; the far field is a patch, the root
    plane one of symmetry.
    """
    front = volume.front
    count, points = len(front.cells), len(front.points)
    last = len(volume.layers) - 1
    corner, beside = front.sides()
    outward = np.arange(last)[:, None, None]
    rising = _rising(front.edges(corner), last, points)
    over = front.cells + points * np.arange(last + 1)[:, None, None]
    cells = np.arange(count) + count * np.arange(last)[:, None]
    inner = np.concatenate([rising, over[1:-1].reshape(-1, 4)])
    pairs = np.concatenate(
        [
            (beside + count * outward).reshape(-1, 2),
            np.stack([cells[:-1], cells[1:]], axis=-1).reshape(-1, 2),
        ]
    )
    family = np.concatenate(
        [np.full(b.eta[1:, 1:].size, i) for i, b in enumerate(volume.grid.blocks)]
    )
    names = [block.family for block in volume.grid.blocks]
    outer: list[Patch] = []
    for name in dict.fromkeys(names):
        own = np.flatnonzero(np.isin(family, [i for i, one in enumerate(names) if one == name]))
        outer.append((name.replace(" ", "_"), "wall", over[0][own][:, ::-1], own))
    outer.append((FAR, "patch", over[-1], cells[-1]))
    corner = front.rim()
    owners = (corner // 4 + count * outward[:, 0]).ravel()
    outer.append((ROOT, "symmetryPlane", _rising(front.edges(corner), last, points), owners))
    return PolyMesh.of(volume.layers.reshape(-1, 3), inner, pairs, outer)


def _rising(edge: Indices, layers: int, points: int) -> Indices:
    """Return the faces (layers x e, 4) over edges (e, 2), their normals to the edges' right."""
    low = edge + points * np.arange(layers)[:, None, None]
    high = low + points
    faces: Indices = np.stack(
        [low[..., 0], low[..., 1], high[..., 1], high[..., 0]], axis=-1
    ).reshape(-1, 4)
    return faces


def write_zip(volume: Volume, path: Path, *, note: str = "") -> None:
    """Write the mesh of a volume as a case's folders, packed: unpack it, and checkMesh runs there.

    The same volume makes the same bytes.
    """
    system: dict[str, Entries] = {
        "controlDict": CONTROL,
        "fvSchemes": {f"{name}Schemes": {"default": "none"} for name in SCHEMES},
        "fvSolution": {"solvers": {}},
    }
    with TemporaryDirectory() as name:
        folder = Path(name)
        write_mesh(mesh_of(volume), folder, group=BLADE)
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=FAST) as archive:
            for file, entries in system.items():
                told = dictionary(file, entries, note=note).encode()  # where marks are looked for
                _packed(archive, f"system/{file}", told, zipfile.ZIP_STORED)
            for part in sorted(folder.iterdir()):
                _packed(archive, f"constant/polyMesh/{part.name}", part.read_bytes())


def _packed(
    archive: zipfile.ZipFile, name: str, content: bytes, how: int = zipfile.ZIP_DEFLATED
) -> None:
    """Add a member to an archive, without the time of day."""
    member = zipfile.ZipInfo(name)
    member.compress_type = how
    archive.writestr(member, content)
