"""The velocity of a path at its stations, from those of the pieces around them, and over span."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.blade.lofting.combined import segments
from bladegen.support.arrays import Array, Indices, Mask
from bladegen.support.values import brief

__all__ = ["Paces", "blended", "three_point"]

EASED = 0.2  # of a segment
SLOW = 2e-3  # of chord over a whole span; a thickness that changes less stands still: shapes that
# move as fast over it turn the surface by less than 1e-3 deg


def blended(before: Array, after: Array, earlier: Array, further: Array, pace: Array) -> Array:
    """Return one velocity at each of s stations, Akima's with vectors in place of numbers.

    Parameters
    ----------
    before, after : (s - 1, ...) arrays
        With which the segments arrive at their ends, and leave their starts.
    earlier, further : (s - 2, ...) arrays
        With which the segments before arrive, carried on to the ends of their neighbours; with
        which the segments behind leave, carried back to the starts of theirs.
    pace : (s,) array
        See `Paces.pace`.

    Returns
    -------
    (s, ...) array
        In terms of the parameter before the station.

    Notes
    -----
    Akima, J. ACM 17 (1970), equation 1, with squares of the differences, as in weighted
    essentially non-oscillatory schemes (Jiang and Shu, J. Comput. Phys. 126 (1996)): where one
    side runs steadily and the other bends, the velocity is the steady side's.  Beyond the ends
    velocities go on to change as they do beside them.
    """
    s, rest = len(pace), (1,) * (before.ndim - 1)
    pace = pace.reshape(-1, *rest)
    around = np.zeros((4, s, *before.shape[1:]))
    around[1, 1:], around[2, :-1] = before, after * pace[:-1]
    around[0, 2:] = earlier / pace[1:-1]
    around[3, :-2] = further * pace[1:-1] * pace[:-2]
    if s == 2:
        around[1, 0], around[2, 1] = after[0], before[0]
        around[0], around[3] = around[1], around[2]
    else:
        around[1, 0] = 2.0 * around[2, 0] - around[3, 0]
        around[0, 0] = 2.0 * around[1, 0] - around[2, 0]
        around[0, 1] = 2.0 * around[1, 1] - around[2, 1]
        around[2, -1] = 2.0 * around[1, -1] - around[0, -1]
        around[3, -1] = 2.0 * around[2, -1] - around[1, -1]
        around[3, -2] = 2.0 * around[2, -2] - around[1, -2]
    bends = np.sum(np.square(np.diff(around, axis=0)), axis=tuple(range(2, around.ndim)))
    total = bends[0] + bends[2]
    share = np.divide(bends[2], total, out=np.full(s, 0.5), where=total > 0.0).reshape(-1, *rest)
    mean: Array = share * around[1] + (1.0 - share) * around[2]
    return mean


def three_point(apart: Array, values: Array, pace: Array) -> Array:
    """Return slopes (s, m) of values (s, m) at knots this far apart, of parabolas through three.

    As in `blended`, in terms of the parameter before the station.
    """
    steps, pace = apart[:, None], pace[:, None]
    secants = np.diff(values, axis=0) / steps
    if len(secants) == 1:
        return np.concatenate([secants, secants])
    slopes = np.empty_like(values)
    before, after = steps[:-1], steps[1:] / pace[1:-1]
    slopes[1:-1] = before * secants[1:] * pace[1:-1] + after * secants[:-1]
    slopes[1:-1] /= before + after
    slopes[0] = 2.0 * secants[0] - slopes[1]
    slopes[-1] = 2.0 * secants[-1] - slopes[-2] / pace[-2]
    return slopes


@dataclass(frozen=True, eq=False)
class Paces:
    """How a path's parameter runs through its stations, so that the path has no corner over span.

    Where the parameter moves on both sides of a station, at whatever speeds, one velocity over span
    is two velocities over the parameter (`pace`).  Where it stands still on one side, or nothing
    moves there, it is slowed down over the last `EASED` of the segment on the other.

    Parameters
    ----------
    knots : (s,) array
        Parameter at the stations, strictly increasing.
    speeds : (2, s) array
        Of the parameter over span, just before and just after each station, not negative.
    still : (s - 1,) array of bool
        Segments in which nothing moves.
    """

    knots: Array
    speeds: Array
    still: Mask

    __repr__ = brief

    @cached_property
    def _moving(self) -> Mask:
        """Whether something moves just before and just after each station, (2, s)."""
        sides = np.stack([np.insert(self.still, 0, False), np.append(self.still, False)])
        moving: Mask = ~sides & (self.speeds >= SLOW)
        return moving

    @cached_property
    def joint(self) -> Mask:
        """Whether something moves on both sides of a station, (s,)."""
        before, after = self._moving
        joint: Mask = before & after
        return joint

    @cached_property
    def pace(self) -> Array:
        """The speed after each station over that before it; 1 where one is none, (s,)."""
        before, after = self.speeds
        pace: Array = np.divide(after, before, out=np.ones_like(after), where=self.joint)
        return pace

    def __call__(self, q: Array) -> tuple[Indices, Array]:
        """Return the segments that hold parameters (k,), and the fractions of them, (k,)."""
        k = segments(self.knots, q)
        fraction = np.clip((q - self.knots[k]) / (self.knots[k + 1] - self.knots[k]), 0.0, 1.0)
        before, after = self._moving
        late = np.where((after & ~before)[k], _delay(fraction), 0.0)
        early = np.where((before & ~after)[k + 1], _delay(1.0 - fraction), 0.0)
        return k, fraction - late + early


def _delay(way: Array) -> Array:
    """Return how far motion that begins at rest lags behind, `way` from where it begins.

    From 0 to `EASED` the way is a cubic that leaves without speed and arrives at full speed.
    """
    x = np.minimum(way / EASED, 1.0)
    lag: Array = EASED * x * np.square(1.0 - x)
    return lag
