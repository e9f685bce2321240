"""From landmarks to the leading edges of sections: the points farthest from the trailing edge.

Between two landmarks a section is a cubic, and its squared distance from the edge has one peak
there: Newton's method climbs to it from where its slopes at either end say it is.  Where a section
is nearly round about its edge, the mean of points nearly as far leads instead (`fronts`).
"""

from typing import NamedTuple

import numpy as np

from bladegen.airfoils.fronts import ROUND
from bladegen.airfoils.slopes import SplineSlopes
from bladegen.curves.cubics import Cubics, pieces
from bladegen.curves.roots import falling
from bladegen.support.arrays import Array, Indices, Mask

__all__ = ["Noses", "farthest", "other_noses"]

ITERATIONS = 8  # three are usual
SETTLED = 1e-7  # of the way between landmarks; the step after is a thousand squares of it
SAME_NOSE = 2  # landmarks; a nose keeps its landmark, or one beside it, under a stretch
FARTHER = 1.25  # times `ROUND`; a front that falls off by more under a stretch is not round


class Noses(NamedTuple):
    """The leading edges of sections.

    Parameters
    ----------
    points : (k, 2) array
        The points.
    shares : (k,) array
        Of the mean of many in them: 0 where the farthest leads.
    wide : (k,) array of bool
        Where a little change of the section may make a share.
    low, high : (k,) arrays of int
        The landmarks between which distances matter.
    """

    points: Array
    shares: Array
    wide: Mask
    low: Indices
    high: Indices

    def take(self, rows: Indices) -> "Noses":
        """Return those of some of the sections."""
        points, shares, wide, low, high = self
        return Noses(points[rows], shares[rows], wide[rows], low[rows], high[rows])


def farthest(slopes: SplineSlopes, planes: Array, edge: Array) -> Noses:
    """Return the noses of sections.

    Parameters
    ----------
    slopes, planes : SplineSlopes and (2, k, n) array
        The sections; noses are in their front half.
    edge : (2, k) array
        The trailing-edge midpoints.
    """
    front = slopes.front
    squares = front.squares(planes, edge)
    best, rows = np.argmax(squares, axis=1), np.arange(len(squares))
    points, places = _peak(slopes, planes, edge, rows, best + front.ahead.start)
    top = ((points.T - edge) ** 2).sum(axis=0)
    led = front.led(planes, edge, squares, top, places)
    at = np.flatnonzero(led.shares)
    points[at] += led.shares[at, None] * (edge[:, at].T + led.means[at] - points[at])
    return Noses(points, led.shares, led.wide, *led.reach)


def other_noses(
    slopes: SplineSlopes, planes: Array, edge: Array, A: Array, landmarks: Indices
) -> Mask:
    """Tell which sections (2, k, n) may have round or other noses under maps (k, 2, 2).

    `edge` (2, k) are the trailing-edge midpoints, `landmarks` (k,) those nearest to the noses.
    """
    squares = slopes.front.squares(planes, edge, A)
    best, start = np.argmax(squares, axis=1), slopes.front.ahead.start
    others = np.abs(best + start - landmarks) > SAME_NOSE
    rows, i = np.arange(len(best)), np.clip(best, 1, squares.shape[1] - 2)
    a, b, c = (squares[rows, i + k] for k in (-1, 0, 1))
    rise, bend = a - c, a - 2.0 * b + c  # the top of a parabola through three landmarks
    h = np.divide(0.5 * rise, bend, out=np.zeros_like(bend), where=bend < 0.0)
    u, i = slopes.u, i + start
    places = u[i] + 0.5 * h * (u[i + 1] - u[i - 1])
    others |= slopes.front.rivalled(squares, b - 0.25 * rise * h, places, FARTHER * ROUND)
    return np.asarray(others)


def _peak(
    slopes: SplineSlopes, planes: Array, edge: Array, rows: Indices, landmarks: Indices
) -> tuple[Array, Array]:
    """Climb from landmarks (m,) of sections `rows` to the points farthest from the edge.

    Returned are points (m, 2), and their places u.
    """
    points, places, settled = _climbed(slopes, planes, edge[:, rows], rows, landmarks)
    open_ = np.flatnonzero(~settled)
    if open_.size:
        rows, landmarks = rows[open_], landmarks[open_]
        some = (v.transpose(1, 2, 0) for v in (planes[:, rows], slopes.all(planes[:, rows])))
        section, u = Cubics(slopes.u, *some), slopes.u

        def receding(u: Array) -> tuple[Array, Array]:
            p, d1, d2 = section.at(u)
            r = p - edge[:, rows].T
            return np.sum(r * d1, axis=-1), np.sum(d1 * d1 + r * d2, axis=-1)

        found = falling(receding, u[landmarks - 1], u[landmarks], u[landmarks + 1])
        points[:, open_], places[open_] = section.at(found)[0].T, found
    return points.T, places


def _climbed(
    slopes: SplineSlopes, planes: Array, edge: Array, rows: Indices, landmarks: Indices
) -> tuple[Array, Array, Mask]:
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
    points, places, settled : (2, m), (m,), (m,) arrays
        The points, their places u, and where they are peaks indeed.
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
        ended = np.zeros(len(s), dtype=bool)
        for _ in range(ITERATIONS):
            here, rate = ((d * s + c) * s + b) * s + a, (3.0 * d * s + 2.0 * c) * s + b
            bending = (rate * rate + here * (6.0 * d * s + 2.0 * c)).sum(axis=0)
            step = np.where(ended, 0.0, (here * rate).sum(axis=0) / bending)
            s = s - step
            ended |= np.abs(step) <= SETTLED  # each section by itself
            if ended.all():
                break
        settled = (np.abs(step) <= SETTLED) & (bending < 0.0) & (s >= 0.0) & (s <= 1.0)
        settled &= (rise >= 0.0) & (fall <= 0.0)
        points = ((d * s + c) * s + b) * s + a + edge
        return points, slopes.u[cell] + s * width, settled
