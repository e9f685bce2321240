"""Measures of sections on their splines: leading edge, unit chord, relative thickness.

Sections are landmarks of shape (k, n, 2) at common parameters u (n,), trailing edge ->
suction side -> leading edge -> pressure side.  Their splines are C2 cubics in u.

The leading edge is the point farthest from the trailing-edge midpoint, the chord is that
distance, and the relative thickness is the largest distance between the two sides measured
normal to the chord line, over the chord.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.airfoils.noses import Noses, farthest
from bladegen.airfoils.resizing import resizing, stretching
from bladegen.airfoils.slopes import SplineSlopes
from bladegen.airfoils.thickest import Places, thickest, thickest_again
from bladegen.curves.cubics import Cubics
from bladegen.curves.roots import ITERATIONS, bracketed
from bladegen.errors import GeometryError
from bladegen.support.arrays import Array, Indices, Mask, mapped
from bladegen.support.values import brief

__all__ = ["SectionCurves"]

SETTLED = 1e-13  # change of a stretch that ends its iteration
EVEN = 1e-11  # of `AMBIGUOUS`; differences of distances that are rounding
NEAR = 20  # landmarks that moved, of which it is looked how much they did
ROUNDING = 1e-15  # of a chord
AMBIGUOUS = 2e-5  # of a chord; noses whose distances differ by less share the leading edge


@dataclass(frozen=True, eq=False)
class SectionCurves:
    """Sections as splines through landmarks (k, n, 2), with slopes that are made when needed."""

    splines: SplineSlopes
    points: Array

    __repr__ = brief

    @property
    def u(self) -> Array:
        """The landmark parameters, (n,)."""
        return self.splines.u

    @cached_property
    def planes(self) -> Array:
        """The landmarks as (2, k, n), all x, then all y: so arithmetic is several times as fast."""
        return np.ascontiguousarray(self.points.transpose(2, 0, 1))

    @cached_property
    def slopes(self) -> Array:
        """The slopes at the landmarks, (k, n, 2)."""
        return self.splines.all(self.planes).transpose(1, 2, 0)

    def normalising(self, relative_thickness: Array | None) -> tuple[Array, Array]:
        """Return the maps of `SectionSplines.normalising`."""
        thickness = None if relative_thickness is None else self.thickness
        if thickness is not None and not bool(np.all(thickness > 0.0)):
            raise GeometryError(
                "sections: one has no thickness; do sides of neighbouring airfoils change places?"
            )
        A, c, passed = resizing(
            np.array(self._noses),
            self.leading_edge,
            self.trailing_edge,
            thickness,
            relative_thickness,
        )
        rows = np.flatnonzero(self.has_rivals | passed)
        if relative_thickness is not None and rows.size:
            B, d, moved = self.take(rows).shared(relative_thickness[rows])
            A[rows[moved]], c[rows[moved]] = B[moved], d[moved]
        return A, c

    def mapped(self, A: Array, c: Array) -> "SectionCurves":
        """Return the sections ``points @ A + c``, for maps (k, 2, 2) and (k, 2)."""
        return SectionCurves(self.splines, mapped(self.points, A, c))

    def at(self, u: Array) -> tuple[Array, Array, Array]:
        """Return points and first and second derivatives at `u` (k, ...), each (k, ..., 2)."""
        return self._cubics.at(u)

    @property
    def _cubics(self) -> Cubics:
        return Cubics(self.u, self.points, self.slopes)

    def take(self, rows: Indices) -> "SectionCurves":
        """Return some of the sections."""
        taken = SectionCurves(self.splines, self.points[rows])
        if "_measured" in vars(self):
            vars(taken)["_measured"] = self._measured.take(rows)
        return taken

    def reshaped(self, points: Array, behind: int) -> "SectionCurves":
        """Return sections of which only the first and the last `behind` landmarks are others.

        What was measured of these ahead of them is kept, where the others do not reach.
        """
        result, n = SectionCurves(self.splines, points), len(self.u)
        if not behind or "_measured" not in vars(self):
            return result
        noses = self._measured
        room = np.minimum(noses.low, n - 1 - noses.high) - behind
        if not self._untouched(result, behind, room).all():
            return result
        vars(result)["_measured"] = noses
        if "_places" in vars(self):
            places, planes = self._places, result.planes
            apart = planes[..., :behind] - planes[..., : -behind - 1 : -1]
            normal = result._along[:, ::-1] * (-1.0, 1.0)
            wider = (normal[:, None] @ apart.swapaxes(0, 1))[:, 0]
            at, rows = np.argmax(wider, axis=1), np.arange(len(wider))
            alone = places.settled & (wider[rows, at] < places.pair)
            room = np.minimum(places.upper, n - 1 - places.lower) - behind
            kept = alone & self._untouched(result, behind, room)
            about = ~kept & (alone | (places.settled & (np.abs(at - places.upper) <= NEAR)))
            height = places.height.copy()
            for some, again in ((about, True), (~kept & ~about, False)):
                rows = np.flatnonzero(some)
                if rows.size and again:
                    given = result.planes[:, rows], result._along[rows], places.take(rows)
                    height[rows] = thickest_again(self.splines, *given)
                elif rows.size:
                    height[rows] = result.take(rows).thickness
            vars(result)["_places"] = places._replace(height=height, settled=kept)
        return result

    def _untouched(self, other: "SectionCurves", behind: int, room: Indices) -> Mask:
        """Tell where landmarks moved behind leave the splines as they are `room` (k,) ahead."""
        n, tail, first = len(self.u), self.splines.tail, max(behind - NEAR, 0)
        nearest = int(room.min(initial=n))
        if nearest > 0 and behind * tail[min(nearest - 1, n - 1)] < ROUNDING:  # by a chord at most
            return np.ones(len(room), dtype=bool)
        sides = slice(first, behind), slice(n - 1 - first, n - 1 - behind, -1)
        moved = sum(
            np.abs(other.planes[..., at] - self.planes[..., at]).sum(axis=0) for at in sides
        )
        away = room[:, None] - 1 + np.arange(behind - first, 0, -1)
        reach = (moved * tail[np.clip(away, 0, n - 1)]).sum(axis=1)
        reach += tail[np.clip(room + NEAR, 0, n - 1)]  # those farther move by less than a chord
        return np.asarray((room > 0) & (reach < ROUNDING))

    @cached_property
    def trailing_edge(self) -> Array:
        """The trailing-edge midpoints, (k, 2)."""
        return 0.5 * (self.points[:, 0] + self.points[:, -1])

    @cached_property
    def _measured(self) -> Noses:
        return farthest(self.splines, self.planes, self.trailing_edge.T)

    @property
    def _noses(self) -> tuple[Array, Array]:
        """The farthest points, and the farthest of other peaks of the distance, (k, 2) each."""
        return self._measured[:2]

    @property
    def has_second_nose(self) -> Mask:
        """Which sections have another peak nearly as far from the trailing edge, (k,)."""
        second: Mask = self._measured.low != self._measured.high
        return second

    @property
    def has_rivals(self) -> Mask:
        """Which sections have another nose that shares in the leading edge, (k,)."""
        one, two = self._noses
        if one is two:
            return np.zeros(len(one), dtype=bool)
        near = np.abs(self._reach(one) - self._reach(two)) < 2.0 * AMBIGUOUS
        rivals: Mask = near & self.has_second_nose
        return rivals

    @cached_property
    def leading_edge(self) -> Array:
        """The leading edges, (k, 2): the points farthest from the trailing-edge midpoints.

        On thick sections two points can be farthest by turns as the span goes on; where they
        agree to `AMBIGUOUS`, the leading edge moves smoothly from the one to the other.
        """
        one, two = self._noses
        if one is two:
            return one
        ahead = self._reach(one) - self._reach(two)
        f = np.clip(ahead / AMBIGUOUS, -1.0, 1.0)
        share = (0.5 - 0.25 * f * (3.0 - f * f))[:, None]
        return one + share * (two - one)

    def _reach(self, points: Array) -> Array:
        """Distances of points (k, 2) from the trailing-edge midpoints, (k,)."""
        away = points - self.trailing_edge
        return np.hypot(away[..., 0], away[..., 1])

    @cached_property
    def chord(self) -> Array:
        """The chords, (k,): the largest distances from the trailing-edge midpoints."""
        one, two = self._noses
        return self._reach(one) if one is two else np.maximum(self._reach(one), self._reach(two))

    @property
    def relative_thickness(self) -> Array:
        """Largest distance between the sides normal to the chord line, over the chord, (k,)."""
        return self.thickness / self.chord

    def shared(self, relative_thickness: Array) -> tuple[Array, Array, Mask]:
        """Return the maps of `resizing` where two noses may share the leading edge.

        Returned besides is where they differ from those of the present leading edge.

        The stretch moves noses away from the chord line, or towards it, so that their distances
        depend on where the line runs between them, and it runs where their distances say: its
        place is found by the signs of the difference.  Where either nose may lead, the one does
        that is farther now.
        """
        noses = np.stack(self._noses)

        def lead(place: Array, rows: Indices) -> Array:
            one, two = noses[0, rows], noses[1, rows]
            point: Array = one + place[:, None] * (two - one)
            return point

        def excess(place: Array, rows: Indices) -> Array:
            some = self.take(rows), noses[:, rows], relative_thickness[rows]
            return SectionCurves._stretched(*some, lead(place, rows))[-1]

        place, either = bracketed(excess, len(self.points), EVEN)
        place = np.where(
            either, np.where(self._reach(noses[0]) < self._reach(noses[1]), 1.0, 0.0), place
        )
        start = lead(place, np.arange(len(place)))
        normal, stretch, reach, _ = self._stretched(noses, relative_thickness, start)
        moved = self.has_rivals | (place > 0.0)
        return *stretching(start, normal, stretch, reach), moved

    def _stretched(
        self, noses: Array, relative_thickness: Array, lead: Array
    ) -> tuple[Array, Array, Array, Array]:
        """Stretch sections normal to the line from points `lead` (k, 2) to their edges.

        Returns the normals, the stretch to the relative thickness, the noses' distances then (2,
        k), and by how much of `AMBIGUOUS` the second nose (of `noses`, (2, k, 2)) is farther
        than it would be if the leading edge lay on the line; where only one is left, how far it
        lies from the line, positive on the second's side.
        """
        edge = self.trailing_edge
        along = (edge - lead) / self._reach(lead)[:, None]
        normal = np.stack([-along[:, 1], along[:, 0]], axis=-1)
        axes = np.stack([along, normal], axis=-1)
        turned = self.mapped(axes, -(edge[:, None] @ axes)[:, 0])
        thickness = thickest(self.splines, self.planes, along).height
        far = ((noses - edge)[..., None, :] @ axes)[..., 0, :]
        side = np.sign(far[1, :, 1] - far[0, :, 1])
        factors = np.ones((len(lead), 2))
        for _ in range(ITERATIONS):  # other points become the farthest, to second order
            stretch = factors[:, 1].copy()
            x, y = far[..., 0], far[..., 1]
            free = thickness**2 - (relative_thickness * y) ** 2
            free = np.maximum(free, SETTLED * thickness**2)  # or no stretch would do
            factors[:, 1] = relative_thickness * np.max(np.abs(x) / np.sqrt(free), axis=0)
            points = turned.points * factors[:, None]
            far = np.stack(SectionCurves(self.splines, points)._noses) / factors
            if np.all(np.abs(factors[:, 1] - stretch) <= SETTLED):
                break
        far *= factors
        reach = np.linalg.norm(far, axis=-1)
        y = side * far[..., 1]
        ahead = np.where(y[0] > y[1], -1.0, 1.0) * (reach[0] - reach[1]) / reach.max(axis=0)
        near, across = y.min(axis=0), np.ptp(y, axis=0)
        share = np.clip(-near / np.where(across > 0.0, across, 1.0), 0.0, 1.0)
        held = 2.0 * np.sin(np.arcsin(1.0 - 2.0 * share) / 3.0)  # the cubic of `leading_edge`
        excess = np.where(across > 0.0, held - ahead / AMBIGUOUS, near)
        return normal, factors[:, 1], reach, excess

    @property
    def edge_width(self) -> Array:
        """Distance from the pressure to the suction side's end normal to the chord line, (k,)."""
        along, gap = self._along, self.points[:, 0] - self.points[:, -1]
        width: Array = along[:, 0] * gap[:, 1] - along[:, 1] * gap[:, 0]
        return width

    @cached_property
    def thickness(self) -> Array:
        """Largest distance between the sides normal to the chord line, (k,)."""
        return self._places.height

    @cached_property
    def _along(self) -> Array:
        """Unit vectors along the chord lines, (k, 2)."""
        lead = self.leading_edge
        return np.asarray((self.trailing_edge - lead) / self._reach(lead)[:, None])

    @cached_property
    def _places(self) -> Places:
        return thickest(self.splines, self.planes, self._along)
