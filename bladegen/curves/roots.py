"""Roots of many functions of one number at once, each kept between two places by their signs."""

from collections.abc import Callable

import numpy as np

from bladegen.support.arrays import Array

__all__ = [
    "ITERATIONS",
    "PARAMETER_TOLERANCE",
    "falling",
]

PARAMETER_TOLERANCE = 1e-8  # of u, before the last step; places are off by a thousand squares of it
ITERATIONS = 60  # bisection alone needs 40


def falling(
    f: Callable[[Array], tuple[Array, Array]], low: Array, start: Array, high: Array
) -> Array:
    """Find where f falls through zero between `low` and `high`: Newton, kept by bisection.

    `f` returns the value and its derivative; positive at `low`, negative at `high`.
    """
    u, low, high = start.copy(), low.copy(), high.copy()
    for _ in range(ITERATIONS):
        value, slope = f(u)
        low, high = np.where(value > 0, u, low), np.where(value > 0, high, u)
        with np.errstate(divide="ignore", invalid="ignore"):
            newton = u - value / slope
        inside = (newton >= low) & (newton <= high)
        following = np.where(inside, newton, 0.5 * (low + high))
        settled = np.all(np.abs(following - u) <= PARAMETER_TOLERANCE)
        u = following
        if settled:
            break
    return u
