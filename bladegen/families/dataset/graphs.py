"""Blades as graphs, for learning on geometry: points, normals, areas, edges, triangles.

In: sections (..., k, n, 3) [m], landmarks around, spans along.  Out: the unit normal and the share
of the surface of each point; the graph is the same for all variants: neighbours around each section
(across the trailing edge too) and along each landmark's line.  The ends at root and tip are open.
"""

from typing import Any

import numpy as np

from bladegen.support.arrays import Array, Indices

__all__ = ["edges", "surface", "triangles"]


def surface(sections: Any) -> tuple[Array, Array]:
    """Return normals (..., k, n, 3), outward, and areas (..., k, n) [m2] of points of sections.

    A cell between two landmarks and two spans is a quadrilateral; a quarter of its area, half the
    cross product of its diagonals, goes to each corner.  A point's normal is the mean of those of
    its cells, weighted by area.
    """
    points = np.asarray(sections, dtype=np.float64)
    following = np.roll(points, -1, axis=-2)
    one = points[..., 1:, :, :] - following[..., :-1, :, :]
    other = following[..., 1:, :, :] - points[..., :-1, :, :]
    turned = [(1, 2), (2, 0), (0, 1)]  # numpy.cross takes four times as long
    parts = [one[..., i] * other[..., j] - one[..., j] * other[..., i] for i, j in turned]
    cells = 0.5 * np.stack(parts, axis=-1)  # (..., k - 1, n, 3)
    vectors = _gathered(cells)
    areas = _gathered(np.linalg.norm(cells, axis=-1, keepdims=True))[..., 0]
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, 1.0), areas


def _gathered(cells: Array) -> Array:
    """Return what points get of cells (..., k - 1, n, m): a quarter of each around them."""
    quarter = 0.25 * (cells + np.roll(cells, 1, axis=-2))
    result = np.zeros((*cells.shape[:-3], cells.shape[-3] + 1, *cells.shape[-2:]))
    result[..., :-1, :, :] += quarter
    result[..., 1:, :, :] += quarter
    return result


def edges(spans: int, landmarks: int) -> Indices:
    """Return pairs (e, 2) of neighbouring points; point = span * landmarks + landmark."""
    point = np.arange(spans * landmarks).reshape(spans, landmarks)
    around = np.stack([point, np.roll(point, -1, axis=1)], axis=-1)
    along = np.stack([point[:-1], point[1:]], axis=-1)
    return np.concatenate([around.reshape(-1, 2), along.reshape(-1, 2)])


def triangles(spans: int, landmarks: int) -> Indices:
    """Return triangles (2 (k - 1) n, 3) of the skin, each cell cut along one diagonal.

    Their corners run anticlockwise seen from outside.
    """
    point = np.arange(spans * landmarks).reshape(spans, landmarks)
    a, b = point[:-1], np.roll(point, -1, axis=1)[:-1]
    c, d = np.roll(point, -1, axis=1)[1:], point[1:]
    cells = np.stack([np.stack([a, c, b], axis=-1), np.stack([a, d, c], axis=-1)], axis=-2)
    return cells.reshape(-1, 3)
