"""Sections as cubics between landmarks: points on them, and the height between their sides.

Landmarks have shape (k, n, 2) at common parameters u (n,), trailing edge -> suction side ->
leading edge -> pressure side; landmarks i and -1 - i lie opposite.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.curves.roots import PARAMETER_TOLERANCE, falling
from bladegen.support.arrays import Array, Indices, Mask

__all__ = ["Cubics", "pieces", "rivals"]

WINDOW = 12  # landmarks either side of a guess in which the thickest place is sought
APART = 2  # landmarks; nearer to the highest there is no other peak
HIDDEN = (
    0.5  # of the bend at a landmark: a peak rises less above it, a quarter where it is a parabola
)


def pieces(start: Array, end: Array, slope: Array, last: Array) -> tuple[Array, ...]:
    """Return cubics from 0 to 1 between values (...) with slopes there, constant term first."""
    secant = end - start
    bend = last + slope - 2.0 * secant
    return start, slope, secant - slope - bend, bend


def rivals(heights: Array, best: Indices) -> Mask:
    """Tell beside which landmarks a peak may be as high as the one beside the highest.

    Parameters
    ----------
    heights : (k, m) array
        At landmarks.
    best : (k,) array of int
        The highest's.

    Returns
    -------
    (k, m) array of bool
        Not of the first and the last.
    """
    result = np.zeros(heights.shape, dtype=bool)
    here = heights[:, 1:-1]
    bend = np.abs(heights[:, :-2] - 2.0 * here + heights[:, 2:])
    places = np.arange(1, heights.shape[1] - 1)
    level = heights[np.arange(len(heights)), best]
    result[:, 1:-1] = (here + HIDDEN * bend > level[:, None]) & (
        np.abs(places - best[:, None]) >= APART
    )
    return result


@dataclass(frozen=True, eq=False)
class Cubics:
    """Cubics through points with slopes (k, n, 2) at the parameters u (n,)."""

    u: Array
    points: Array
    slopes: Array

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

    @property
    def height(self) -> Array:
        """Largest height between the sides at one x, (k,)."""
        middle = len(self.u) // 2
        reach = max(0, min(WINDOW, (middle - 3) // 2))
        paired = self.points[:, :middle, 1] - self.points[:, :middle:-1, 1]
        best, rows = np.argmax(paired, axis=1), np.arange(len(paired))
        others: list[tuple[Indices, Indices]] = []
        for _ in range(middle):
            at = np.clip(best[rows], reach + 1, max(reach + 1, middle - reach - 2))
            window = at[:, None] + np.arange(-reach, reach + 1)
            heights = Cubics(self.u, self.points[rows], self.slopes[rows])._gap(
                self.u[window], 1.0 - self.u[window]
            )[0]
            highest = np.argmax(heights, axis=1)
            best[rows] = found = window[np.arange(len(rows)), highest]
            row, place = np.nonzero(rivals(heights, highest))
            others.append((rows[row], window[row, place]))
            rows = rows[(np.abs(found - at) == reach) & (found != at)]
            if not rows.size:
                break

        height = self._climbed(best)
        rows, places = (np.concatenate(part) for part in zip(*others, strict=True))
        if rows.size:
            some = Cubics(self.u, self.points[rows], self.slopes[rows])
            np.maximum.at(height, rows, some._climbed(places))
        return height

    def _climbed(self, landmarks: Indices) -> Array:
        """Climb from landmarks (k,) to the largest height beside them."""
        height, opposite = np.empty(0), 1.0 - self.u[landmarks]

        def rising(u: Array) -> tuple[Array, Array]:
            nonlocal height, opposite
            height, slope, bend, opposite = self._gap(u, opposite)
            return slope, bend

        falling(rising, self.u[landmarks - 1], self.u[landmarks], self.u[landmarks + 1])
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
