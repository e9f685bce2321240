"""How far the points of a section's front half are from its trailing edge, and which are as far.

Where a section is nearly round about its trailing edge, many points are nearly as far as the
farthest, and which of them it is tells little: it jumps as the section changes.  Their mean does
not,

    mean p = sum_i w_i x_i^2 p_i / MASS,    x_i = max(q_i / l - 1, 0),    sum_i w_i x_i^2 = MASS,

with the squared distances q_i of landmarks p_i, their shares w_i of u, and l by the last equation.
So it is with the distance, sqrt(l (1 + 7/6 mean x)): the factor is that of parabolas.  Both are C1
in the landmarks.  The mean leads where other points rival the farthest one, at u, by

    Y = sum_i w_i y_i^2 d_i^2 / (d_i^2 + NEAR^2)^(3/2),    d_i = u_i - u,
    y_i = max(1 - (1 - q_i / q + DIGITS) / (ROUND d_i^2 + DIGITS), 0).

Where Y is 0, as on most airfoils, the leading edge is the farthest point; from `LED` on, as on a
circle, it is the mean.  Rivals much nearer than `NEAR` count for little: they are one nose, which
is flat there for less than the mean would move the leading edge.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from bladegen.support.arrays import Array, Indices, Mask

__all__ = ["Front", "Led"]

MASS = 5e-8  # of u; points of a circle count up to 9e-4 of its diameter behind the farthest
PARABOLA = 7.0 / 6.0  # of the mean x is the largest one
ROUND = 6.0  # of 1 / u^2, by which squared distances fall off; on a circle it is 9.9 to 8
DIGITS = 1e-7  # of squared distances; what they differ by where they are taken to be the same
NEAR = 1e-3  # of u
SAME = 1e-13  # of squared distances; rounding
LED = 0.07  # of Y; two noses that are as far have some 0.3, and a third of it at a distance `NEAR`
ALMOST = 1.2  # times `ROUND`; a front that falls off by more is not made round by a little
FIRST = 4e-3  # by which squared distances differ in a first guess of l
POWER = 0.4  # of the mass is nearly linear in l: that of parabolas is
STEPS = 12  # of Newton's method for l; three are usual
LEVEL = 1e-9  # of l; the step after is a thousand squares of it
LEAST = 1e-3  # of `FIRST`, which some point is farther at least than those that count


@dataclass(frozen=True, eq=False)
class Front:
    """The landmarks (n,) among which noses are sought: those of the front half."""

    u: Array

    @property
    def ahead(self) -> slice:
        """The landmarks in front."""
        quarter = len(self.u) // 4
        return slice(quarter, len(self.u) - quarter)

    @cached_property
    def shares(self) -> Array:
        """These landmarks' shares of u, (m,)."""
        around = np.arange(len(self.u))[self.ahead]
        result: Array = 0.5 * (self.u[around + 1] - self.u[around - 1])
        return result

    def squares(self, planes: Array, edge: Array, A: Array | None = None) -> Array:
        """Return squared distances (k, m) of sections (2, k, n) from edges (2, k).

        Under the maps A (k, 2, 2), if any.
        """
        away = planes[..., self.ahead] - edge[..., None]
        if A is not None:
            away = (A.mT @ away.swapaxes(0, 1)).swapaxes(0, 1)
        away *= away
        away[0] += away[1]
        result: Array = away[0]
        return result

    def rivals(self, squares: Array, top: Array, u: Array) -> Array:
        """Return what y of landmarks (k, m) is where noses lie at u (k,), `top` squared away."""
        away = self.u[self.ahead] - u[:, None]
        away *= away
        away *= ROUND
        away += DIGITS
        gaps = squares / -top[:, None]
        gaps += 1.0 + DIGITS
        gaps /= away
        result: Array = np.maximum(1.0 - gaps, 0.0, out=gaps)
        return result

    def rivalled(self, squares: Array, top: Array, u: Array, fall: float) -> Mask:
        """Tell where squared distances (k, m) fall off from places u (k,) slower than `fall`."""
        place = u - 0.5
        limits = np.stack([np.full_like(place, fall), -2.0 * fall * place], axis=1) @ self._powers
        limits += squares * (1.0 / top)[:, None]
        most = 1.0 + SAME - fall * place * place
        return np.asarray((limits > most[:, None]).any(axis=1))

    @cached_property
    def _powers(self) -> Array:
        """The landmarks' u squared, and u, about the middle, (2, m)."""
        u = self.u[self.ahead] - 0.5
        return np.stack([u * u, u])

    def led(self, planes: Array, edge: Array, squares: Array, top: Array, u: Array) -> "Led":
        """Return by what leading edges of sections (2, k, n) are led, from edges (2, k) on.

        The farthest points lie at places u (k,), `top` (k,) squared away.
        """
        best = np.argmax(squares, axis=1)
        shares, means = np.zeros(len(top)), np.zeros((len(top), 2))
        low = high = best + self.ahead.start
        wide = self.rivalled(squares, top, u, ALMOST * ROUND)
        rows = np.flatnonzero(wide)
        if not rows.size:
            return Led(shares, means, wide, np.stack([low, high]))
        y = self.rivals(squares[rows], top[rows], u[rows])
        apart = (self.u[self.ahead] - u[rows, None]) ** 2
        y *= y * self.shares * apart / (apart + NEAR * NEAR) ** 1.5
        f = np.minimum(y.sum(axis=1) / LED, 1.0)
        shares[rows] = f * f * (3.0 - 2.0 * f)
        rows = rows[f > 0.0]
        weights, far = self._means(squares[rows], squares[rows, best[rows]])
        counted, low, high = weights > 0.0, low.copy(), high.copy()
        low[rows] = self.ahead.start + np.argmax(counted, axis=1)
        high[rows] = self.ahead.stop - 1 - np.argmax(counted[:, ::-1], axis=1)
        away = planes[:, rows, self.ahead] - edge[:, rows, None]
        mean = (weights * away).sum(axis=-1)
        means[rows] = (mean * (far / np.hypot(mean[0], mean[1]))).T
        return Led(shares, means, wide, np.stack([low, high]))

    def _means(self, squares: Array, top: Array) -> tuple[Array, Array]:
        """Return weights (k, m) of landmarks, and mean distances (k,)."""
        shares = self.shares
        x = np.maximum(squares / (top / (1.0 + FIRST))[:, None] - 1.0, 0.0)
        mass = (x * x * shares).sum(axis=1)
        level = top / (1.0 + FIRST * (MASS / mass) ** POWER)
        rows = np.arange(len(level))
        for _ in range(STEPS):  # sections do not know of each other: each ends by itself
            x = np.maximum(squares[rows] / level[rows, None] - 1.0, 0.0)
            weights = x * shares
            first, mass = weights.sum(axis=1), (weights * x).sum(axis=1)
            step = mass * (1.0 - (MASS / mass) ** POWER) / (2.0 * POWER * (mass + first))
            level[rows] = np.minimum(level[rows] * (1.0 + step), top[rows] / (1.0 + LEAST * FIRST))
            rows = rows[np.abs(step) > LEVEL]
            if not rows.size:
                break
        x = np.maximum(squares / level[:, None] - 1.0, 0.0)
        weights = x * x * shares
        weights /= weights.sum(axis=1)[:, None]
        far = np.sqrt(level * (1.0 + PARABOLA * (weights * x).sum(axis=1)))
        return weights, far


class Led(NamedTuple):
    """By what leading edges are led.

    Parameters
    ----------
    shares : (k,) array
        Of the mean of many points in them: 0 where the farthest leads.
    means : (k, 2) array
        The means, from the edge on.
    wide : (k,) array of bool
        Where a little change of the section may make a share.
    reach : (2, k) array of int
        The landmarks between which distances matter.
    """

    shares: Array
    means: Array
    wide: Mask
    reach: Indices
