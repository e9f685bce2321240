"""Signed distances from points to a surface, and the points of a surface to measure from.

The nearest triangle (VTK's cell locator) says on which patch and where the search begins; Newton's
method on the patch itself ends it, inside its box and its rims.  So distances are as exact as the
surface is, however coarse its triangles.  Metres; vtkmodules is imported when first needed.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.measures.patches import Patch, inside, to_rims
from bladegen.measures.surfaces import Surface
from bladegen.support.arrays import Array, Indices, Mask
from bladegen.surface.mesh import TriangleMesh

__all__ = ["between", "signed"]

COARSE = 12_000  # points of each kind on a patch, at first
WORST = 5  # rows and columns of a patch that are then measured throughout
RECHECKED = 400  # points farthest away that are held against every patch
VERTICES = 200_000  # of a mesh that are measured from
FEWEST = 24  # cells of a patch along an axis, at least


def signed(points: Array, surface: Surface) -> Array:
    """Return distances [m] of points (m, 3) to a surface, positive outside."""
    found = _nearest(points, surface, _Locator(surface))
    worst = np.argsort(-np.abs(found))[:RECHECKED]
    if len(surface.patches) > 1:
        for part in range(-1, len(surface.patches)):
            some = surface.owner == part
            corners = surface.mesh.vertices[np.unique(surface.mesh.faces[some])]
            near = worst[_away(points[worst], corners) < np.abs(found[worst])]
            if near.size:
                there = _nearest(points[near], surface, _Locator(surface, some))
                nearer = np.abs(there) < np.abs(found[near])
                found[near[nearer]] = there[nearer]
    return found


def _away(points: Array, corners: Array) -> Array:
    """Return distances (m,) from points to the box around others, infinite if there are none."""
    if not len(corners):
        return np.full(len(points), np.inf)
    outside = np.maximum(corners.min(axis=0) - points, points - corners.max(axis=0))
    away: Array = np.linalg.norm(np.maximum(outside, 0.0), axis=1)
    return away


def between(one: Surface, other: Surface) -> tuple[Array, Array]:
    """Return points (m, 3) of a surface and their signed distances (m,) to another one.

    Patches are measured at `net.BETWEEN` of their cells along u and at 1/3 and 3/4 along v, at a
    part of these first and then along the rows and columns that lie farthest away.
    """
    sites = [_Sites.of(patch) for patch in one.patches if not patch.rims]
    flat = np.isin(one.owner, [-1, *(k for k, p in enumerate(one.patches) if p.rims)])
    corners = np.unique(one.mesh.faces[flat])
    corners = corners[:: max(1, len(corners) // VERTICES)]
    points = [one.mesh.vertices[corners], *(site.points(site.coarse) for site in sites)]
    counts = np.cumsum([len(part) for part in points])
    distances = [signed(np.concatenate(points), other)]
    parts = np.split(distances[0], counts[:-1])[1:]
    finer = [
        site.points(site.around(np.abs(part))) for site, part in zip(sites, parts, strict=True)
    ]
    if sites:
        points += finer
        distances.append(signed(np.concatenate(finer), other))
    return np.concatenate(points), np.concatenate(distances)


@dataclass(frozen=True, eq=False)
class _Sites:
    """Where a patch is measured: a grid of parameters, of which a few rows and columns at first."""

    patch: Patch
    u: Array
    v: Array

    @classmethod
    def of(cls, patch: Patch) -> "_Sites":
        (a, b), (c, d) = (_cells(patch, axis) for axis in (0, 1))
        v = np.concatenate([c + (d - c) / 3.0, c + 0.75 * (d - c), patch.low[1:], patch.high[1:]])
        return cls(
            patch, np.concatenate([patch.low[:1], 0.5 * (a + b), patch.high[:1]]), np.sort(v)
        )

    @property
    def coarse(self) -> Mask:
        """Some columns at all u, and some rows at all v: a mask (ku, kv)."""
        chosen = np.zeros((len(self.u), len(self.v)), dtype=bool)
        step = max(1, chosen.size // COARSE)
        chosen[:: min(step, max(1, len(self.u) // 4))] = True
        chosen[:, :: min(step, max(1, len(self.v) // 4))] = True
        return chosen

    def around(self, distances: Array) -> Mask:
        """Return which sites share a row or a column with the worst of the coarse ones."""
        rows, columns = np.nonzero(self.coarse)
        chosen = np.zeros((len(self.u), len(self.v)), dtype=bool)
        for axis, at in ((0, rows), (1, columns)):
            worst = np.zeros(chosen.shape[axis])
            np.maximum.at(worst, at, distances)
            some = np.argsort(-worst)[:WORST]
            chosen[(some, slice(None)) if axis == 0 else (slice(None), some)] = True
        fresh: Mask = chosen & ~self.coarse
        return fresh

    def points(self, chosen: Mask) -> Array:
        i, j = np.nonzero(chosen)
        return self.patch.at(np.stack([self.u[i], self.v[j]], axis=1))[0]


def _cells(patch: Patch, axis: int) -> tuple[Array, Array]:
    """Return starts and ends of a patch's cells along an axis, cut where they are few."""
    x = patch.cells(axis)
    pieces = -(-FEWEST // (len(x) - 1)) if patch.degrees[axis] > 1 else 2
    share = np.arange(pieces + 1) / pieces
    fine = np.unique(x[:-1, None] + share * np.diff(x)[:, None])
    return fine[:-1], fine[1:]


def _nearest(points: Array, surface: Surface, locator: "_Locator") -> Array:
    """Return signed distances: on the nearest triangle, or on its patch from there."""
    cell, place = locator(points)
    corners = surface.mesh.faces[cell]
    a, b, c = (surface.mesh.vertices[corners[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    weights = _shares(place, a, b, c, normal)
    start = np.sum(weights[..., None] * surface.uv[corners], axis=1)
    for k, patch in enumerate(surface.patches):
        some = np.flatnonzero(surface.owner[cell] == k)
        if not some.size:
            continue
        uv, there, outward = patch.nearest(points[some], start[some])
        if patch.rims:
            beyond = np.flatnonzero(~inside(patch.rims, uv))
            if beyond.size:
                at, there[beyond] = to_rims(patch, points[some[beyond]])
                _, du, dv = patch.at(at)
                outward[beyond] = patch.sign * np.cross(du, dv)
        place[some], normal[some] = there, outward
    gap = points - place
    sign = np.where(np.sum(gap * normal, axis=1) < 0, -1.0, 1.0)
    distances: Array = sign * np.linalg.norm(gap, axis=1)
    return distances


def _shares(points: Array, a: Array, b: Array, c: Array, normal: Array) -> Array:
    """Return the barycentric coordinates (m, 3) of points on triangles."""
    square = np.maximum(np.sum(normal * normal, axis=1), 1e-300)
    second = np.sum(np.cross(points - a, c - a) * normal, axis=1) / square
    third = np.sum(np.cross(b - a, points - a) * normal, axis=1) / square
    shares: Array = np.stack([1.0 - second - third, second, third], axis=1)
    return shares


class _Locator:
    """Finds the nearest of a surface's triangles, or of some of them."""

    def __init__(self, surface: Surface, some: Array | None = None) -> None:
        from vtkmodules.vtkCommonDataModel import vtkCellLocator

        self.which = np.arange(len(surface.mesh.faces)) if some is None else np.flatnonzero(some)
        self.data = _poly_data(surface.mesh, self.which)
        # the static one is as quick, and takes a gigabyte where triangles are long and many
        self.locator: Any = vtkCellLocator()
        self.locator.SetDataSet(self.data)
        self.locator.BuildLocator()

    def __call__(self, points: Array) -> tuple[Indices, Array]:
        """Return the nearest triangle of each point, and the nearest point on it."""
        from vtkmodules.vtkCommonCore import reference
        from vtkmodules.vtkCommonDataModel import vtkGenericCell

        filled: Any = (vtkGenericCell(), reference(0), reference(0), reference(0.0))
        number, place = filled[1], [0.0, 0.0, 0.0]
        cells, places = np.zeros(len(points), dtype=np.int64), np.zeros((len(points), 3))
        find = self.locator.FindClosestPoint
        for i, point in enumerate(points.tolist()):
            find(point, place, *filled)
            cells[i], places[i] = number.get(), place
        return self.which[cells], places


def _poly_data(mesh: TriangleMesh, which: Indices) -> Any:
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    points, cells, data = vtkPoints(), vtkCellArray(), vtkPolyData()
    floats: Any = numpy_to_vtk
    integers: Any = numpy_to_vtkIdTypeArray
    points.SetData(floats(np.array(mesh.vertices), deep=True))
    faces = np.ascontiguousarray(mesh.faces[which])
    starts = np.arange(len(faces) + 1) * 3
    cells.SetData(
        integers(starts, deep=True),
        integers(faces.ravel(), deep=True),
    )
    data.SetPoints(points)
    data.SetPolys(cells)
    return data
