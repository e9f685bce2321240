"""The blocks of a rotor's sector and their cells, between a cylinder at the hub and a far one.

Rotor frame: x along the axis, downwind; the blade points up, along z.  A strip of even cells holds
the blade.  Beside it cells widen to the sector's sides, two planes through the axis that are turned
onto each other: three blocks meet beside the strip, so that cells are as wide at the hub as in the
strip and need not narrow toward the axis.  Metres and radians.
"""

from dataclasses import dataclass
from functools import cached_property
from math import ceil, cos, log, pi, sin

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["RING", "Edge", "Sector", "ending", "growing"]

RING = 1.12  # where the strip ends, in tip radii
APEX = 0.12  # of the tip radius: how far from the hub the three blocks meet
SPREAD = 0.12  # of the sector's half angle, which the strip takes at the far cylinder
ACROSS, AWAY = 1.3, 1.35  # growth of cells beside the strip, and toward the far ends
MARGIN = 2.0  # background cells ahead of and behind the blade that are even
LARGEST_GROWTH = 3.0

Edge = tuple[str, str]


@dataclass(frozen=True)
class Sector:
    """Where the sector ends, and the size of its background cells.

    Parameters
    ----------
    blades : int
        Of the rotor: the sector is one of so many.
    hub, tip, far : float
        Radii of the inner cylinder, of the blade's tip and of the outer cylinder [m].
    blade : (float, float)
        Where the blade lies along x, less its lean [m].
    lean : float
        How far downwind the blade goes from the axis to the tip, over the tip's radius: blocks
        around it go with it, so that its surface crosses few rows of cells.
    ends : (float, float)
        Inlet and outlet, x [m].
    cell : float
        Size of background cells across the strip and along x [m].
    slender : float
        How many times as long they are along the blade.
    """

    blades: int
    hub: float
    tip: float
    far: float
    blade: tuple[float, float]
    lean: float
    ends: tuple[float, float]
    cell: float
    slender: float

    @property
    def half(self) -> float:
        """Half the sector's angle [rad]."""
        return pi / self.blades

    @cached_property
    def points(self) -> dict[str, Array]:
        """Corners of blocks in the plane of rotation, (2,) each: y and z [m]."""
        hub = _polar(self.hub, self.half)
        ring, far = RING * self.tip, self.far
        wide = float(hub[0])
        reach = APEX * self.tip
        beside, up = _polar(reach, self.half), np.array([0.0, reach])
        strip = np.array([wide, (ring**2 - wide**2) ** 0.5])
        middle = 0.5 * (np.arctan2(*strip) + self.half)
        right = {
            "hub": hub,
            "strip": hub + up,
            "side": hub + beside,
            "meet": hub + beside + up,
            "ring_strip": strip,
            "ring_middle": _polar(ring, middle),
            "ring_side": _polar(ring, self.half),
            "far_strip": _polar(far, SPREAD * self.half),
            "far_middle": _polar(far, 0.5 * (1.0 + SPREAD) * self.half),
            "far_side": _polar(far, self.half),
        }
        left = {f"-{name}": point * [-1.0, 1.0] for name, point in right.items()}
        return right | left

    @cached_property
    def _edges(self) -> dict[Edge, tuple[int, float]]:
        """Cells on edges of the right half and the middle, and how much longer the last one is."""
        along = self.slender * self.cell
        beside, wide = growing(self._length("hub", "side"), self.cell, ACROSS)
        apex = ceil(self._length("hub", "strip") / along)
        outward = ceil(self._length("strip", "ring_strip") / along)
        away, longer = growing(self.far - RING * self.tip, along, AWAY)
        across = ceil(2.0 * self.points["hub"][0] / self.cell)
        ring = ending(self._length("ring_strip", "ring_middle"), self.cell, beside)
        found: dict[Edge, tuple[int, float]] = {
            ("hub", "side"): (beside, wide),
            ("strip", "meet"): (beside, wide),
            ("ring_strip", "ring_middle"): (beside, ring),
            ("far_strip", "far_middle"): (beside, 1.0),
            ("hub", "strip"): (apex, 1.0),
            ("side", "meet"): (apex, 1.0),
            ("ring_side", "ring_middle"): (apex, 1.0),
            ("far_side", "far_middle"): (apex, 1.0),
        }
        for name, start in (("strip", "strip"), ("middle", "meet"), ("side", "side")):
            found[start, f"ring_{name}"] = (outward, 1.0)
            found[f"ring_{name}", f"far_{name}"] = (away, longer)
        for name in ("hub", "strip", "ring_strip", "far_strip"):
            found[f"-{name}", name] = (across, 1.0)
        return found

    def _length(self, a: str, b: str) -> float:
        return float(np.linalg.norm(self.points[b] - self.points[a]))

    def edge(self, a: str, b: str) -> tuple[int, float]:
        """Return the cells between two corners, and the last one's length over the first's."""
        left, right = a.startswith("-"), b.startswith("-")
        if left and right:
            a, b = a[1:], b[1:]
        if (a, b) in self._edges:
            return self._edges[a, b]
        count, ratio = self._edges[b, a]
        return count, 1.0 / ratio

    @cached_property
    def faces(self) -> list[tuple[str, str, str, str]]:
        """Blocks in the plane of rotation by their corners, counter-clockwise from behind."""
        middle = [
            ("-hub", "hub", "strip", "-strip"),
            ("-strip", "strip", "ring_strip", "-ring_strip"),
            ("-ring_strip", "ring_strip", "far_strip", "-far_strip"),
        ]
        right = [
            ("hub", "side", "meet", "strip"),
            ("strip", "meet", "ring_middle", "ring_strip"),
            ("side", "ring_side", "ring_middle", "meet"),
            ("ring_strip", "ring_middle", "far_middle", "far_strip"),
            ("ring_side", "far_side", "far_middle", "ring_middle"),
        ]
        left = [(f"-{d}", f"-{c}", f"-{b}", f"-{a}") for a, b, c, d in right]
        return middle + right + left

    @cached_property
    def planes(self) -> list[float]:
        """Where blocks end along x [m]."""
        low, high = self.blade
        room = MARGIN * self.cell
        return [self.ends[0], low - room, high + room, self.ends[1]]

    def along_x(self, plane: int, radius: float) -> float:
        """Return where a plane of `planes` is at a radius [m]."""
        leans = 0 < plane < len(self.planes) - 1
        return self.planes[plane] + (self.lean * min(radius, self.tip) if leans else 0.0)

    @cached_property
    def layers(self) -> list[tuple[int, float]]:
        """Cells of blocks along x, and how much longer the last one is."""
        x = self.planes
        before, nearer = growing(x[1] - x[0], self.cell, AWAY)
        after, farther = growing(x[3] - x[2], self.cell, AWAY)
        return [(before, 1.0 / nearer), (ceil((x[2] - x[1]) / self.cell), 1.0), (after, farther)]

    @cached_property
    def cells(self) -> int:
        """How many there are in the background."""
        across = sum(self.edge(a, b)[0] * self.edge(a, d)[0] for a, b, _, d in self.faces)
        return across * sum(count for count, _ in self.layers)


def growing(length: float, first: float, growth: float) -> tuple[int, float]:
    """Return how many cells fill a length, each `growth` times the one before, and last over first.

    >>> growing(7.0, 1.0, 2.0)
    (3, 4.0)
    """
    count = max(1, ceil(log(1.0 + length / first * (growth - 1.0)) / log(growth) - 1e-9))
    return count, growth ** (count - 1)


def ending(length: float, first: float, count: int) -> float:
    """Return the last cell's length over the first's, of so many cells that fill a length."""
    from scipy.optimize import brentq

    if count < 2 or length <= count * first:
        return 1.0

    def over(growth: float) -> float:
        return float(first * np.sum(growth ** np.arange(count)) - length)

    return float(brentq(over, 1.0, LARGEST_GROWTH)) ** (count - 1)


def _polar(radius: float, angle: float) -> Array:
    """Return y and z at an angle from z."""
    return radius * np.array([sin(angle), cos(angle)])
