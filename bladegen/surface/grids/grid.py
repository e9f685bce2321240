"""A blade's surface as structured blocks of quadrilaterals that match point to point.

Suction side, trailing edge and pressure side form an O around every section; the tip, flat or
round, is covered by two blocks without a singular point: a rim along the section's outline, and
a core between its two halves.  The root stays open.  All points lie on `Blade.sections` or on
the tip's own surface; normals, i cross j, point outward.  Metres, blade frame.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import visible
from bladegen.support.arrays import Array
from bladegen.surface.grids.blocks import Block, frame, is_blunt
from bladegen.surface.grids.coupling import coupled
from bladegen.surface.grids.interfaces import Corner, Interface, interfaces
from bladegen.surface.grids.spacing import Spacing
from bladegen.surface.tips import Tip, arcs, flat_tip

__all__ = ["Block", "Grid", "Interface", "Spacing", "from_blade"]


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
    spacing = coupled(spacing or Spacing(), blade, tip)
    u, eta = spacing.parameters(), spacing.spans(blade)
    sections = blade.sections(eta, u)
    blunt = is_blunt(blade.name, sections)
    if not blunt:
        sections[:, -1] = sections[:, 0]  # so that both sides' points there are the same bits
    made = frame(sections, u, spacing.edge, arcs(blade, tip, u), blunt=blunt)
    over = blade.sections(1.0, made.places), arcs(blade, tip, made.places)
    blocks = made.blocks(sections, over, eta, u)
    joints = interfaces(blocks, spacing.edge)
    for i, name in enumerate(blade.sides):
        blocks[i] = replace(blocks[i], name=name, family=name)
    return Grid(blade.name, tuple(blocks), joints, spacing)


def _line(points: Array, start: Corner, stop: Corner) -> Array:
    """Return the points from one index pair to another along i or j, both included."""
    count = max(abs(stop[0] - start[0]), abs(stop[1] - start[1])) + 1
    i, j = (
        np.linspace(a, b, count).round().astype(np.int64) for a, b in zip(start, stop, strict=True)
    )
    line: Array = points[i, j]
    return line
