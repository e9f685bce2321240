"""Points of the unit cube for designs of experiments, each drawn when it is asked for.

A variant's point depends on the seed and its place alone (with a Latin hypercube and sweeps on the
count as well), whoever asks and in whatever order.  Sequences come in pages, so that a plan of
millions takes no more memory than a plan of thousands.
"""

from collections.abc import Callable
from functools import lru_cache
from numbers import Integral

import numpy as np

from bladegen.errors import DesignError
from bladegen.support.arguments import shown
from bladegen.support.arrays import Array, Indices, readonly

__all__ = [
    "WIDEST",
    "Points",
    "Seed",
    "corners",
    "independent",
    "latin",
    "point",
    "seed_of",
    "sobol",
]

DIAGONALS = 1024  # of a box; with more factors than ten only so many are swept
PAGE, PAGES = 2**14, 8  # points of a Sobol sequence made at once, and how many such are kept
WIDEST = 2**63  # of the numbers that generators give for seeds: a manifest's column holds them
Seed = int | None | np.random.Generator | np.random.BitGenerator | np.random.SeedSequence
Points = Callable[[Indices, int, int, int], Array]  # of places, count, dimension and seed


def seed_of(seed: Seed) -> int:
    """Return the number that a seed stands for, by NumPy's convention.

    A whole number is itself; None gives a fresh number; a generator gives one and moves on, so
    that the same generator gives another family the next time.

    Raises
    ------
    DesignError
        If it is negative or no seed.
    """
    if isinstance(seed, Integral) and not isinstance(seed, bool):
        if seed < 0:
            raise DesignError(f"seed: got {seed}, must not be negative")
        return int(seed)
    if seed is None or isinstance(
        seed, np.random.Generator | np.random.BitGenerator | np.random.SeedSequence
    ):
        return int(np.random.default_rng(seed).integers(WIDEST))
    raise DesignError(
        f"seed: got {shown(seed)}, must be a whole number from 0, None, or a NumPy Generator, "
        "BitGenerator or SeedSequence"
    )


def sobol(index: Indices, count: int, dimension: int, seed: int) -> Array:  # noqa: ARG001
    pages = index // PAGE
    points = np.empty((len(index), dimension))
    for page in np.unique(pages).tolist():
        rows = pages == page
        points[rows] = _sobol_page(page, dimension, seed)[index[rows] % PAGE]
    return points


@lru_cache(PAGES)
def _sobol_page(page: int, dimension: int, seed: int) -> Array:
    """Return the points of one page of the sequence; whole powers of two keep the balance."""
    from scipy.stats import qmc

    engine = qmc.Sobol(dimension, rng=np.random.default_rng(seed))
    if page:
        engine.fast_forward(page * PAGE)
    return readonly(engine.random(PAGE))


def latin(index: Indices, count: int, dimension: int, seed: int) -> Array:
    return _hypercube(count, dimension, seed)[index]


@lru_cache(1)
def _hypercube(count: int, dimension: int, seed: int) -> Array:
    from scipy.stats import qmc

    return readonly(qmc.LatinHypercube(dimension, rng=np.random.default_rng(seed)).random(count))


def independent(index: Indices, count: int, dimension: int, seed: int) -> Array:  # noqa: ARG001
    points = [point(seed, place, 0, dimension) for place in index.tolist()]
    return np.reshape(points, (len(index), dimension))


def point(seed: int, index: int, attempt: int, dimension: int) -> Array:
    """Return the point of the unit cube of one variant at one attempt."""
    key = np.random.SeedSequence(seed, spawn_key=(index, attempt))
    point: Array = np.random.Generator(np.random.PCG64(key)).random(dimension)
    return point


def corners(index: Indices, count: int, dimension: int, seed: int) -> Array:  # noqa: ARG001
    """Run through the box from corner to opposite corner, along each diagonal in turn."""
    lines = min(2 ** (dimension - 1), DIAGONALS)
    line, step = index % lines, index // lines
    steps = max(1, -(-count // lines) - 1)
    along = np.clip(step / steps, 0.0, 1.0)
    bits = (line[:, None] >> np.arange(dimension)) & 1
    points: Array = np.where(bits == 1, 1.0 - along[:, None], along[:, None])
    return points
