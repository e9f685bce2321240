"""windIO 1, read and written: angles in radians, the pitch axis as a fraction of the chord."""

import math
from dataclasses import replace
from functools import partial

import numpy as np

from bladegen.definition.blade_definition import Airfoil, BladeDefinition, Distribution, united
from bladegen.formats.airfoils.unique_names import uniquely_named
from bladegen.formats.common.document import Node, Range
from bladegen.formats.common.redefinition import missed, sampled
from bladegen.formats.windio import reading, turbine_facts, writing
from bladegen.formats.windio.reading import Entry, Layout
from bladegen.formats.windio.structure import reading1, writing1
from bladegen.formats.windio.writing import Document, Note
from bladegen.support.arrays import Array

__all__ = ["LAYOUT", "document", "outer_shape", "polars", "read", "recognises", "write"]


def schedule(shape: Node) -> list[Entry]:
    """Read `airfoil_position`: a grid and the labels of the airfoils on it."""
    position = shape["airfoil_position"]
    grid, labels = position["grid"].span_fractions(), position["labels"].members()
    names = [label.text() for label in labels]
    if grid is not None and labels and len(grid) != len(labels):
        position.problem(f"grid has {len(grid)} entries and labels {len(labels)}, must be alike")
        return []
    etas = [None] * len(labels) if grid is None else grid.tolist()
    return [
        Entry(name, eta, label)
        for name, eta, label in zip(names, etas, labels, strict=False)
        if name is not None
    ]


LAYOUT = Layout(
    version="1",
    shape="outer_shape_bem",
    offset="pitch_axis",
    thickness="relative_thickness",
    axis=("outer_shape_bem", "reference_axis"),
    schedule=schedule,
    tilt=tuple(
        ("components", "nacelle", part, name)
        for part in ("drivetrain", "outer_shape_bem")
        for name in ("uptilt", "uptilt_angle")
    ),
    angle=1.0,
    turn=Range(-math.pi / 2, math.pi / 2, "rad"),
    structure=reading1.read,
    facts=turbine_facts.read_older,
)
recognises = partial(reading.recognises, layout=LAYOUT)
read = partial(reading.read, layout=LAYOUT)


def document(definition: BladeDefinition, note: Note) -> Document:
    """Return a turbine document that holds what a definition says."""
    definition = writing.within(definition, note)
    stations = uniquely_named(definition.stations)
    rotor = definition.rotor
    shared = tuple(fact for fact in rotor.facts if fact[0].startswith("assembly."))
    if shared != rotor.facts:
        note("turbine", "its control and drivetrain stand elsewhere in windIO 1; left out")
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
    entries = writing.airfoil_entries(stations, "relative_thickness", polars)
    made = writing.turbine(definition, "1.0", components, entries)
    turbine_facts.add(made, shared)
    inside = writing1.document(definition, note)
    if inside is not None:
        components["blade"]["internal_structure_2d_fem"], made["materials"] = inside
    return made


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
        "chord": writing.pairs(definition.chord),
        "twist": writing.pairs(definition.twist),
        "pitch_axis": writing.pairs(_pitch_axis(definition, note)),
        "reference_axis": writing.axis(definition),
    }
    if definition.relative_thickness is not None:
        shape["rthick"] = writing.pairs(writing.thickness(definition.relative_thickness, note))
    return shape


def polars(airfoil: Airfoil) -> list[Document]:
    """Return an airfoil's polars, one entry each."""
    return [
        {
            "configuration": polar.configuration,
            **({"description": polar.source} if polar.source else {}),
            "re": polar.reynolds or 0.0,
            **{f"c_{x}": writing.curve(polar.alpha, getattr(polar, f"c{x}")) for x in "ldm"},
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

    made = sampled(fraction, grid, writing.OFFSET / float(definition.chord.values.max()))
    note(
        "pitch_axis",
        f"section_offset_y over chord at {len(made.grid)} points, within "
        f"{missed(made, fraction):.1g} chord of the quotient",
    )
    return made


write = partial(writing.write, version="1", document=document)
