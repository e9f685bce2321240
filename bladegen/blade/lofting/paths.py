"""Shapes and their affine maps as functions of span, through given stations.

A path runs over a parameter q that increases from station to station: span itself, or the
relative thickness where a definition gives it, so that shape follows thickness.
`GeodesicPath` is the paper's: geodesics of Gr(n, 2) from station to station.  `SplinePath`
passes through the same stations smoothly, by a spline of the logarithms at their mean.
`SectionSpline` carries the affine part; it cannot become singular.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from bladegen.blade.lofting.combined import Combined
from bladegen.definition.blade_definition import Distribution, Interpolant, pchip
from bladegen.shapes import affine, grassmann
from bladegen.support.arrays import Array, Indices, Mask
from bladegen.support.values import brief

__all__ = ["PATHS", "GeodesicPath", "Parameter", "Path", "SectionSpline", "SplinePath"]

EQUAL_THICKNESS = 1e-3  # of chord; neighbours closer than this are told apart by span instead
STEEP = 0.05  # of chord over a whole span; nearer neighbours follow thickness too where it
RIPPLE = 5e-5  # changes faster than this, and by more than published curves ripple
NOISE = 1e-3  # rad; neighbours closer than this are told apart by their digits alone: no slope
SAME_SHAPE = 1e-12  # rad; neighbours closer than this are one shape, constant between them


@dataclass(frozen=True, eq=False)
class Parameter:
    """The parameter q of a path as a function of span: thickness where given, else span.

    Parameters
    ----------
    stations : (s,) array
        Span fractions of the stations.
    relative_thickness : Distribution, optional
        Where neighbouring stations differ in it, q moves as it does between them.
    """

    stations: Array
    relative_thickness: Distribution | None = None

    __repr__ = brief

    @cached_property
    def _ends(self) -> tuple[Array, Mask]:
        """Thickness at the stations, and which segments follow it."""
        if self.relative_thickness is None:
            return self.stations, np.zeros(len(self.stations) - 1, dtype=bool)
        thickness = self.relative_thickness(self.stations)
        steps = np.abs(np.diff(thickness))
        steep = (steps > RIPPLE) & (steps > STEEP * np.diff(self.stations))
        return thickness, (steps > EQUAL_THICKNESS) | steep

    @cached_property
    def knots(self) -> Array:
        """The values of q at the stations, strictly increasing, (s,)."""
        thickness, follows = self._ends
        steps = np.where(follows, np.abs(np.diff(thickness)), np.diff(self.stations))
        return np.concatenate([[0.0], np.cumsum(steps)])

    def __call__(self, eta: Array) -> Array:
        """Return q at span fractions `eta`; constant beyond the first and last station."""
        thickness, follows = self._ends
        k = np.clip(np.searchsorted(self.stations, eta, side="right") - 1, 0, len(follows) - 1)
        start, end = self.stations[k], self.stations[k + 1]
        fraction = (eta - start) / (end - start)
        if self.relative_thickness is not None:
            drop = np.where(follows[k], thickness[k + 1] - thickness[k], 1.0)
            by_thickness = (self.relative_thickness(eta) - thickness[k]) / drop
            within = (eta > start) & (eta < end)
            fraction = np.where(follows[k] & within, by_thickness, fraction)
        fraction = np.clip(fraction, 0.0, 1.0)
        return self.knots[k] + fraction * (self.knots[k + 1] - self.knots[k])


class Path(Protocol):
    """A curve on the Grassmannian."""

    def __call__(self, q: Array) -> Array:
        """Return orthonormal bases (k, n, 2) at parameters (k,)."""
        ...


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
        k = _segment(self.knots, q)
        length = self.distances[k + 1] - self.distances[k]
        fraction = np.divide(
            self._run(q) - self.distances[k], length, out=np.zeros_like(q), where=length > 0
        )
        return k, np.where(q >= self.knots[k + 1], 1.0, fraction)[:, None, None]

    def __call__(self, q: Array) -> Array:
        k, fraction = self._place(q)
        return grassmann.exp(self.X[k], fraction * self._steps[k])

    def combined(self, q: Array) -> Combined:
        """Return the bases at parameters (k,) as combinations."""
        k, fraction = self._place(q)
        columns, squares = self._columns
        cosine, sinc = grassmann.exp_factors(fraction**2 * squares[k])
        return Combined(columns, k, np.concatenate([cosine, fraction * sinc], axis=1))


@dataclass(frozen=True, eq=False)
class SplinePath:
    """A C1 curve through the stations: a spline of their logarithms at the Karcher mean.

    Parameters
    ----------
    knots : (s,) array
        Parameter at the stations, strictly increasing.
    X : (s, n, 2) array
        Representatives aligned with `mean`, so that bases join.
    mean : (n, 2) array
        The base point.

    Notes
    -----
    Slopes are modified Akima's with vectors in place of numbers (`_slopes`), so that the path
    does not depend on coordinates; they are zero beside identical neighbours, between which
    the path is constant.
    """

    knots: Array
    X: Array
    mean: Array

    __repr__ = brief

    @cached_property
    def _logs(self) -> Any:
        from scipy.interpolate import CubicHermiteSpline

        logs = grassmann.log(self.mean[None], self.X)
        return CubicHermiteSpline(self.knots, logs, _slopes(self.knots, logs))

    @cached_property
    def _columns(self) -> tuple[Array, Array]:
        """What each segment's points are made of, (s - 1, 10, n), and the powers' products."""
        powers = np.moveaxis(self._logs.c, 0, 1)
        s, _, n, _ = powers.shape
        mean = np.broadcast_to(self.mean.T, (s, 2, n))
        rows = powers.mT.reshape(s, 8, n)
        return np.concatenate([mean, rows], axis=1), rows @ rows.mT

    def __call__(self, q: Array) -> Array:
        return grassmann.exp(self.mean[None], self._logs(q))

    def combined(self, q: Array) -> Combined:
        """Return the bases at parameters (k,) as combinations."""
        k = _segment(self.knots, q)
        columns, products = self._columns
        powers = (q - self.knots[k])[:, None] ** (3.0, 2.0, 1.0, 0.0)
        scale = (powers[:, :, None, None] * np.eye(2)).reshape(len(q), 8, 2)
        cosine, sinc = grassmann.exp_factors(scale.mT @ (products[k] @ scale))
        return Combined(columns, k, np.concatenate([cosine, scale @ sinc], axis=1))


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


PathMaker = Callable[[Array, Array, Array], tuple[Path, Array]]


def geodesic_path(knots: Array, X: Array, M: Array) -> tuple[Path, Array]:
    """Cluster the stations from tip to hub and join them by geodesics.

    Returns the path and the linear maps that belong to its bases.
    """
    X, M = affine.cluster(X, M)
    return GeodesicPath(knots, X), M


def spline_path(knots: Array, X: Array, M: Array) -> tuple[Path, Array]:
    """Align the stations with their Karcher mean and join them smoothly.

    Returns the path and the linear maps that belong to its bases.
    """
    mean = grassmann.align(X[-1], grassmann.karcher_mean(X))  # no mirrored bases
    aligned = grassmann.align(mean[None], X)
    return SplinePath(knots, aligned, mean), aligned.mT @ X @ M


PATHS: dict[str, PathMaker] = {"geodesic": geodesic_path, "spline": spline_path}


def _slopes(knots: Array, V: Array) -> Array:
    """Return slopes (s, n, p) through tangent vectors V: modified Akima's, by their lengths.

    Akima, J. ACM 17 (1970), equation 1, with the weights of the "makima" variant, in which
    half the length of the sum is added to that of the difference.
    """
    secants = np.diff(V, axis=0) / np.diff(knots)[:, None, None]
    same = grassmann.norm(np.diff(V, axis=0)) <= NOISE
    steps = np.empty((len(knots) + 3, *V.shape[1:]))  # two more at either end
    steps[2:-2] = secants
    turn = secants[:1] - secants[1:2] if len(secants) > 1 else np.zeros_like(secants)
    steps[1::-1] = secants[:1] + turn * np.array([1.0, 2.0])[:, None, None]
    turn = secants[-1:] - secants[-2:-1] if len(secants) > 1 else np.zeros_like(secants)
    steps[-2:] = secants[-1:] + turn * np.array([1.0, 2.0])[:, None, None]
    change = grassmann.norm(np.diff(steps, axis=0)) + 0.5 * grassmann.norm(steps[1:] + steps[:-1])
    before, after = change[2:], change[:-2]
    total = before + after
    share = np.divide(before, total, out=np.full_like(total, 0.5), where=total > 0)[:, None, None]
    slopes = share * steps[1:-2] + (1.0 - share) * steps[2:-1]
    slopes[np.append(same, False) | np.insert(same, 0, False)] = 0.0
    return slopes


def _segment(knots: Array, q: Array) -> Indices:
    """Return the index of the segment that holds each q."""
    return np.clip(np.searchsorted(knots, q, side="right") - 1, 0, len(knots) - 2)
