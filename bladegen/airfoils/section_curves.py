"""Measures of sections on their splines: leading edge, unit chord, relative thickness.

Sections are landmarks of shape (k, n, 2) at common parameters u (n,), trailing edge ->
suction side -> leading edge -> pressure side.  Their splines are C2 cubics in u.

The leading edge is the point farthest from the trailing-edge midpoint, or the mean of many that are
nearly as far (`noses`); the chord is its distance, and the relative thickness is the
largest distance between the two sides measured normal to the chord line, over the chord.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.airfoils.noses import Noses, farthest, other_noses
from bladegen.airfoils.resizing import LITTLE, Sizing, stretching
from bladegen.airfoils.slopes import SplineSlopes
from bladegen.airfoils.thickest import Places, thickest, thickest_again
from bladegen.curves.cubics import Cubics
from bladegen.curves.roots import ITERATIONS
from bladegen.errors import GeometryError
from bladegen.support.arrays import Array, Indices, Mask, mapped
from bladegen.support.values import brief

__all__ = ["SectionCurves"]

SETTLED = 1e-13  # of a relative thickness
SLOWEST, FASTEST = 0.25, 4.0  # growth of a relative thickness with a stretch, both as logarithms
NEAR = 20  # landmarks that moved, of which it is looked how much they did
ROUNDING = 1e-15  # of a chord


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
        A, c, *_ = self.sizing(relative_thickness)
        return A, c

    def sizing(self, relative_thickness: Array | None) -> Sizing:
        """Return the maps of `normalising`, and noses that they may have made others.

        Those to the thickness that was asked for last are remembered.
        """
        asked, known = vars(self).get("_sized", (None, None))
        if known is None or asked is not relative_thickness:
            known = self._sizing(relative_thickness)
            vars(self)["_sized"] = relative_thickness, known
        sizing: Sizing = known
        return sizing

    def _sizing(self, relative_thickness: Array | None) -> Sizing:
        thickness = None if relative_thickness is None else self.thickness
        if thickness is not None and not bool(np.all(thickness > 0.0)):
            raise GeometryError(
                "sections: one has no thickness; do sides of neighbouring airfoils change places?"
            )
        lead, along = self.leading_edge, self._along
        normal, reach = along[:, ::-1] * (-1.0, 1.0), self.chord
        if thickness is None or relative_thickness is None:
            none = np.empty(0, dtype=np.int64)
            maps = stretching(lead, normal, np.ones_like(reach), reach)
            return Sizing(*maps, none, lead[none], np.empty(0, dtype=bool))
        stretch = relative_thickness * reach / thickness
        A, c = stretching(self.trailing_edge, normal, stretch, reach)
        round_ = self._measured.wide.copy()
        rows = np.flatnonzero(~round_ & (np.abs(stretch - 1.0) > LITTLE))
        if rows.size:
            edges, low = self.trailing_edge[rows].T, self._measured.low[rows]
            round_[rows] = other_noses(self.splines, self.planes[:, rows], edges, A[rows], low)
        rows = np.flatnonzero(round_)
        noses, alone = lead[rows], ~round_[rows]
        if rows.size:
            A[rows], c[rows], noses, alone = self.take(rows)._round(relative_thickness[rows])
        return Sizing(A, c, rows, noses, alone)

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
        if "_places" in vars(self):
            vars(taken)["_places"] = self._places.take(rows)
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
            if "_sized" in vars(self):
                asked, known = vars(self)["_sized"]
                others = np.flatnonzero(~kept)
                wanted = None if asked is None else asked[others]
                own = result.take(others)._sizing(wanted) if others.size else None
                vars(result)["_sized"] = asked, known.but(others, own)
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
    def nose_landmarks(self) -> Indices:
        """The landmarks nearest to the noses, (k,)."""
        return self._measured.low

    @property
    def may_be_round(self) -> Mask:
        """Which sections' leading edge is a mean of many points, or nearly, (k,)."""
        return self._measured.wide.copy()

    @property
    def shares(self) -> Array:
        """The share of the mean of many points in the leading edges, (k,); mostly 0."""
        return self._measured.shares

    @property
    def leading_edge(self) -> Array:
        """The leading edges, (k, 2)."""
        return self._measured.points

    @cached_property
    def chord(self) -> Array:
        """The chords, (k,): distances of the leading edges from the trailing-edge midpoints."""
        away = self.leading_edge - self.trailing_edge
        return np.hypot(away[..., 0], away[..., 1])

    @property
    def relative_thickness(self) -> Array:
        """Largest distance between the sides normal to the chord line, over the chord, (k,)."""
        return self.thickness / self.chord

    def _round(self, relative_thickness: Array) -> tuple[Array, Array, Array, Mask]:
        """Return maps, noses and `alone` where leading edges may be means of many points.

        The stretch, normal to the sections' own chord lines, moves them, and the chord lines with
        them.  Its amount is the one after which the sections have the relative thickness, measured
        anew: Newton's method on logarithms, with slopes of the last two steps.  It ends with the
        step that what is left cannot miss by `SETTLED`: the slope is known by how much it changed.
        A section whose chord line turns away before it is that thick gets its thickness normal to
        its own.
        """
        count = len(relative_thickness)
        edge, normal = self.trailing_edge, self._along[:, ::-1] * (-1.0, 1.0)
        start = relative_thickness * self.chord / self.thickness
        more, missing, steps = (np.zeros(count) for _ in range(3))  # logarithms
        slopes, reaches, noses = np.full(count, np.nan), np.empty(count), np.empty((count, 2))
        alone, turned = np.empty(count, dtype=bool), np.zeros(count, dtype=bool)

        def stretched(rows: Indices) -> SectionCurves:
            amount, none = start[rows] * np.exp(more[rows]), np.ones(len(rows))
            maps = stretching(edge[rows], normal[rows], amount, none)
            some = SectionCurves(self.splines, mapped(self.points[rows], *maps))
            noses[rows], alone[rows] = some.leading_edge, ~some.may_be_round
            reaches[rows] = some.chord
            return some

        rows, last = np.arange(count), []
        for _ in range(ITERATIONS):
            some = stretched(rows)
            short = relative_thickness[rows] * some.chord / some.thickness
            torn = ~(short > 0.0)  # its sides have changed places
            left = np.log(np.where(torn, 1.0, short))
            rate = np.ones(len(rows))
            np.divide(missing[rows] - left, steps[rows], out=rate, where=steps[rows] != 0.0)
            missing[rows], steps[rows] = left, left / np.clip(rate, SLOWEST, FASTEST)
            open_ = np.abs(left) > SETTLED
            known = np.abs(left * (rate - slopes[rows])) <= SETTLED
            turned[rows], slopes[rows] = torn | (open_ & (rate < 0.0)), rate
            more[rows] += np.where(open_, steps[rows], 0.0)
            more[turned] = 0.0
            last.append(rows[turned[rows] | (open_ & known)])
            rows = rows[open_ & ~(known | turned[rows])]
            if not rows.size:
                break
        rows = np.concatenate([rows, *last])
        if rows.size:
            stretched(rows)
        reaches[turned] = self.chord[turned]
        maps = stretching(edge, normal, start * np.exp(more), reaches)
        return *maps, noses / reaches[:, None], alone

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
        return np.asarray((self.trailing_edge - self.leading_edge) / self.chord[:, None])

    @cached_property
    def _places(self) -> Places:
        return thickest(self.splines, self.planes, self._along)
