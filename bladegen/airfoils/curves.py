"""Measures of sections on their splines: leading edge, unit chord, relative thickness.

Sections are landmarks of shape (k, n, 2) at common parameters u (n,), trailing edge ->
suction side -> leading edge -> pressure side.  Their splines are C2 cubics in u.

The leading edge is the point farthest from the trailing-edge midpoint, the chord is that
distance, and the relative thickness is the largest distance between the two sides measured
normal to the chord line, over the chord.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from bladegen.airfoils.resizing import RIVAL, resizing, stretching
from bladegen.airfoils.roots import ITERATIONS, PARAMETER_TOLERANCE, bracketed, falling
from bladegen.errors import GeometryError
from bladegen.support.arrays import Array, Indices, Mask, mapped, readonly

__all__ = ["SectionCurves", "SectionSplines"]

SETTLED = 1e-13  # change of a stretch that ends its iteration
EVEN = 1e-11  # of `AMBIGUOUS`; differences of distances that are rounding
SAME_NOSE = 3  # landmarks; nearer peaks are one nose
AMBIGUOUS = 2e-5  # of a chord; noses whose distances differ by less share the leading edge
REMEMBERED = 8  # sets of landmark parameters whose matrices are kept, 1.3 MB each for 401
WINDOW = 5  # landmarks either side of a guess in which the thickest place is sought


@lru_cache(maxsize=REMEMBERED)
def _slope_matrix(parameters_in_bytes: bytes) -> Array:
    """Return the matrix of `SectionSplines`, shared by all blades with the same landmarks."""
    from scipy.interpolate import CubicSpline

    u = np.frombuffer(parameters_in_bytes)
    return readonly(CubicSpline(u, np.eye(len(u)))(u, 1))


@dataclass(frozen=True, eq=False)
class SectionSplines:
    """Fits splines to any number of sections with the same landmark parameters.

    Parameters
    ----------
    u : (n,) array
        Landmark parameters, 0.5 at the leading-edge landmark, symmetric about it.

    Notes
    -----
    A spline's slopes are linear in its points, so a fit is one matrix product.
    """

    u: Array

    @cached_property
    def _slopes(self) -> Array:
        """The (n, n) matrix from points to the slopes of their not-a-knot cubic spline."""
        return _slope_matrix(self.u.tobytes())

    def values(self, u: Array, derivative: int = 0) -> Array:
        """Return the (m, n) matrix from landmarks to points, or derivatives, at `u`."""
        from scipy.interpolate import CubicSpline

        matrix: Array = CubicSpline(self.u, np.eye(len(self.u)))(u, derivative)
        return matrix

    def fit(self, points: Array) -> "SectionCurves":
        """Return the splines through landmarks (k, n, 2)."""
        n, k = len(self.u), len(points)
        columns = np.moveaxis(points, 1, 0).reshape(n, 2 * k)  # one product for all sections
        slopes = np.moveaxis((self._slopes @ columns).reshape(n, k, 2), 0, 1)
        return SectionCurves(self.u, points, slopes)

    def normalising(self, points: Array, relative_thickness: Array | None) -> tuple[Array, Array]:
        """Return the maps that bring sections to unit chord and relative thickness, exactly.

        Both are maps of GL2 that move no point of the Grassmannian: a scaling, and a
        stretch normal to the chord line, which keeps leading edge and trailing-edge midpoint.

        Parameters
        ----------
        points : (k, n, 2) array
            Sections in airfoil axes, close to unit chord.
        relative_thickness : (k,) array, optional
            The thickness over chord to reach, not many times its own; None leaves it.

        Returns
        -------
        A, c : (k, 2, 2), (k, 2) arrays
            ``points @ A + c`` has unit chord and the thickness.
        """
        return self.fit(points).normalising(relative_thickness)


@dataclass(frozen=True, eq=False)
class SectionCurves:
    """Sections as splines: landmarks and slopes (k, n, 2) at the parameters u (n,)."""

    u: Array
    points: Array
    slopes: Array

    def normalising(self, relative_thickness: Array | None) -> tuple[Array, Array]:
        """Return the maps of `SectionSplines.normalising`."""
        A, c, either = self._step(relative_thickness)
        rows = np.flatnonzero(either)
        for _ in range(ITERATIONS):  # away from noses that agree
            if relative_thickness is None or not rows.size:
                break
            moved = self.take(rows).mapped(A[rows], c[rows])
            B, d, either = moved._step(relative_thickness[rows])
            A[rows], c[rows] = A[rows] @ B, (c[rows][:, None] @ B)[:, 0] + d
            rows = rows[either]
        return A, c

    def _step(self, relative_thickness: Array | None) -> tuple[Array, Array, Mask]:
        """Return the maps of `normalising`, exact but where either nose may lead, and where."""
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
        either = np.zeros(len(self.points), dtype=bool)
        rows = np.flatnonzero(self.has_rivals | passed)
        if relative_thickness is not None and rows.size:
            B, d, moved, either[rows] = self.take(rows).shared(relative_thickness[rows])
            A[rows[moved]], c[rows[moved]] = B[moved], d[moved]
        return A, c, either

    def mapped(self, A: Array, c: Array) -> "SectionCurves":
        """Return the sections ``points @ A + c``, for maps (k, 2, 2) and (k, 2)."""
        slopes = mapped(self.slopes, A, np.zeros(2))
        return SectionCurves(self.u, mapped(self.points, A, c), slopes)

    def at(self, u: Array) -> tuple[Array, Array, Array]:
        """Return points and first and second derivatives at `u` (k, ...), each (k, ..., 2)."""
        i = np.clip(np.searchsorted(self.u, u, side="right") - 1, 0, len(self.u) - 2)
        row = np.arange(len(self.points)).reshape((-1,) + (1,) * (u.ndim - 1))
        start, slope = self.points[row, i], self.slopes[row, i]
        width, h = (self.u[i + 1] - self.u[i])[..., None], (u - self.u[i])[..., None]
        secant = (self.points[row, i + 1] - start) / width
        bend = self.slopes[row, i + 1] + slope - 2.0 * secant
        a = bend / width**2
        b = (secant - slope - bend) / width
        return (
            ((a * h + b) * h + slope) * h + start,
            (3 * a * h + 2 * b) * h + slope,
            6 * a * h + 2 * b,
        )

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

    def shared(self, relative_thickness: Array) -> tuple[Array, Array, Mask, Mask]:
        """Return the maps of `resizing` where two noses may share the leading edge.

        Returned besides is where they differ from those of the present leading edge, and where
        either nose may lead though they share the edge now.

        The stretch moves noses away from the chord line, or towards it, so that their distances
        depend on where the line runs between them, and it runs where their distances say: its
        place is found by the signs of the difference.
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
        either &= self.has_rivals
        start = lead(place, np.arange(len(place)))
        normal, stretch, reach, _ = self._stretched(noses, relative_thickness, start)
        moved = ~either & (self.has_rivals | (place > 0.0))
        return *stretching(start, normal, stretch, reach), moved, either

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
        thickness, far = turned._height, ((noses - edge)[..., None, :] @ axes)[..., 0, :]
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
        return self._along_chord._height

    @property
    def _height(self) -> Array:
        """Largest height between the sides at one x, (k,)."""
        middle = len(self.u) // 2
        reach = max(0, min(WINDOW, (middle - 3) // 2))
        paired = self.points[:, :middle, 1] - self.points[:, :middle:-1, 1]
        best, rows = np.argmax(paired, axis=1), np.arange(len(paired))
        for _ in range(middle):
            at = np.clip(best[rows], reach + 1, max(reach + 1, middle - reach - 2))
            window = at[:, None] + np.arange(-reach, reach + 1)
            heights = self.take(rows)._gap(self.u[window], 1.0 - self.u[window])[0]
            best[rows] = found = window[np.arange(len(rows)), np.argmax(heights, axis=1)]
            rows = rows[(np.abs(found - at) == reach) & (found != at)]
            if not rows.size:
                break

        height, opposite = np.empty(0), 1.0 - self.u[best]

        def rising(u: Array) -> tuple[Array, Array]:
            nonlocal height, opposite
            height, slope, bend, opposite = self._gap(u, opposite)
            return slope, bend

        falling(rising, self.u[best - 1], self.u[best], self.u[best + 1])
        return height

    def _gap(self, u: Array, w: Array) -> tuple[Array, Array, Array, Array]:
        """Return the height between the sides at suction parameters `u`, and two derivatives.

        `w` is a first guess of the pressure side's parameters at the same x; those found are
        returned last.
        """
        p, p1, p2 = self.at(u)
        for _ in range(8):  # Newton for the pressure-side point at the same x
            q, q1, q2 = self.at(w)
            step = (q[..., 0] - p[..., 0]) / q1[..., 0]
            w = np.clip(w - step, 0.5, 1.0)
            if np.all(np.abs(step) <= PARAMETER_TOLERANCE):
                break
        q = q - q1 * step[..., None]  # the last step to first order: 1e-12 is left
        rate = p1[..., 0] / q1[..., 0]  # dw / du at equal x
        bend = (p2[..., 0] - q2[..., 0] * rate**2) / q1[..., 0]
        return (
            p[..., 1] - q[..., 1],
            p1[..., 1] - q1[..., 1] * rate,
            p2[..., 1] - q2[..., 1] * rate**2 - q1[..., 1] * bend,
            w,
        )
