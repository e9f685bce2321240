"""Roots of many functions of one number at once, each kept between two places by their signs.

`falling` follows a derivative, for smooth functions that are dear; `bracketed` needs values alone.
"""

from collections.abc import Callable

import numpy as np

from bladegen.support.arrays import Array, Indices

__all__ = [
    "ITERATIONS",
    "PARAMETER_TOLERANCE",
    "ROUNDING",
    "bracketed",
    "falling",
]

PARAMETER_TOLERANCE = 1e-8  # of u, before the last step; places are off by a thousand squares of it
ITERATIONS = 60  # bisection alone needs 40
ROUNDING = 1e-15  # of the way from 0 to 1; steps below it change nothing


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


def bracketed(
    f: Callable[[Array, Indices], Array], above: Array, below: Array, tolerance: float
) -> Array:
    """Find where functions fall through zero between 0 and 1, by false position (Illinois).

    Parameters
    ----------
    f : callable
        Returns the values of the functions `rows` (m,) at places (m,).
    above, below : (count,) arrays
        Their values at 0 and at 1.
    tolerance : float
        Of the values.

    Returns
    -------
    (count,) array
        0 where a function is not positive there, else 1 where it is not negative there.
    """
    above, below, low, high = above.copy(), below.copy(), np.zeros(len(above)), np.ones(len(above))
    first, last = ~(above > tolerance), ~(below < -tolerance)
    place, kept = np.where(last & ~first, 1.0, 0.0), np.zeros(len(above))
    rows = np.flatnonzero(~first & ~last)
    for _ in range(ITERATIONS):
        if not rows.size:
            break
        a, b = above[rows], below[rows]
        at = low[rows] + (high[rows] - low[rows]) * (a / (a - b))
        step = at - place[rows]
        place[rows] = at
        value = f(at, rows)
        rises = value > 0.0
        up, down = rows[rises], rows[~rises]
        low[up], above[up] = at[rises], value[rises]
        high[down], below[down] = at[~rises], value[~rises]
        below[up] *= np.where(kept[up] > 0.0, 0.5, 1.0)  # or an end that stays would hold all back
        above[down] *= np.where(kept[down] < 0.0, 0.5, 1.0)
        kept[up], kept[down] = 1.0, -1.0
        rows = rows[(np.abs(value) > tolerance) & (np.abs(step) > ROUNDING)]
    return place
