"""The inner side of a blade's wall: its outer surface, offset by what its layers are thick.

Sections stay in their planes.  A point moves along the normal of its outline there, by the wall's
thickness over the cosine of the surface's slope to the plane, so that the wall is as thick along
the surface's normal as its layers are; where there is no room for it, by less (`room`).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from bladegen.airfoils.landmarks import landmark_parameters
from bladegen.blade.layup.layup import Layup
from bladegen.blade.layup.walls import Walls
from bladegen.curves.vectors import cross, dots, lengths
from bladegen.support.arrays import Array
from bladegen.surface.inner.room import kept_within, lowered, rooms
from bladegen.surface.net import SurfaceNet

__all__ = ["Mapped", "Wall"]

PLACES, SPANS = 301, 301  # of the map of the room
FINER = 4  # places between landmarks at which radii of curvature are looked at
STEEPEST = 0.2  # cosine of the slope to the section's plane, beyond which walls grow no more


class Mapped(NamedTuple):
    """A wall on a grid of spans and landmark parameters.

    Parameters
    ----------
    eta, u : (k,), (n,) arrays
        The grid.
    points, inward : (k, n, 3) arrays
        Points of the outer surface [m], and inward normals in their sections' planes.
    cosine : (k, n) array
        Of the surface's slope to the plane.
    thickness, depth : (k, n) arrays
        Of the layers, and how deep the inner side lies along the surface's normal [m].
    room : (k, n) array
        For the wall, in the plane [m].
    """

    eta: Array
    u: Array
    points: Array
    inward: Array
    cosine: Array
    thickness: Array
    depth: Array
    room: Array


@dataclass(frozen=True, eq=False)
class Wall:
    """The wall of a blade below a net, as sections of its inner side.

    Parameters
    ----------
    net : SurfaceNet
        The outer surface.
    layup : Layup
        Its layers.
    """

    net: SurfaceNet
    layup: Layup

    @property
    def u(self) -> Array:
        """The blade's landmark parameters."""
        return self.layup.blade.u

    @property
    def sides(self) -> tuple[str, str]:
        """What the halves of sections are called."""
        return self.layup.blade.sides

    def sections(self, eta: Array, u: Array | None = None) -> Array:
        """Return points (k, n, 3) [m] on the inner side at span fractions (k,)."""
        made = self.at(eta, self.u if u is None else u)
        return made.points + (made.depth / made.cosine)[..., None] * made.inward

    def at(self, eta: Array, u: Array) -> Mapped:
        """Return the wall at span fractions (k,) and landmark parameters (n,)."""
        points, inward, cosine = self._outlines(eta, u, self.planes(eta))
        thickness, room = self._walls.thickness(eta, u), self.room(eta, u)
        depth = cosine * kept_within(thickness / cosine, room)
        return Mapped(eta, u, points, inward, cosine, thickness, depth, room)

    def planes(self, eta: Array) -> Array:
        """Return the unit normals (k, 3) of sections, about which outlines turn to the left."""
        around = self.net.evaluate(landmark_parameters(PLACES), eta)
        around = around - around[:, :1]
        normal = cross(around[:, :-1], around[:, 1:]).sum(axis=1)
        unit: Array = normal / lengths(normal)[:, None]
        return unit

    @cached_property
    def _walls(self) -> Walls:
        return Walls(self.layup)

    def _outlines(self, eta: Array, u: Array, planes: Array) -> tuple[Array, Array, Array]:
        points = self.net.evaluate(u, eta)
        inward = cross(planes[:, None], self.net.evaluate(u, eta, nu=1))
        inward /= lengths(inward)[..., None]
        cosine = np.abs(dots(self.net.normals(u, eta), inward))
        return points, inward, np.maximum(cosine, STEEPEST)

    def room(self, eta: Array, u: Array) -> Array:
        """Return how much room there is for the wall (k, n) [m], by the map of it."""
        at, spans, known = self._map
        row = np.clip(np.searchsorted(spans, eta, side="right") - 1, 0, len(spans) - 2)
        part = ((eta - spans[row]) / (spans[row + 1] - spans[row]))[:, None]
        here = known[row] * (1.0 - part) + known[row + 1] * part
        return np.array([np.interp(u, at, one) for one in here])

    @cached_property
    def _map(self) -> tuple[Array, Array, Array]:
        """Return places (n,), spans (k,) and how much room there is at them (k, n) [m]."""
        at, spans = landmark_parameters(PLACES), np.linspace(0.0, 1.0, SPANS)
        planes = self.planes(spans)
        points, inward, _ = self._outlines(spans, at, planes)
        steps = lengths(np.diff(points, axis=1))
        along = np.pad(np.cumsum(steps, axis=1), ((0, 0), (1, 0)))
        room = np.minimum(rooms(points, inward), self._bends(spans, at, planes))
        room = lowered(room, along, spans * self.layup.blade.length)
        return at, spans, room

    def _bends(self, eta: Array, u: Array, planes: Array) -> Array:
        """Return the least radii of curvature (k, n) [m] from one landmark to its neighbours."""
        fine = np.interp(np.arange(FINER * (len(u) - 1) + 1) / FINER, np.arange(len(u)), u)
        slope, bend = (self.net.evaluate(fine, eta, nu=times) for times in (1, 2))
        turn = dots(cross(slope, bend), planes[:, None])
        with np.errstate(divide="ignore"):
            radius = np.where(turn > 0.0, lengths(slope) ** 3 / turn, np.inf)
        cells = radius[:, :-1].reshape(len(eta), -1, FINER).min(axis=-1)
        wide = np.pad(cells, ((0, 0), (1, 1)), mode="edge")
        least: Array = np.minimum(np.minimum(wide[:, :-1], wide[:, 1:]), radius[:, ::FINER])
        return least
