"""Slopes of splines through landmarks: at all of them, or at a few and their neighbours.

A spline's slopes are linear in its points, and a point's share in the slope of another falls off
by a factor of about four from landmark to landmark: those nearby decide, to rounding.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from bladegen.airfoils.fronts import Front
from bladegen.support.arrays import Array, Indices, readonly
from bladegen.support.recent import Recent
from bladegen.support.values import brief

__all__ = ["SplineSlopes"]

REMEMBERED = 8  # sets of landmark parameters whose matrices are kept, 7 MB each for 401
ASKED = 4  # matrices to other places that are kept of one set, 4 MB each for 1200 places
NEGLIGIBLE = 1e-19  # of the largest share; what lies below is no part of a slope's digits


@dataclass(frozen=True, eq=False)
class SplineSlopes:
    """From landmarks at parameters u (n,) to the slopes of their not-a-knot cubic splines."""

    u: Array

    __repr__ = brief

    @classmethod
    def at(cls, u: Array) -> "SplineSlopes":
        """Return those of landmark parameters, shared by all blades with the same ones."""
        return _shared(np.asarray(u, dtype=np.float64).tobytes())

    @cached_property
    def front(self) -> Front:
        """The landmarks among which noses are sought."""
        return Front(self.u)

    @cached_property
    def _unit(self) -> Any:
        """The splines through 1 at one landmark and 0 at all others."""
        from scipy.interpolate import CubicSpline

        return CubicSpline(self.u, np.eye(len(self.u)))

    @cached_property
    def _recent(self) -> Recent[Array]:
        return Recent(ASKED)

    @cached_property
    def matrix(self) -> Array:
        """The (n, n) matrix from points to slopes."""
        return readonly(self._unit(self.u, 1))

    def values(self, u: Array, derivative: int = 0) -> Array:
        """Return the (m, n) matrix from landmarks to points, or derivatives, at `u` (m,).

        The last few are remembered: those who measure a surface ask for the same places often.
        """
        key = bytes([derivative]) + np.asarray(u, dtype=np.float64).tobytes()
        return self._recent.get(key, lambda: readonly(self._unit(u, derivative)))

    @cached_property
    def tail(self) -> Array:
        """How far a landmark moved by 1 moves a spline beyond others, by how many there are (n,).

        At most, and to first order: its shares in slopes there times the steps.
        """
        n = len(self.u)
        moved = np.abs(self.matrix) * np.diff(self.u).max()
        most = [
            max(np.diagonal(moved, far).max(), np.diagonal(moved, -far).max()) for far in range(n)
        ]
        return np.maximum.accumulate(most[::-1])[::-1]

    @cached_property
    def _nearby(self) -> tuple[Indices, Array]:
        """For each landmark the first that counts, and the shares (n, w, 3) of those that do.

        In the slopes at the landmark before, the landmark, and the one after.
        """
        n, place = len(self.u), np.arange(len(self.u))
        reach = 1 + int(np.count_nonzero(self.tail > NEGLIGIBLE * self.tail[0]))
        width = min(2 * reach + 1, n)
        first = np.clip(place - reach, 0, n - width)
        rows = np.clip(place[:, None] + np.arange(-1, 2), 0, n - 1)
        columns = first[:, None] + np.arange(width)
        return first, readonly(self.matrix[rows[:, None], columns[..., None]])

    def all(self, points: Array) -> Array:
        """Return the slopes (..., n) of splines through numbers (..., n) at the landmarks."""
        slopes: Array = points @ self.matrix.T
        return slopes

    def around(self, planes: Array, rows: Indices, landmarks: Indices) -> Array:
        """Return the slopes at landmarks (m,) and their neighbours, of some of the sections.

        Parameters
        ----------
        planes : (2, k, n) array
            All x, all y.
        rows : (m,) array of int
            Which sections.
        landmarks : (m,) array of int
            From 1 to n - 2.

        Returns
        -------
        (2, m, 3) array
            Slopes at the landmark before, the landmark, and the one after.
        """
        first, shares = self._nearby
        (_, k, n), width = planes.shape, shares.shape[1]
        shape, strides = (2, k, n - width + 1, width), (*planes.strides, planes.strides[-1])
        windows = np.lib.stride_tricks.as_strided(planes, shape, strides)
        near = windows[:, rows, first[landmarks]].swapaxes(0, 1)
        return (near @ shares[landmarks]).swapaxes(0, 1)


@lru_cache(maxsize=REMEMBERED)
def _shared(parameters_in_bytes: bytes) -> SplineSlopes:
    return SplineSlopes(np.frombuffer(parameters_in_bytes))
