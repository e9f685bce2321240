"""A volume around a blade: its surface's blocks, grown outward in layers up to a distance.

Blocks are those of the surface with a third index k from the wall outward; i cross j points along
k, so that cells are right-handed.  Whatever cannot be grown without a folded cell is refused.
Metres, blade frame.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.definition.estimates import AIR
from bladegen.errors import GeometryError, visible
from bladegen.support.arguments import amount, require_within
from bladegen.support.arrays import Array, Indices, readonly
from bladegen.support.values import brief
from bladegen.surface.grids.grid import Grid, Spacing
from bladegen.surface.volumes.front import Front, front_of
from bladegen.surface.volumes.marching import layers
from bladegen.surface.volumes.volume_quality import corner_jacobians, figures_of
from bladegen.surface.wall_spacing import first_height

__all__ = ["Extrusion", "Volume", "volume_of"]

GROWTHS = 1.05, 1.5
SMOOTHINGS = 0.5, 2.0
MOST = 400  # layers
STATION = 0.75  # of the span, whose chord a Reynolds number is of
COARSE = 129, 81, 16  # points around, along, across: all bundled blades are grown (docs/grids.md)
REACH = 0.2  # of the blade's length: the distance by default


@dataclass(frozen=True)
class Extrusion:
    """How layers of a volume follow each other.

    Parameters
    ----------
    first_height : float, optional
        Of the cells on the wall [m]; by `y_plus` if that is given, else `DEFAULT_HEIGHT`.
    growth : float
        Of heights from layer to layer.
    distance : float, optional
        How far the last layer is from the wall, half of its points at least [m]; a fifth of
        the blade's length if not given.
    smoothing : float
        Times the smoothing of steps along a layer, and the spreading of lines.
    y_plus, reynolds : float, optional
        The distance in wall units that the first cells' height is, and the Reynolds number of the
        chord at 75 % span, by the friction of a flat plate (`wall_spacing`); that of the blade's
        rotor at its rated speed, in air, if not given.
    """

    first_height: float | None = None
    growth: float = 1.2
    distance: float | None = None
    smoothing: float = 1.0
    y_plus: float | None = None
    reynolds: float | None = None

    DEFAULT_HEIGHT: ClassVar[float] = 1e-5  # m: y+ = 1 at a Reynolds number of ten million, about

    def __post_init__(self) -> None:
        for name, allowed in (("growth", GROWTHS), ("smoothing", SMOOTHINGS)):
            value = amount(getattr(self, name), name, GeometryError)
            require_within(value, name, allowed, GeometryError)
        for name in ("first_height", "distance"):
            value = getattr(self, name)
            if value is not None and not amount(value, name, GeometryError) > 0.0:
                raise GeometryError(f"{name}: got {value:g} m, must be positive")
        if self.y_plus is not None and self.first_height is not None:
            raise GeometryError(
                "first_height, y_plus: both are given, and either says how high first cells are; "
                "leave one out"
            )

    def height(self, blade: Blade) -> float:
        """Return the first cells' height [m] on a blade."""
        if self.y_plus is None:
            return self.DEFAULT_HEIGHT if self.first_height is None else self.first_height
        chord = float(blade.chord(STATION))
        return float(first_height(self.number(blade), chord, self.y_plus))

    def number(self, blade: Blade) -> float:
        """Return the Reynolds number of the chord at 75 % span.

        Raises
        ------
        GeometryError
            If none is given and the blade's definition does not say how fast its rotor turns.
        """
        if self.reynolds is not None:
            return self.reynolds
        rotor = blade.definition.rotor
        if rotor.speed is None:
            raise GeometryError(
                f"y_plus: got {self.y_plus:g} without a Reynolds number of the chord at "
                f"{100 * STATION:g} % span, and {visible(blade.name)} names no rotor speed; give "
                "one too: --reynolds 1e7"
            )
        radius = (rotor.hub_radius or 0.0) + STATION * blade.length
        return rotor.speed * radius * float(blade.chord(STATION)) / AIR


@dataclass(frozen=True, eq=False)
class Volume:
    """A volume of hexahedra around a blade.

    Parameters
    ----------
    grid : Grid
        The surface.
    front : Front
        The same with points that blocks share welded.
    layers : (m, p, 3) array
        Points [m] of each layer, the wall first.
    first_height, growth : float
        As asked for [m], [-].
    reynolds : float, optional
        That of which the height follows, if it follows from y+.
    """

    grid: Grid
    front: Front
    layers: Array
    first_height: float
    growth: float
    reynolds: float | None = None

    __repr__ = brief

    def __post_init__(self) -> None:
        object.__setattr__(self, "layers", readonly(self.layers))

    @cached_property
    def shapes(self) -> list[tuple[int, int, int]]:
        """Numbers of points (ni, nj, nk) of each block."""
        return [(*block.eta.shape, len(self.layers)) for block in self.grid.blocks]

    @cached_property
    def figures(self) -> dict[str, Any]:
        """How good its cells are."""
        counts = [(block.name, block.eta[1:, 1:].size) for block in self.grid.blocks]
        asked = {"first_height_asked_m": self.first_height, "growth_asked": self.growth}
        if self.reynolds is not None:
            asked["reynolds"] = self.reynolds
        found = figures_of(self.front, self.layers, counts)
        layer, cell = found.pop("largest_skewness_cell")
        corners = self.front.cells[cell]
        off = np.linalg.norm(self.layers[layer, corners] - self.layers[0, corners], axis=1)
        place = _place(self.grid, self.front.cells, cell)
        return asked | found | {"largest_skewness_at": [float(off.mean()), place]}

    def block(self, number: int) -> Array:
        """Return the points (ni, nj, nk, 3) of a block."""
        points: Array = np.moveaxis(self.layers[:, self.front.numbers[number]], 0, 2)
        return points


def volume_of(
    blade: Blade,
    grid: Grid,
    extrusion: Extrusion | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Volume:
    """Grow a volume from a blade's grid.

    Parameters
    ----------
    blade : Blade
        Its length is what the distance is a share of by default, its chord that of y+.
    grid : Grid
        Its surface, with a blunt trailing edge.
    extrusion : Extrusion, optional
        How layers follow each other.
    progress : callable
        Told which layer is made.

    Raises
    ------
    GeometryError
        If a cell would be folded, the trailing edge is sharp, or too many layers were needed.
    """
    made = extrusion or Extrusion()
    front, first = front_of(grid), made.height(blade)
    distance = REACH * blade.length if made.distance is None else made.distance
    expected = float(np.log1p(distance * (made.growth - 1.0) / first) / np.log(made.growth))
    if expected > MOST:
        raise GeometryError(
            f"growth: got {made.growth:g}, {MOST} layers do not reach {distance:g} m; give more, "
            "or higher first cells"
        )
    points = [front.points]
    for layer in layers(front, first, made.growth, expected, made.smoothing):
        progress(f"growing the volume, layer {len(points)} of about {expected:.0f}")
        jacobians = corner_jacobians(points[-1], layer, front.cells)
        reached = np.linalg.norm(layer - front.points, axis=1)
        if not jacobians.min() > 0.0:
            worst = int(np.argmin(jacobians.min(axis=1)))
            gone = np.linalg.norm(points[-1] - front.points, axis=1)
            away = float(gone[front.cells[worst]].mean())
            raise GeometryError(
                f"{visible(grid.name)}: cells would fold in layer {len(points)}, {away:.3g} m off "
                f"{_place(grid, front.cells, worst)}; give {_instead(grid.spacing, 0.8 * away)}"
            )
        points.append(layer)
        if np.median(reached) >= distance:
            break
        if len(points) > MOST:
            raise GeometryError(
                f"distance: {MOST} layers reach {np.median(reached):.3g} m, asked for are "
                f"{distance:g} m; give more growth, or less distance"
            )
    number = None if made.y_plus is None else made.number(blade)
    return Volume(grid, front, np.stack(points), first, made.growth, number)


def _instead(spacing: Spacing, nearer: float) -> str:
    """Say what may be given where cells would fold: fewer points, if there are more than needed."""
    around, along, edge = COARSE
    if spacing.edge > edge:
        return f"fewer cells across the trailing edge: --grid-edge {edge}"
    if spacing.around > around or spacing.along > along:
        return f"fewer points: --grid-around {around} --grid-along {along} --grid-edge {edge}"
    if nearer == 0.0:
        return "a smaller --first-height, or other numbers of points"
    return f"--distance {nearer:.2g}m, another --smoothing or --growth, or other numbers of points"


def _place(grid: Grid, cells: Indices, cell: int) -> str:
    """Say where on the surface a cell is."""
    for block in grid.blocks:
        ni, nj = block.eta.shape
        count = (ni - 1) * (nj - 1)
        if cell < count:
            i, j = divmod(cell, nj - 1)
            return f"the {block.name} at {100.0 * block.eta[i, j]:.1f} % span"
        cell -= count
    raise AssertionError(cells.shape)
