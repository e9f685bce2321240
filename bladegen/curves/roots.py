"""Roots of many functions of one number at once, each kept between two places by their signs.

`falling` follows a derivative, for smooth functions that are dear; `bracketed` needs values alone.
"""

from collections.abc import Callable

import numpy as np

from bladegen.support.arrays import Array, Indices, Mask

__all__ = [
    "HALVED",
    "ITERATIONS",
    "JUMP",
    "PARAMETER_TOLERANCE",
    "ROUNDING",
    "SMOOTH",
    "bracketed",
    "falling",
]

PARAMETER_TOLERANCE = 1e-8  # of u, before the last step; places are off by a thousand squares of it
ITERATIONS = 60  # bisection alone needs 40
SMOOTH = 6  # steps, about, that find the root of a smooth function
JUMP = 1e-3  # of values that are as far apart then, at the ends, the way is halved between
HALVED = 1e-9  # of the way from 0 to 1; a jump is followed to there
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
    f: Callable[[Array, Indices], Array], count: int, tolerance: float
) -> tuple[Array, Mask]:
    """Find where functions fall through zero between 0 and 1, by false position (Illinois).

    A function that jumps through zero is halved to its jump; of the places on either side that is
    returned whose value is nearer to zero.

    Parameters
    ----------
    f : callable
        Returns the values of the functions `rows` (m,) at places (m,).
    count : int
        How many functions there are.
    tolerance : float
        Of the values.

    Returns
    -------
    place : (count,) array
        0 where a function is not positive there, else 1 where it is not negative there.
    either : (count,) array of bool
        Where both are so.
    """
    rows = np.arange(count)
    low, high = np.zeros(count), np.ones(count)
    above, below = f(low, rows), f(high, rows)
    first, last = ~(above > tolerance), ~(below < -tolerance)
    place, step = np.where(last & ~first, 1.0, 0.0), high.copy()
    rows = rows[~first & ~last]
    kept = np.zeros(count)  # the end that the last place left: 1 the upper, -1 the lower
    ends, jumps = np.stack([above, below]), np.zeros(count, dtype=bool)
    for k in range(ITERATIONS):
        if not rows.size:
            break
        a, b = above[rows], below[rows]
        share = np.where(jumps[rows], 0.5, a / (a - b))
        at = low[rows] + (high[rows] - low[rows]) * share
        step[rows], place[rows] = at - place[rows], at
        value = f(at, rows)
        rises = value > 0.0
        up, down = rows[rises], rows[~rises]
        low[up], above[up], ends[0, up] = at[rises], value[rises], value[rises]
        high[down], below[down], ends[1, down] = at[~rises], value[~rises], value[~rises]
        below[up] *= np.where(kept[up] > 0.0, 0.5, 1.0)  # or an end that stays would hold all back
        above[down] *= np.where(kept[down] < 0.0, 0.5, 1.0)
        kept[up], kept[down] = 1.0, -1.0
        jumps[rows] = (k >= SMOOTH) & (ends[0, rows] - ends[1, rows] > JUMP)
        small = np.abs(step[rows]) <= np.where(jumps[rows], HALVED, ROUNDING)
        rows = rows[(np.abs(value) > tolerance) & ~small]
    nearer = np.where(ends[0] < -ends[1], low, high)
    place = np.where(jumps, nearer, place)
    return place, first & last
