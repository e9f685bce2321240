"""Blocks of a structured grid over a blade: both sides, the trailing edge, and the tip's cap.

What lays points out here is linear in them, so derivatives of points are laid out the same way:
coordinates stand along the last axis, of any length.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.errors import GeometryError
from bladegen.support.arrays import Array, readonly
from bladegen.support.values import brief
from bladegen.surface.grids.caps import Cap
from bladegen.surface.net import CLOSED_EDGE

__all__ = ["Block", "blocks_of", "is_blunt"]


@dataclass(frozen=True, eq=False)
class Block:
    """A block of a grid.

    Parameters
    ----------
    name : str
        As the solid's face; the tip has two blocks.
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


def blocks_of(sections: Array, over: Cap, eta: Array, u: Array, *, blunt: bool) -> list[Block]:
    """Return the blocks of sections (k, n, ...) and a cap: of points, or of derivatives."""
    middle = len(u) // 2
    span = np.broadcast_to(eta[:, None], sections.shape[:2])
    place = np.broadcast_to(u, sections.shape[:2])
    halves = slice(None, middle + 1), slice(middle, None)
    blocks = [
        Block(name, name, sections[:, half], span[:, half], place[:, half])
        for name, half in zip(("suction side", "pressure side"), halves, strict=True)
    ]
    if blunt:
        blocks.append(_edge_block(sections, eta, over))
    for name, points, place in (("rim", over.rim, over.rim_u), ("core", over.core, over.core_u)):
        blocks.append(Block(f"tip {name}", "tip", points, np.ones(place.shape), place))
    return blocks


def _edge_block(sections: Array, eta: Array, over: Cap) -> Block:
    """Return the trailing edge, from pressure to suction side; its last row is the tip's."""
    layers, across = len(over.rim) - 1, len(over.core) - 1
    w = np.linspace(0.0, 1.0, 2 * layers + across + 1)
    points = (1.0 - w[:, None]) * sections[:, -1:] + w[:, None] * sections[:, :1]
    points[:, 0], points[:, -1] = sections[:, -1], sections[:, 0]
    points[-1, : layers + 1] = over.rim[:, -1]
    points[-1, layers : layers + across + 1] = over.core[::-1, 0]
    points[-1, layers + across :] = over.rim[::-1, 0]
    shape = points.shape[:2]
    span = np.broadcast_to(eta[:, None], shape)
    return Block("trailing edge", "trailing edge", points, span, np.broadcast_to(w < 0.5, shape))
