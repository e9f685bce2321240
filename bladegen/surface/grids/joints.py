"""How a structured grid's cells compare across the edges that its blocks share.

A cell's height there is the distance of its block's next line of points from the edge, normal to
it; the jump at a point of the edge is how many times as high the cells of one block are as those
of the other.  Metres.
"""

from typing import Any

import numpy as np

from bladegen.support.arrays import Array
from bladegen.surface.grids.grid import Block, Grid
from bladegen.surface.grids.interfaces import Corner, Interface
from bladegen.surface.grids.measuring import away

__all__ = ["heights", "jump_figures", "jumps"]

COLLAPSED = 1e-9  # [m]: a cell less high belongs to a point where blocks come together


def jumps(grid: Grid, interface: Interface) -> Array:
    """Return the jumps (m,), at least 1, along an interface.

    They are NaN where both blocks come together in one point, as tips do at a sharp edge.
    """
    own, other = heights(grid, interface)
    found = np.full(len(own), np.nan)
    sound = np.minimum(own, other) > COLLAPSED
    ratio = own[sound] / other[sound]
    found[sound] = np.maximum(ratio, 1.0 / ratio)
    return found


def heights(grid: Grid, interface: Interface) -> tuple[Array, Array]:
    """Return the heights (m,) [m] of both blocks' first cells, normal to an interface."""
    edge, _ = grid.along(interface)
    own = _next(grid.blocks[interface.block], interface.start, interface.stop)
    other = _next(grid.blocks[interface.donor], interface.donor_start, interface.donor_stop)

    return away(own - edge, edge), away(other - edge, edge)


def jump_figures(grid: Grid) -> dict[str, Any]:
    """Measure the jumps: the largest and the median, of all edges and between each two blocks."""
    between: dict[str, list[Array]] = {}
    for joint in grid.interfaces:
        pair = f"{grid.blocks[joint.block].name} - {grid.blocks[joint.donor].name}"
        between.setdefault(pair, []).append(jumps(grid, joint))
    joined = {pair: np.concatenate(found) for pair, found in between.items()}
    every = np.concatenate(list(joined.values()))
    return {
        "largest_jump": float(np.nanmax(every)),
        "median_jump": float(np.nanmedian(every)),
        "collapsed_edge_points": int(np.count_nonzero(np.isnan(every))),
        "largest_and_median_jump_between": {
            pair: [float(np.nanmax(found)), float(np.nanmedian(found))]
            for pair, found in joined.items()
        },
    }


def _next(block: Block, start: Corner, stop: Corner) -> Array:
    """Return the points (m, 3) of the line beside an edge of a block, in the edge's order."""
    axis = 0 if start[0] != stop[0] else 1  # along which the edge runs
    across, sense = start[1 - axis], 1 if stop[axis] > start[axis] else -1
    inward = across + (1 if across == 0 else -1)
    line = np.take(block.points, inward, axis=1 - axis)
    first, last = sorted((start[axis], stop[axis]))
    kept: Array = line[first : last + 1][::sense]
    return kept
