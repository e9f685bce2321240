"""How good a structured grid's cells are: sizes, skewness, stretching, and whether blocks match.

Skewness is by angles, 0 for a rectangle and 1 for a cell that has collapsed: the largest of
(angle - 90) / 90 and (90 - angle) / 90 degrees over its corners.  The scaled Jacobian is the
smallest sine of a corner's angle, 1 for a rectangle, negative where a cell is folded.  Stretching
is how many times as long one cell is as its neighbour along i or j in the same block; what cells of
two blocks differ by is in `joints`.  Metres.
"""

from dataclasses import asdict
from typing import Any

import numpy as np

from bladegen.support.arrays import Array, Mask
from bladegen.surface.grids.grid import Block, Grid
from bladegen.surface.grids.joints import jump_figures

__all__ = [
    "areas",
    "collapsed",
    "corner_angles",
    "grid_figures",
    "scaled_jacobian",
    "skewness",
    "stretching",
]


def corner_angles(points: Array) -> Array:
    """Return the angles [rad] at the corners of the cells of points (ni, nj, 3).

    They are signed about each cell's own normal, so that a folded corner's is negative; the
    result is (ni - 1, nj - 1, 4).
    """
    corners = _corners(points)
    ahead = np.roll(corners, -1, axis=2) - corners
    behind = np.roll(corners, 1, axis=2) - corners
    normal = np.cross(corners[:, :, 2] - corners[:, :, 0], corners[:, :, 3] - corners[:, :, 1])
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    sine = np.sum(np.cross(ahead, behind) * normal[:, :, None], axis=-1)
    angles: Array = np.arctan2(sine, np.sum(ahead * behind, axis=-1))
    return angles


def skewness(points: Array) -> Array:
    """Return the cells' skewness (ni - 1, nj - 1), 0 to 1, more than 1 where one is folded."""
    off: Array = np.abs(corner_angles(points) / (0.5 * np.pi) - 1.0)
    worst: Array = off.max(axis=-1)
    return worst


def collapsed(points: Array) -> Mask:
    """Tell which cells (ni - 1, nj - 1) are triangles: two of their corners are one point."""
    corners = _corners(points)
    alike: Mask = np.any(np.all(np.roll(corners, -1, axis=2) == corners, axis=-1), axis=-1)
    return alike


def scaled_jacobian(points: Array) -> Array:
    """Return the cells' scaled Jacobians (ni - 1, nj - 1), 0 for triangles."""
    least: Array = np.sin(corner_angles(points)).min(axis=-1)
    return least


def areas(points: Array) -> Array:
    """Return the cells' areas (ni - 1, nj - 1) [m2]."""
    corners = _corners(points)
    crossed = np.cross(corners[:, :, 2] - corners[:, :, 0], corners[:, :, 3] - corners[:, :, 1])
    area: Array = 0.5 * np.linalg.norm(crossed, axis=-1)
    return area


def stretching(points: Array) -> float:
    """Return the largest ratio of the lengths of neighbouring cells, at least 1."""
    worst = 1.0
    for axis in (0, 1):
        lengths = np.moveaxis(np.linalg.norm(np.diff(points, axis=axis), axis=-1), axis, 0)
        small = np.minimum(lengths[1:], lengths[:-1])
        large = np.maximum(lengths[1:], lengths[:-1])
        worst = max(worst, float(np.max(large[small > 0] / small[small > 0], initial=1.0)))
    return worst


def grid_figures(grid: Grid) -> dict[str, Any]:
    """Measure a grid: its size, its cells, and how well its blocks match.

    Scaled Jacobians and corners' angles are those of cells that are no triangles; these are
    counted.
    """
    blocks = {block.name: _block_figures(block) for block in grid.blocks}
    leading, trailing = _edge_cells(grid)
    gaps = [np.abs(own - other).max() for own, other in map(grid.along, grid.interfaces)]
    return {
        "blocks": len(blocks),
        "points": sum(block.points[..., 0].size for block in grid.blocks),
        "cells": sum(figures["cells"] for figures in blocks.values()),
        "smallest_cell_m2": min(figures["smallest_cell_m2"] for figures in blocks.values()),
        "folded_cells": sum(figures["folded_cells"] for figures in blocks.values()),
        "collapsed_cells": sum(figures["collapsed_cells"] for figures in blocks.values()),
        "worst_skewness": max(figures["worst_skewness"] for figures in blocks.values()),
        "smallest_scaled_jacobian": min(f["smallest_scaled_jacobian"] for f in blocks.values()),
        "corner_angles_deg": [
            min(figures["corner_angles_deg"][0] for figures in blocks.values()),
            max(figures["corner_angles_deg"][1] for figures in blocks.values()),
        ],
        "largest_stretching": max(figures["largest_stretching"] for figures in blocks.values()),
        **jump_figures(grid),
        "spacing": asdict(grid.spacing),
        "leading_edge_cell_of_side": leading,
        "trailing_edge_cell_of_side": trailing,
        "tip_cell_m": _range([_tip_cells(grid)]),
        "interfaces": len(grid.interfaces),
        "interface_gap_m": float(max(gaps)),
        "by_block": blocks,
    }


def _block_figures(block: Block) -> dict[str, Any]:
    ni, nj, _ = block.points.shape
    skewed, triangles = skewness(block.points), collapsed(block.points)
    angles = np.degrees(corner_angles(block.points)[~triangles]) % 360.0
    return {
        "points": [ni, nj],
        "cells": (ni - 1) * (nj - 1),
        "smallest_cell_m2": float(areas(block.points).min()),
        "folded_cells": int(np.count_nonzero(skewed > 1.0)),
        "collapsed_cells": int(np.count_nonzero(triangles)),
        "worst_skewness": float(skewed.max()),
        "smallest_scaled_jacobian": float(scaled_jacobian(block.points)[~triangles].min()),
        "corner_angles_deg": _range([angles]),
        "largest_stretching": stretching(block.points),
    }


def _edge_cells(grid: Grid) -> tuple[list[float], list[float]]:
    """Return the least and the largest cell at the leading and at the trailing edge.

    Each over the length of its section's side.
    """
    leading, trailing = [], []
    for block, nose in zip(grid.blocks[:2], (-1, 0), strict=True):
        lengths = np.linalg.norm(np.diff(block.points, axis=1), axis=-1)
        shares = lengths / lengths.sum(axis=1, keepdims=True)
        leading.append(shares[:, nose])
        trailing.append(shares[:, -1 - nose])
    return _range(leading), _range(trailing)


def _range(values: list[Array]) -> list[float]:
    return [float(np.min(values)), float(np.max(values))]


def _tip_cells(grid: Grid) -> Array:
    last = grid.blocks[0].points[-2:]
    sizes: Array = np.linalg.norm(last[1] - last[0], axis=-1)
    return sizes


def _corners(points: Array) -> Array:
    """Return the corners (ni - 1, nj - 1, 4, 3) of cells, in order around each."""
    return np.stack([points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]], axis=2)
