"""How good a blade's structured grid is at its tip: scaled Jacobians, and jumps across edges."""

from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.support.arrays import Array
from bladegen.surface.grids.grid import from_blade
from bladegen.surface.grids.grid_quality import grid_figures, scaled_jacobian
from bladegen.surface.tips import TIPS
from bladegen.views.plots.figures import figure, titled
from bladegen.views.plots.style import INK, SEQUENTIAL

__all__ = ["grid"]

NOSE, EDGE = 0.06, 1.6  # half a picture's width: of the chord at the nose, of the edge's thickness
THINNEST = 0.004  # of the chord: what a sharp edge is taken for


def grid(blade: Blade, baseline: Blade | None = None) -> Any:  # noqa: ARG001
    """Draw the cells of flat and round tips, by their scaled Jacobians; at nose and edge closer."""
    drawn, axes = figure(len(TIPS), 3, width=14, height=6.4)
    cells = None
    for row, (kind, tip) in zip(axes, TIPS.items(), strict=True):
        made = from_blade(blade, tip=tip)
        figures = grid_figures(made)
        outline = np.concatenate([block.points[-1] for block in made.blocks[:2]])
        nose, edge = made.blocks[0].points[-1, -1], 0.5 * (outline[0] + outline[-1])
        gap = float(np.linalg.norm(outline[0] - outline[-1]))
        along = (edge - nose) / np.linalg.norm(edge - nose)
        normal = np.cross(along, _outward(outline))
        chord = float(np.dot(edge - nose, along))
        frame = np.stack([along, normal / np.linalg.norm(normal)], axis=-1)
        quads, values = [], []
        for block in made.blocks[2:]:
            if block.eta[0, 0] == 1.0:  # those of the tip, the edge's under a round one included
                points = (block.points - nose) @ frame
                corners = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
                quads.append(np.stack(corners, axis=2).reshape(-1, 4, 2))
                values.append(scaled_jacobian(block.points).reshape(-1))
        close = NOSE * chord, EDGE * max(gap, THINNEST * chord)
        views = ((0.5 * chord, 0.55 * chord), (0.6 * close[0], close[0]), (chord, close[1]))
        middle = float((edge - nose) @ frame[:, 1])
        for axis, (at, half), height in zip(row, views, (0.0, 0.0, middle), strict=True):
            centre, size = np.array([at, height]), np.array([half, 0.6 * half])
            cells = _cells(axis, np.concatenate(quads), np.concatenate(values), centre, size)
            limits = np.stack([centre - size, centre + size])
            axis.set(xlim=limits[:, 0], ylim=limits[:, 1])
            axis.set_aspect("equal")
            axis.set_ylabel("m")
        worst = min(
            figures["by_block"][block.name]["smallest_scaled_jacobian"] for block in made.blocks[2:]
        )
        row[0].set(title=f"{kind} tip: scaled Jacobian at least {worst:.2f}")
        row[1].set(title=f"nose; largest jump of the grid {figures['largest_jump']:.2f}")
        row[2].set(title="trailing edge")
    drawn.colorbar(cells, ax=axes, label="scaled Jacobian", shrink=0.8)
    return titled(drawn, blade, "structured grid at the tip")


def _outward(outline: Array) -> Array:
    """Return the direction in which a closed outline's plane faces."""
    centred = outline - outline.mean(axis=0)
    area: Array = np.cross(centred[:-1], centred[1:]).sum(axis=0)
    return area


def _cells(axis: Any, quads: Array, values: Array, centre: Array, size: Array) -> Any:
    """Draw the cells that reach into a view: a file holds no others."""
    from matplotlib.collections import PolyCollection

    low, high = quads.min(axis=1) - centre, quads.max(axis=1) - centre
    seen = np.all((low < size) & (high > -size), axis=1)
    made = PolyCollection(
        list(quads[seen]),
        array=values[seen],
        cmap=SEQUENTIAL,
        clim=(0.0, 1.0),
        edgecolor=INK,
        linewidth=0.15,
    )
    axis.add_collection(made)
    return made
