"""Measures of polygons and of the polyhedra between sections, exact for these.

Polygons are closed by a straight line from their last point to the first and run counter-
clockwise.  Area, centroid and second moments are sums over the edges by Green's theorem;
volume and area of a polyhedron are sums over its triangles.
"""

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["MEASURES", "measure", "volume_and_area"]

MEASURES = (
    "area",
    "centroid_x",
    "centroid_y",
    "inertia_xx",
    "inertia_yy",
    "inertia_xy",
    "perimeter",
)


def measure(points: Array) -> Array:
    """Return the `MEASURES` (..., 7) of polygons (..., n, 2).

    Second moments are about axes through the centroid: inertia_xx is the integral of y^2,
    inertia_yy of x^2, and inertia_xy of x y.
    """
    x, y = points[..., 0], points[..., 1]
    x1, y1 = np.roll(x, -1, axis=-1), np.roll(y, -1, axis=-1)
    twice = x * y1 - x1 * y
    area = 0.5 * twice.sum(axis=-1)
    cx = ((x + x1) * twice).sum(axis=-1) / (6.0 * area)
    cy = ((y + y1) * twice).sum(axis=-1) / (6.0 * area)
    xx = ((y * (y + y1) + y1 * y1) * twice).sum(axis=-1) / 12.0 - area * cy**2
    yy = ((x * (x + x1) + x1 * x1) * twice).sum(axis=-1) / 12.0 - area * cx**2
    mixed = (x * (2.0 * y + y1) + x1 * (y + 2.0 * y1)) * twice
    xy = mixed.sum(axis=-1) / 24.0 - area * cx * cy
    perimeter = np.hypot(x1 - x, y1 - y).sum(axis=-1)
    return np.stack([area, cx, cy, xx, yy, xy, perimeter], axis=-1)


def volume_and_area(sections: Array) -> tuple[Array, Array]:
    """Return volume and surface (...) of the closed polyhedra through sections (..., k, n, 3).

    Sections run as a blade's do: clockwise as seen from the tip, root first.

    Neighbouring sections are joined by two triangles a cell; the ends and the strip between
    the trailing edges are closed.  A cell a, b, c, d counts with its vector area, half of
    (c - a) x (d - b): exact for the volume, and for the surface where the cell is plane.
    """
    loop = np.concatenate([sections, sections[..., :1, :]], axis=-2)
    x, y, z = np.ascontiguousarray(np.moveaxis(loop, -1, 0))
    (px, qx), (py, qy), (pz, qz) = (_diagonals(w) for w in (x, y, z))
    nx, ny, nz = py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx
    six = sum((w[..., :-1, :-1] * n).sum(axis=(-1, -2)) for w, n in ((x, nx), (y, ny), (z, nz)))
    area = 0.5 * np.sqrt(nx * nx + ny * ny + nz * nz).sum(axis=(-1, -2))
    for end, sign in ((loop[..., 0, :, :], 1.0), (loop[..., -1, :, :], -1.0)):
        start = end[..., :1, :]
        flat = np.cross(end[..., :-1, :] - start, end[..., 1:, :] - start).sum(axis=-2)
        six = six + sign * np.sum(start[..., 0, :] * flat, axis=-1)
        area = area + 0.5 * np.linalg.norm(flat, axis=-1)
    return six / 6.0, area


def _diagonals(w: Array) -> tuple[Array, Array]:
    """Return the diagonals of cells of one coordinate (..., k, n), along and across."""
    return w[..., 1:, 1:] - w[..., :-1, :-1], w[..., :-1, 1:] - w[..., 1:, :-1]
