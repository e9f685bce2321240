"""Points around a section for a mesh: fine at the nose and at the trailing edge's corners.

In the plane of the section, metres, nose at the origin, x along the chord line, y to the suction
side.  They run clockwise, as a mesh that grows to their left needs them: from the edge's lower
corner along the pressure side to the nose, back along the suction side, and down the edge.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import GeometryError
from bladegen.support.arrays import Array
from bladegen.support.values import brief
from bladegen.surface.grids.stretching import two_sided

__all__ = ["CELLS", "Outline", "around"]

CELLS = (128, 2048)  # around a section
NOSE = 0.6  # of the mean cell: that at the nose
EDGE = 2e-3  # chords; the largest cell at the trailing edge
LEAST = 6  # cells across the trailing edge
LARGEST = 1.4  # of a side's mean cell: that at its edge, at most
FITTING = 5  # of that cell to those across the edge: landmarks are no lengths near a round root
THINNEST = 1e-4  # chords; thinner edges are no base


@dataclass(frozen=True, eq=False)
class Outline:
    """Points around a section, closed by the first.

    Parameters
    ----------
    points : (n, 2) array
        [m].
    chord : float
        [m].
    sides : dict
        How many cells each side has, by its name, in the points' order.
    """

    points: Array
    chord: float
    sides: dict[str, int]

    __repr__ = brief


def around(blade: Blade, eta: float, cells: int = 512) -> Outline:
    """Return points around the section of a blade.

    Parameters
    ----------
    blade : Blade
        Its trailing edge is blunt there.
    eta : float
        Span fraction.
    cells : int
        Around the section.

    Raises
    ------
    GeometryError
        If there are too few cells or too many, or the trailing edge is sharp.
    """
    if not CELLS[0] <= cells <= CELLS[1]:
        raise GeometryError(f"cells: got {cells}, allowed is {CELLS[0]} to {CELLS[1]}")
    chord = blade.chord([eta])
    ends = blade.trailing_edge(blade.profiles([eta]), chord)[0, [0, -1]]
    width = float(np.linalg.norm(ends[0] - ends[1]))
    if width < THINNEST:
        raise GeometryError(
            f"trailing edge: at eta = {eta:g} it is {1e3 * width * chord[0]:.3f} mm thick, the "
            f"mesh needs {1e3 * THINNEST * chord[0]:.2g} mm; such as --trailing-edge 2mm"
        )
    base = max(LEAST, int(np.ceil(width / min(EDGE, 1.0 / cells))))
    side = (cells - base) // 2
    if side < 2 * LEAST:
        raise GeometryError(
            f"cells: got {cells}, of which the trailing edge takes {base}; give more, such as "
            f"{4 * base}"
        )
    base = cells - 2 * side
    cell = spacing = width / base
    for _ in range(FITTING):
        half = 0.5 * two_sided(side, min(spacing, LARGEST / side), NOSE / side)
        u = np.concatenate([half, 1.0 - half[-2::-1]])
        points = blade.trailing_edge(blade.profiles([eta], u), chord)[0, ::-1]
        reached = np.linalg.norm(points[[1, -1]] - points[[0, -2]], axis=1).mean()
        spacing *= cell / float(reached)
    across = points[-1] + (points[0] - points[-1]) * np.linspace(0.0, 1.0, base + 1)[1:-1, None]
    points = _on_chord_line(np.concatenate([points, across]), side, 2 * side) * chord
    sides = {"pressure_side": side, "suction_side": side, "trailing_edge": base}
    return Outline(points, float(chord[0]), sides)


def _on_chord_line(points: Array, nose: int, edge: int) -> Array:
    """Return points turned and shifted: nose at the origin, the edge's middle on the x axis."""
    x, y = 0.5 * (points[0] + points[edge]) - points[nose]
    turn = np.array([[x, -y], [y, x]]) / np.hypot(x, y)
    result: Array = (points - points[nose]) @ turn
    return result
