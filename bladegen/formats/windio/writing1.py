"""windIO 1: angles in radians, the pitch axis as a fraction of the chord."""

from dataclasses import replace
from functools import partial

import numpy as np

from bladegen.definition.blade_definition import Airfoil, BladeDefinition, Distribution, united
from bladegen.formats.common.redefinition import missed, sampled
from bladegen.formats.windio import writing as windio
from bladegen.formats.windio.writing import Document, Note
from bladegen.support.arrays import Array

__all__ = ["document", "outer_shape", "polars", "write"]


def document(definition: BladeDefinition, note: Note) -> Document:
    """Return a turbine document that holds what a definition says."""
    definition = windio.within(definition, note)
    stations = windio.uniquely_named(definition.stations)
    rotor = definition.rotor
    named = replace(definition, stations=stations)
    components: Document = {"blade": {"outer_shape_bem": outer_shape(named, note)}}
    hub: Document = {}
    if rotor.hub_radius is not None:
        hub["diameter"] = 2.0 * rotor.hub_radius
    if rotor.cone is not None:
        hub["cone_angle"] = rotor.cone
    if rotor.hub_drag is not None:
        hub["cd"] = rotor.hub_drag
    if hub:
        components["hub"] = hub
    if rotor.tilt is not None:
        components["nacelle"] = {"drivetrain": {"uptilt": rotor.tilt}}
    entries = windio.airfoil_entries(stations, "relative_thickness", polars)
    return windio.turbine(definition, "1.0", components, entries)


def outer_shape(definition: BladeDefinition, note: Note) -> Document:
    """Return the outer shape, with its reference axis."""
    offset_x = definition.section_offset_x
    if offset_x is not None and np.any(offset_x.values):
        note(
            "section_offset_x",
            f"up to {np.abs(offset_x.values).max():.4g} m, has no place in windIO 1; left out",
        )
    shape: Document = {
        "airfoil_position": {
            "grid": [station.eta for station in definition.stations],
            "labels": [station.airfoil.name for station in definition.stations],
        },
        "chord": windio.pairs(definition.chord),
        "twist": windio.pairs(definition.twist),
        "pitch_axis": windio.pairs(_pitch_axis(definition, note)),
        "reference_axis": windio.axis(definition),
    }
    if definition.relative_thickness is not None:
        shape["rthick"] = windio.pairs(windio.thickness(definition.relative_thickness, note))
    return shape


def polars(airfoil: Airfoil) -> list[Document]:
    """Return an airfoil's polars, one entry each."""
    return [
        {
            "configuration": polar.configuration,
            **({"description": polar.source} if polar.source else {}),
            "re": polar.reynolds or 0.0,
            **{f"c_{x}": windio.curve(polar.alpha, getattr(polar, f"c{x}")) for x in "ldm"},
        }
        for polar in airfoil.polars
    ]


def _pitch_axis(definition: BladeDefinition, note: Note) -> Distribution:
    if definition.pitch_axis is not None:
        return definition.pitch_axis
    assert definition.section_offset_y is not None  # a definition has one of both
    grid = united(definition.section_offset_y.grid, definition.chord.grid)

    def fraction(eta: Array) -> Array:
        return definition.offset_y(eta) / definition.chord(eta)

    made = sampled(fraction, grid, windio.OFFSET / float(definition.chord.values.max()))
    note(
        "pitch_axis",
        f"section_offset_y over chord at {len(made.grid)} points, within "
        f"{missed(made, fraction):.1g} chord of the quotient",
    )
    return made


write = partial(windio.write, version="1", document=document)
