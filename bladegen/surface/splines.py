"""Cubic splines with knots of any multiplicity: fitted along a chord, joined along a span.

A knot that stands once leaves a spline C2, twice C1, three times C0.  Along a section a spline is
the least-squares fit to more points than it has poles, and meets edges and nose exactly; along the
span it passes through all sections at its knots, with the blade's own slopes where it is not C2.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from bladegen.support.arrays import Array, Indices, Mask
from bladegen.support.values import brief

__all__ = ["DEGREE", "Fit", "Knots", "basis", "joined"]

DEGREE = 3
NOSE = 0.5  # the landmark parameter of the leading edge


@dataclass(frozen=True, eq=False)
class Knots:
    """Where cubics meet, and how: the knots of a spline.

    Parameters
    ----------
    at : (k,) array
        Distinct knots, increasing.
    times : (k,) array of int
        How often each stands: 1 for C2, 2 for C1, 3 for C0; what is given for the ends is ignored.
    """

    at: Array
    times: Indices

    __repr__ = brief

    @classmethod
    def simple(cls, at: Array) -> "Knots":
        """Return knots that leave the spline C2."""
        return cls(at, np.ones(len(at), dtype=np.int64))

    @property
    def sequence(self) -> Array:
        """The knots with multiplicities, the ends four times."""
        times = self.times.copy()
        times[[0, -1]] = DEGREE + 1
        sequence: Array = np.repeat(self.at, times)
        return sequence

    @property
    def poles(self) -> int:
        """How many poles a spline with these knots has."""
        return len(self.at) + DEGREE - 1 + int(np.sum(self.times[1:-1] - 1))

    @property
    def slopes(self) -> tuple[Mask, Mask]:
        """At which knots a slope is given behind them, and at which ahead, (k,) each."""
        behind, ahead = self.times > 1, self.times > 1
        behind[[0, -1]] = True, False
        ahead[[0, -1]] = False, True
        return behind, ahead

    def inside(self, shares: Array) -> Array:
        """Return both ends, and places at some shares of the way from knot to knot, increasing."""
        places = self.at[:-1, None] + shares * np.diff(self.at)[:, None]
        return np.unique(np.concatenate([self.at[:1], places.ravel(), self.at[-1:]]))


def basis(knots: Array, x: Array, nu: int = 0) -> Any:
    """Return cubic B-splines, or their derivatives, at x (k,): a sparse matrix (k, poles).

    At a knot they are those behind it, at the last one those ahead.
    """
    from scipy.interpolate import BSpline
    from scipy.sparse import diags_array

    matrix = BSpline.design_matrix(x, knots[nu : len(knots) - nu], DEGREE - nu)
    for degree in range(DEGREE - nu + 1, DEGREE + 1):
        own = knots[DEGREE - degree : len(knots) - DEGREE + degree]
        weights = degree / (own[degree + 1 : -1] - own[1 : -degree - 1])
        shape = len(weights), len(weights) + 1
        matrix = matrix @ diags_array([-weights, weights], offsets=[0, 1], shape=shape)
    return matrix.tocsr()


@dataclass(frozen=True, eq=False)
class Fit:
    """Splines fitted to points at u, least squares; both ends are exact, and the nose, u = 0.5.

    Parameters
    ----------
    knots : Knots
        Simple ones.
    u : (m,) array
        Where the points are: both ends among them, and enough between any two knots.
    """

    knots: Knots
    u: Array

    __repr__ = brief

    @cached_property
    def matrix(self) -> Any:
        """From poles to points."""
        return basis(self.knots.sequence, self.u)

    @cached_property
    def _nose(self) -> tuple[Array, Array]:
        """The basis at the nose, and by how much poles move that one unit there is met."""
        from scipy.linalg import cho_solve_banded

        row = self.matrix[np.flatnonzero(self.u == NOSE)].toarray()
        moved = cho_solve_banded((self._factors[1], True), np.ascontiguousarray(row[:, 1:-1].T))
        moved = np.pad(moved, ((1, 1), (0, 0)))
        return row, moved / (row @ moved)

    @cached_property
    def _factors(self) -> tuple[Any, Array, Array]:
        from scipy.linalg import cholesky_banded

        inner = self.matrix[:, 1:-1]
        normal = inner.T @ inner
        bands = np.zeros((DEGREE + 1, normal.shape[0]))
        for k in range(min(DEGREE + 1, len(bands[0]))):
            bands[k, : normal.shape[0] - k] = normal.diagonal(-k)
        ends = self.matrix[:, [0, self.matrix.shape[1] - 1]].toarray()
        return inner.T.tocsr(), cholesky_banded(bands, lower=True), ends

    def __call__(self, points: Array) -> Array:
        """Return the poles (a, k, 3) of the splines that fit points (k, m, 3)."""
        from scipy.linalg import cho_solve_banded

        inner, factor, ends = self._factors
        k, m = points.shape[:2]
        values = points.swapaxes(0, 1).reshape(m, -1)
        first_last = values[[0, -1]]
        poles = cho_solve_banded((factor, True), inner @ (values - ends @ first_last))
        poles = np.concatenate([first_last[:1], poles, first_last[1:]])
        nose = np.flatnonzero(self.u == NOSE)
        if nose.size:
            row, moved = self._nose
            poles += moved @ (values[nose] - row @ poles)
        return poles.reshape(-1, k, 3)


def joined(knots: Knots, values: Array, behind: Array, ahead: Array) -> Array:
    """Return the poles (a, b, 3) of splines through values at all knots.

    Parameters
    ----------
    knots : Knots
        Of the splines.
    values : (a, k, 3) array
        What they take at the knots.
    behind, ahead : (a, j, 3) arrays
        Their slopes just behind and just ahead of the knots at `Knots.slopes`; where a knot stands
        twice, the mean of both is theirs.
    """
    sequence = knots.sequence
    k, (after, before) = len(knots.at), knots.slopes
    twice = knots.times == 2
    twice[[0, -1]] = False
    rows = np.concatenate(
        [
            basis(sequence, knots.at).toarray(),
            basis(sequence, knots.at[after], 1).toarray(),
            basis(sequence, np.nextafter(knots.at[before], -np.inf), 1).toarray(),
        ]
    )
    given = np.concatenate([values, behind, ahead], axis=1)
    ones, others = (
        k + np.flatnonzero(twice[after]),
        k + len(behind[0]) + np.flatnonzero(twice[before]),
    )
    rows[ones] = 0.5 * (rows[ones] + rows[others])
    given[:, ones] = 0.5 * (given[:, ones] + given[:, others])
    rows, given = np.delete(rows, others, axis=0), np.delete(given, others, axis=1)
    flat = np.linalg.solve(rows, given.swapaxes(0, 1).reshape(len(rows), -1))
    poles: Array = flat.reshape(len(rows), -1, 3).swapaxes(0, 1)
    return poles
