"""The parameter of a path as a function of span: shape follows thickness where it is given.

It increases from station to station: as relative thickness changes, or as span where two
stations are equally thick.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.blade.lofting.combined import segments
from bladegen.definition.blade_definition import Distribution
from bladegen.support.arrays import Array, Mask
from bladegen.support.values import brief

__all__ = ["Parameter"]

EQUAL_THICKNESS = 1e-3  # of chord; neighbours closer than this are told apart by span instead
STEEP = 0.05  # of chord over a whole span; nearer neighbours follow thickness too where it
BESIDE = 1e-9  # of a segment; where slopes beside a station are taken
RIPPLE = 5e-5  # changes faster than this, and by more than published curves ripple


@dataclass(frozen=True, eq=False)
class Parameter:
    """The parameter q of a path as a function of span: thickness where given, else span.

    Parameters
    ----------
    stations : (s,) array
        Span fractions of the stations.
    relative_thickness : Distribution, optional
        Where neighbouring stations differ in it, q moves as it does between them.
    """

    stations: Array
    relative_thickness: Distribution | None = None

    __repr__ = brief

    @cached_property
    def _ends(self) -> tuple[Array, Mask]:
        """Thickness at the stations, and which segments follow it."""
        if self.relative_thickness is None:
            return self.stations, np.zeros(len(self.stations) - 1, dtype=bool)
        thickness = self.relative_thickness(self.stations)
        steps = np.abs(np.diff(thickness))
        steep = (steps > RIPPLE) & (steps > STEEP * np.diff(self.stations))
        return thickness, (steps > EQUAL_THICKNESS) | steep

    @cached_property
    def thickness(self) -> Array | None:
        """The relative thickness at the stations, (s,), if there is one."""
        return None if self.relative_thickness is None else self._ends[0]

    @cached_property
    def speeds(self) -> Array:
        """dq / d eta just before and just after each station, (2, s)."""
        thickness, follows = self._ends
        speeds = np.ones((2, len(follows)))
        if self.relative_thickness is not None:
            inside = BESIDE * np.diff(self.stations)
            beside = np.stack([self.stations[:-1] + inside, self.stations[1:] - inside])
            slopes = self.relative_thickness(beside, nu=1) * np.sign(np.diff(thickness))
            speeds = np.where(follows, np.maximum(slopes, 0.0), 1.0)
        before, after = np.insert(speeds[1], 0, speeds[0, 0]), np.append(speeds[0], speeds[1, -1])
        return np.stack([before, after])

    @cached_property
    def knots(self) -> Array:
        """The values of q at the stations, strictly increasing, (s,)."""
        thickness, follows = self._ends
        steps = np.where(follows, np.abs(np.diff(thickness)), np.diff(self.stations))
        return np.concatenate([[0.0], np.cumsum(steps)])

    def __call__(self, eta: Array) -> Array:
        """Return q at span fractions `eta`; constant beyond the first and last station."""
        thickness, follows = self._ends
        k = segments(self.stations, eta)
        start, end = self.stations[k], self.stations[k + 1]
        fraction = (eta - start) / (end - start)
        if self.relative_thickness is not None:
            drop = np.where(follows[k], thickness[k + 1] - thickness[k], 1.0)
            by_thickness = (self.relative_thickness(eta) - thickness[k]) / drop
            within = (eta > start) & (eta < end)
            fraction = np.where(follows[k] & within, by_thickness, fraction)
        fraction = np.clip(fraction, 0.0, 1.0)
        return self.knots[k] + fraction * (self.knots[k + 1] - self.knots[k])
