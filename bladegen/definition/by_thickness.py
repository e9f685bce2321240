"""Airfoils placed where a thickness distribution meets their own, for files that place none."""

from collections.abc import Sequence

import numpy as np

from bladegen.definition.blade_definition import THICKNESS_RIPPLE, Airfoil, Station
from bladegen.definition.distribution import Distribution
from bladegen.errors import DefinitionError
from bladegen.support.arrays import Array

__all__ = ["stations_by_thickness"]

AT_END = 1e-6  # of the span: a curve that ends level meets its end value as much too early


def stations_by_thickness(
    airfoils: Sequence[tuple[float, Airfoil]], relative_thickness: Distribution
) -> tuple[Station, ...]:
    """Place airfoils where the thickness distribution crosses their own thickness.

    Parameters
    ----------
    airfoils : sequence of (thickness, Airfoil)
        Each airfoil with its own relative thickness.
    relative_thickness : Distribution
        Thickness over span, falling from root to tip up to small ripples.

    Returns
    -------
    tuple of Station
        From thick to thin; the thickest and the thinnest hold to the ends of the blade.

    Raises
    ------
    DefinitionError
        If an airfoil's thickness is not crossed by the distribution.
    """
    grid = np.unique(np.concatenate([relative_thickness.grid, np.linspace(0.0, 1.0, 2001)]))
    falling = np.minimum.accumulate(relative_thickness(grid))
    ordered = sorted(airfoils, key=lambda pair: -pair[0])
    stations = []
    for thickness, airfoil in ordered:
        level = float(np.clip(thickness, falling[-1], falling[0]))
        if abs(level - thickness) > THICKNESS_RIPPLE:
            raise DefinitionError(
                f"airfoil {airfoil.name!r}: relative thickness {thickness:g} is not met by the "
                f"distribution, which runs from {falling[0]:g} to {falling[-1]:g}"
            )
        first = int(np.argmax(falling <= level))
        eta = _crossing(relative_thickness, grid, first, level)
        if min(eta, 1.0 - eta) < AT_END:
            eta = float(round(eta))
        stations.append(Station(eta, airfoil))
    if stations[0].eta > 0:
        stations.insert(0, Station(0.0, stations[0].airfoil))
    if stations[-1].eta < 1:
        stations.append(Station(1.0, stations[-1].airfoil))
    return tuple(stations)


def _crossing(quantity: Distribution, grid: Array, first: int, level: float) -> float:
    """Bisect for the place in (grid[first - 1], grid[first]] where `quantity` meets `level`."""
    if first == 0:
        return float(grid[0])
    low, high = float(grid[first - 1]), float(grid[first])
    for _ in range(60):  # halves 5e-4 to below the spacing of doubles
        middle = 0.5 * (low + high)
        low, high = (middle, high) if quantity(middle) > level else (low, middle)
    return high
