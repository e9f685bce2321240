"""How good the blocks of a file are, whoever wrote them: cells, angles, and whether blocks meet.

Surfaces have one point along one of their indices.  Jacobians are the triple products of the edges
at a cell's corners, scaled by their lengths 1 for a brick; a cell is folded where one is not
positive, in a volume whose blocks are left-handed where one is not negative.  Sides of cells that
two cells share are told by their points, bit for bit.  Lengths are those of the file.
"""

from itertools import product
from typing import Any

import numpy as np

from bladegen.support.arrays import Array
from bladegen.surface.grids import grid_quality

__all__ = ["figures_of", "triangles_of"]

Blocks = list[tuple[str, Array]]


def figures_of(blocks: Blocks) -> dict[str, Any]:
    """Measure blocks of points (ni, nj, nk, 3), all of surfaces or all of volumes."""
    flat = [min(points.shape[:3]) == 1 for _, points in blocks]
    every = [points.reshape(-1, 3) for _, points in blocks]
    low, high = (np.stack([edge(p, axis=0) for p in every]).T for edge in (np.min, np.max))
    extent = [low.min(axis=1).tolist(), high.max(axis=1).tolist()]
    told = {"blocks": len(blocks), "points": sum(map(len, every))}
    if all(flat):
        return told | _surface([_sheet(points) for _, points in blocks]) | {"bounds": extent}
    solid = [points for (_, points), thin in zip(blocks, flat, strict=True) if not thin]
    beside = {"surfaces_beside": sum(flat)} if any(flat) else {}
    return told | beside | _volume(solid) | {"bounds": extent}


def triangles_of(blocks: Blocks) -> tuple[Array, Any]:
    """Return vertices (p, 3) and triangles (t, 3) of blocks of a surface."""
    vertices, faces, before = [], [], 0
    for _, points in blocks:
        sheet = _sheet(points)
        number = before + np.arange(sheet[..., 0].size).reshape(sheet.shape[:2])
        a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
        faces += [np.stack(corners, axis=-1).reshape(-1, 3) for corners in ((a, b, c), (a, c, d))]
        vertices.append(sheet.reshape(-1, 3))
        before += number.size
    return np.concatenate(vertices), np.concatenate(faces)


def _sheet(points: Array) -> Array:
    """Return a surface's points (ni, nj, 3)."""
    thin: Array = np.squeeze(points, axis=int(np.argmin(points.shape[:3])))
    return thin


def _surface(sheets: list[Array]) -> dict[str, Any]:
    areas = [grid_quality.areas(sheet) for sheet in sheets]
    skewed = [grid_quality.skewness(sheet) for sheet in sheets]
    whole = [~grid_quality.collapsed(sheet) for sheet in sheets]
    scaled = [grid_quality.scaled_jacobian(s)[w] for s, w in zip(sheets, whole, strict=True)]
    folded = sum(int(np.count_nonzero(s[w] > 1.0)) for s, w in zip(skewed, whole, strict=True))
    sides = [_edges(sheet) for sheet in sheets]
    return {
        "cells": sum(area.size for area in areas),
        "folded_cells": folded,
        "no_folded_cell": folded == 0,
        "triangles": sum(int(np.count_nonzero(~w)) for w in whole),
        "smallest_scaled_jacobian": min(float(s.min(initial=1.0)) for s in scaled),
        "worst_skewness": max(float(s.max()) for s in skewed),
        "largest_stretching": max(map(grid_quality.stretching, sheets)),
        "smallest_cell": min(float(area.min()) for area in areas),
        "area": sum(float(area.sum()) for area in areas),
        **_shared(np.concatenate(sides), "edges"),
    }


def _volume(blocks: list[Array]) -> dict[str, Any]:
    least, scaled, folded, cells, total, smallest = [], [], 0, 0, 0.0, np.inf
    hand = np.sign(sum(float(np.sign(_corner(p, (0, 0, 0))[0]).sum()) for p in blocks)) or 1.0
    for points in blocks:
        worst = np.full(np.subtract(points.shape[:3], 1), np.inf)
        sharp = np.inf
        for place in product((0, 1), repeat=3):
            plain, over = _corner(points, place)
            worst = np.minimum(worst, hand * plain)
            sharp = min(sharp, float((hand * over).min()))
        size = hand * _volumes(points)
        least.append(float(worst.min()))
        scaled.append(sharp)
        folded += int(np.count_nonzero(worst <= 0.0))
        cells += worst.size
        total += float(size.sum())
        smallest = min(smallest, float(size.min()))
    return {
        "cells": cells,
        "right_handed": bool(hand > 0.0),
        "folded_cells": folded,
        "no_folded_cell": folded == 0,
        "smallest_jacobian": min(least),
        "smallest_scaled_jacobian": min(scaled),
        "smallest_volume": smallest,
        "volume": total,
        **_shared(np.concatenate([_faces(points) for points in blocks]), "faces"),
    }


def _volumes(points: Array) -> Array:
    """Return the volumes of cells with doubly curved faces.

    J. Grandy, "Efficient computation of volume of hexahedral cells", UCRL-ID-128886 (1997).
    """
    at = {
        n: points[tuple(slice(None, -1) if not n >> a & 1 else slice(1, None) for a in range(3))]
        for n in range(8)
    }
    a, b, c = at[7] - at[1], at[6] - at[0], at[7] - at[2]
    d, e, f = at[3] - at[0], at[5] - at[0], at[7] - at[4]
    parts = ((a + b, c, d), (b, c + e, f), (a, e, f + d))
    total: Array = sum(np.einsum("...c,...c->...", np.cross(x, y), z) for x, y, z in parts) / 12.0
    return total


def _corner(points: Array, place: tuple[int, ...]) -> tuple[Array, Array]:
    """Return the Jacobians of cells at one of their corners, and the scaled ones."""
    i, j, k = (slice(None, -1) if not low else slice(1, None) for low in place)
    u = np.diff(points, axis=0)[:, j, k]
    v = np.diff(points, axis=1)[i, :, k]
    w = np.diff(points, axis=2)[i, j]
    plain: Array = np.einsum("...c,...c->...", np.cross(u, v), w)
    length = np.prod([np.linalg.norm(one, axis=-1) for one in (u, v, w)], axis=0)
    return plain, np.divide(plain, length, out=np.zeros_like(plain), where=length > 0.0)


def _edges(sheet: Array) -> Array:
    """Return the edges (e, 2, 3) of a block's rim, one a cell."""
    lines = (sheet[0], sheet[-1], sheet[:, 0], sheet[:, -1])
    return np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])


def _faces(points: Array) -> Array:
    """Return the faces (f, 4, 3) of a block's hull, one a cell."""
    found = []
    for axis in range(3):
        for end in (0, -1):
            sheet = np.take(points, end, axis=axis)
            corners = sheet[:-1, :-1], sheet[1:, :-1], sheet[:-1, 1:], sheet[1:, 1:]
            found.append(np.stack(corners, axis=2).reshape(-1, 4, 3))
    return np.concatenate(found)


def _shared(sides: Array, what: str) -> dict[str, int]:
    """Count the sides that blocks share, those of one cell alone, and those of more than two."""
    real = sides[~np.all(sides == sides[:, :1], axis=(1, 2))]  # of no length: a pole
    corners = np.sort(np.ascontiguousarray(real + 0.0).view("V24")[..., 0].astype("V24"), axis=1)
    keys = np.ascontiguousarray(corners).view(f"V{24 * real.shape[1]}").reshape(-1)
    count = np.unique(keys, return_counts=True)[1]
    return {
        f"{what}_shared": int(np.count_nonzero(count == 2)),
        f"{what}_open": int(np.count_nonzero(count == 1)),
        f"{what}_of_more_than_two": int(np.count_nonzero(count > 2)),
    }
