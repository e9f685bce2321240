"""Structured quadrilaterals over a blade's tip, in two blocks without a singular point.

A rim goes along the last section's outline, from trailing edge around the nose to trailing edge;
a core fills what it encloses, from the suction to the pressure side and from the trailing edge
to the nose.  Points are named by e = |u - 1/2|, the distance from the nose, and w, 0 to 1, the
place between suction and pressure side.  Lines of constant w meet in the nose, so the core ends
ahead of it and the rim goes around: on a flat tip along straight lines of its plane; on a round
one along straight lines of the half plane e exp(i pi w), where the nose is a regular point of
the outline w = 0, 1.
Metres, blade frame.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.support.arrays import Array, Indices
from bladegen.surface.tips import on_arcs

__all__ = ["Cap", "Layout", "divisions"]

FLAT_CORE = 12  # cells across a flat core at most: rims need the others to grow


@dataclass(frozen=True, eq=False)
class Cap:
    """Points [m] over a tip and their landmark parameters, those of the nearer side.

    `rim` is (layers + 1, n, 3), from the outline inward and around; `core` is
    (across + 1, corner + 1, 3), from suction to pressure side and from the trailing edge to the
    nose.  `rim_u` and `core_u` are (layers + 1, n) and (across + 1, corner + 1).
    """

    rim: Array
    core: Array
    rim_u: Array
    core_u: Array


@dataclass(frozen=True, eq=False)
class Layout:
    """Where a cap's points lie on a tip: distances e from the nose and places w, `Cap`'s shapes.

    `corner` is the point of the outline that the core's corner faces.  A `flat` tip's rim runs
    along straight lines, on which `t` (layers + 1, n) are its points.  `edge_cells` are the heights
    [m] of the first cells off the tip's edge at the trailing edge, from suction side.
    """

    rim_e: Array
    rim_w: Array
    core_e: Array
    core_w: Array
    corner: int
    t: Array
    flat: bool
    edge_cells: Array

    @property
    def places(self) -> tuple[Array, Indices, Array]:
        """The landmark parameters (m,) of the points, symmetric, and for each its place and w.

        The place is that in the first half of the parameters.
        """
        flat = np.concatenate([[0.0, 0.5], self.rim_e.reshape(-1), self.core_e.reshape(-1)])
        e, index = np.unique(flat, return_inverse=True)
        side = 0.5 - e[::-1]
        u = np.concatenate([side, 1.0 - side[-2::-1]])
        w = np.concatenate([self.rim_w.reshape(-1), self.core_w.reshape(-1)])
        return u, len(e) - 1 - index[2:], w

    def points(self, section: Array, poles: Array | None) -> tuple[Array, Array]:
        """Return points of rim and core, of the section at `places` or of its arcs' poles.

        Coordinates stand along the last axis, of any length: those of points, or derivatives.
        """
        _, index, w = self.places
        if poles is None:
            points = (1.0 - w)[:, None] * section[index] + w[:, None] * section[-1 - index]
        else:
            points = on_arcs(poles[index], w)
        rim, core = np.split(points, [self.rim_e.size])
        return rim.reshape(*self.rim_e.shape, -1), core.reshape(*self.core_e.shape, -1)

    def cap(self, outline: Array, rim: Array, core: Array, *, sharp: bool) -> Cap:
        """Return the cap of such points, joined to an outline (n, ...) and to itself."""
        if self.flat:
            rim = outline + self.t[..., None] * (rim[-1] - outline)
        n, corner = len(outline), self.corner
        rim[0] = outline
        core[0], core[-1] = rim[-1, : corner + 1], rim[-1, : n - corner - 2 : -1]
        core[:, -1] = rim[-1, corner : n - corner]
        if sharp:
            rim[:, [0, -1]] = core[:, :1] = outline[0]  # one point, bit for bit
        u = _landmark(self.rim_e, self.rim_w), _landmark(self.core_e, self.core_w)
        return Cap(rim, core, *u)


def divisions(edge: int, *, flat: bool) -> tuple[int, int]:
    """Return how many of the cells across a tip belong to either rim, and to the core."""
    layers = max(edge // 4, (edge - FLAT_CORE) // 2) if flat else (edge // 4 + edge // 2) // 2
    return layers, edge - 2 * layers


def _landmark(e: Array, w: Array) -> Array:
    return np.where(w <= 0.5, 0.5 - e, 0.5 + e)
