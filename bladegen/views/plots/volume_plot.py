"""The volume around a blade: a plane cut across it, closer at the trailing edge, and its edges."""

from itertools import pairwise
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.support.arrays import Array
from bladegen.surface.grids.grid import Spacing, from_blade
from bladegen.surface.volumes.volume import Extrusion, Volume, volume_of
from bladegen.surface.volumes.volume_quality import scaled_jacobians
from bladegen.views.plots.figures import figure, titled
from bladegen.views.plots.style import INK, SEQUENTIAL

__all__ = ["volume"]

SPACING = Spacing(around=129, along=81, edge=16)
GROWN = Extrusion(first_height=1e-4)
STATION = 0.7  # of the span: where it is cut
CLOSE = 0.9, 0.03  # half a picture's width, of the chord


def volume(blade: Blade, baseline: Blade | None = None) -> Any:  # noqa: ARG001
    """Draw a coarse volume: cells of a cut by their scaled Jacobians, and lines off the edges."""
    drawn, axes = figure(1, 3, width=14, height=5.2)
    made = volume_of(blade, from_blade(blade, SPACING), GROWN)
    least = np.stack(
        [scaled_jacobians(*both, made.front.cells).min(axis=1) for both in pairwise(made.layers)]
    )
    span = (1.0 - STATION) * blade.axis(np.zeros(1)) + STATION * blade.axis(np.ones(1))
    quads, values = _cut(made, least, float(span[0, 2]))
    chord = float(blade.chord(STATION))
    wall = quads[: made.grid.spacing.around - 1, 0]
    edge = 0.5 * (wall[0] + wall[-1])
    middle = 0.5 * (wall.min(axis=0) + wall.max(axis=0))
    for axis, at, half in zip(axes[0, 1:], (middle, edge), CLOSE, strict=True):
        cells = _cells(axis, quads, values)
        size = half * chord
        axis.set(xlim=(at[0] - size, at[0] + size), ylim=(at[1] - size, at[1] + size))
        axis.set(xlabel="y, m", ylabel="x, m")
    _edges(axes[0, 0], made)
    axes[0, 0].set(title=f"lines off leading and trailing edge; {least.size:,} cells")
    axes[0, 1].set(
        title=f"cut at {100 * STATION:g} % span; scaled Jacobian at least {least.min():.2f}"
    )
    axes[0, 2].set(title="trailing edge")
    for axis in axes[0]:
        axis.set_aspect("equal")
    drawn.colorbar(cells, ax=axes, label="scaled Jacobian", shrink=0.8)
    return titled(drawn, blade, "volume")


def _cut(made: Volume, least: Array, height: float) -> tuple[Array, Array]:
    """Return the quadrilaterals (m, 4, 2), y and x, in which a plane of constant z cuts cells.

    And the cells' scaled Jacobians (m,): the sides' and the trailing edge's, whose lines along the
    span pass the plane.  Those on the wall come first, from trailing edge to trailing edge.
    """
    quads, values, start = [], [], 0
    for number, block in enumerate(made.grid.blocks):
        ni, nj = block.eta.shape
        count = (ni - 1) * (nj - 1)
        own = least[:, start : start + count].reshape(-1, ni - 1, nj - 1)
        start += count
        points = made.block(number)
        if block.eta[0, 0] != 0.0:
            continue
        i = np.clip(np.sum(points[..., 2] < height, axis=0) - 1, 0, ni - 2)
        j, k = np.indices(i.shape)
        low, high = points[i, j, k], points[i + 1, j, k]
        share = (height - low[..., 2:]) / (high[..., 2:] - low[..., 2:])
        flat = (low + share * (high - low))[..., 1::-1].swapaxes(0, 1)
        corners = flat[:-1, :-1], flat[:-1, 1:], flat[1:, 1:], flat[1:, :-1]
        quads.append(np.stack(corners, axis=2))
        values.append(own[k[:-1, :-1], i[:-1, :-1], j[:-1, :-1]].swapaxes(0, 1))
    both = np.concatenate(quads, axis=1), np.concatenate(values, axis=1)
    return both[0].reshape(-1, 4, 2), both[1].reshape(-1)


def _edges(axis: Any, made: Volume) -> None:
    """Draw the layers over the leading and the trailing edge, and the lines that leave them."""
    side = made.block(0)
    for column in (0, -1):
        points = side[:, column, :, 1:]
        axis.plot(points[..., 0], points[..., 1], color=INK, linewidth=0.2)
        axis.plot(points[..., 0].T, points[..., 1].T, color=INK, linewidth=0.2)
    axis.set(xlabel="y, m", ylabel="z, m")


def _cells(axis: Any, quads: Array, values: Array) -> Any:
    from matplotlib.collections import PolyCollection

    made = PolyCollection(
        list(quads), array=values, cmap=SEQUENTIAL, clim=(0.0, 1.0), edgecolor=INK, linewidth=0.15
    )
    axis.add_collection(made)
    return made
