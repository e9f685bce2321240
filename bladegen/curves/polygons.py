"""Measures of polygons and of the polyhedra between sections, exact for these.

Polygons are closed by a straight line from their last point to the first and run counter-
clockwise.  Area, centroid and second moments are sums over the edges by Green's theorem;
volume and area of a polyhedron are sums over its triangles.
"""

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["MEASURES", "measure", "measure_slopes", "volume_and_area", "volume_and_area_slopes"]

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


def measure_slopes(points: Array) -> Array:
    """Return the derivatives (..., 7, n, 2) of `measure` in the points (..., n, 2)."""
    (x, y), (x1, y1) = np.moveaxis(points, -1, 0), np.moveaxis(np.roll(points, -1, axis=-2), -1, 0)
    twice, zero = x * y1 - x1 * y, np.zeros_like(x)
    turn = np.stack([y1, -x1, -y, x])
    length = np.hypot(x1 - x, y1 - y)
    along = np.divide(
        np.stack([x1 - x, y1 - y]), length, out=np.zeros((2, *x.shape)), where=length > 0
    )
    ones = np.ones_like(x)
    weights = {  # of `twice` in a sum over the edges, and their derivatives in x, y, x1, y1
        "sx": (x + x1, [ones, zero, ones, zero]),
        "sy": (y + y1, [zero, ones, zero, ones]),
        "yy": (y * (y + y1) + y1 * y1, [zero, 2 * y + y1, zero, y + 2 * y1]),
        "xx": (x * (x + x1) + x1 * x1, [2 * x + x1, zero, x + 2 * x1, zero]),
        "xy": (
            x * (2 * y + y1) + x1 * (y + 2 * y1),
            [2 * y + y1, 2 * x + x1, y + 2 * y1, x + 2 * x1],
        ),
    }

    def gathered(parts: Array) -> Array:
        """Return what edges give to their ends (4, ..., n) as given to points (..., n, 2)."""
        both: Array = np.stack(
            [parts[0] + np.roll(parts[2], 1, axis=-1), parts[1] + np.roll(parts[3], 1, axis=-1)], -1
        )
        return both

    total = twice.sum(axis=-1)[..., None, None]
    slope = gathered(turn)
    sums, slopes = {}, {}
    for name, (weight, changes) in weights.items():
        sums[name] = (weight * twice).sum(axis=-1)[..., None, None]
        slopes[name] = gathered(np.stack(changes) * twice + weight * turn)
    area = 0.5 * total
    cx, cy = sums["sx"] / (3.0 * total), sums["sy"] / (3.0 * total)
    dx, dy = (
        (slopes[name] - 3.0 * c * slope) / (3.0 * total) for name, c in (("sx", cx), ("sy", cy))
    )
    result: Array = np.stack(
        [
            0.5 * slope,
            dx,
            dy,
            slopes["yy"] / 12.0 - 0.5 * slope * cy**2 - 2.0 * area * cy * dy,
            slopes["xx"] / 12.0 - 0.5 * slope * cx**2 - 2.0 * area * cx * dx,
            slopes["xy"] / 24.0 - 0.5 * slope * cx * cy - area * (dx * cy + cx * dy),
            gathered(np.concatenate([-along, along])),
        ],
        axis=-3,
    )
    return result


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


def volume_and_area_slopes(sections: Array) -> tuple[Array, Array]:
    """Return the derivatives of `volume_and_area` in the points, (..., k, n, 3) each."""
    loop = np.concatenate([sections, sections[..., :1, :]], axis=-2)
    own = loop[..., :-1, :-1, :]
    p = loop[..., 1:, 1:, :] - own
    q = loop[..., :-1, 1:, :] - loop[..., 1:, :-1, :]
    normal = np.cross(p, q)
    slopes = []
    for toward in (own, 0.5 * _unit(normal)):
        slope = np.zeros_like(loop)
        along, across = np.cross(q, toward), np.cross(toward, p)
        slope[..., 1:, 1:, :] += along
        slope[..., :-1, :-1, :] -= along
        slope[..., :-1, 1:, :] += across
        slope[..., 1:, :-1, :] -= across
        slopes.append(slope)
    slopes[0][..., :-1, :-1, :] += normal
    for k, sign in ((0, 1.0), (-1, -1.0)):
        start = loop[..., k, :1, :]
        a, b = loop[..., k, :-1, :] - start, loop[..., k, 1:, :] - start
        flat = np.cross(a, b).sum(axis=-2)[..., None, :]
        for slope, toward in zip(slopes, (sign * start, 0.5 * _unit(flat)), strict=True):
            first, second = np.cross(b, toward), np.cross(toward, a)
            slope[..., k, :-1, :] += first
            slope[..., k, 1:, :] += second
            slope[..., k, 0, :] -= (first + second).sum(axis=-2)
        slopes[0][..., k, 0, :] += sign * flat[..., 0, :]
    for slope in slopes:
        slope[..., 0, :] += slope[..., -1, :]
    return slopes[0][..., :-1, :] / 6.0, slopes[1][..., :-1, :]


def _unit(vectors: Array) -> Array:
    """Return vectors of length 1; of no length where they have none."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    unit: Array = np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0.0)
    return unit


def _diagonals(w: Array) -> tuple[Array, Array]:
    """Return the diagonals of cells of one coordinate (..., k, n), along and across."""
    return w[..., 1:, 1:] - w[..., :-1, :-1], w[..., :-1, 1:] - w[..., 1:, :-1]
