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

from bladegen.airfoils.resizing import RIVAL, resizing, stretching
from bladegen.curves.cubics import Cubics
from bladegen.curves.roots import ITERATIONS, bracketed, falling
from bladegen.errors import GeometryError
from bladegen.support.arrays import Array, Indices, Mask, mapped
from bladegen.support.values import brief

__all__ = ["SectionCurves"]

SETTLED = 1e-13  # change of a stretch that ends its iteration
EVEN = 1e-11  # of `AMBIGUOUS`; differences of distances that are rounding
SAME_NOSE = 3  # landmarks; nearer peaks are one nose
AMBIGUOUS = 2e-5  # of a chord; noses whose distances differ by less share the leading edge


@dataclass(frozen=True, eq=False)
class SectionCurves:
    """Sections as splines: landmarks and slopes (k, n, 2) at the parameters u (n,)."""

    u: Array
    points: Array
    slopes: Array

    __repr__ = brief

    def normalising(self, relative_thickness: Array | None) -> tuple[Array, Array]:
        """Return the maps of `SectionSplines.normalising`."""
        thickness = None if relative_thickness is None else self.thickness
        if thickness is not None and not bool(np.all(thickness > 0.0)):
            raise GeometryError(
                "sections: one has no thickness; do sides of neighbouring airfoils change places?"
            )
        A, c, passed = resizing(
            np.stack(self._noses),
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
        slopes = mapped(self.slopes, A, np.zeros(2))
        return SectionCurves(self.u, mapped(self.points, A, c), slopes)

    def at(self, u: Array) -> tuple[Array, Array, Array]:
        """Return points and first and second derivatives at `u` (k, ...), each (k, ..., 2)."""
        return self._cubics.at(u)

    @property
    def _cubics(self) -> Cubics:
        return Cubics(self.u, self.points, self.slopes)

    def take(self, rows: Indices) -> "SectionCurves":
        """Return some of the sections."""
        return SectionCurves(self.u, self.points[rows], self.slopes[rows])

    @cached_property
    def trailing_edge(self) -> Array:
        """The trailing-edge midpoints, (k, 2)."""
        return 0.5 * (self.points[:, 0] + self.points[:, -1])

    @cached_property
    def _distances(self) -> Array:
        """Squared distances (k, n - 2 first) of the front half's landmarks to the edge."""
        first = len(self.u) // 4
        away = self.points[:, first:-first] - self.trailing_edge[:, None]
        squares: Array = np.einsum("kni,kni->kn", away, away)
        return squares

    def _peak(self, landmark: Indices) -> Array:
        """Climb from landmarks (k,) to the points there that are farthest from the edge."""

        def receding(u: Array) -> tuple[Array, Array]:
            p, d1, d2 = self.at(u)
            r = p - self.trailing_edge
            return np.sum(r * d1, axis=-1), np.sum(d1 * d1 + r * d2, axis=-1)

        u = self.u
        return self.at(falling(receding, u[landmark - 1], u[landmark], u[landmark + 1]))[0]

    @cached_property
    def _noses(self) -> tuple[Array, Array]:
        """The farthest points, and the farthest of other peaks of the distance, (k, 2) each."""
        distances, first = self._distances, len(self.u) // 4
        best = np.argmax(distances, axis=1)
        peaks = np.zeros(distances.shape, dtype=bool)
        peaks[:, 1:-1] = (distances[:, 1:-1] > distances[:, :-2]) & (
            distances[:, 1:-1] >= distances[:, 2:]
        )
        peaks &= np.abs(np.arange(distances.shape[1]) - best[:, None]) > SAME_NOSE
        peaks &= distances > distances.max(axis=1, keepdims=True) * (1.0 - RIVAL)
        other = np.argmax(np.where(peaks, distances, -1.0), axis=1)
        other = np.where(peaks.any(axis=1), other, best)
        farthest = self._peak(best + first)
        if np.array_equal(other, best):
            return farthest, farthest
        alone = (other == best)[:, None]
        return farthest, np.where(alone, farthest, self._peak(other + first))

    @property
    def has_second_nose(self) -> Mask:
        """Which sections have another peak nearly as far from the trailing edge, (k,)."""
        one, two = self._noses
        second: Mask = np.any(one != two, axis=-1)
        return second

    @property
    def has_rivals(self) -> Mask:
        """Which sections have another nose that shares in the leading edge, (k,)."""
        one, two = self._noses
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
        ahead = self._reach(one) - self._reach(two)
        f = np.clip(ahead / AMBIGUOUS, -1.0, 1.0)
        share = (0.5 - 0.25 * f * (3.0 - f * f))[:, None]
        return one + share * (two - one)

    def _reach(self, points: Array) -> Array:
        """Distances of points (k, 2) from the trailing-edge midpoints, (k,)."""
        reach: Array = np.linalg.norm(points - self.trailing_edge, axis=-1)
        return reach

    @cached_property
    def chord(self) -> Array:
        """The chords, (k,): the largest distances from the trailing-edge midpoints."""
        return np.maximum(*(self._reach(nose) for nose in self._noses))

    @property
    def relative_thickness(self) -> Array:
        """Largest distance between the sides normal to the chord line, over the chord, (k,)."""
        return self.thickness / self.chord

    @property
    def _along_chord(self) -> "SectionCurves":
        """The sections turned so that x runs along the chord line."""
        along = self.trailing_edge - self.leading_edge
        along = along / np.linalg.norm(along, axis=-1, keepdims=True)
        axes = np.stack([along, np.stack([-along[:, 1], along[:, 0]], axis=-1)], axis=-1)
        return SectionCurves(self.u, self.points @ axes, self.slopes @ axes)

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
        turned = SectionCurves(self.u, (self.points - edge[:, None]) @ axes, self.slopes @ axes)
        thickness, far = turned._cubics.height, ((noses - edge)[..., None, :] @ axes)[..., 0, :]
        side = np.sign(far[1, :, 1] - far[0, :, 1])
        factors = np.ones((len(lead), 2))
        for _ in range(ITERATIONS):  # other points become the farthest, to second order
            stretch = factors[:, 1].copy()
            x, y = far[..., 0], far[..., 1]
            free = thickness**2 - (relative_thickness * y) ** 2
            free = np.maximum(free, SETTLED * thickness**2)  # or no stretch would do
            factors[:, 1] = relative_thickness * np.max(np.abs(x) / np.sqrt(free), axis=0)
            points, slopes = turned.points * factors[:, None], turned.slopes * factors[:, None]
            far = np.stack(SectionCurves(self.u, points, slopes)._noses) / factors
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
        along = self.trailing_edge - self.leading_edge
        gap = self.points[:, 0] - self.points[:, -1]
        width: Array = (along[:, 0] * gap[:, 1] - along[:, 1] * gap[:, 0]) / self._reach(
            self.leading_edge
        )
        return width

    @cached_property
    def thickness(self) -> Array:
        """Largest distance between the sides normal to the chord line, (k,)."""
        return self._along_chord._cubics.height
