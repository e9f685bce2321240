"""Sections that are linear in a few features, measured without being formed.

A perturbed section is the blade's own shape times a 2 x 2 matrix, plus the modes' shapes times
others, plus a shift: the landmarks are ``values[k].T @ coefficients``, with F features that are
the same for all perturbations of the section at span k.  Leading edge, chord and thickness are
found on the sections' splines (`sections`), which are linear in the features too, by Newton
steps from the nearest landmark.  Arrays of sections are (k, b, ...): spans, then perturbations.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from bladegen.arrays import Array, Indices, Mask, readonly
from bladegen.sections import AMBIGUOUS, PARAMETER_TOLERANCE, RIVAL, SAME_NOSE, SectionSplines
from bladegen.separation import FLAT, cross, turning_twice

__all__ = ["Features", "Measures"]

Single = npt.NDArray[np.float32]
STEPS = 12  # Newton steps; four are usual
WANDERING = 12  # landmarks a thickest place may lie from the thickest pair of landmarks
ROUNDING = 1e-10  # chord^2; on such small triangles single precision is off by 1e-12
SLACK = 1.01  # more other noses are taken for rivals than matter, since singles are compared


@dataclass(frozen=True, eq=False)
class Measures:
    """What was measured of sections (k, b); `unsure` ones need another look.

    Parameters
    ----------
    noses : (2, k, b, 2) array
        The point farthest from the trailing-edge midpoint, and the highest other peak of that
        distance, or the same.
    trailing_edge : (k, b, 2) array
        The trailing-edge midpoint.
    chord, thickness : (k, b) arrays
        Their distance, and the largest distance between the sides normal to the chord line.
    unsure : (k, b) array of bool
        Where two noses share the leading edge or Newton's method did not settle.
    """

    noses: Array
    trailing_edge: Array
    chord: Array
    thickness: Array
    unsure: Mask


@dataclass(frozen=True, eq=False)
class Features:
    """Features of sections and their splines.

    Parameters
    ----------
    u : (n,) array
        Landmark parameters, symmetric about 0.5 at the leading-edge landmark.
    values : (k, F, n) array
        Features at the landmarks; coefficients are (k, b, F, 2).
    """

    u: Array
    values: Array

    def __post_init__(self) -> None:
        for name in ("u", "values"):
            object.__setattr__(self, name, readonly(getattr(self, name)))

    @cached_property
    def _pieces(self) -> Array:
        """The cubic pieces of the features' splines, (k, n - 1, 4, F), constant term first."""
        k, count, n = self.values.shape
        columns = self.values.reshape(-1, n).T
        slopes = (SectionSplines(self.u).values(self.u, 1) @ columns).T.reshape(k, count, n)
        width = np.diff(self.u)
        start, slope = self.values[..., :-1], slopes[..., :-1]
        secant = np.diff(self.values, axis=-1) / width
        bend = slopes[..., 1:] + slope - 2.0 * secant
        pieces = np.stack([start, slope, (secant - slope - bend) / width, bend / width**2])
        return np.ascontiguousarray(np.moveaxis(pieces, (0, 3), (2, 1)))

    def piece(self, coefficients: Array, rows: Indices, spans: Indices, cell: Indices) -> Array:
        """Return the cubic pieces (m, 4, 2) of some sections (rows of (k * b, F, 2)) at cells."""
        return self._pieces[spans, cell] @ coefficients[rows]

    @cached_property
    def _front(self) -> Array:
        """The features in the front half, where noses are, less those at the trailing edge."""
        first = len(self.u) // 4
        edge = 0.5 * (self.values[..., :1] + self.values[..., -1:])
        return np.ascontiguousarray((self.values[..., first:-first] - edge).astype(np.float32))

    @cached_property
    def _across(self) -> Array:
        """The features' differences from pressure to suction side at opposite landmarks."""
        middle = len(self.u) // 2
        pairs = self.values[..., :middle] - self.values[..., :middle:-1]
        return np.ascontiguousarray(pairs.astype(np.float32))

    @cached_property
    def _in_pairs(self) -> Array:
        """The features for both coordinates at once, (k, 2 F, 2 n)."""
        k, count, n = self.values.shape
        pairs = np.zeros((k, count, 2, n, 2))
        pairs[:, :, 0, :, 0] = pairs[:, :, 1, :, 1] = self.values
        return pairs.reshape(k, 2 * count, 2 * n)

    def points(self, coefficients: Array) -> Array:
        """Return sections (b, k, n, 2) with coefficients (k, b, F, 2)."""
        k, b, count, _ = coefficients.shape
        points = np.empty((b, k, 2 * len(self.u)))
        np.matmul(
            coefficients.reshape(k, b, 2 * count), self._in_pairs, out=np.moveaxis(points, 0, 1)
        )
        return points.reshape(b, k, -1, 2)

    @cached_property
    def _ladder(self) -> tuple[Array, ...]:
        """The features' differences across at opposite landmarks, and along both sides."""
        middle = len(self.u) // 2
        upper, lower = self.values[..., : middle + 1], self.values[..., : middle - 1 : -1]
        parts = upper - lower, np.diff(upper, axis=-1), np.diff(lower, axis=-1)
        return tuple(np.ascontiguousarray(part.astype(np.float32)) for part in parts)

    def proved_sound(self, coefficients: Array) -> Mask:
        """Tell which sections (k, b) are proved not to cross themselves, by ladders.

        As `separation.ladders`, in single precision but for the trailing edge, where sides may
        meet: triangles must be larger than its rounding.
        """
        single = coefficients.astype(np.float32)
        (x, y), (ux, uy), (lx, ly) = (
            (single[..., 0] @ part, single[..., 1] @ part) for part in self._ladder
        )
        x_in, y_in = x[..., 1:-1], y[..., 1:-1]
        below = x_in * ly[..., 1:] - y_in * lx[..., 1:]
        above = x_in * uy[..., :-1] - y_in * ux[..., :-1]
        turned = np.minimum(below, above).min(axis=-1) >= ROUNDING
        ahead = np.concatenate([ux > 0, lx[..., ::-1] < 0, x[..., :1] > 0], axis=-1)
        ends = coefficients.mT @ self.values[:, None, :, [0, -2, -1]]
        edge = cross(ends[..., 0] - ends[..., 2], ends[..., 1] - ends[..., 2])
        sound: Mask = turned & turning_twice(ahead) & (edge >= FLAT)
        return sound

    def measure(self, coefficients: Array) -> Measures:
        """Measure sections with coefficients (k, b, F, 2)."""
        k, b, count, _ = coefficients.shape
        single = coefficients.astype(np.float32)
        flat = coefficients.reshape(k * b, count, 2)
        spans = np.repeat(np.arange(k), b)
        ends = 0.5 * (self.values[:, :, 0] + self.values[:, :, -1])
        edge = (ends[:, None, None] @ coefficients)[:, :, 0].reshape(-1, 2)

        nose, other, unsure = self._noses(flat, single, spans, edge)
        along = edge - nose
        chord = np.hypot(along[:, 0], along[:, 1])
        along /= chord[:, None]
        thickness, lost = self._thickness(flat, single, spans, along)
        shape = (k, b)
        return Measures(
            np.stack([nose, other]).reshape(2, *shape, 2),
            edge.reshape(*shape, 2),
            chord.reshape(shape),
            thickness.reshape(shape),
            (unsure | lost).reshape(shape),
        )

    def _noses(
        self, flat: Array, single: Single, spans: Indices, edge: Array
    ) -> tuple[Array, Array, Mask]:
        """Return the points farthest from the trailing edges, their rivals, and where unsure."""
        x, y = single[..., 0] @ self._front, single[..., 1] @ self._front
        distances = (x * x + y * y).reshape(len(flat), -1)
        best = np.argmax(distances, axis=1)
        near = distances > distances.max(axis=1, keepdims=True) * np.float32(1.0 - SLACK * RIVAL)
        # a landmark among the near ones that is higher than the next is a peak
        falls = near[:, 1:-1] & (distances[:, 1:-1] > distances[:, :-2])
        falls &= distances[:, 1:-1] >= distances[:, 2:]
        row, at = np.nonzero(falls)
        at += 1
        apart = np.abs(at - best[row]) >= SAME_NOSE  # single precision may take a neighbour
        row, at = row[apart], at[apart]
        ordered = np.argsort(distances[row, at], kind="stable")  # the highest comes last
        second = np.full(len(flat), -1)
        second[row[ordered]] = at[ordered]

        first = len(self.u) // 4
        nose, lost = self._peak(flat, np.arange(len(flat)), spans, edge, best + first)
        other, rows = nose.copy(), np.flatnonzero(second >= 0)
        other[rows], astray = self._peak(flat, rows, spans, edge, second[rows] + first)
        reach = [np.hypot(*(points[rows] - edge[rows]).T) for points in (nose, other)]
        lost[rows] |= astray | (reach[0] - reach[1] < 2.0 * AMBIGUOUS)
        return nose, other, lost

    def _peak(
        self, flat: Array, rows: Indices, spans: Indices, edge: Array, landmark: Indices
    ) -> tuple[Array, Mask]:
        """Climb from landmarks to the points of rows that are farthest from the edge."""
        cell, edge, spans = landmark.copy(), edge[rows], spans[rows]
        if not rows.size:
            return np.zeros((0, 2)), np.zeros(0, dtype=bool)
        piece = self.piece(flat, rows, spans, cell)
        receding = np.sum((piece[:, 0] - edge) * piece[:, 1], axis=-1)
        behind = np.flatnonzero(receding < 0)
        cell[behind] -= 1
        piece[behind] = self.piece(flat, rows[behind], spans[behind], cell[behind])
        width = np.diff(self.u)
        h = np.where(receding < 0, width[cell], 0.0)
        for _ in range(STEPS):
            p, d1, d2 = _at(piece, h)
            r = p - edge
            step = np.sum(r * d1, axis=-1) / np.sum(d1 * d1 + r * d2, axis=-1)
            h = h - step
            if np.abs(step).max() <= PARAMETER_TOLERANCE:
                break
        lost = ~((h >= -PARAMETER_TOLERANCE) & (h <= width[cell] + PARAMETER_TOLERANCE))
        return _at(piece, h)[0], lost

    def _thickness(
        self, flat: Array, single: Single, spans: Indices, along: Array
    ) -> tuple[Array, Mask]:
        """Return the largest distances between the sides normal to `along`, and where unsure.

        At the thickest place both sides run the same way, at the same place along the chord.
        """
        middle = len(self.u) // 2
        k, b = single.shape[:2]
        normal = np.stack([-along[:, 1], along[:, 0]], axis=-1).astype(np.float32)
        weights = (single @ normal.reshape(k, b, 2, 1))[..., 0]
        best = np.argmax((weights @ self._across).reshape(k * b, -1), axis=1)
        best = np.clip(best, 1, middle - 2)

        rows = np.arange(len(flat))
        u, w = self.u[best].copy(), 1.0 - self.u[best]
        upper_cell = best.copy()
        lower_cell = len(self.u) - 2 - best
        upper = self.piece(flat, rows, spans, upper_cell)
        lower = self.piece(flat, rows, spans, lower_cell)
        height = np.empty(len(flat))
        active = rows
        for _ in range(STEPS):
            a = along[active]
            p, p1, p2 = _at(upper[active], u[active] - self.u[upper_cell[active]])
            q, q1, q2 = _at(lower[active], w[active] - self.u[lower_cell[active]])
            ahead = np.sum((p - q) * a, axis=-1)
            turn = cross(p1, q1)
            ju, jw = np.sum(p1 * a, axis=-1), -np.sum(q1 * a, axis=-1)
            tu, tw = cross(p2, q1), cross(p1, q2)
            determinant = ju * tw - jw * tu
            with np.errstate(divide="ignore", invalid="ignore"):
                du = (ahead * tw - jw * turn) / determinant
                dw = (ju * turn - ahead * tu) / determinant
            height[active] = cross(a, p - q) - ahead * cross(a, p1) / ju
            moving = ~(np.maximum(np.abs(du), np.abs(dw)) <= PARAMETER_TOLERANCE)
            if not moving.any():
                active = active[:0]
                break
            active, du, dw = active[moving], du[moving], dw[moving]
            reach = 4.0 * (self.u[best[active] + 1] - self.u[best[active]])
            u[active] = np.clip(u[active] - np.clip(du, -reach, reach), self.u[1], 0.5)
            w[active] = np.clip(w[active] - np.clip(dw, -reach, reach), 0.5, self.u[-2])
            self._follow(flat, spans, active, u, upper_cell, upper)
            self._follow(flat, spans, active, w, lower_cell, lower)
        lost = np.abs(upper_cell - best) > WANDERING
        lost[active] = True
        return height, lost

    def _follow(
        self, flat: Array, spans: Indices, active: Indices, u: Array, cell: Indices, piece: Array
    ) -> None:
        """Take the pieces that hold parameters which have left theirs."""
        here = np.searchsorted(self.u, u[active], side="right") - 1
        here = np.clip(here, 0, len(self.u) - 2)
        moved = active[here != cell[active]]
        if moved.size:
            cell[active] = here
            piece[moved] = self.piece(flat, moved, spans[moved], cell[moved])


def _at(piece: Array, h: Array) -> tuple[Array, Array, Array]:
    """Return cubic pieces (m, 4, 2) and two derivatives at h (m,), each (m, 2)."""
    h = h[:, None]
    p0, p1, p2, p3 = piece[:, 0], piece[:, 1], piece[:, 2], piece[:, 3]
    return (
        p0 + h * (p1 + h * (p2 + h * p3)),
        p1 + h * (2.0 * p2 + 3.0 * h * p3),
        2.0 * p2 + 6.0 * h * p3,
    )
