"""Densities of coordinates: a box, an ellipsoid, normal distributions, a convex hull.

Each is learned from data (m, r), carries points of a cube to coordinates, and tells how likely
coordinates are and whether they lie among the data.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from bladegen.errors import MissingLibraryError, SpaceError
from bladegen.shapes.statistics.ellipsoids import smallest
from bladegen.support.arrays import Array, Indices, Mask
from bladegen.support.values import brief

__all__ = ["KINDS", "Density"]

EDGE = 1e-9  # of the data's size: what lies on a boundary is inside
MOST_MODES = 6  # of a convex hull: its simplices grow like the count to the power of half the modes
COMPONENTS = (1, 2, 4, 6, 8, 12, 16)  # of a mixture, of which that of least BIC is taken
LEARNED = 2000  # shapes that a mixture is fitted to, every so many-th of the data
HALF_LOG = 0.5 * np.log(2.0 * np.pi)


class Density(Protocol):
    """A density of coordinates."""

    def carried(self, unit: Array) -> Array:
        """Carry points (m, r + 1), uniform in a cube, to coordinates (m, r)."""
        ...

    def log_prob(self, t: Array) -> Array:
        """Return the logarithm of the density at coordinates (m, r), -inf where it is none."""
        ...

    def contains(self, t: Array) -> Mask:
        """Tell which coordinates (m, r) lie among the data."""
        ...


@dataclass(frozen=True, eq=False)
class Box:
    """Uniform between the least and the largest of the data."""

    low: Array
    high: Array
    __repr__ = brief

    @classmethod
    def of(cls, data: Array) -> "Box":
        return cls(data.min(axis=0), data.max(axis=0))

    def carried(self, unit: Array) -> Array:
        return self.low + unit[:, :-1] * (self.high - self.low)

    def log_prob(self, t: Array) -> Array:
        volume = np.log(self.high - self.low).sum()
        return np.where(self.contains(t), -volume, -np.inf)

    def contains(self, t: Array) -> Mask:
        edge = EDGE * (self.high - self.low)
        inside: Mask = np.all((t >= self.low - edge) & (t <= self.high + edge), axis=1)
        return inside


@dataclass(frozen=True, eq=False)
class Ellipsoid:
    """Uniform where |A (t - centre)| <= 1: the smallest ellipsoid that holds the data."""

    centre: Array
    A: Array
    __repr__ = brief

    @classmethod
    def of(cls, data: Array) -> "Ellipsoid":
        return cls(*smallest(_corners(data)))

    def carried(self, unit: Array) -> Array:
        r = len(self.centre)
        normal = _normal(unit[:, :-1])
        length = np.linalg.norm(normal, axis=1, keepdims=True)
        ball = normal / np.where(length > 0, length, 1.0) * unit[:, -1:] ** (1.0 / r)
        return self.centre + np.linalg.solve(self.A, ball.T).T

    def log_prob(self, t: Array) -> Array:
        from scipy.special import gammaln

        r = len(self.centre)
        ball = 0.5 * r * np.log(np.pi) - gammaln(0.5 * r + 1.0)
        volume = ball - np.linalg.slogdet(self.A).logabsdet
        return np.where(self.contains(t), -volume, -np.inf)

    def contains(self, t: Array) -> Mask:
        inside: Mask = np.linalg.norm((t - self.centre) @ self.A.T, axis=1) <= 1.0 + EDGE
        return inside


@dataclass(frozen=True, eq=False)
class Mixture:
    """Normal distributions with weights (c,), means (c, r) and covariances L L^T, L (c, r, r)."""

    weights: Array
    means: Array
    roots: Array
    least: float
    __repr__ = brief

    @classmethod
    def of(cls, data: Array, weights: Array, means: Array, covariances: Array) -> "Mixture":
        roots = np.linalg.cholesky(covariances).astype(np.float64)
        made = cls(weights, means, roots, -np.inf)
        return replace(made, least=float(made.log_prob(data).min()))

    @classmethod
    def normal(cls, data: Array) -> "Mixture":
        """Return the normal distribution of the data's mean and covariance."""
        covariance: Array = np.cov(data.T, bias=True).reshape(1, data.shape[1], -1)
        return cls.of(data, np.ones(1), data.mean(axis=0)[None], covariance)

    @classmethod
    def learned(cls, data: Array) -> "Mixture":
        """Return the mixture of scikit-learn whose number of components has the least BIC."""
        try:
            from sklearn.mixture import GaussianMixture
        except ImportError as error:
            raise MissingLibraryError(error) from None
        some = data[:: -(-len(data) // LEARNED)]
        counts = [count for count in COMPONENTS if count * 2 <= len(some)]
        fits = [GaussianMixture(count, random_state=0).fit(some) for count in counts]
        best = fits[int(np.argmin([fit.bic(some) for fit in fits]))]
        return cls.of(data, best.weights_, best.means_, best.covariances_)

    def carried(self, unit: Array) -> Array:
        of = _chosen(np.cumsum(self.weights), unit[:, -1])
        result: Array = self.means[of] + np.einsum(
            "mij,mj->mi", self.roots[of], _normal(unit[:, :-1])
        )
        return result

    def log_prob(self, t: Array) -> Array:
        from scipy.special import logsumexp

        away = np.moveaxis(t[:, None] - self.means, 0, -1)  # (c, r, m)
        normal = np.linalg.solve(self.roots, away)
        scale = np.log(np.diagonal(self.roots, axis1=1, axis2=2)).sum(axis=1)
        each = -0.5 * np.sum(normal**2, axis=1) - scale[:, None] - HALF_LOG * t.shape[1]
        result: Array = logsumexp(each + np.log(self.weights)[:, None], axis=0)
        return result

    def contains(self, t: Array) -> Mask:
        inside: Mask = self.log_prob(t) >= self.least - EDGE
        return inside


@dataclass(frozen=True, eq=False)
class Hull:
    """Uniform in the convex hull of the data, cut into simplices (s, r + 1, r)."""

    simplices: Array
    volumes: Array
    faces: Array
    __repr__ = brief

    @classmethod
    def of(cls, data: Array) -> "Hull":
        from scipy.spatial import ConvexHull, Delaunay

        r = data.shape[1]
        if not 2 <= r <= MOST_MODES:
            raise SpaceError(f"hull: got {r} modes, allowed is 2 to {MOST_MODES}")
        hull, corners = ConvexHull(data), _corners(data)
        cells = corners[Delaunay(corners, qhull_options="QJ").simplices]
        volumes = np.abs(np.linalg.det(cells[:, 1:] - cells[:, :1]))
        return cls(cells, volumes, hull.equations)

    def carried(self, unit: Array) -> Array:
        of = _chosen(np.cumsum(self.volumes) / self.volumes.sum(), unit[:, -1])
        cuts = np.sort(unit[:, :-1], axis=1)  # differences of sorted numbers: uniform weights
        weights = np.diff(cuts, axis=1, prepend=0.0, append=1.0)
        result: Array = np.einsum("mi,mij->mj", weights, self.simplices[of])
        return result

    def log_prob(self, t: Array) -> Array:
        from scipy.special import gammaln

        volume = np.log(self.volumes.sum()) - gammaln(t.shape[1] + 1.0)
        return np.where(self.contains(t), -volume, -np.inf)

    def contains(self, t: Array) -> Mask:
        size = np.ptp(self.simplices.reshape(-1, t.shape[1]), axis=0).max()
        beyond = self.faces[:, :-1] @ t.T + self.faces[:, -1:]
        inside: Mask = np.all(beyond <= EDGE * size, axis=0)
        return inside


def _corners(data: Array) -> Array:
    """Return the data's extreme points, or all where finding these takes longer."""
    from scipy.spatial import ConvexHull

    few = 2 <= data.shape[1] <= MOST_MODES
    return data[ConvexHull(data).vertices] if few else data


KINDS: dict[str, Callable[[Array], Density]] = {
    "box": Box.of,
    "ellipsoid": Ellipsoid.of,
    "gaussian": Mixture.normal,
    "mixture": Mixture.learned,
    "hull": Hull.of,
}


def _chosen(ends: Array, unit: Array) -> Indices:
    """Return which parts numbers uniform in 0 to 1 fall on, of parts that end at `ends` (s,)."""
    return np.minimum(np.searchsorted(ends, unit, side="right"), len(ends) - 1)


def _normal(unit: Array) -> Array:
    """Carry numbers uniform in 0 to 1 to normal deviates."""
    from scipy.special import ndtri

    result: Array = ndtri(np.clip(unit, 1e-15, 1.0 - 1e-15))
    return result
