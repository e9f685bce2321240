"""What looks odd in a definition once its airfoils are measured."""

import numpy as np

from bladegen.airfoils.landmarks import Contour
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import Finding
from bladegen.support.arrays import Array

__all__ = ["disagreeing", "opened"]

DISAGREEMENT = 0.01  # of the thickness; airfoil and distribution differing by more is a finding


def opened(definition: BladeDefinition, contours: tuple[Contour, ...]) -> tuple[Finding, ...]:
    """Say which airfoils had a blunt base that was closed to one point."""
    heights = {
        station.airfoil.name: contour.opened
        for station, contour in zip(definition.stations, contours, strict=True)
    }
    return tuple(
        Finding(
            f"airfoil {name}",
            f"a blunt base of {height:.4f} chord is closed to one point; taken as an open "
            "trailing edge",
        )
        for name, height in heights.items()
        if height
    )


def disagreeing(definition: BladeDefinition, u: Array, airfoils: Array) -> tuple[Finding, ...]:
    """Say where an airfoil's own thickness is not that of the distribution at its station.

    `airfoils` (s, n, 2) are the stations' landmarks at parameters `u` (n,).
    """
    if definition.relative_thickness is None:
        return ()
    eta = np.array([station.eta for station in definition.stations])
    own = SectionSplines(u).fit(airfoils).relative_thickness
    wanted = definition.relative_thickness(eta)
    return tuple(
        Finding(
            f"station at eta = {eta[k]:.4f}",
            f"{definition.stations[k].airfoil.name} is {own[k]:.4g} thick, the distribution says "
            f"{wanted[k]:.4g}; the distribution wins",
        )
        for k in np.flatnonzero(np.abs(own - wanted) > DISAGREEMENT * wanted)
    )
