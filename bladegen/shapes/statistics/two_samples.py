"""Whether two sets of coordinates are drawn alike: energy distance, maximum mean discrepancy.

In: samples (m, r) and (n, r) of the same quantities.  Out: how far apart their distributions lie,
and how often as large a distance comes by chance, if who belongs to which set is shuffled.

Both are mean k(x, x') + mean k(y, y') - 2 mean k(x, y), of all pairs: with k = -|x - y| the energy
distance (Szekely & Rizzo, J. Stat. Plan. Inference 143, 2013), with k = exp(-|x - y|^2 / 2 s^2) and
s the median distance the squared maximum mean discrepancy (Gretton et al., J. Mach. Learn. Res. 13,
2012).  Neither is ever negative, and both are zero for the same distribution alone, in any number
of dimensions (Sejdinovic et al., Ann. Stat. 41, 2013).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.errors import SpaceError
from bladegen.support.arguments import generator, numbers, one_of, whole
from bladegen.support.arrays import Array

__all__ = ["TwoSamples", "two_samples"]

MOST = 1000  # of each set, drawn at random from more: pairs are kept in memory
ALIKE = 0.05  # p-values below are told as a difference


def _energy(distance: Array) -> Array:
    return -distance


def _mmd(distance: Array) -> Array:
    between = distance[np.triu_indices_from(distance, 1)]
    size = float(np.median(between)) or 1.0
    result: Array = np.exp(-0.5 * (distance / size) ** 2)
    return result


KERNELS: dict[str, Callable[[Array], Array]] = {"energy": _energy, "mmd": _mmd}


@dataclass(frozen=True, repr=False)
class TwoSamples:
    """What a test of two sets of coordinates found.

    Parameters
    ----------
    kind : str
        "energy" or "mmd".
    statistic : float
        How far apart they lie: the energy distance, or the squared maximum mean discrepancy.
    p_value : float
        Share of shuffles with as large a statistic: small where sets are not drawn alike.
    each : tuple of float
        Of each coordinate alone, by the test of Kolmogorov and Smirnov: where they differ.
    counts : (int, int)
        How many of each set were compared.
    """

    kind: str
    statistic: float
    p_value: float
    each: tuple[float, ...]
    counts: tuple[int, int]

    def __repr__(self) -> str:
        said = "drawn alike, as far as can be told" if self.alike else "not drawn alike"
        return (
            f"<TwoSamples: {said}: {self.kind} {self.statistic:.3g}, p = {self.p_value:.3g}, "
            f"{self.counts[0]} against {self.counts[1]}>"
        )

    @property
    def alike(self) -> bool:
        """Whether nothing speaks against one distribution, at a level of 5 %."""
        return self.p_value >= ALIKE


def two_samples(
    one: Any,
    other: Any,
    *,
    kind: str = "energy",
    shuffles: int = 999,
    rng: np.random.Generator | int | None = 0,
) -> TwoSamples:
    """Test whether two sets of coordinates are drawn from one distribution.

    Columns are compared in units of their common standard deviation, so that radians, degrees
    and factors count alike; those in which nothing varies are left out.

    Parameters
    ----------
    one, other : (m, r) and (n, r) arrays, or families
        The sets; of more than 1,000 so many are drawn.  Of a loaded family, or of a space, its
        `parameters` or `coordinates` are taken.
    kind : str
        "energy": the energy distance, without anything to choose; or "mmd": the squared maximum
        mean discrepancy with a Gaussian kernel as wide as the median distance.
    shuffles : int
        How many random shuffles; the least p-value is 1 / (shuffles + 1).
    rng : numpy.random.Generator or int, optional
        Of the shuffles, or its seed: the same seed, the same answer.

    Raises
    ------
    SpaceError
        If the sets have not the same columns, or fewer than two rows.

    >>> import bladegen as bg
    >>> space = bg.ShapeSpace.bundled()
    >>> box, hull = space.distribution("box"), space.distribution("hull")
    >>> bg.two_samples(box.sample(200, 1), box.sample(200, 2)).alike
    True
    >>> bg.two_samples(box.sample(200, 1), hull.sample(200, 2)).alike
    False
    """
    from scipy.spatial.distance import cdist
    from scipy.stats import ks_2samp

    one_of(kind, KERNELS, "kind", SpaceError)
    if whole(shuffles, "shuffles", SpaceError) < 1:
        raise SpaceError(f"shuffles: got {shuffles}, must be at least 1")
    random = generator(rng, "rng", SpaceError)
    a, b = (_some(_rows(values, name), random) for values, name in ((one, "one"), (other, "other")))
    if a.shape[1] != b.shape[1]:
        raise SpaceError(f"other: got {b.shape[1]} columns, must be {a.shape[1]} as the first has")
    pooled = np.concatenate([a, b])
    spread = pooled.std(axis=0)
    scaled = pooled / np.where(spread > 0, spread, 1.0)
    kernel = KERNELS[kind](cdist(scaled, scaled))
    own = np.zeros((len(pooled), 1))
    own[: len(a)] = 1.0
    found = float(_apart(kernel, own)[0])
    shuffled = random.permuted(np.repeat(own, shuffles, axis=1), axis=0)
    larger = int(np.count_nonzero(_apart(kernel, shuffled) >= found * (1.0 - 1e-12)))
    each = tuple(float(ks_2samp(x, y).pvalue) for x, y in zip(a.T, b.T, strict=True))
    return TwoSamples(kind, found, (1 + larger) / (1 + shuffles), each, (len(a), len(b)))


def _apart(kernel: Array, first: Array) -> Array:
    """Return statistics (p,) of splits: 1 where a row (m + n, p) is of the first set, 0 else."""
    second = 1.0 - first
    m, n = first[:, 0].sum(), second[:, 0].sum()
    weight = first / m - second / n
    result: Array = np.einsum("ip,ip->p", weight, kernel @ weight)
    return result


def _rows(given: Any, name: str) -> Array:
    """Return a set as an array (m, r), by what a family or a space holds."""
    for attribute in ("parameters", "coordinates"):
        given = getattr(given, attribute, given)
    values = numbers(given, name, SpaceError)
    values = values[:, None] if values.ndim == 1 else values
    if values.ndim != 2 or len(values) < 2 or not np.isfinite(values).all():
        raise SpaceError(
            f"{name}: got the shape {values.shape}, must be (samples, coordinates), two rows or "
            "more of finite numbers, such as family.parameters"
        )
    return values


def _some(values: Array, random: np.random.Generator) -> Array:
    return values if len(values) <= MOST else random.choice(values, MOST, replace=False)
