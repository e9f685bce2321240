"""Names that tell a blade's airfoils apart, for formats that find airfoils by name."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from bladegen.definition.blade_definition import Airfoil, Station

__all__ = ["unique_names", "uniquely_named"]


def uniquely_named(stations: Iterable[Station]) -> tuple[Station, ...]:
    """Return stations whose airfoils differ in name if they differ in shape or polars.

    Names stay as they are, and airfoils that are alike keep one name.
    """
    known: dict[str, Airfoil] = {}
    result = []
    for station in stations:
        airfoil, count = station.airfoil, 2
        while airfoil.name in known and not _alike(known[airfoil.name], airfoil):
            airfoil = replace(airfoil, name=f"{station.airfoil.name}-{count}")
            count += 1
        known[airfoil.name] = airfoil
        result.append(Station(station.eta, airfoil))
    return tuple(result)


def unique_names(stations: Iterable[Station]) -> dict[int, tuple[str, Airfoil]]:
    """Return a name of its own for each airfoil of a blade, by the airfoil's `id`.

    For tables and sheets: printable, and no formula.
    """
    named: dict[int, tuple[str, Airfoil]] = {}
    taken: set[str] = set()
    for station in stations:
        airfoil = station.airfoil
        if id(airfoil) in named:
            continue
        printable = "".join(letter if letter.isprintable() else " " for letter in airfoil.name)
        plain = " ".join(printable.split()).lstrip("=+-@#") or "airfoil"  # no spreadsheet formula
        name, count = plain, 1
        while name in taken:
            count += 1
            name = f"{plain} ({count})"
        taken.add(name)
        named[id(airfoil)] = name, airfoil
    return named


def _alike(one: Airfoil, other: Airfoil) -> bool:
    return (
        one.relative_thickness == other.relative_thickness
        and np.array_equal(one.coordinates, other.coordinates)
        and one.polars is other.polars
    )
