"""Structured quadrilaterals over a blade's tip, in two blocks without a singular point.

A rim goes along the last section's outline, from trailing edge around the nose to trailing edge;
a core fills what it encloses, from the suction to the pressure side and from the trailing edge
to the nose.  Points are named by e = |u - 1/2|, the distance from the nose, and w, 0 to 1, the
place between suction and pressure side.  Lines of constant w meet in the nose, so the core ends
ahead of it and the rim goes around: on a flat tip along straight lines of its plane; on a round
one along straight lines of the half plane e exp(i pi w), where the nose is a regular point of
the outline w = 0, 1.  Metres, blade frame.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.support.arrays import Array, Indices
from bladegen.surface.tips import Tip, arcs, on_arcs

__all__ = ["Cap", "Layout", "cap", "divisions", "layout"]

DEPTH = 0.3  # a flat core ends where the nose is so deep for its half width: 45 degrees turned
CLOSEST = 1.6  # but no nearer than so many times the distance at which the rim leaves the sides
NARROWED = 0.9  # there the core is as wide as the rim, nearly
ROUND_CLOSEST = 1.4  # the same on a round tip, where the core need not narrow
FARTHEST = 0.25  # e, half way to the trailing edge


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


def divisions(edge: int) -> tuple[int, int]:
    """Return how many of the cells across the edge belong to either rim, and to the core."""
    layers = edge // 4
    return layers, edge - 2 * layers


@dataclass(frozen=True, eq=False)
class Layout:
    """Where a cap's points lie on a tip: distances e from the nose and places w, `Cap`'s shapes.

    `corner` is the point of the outline that the core's corner faces, `layers` the cells across
    the rim; a `flat` tip's rim runs along straight lines.
    """

    rim_e: Array
    rim_w: Array
    core_e: Array
    core_w: Array
    corner: int
    layers: int
    flat: bool

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
            t = np.linspace(0.0, 1.0, self.layers + 1)[:, None, None]
            rim = outline + t * (rim[-1] - outline)
        n, corner = len(outline), self.corner
        rim[0] = outline
        core[0], core[-1] = rim[-1, : corner + 1], rim[-1, : n - corner - 2 : -1]
        core[:, -1] = rim[-1, corner : n - corner]
        if sharp:
            rim[:, [0, -1]] = core[:, :1] = outline[0]  # one point, bit for bit
        u = _landmark(self.rim_e, self.rim_w), _landmark(self.core_e, self.core_w)
        return Cap(rim, core, *u)


def cap(blade: Blade, tip: Tip, outline: Array, u: Array, edge: int) -> Cap:
    """Cover a blade's tip.

    Parameters
    ----------
    blade : Blade
        Whose tip it is.
    tip : callable
        `tips.flat_tip` or `tips.round_tip`.
    outline : (n, 3) array
        Its last section [m], which the rim starts from.
    u : (n,) array
        The landmark parameters of its points.
    edge : int
        Cells across the trailing edge, even, at least 4.
    """
    placed = layout(outline, u, edge, flat=arcs(blade, tip) is None)
    own, _, _ = placed.places
    poles = None if placed.flat else arcs(blade, tip, own)
    points = placed.points(blade.sections(1.0, own) if placed.flat else outline, poles)
    return placed.cap(outline, *points, sharp=bool(np.array_equal(outline[0], outline[-1])))


def layout(outline: Array, u: Array, edge: int, *, flat: bool) -> Layout:
    """Lay out the cap of a tip that is flat or round: see `cap`."""
    layers, across = divisions(edge)
    share = layers / edge
    n, middle = len(u), len(u) // 2
    corner = middle - across // 2  # the core's nose faces so many cells of the outline

    e = np.abs(u - 0.5)
    nose = min(_core_ends(outline, e, corner) if flat else ROUND_CLOSEST * e[corner], FARTHEST)
    within = nose + (e - e[corner]) * (0.5 - nose) / (0.5 - e[corner])
    within[corner : n - corner] = nose
    within[[0, -1]] = 0.5
    width = np.full(n, 1.0 - 2.0 * share)
    if flat:
        narrow = min(NARROWED * e[corner] / (nose * width[0]), 1.0)
        width *= 1.0 - (1.0 - narrow) * (nose / within - 2.0 * nose) / (1.0 - 2.0 * nose)
    place = np.clip((np.arange(n) - corner) / across, 0.0, 1.0)
    w, opposite = np.where(np.arange(n) > middle, 1.0, 0.0), _across(width, place)
    t = np.linspace(0.0, 1.0, layers + 1)[:, None]
    rim_e, rim_w = (1.0 - t) * e + t * within, (1.0 - t) * w + t * opposite
    if not flat:
        round_nose = slice(corner + 1, n - 1 - corner)
        start, stop = (a * np.exp(1j * np.pi * b) for a, b in ((e, w), (within, opposite)))
        line = ((1.0 - t) * start + t * stop)[1:, round_nose]
        rim_e[1:, round_nose], rim_w[1:, round_nose] = np.abs(line), np.angle(line) / np.pi

    core_w = _across(width[: corner + 1], place[corner : n - corner, None])
    core_e = np.broadcast_to(within[: corner + 1], core_w.shape)
    return Layout(rim_e, rim_w, core_e, core_w, corner, layers, flat)


def _core_ends(outline: Array, e: Array, corner: int) -> float:
    """Return the distance e from the nose at which a flat tip's core ends."""
    middle = len(outline) // 2
    suction, pressure = outline[: middle + 1], outline[: middle - 1 : -1]
    depth = np.linalg.norm(0.5 * (suction + pressure) - outline[middle], axis=-1)
    half = 0.5 * np.linalg.norm(suction - pressure, axis=-1)
    first = int(np.argmax(depth <= DEPTH * half))  # from the trailing edge on
    return float(max(e[first], CLOSEST * e[corner]))


def _across(width: Array, place: Array) -> Array:
    """Return w of places 0 to 1 across a core that takes a share `width` of the way."""
    w: Array = 0.5 - width * (0.5 - place)
    return w


def _landmark(e: Array, w: Array) -> Array:
    return np.where(w <= 0.5, 0.5 - e, 0.5 + e)
