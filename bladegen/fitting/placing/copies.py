"""Copies of a blade in one mesh, such as those of a rotor: one of them is taken out."""

import numpy as np

from bladegen.support.arrays import Array, Indices
from bladegen.surface.mesh import TriangleMesh

__all__ = ["one_of_copies"]

ALIKE = 0.01  # of the area and of the longest extent, by which copies differ at most
SMALL = 0.2  # of the largest part's area: smaller parts are no blades
SLENDER = 3.0  # times as long as the root of the area of one side over the length


def one_of_copies(mesh: TriangleMesh) -> tuple[TriangleMesh, tuple[str, ...]]:
    """Return one of several closed parts of a mesh that are alike, and what is to be said.

    A mesh that has no such parts stays as it is.
    """
    parts = _parts(mesh)
    if len(parts) < 2:
        return mesh, ()
    corners = mesh.vertices[mesh.faces]
    size = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    areas = np.array([0.5 * size[part].sum() for part in parts])
    large = [k for k in range(len(parts)) if areas[k] > SMALL * areas.max()]
    lengths = {k: _length(corners[parts[k]].reshape(-1, 3)) for k in large}
    blades = [
        k for k in large if lengths[k] ** 2 > SLENDER * areas[k] / 2.0 and _closed(mesh, parts[k])
    ]
    for k in blades:
        same = [
            j
            for j in blades
            if abs(areas[j] / areas[k] - 1.0) < ALIKE and abs(lengths[j] / lengths[k] - 1.0) < ALIKE
        ]
        if len(same) > 1:
            used, faces = np.unique(mesh.faces[parts[k]], return_inverse=True)
            said = f"it holds {len(same)} copies of a blade, and {len(parts) - len(same)} other "
            return (
                TriangleMesh(mesh.vertices[used], faces.reshape(-1, 3)),
                (said + "parts: the first copy is taken",),
            )
    return mesh, ()


def _parts(mesh: TriangleMesh) -> list[Indices]:
    """Return the triangles of each part of a mesh that hangs together."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    a, b, c = mesh.faces.T
    edges = np.concatenate([a, b]), np.concatenate([b, c])
    count = len(mesh.vertices)
    graph = coo_array((np.ones(len(edges[0]), dtype=bool), edges), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    own = label[a]
    order = np.argsort(own, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(own[order])) + 1)


def _length(points: Array) -> float:
    """Return how far points reach along their longest axis."""
    away = points - points.mean(axis=0)
    _, axes = np.linalg.eigh(away.T @ away)
    return float(np.ptp(away @ axes[:, 2]))


def _closed(mesh: TriangleMesh, part: Indices) -> bool:
    faces = mesh.faces[part]
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    keys = edges[:, 0] * len(mesh.vertices) + edges[:, 1]
    return bool(np.all(np.unique(keys, return_counts=True)[1] == 2))
