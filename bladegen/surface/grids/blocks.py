"""Blocks of a structured grid over a blade: both sides, the trailing edge, and the tip's cap.

What lays points out here is linear in them, so derivatives of points are laid out the same way:
coordinates stand along the last axis, of any length.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.errors import GeometryError
from bladegen.support.arrays import Array, readonly
from bladegen.support.values import brief
from bladegen.surface.grids.caps import Cap, Layout, divisions
from bladegen.surface.grids.edges import EdgeEnd, across_edge, edge_end, joined
from bladegen.surface.grids.tip_layout import layout
from bladegen.surface.net import CLOSED_EDGE

__all__ = ["Block", "Frame", "frame", "is_blunt"]


@dataclass(frozen=True, eq=False)
class Block:
    """A block of a grid.

    Parameters
    ----------
    name : str
        As the solid's face; the tip has two blocks, and so has the piece of a blunt trailing edge
        under a round tip's arc.
    family : str
        The solid's face that it belongs to.
    points : (ni, nj, 3) array
        Points [m]; on the sides i runs from root to tip, j around.
    eta, u : (ni, nj) arrays
        Span fraction and landmark parameter; between the sides those of the nearer one.
    """

    name: str
    family: str
    points: Array
    eta: Array
    u: Array

    __repr__ = brief

    def __post_init__(self) -> None:
        for name in ("points", "eta", "u"):
            object.__setattr__(self, name, readonly(getattr(self, name)))


def is_blunt(name: str, sections: Array) -> bool:
    """Tell whether the trailing edge of sections (k, n, 3) is blunt, or sharp.

    Raises
    ------
    GeometryError
        If it is both.
    """
    gap = np.linalg.norm(sections[:, 0] - sections[:, -1], axis=-1)
    blunt = bool(gap.max() > CLOSED_EDGE)
    if blunt and gap.min() <= CLOSED_EDGE:
        raise GeometryError(
            f"{name}: the trailing edge is sharp at some spans and blunt at others; give "
            "it a minimum thickness or make it sharp everywhere"
        )
    return blunt


@dataclass(frozen=True, eq=False)
class Frame:
    """Where a grid's points lie, from the sections of the blade that it is laid out for.

    `cap` lays out the tip; across a blunt trailing edge points lie at places `edge`
    (k, edge + 1), and `end` lays out the piece under a round tip's arc.  A sharp edge has
    neither, a flat tip no `end`.
    """

    cap: Layout
    edge: Array | None
    end: EdgeEnd | None

    @property
    def places(self) -> Array:
        """Landmark parameters of the last section's points from which the tip is made."""
        return self.cap.places[0]

    def blocks(
        self, sections: Array, over: tuple[Array, Array | None], eta: Array, u: Array
    ) -> list[Block]:
        """Return the blocks of sections (k, n, ...): of points, or of derivatives.

        `over` are the last section's points at `places`, and its arcs' poles on a round tip.
        """
        made = self.cap.cap(sections[-1], *self.cap.points(*over), sharp=self.edge is None)
        middle = len(u) // 2
        span = np.broadcast_to(eta[:, None], sections.shape[:2])
        place = np.broadcast_to(u, sections.shape[:2])
        halves = slice(None, middle + 1), slice(middle, None)
        blocks = [
            Block(name, name, sections[:, half], span[:, half], place[:, half])
            for name, half in zip(("suction side", "pressure side"), halves, strict=True)
        ]
        if self.edge is not None:
            edge = _edge_points(sections, self.edge)
            if self.end is None:
                edge[-1] = np.concatenate(
                    [made.rim[:-1, -1], made.core[::-1, 0], made.rim[-2::-1, 0]]
                )
            span = np.broadcast_to(eta[:, None], self.edge.shape)
            nearer = (self.edge < 0.5).astype(np.float64)
            blocks.append(Block("trailing edge", "trailing edge", edge, span, nearer))
        if self.end is not None and over[1] is not None:
            blocks += _end_blocks(self.end, sections[-1], over[1][0], edge[-1], made)
        for name, points, at in (("rim", made.rim, made.rim_u), ("core", made.core, made.core_u)):
            blocks.append(Block(f"tip {name}", "tip", points, np.ones(at.shape), at))
        return blocks


def frame(sections: Array, u: Array, edge: int, poles: Array | None, *, blunt: bool) -> Frame:
    """Lay out a grid over sections (k, n, 3); a round tip has `poles` (n // 2 + 1, 4, 3) there."""
    over = layout(sections[-2:], u, edge, poles)
    if not blunt:
        return Frame(over, None, None)
    across = across_edge(sections, edge)
    row = np.concatenate([over.rim_w[:-1, -1], over.core_w[::-1, 0], over.rim_w[-2::-1, 0]])
    if poles is None:
        return Frame(over, joined(across, 1.0 - row, sections), None)
    layers, _ = divisions(edge, flat=False)
    outline = sections[-1]
    cells = over.edge_cells[::-1] / np.linalg.norm(outline[0] - outline[-1])
    return Frame(over, across, edge_end(across[-1], row, layers, cells))


def _edge_points(sections: Array, places: Array) -> Array:
    """Return the trailing edge, from pressure to suction side."""
    w = places[..., None]
    points: Array = (1.0 - w) * sections[:, -1:] + w * sections[:, :1]
    points[:, 0], points[:, -1] = sections[:, -1], sections[:, 0]
    return points


def _end_blocks(end: EdgeEnd, outline: Array, poles: Array, row: Array, over: Cap) -> list[Block]:
    """Return the ring along a round tip's arc at the trailing edge, and the core inside it."""
    ring, core = end.points(outline[0], outline[-1], poles)
    arc = np.concatenate([over.rim[:-1, -1], over.core[::-1, 0], over.rim[-2::-1, 0]])
    layers, high, last = ring.shape[1] - 1, len(core) - 1, len(ring) - 1
    ring[:, 0] = arc
    ring[0], ring[-1] = row[: layers + 1], row[: -layers - 2 : -1]
    core[0] = row[layers : len(row) - layers]
    core[:, 0], core[:, -1] = ring[: high + 1, layers], ring[: last - high - 1 : -1, layers]
    core[-1] = ring[high : last - high + 1, layers]
    return [
        Block(f"edge {name}", "trailing edge", points, np.ones(a.shape), (a > 0.5).astype(float))
        for name, points, (a, _, _) in (("ring", ring, end.ring), ("core", core, end.core))
    ]
