"""Distributions of normal coordinates: where shapes like those of a space's data lie, how densely.

In: coordinates (m, r) of the data.  Out: a `Distribution` that draws coordinates, and says how
likely they are and whether they lie among the data: the box, the smallest ellipsoid or the convex
hull that holds these, a normal distribution or a mixture of them.  Without the shapes that cross
themselves if asked for: draws are then rejected, exactly.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from bladegen.curves.crossing import crossing_sections
from bladegen.errors import SpaceError
from bladegen.shapes.statistics.densities import KINDS, Density
from bladegen.support.arguments import generator, numbers, one_of, whole
from bladegen.support.arrays import Array, Mask

__all__ = ["KINDS", "Distribution", "distribution_of", "sound_at"]

DESIGNS = {"normal": "gaussian", "smallest": "ellipsoid"}  # `designs` names them otherwise

TRIED, SEED = 5_000, 2022  # draws that say which share of a distribution is sound
HOPELESS = 10_000  # draws of which none is sound
CHUNK = 500  # shapes that are tested at once: they fit in a cache


@dataclass(frozen=True, eq=False, repr=False)
class Distribution:
    """A distribution of coordinates (r,).  `ShapeSpace.distribution` makes one.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    dimension : int
        How many coordinates, r.
    density : Density
        Of coordinates, sound or not.
    sound : callable, optional
        Tells which coordinates (m, r) give shapes that do not cross themselves; only these are
        drawn then.
    """

    kind: str
    dimension: int
    density: Density
    sound: Callable[[Array], Mask] | None = None

    def __repr__(self) -> str:
        only = ", sound shapes alone" if self.sound else ""
        return f"<Distribution of {self.dimension} coordinates: {self.kind}{only}>"

    def sample(self, count: int, rng: np.random.Generator | int | None = None) -> Array:
        """Draw coordinates (count, r), by a generator of random numbers or its seed.

        Raises
        ------
        SpaceError
            If no draw of thousands is sound.
        """
        count = whole(count, "count", SpaceError)
        if count < 0:
            raise SpaceError(f"count: got {count}, must not be negative")
        random = generator(rng, "rng", SpaceError)
        if self.sound is None:
            return self.density.carried(random.random((count, self.dimension + 1)))
        kept, tried, found = [np.empty((0, self.dimension))], 0, 0
        while found < count:
            drawn = self.density.carried(random.random((count, self.dimension + 1)))
            kept.append(drawn[self.sound(drawn)])
            found, tried = found + len(kept[-1]), tried + count
            if not found and tried > HOPELESS:
                raise SpaceError(f"{self.kind}: none of {tried} draws is a sound shape")
        return np.concatenate(kept)[:count]

    def log_prob(self, t: Any) -> Array:
        """Return the logarithm of the density at coordinates (..., r), -inf where there is none.

        Of sound shapes alone it is known to a percent: their share is measured by 5,000 draws.
        """
        flat, lead = self._flat(t)
        found = self.density.log_prob(flat)
        if self.sound is not None:
            found = np.where(self.sound(flat), found - np.log(self.share), -np.inf)
        return found.reshape(lead)

    def contains(self, t: Any) -> Mask:
        """Tell which coordinates (..., r) lie among the data, and are sound where only such are.

        Of normal distributions and mixtures: which are as likely as the least likely of the data.
        """
        flat, lead = self._flat(t)
        inside = self.density.contains(flat)
        if self.sound is not None:
            inside = inside & self.sound(flat)
        return inside.reshape(lead)

    @cached_property
    def share(self) -> float:
        """The share of draws that are sound, of 5,000; 1 if nobody asked."""
        if self.sound is None:
            return 1.0
        rng = np.random.default_rng(SEED)
        drawn = self.density.carried(rng.random((TRIED, self.dimension + 1)))
        return float(np.mean(self.sound(drawn)))

    def _flat(self, t: Any) -> tuple[Array, tuple[int, ...]]:
        values = numbers(t, "t", SpaceError)
        if values.ndim == 0 or values.shape[-1] != self.dimension:
            raise SpaceError(f"t: got the shape {values.shape}, must be (..., {self.dimension})")
        return values.reshape(-1, self.dimension), values.shape[:-1]


def distribution_of(space: Any, kind: str, *, sound: bool = False) -> Distribution:
    """Return a distribution of the space's coordinates, learned from those of its data.

    Parameters
    ----------
    kind : str
        "box", "ellipsoid" (the smallest that holds the data), "hull" (convex), "gaussian" or
        "mixture" of these, its number by BIC, which needs scikit-learn.
    sound : bool
        Only shapes that do not cross themselves.

    Raises
    ------
    SpaceError
        If there is no such kind, or the data are too few for it.
    """
    if kind in DESIGNS:
        raise SpaceError(
            f"distribution: got {kind!r}, which is the design of families that is called "
            f"{DESIGNS[kind]!r} here; allowed are {', '.join(KINDS)}"
        )
    one_of(kind, KINDS, "distribution", SpaceError)
    density = _density(space, kind)
    return Distribution(kind, space.dimension, density, space.sound if sound else None)


@lru_cache(16)
def _density(space: Any, kind: str) -> Density:
    return KINDS[kind](space.coordinates)


def sound_at(space: Any, t: Any) -> Mask:
    """Tell which shapes (...) at coordinates t (..., r) do not cross themselves."""
    values = numbers(t, "t", SpaceError)
    flat = values.reshape(-1, values.shape[-1])
    result = np.ones(len(flat), dtype=bool)
    for first in range(0, len(flat), CHUNK):
        shapes = space.decode(flat[first : first + CHUNK])
        result[first + np.array(crossing_sections(shapes), dtype=np.int64)] = False
    return result.reshape(values.shape[:-1])
