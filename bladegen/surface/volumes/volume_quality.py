"""How good a volume's cells are: Jacobians, faces as flow solvers see them, heights.

A corner's Jacobian is the triple product of the edges that leave it [m3]; scaled by their lengths
it is 1 for a brick and negative where a cell is folded.  Non-orthogonality is the angle between a
face's normal and the line that joins the centres of the cells on both sides; skewness is how far
that line passes by the face's centre, over the face's size in that direction: both as OpenFOAM's
checkMesh has them (`primitiveMeshTools`), and so are areas, volumes and centres.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from bladegen.support.arrays import Array, Indices
from bladegen.surface.volumes.front import Front

__all__ = ["corner_jacobians", "figures_of", "scaled_jacobians"]

SMALL = 1e-300
LEAST = 0.2  # of the distance of two centres: what a face's size is at least taken for


def corner_jacobians(inner: Array, outer: Array, cells: Indices) -> Array:
    """Return the Jacobians (c, 8) [m3] of cells (c, 4) between two layers of points (p, 3).

    Those of the inner layer's corners come first.
    """
    return _jacobians(inner, outer, cells)[0]


def scaled_jacobians(inner: Array, outer: Array, cells: Indices) -> Array:
    """Return the same over the lengths of the three edges, (c, 8)."""
    return _jacobians(inner, outer, cells)[1]


def figures_of(front: Front, layers: Array, families: list[tuple[str, int]]) -> dict[str, Any]:
    """Measure the volume between layers (m, p, 3).

    `families` are the names of the surface's blocks and how many cells of the front each has.
    The cell of the largest skewness is told by its layer and its number on the front.
    """
    around, beside = _Around.of(front), front.sides()[1]
    jacobian, scaled, smallest, low = np.inf, [], np.inf, 0
    angles, skewed = [], []
    floor = _Faces.of(layers[0][front.cells])
    before: Array | None = None
    for layer, (inner, outer) in enumerate(pairwise(layers)):
        corners, parts = _jacobians(inner, outer, front.cells)
        roof = _Faces.of(outer[front.cells])
        walls = _Faces.of(
            np.concatenate([inner[around.edges], outer[around.edges][:, ::-1]], axis=1)
        )
        centres, size = around.cells(floor, roof, walls)
        jacobian = min(jacobian, float(corners.min()))
        scaled.append(parts.min(axis=1))
        smallest = min(smallest, float(size.min()))
        low += int(np.count_nonzero((size <= 0.0) | (corners.min(axis=1) <= 0.0)))
        found = [walls.first(len(beside)).seen(centres[beside[:, 0]], centres[beside[:, 1]])]
        if before is not None:
            found.append(floor.seen(before, centres))
        angles += [turned for turned, _ in found]
        for (_, off), own in zip(found, (beside[:, 0], np.arange(len(centres))), strict=False):
            worst_face = int(np.argmax(off))
            skewed.append((float(off[worst_face]), layer, int(own[worst_face])))
        floor, before = roof, centres
    every, steps = np.concatenate(angles), np.linalg.norm(np.diff(layers, axis=0), axis=2)
    away = np.linalg.norm(layers[-1] - layers[0], axis=1)
    ratio, worst = steps[1:] / steps[:-1], np.min(scaled, axis=0)
    starts = np.concatenate([[0], np.cumsum([count for _, count in families])[:-1]])
    return {
        "cells": int(len(front.cells) * (len(layers) - 1)),
        "points": int(layers[..., 0].size),
        "layers": len(layers) - 1,
        "distance_m": {
            "least": float(away.min()),
            "median": float(np.median(away)),
            "largest": float(away.max()),
        },
        "first_height_m": _range(steps[0]),
        "largest_growth": float(max(ratio.max(), 1.0 / ratio.min())),
        "cells_not_positive": low,
        "smallest_volume_m3": smallest,
        "smallest_jacobian_m3": jacobian,
        "smallest_scaled_jacobian": float(worst.min()),
        "smallest_scaled_jacobian_by_block": {
            name: float(part)
            for (name, _), part in zip(families, np.minimum.reduceat(worst, starts), strict=True)
        },
        "scaled_jacobian_of_a_thousandth": float(np.quantile(np.concatenate(scaled), 1e-3)),
        "largest_non_orthogonality_deg": float(np.degrees(every.max())),
        "mean_non_orthogonality_deg": float(np.degrees(np.arccos(np.cos(every).mean()))),
        "faces_over_70_deg": int(np.count_nonzero(every > np.radians(70.0))),
        "largest_skewness": max(skewed)[0],
        "largest_skewness_cell": list(max(skewed)[1:]),
    }


def _jacobians(inner: Array, outer: Array, cells: Indices) -> tuple[Array, Array]:
    """Return the Jacobians of both layers' corners (c, 8), and the scaled ones."""
    up = outer[cells] - inner[cells]
    high = np.linalg.norm(up, axis=2)
    plain, scaled = [], []
    for points in (inner, outer):
        corners = points[cells]
        ahead = np.roll(corners, -1, axis=1) - corners
        behind = -np.roll(ahead, 1, axis=1)
        volume = np.einsum("cij,cij->ci", np.cross(ahead, behind), up)
        length = np.linalg.norm(ahead, axis=2)
        plain.append(volume)
        scaled.append(volume / np.maximum(length * np.roll(length, 1, axis=1) * high, SMALL))
    return np.concatenate(plain, axis=1), np.concatenate(scaled, axis=1)


@dataclass(frozen=True, eq=False)
class _Faces:
    """Quadrilaterals (f, 4, 3), their centres and areas (f, 3), as OpenFOAM has them."""

    points: Array
    middles: Array
    areas: Array

    @classmethod
    def of(cls, points: Array) -> "_Faces":
        """Measure faces by the triangles between their edges and the mean of their points."""
        mean = points.mean(axis=1, keepdims=True)
        after = np.roll(points, -1, axis=1)
        parts = np.cross(after - points, mean - points)  # twice the areas of triangles
        size = np.linalg.norm(parts, axis=2, keepdims=True)
        middles = np.sum(size * (points + after + mean), axis=1) / (3.0 * size.sum(axis=1))
        return cls(points, middles, 0.5 * parts.sum(axis=1))

    def first(self, count: int) -> "_Faces":
        """Return the first of them."""
        return _Faces(self.points[:count], self.middles[:count], self.areas[:count])

    def seen(self, own: Array, other: Array) -> tuple[Array, Array]:
        """Return non-orthogonality [rad] and skewness between centres (f, 3) on both sides."""
        between, there = other - own, self.middles - own
        across = np.einsum("fi,fi->f", self.areas, between)
        aside = np.linalg.norm(np.cross(self.areas, between), axis=1)
        share = np.einsum("fi,fi->f", self.areas, there) / np.where(across == 0.0, SMALL, across)
        off = there - share[:, None] * between
        far = np.linalg.norm(off, axis=1)
        way = off / np.maximum(far, SMALL)[:, None]
        size = np.abs(np.einsum("fki,fi->fk", self.points - self.middles[:, None], way)).max(axis=1)
        size = np.maximum(size, LEAST * np.linalg.norm(between, axis=1))
        return np.arctan2(aside, np.abs(across)), far / size


@dataclass(frozen=True, eq=False)
class _Around:
    """Which faces rise around each cell of a front.

    Over edges (e, 2), those between two cells first; sides (c, 4) are a cell's, and `outward`
    (c, 4) is 1 where the face's normal points out of it, else -1.
    """

    edges: Indices
    sides: Indices
    outward: Array

    @classmethod
    def of(cls, front: Front) -> "_Around":
        corner, beside = front.sides()
        starts = np.concatenate([corner, front.rim()])
        own = np.concatenate([beside[:, 0], front.rim() // 4])
        order = np.argsort(np.concatenate([own, beside[:, 1]]), kind="stable")
        faces = np.concatenate([np.arange(len(starts)), np.arange(len(beside))])
        sign = np.concatenate([np.ones(len(starts)), -np.ones(len(beside))])
        return cls(front.edges(starts), faces[order].reshape(-1, 4), sign[order].reshape(-1, 4))

    def cells(self, floor: _Faces, roof: _Faces, walls: _Faces) -> tuple[Array, Array]:
        """Return the centres (c, 3) and volumes (c,) of cells between faces."""
        middles = np.concatenate(
            [floor.middles[:, None], roof.middles[:, None], walls.middles[self.sides]], axis=1
        )
        around = self.outward[..., None] * walls.areas[self.sides]
        areas = np.concatenate([-floor.areas[:, None], roof.areas[:, None], around], axis=1)
        guess = middles.mean(axis=1, keepdims=True)
        cones = np.einsum("cfi,cfi->cf", areas, middles - guess)  # three times their volumes
        total = cones.sum(axis=1)
        centres = np.sum(cones[..., None] * (0.75 * middles + 0.25 * guess), axis=1)
        return centres / total[:, None], total / 3.0


def _range(values: Array) -> list[float]:
    return [float(values.min()), float(values.max())]
