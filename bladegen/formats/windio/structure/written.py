"""What lies inside the skin as parts of windIO documents: what versions 1 and 2 share in writing.

Rules are written as rules, and the fractions of the arc that they mean on this blade besides, as
tools want them that find no places themselves.  A rule that a version has no form for is written
as these fractions alone, and that is said.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.distribution import Distribution, united
from bladegen.definition.structure.positions import (
    Arc,
    PlaneCut,
    Position,
    Shifted,
    extent_of,
)
from bladegen.definition.structure.structure import Axes, Layer, Material, Web
from bladegen.formats.windio.structure.parts import END, HELD, START, whole
from bladegen.formats.windio.writing import Document, Note, pairs
from bladegen.support.arrays import Array

__all__ = ["EDGES", "Strip", "Written", "extents", "materials", "strip_of"]

STRAIGHT = 1e-9  # m, of an axis from a line
POINTS = 41  # of fractions over span, where the file gave none
LANDMARKS = 401
AROUND = whole(1.0), whole(0.0)  # between which a strip about the trailing edge lies
EDGES = {whole(0.0): START, whole(1.0): END}  # the trailing edge, by its handle


@dataclass(frozen=True)
class Strip:
    """A strip by a width: about its middle, or from one end on; `by` is 0.5, 1 or -1."""

    base: Position
    width: Distribution
    by: float


def strip_of(start: Position, end: Position) -> Strip | None:
    """Return the strip between two places, None if they are no such."""
    if isinstance(end, Shifted) and end.base == start and end.times == 1.0:
        return Strip(start, end.width, 1.0)
    if isinstance(start, Shifted) and start.base == end and start.times == -1.0:
        return Strip(end, start.width, -1.0)
    if isinstance(start, Shifted) and isinstance(end, Shifted):
        halves = (start.times, end.times) == (-0.5, 0.5)
        about = start.base == end.base or (start.base, end.base) == AROUND
        if halves and about and start.width == end.width:
            return Strip(start.base, start.width, 0.5)
    return None


@dataclass
class Written:
    """A blade whose structure is written: fractions on its sections, notes, planes.

    Parameters
    ----------
    definition : BladeDefinition
        The blade.
    note : callable
        Takes what a version cannot hold.
    """

    definition: BladeDefinition
    note: Note
    outlines: dict[bytes, Any] = field(default_factory=dict)

    def fractions(self, place: Position, one: Web | Layer, end: int) -> Document:
        """Return where a place of a web or a layer is on this blade, as grid and values."""
        if isinstance(place, Arc):
            return pairs(place.fraction)
        given = one.stated[end]
        low, high = extent_of(place)
        grid = np.linspace(low, high, POINTS)
        if given is not None:
            inside = given.grid[(given.grid >= low) & (given.grid <= high)]
            few = [low, high] if len(inside) > POINTS // 2 else grid
            grid = united(inside, few)
        values = np.clip(self._on(grid).places(place), 0.0, 1.0)
        held = np.isfinite(values)
        if held.sum() < 2:
            self.note(f"structure: {one.name}", "lies nowhere on this blade; written as no width")
            return pairs(Distribution.constant(0.0))
        return pairs(Distribution(grid[held], values[held]))

    def _on(self, grid: Array) -> Any:
        from bladegen.blade.blade import Blade
        from bladegen.blade.layup.outlines import Outlines

        if b"" not in self.outlines:
            self.outlines[b""] = Blade.from_definition(self.definition, landmarks=LANDMARKS)
        key = grid.tobytes()
        if key not in self.outlines:
            self.outlines[key] = Outlines.of(self.outlines[b""], grid)
        return self.outlines[key]

    def formless(self, name: str, end: str, version: str) -> None:
        """Say that a rule is not written."""
        said = f"has no rule in windIO {version}; written as fractions of the arc on this blade"
        self.note(f"structure: {name}.{end}", said)

    def turn(self, plane: PlaneCut, grid: Array) -> Array:
        """Return a plane's rotation in the axes of the blade's root, over span [rad]."""
        turn = np.zeros(len(grid)) if plane.rotation is None else plane.rotation(grid)
        return turn + (self.definition.twist(grid) if plane.frame == "chord" else 0.0)

    def offset(self, plane: PlaneCut, through: tuple[float, float] | None) -> Document:
        """Return a plane's offset from the line through two points of the axis, or from the axis.

        It is the plane's own where that line is the one it is given from, or lies there as well.
        """
        from bladegen.blade.layup.outlines import beside_axis

        axis, own = self.definition.axis, plane.offset
        low, high = own.grid[0], own.grid[-1]
        finer = united(own.grid, axis.x.grid, axis.y.grid, np.linspace(low, high, POINTS))
        grid = finer[(finer >= low) & (finer <= high)]
        turn = self.turn(plane, grid)
        given, wanted = (
            np.zeros(len(grid)) if line is None else beside_axis(axis, grid, line, turn)
            for line in (plane.through, through)
        )
        if np.all(np.abs(given - wanted) < STRAIGHT):
            return pairs(own)
        return pairs(Distribution(grid, own(grid) + given - wanted))


def extents(one: Web | Layer) -> Document:
    """Return where a web or a layer starts and ends over span, if its grids do not say so."""
    if isinstance(one, Layer):
        known = float(one.thickness.grid[0]), float(one.thickness.grid[-1])
    else:
        known = extent_of(one.start, one.end)
    keys = ("start_nd_grid", "end_nd_grid")
    return {
        key: own for key, own, other in zip(keys, one.extent, known, strict=True) if own != other
    }


def materials(those: Iterable[Material]) -> list[Document]:
    """Return the file's list of materials."""
    return [
        {
            "name": one.name,
            "orth": int(one.orthotropic),
            "rho": one.density,
            **{
                key: _figures(getattr(one, ours), one.orthotropic)
                for key, ours in HELD.items()
                if getattr(one, ours) is not None
            },
            **({} if one.ply_thickness is None else {"ply_t": one.ply_thickness}),
            **{key: [*value] if isinstance(value, tuple) else value for key, value in one.others},
        }
        for one in those
    ]


def _figures(axes: Axes, orthotropic: bool) -> float | list[float]:
    """Return three figures, or one: of isotropic materials, whose nu windIO 2 limits to 0.5."""
    return axes[0] if len(set(axes)) == 1 and not orthotropic else [*axes]
