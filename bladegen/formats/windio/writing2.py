"""windIO 2: angles in degrees, the distance from leading edge to axis in metres."""

from dataclasses import replace
from functools import partial

import numpy as np

from bladegen.definition.blade_definition import (
    Airfoil,
    BladeDefinition,
    Distribution,
    Rotor,
    Station,
    united,
)
from bladegen.definition.thickness import ruled
from bladegen.formats.common.redefinition import missed, sampled
from bladegen.formats.windio import writing as windio
from bladegen.formats.windio.writing import Document, Note

__all__ = ["blade", "document", "polars", "write"]

DEGREES = 180.0 / np.pi
DIGITS = 12  # of angles in degrees, so that those of a file in degrees come back
NOT_HELD = frozenset({"b5"})  # of AeroDyn's constants for unsteady aerodynamics


def document(definition: BladeDefinition, note: Note) -> Document:
    """Return a turbine document that holds what a definition says."""
    definition = windio.within(definition, note)
    stations = windio.uniquely_named(definition.stations)
    rotor = definition.rotor
    components: Document = {"blade": blade(replace(definition, stations=stations), note)}
    hub = _hub(rotor, note)
    if hub:
        components["hub"] = hub
    if rotor.tilt is not None:
        components["drivetrain"] = {"outer_shape": {"uptilt": DEGREES * rotor.tilt}}
    entries = windio.airfoil_entries(stations, "rthick", polars)
    return windio.turbine(definition, "2.0", components, entries)


def _hub(rotor: Rotor, note: Note) -> Document:
    """Return the hub, of which windIO 2 demands all three figures or none."""
    if rotor.hub_radius is None:
        if rotor.cone is not None:
            note("hub", "its diameter is not known, so that the cone angle has no place; left out")
        return {}
    for name, value in (("cone_angle", rotor.cone), ("cd", rotor.hub_drag)):
        if value is None:
            note(f"hub.{name}", "windIO 2 must have one and none is known; 0 is written")
    return {
        "diameter": 2.0 * rotor.hub_radius,
        "cone_angle": DEGREES * (rotor.cone or 0.0),
        "cd": rotor.hub_drag or 0.0,
    }


def blade(definition: BladeDefinition, note: Note) -> Document:
    """Return the reference axis and the outer shape."""
    if definition.relative_thickness is None:
        note("rthick", "windIO 2 must have one; that of the airfoils, PCHIP over span, is written")
    thickness = ruled(definition).relative_thickness
    assert thickness is not None  # it rules
    shape: Document = {
        "airfoils": [_scheduled(station) for station in definition.stations],
        "chord": windio.pairs(definition.chord),
        "twist": windio.pairs(definition.twist, DEGREES),
        "section_offset_y": windio.pairs(_offset(definition, note)),
        "rthick": windio.pairs(windio.thickness(thickness, note)),
    }
    if definition.section_offset_x is not None:
        shape["section_offset_x"] = windio.pairs(definition.section_offset_x)
    return {"reference_axis": windio.axis(definition), "outer_shape": shape}


def polars(airfoil: Airfoil) -> list[Document]:
    """Return an airfoil's polars, those of one configuration together."""
    sets: dict[tuple[str, str], list[Document]] = {}
    for polar in airfoil.polars:
        row: Document = {"re": polar.reynolds or 0.0}
        for key in ("cl", "cd", "cm"):
            row[key] = windio.curve(np.degrees(polar.alpha).round(DIGITS), getattr(polar, key))
        row |= {name: value for name, value in polar.parameters if name not in NOT_HELD}
        sets.setdefault((polar.configuration, polar.source), []).append(row)
    return [
        {"configuration": name, **({"description": source} if source else {}), "re_sets": rows}
        for (name, source), rows in sets.items()
    ]


def _scheduled(station: Station) -> Document:
    """Return a station's entry in the schedule, with the polars that hold there."""
    entry: Document = {"name": station.airfoil.name, "spanwise_position": station.eta}
    if station.airfoil.polars:
        first = station.airfoil.polars[0].configuration
        entry |= {"configuration": [first], "weight": [1.0]}
    return entry


def _offset(definition: BladeDefinition, note: Note) -> Distribution:
    if definition.section_offset_y is not None:
        return definition.section_offset_y
    assert definition.pitch_axis is not None  # a definition has one of both
    grid = united(definition.pitch_axis.grid, definition.chord.grid)
    made = sampled(definition.offset_y, grid, windio.OFFSET)
    off = missed(made, definition.offset_y)
    note(
        "section_offset_y",
        f"pitch axis times chord at {len(made.grid)} points, within {off:.1g} m of the product",
    )
    return made


write = partial(windio.write, version="2", document=document)
