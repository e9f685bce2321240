"""The paper's path: geodesics of Gr(n, 2) from station to station, with a corner at each.

Out come bases of shapes over the path's parameter; maps go along as monotone splines of their
polar factors.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.blade.lofting.combined import Combined, segments
from bladegen.definition.blade_definition import Interpolant, pchip
from bladegen.shapes import affine, grassmann
from bladegen.support.arrays import Array, Indices
from bladegen.support.values import brief

__all__ = ["SAME_SHAPE", "GeodesicPath", "SectionSpline"]

SAME_SHAPE = 1e-12  # rad; neighbours closer than this are one shape, constant between them


@dataclass(frozen=True, eq=False)
class GeodesicPath:
    """Geodesics from station to station, run at a continuous speed.

    Parameters
    ----------
    knots : (s,) array
        Parameter at the stations, strictly increasing.
    X : (s, n, 2) array
        Clustered representatives (`affine.cluster`), so that bases join.

    Notes
    -----
    The distance run is a monotone spline (PCHIP) of the parameter through the cumulative
    distances of the stations; between identical neighbours it is constant.
    """

    knots: Array
    X: Array

    __repr__ = brief

    @cached_property
    def _steps(self) -> Array:
        return grassmann.log(self.X[:-1], self.X[1:])

    @cached_property
    def distances(self) -> Array:
        """Distance from the first station, along the path [rad], (s,)."""
        lengths = grassmann.norm(self._steps)
        return np.concatenate([[0.0], np.cumsum(np.where(lengths > SAME_SHAPE, lengths, 0.0))])

    @cached_property
    def _run(self) -> Interpolant:
        return pchip(self.knots, self.distances)

    @cached_property
    def _columns(self) -> tuple[Array, Array]:
        """What each segment's points are made of, (s - 1, 4, n), and the steps' D^T D."""
        return np.concatenate(
            [self.X[:-1].mT, self._steps.mT], axis=1
        ), self._steps.mT @ self._steps

    def _place(self, q: Array) -> tuple[Indices, Array]:
        """Return which segments hold q, and the fractions of their length (k, 1, 1)."""
        k = segments(self.knots, q)
        length = self.distances[k + 1] - self.distances[k]
        fraction = np.divide(
            self._run(q) - self.distances[k], length, out=np.zeros_like(q), where=length > 0
        )
        return k, np.where(q >= self.knots[k + 1], 1.0, fraction)[:, None, None]

    def __call__(self, q: Array) -> Array:
        k, fraction = self._place(q)
        return grassmann.exp(self.X[k], fraction * self._steps[k])

    def maps(self, M: Array, b: Array) -> "SectionSpline":
        """Return the stations' affine maps, (s, 2, 2) and (s, 2), joined over the parameter."""
        return SectionSpline(self.knots, M, b)

    def combined(self, q: Array) -> Combined:
        """Return the bases at parameters (k,) as combinations."""
        k, fraction = self._place(q)
        columns, squares = self._columns
        cosine, sinc = grassmann.exp_factors(fraction**2 * squares[k])
        return Combined(columns, k, np.concatenate([cosine, fraction * sinc], axis=1))


@dataclass(frozen=True, eq=False)
class SectionSpline:
    """The affine part of the sections: M and b over the path's parameter.

    Parameters
    ----------
    knots : (s,) array
        Parameter at the stations.
    M : (s, 2, 2) array
        Linear maps with positive determinant.
    b : (s, 2) array
        Translations.

    Notes
    -----
    Monotone splines (PCHIP) of the polar factors, angle and logarithm of the stretch: no
    overshoot, and no singular map between regular ones.
    """

    knots: Array
    M: Array
    b: Array

    __repr__ = brief

    @cached_property
    def _parts(self) -> Interpolant:
        angle, log_stretch = affine.polar(self.M)
        parts = np.unwrap(angle)[:, None], log_stretch.reshape(-1, 4), self.b
        return pchip(self.knots, np.concatenate(parts, axis=1))

    def __call__(self, q: Array) -> tuple[Array, Array]:
        """Return M (k, 2, 2) and b (k, 2) at parameters (k,)."""
        parts = self._parts(q)
        M = affine.from_polar(parts[..., 0], parts[..., 1:5].reshape(*q.shape, 2, 2))
        return M, parts[..., 5:]
