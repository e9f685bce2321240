"""A grid's blocks as one front of quadrilaterals: points, cells of these, and who is beside whom.

Points that blocks share are one.  The front is closed but for the root, whose points are on a
plane.  Around a point, cells follow each other anticlockwise seen from outside; a cell's corner
names its point, the next point and the one before.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.errors import GeometryError, visible
from bladegen.support.arrays import Array, Indices, Mask
from bladegen.support.values import brief
from bladegen.surface.grids.grid import Grid
from bladegen.surface.grids.grid_files import numbered, welded
from bladegen.surface.grids.grid_quality import corner_angles

__all__ = ["Front", "front_of"]

FLAT = 1e-6  # [m] that the root's points may be off their plane


@dataclass(frozen=True, eq=False)
class Front:
    """The welded surface of a grid.

    Parameters
    ----------
    points : (p, 3) array
        [m].
    cells : (c, 4) array of int
        Corners, anticlockwise seen from outside; those of one block after another.
    numbers : list of (ni, nj) arrays of int
        Each block's points.
    centres, ahead, behind : (m,) arrays of int
        Points with two neighbours that lie opposite each other; inner points have two such pairs,
        each of them twice.
    odd, beside : (k,) arrays of int
        Points where other than four lines meet, and each of their neighbours.
    root : (p,) array of bool
        Which points are on the root plane.
    normal : (3,) array
        Of that plane.
    """

    points: Array
    cells: Indices
    numbers: list[Indices]
    centres: Indices
    ahead: Indices
    behind: Indices
    odd: Indices
    beside: Indices
    root: Mask
    normal: Array

    __repr__ = brief

    @cached_property
    def _across(self) -> Indices:
        """The corner across the edge ahead of each corner, -1 at the root's edges."""
        return _turned(self.cells, len(self.points))[1]

    def sides(self) -> tuple[Indices, Indices]:
        """Return the corners (e,) at which edges between two cells begin, and these cells (e, 2).

        Corners are counted through all cells; the first cell is that of the corner, on the left of
        the edge seen from outside.
        """
        over = self._across
        corner = np.flatnonzero(over >= 0)
        beside = np.stack([corner // 4, over[corner] // 4], axis=-1)
        once = beside[:, 0] < beside[:, 1]
        return corner[once], beside[once]

    def rim(self) -> Indices:
        """Return the corners (e,) at which the root's edges begin."""
        return np.flatnonzero(self._across < 0)

    def edges(self, corner: Indices) -> Indices:
        """Return the points (e, 2) of edges that begin at corners (e,)."""
        start, stop = self.cells.reshape(-1), np.roll(self.cells, -1, axis=1).reshape(-1)
        return np.stack([start[corner], stop[corner]], axis=-1)


def front_of(grid: Grid) -> Front:
    """Weld a grid's blocks.

    Raises
    ------
    GeometryError
        If a cell is folded on the surface, or has two corners in one point, as at a sharp
        trailing edge's tip, or the root is not plane.
    """
    first, cells = welded(grid)
    _, numbers = numbered(grid)
    points = np.concatenate([block.points.reshape(-1, 3) for block in grid.blocks])[first]
    if np.any(cells == np.roll(cells, -1, axis=1)):
        raise GeometryError(
            f"{visible(grid.name)}: its trailing edge is sharp, and cells of the tip are triangles "
            "there, on which no volume is built; give the edge a thickness: --trailing-edge 2mm,1%"
        )
    for block in grid.blocks:
        if not corner_angles(block.points).min() > 0.0:
            raise GeometryError(
                f"{visible(grid.name)}: cells of the {block.name} are folded on the surface "
                "already; give other numbers of points or sizes: a smaller --le-spacing, another "
                "--grid-edge"
            )
    over, _ = _turned(cells, len(points))
    ahead = np.roll(cells, -1, axis=1).reshape(-1)
    behind = np.roll(cells, 1, axis=1).reshape(-1)
    at, inner = cells.reshape(-1), over >= 0
    twice = np.where(inner, over[over], -1)
    whole = (twice >= 0) & (over[over[twice]] == np.arange(len(at)))  # four cells, all around
    entered = np.zeros(len(at), dtype=bool)  # corners that follow another
    entered[over[inner]] = True
    open_ = np.flatnonzero(~entered & inner)  # the first of two at the root
    root = np.zeros(len(points), dtype=bool)
    root[at[open_]] = True
    odd = np.flatnonzero(~whole & ~root[at])
    return Front(
        points,
        cells,
        numbers,
        np.concatenate([at[whole], at[open_]]),
        np.concatenate([ahead[whole], ahead[open_]]),
        np.concatenate([ahead[twice[whole]], behind[over[open_]]]),
        at[odd],
        ahead[odd],
        root,
        _plane(visible(grid.name), points[root]),
    )


def _turned(cells: Indices, count: int) -> tuple[Indices, Indices]:
    """Return the corner that follows each around its point, and that across the edge ahead of it.

    Corners are counted through all cells; -1 where there is none.
    """
    start = cells.reshape(-1)
    ahead = np.roll(cells, -1, axis=1).reshape(-1)
    behind = np.roll(cells, 1, axis=1).reshape(-1)
    edge = start * count + ahead
    order = np.argsort(edge)
    over = _found(edge, order, start * count + behind)
    return over, _found(edge, order, ahead * count + start)


def _found(keys: Indices, order: Indices, wanted: Indices) -> Indices:
    """Return the places of wanted numbers among keys, whose order is given; -1 for none."""
    at = np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)
    place: Indices = np.where(keys[order[at]] == wanted, order[at], -1)
    return place


def _plane(name: str, points: Array) -> Array:
    """Return the normal of a plane through points."""
    middle = points.mean(axis=0)
    normal: Array = np.linalg.svd(points - middle, full_matrices=False)[2][2]
    off = float(np.abs((points - middle) @ normal).max())
    if off > FLAT:
        raise GeometryError(
            f"{name}: its root is {off * 1e3:.3g} mm off a plane, on which the volume would end; "
            f"allowed is {FLAT * 1e3:g} mm"
        )
    return normal
