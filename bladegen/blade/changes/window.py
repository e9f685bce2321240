"""Where along the span a perturbation acts: a weight that rises from 0 to 1."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bladegen.definition.blade_definition import Station, united
from bladegen.errors import PerturbationError
from bladegen.support.arguments import amount
from bladegen.support.arrays import Array

__all__ = ["Window"]

RAMP = 33  # span fractions that resolve a window's rise


@dataclass(frozen=True)
class Window:
    """A weight over span: 0 up to `start`, 1 from `end` on, C2 between."""

    start: float = 0.0
    end: float = 0.0

    def __post_init__(self) -> None:
        start, end = (amount(edge, "window", PerturbationError) for edge in (self.start, self.end))
        if not 0.0 <= start <= end <= 1.0:
            raise PerturbationError(
                f"window: got {start:g} to {end:g}, must rise within 0 (root) to 1 (tip)"
            )

    @classmethod
    def beyond_circles(cls, stations: Sequence[Station]) -> "Window":
        """Rise from the last round station to the first lifting one; 1 all over without any."""
        lifting = [not station.airfoil.is_round for station in stations]
        first = lifting.index(True) if True in lifting else len(stations) - 1
        if first == 0:
            return cls()
        return cls(stations[first - 1].eta, stations[first].eta)

    def __call__(self, eta: Array) -> Array:
        """Return the weight at span fractions `eta`."""
        if self.end == self.start:
            return np.where(eta >= self.end, 1.0, 0.0) if self.end > 0 else np.ones_like(eta)
        f = np.clip((eta - self.start) / (self.end - self.start), 0.0, 1.0)
        weight: Array = f**3 * (10.0 - 15.0 * f + 6.0 * f**2)
        return weight

    def with_ramp(self, grid: Array) -> Array:
        """Return a grid united with span fractions that resolve the rise."""
        return united(grid, np.linspace(self.start, self.end, RAMP))
