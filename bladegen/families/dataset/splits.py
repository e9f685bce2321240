"""Splits of a family into training, validation and test: fixed by a seed, variant by variant.

A variant's part depends on the seed and on its place alone, so that a family which is added to
keeps the parts of the variants that it had.  Shares are therefore met on average, not exactly.
"""

import math
from collections.abc import Sequence

import numpy as np

from bladegen.errors import FamilyError
from bladegen.support.arrays import Array, Indices

__all__ = ["SHARES", "SPLITS", "split_of"]

SPLITS = ("train", "validation", "test")
SHARES = (0.8, 0.1, 0.1)
STEP = 0x9E3779B97F4A7C15  # of SplitMix64 (Steele, Lea & Flood, OOPSLA 2014), as its two factors
FACTORS = ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB))
WORD = 2**64


def split_of(index: Indices, seed: int, shares: tuple[float, float, float] = SHARES) -> Indices:
    """Return the part of each variant, a place in `SPLITS`.

    Parameters
    ----------
    index : (b,) array of int
        Places of variants in their family.
    seed : int
        Of the split.
    shares : three floats
        Of training, validation and test; they sum to one.

    Raises
    ------
    FamilyError
        If shares are negative or do not sum to one.

    >>> split_of(np.arange(8), 7)
    array([0, 0, 2, 1, 0, 0, 0, 0])
    """
    several = isinstance(shares, Sequence | np.ndarray) and len(shares) == len(SPLITS)
    if not (several and min(shares) >= 0 and math.isclose(sum(shares), 1.0)):
        raise FamilyError(
            f"shares: got {shares}, must be three that sum to 1: train, validation, test"
        )
    bounds = np.cumsum(shares)[:-1]
    found: Indices = np.searchsorted(bounds, _uniform(index, seed), side="right")
    return found


def _uniform(index: Indices, seed: int) -> Array:
    """Return a number in [0, 1) for each place, by the generator SplitMix64."""
    with np.errstate(over="ignore"):
        mixed = (np.asarray(index, dtype=np.uint64) + np.uint64(1)) * np.uint64(STEP)
        mixed += np.uint64(_start(seed))
        for shift, factor in FACTORS:
            mixed = (mixed ^ (mixed >> np.uint64(shift))) * np.uint64(factor)
        mixed ^= mixed >> np.uint64(31)
    values: Array = (mixed >> np.uint64(11)).astype(np.float64) * 2.0**-53
    return values


def _start(seed: int) -> int:
    """Return where the sequence of a seed starts: neighbouring seeds are far apart."""
    mixed = seed % WORD
    for shift, factor in FACTORS:
        mixed = ((mixed ^ (mixed >> shift)) * factor) % WORD
    return mixed ^ (mixed >> 31)
