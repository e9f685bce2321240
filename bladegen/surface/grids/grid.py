"""A blade's surface as structured blocks of quadrilaterals that match point to point.

Suction side, trailing edge and pressure side form an O around every section; the tip, flat or
round, is covered by two blocks without a singular point: a rim along the section's outline, and
a core between its two halves.  The root stays open.  All points lie on `Blade.sections` or on
the tip's own surface; normals, i cross j, point outward.  Metres, blade frame.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import GeometryError, visible
from bladegen.support.arrays import Array
from bladegen.surface.grids.blocks import Block, blocks_of, is_blunt
from bladegen.surface.grids.caps import cap, divisions
from bladegen.surface.grids.stretching import MINIMUM_CELLS, two_sided
from bladegen.surface.tips import Tip, flat_tip

__all__ = ["Block", "Grid", "Interface", "Spacing", "from_blade"]

AXIS_POINTS = 2001  # at which the length along the axis is measured


@dataclass(frozen=True)
class Spacing:
    """How many points a grid has, and how fine it is where it matters.

    Parameters
    ----------
    around : int
        Points around a section, from trailing edge to trailing edge; odd.
    along : int
        Points from root to tip.
    edge : int
        Cells across the trailing edge, and across the tip; even.
    leading_edge, trailing_edge : float
        Cell sizes there, as fractions of the length of a section's side, about a chord.
    tip, root : float
        Cell sizes there, as fractions of the length of the blade's axis.
    """

    around: int = 257
    along: int = 129
    edge: int = 8
    leading_edge: float = 1e-3
    trailing_edge: float = 1e-3
    tip: float = 2e-4
    root: float = 0.01

    def __post_init__(self) -> None:
        least = 2 * (self.edge // 2 + 2 * MINIMUM_CELLS) + 1
        if self.edge < 4 or self.edge % 2:
            raise GeometryError(f"grid edge: got {self.edge}, allowed are even numbers from 4")
        if self.around < least or self.around % 2 == 0:
            raise GeometryError(
                f"grid around: got {self.around}, allowed are odd numbers from {least}"
            )
        if self.along <= MINIMUM_CELLS:
            raise GeometryError(
                f"grid along: got {self.along}, at least {MINIMUM_CELLS + 1} are needed"
            )
        self._sides()
        self._lengths()

    def _sides(self) -> Array:
        names = "trailing-edge spacing", "leading-edge spacing"
        return two_sided(self.around // 2, self.trailing_edge, self.leading_edge, names=names)

    def _lengths(self) -> Array:
        names = "root spacing", "tip spacing"
        return two_sided(self.along - 1, self.root, self.tip, names=names)

    def parameters(self) -> Array:
        """Return the landmark parameters (around,), symmetric about 0.5."""
        side = 0.5 * self._sides()
        return np.concatenate([side, 1.0 - side[-2::-1]])

    def spans(self, blade: Blade) -> Array:
        """Return the span fractions (along,), spaced along a blade's axis."""
        eta = np.linspace(0.0, 1.0, AXIS_POINTS)
        steps = np.linalg.norm(np.diff(blade.axis(eta), axis=0), axis=-1)
        length = np.concatenate([[0.0], np.cumsum(steps)])
        spans: Array = np.interp(self._lengths() * length[-1], length, eta)
        return spans


Corner = tuple[int, int]


@dataclass(frozen=True)
class Interface:
    """Two edges of blocks with the same points in the same order.

    Parameters
    ----------
    block, donor : int
        The blocks' places in the grid.
    start, stop, donor_start, donor_stop : (int, int)
        Indices, from 0, of the edges' first and last points.
    transform : (int, int)
        For i and j of the block: which index of the donor goes along, 1 or 2, negative if it
        runs the other way (as CGNS writes it).
    """

    block: int
    donor: int
    start: Corner
    stop: Corner
    donor_start: Corner
    donor_stop: Corner
    transform: Corner


@dataclass(frozen=True, eq=False)
class Grid:
    """Blocks of a blade's surface and how they join."""

    name: str
    blocks: tuple[Block, ...]
    interfaces: tuple[Interface, ...]
    spacing: Spacing = field(default_factory=Spacing)

    def __repr__(self) -> str:
        points = sum(block.eta.size for block in self.blocks)
        return f"<Grid {visible(self.name)}: {len(self.blocks)} blocks, {points} points>"

    def along(self, interface: Interface) -> tuple[Array, Array]:
        """Return the points (m, 3) of both edges of an interface."""
        own = _line(self.blocks[interface.block].points, interface.start, interface.stop)
        other = self.blocks[interface.donor].points
        return own, _line(other, interface.donor_start, interface.donor_stop)


def from_blade(blade: Blade, spacing: Spacing | None = None, tip: Tip = flat_tip) -> Grid:
    """Grid a blade.

    Parameters
    ----------
    blade : Blade
        What to grid.  With a sharp trailing edge there is no block for it, and the blocks of
        the tip come together there in one point.
    spacing : Spacing, optional
        Numbers of points and sizes of cells.
    tip : callable
        `tips.flat_tip` or `tips.round_tip`.

    Raises
    ------
    GeometryError
        If the trailing edge is sharp in part and blunt in part.
    """
    spacing = spacing or Spacing()
    u, eta = spacing.parameters(), spacing.spans(blade)
    sections = blade.sections(eta, u)
    blunt = is_blunt(blade.name, sections)
    if not blunt:
        sections[:, -1] = sections[:, 0]  # so that both sides' points there are the same bits
    blocks = blocks_of(
        sections, cap(blade, tip, sections[-1], u, spacing.edge), eta, u, blunt=blunt
    )
    joints = _interfaces(blocks, spacing)
    for i, name in enumerate(blade.sides):
        blocks[i] = replace(blocks[i], name=name, family=name)
    return Grid(blade.name, tuple(blocks), joints, spacing)


def _interfaces(blocks: list[Block], spacing: Spacing) -> tuple[Interface, ...]:
    """List where blocks join, each pair of edges once."""
    place = {block.name: i for i, block in enumerate(blocks)}
    top, middle, last = spacing.along - 1, spacing.around // 2, spacing.around - 1
    layers, across = divisions(spacing.edge)
    corner = middle - across // 2
    side, rim, core, edge = "suction side", "tip rim", "tip core", "trailing edge"
    other = "pressure side"
    joints: list[tuple[str, Corner, Corner, str, Corner, Corner]] = [
        (side, (0, middle), (top, middle), other, (0, 0), (top, 0)),
        (side, (top, 0), (top, middle), rim, (0, 0), (0, middle)),
        (other, (top, 0), (top, middle), rim, (0, middle), (0, last)),
        (core, (0, 0), (0, corner), rim, (layers, 0), (layers, corner)),
        (core, (0, corner), (across, corner), rim, (layers, corner), (layers, corner + across)),
        (core, (across, corner), (across, 0), rim, (layers, corner + across), (layers, last)),
    ]
    if edge in place:
        inner = layers + across
        joints += [
            (other, (0, middle), (top, middle), edge, (0, 0), (top, 0)),
            (edge, (0, spacing.edge), (top, spacing.edge), side, (0, 0), (top, 0)),
            (edge, (top, 0), (top, layers), rim, (0, last), (layers, last)),
            (edge, (top, layers), (top, inner), core, (across, 0), (0, 0)),
            (edge, (top, inner), (top, spacing.edge), rim, (layers, 0), (0, 0)),
        ]
    else:
        joints.append((other, (0, middle), (top, middle), side, (0, 0), (top, 0)))
    found = []
    for name, start, stop, donor, donor_start, donor_stop in joints:
        a, b = place[name], place[donor]
        transform = _transform(
            blocks[a].points.shape, start, stop, blocks[b].points.shape, donor_start, donor_stop
        )
        found.append(Interface(a, b, start, stop, donor_start, donor_stop, transform))
    return tuple(found)


def _transform(
    shape: tuple[int, ...],
    start: Corner,
    stop: Corner,
    donor_shape: tuple[int, ...],
    donor_start: Corner,
    donor_stop: Corner,
) -> Corner:
    """Return the signed axes of the donor that continue i and j of a block across an edge."""
    (axis, sense, out), (other, other_sense, into) = (
        _edge(shape, start, stop),
        _edge(donor_shape, donor_start, donor_stop),
    )
    signed = {axis: sense * other_sense * (other + 1), 1 - axis: -out * into * (2 - other)}
    return signed[0], signed[1]


def _edge(shape: tuple[int, ...], start: Corner, stop: Corner) -> tuple[int, int, int]:
    """Return an edge's axis, its sense, and the sign of the other axis out of the block."""
    axis = 0 if start[0] != stop[0] else 1
    out = 1 if start[1 - axis] == shape[1 - axis] - 1 else -1
    return axis, 1 if stop[axis] > start[axis] else -1, out


def _line(points: Array, start: Corner, stop: Corner) -> Array:
    """Return the points from one index pair to another along i or j, both included."""
    count = max(abs(stop[0] - start[0]), abs(stop[1] - start[1])) + 1
    i, j = (
        np.linspace(a, b, count).round().astype(np.int64) for a, b in zip(start, stop, strict=True)
    )
    line: Array = points[i, j]
    return line
