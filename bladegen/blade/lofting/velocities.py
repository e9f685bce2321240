"""The velocity of a path at its stations, from those of the pieces around them."""

from dataclasses import dataclass

import numpy as np

from bladegen.blade.lofting.combined import segments
from bladegen.support.arrays import Array, Indices, Mask
from bladegen.support.values import brief

__all__ = ["Easing", "blended", "three_point"]

EASED = 0.2  # of a segment
SLOW = 2e-3  # of chord over a whole span; a thickness that changes less stands still: shapes that
# move as fast over it turn the surface by less than 1e-3 deg


def blended(lengths: Array, before: Array, after: Array, earlier: Array, further: Array) -> Array:
    """Return one velocity at each of s stations, Akima's with vectors in place of numbers.

    Parameters
    ----------
    lengths : (s - 1,) array
        Of the segments.
    before, after : (s - 1, ...) arrays
        With which the segments arrive at their ends, and leave their starts.
    earlier, further : (s - 2, ...) arrays
        With which the segments before arrive, carried on to the ends of their neighbours; with
        which the segments behind leave, carried back to the starts of theirs.

    Notes
    -----
    Akima, J. ACM 17 (1970), equation 1, with squares of the differences, as in weighted
    essentially non-oscillatory schemes (Jiang and Shu, J. Comput. Phys. 126 (1996)): where one
    side runs steadily and the other bends, the velocity is the steady side's.  Beyond the ends
    velocities go on to change as they do beside them.
    """
    s = len(lengths) + 1
    around = np.zeros((4, s, *before.shape[1:]))
    around[1, 1:], around[2, :-1] = before, after
    around[0, 2:], around[3, :-2] = earlier, further
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
    share = np.divide(bends[2], total, out=np.full(s, 0.5), where=total > 0.0)
    share = share.reshape(-1, *(1,) * (before.ndim - 1))
    mean: Array = share * around[1] + (1.0 - share) * around[2]
    return mean


def three_point(apart: Array, values: Array) -> Array:
    """Return slopes (s, ...) at knots this far apart: of parabolas through three neighbours."""
    steps = apart.reshape(-1, *(1,) * (values.ndim - 1))
    secants = np.diff(values, axis=0) / steps
    if len(secants) == 1:
        return np.concatenate([secants, secants])
    slopes = np.empty_like(values)
    slopes[1:-1] = (steps[:-1] * secants[1:] + steps[1:] * secants[:-1]) / (steps[:-1] + steps[1:])
    slopes[0] = 2.0 * secants[0] - slopes[1]
    slopes[-1] = 2.0 * secants[-1] - slopes[-2]
    return slopes


@dataclass(frozen=True, eq=False)
class Easing:
    """A path's parameter as fractions of its segments, slowed down beside some stations.

    A parameter that is faster over span on one side of a station than on the other would give
    the path a corner there: it is brought to the slower speed over the last `EASED` of the
    segment.

    Parameters
    ----------
    knots : (s,) array
        Parameter at the stations, strictly increasing.
    leaving, arriving : (s - 1,) arrays
        Shares of its speed that the parameter has at the start and the end of the segments.
    """

    knots: Array
    leaving: Array
    arriving: Array

    __repr__ = brief

    @classmethod
    def of(cls, knots: Array, speeds: Array | None, still: Mask) -> "Easing":
        """Return that for the parameter's speeds over span, before and after stations, (2, s).

        Nothing moves in the segments that are `still`, (s - 1,), and slow speeds count as none.
        """
        given = np.ones((2, len(knots))) if speeds is None else speeds
        sides = np.stack([np.insert(still, 0, False), np.append(still, False)])
        moving = np.where(sides | (given < SLOW), 0.0, given)
        slower = moving.min(axis=0)
        shares = np.divide(slower, moving, out=np.ones_like(moving), where=moving > slower)
        return cls(knots, shares[1, :-1], shares[0, 1:])

    def __call__(self, q: Array) -> tuple[Indices, Array]:
        """Return the segments that hold parameters (k,), and the fractions of them, (k,)."""
        k = segments(self.knots, q)
        fraction = np.clip((q - self.knots[k]) / (self.knots[k + 1] - self.knots[k]), 0.0, 1.0)
        late = _delay(fraction, self.leaving[k])
        early = _delay(1.0 - fraction, self.arriving[k])
        return k, fraction - late + early


def _delay(way: Array, share: Array) -> Array:
    """Return how far eased motion lags behind, `way` from where it starts with a share of speed.

    From 0 to `EASED` the way is a cubic that leaves with this share and arrives at full speed.
    """
    x = np.minimum(way / EASED, 1.0)
    lag: Array = EASED * (1.0 - share) * x * np.square(1.0 - x)
    return lag
