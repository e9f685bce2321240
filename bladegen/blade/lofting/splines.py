"""The smooth path: the paper's geodesics with their corners blended on the manifold.

Each station gets one velocity, a mean of those with which the geodesics around it arrive and
leave; between two stations the geodesic is bent to meet both.  Out come bases of shapes over the
path's parameter; maps go along in the same way.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.blade.lofting.combined import Combined
from bladegen.blade.lofting.geodesics import SAME_SHAPE
from bladegen.blade.lofting.velocities import Paces, blended, three_point
from bladegen.curves.cubics import pieces
from bladegen.shapes import affine, grassmann
from bladegen.support.arrays import Array, Mask
from bladegen.support.values import brief

__all__ = ["MapSpline", "SplinePath"]

NOISE = 2e-4  # rad; equally thick neighbours closer than this are told apart by their digits alone
POWERS = np.arange(4.0)  # of a segment's fraction, as `curves.cubics.pieces` has them
LEAST_STRETCH = 0.1  # of a station's; how far the splines' control values of it may go down


@dataclass(frozen=True, eq=False)
class SplinePath:
    """Geodesics from station to station, bent so that they join with one velocity.

    Parameters
    ----------
    knots : (s,) array
        Parameter at the stations, strictly increasing.
    X : (s, n, 2) array
        Clustered representatives (`affine.cluster`), so that bases join.
    thickness : (s,) array, optional
        Relative thickness at the stations: shapes move as its logarithm does, where the
        parameter moves as it does.
    speeds : (2, s) array, optional
        Of the parameter over span, just before and just after each station.

    Notes
    -----
    A segment is a cubic in the tangent space at the middle of its geodesic, so that the geodesic
    itself is a straight line there.  It ends in the velocities of its stations, carried to that
    space by the differential of the logarithm.  These are Akima's (`velocities.blended`), of
    lengths and angles on the manifold alone: no basis, base point or coordinate is preferred.
    Between identical neighbours the path is constant.
    """

    knots: Array
    X: Array
    thickness: Array | None = None
    speeds: Array | None = None

    __repr__ = brief

    @cached_property
    def _drops(self) -> Array:
        """The change of thickness over a segment, of that at its start; 0 where span rules."""
        if self.thickness is None:
            return np.zeros(len(self.knots) - 1)
        steps, apart = np.diff(self.thickness), np.diff(self.knots)
        follows = np.isclose(np.abs(steps), apart, rtol=1e-9)
        return np.where(follows, steps / self.thickness[:-1], 0.0)

    @cached_property
    def _lengths(self) -> Array:
        """How far the logarithm of thickness, or span, goes in each segment."""
        logarithm = np.abs(np.log1p(self._drops))
        return np.where(self._drops != 0.0, logarithm, np.diff(self.knots))

    @cached_property
    def _steps(self) -> Array:
        return grassmann.log(self.X[:-1], self.X[1:])

    @cached_property
    def same(self) -> Mask:
        """Which segments join identical shapes, (s - 1,)."""
        apart = grassmann.norm(self._steps)
        return apart <= np.where(self._drops != 0.0, SAME_SHAPE, NOISE)

    @cached_property
    def velocities(self) -> tuple[Array, Array]:
        """Tangent vectors at the stations just before and just after them, (s, n, 2) each."""
        lengths, X, pace = self._lengths[:, None, None], self.X, self._pace
        before, after = -grassmann.log(X[1:], X[:-1]) / lengths, self._steps / lengths
        further = grassmann.transport(after[1:], X[1:-1], X[:-2])
        earlier = grassmann.transport(before[:-1], X[1:-1], X[2:])
        velocities = blended(before, after, earlier, further, pace)
        moving = ~self.same[:, None, None]
        before, after = velocities, velocities / pace[:, None, None]
        before[1:] *= moving
        after[:-1] *= moving
        return before, after

    @cached_property
    def _pace(self) -> Array:
        """`Paces.pace` of the logarithm of thickness where that rules, (s,)."""
        drops, thickness = self._drops != 0.0, self.thickness
        rates = np.ones((2, len(self.knots)))
        if thickness is not None:
            rates[0, 1:] = np.where(drops, 1.0 / thickness[1:], 1.0)
            rates[1, :-1] = np.where(drops, 1.0 / thickness[:-1], 1.0)
        return np.where(self.paces.joint, self.paces.pace * rates[1] / rates[0], 1.0)

    @cached_property
    def paces(self) -> Paces:
        """How the parameter runs through the stations."""
        speeds = np.ones((2, len(self.knots))) if self.speeds is None else self.speeds
        return Paces(self.knots, speeds, self.same)

    @cached_property
    def _pieces(self) -> tuple[Array, Array, Array]:
        """Columns of the segments (s - 1, 10, n), products (s - 1, 8, 8), turning (s - 1, 2)."""
        X, lengths = self.X, self._lengths[:, None, None]
        middle = grassmann.exp(X[:-1], 0.5 * self._steps)
        end = grassmann.log(middle, X[1:])
        arriving, leaving = self.velocities[0][1:], self.velocities[1][:-1]
        start_rate = lengths * grassmann.log_rate(middle, X[:-1], leaving)
        end_rate = lengths * grassmann.log_rate(middle, X[1:], arriving)
        powers = np.stack(pieces(-end, end, start_rate, end_rate), axis=1)
        rows = powers.mT.reshape(len(X) - 1, 8, -1)
        turning = [
            _turning(X[:-1], middle, lengths * leaving),
            _turning(X[1:], middle, lengths * arriving),
        ]
        columns = np.concatenate([middle.mT, rows], axis=1)
        return columns, rows @ rows.mT, np.stack(turning, axis=1)

    def __call__(self, q: Array) -> Array:
        combined = self.combined(q)
        bases: Array = combined.columns[combined.segments].mT @ combined.weights
        return bases

    def maps(self, M: Array, b: Array) -> "MapSpline":
        """Return the stations' affine maps, (s, 2, 2) and (s, 2), joined over the parameter."""
        return MapSpline(self.paces, M, b, self.same)

    def combined(self, q: Array) -> Combined:
        """Return the bases at parameters (k,) as combinations."""
        k, fraction = self.paces(q)
        columns, products, turning = self._pieces
        drop = self._drops[k]
        follows = drop != 0.0
        run = np.log1p(fraction * drop) / np.where(follows, np.log1p(drop), 1.0)
        t = np.where(follows & (fraction < 1.0), run, fraction)
        powers = t[:, None] ** POWERS
        scale = (powers[:, :, None, None] * np.eye(2)).reshape(len(q), 8, 2)
        cosine, sinc = grassmann.exp_factors(scale.mT @ (products[k] @ scale))
        away = t * (1.0 - t)
        angle = -away * (turning[k, 0] * (1.0 - t) - turning[k, 1] * t)
        weights = np.concatenate([cosine, scale @ sinc], axis=1)
        return Combined(columns, k, weights @ affine.rotation(angle))


@dataclass(frozen=True, eq=False)
class MapSpline:
    """The affine part of the sections over the path's parameter, with one slope at each station.

    Parameters
    ----------
    paces : Paces
        Parameter at the stations, and how it runs through them.
    M : (s, 2, 2) array
        Linear maps with positive determinant.
    b : (s, 2) array
        Translations.
    same : (s - 1,) array of bool
        Segments that join identical shapes: constant where the maps agree too.

    Notes
    -----
    Cubics of the polar factors, angle and stretch, and of b, with the slopes of parabolas through
    three stations.  Where a stretch could come near a singular one, its slopes are reduced.
    """

    paces: Paces
    M: Array
    b: Array
    same: Mask

    __repr__ = brief

    @cached_property
    def _powers(self) -> Array:
        """Angle, stretch and translation as cubics of a segment's fraction, (s - 1, 7, 4)."""
        angle, log_stretch = affine.polar(self.M)
        stretch = affine.from_polar(np.zeros(len(angle)), log_stretch)
        values = np.concatenate([np.unwrap(angle)[:, None], stretch.reshape(-1, 4), self.b], axis=1)
        apart, pace = np.diff(self.paces.knots), self.paces.pace[:, None]
        slopes = three_point(apart, values, self.paces.pace)
        reach = np.maximum(np.insert(apart, 0, 0.0), np.append(apart, 0.0) / self.paces.pace)
        slopes *= _reduced(stretch, slopes[:, 1:5].reshape(-1, 2, 2), reach)[:, None]
        still = self.same & (np.abs(np.diff(values, axis=0)).max(axis=1) <= NOISE)
        steps = np.where(still, 0.0, apart)[:, None]
        leaving = (slopes / pace)[:-1]
        cubic = pieces(values[:-1], values[1:], steps * leaving, steps * slopes[1:])
        return np.stack(cubic, axis=-1)

    def __call__(self, q: Array) -> tuple[Array, Array]:
        """Return M (k, 2, 2) and b (k, 2) at parameters (k,)."""
        k, t = self.paces(q)
        parts = (self._powers[k] @ (t[:, None] ** POWERS)[..., None])[..., 0]
        turn = affine.rotation(parts[..., 0])
        return turn @ parts[..., 1:5].reshape(*q.shape, 2, 2), parts[..., 5:]


def _turning(X: Array, middle: Array, velocity: Array) -> Array:
    """Return how fast the basis that lies closest to `middle` turns as X moves, (s,) [rad].

    With X^T middle = S symmetric, the turn W obeys S W + W S = B - B^T, B = velocity^T middle.
    """
    B = velocity.mT @ middle
    trace = np.trace(X.mT @ middle, axis1=-2, axis2=-1)
    rate: Array = (B[..., 1, 0] - B[..., 0, 1]) / trace
    return rate


def _reduced(stretch: Array, slopes: Array, reach: Array) -> Array:
    """Return by how much slopes (s, 2, 2) are to be multiplied, at most 1, (s,).

    A cubic stays positive definite where its control values do: those beside a station are its
    stretch and a third of the slope times the segment's length; `reach` is the longer one's, (s,).
    """
    root = np.linalg.inv(np.linalg.cholesky(stretch))
    relative = np.abs(np.linalg.eigvalsh(root @ slopes @ root.mT)).max(axis=-1) / 3.0
    most = 1.0 - LEAST_STRETCH
    factors: Array = most / np.maximum(relative * reach, most)
    return factors
