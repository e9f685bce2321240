"""The thickest places of sections, from their landmarks and the slopes of a few.

The height between two sides at one x is largest where the sides are parallel.  With s and r for
the places on the suction and the pressure side, x to the trailing edge,

    X(s) = x(r),        Y'(s) x'(r) = y'(r) X'(s)

are solved by Newton's method between the landmarks nearest to the place, which are found first.
Where other landmarks may be as near to it, all of them are tried (`Cubics.height`).
"""

from typing import NamedTuple

import numpy as np

from bladegen.airfoils.slopes import SplineSlopes
from bladegen.curves.cubics import Cubics, pieces, rivals
from bladegen.support.arrays import Array, Indices, Mask

__all__ = ["Places", "thickest", "thickest_again"]

REACH = 12  # landmarks either side of the thickest pair, among which the place is sought
LEAST = 3  # of these, where a side has too few for more
ITERATIONS = 10  # four are usual
SETTLED = 1e-7  # of the way between landmarks; the step after is a thousand squares of it
ROUNDING = 1e-12  # by which a place may pass the landmark that it lies at


class Places(NamedTuple):
    """The thickest places of sections.

    Parameters
    ----------
    height : (k,) array
        Between the sides, normal to the direction.
    settled : (k,) array of bool
        Where the landmarks nearest to it are known, and alone.
    upper, lower : (k,) arrays of int
        The landmarks nearest to it on the suction and on the pressure side.
    off : (2, k) array
        By how much of the way to the next landmark it lies after those, or before.
    pair : (k,) array
        The height of the thickest pair of opposite landmarks.
    """

    height: Array
    settled: Mask
    upper: Indices
    lower: Indices
    off: Array
    pair: Array

    def take(self, rows: Indices) -> "Places":
        """Return those of some of the sections."""
        height, settled, upper, lower, off, pair = self
        off, pair = off[:, rows], pair[rows]
        return Places(height[rows], settled[rows], upper[rows], lower[rows], off, pair)


def thickest(slopes: SplineSlopes, planes: Array, along: Array) -> Places:
    """Return the thickest places of sections.

    Parameters
    ----------
    slopes, planes : SplineSlopes and (2, k, n) array
        The sections.
    along : (k, 2) array
        Unit vectors of the direction to which heights are normal.
    """
    k, n = planes.shape[1:]
    axes, middle = _axes(along), n // 2
    apart = planes[:, :, :middle] - planes[:, :, :middle:-1]
    paired = (axes[:, 1:] @ apart.swapaxes(0, 1))[:, 0]
    best = np.argmax(paired, axis=1)
    pair = paired[np.arange(k), best]
    places = Places(
        np.empty(k), np.zeros(k, dtype=bool), best, n - 1 - best, np.zeros((2, k)), pair
    )
    reach = min(REACH, (middle - 3) // 2)
    if reach >= LEAST:
        best = np.minimum(np.maximum(best, reach + 1), middle - reach - 2)
        upper, lower, off, alone = _nearest(planes, axes, best, reach)
        near = Places(places.height, alone, upper, lower, off, pair)
        places = _followed(slopes, planes, axes, near)
    rows = np.flatnonzero(~places.settled)
    if rows.size:
        some = planes[:, rows]
        points, rates = (
            (axes[rows] @ values.swapaxes(0, 1)).mT for values in (some, slopes.all(some))
        )
        places.height[rows] = Cubics(slopes.u, points, rates).height
    return places


def thickest_again(slopes: SplineSlopes, planes: Array, along: Array, known: Places) -> Array:
    """Return the largest heights (k,) of sections whose thickest places are about the known ones.

    Parameters are those of `thickest`.
    """
    places = _followed(slopes, planes, _axes(along), known)
    rows = np.flatnonzero(~places.settled)
    if rows.size:
        places.height[rows] = thickest(slopes, planes[:, rows], along[rows]).height
    return places.height


def _axes(along: Array) -> Array:
    """Return unit vectors and the normals to them, (k, 2, 2)."""
    axes = np.empty((len(along), 2, 2))
    axes[:, 0], axes[:, 1] = along, along[:, ::-1] * (-1.0, 1.0)
    return axes


def _followed(slopes: SplineSlopes, planes: Array, axes: Array, near: Places) -> Places:
    """Follow the height from places nearby to where it is largest."""
    rows = np.arange(len(near.upper))
    landmarks, both = np.concatenate([near.upper, near.lower]), np.concatenate([rows, rows])
    around = landmarks[:, None] + np.arange(-1, 2)
    turn = np.concatenate([axes, axes])
    points = turn @ planes[:, both[:, None], around].swapaxes(0, 1)
    rates = turn @ slopes.around(planes, both, landmarks).swapaxes(0, 1)
    height, settled, off = _parallel(slopes.u, points, rates, landmarks, near.off.reshape(-1))
    settled &= near.settled
    return Places(height, settled, near.upper, near.lower, off.reshape(2, -1), near.pair)


def _nearest(
    planes: Array, axes: Array, best: Indices, reach: int
) -> tuple[Indices, Indices, Array, Mask]:
    """Return the landmarks nearest to thickest places, by how many landmarks they are missed, and
    where no others may be as near.

    From the thickest pairs, by landmarks alone.
    """
    n, rows = planes.shape[2], np.arange(len(best))
    window = best[:, None] + np.arange(-reach - 1, reach + 2)
    near = np.concatenate([window, n - 1 - window], axis=1)
    turned = axes @ planes[:, rows[:, None], near].swapaxes(0, 1)
    count = window.shape[1]
    apart, other = turned[..., :count] - turned[..., count:], turned[..., count:]
    ahead = other[..., :-2] - other[..., 2:]  # two landmarks on along the pressure side
    with np.errstate(all="ignore"):
        heights = apart[:, 1, 1:-1] - apart[:, 0, 1:-1] * (ahead[:, 1] / ahead[:, 0])
        inner = np.minimum(np.maximum(np.argmax(heights, axis=1), 1), count - 4)
        low, here, high = (heights[rows, inner + i] for i in (-1, 0, 1))
        offset = np.fmin(np.fmax(0.5 * (low - high) / (low - 2.0 * here + high), -0.5), 0.5)
        passed = 2.0 * apart[rows, 0, inner + 1] / ahead[rows, 0, inner] - offset
        passed = np.fmin(np.fmax(passed, 1 - count), count - 1)  # a number, whatever it was
        alone: Mask = ~np.any(rivals(heights, inner), axis=1)
    steps = np.rint(passed)
    upper = best + inner - reach
    lower = np.minimum(np.maximum(n - 1 - upper + steps.astype(np.int64), n // 2 + 1), n - 2)
    return upper, lower, np.array([offset, passed - steps]), alone


def _parallel(
    u: Array, points: Array, rates: Array, landmarks: Indices, off: Array
) -> tuple[Array, Mask, Array]:
    """Return the heights (k,) where sides are parallel, where that is settled, and the places.

    Points and slopes (2 k, 2, 3) are at landmarks (2 k,) and their neighbours, first of all
    suction, then of all pressure sides; places are sought from `off` on, in the cell after the
    landmark or before it.
    """
    k, after = len(off) // 2, off > 0.0
    s = off + ~after
    cubics = _between(u, points, rates, landmarks, after)
    with np.errstate(all="ignore"):
        for i in range(ITERATIONS):
            step, bending = _step(cubics, s)
            s = s - step
            if not np.abs(step).max(initial=0.0) > SETTLED:
                break
            outside = (s < 0.0) | (s > 1.0)
            if i == 1 and outside.any():
                s = np.where(outside, np.where(after, s + 1.0, s - 1.0), s)
                after = after ^ outside
                cubics = _between(u, points, rates, landmarks, after)
        a, b, c, d = (part[1] for part in cubics)
        y = ((d * s + c) * s + b) * s + a
        settled = (np.abs(step) <= SETTLED) & (np.abs(s - 0.5) <= 0.5 + ROUNDING)
        settled = settled[:k] & settled[k:] & (bending < 0.0)
        return y[:k] - y[k:], settled, s - ~after


def _between(
    u: Array, points: Array, rates: Array, landmarks: Indices, after: Mask
) -> tuple[Array, ...]:
    """Return the cubics (2, 2 k) of the cells after landmarks, or before them."""
    cell = landmarks - 1 + after
    width, chosen = (u[cell + 1] - u[cell])[:, None], after[:, None]
    start, end = (np.where(chosen, points[..., i + 1], points[..., i]) for i in (0, 1))
    slope, last = (np.where(chosen, rates[..., i + 1], rates[..., i]) * width for i in (0, 1))
    return pieces(start.T, end.T, slope.T, last.T)


def _step(cubics: tuple[Array, ...], s: Array) -> tuple[Array, Array]:
    """Return a step (2 k,) of Newton's method back from places s, and the height's bending (k,)."""
    a, b, c, d = cubics
    k = len(s) // 2
    here = ((d[0] * s + c[0]) * s + b[0]) * s + a[0]
    rate, bend = (3.0 * d * s + 2.0 * c) * s + b, 6.0 * d * s + 2.0 * c
    (x, y), (x2, y2) = rate, bend
    ahead = here[:k] - here[k:]
    turned = y[:k] * x[k:] - y[k:] * x[:k]
    first = y2[:k] * x[k:] - y[k:] * x2[:k]
    second = y[:k] * x2[k:] - y2[k:] * x[:k]
    bending = x[:k] * second + x[k:] * first
    step = np.concatenate([ahead * second + x[k:] * turned, x[:k] * turned - first * ahead])
    return step / np.concatenate([bending, bending]), bending
