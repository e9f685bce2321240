"""Polars between the airfoils of a blade, and polars that reach all the way round.

Between two stations the weight of the outer airfoil follows the relative thickness where that
differs between both, as their shapes do, and the span where it does not.  A blend bears the mark
of what it is made of: `polars.BORROWED` of a baseline's, an estimate's own; `of_their_own` tells
those that are neither.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from bladegen.airfoils.polars import Polar, blended
from bladegen.airfoils.viterna import STALL, extended
from bladegen.definition.blade_definition import Airfoil, BladeDefinition
from bladegen.support.arrays import Array

__all__ = ["Between", "between", "completed", "of_their_own", "without_polars"]

BY_THICKNESS = 1e-3  # of the chord; polars are blended by thickness where it differs by more
WHOLE = np.radians(1.0)  # tables that end nearer to half a turn than this are drawn out to it
ENDS = (0.0, 1.0)


@dataclass(frozen=True)
class Between:
    """Where a place along the span stands between two stations.

    Parameters
    ----------
    one, other : Airfoil
        Of the inner and the outer station; the same where the place is a station.
    weight : float
        0 for the inner, 1 for the outer.
    """

    one: Airfoil
    other: Airfoil
    weight: float

    @property
    def near(self) -> Airfoil:
        """The airfoil that weighs more."""
        return self.one if self.weight < 0.5 else self.other

    @property
    def centre(self) -> float | None:
        """What polars there are about, of the chord from the leading edge; None if not known."""
        inner, outer = self.one.aerodynamic_center, self.other.aerodynamic_center
        if inner is None or outer is None or self.weight in ENDS:
            return self.near.aerodynamic_center
        return (1.0 - self.weight) * inner + self.weight * outer

    @property
    def said(self) -> str:
        """The airfoils by name, and how much of which."""
        if self.one is self.other or self.weight in ENDS:
            return self.near.name
        return f"{self.one.name} and {self.other.name}, {100 * self.weight:.0f} % of the latter"

    def polars(self, mark: str = "") -> tuple[Polar, ...]:
        """Return the polars there; none if an airfoil has none.

        Parameters
        ----------
        mark : str
            How their source begins; if not given, an airfoil's own stay as they are, and a
            blend is marked as the airfoils' are.
        """
        own, marked = self.near.polars, f"{mark}: {self.said}"
        if self.weight in ENDS or self.one is self.other:
            return tuple(replace(polar, source=marked) for polar in own) if mark else own
        if not (self.one.polars and self.other.polars):
            return ()
        source = marked if mark else self._source()
        return blended(self.one.polars, self.other.polars, self.weight, source)

    def _source(self) -> str:
        """Return the source of a blend: of the airfoils' own what speaks against it, if any."""
        inner, outer = self.one.polars[0], self.other.polars[0]
        if inner.source == outer.source and inner.source:
            return f"{inner.source}; between {self.said}"
        marked = [p for p in (inner, outer) if p.is_borrowed or p.is_estimate]
        first = min(marked, key=lambda p: not p.is_borrowed).source if marked else "blended"
        return f"{first}; between {self.said}"


def between(definition: BladeDefinition, eta: float) -> Between:
    """Return where a span fraction stands between the stations of a blade."""
    stations = definition.stations
    after = max(1, int(np.searchsorted([station.eta for station in stations[:-1]], eta)))
    one, other = stations[after - 1], stations[after]
    weight = float(np.clip((eta - one.eta) / (other.eta - one.eta), 0.0, 1.0))
    rthick = definition.relative_thickness
    if rthick is not None and 0.0 < weight < 1.0:
        ends, here = rthick(np.array([one.eta, other.eta])), float(rthick(eta))
        if abs(ends[1] - ends[0]) > BY_THICKNESS:
            weight = float(np.clip((here - ends[0]) / (ends[1] - ends[0]), 0.0, 1.0))
    return Between(one.airfoil, other.airfoil, weight)


def without_polars(definition: BladeDefinition) -> list[str]:
    """Return the names of a blade's airfoils that have no polars, sorted."""
    return sorted({s.airfoil.name for s in definition.stations if not s.airfoil.polars})


def of_their_own(polars: Sequence[Polar]) -> bool:
    """Tell whether polars are an airfoil's own, neither estimated nor a baseline's."""
    return bool(polars) and not (polars[0].is_borrowed or polars[0].is_estimate)


def completed(polar: Polar) -> Polar:
    """Return a polar from -180 to 180 degrees, as AeroDyn and HAWC2 ask for.

    One that runs from stall to stall is extended (`viterna.extended`); others keep their end
    values.  What was added is told in the source.
    """
    first, last = float(polar.alpha[0]), float(polar.alpha[-1])
    missing = max(first + np.pi, np.pi - last)
    if missing == 0.0:
        return polar
    parts = polar.cl, polar.cd, polar.cm
    if missing > WHOLE and -np.pi / 2 < first < -STALL and STALL < last < np.pi / 2:
        alpha, cl, cd, cm = extended(polar.alpha, *parts)
        return _with(polar, (alpha, cl, cd, cm), "Viterna")
    grid = polar.alpha
    for end in (-np.pi, np.pi):
        if not np.any(np.isclose(grid, end, rtol=0.0, atol=1e-12)):
            grid = np.union1d(grid, [end])
    held = np.clip(grid, first, last)
    alpha = np.clip(grid, -np.pi, np.pi)
    cl, cd, cm = polar.at(held)
    return _with(polar, (alpha, cl, cd, cm), "end values" if missing > WHOLE else "")


def _with(polar: Polar, table: tuple[Array, Array, Array, Array], beyond: str) -> Polar:
    """Return a polar with another table, which says what it is beyond the given angles."""
    alpha, cl, cd, cm = table
    source = polar.source
    if beyond:
        given = f"{np.degrees(polar.alpha[0]):.4g} to {np.degrees(polar.alpha[-1]):.4g} deg"
        source = f"{source}; {beyond} beyond {given}".lstrip("; ")
    return replace(polar, alpha=alpha, cl=cl, cd=cd, cm=cm, source=source)
