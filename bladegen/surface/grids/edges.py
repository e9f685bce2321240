"""The blunt trailing edge: cells across it, and the plane piece under a round tip's arc.

Across the edge, cells begin as high as the sides' first cells are and grow geometrically up to
the middle.  The piece under the arc leaves the sides tangentially, so that a block's corner there
would be of 180 degrees; a ring of cells goes along the arc from side to side instead and
encloses a core.  It is laid out in its half plane: x from -1, pressure side, to 1, suction side,
y along the blade, both over half the edge.  On the arc
x = 1 - 2 (3 w^2 - 2 w^3), y = 4 w (1 - w).
"""

from dataclasses import dataclass

import numpy as np

from bladegen.support.arrays import Array
from bladegen.surface.grids.measuring import (
    LEAST_SINE,
    along_rows,
    away,
    facing_cells,
    lengths,
    sines,
)
from bladegen.surface.grids.stretching import (
    between,
    eased,
    symmetric,
)
from bladegen.surface.tips import on_arcs

__all__ = ["EdgeEnd", "across_edge", "edge_end", "first_cells", "joined"]

JOINED = 5.0  # times the thickness of the edge at the tip
CORNER = 0.47  # the core's corners lie so far out, of the way from the middle to the arc,
WIDEST = 0.55  # but at least at this share of its width on the edge
BULGE = 1.2, 0.2  # exponent of its sides; its top's rise, 4 times over its width
MIRROR = np.array([-1.0, 1.0])


def across_edge(sections: Array, edge: int) -> Array:
    """Return places (k, edge + 1) across the edges of sections (k, n, 3), from pressure side."""
    gap = np.linalg.norm(sections[:, 0] - sections[:, -1], axis=-1)
    half = edge // 2
    suction, pressure = (symmetric(edge, eased(edge, c / gap)) for c in first_cells(sections))
    return np.concatenate([pressure[:, :half], suction[:, half:]], axis=1)


def first_cells(sections: Array) -> tuple[Array, Array]:
    """Return how high the first cells at the trailing edge are on both sides (k,), normal to it."""
    suction, pressure = (
        away(sections[:, after] - sections[:, at], sections[:, at])
        for at, after in ((0, 1), (-1, -2))
    )
    return suction, pressure


def joined(places: Array, row: Array, sections: Array) -> Array:
    """Return places across the edge that lead to those of a tip's `row` in the last section.

    They do over a few times the edge's thickness, as cells there are much shorter than that.
    """
    middle = 0.5 * (sections[:, 0] + sections[:, -1])
    left = np.linalg.norm(middle - middle[-1], axis=-1)
    gap = np.linalg.norm(sections[-1, 0] - sections[-1, -1])
    share = np.exp(-left / (JOINED * gap))[:, None]
    result: Array = places + share * (row - places[-1])
    return result


@dataclass(frozen=True, eq=False)
class EdgeEnd:
    """Where points of the piece under the arc lie.

    Places `a`, 0 to 1 from suction to pressure side, w of the arc's point above, and heights v
    between the edge's last row, 0, and the arc, 1; of the ring (2 b + c + 1, layers + 1) and of
    the core (b + 1, c + 1).
    """

    ring: tuple[Array, Array, Array]
    core: tuple[Array, Array, Array]

    def points(self, suction: Array, pressure: Array, poles: Array) -> tuple[Array, Array]:
        """Return points of ring and core between sides' last points (...), poles (4, ...)."""
        made = []
        for a, w, v in (self.ring, self.core):
            below = suction + a[..., None] * (pressure - suction)
            made.append(below + v[..., None] * (on_arcs(poles[None, None], w) - below))
        return made[0], made[1]


def edge_end(row: Array, arc: Array, layers: int, cells: Array) -> EdgeEnd:
    """Lay out the piece under a round tip's arc.

    Parameters
    ----------
    row : (edge + 1,) array
        Places across the edge in its last row, from pressure side.
    arc : (m,) array
        Places w of the arc's points, from pressure side, 1, to suction side, 0.
    layers : int
        Cells across the ring; as many lie on the arc beside the core's corners.
    cells : (m,) array
        The tip's first cells off the arc there, over the edge's thickness.
    """
    outer = _on_arc(arc)
    below = 2.0 * row - 1.0
    bottom = below[layers : len(row) - layers]
    suction = _side(bottom[:-3:-1], outer[::-1], layers)
    pressure = _side(-bottom[:2], outer * MIRROR, layers) * MIRROR
    width = (bottom - bottom[0]) / (bottom[-1] - bottom[0])
    top = pressure[-1] + width[:, None] * (suction[-1] - pressure[-1])
    top[:, 1] += BULGE[1] * (top[-1, 0] - top[0, 0]) * width * (1.0 - width)
    core = _filled(np.stack([bottom, 0.0 * bottom], -1), top, pressure, suction)
    inner = np.concatenate([pressure, core[-1, 1:-1], suction[::-1]])
    facing = [
        away(core[:, 1] - core[:, 0], core[:, 0]),
        away(core[-2] - core[-1], core[-1]),
        away(core[::-1, -2] - core[::-1, -1], core[::-1, -1]),
    ]
    steps = inner - outer
    total = np.linalg.norm(steps, axis=-1)
    begin = 2.0 * cells / np.maximum(sines(steps, outer), LEAST_SINE)
    final = facing_cells(-steps, inner, facing)
    t = between(layers, begin / total, final / total)[..., None]
    ring = (1.0 - t) * outer[:, None] + t * inner[:, None]
    ring[0, :, 0], ring[-1, :, 0] = below[: layers + 1], below[: -layers - 2 : -1]
    ring[[0, -1], :, 1] = 0.0
    return EdgeEnd(_places(ring), _places(core))


def _on_arc(w: Array) -> Array:
    return np.stack([1.0 - 2.0 * (3.0 * w**2 - 2.0 * w**3), 4.0 * w * (1.0 - w)], axis=-1)


def _places(points: Array) -> tuple[Array, Array, Array]:
    """Return a, w and v of points (..., 2) of the half plane."""
    a = np.clip(0.5 * (1.0 - points[..., 0]), 0.0, 1.0)
    w = 0.5 - np.sin(np.arcsin(1.0 - 2.0 * a) / 3.0)  # a = 3 w^2 - 2 w^3
    high = 4.0 * w * (1.0 - w)
    v = np.divide(points[..., 1], high, out=np.zeros_like(high), where=high > 0.0)
    return a, w, np.clip(v, 0.0, 1.0)


def _side(ends: Array, arc: Array, cells: int) -> Array:
    """Return points (cells + 1, 2) from the edge's last row to the core's corner on the right.

    There start the core's cells in that row, of which the first is between `ends` (2,), and the
    arc's points (m, 2).
    """
    start, corner = ends[0], CORNER * arc[cells]
    corner[0] = max(corner[0], WIDEST * start)
    first = np.linalg.norm(np.diff(arc[:2], axis=0), axis=-1)
    last = corner[:1] * (1.0 - ends[1] / start)  # as in its top row
    y = np.linspace(0.0, 1.0, 65)
    line = np.stack([start - (start - corner[0]) * y ** BULGE[0], corner[1] * y], axis=-1)
    way = lengths(line)
    t = between(cells, first / way[-1], last / way[-1])
    side: Array = np.stack(
        [along_rows(way[None], line[:, i], t * way[-1])[0] for i in range(2)], axis=-1
    )
    side[0], side[-1] = (start, 0.0), corner
    return side


def _filled(bottom: Array, top: Array, left: Array, right: Array) -> Array:
    """Return points (b + 1, c + 1, 2) between four lines."""
    u = ((bottom[:, 0] - bottom[0, 0]) / (bottom[-1, 0] - bottom[0, 0]))[None, :, None]
    v = (0.5 * (left + right)[:, 1] / (0.5 * (left + right)[-1, 1]))[:, None, None]
    corners = (1 - u) * ((1 - v) * bottom[0] + v * top[0]) + u * (
        (1 - v) * bottom[-1] + v * top[-1]
    )
    sides = (1 - u) * left[:, None] + u * right[:, None]
    filled: Array = (1 - v) * bottom[None] + v * top[None] + sides - corners
    return filled
