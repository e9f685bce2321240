"""windIO 2, read and written: angles in degrees, leading edge to axis in metres."""

import math
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
from bladegen.formats.airfoils.contours import thickness
from bladegen.formats.airfoils.unique_names import uniquely_named
from bladegen.formats.common.document import FRACTION, Node, Range
from bladegen.formats.common.redefinition import missed, sampled
from bladegen.formats.windio import reading, turbine_facts, writing
from bladegen.formats.windio.reading import Entry, Layout
from bladegen.formats.windio.structure import reading2, writing2
from bladegen.formats.windio.writing import Document, Note

__all__ = ["LAYOUT", "blade", "document", "polars", "read", "recognises", "write"]

DEGREES = 180.0 / np.pi
MEASURED = 6  # digits of a thickness that coordinates give
DIGITS = 12  # of angles in degrees, so that those of a file in degrees come back
NOT_HELD = frozenset({"b5"})  # of AeroDyn's constants for unsteady aerodynamics


def schedule(shape: Node) -> list[Entry]:
    """Read `airfoils`: names, with or without their position over span."""
    entries = []
    for item in shape["airfoils"].members():
        name, eta = item["name"].text(), None
        if item.has("spanwise_position"):
            eta = item["spanwise_position"].number(FRACTION)
        if name is not None:
            entries.append(Entry(name, eta, item))
    return entries


LAYOUT = Layout(
    version="2",
    shape="outer_shape",
    offset="section_offset_y",
    thickness="rthick",
    axis=("reference_axis",),
    schedule=schedule,
    tilt=(("components", "drivetrain", "outer_shape", "uptilt"),),
    angle=math.pi / 180.0,
    turn=Range(-90.0, 90.0, "deg"),
    structure=reading2.read,
    facts=turbine_facts.read,
)
recognises = partial(reading.recognises, layout=LAYOUT)
read = partial(reading.read, layout=LAYOUT)


def document(definition: BladeDefinition, note: Note) -> Document:
    """Return a turbine document that holds what a definition says."""
    definition = writing.within(definition, note)
    stations = uniquely_named(definition.stations)
    rotor = definition.rotor
    components: Document = {"blade": blade(replace(definition, stations=stations), note)}
    hub = _hub(rotor, note)
    if hub:
        components["hub"] = hub
    if rotor.tilt is not None:
        components["drivetrain"] = {"outer_shape": {"uptilt": DEGREES * rotor.tilt}}
    entries = writing.airfoil_entries(stations, "rthick", polars)
    made = writing.turbine(definition, "2.0", components, entries)
    inside = writing2.document(definition, note)
    if inside is not None:
        components["blade"]["structure"], made["materials"] = inside
    return made


def whole(definition: BladeDefinition, note: Note) -> Document:
    """Return a document that tools can run: facts of the turbine, airfoils' thickness in it."""
    made = document(definition, note)
    _measured(made["airfoils"], note)
    turbine_facts.add(made, definition.rotor.facts)
    return made


def _measured(entries: list[Document], note: Note) -> None:
    """Measure the airfoils whose thickness nobody states: WISDEM runs none without one."""
    for entry in entries:
        if "rthick" not in entry:
            xy = np.array([entry["coordinates"][axis] for axis in "xy"]).T
            entry["rthick"] = min(round(thickness(xy), MEASURED), 1.0)
            where = f"airfoil {entry['name']}: rthick"
            note(where, f"is not stated; {entry['rthick']:g} is written, as its coordinates give")


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
        "chord": writing.pairs(definition.chord),
        "twist": writing.pairs(definition.twist, DEGREES),
        "section_offset_y": writing.pairs(_offset(definition, note)),
        "rthick": writing.pairs(writing.thickness(thickness, note)),
    }
    if definition.section_offset_x is not None:
        shape["section_offset_x"] = writing.pairs(definition.section_offset_x)
    return {"reference_axis": writing.axis(definition), "outer_shape": shape}


def polars(airfoil: Airfoil) -> list[Document]:
    """Return an airfoil's polars, those of one configuration together."""
    sets: dict[tuple[str, str], list[Document]] = {}
    for polar in airfoil.polars:
        row: Document = {"re": polar.reynolds or 0.0}
        for key in ("cl", "cd", "cm"):
            row[key] = writing.curve(np.degrees(polar.alpha).round(DIGITS), getattr(polar, key))
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
    made = sampled(definition.offset_y, grid, writing.OFFSET)
    off = missed(made, definition.offset_y)
    if off > 0.0:
        note(
            "section_offset_y",
            f"is the pitch axis times the chord, at {len(made.grid)} points; between them within "
            f"{off:.1g} m of it",
        )
    return made


write = partial(writing.write, version="2", document=whole)
