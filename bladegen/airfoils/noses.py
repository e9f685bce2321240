"""From landmarks to the noses of sections: the points farthest from the trailing edge.

Between two landmarks a section is a cubic, and its squared distance from the edge has one peak
there: Newton's method climbs to it from where its slopes at either end say it is.
"""

from typing import NamedTuple

import numpy as np

from bladegen.airfoils.resizing import RIVAL
from bladegen.airfoils.slopes import SplineSlopes
from bladegen.curves.cubics import Cubics, pieces
from bladegen.curves.roots import falling
from bladegen.support.arrays import Array, Indices, Mask

__all__ = ["Noses", "farthest", "several_peaks"]

ITERATIONS = 8  # three are usual
SETTLED = 1e-7  # of the way between landmarks; the step after is a thousand squares of it
SAME_NOSE = 3  # landmarks; nearer peaks are one nose


class Noses(NamedTuple):
    """The noses of sections.

    Parameters
    ----------
    first, second : (k, 2) arrays
        The farthest points, and the farthest of other peaks of the distance nearly as far; the
        same where there is none.
    low, high : (k,) arrays of int
        The landmarks nearest to the two.
    """

    first: Array
    second: Array
    low: Indices
    high: Indices

    def take(self, rows: Indices) -> "Noses":
        """Return those of some of the sections."""
        return Noses(self.first[rows], self.second[rows], self.low[rows], self.high[rows])


def farthest(slopes: SplineSlopes, planes: Array, edge: Array) -> Noses:
    """Return the noses of sections.

    Parameters
    ----------
    slopes, planes : SplineSlopes and (2, k, n) array
        The sections; noses are in their front half.
    edge : (2, k) array
        The trailing-edge midpoints.
    """
    ahead = planes.shape[2] // 4
    distances, y = planes[..., ahead:-ahead] - edge[..., None]
    distances *= distances
    y *= y
    distances += y
    best, rows = np.argmax(distances, axis=1), np.arange(len(distances))
    first = _peak(slopes, planes, edge, rows, best + ahead)
    peaks, several = _peaks(distances, best)
    more = np.flatnonzero(several)
    if not more.size:
        return Noses(first, first, best + ahead, best + ahead)
    inner, peaks = distances[more, 1:-1], peaks[more]
    peaks &= np.abs(np.arange(1, distances.shape[1] - 1) - best[more, None]) > SAME_NOSE
    peaks &= inner > distances[more].max(axis=1, keepdims=True) * (1.0 - RIVAL)
    rivals = np.flatnonzero(peaks.any(axis=1))
    second, other = first.copy(), best + ahead
    if rivals.size:
        rows = more[rivals]
        other[rows] = 1 + ahead + np.argmax(np.where(peaks, inner, -1.0)[rivals], axis=1)
        second[rows] = _peak(slopes, planes, edge, rows, other[rows])
    return Noses(first, second, np.minimum(best + ahead, other), np.maximum(best + ahead, other))


def several_peaks(planes: Array, edge: Array, A: Array) -> Mask:
    """Tell which sections (2, k, n) have more than one peak of the distance under maps (k, 2, 2).

    `edge` (2, k) are the trailing-edge midpoints.
    """
    ahead = planes.shape[2] // 4
    away = A.mT @ (planes[..., ahead:-ahead] - edge[..., None]).swapaxes(0, 1)
    away *= away
    distances = away[:, 0] + away[:, 1]
    return _peaks(distances, np.argmax(distances, axis=1))[1]


def _peaks(distances: Array, best: Indices) -> tuple[Mask, Mask]:
    """Return where inner landmarks (k, m - 2) are peaks, and which sections have several, (k,)."""
    rises = distances[:, 1:] > distances[:, :-1]
    peaks = rises[:, :-1] & ~rises[:, 1:]
    ends = (best == 0) | (best == distances.shape[1] - 1)
    return peaks, ends | (np.count_nonzero(peaks, axis=1) != 1)


def _peak(
    slopes: SplineSlopes, planes: Array, edge: Array, rows: Indices, landmarks: Indices
) -> Array:
    """Climb from landmarks (m,) of sections `rows` to the points farthest from the edge, (m, 2)."""
    points, settled = _climbed(slopes, planes, edge[:, rows], rows, landmarks)
    open_ = np.flatnonzero(~settled)
    if open_.size:
        rows, landmarks = rows[open_], landmarks[open_]
        some = (v.transpose(1, 2, 0) for v in (planes[:, rows], slopes.all(planes[:, rows])))
        section, u = Cubics(slopes.u, *some), slopes.u

        def receding(u: Array) -> tuple[Array, Array]:
            p, d1, d2 = section.at(u)
            r = p - edge[:, rows].T
            return np.sum(r * d1, axis=-1), np.sum(d1 * d1 + r * d2, axis=-1)

        places = falling(receding, u[landmarks - 1], u[landmarks], u[landmarks + 1])
        points[:, open_] = section.at(places)[0].T
    return points.T


def _climbed(
    slopes: SplineSlopes, planes: Array, edge: Array, rows: Indices, landmarks: Indices
) -> tuple[Array, Mask]:
    """Climb from landmarks to the points beside them that are farthest from the edge.

    Parameters
    ----------
    slopes, planes : SplineSlopes and (2, k, n) array
        The sections.
    edge : (2, m) array
        The trailing-edge midpoints of the sections `rows` (m,).
    landmarks : (m,) array of int
        Where to start, farther from the edge than their neighbours.

    Returns
    -------
    points, settled : (2, m), (m,) arrays
        The points, and where they are peaks indeed.
    """
    near = landmarks[:, None] + np.arange(-1, 2)
    away = planes[:, rows[:, None], near] - edge[..., None]
    rates = slopes.around(planes, rows, landmarks)
    after = (away[..., 1] * rates[..., 1]).sum(axis=0) > 0.0
    cell = landmarks - 1 + after
    width = slopes.u[cell + 1] - slopes.u[cell]
    start, end = (np.where(after, away[..., i + 1], away[..., i]) for i in (0, 1))
    slope, last = (np.where(after, rates[..., i + 1], rates[..., i]) * width for i in (0, 1))
    rise, fall = (start * slope).sum(axis=0), (end * last).sum(axis=0)
    a, b, c, d = pieces(start, end, slope, last)
    with np.errstate(all="ignore"):
        s = rise / (rise - fall)
        for _ in range(ITERATIONS):
            here, rate = ((d * s + c) * s + b) * s + a, (3.0 * d * s + 2.0 * c) * s + b
            bending = (rate * rate + here * (6.0 * d * s + 2.0 * c)).sum(axis=0)
            step = (here * rate).sum(axis=0) / bending
            s = s - step
            if not np.abs(step).max(initial=0.0) > SETTLED:
                break
        settled = (np.abs(step) <= SETTLED) & (bending < 0.0) & (s >= 0.0) & (s <= 1.0)
        settled &= (rise >= 0.0) & (fall <= 0.0)
        return ((d * s + c) * s + b) * s + a + edge, settled
