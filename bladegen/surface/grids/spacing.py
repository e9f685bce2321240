"""How many points a structured grid has, and how large its cells are at edges, root and tip."""

from dataclasses import dataclass

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import GeometryError
from bladegen.support.arrays import Array
from bladegen.surface.grids.caps import divisions
from bladegen.surface.grids.stretching import FASTEST, MINIMUM_CELLS, require_sizes, two_sided

__all__ = ["Spacing"]

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

    Where `trailing_edge` or `tip` is None, `coupling.coupled` chooses it for a blade, such that
    cells are as high on both sides of blocks' edges.
    """

    around: int = 289
    along: int = 165
    edge: int = 72
    leading_edge: float = 1e-3
    trailing_edge: float | None = None
    tip: float | None = None
    root: float = 0.008

    def __post_init__(self) -> None:
        if self.edge < 4 or self.edge % 2:
            raise GeometryError(f"grid edge: got {self.edge}, allowed are even numbers from 4")
        across = max(divisions(self.edge, flat=flat)[1] for flat in (True, False))
        least = 2 * (across // 2 + 2 * MINIMUM_CELLS) + 1
        if self.around < least or self.around % 2 == 0:
            raise GeometryError(
                f"grid around: got {self.around}, allowed are odd numbers from {least}"
            )
        if self.along <= MINIMUM_CELLS:
            raise GeometryError(
                f"grid along: got {self.along}, at least {MINIMUM_CELLS + 1} are needed"
            )
        require_sizes(*self._sides)
        require_sizes(*self._lengths)

    def parameters(self) -> Array:
        """Return the landmark parameters (around,), symmetric about 0.5."""
        cells, first, last, names = self._sides
        side = 0.5 * two_sided(cells, first, last, names=names)
        return np.concatenate([side, 1.0 - side[-2::-1]])

    def spans(self, blade: Blade) -> Array:
        """Return the span fractions (along,), spaced along a blade's axis."""
        eta = np.linspace(0.0, 1.0, AXIS_POINTS)
        steps = np.linalg.norm(np.diff(blade.axis(eta), axis=0), axis=-1)
        length = np.concatenate([[0.0], np.cumsum(steps)])
        cells, first, last, names = self._lengths
        places = two_sided(cells, first, last, names=names)
        spans: Array = np.interp(places * length[-1], length, eta)
        return spans

    @property
    def least(self) -> tuple[float, float]:
        """The smallest cells at the trailing edge and at the tip from which others can grow."""
        return _least(self.around // 2), _least(self.along - 1)

    @property
    def _sides(self) -> tuple[int, float, float, tuple[str, str]]:
        """Arguments of `two_sided`: cells of a side, sizes at its ends and what they are called."""
        names, cells = ("trailing-edge spacing", "leading-edge spacing"), self.around // 2
        first = 1.0 / cells if self.trailing_edge is None else self.trailing_edge
        return cells, first, self.leading_edge, names

    @property
    def _lengths(self) -> tuple[int, float, float, tuple[str, str]]:
        names, cells = ("root spacing", "tip spacing"), self.along - 1
        last = 1.0 / cells if self.tip is None else self.tip
        return cells, self.root, last, names


def _least(cells: int) -> float:
    """Return the size of a cell from which so many, two thirds of them growing, fill 0 to 1."""
    return float((FASTEST - 1.0) / (FASTEST ** (2.0 * cells / 3.0) - 1.0))
