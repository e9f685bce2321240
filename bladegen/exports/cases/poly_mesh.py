"""OpenFOAM's mesh of one cell's thickness from a plane O-grid: points, faces, owner, neighbour.

Cells are counted around, then outward; so are the points of either plane.  Faces come as OpenFOAM
wants them: inner ones first, by owner, then by neighbour, their normals out of the owner, and then
those of each patch in one piece.  Reference: OpenFOAM's user guide, "Mesh description".
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from bladegen.support.arrays import Array, Indices
from bladegen.support.foam import dictionary, entries, number
from bladegen.support.values import brief

__all__ = ["FAR", "PLANES", "Patch", "PolyMesh", "extruded", "write_mesh"]

FAR, PLANES = "far_field", "front_and_back"
Patch = tuple[str, str, Indices, Indices]  # its name, its type, its faces (f, 4), their owners (f,)
DIGITS = 12  # of points: a first cell's height is 1e-8 of the far field's radius


@dataclass(frozen=True, eq=False)
class PolyMesh:
    """A mesh by faces.

    Parameters
    ----------
    points : (p, 3) array
        [m].
    faces : (f, 4) array
        Points of each face, anticlockwise seen from outside the owner.
    owner, neighbour : (f,), (i,) arrays
        Cells at each face; the first i faces are inner ones.
    patches : dict
        The type, the first face and the number of faces of each patch.
    """

    points: Array
    faces: Indices
    owner: Indices
    neighbour: Indices
    patches: dict[str, tuple[str, int, int]]

    __repr__ = brief

    @classmethod
    def of(
        cls, points: Array, inner: Indices, pairs: Indices, outer: Sequence[Patch]
    ) -> "PolyMesh":
        """Return the mesh of inner faces (i, 4) between pairs of cells (i, 2), and of patches.

        The first cell of a pair is the owner, the lower number.
        """
        order = np.lexsort((pairs[:, 1], pairs[:, 0]))
        patches, start = {}, len(inner)
        for name, kind, faces, _ in outer:
            patches[name] = (kind, start, len(faces))
            start += len(faces)
        return cls(
            points,
            np.concatenate([inner[order], *(faces for _, _, faces, _ in outer)]),
            np.concatenate([pairs[order, 0], *(owners for _, _, _, owners in outer)]),
            pairs[order, 1],
            patches,
        )


def extruded(layers: Array, thickness: float, walls: dict[str, int]) -> PolyMesh:
    """Return the mesh between two planes a thickness apart.

    Parameters
    ----------
    layers : (m, n, 2) array
        The wall first, clockwise.
    thickness : float
        [m].
    walls : dict
        How many faces each patch of the wall has, in its order.
    """
    count, n = len(layers) - 1, layers.shape[1]
    flat = layers.reshape(-1, 2)
    points = np.concatenate(
        [np.column_stack([flat, np.full(len(flat), z)]) for z in (0.0, thickness)]
    )
    cells = np.arange(count * n).reshape(count, n)
    low = np.arange(len(flat)).reshape(count + 1, n)
    high = low + len(flat)
    # between neighbours around, at the points of the second; the last is that of cells n-1 and 0
    second = np.roll(np.arange(n), -1)
    rising = np.stack(
        [low[:-1], low[1:], high[1:], high[:-1]],
        axis=-1,
    )[:, second]
    rising[:, -1] = rising[:, -1, ::-1]  # whose owner is cell 0
    beside = np.sort(np.stack([cells, np.roll(cells, -1, axis=1)], axis=-1), axis=-1)
    # of each layer of points, with normals outward
    over = np.stack(
        [low, high, np.roll(high, -1, axis=1), np.roll(low, -1, axis=1)],
        axis=-1,
    )
    above = np.stack([cells[:-1], cells[1:]], axis=-1)
    inner = np.concatenate([rising.reshape(-1, 4), over[1:-1].reshape(-1, 4)])
    pairs = np.concatenate([beside.reshape(-1, 2), above.reshape(-1, 2)])
    ring = np.roll(low, -1, axis=1)
    bottom = np.stack([low[:-1], low[1:], ring[1:], ring[:-1]], axis=-1).reshape(-1, 4)
    top = bottom[:, ::-1] + len(flat)
    ends = np.cumsum([0, *walls.values()])
    outer: list[Patch] = [
        (name, "wall", over[0][start:end, ::-1], cells[0, start:end])
        for name, (start, end) in zip(walls, pairwise(ends.tolist()), strict=True)
    ]
    outer.append((FAR, "patch", over[-1], cells[-1]))
    planes = np.concatenate([bottom, top])
    outer.append((PLANES, "empty", planes, np.concatenate([cells.ravel(), cells.ravel()])))
    return PolyMesh.of(points, inner, pairs, outer)


def write_mesh(mesh: PolyMesh, folder: Path, *, group: str) -> None:
    """Write the five files of a mesh into a folder; all walls are in a group of patches."""
    files = {
        "points": ("vectorField", [f"({row})" for row in _rows(mesh.points, f"%.{DIGITS}g")]),
        "faces": ("faceList", [f"4({row})" for row in _rows(mesh.faces, "%d")]),
        "owner": ("labelList", list(map(str, mesh.owner.tolist()))),
        "neighbour": ("labelList", list(map(str, mesh.neighbour.tolist()))),
    }
    for name, (kind, rows) in files.items():
        lines = [str(len(rows)), "(", *rows, ")"]
        text = dictionary(name, lines, kind=kind)
        (folder / name).write_text(text, encoding="ascii")
    lines = [number(len(mesh.patches)), "("]
    for name, (kind, start, size) in mesh.patches.items():
        of_group = {"inGroups": (group,)} if kind == "wall" else {}
        lines += entries({name: {"type": kind, **of_group, "nFaces": size, "startFace": start}})
    text = dictionary("boundary", [*lines, ")"], kind="polyBoundaryMesh")
    (folder / "boundary").write_text(text, encoding="ascii")


def _rows(values: Array | Indices, form: str) -> list[str]:
    """Return the rows of an array as words with blanks between."""
    row = " ".join([form] * values.shape[1])
    return [row % tuple(each) for each in values.tolist()]
