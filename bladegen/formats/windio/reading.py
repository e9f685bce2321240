"""windIO turbine files, read for the blade's outer shape: what versions 1 and 2 share.

Both hold the same things under other names and in other units; a `Layout` says which.
Conventions: windIO documentation and schema, https://ieawindsystems.github.io/windIO.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import reduce
from pathlib import Path

from bladegen.definition.blade_definition import (
    SMALLEST_STEP,
    Airfoil,
    BladeDefinition,
    Distribution,
    ReferenceAxis,
    Rotor,
    Station,
)
from bladegen.definition.by_thickness import stations_by_thickness
from bladegen.definition.structure.structure import Structure
from bladegen.errors import DefinitionError
from bladegen.formats.airfoils.by_name import airfoils
from bladegen.formats.airfoils.contours import thickness
from bladegen.formats.common.document import Node, Range

__all__ = ["Entry", "Layout", "read", "recognises"]

CHORD = Range(1e-6, 100.0, "m")  # a tip may run out to a point, all but
POSITION = Range(-1000.0, 1000.0, "m")
FRACTION_OF_CHORD = Range(-1.0, 2.0, "of the chord")
RELATIVE_THICKNESS = Range(0.0, 1.05, "of the chord", above=True)
DIAMETER = Range(0.0, 1000.0, "m")
BLADES = Range(1, 10)
DRAG = Range(0.0, 2.0)
HUBS: tuple[tuple[str, ...], ...] = ((), ("outer_shape_bem",), ("outer_shape",))  # members of hub


@dataclass(frozen=True)
class Entry:
    """An airfoil of the schedule: its name, its span fraction if given, its place in the file."""

    name: str
    eta: float | None
    node: Node


@dataclass(frozen=True)
class Layout:
    """Where a version of windIO keeps things, and in which unit of angle.

    Parameters
    ----------
    version : str
        The first digit of `windIO_version`.
    shape : str
        The member of `components.blade` that holds the outer shape.
    offset : str
        The one of `section_offset_y` and `pitch_axis` that the version knows.
    thickness : str
        What the version calls the relative thickness of an airfoil.
    axis : tuple of str
        The path of the reference axis in `components.blade`.
    schedule : callable
        From the node of the shape to the entries of the airfoil schedule.
    tilt : tuple of tuples of str
        The paths at which the tilt angle may stand.
    angle : float
        The unit of angle [rad].
    turn : Range
        The angles allowed, a quarter turn, in that unit.
    structure : callable
        From the document to what lies inside the skin; notes what it leaves out.
    facts : callable
        From the document to what is kept of the turbine for other tools.
    """

    version: str
    shape: str
    offset: str
    thickness: str
    axis: tuple[str, ...]
    schedule: Callable[[Node], list[Entry]]
    tilt: tuple[tuple[str, ...], ...]
    angle: float
    turn: Range
    structure: Callable[[Node], Structure | None]
    facts: Callable[[Node], tuple[tuple[str, str | float], ...]]


def recognises(document: object, layout: Layout) -> bool:
    """Tell whether a document holds a blade in this layout, or says that it does."""
    blade = document
    for key in ("components", "blade"):
        blade = blade.get(key) if isinstance(blade, Mapping) else None
    if isinstance(blade, Mapping) and layout.shape in blade:
        return True
    stated = document.get("windIO_version") if isinstance(document, Mapping) else None
    return str(stated).strip().startswith(layout.version)


def read(root: Node, path: Path, layout: Layout) -> BladeDefinition | None:
    """Read a blade; None if there are problems, which `root.notes` then holds."""
    blade = root["components"]["blade"]
    shape = blade[layout.shape]
    chord = shape["chord"].distribution(CHORD)
    twist = shape["twist"].distribution(layout.turn, factor=layout.angle)
    axis = _axis(reduce(Node.__getitem__, layout.axis, blade))
    rthick = _optional(shape, "rthick", RELATIVE_THICKNESS)
    if rthick is None:
        rthick = _optional(shape, "relative_thickness", RELATIVE_THICKNESS)
    offset_x = _optional(shape, "section_offset_x", POSITION)
    offset_y = _optional(shape, "section_offset_y", POSITION)
    pitch_axis = _optional(shape, "pitch_axis", FRACTION_OF_CHORD)
    given = [key for key in ("pitch_axis", "section_offset_y") if shape.has(key)]
    if not given:
        _ = shape[layout.offset]  # its absence is the problem
    elif len(given) == 2:
        shape.problem("got both pitch_axis and section_offset_y, allowed is one of them")
    if shape.has("surface"):
        shape["surface"].finding("is passed over; the blade is made from airfoils, chord and twist")
    entries = layout.schedule(shape)
    library = airfoils(root["airfoils"], [(e.name, e.node) for e in entries], layout.thickness)
    stations = _stations(entries, library, rthick)
    rotor = _rotor(root, layout)
    structure = layout.structure(root)
    if root.notes.problems or not (chord and twist and axis and stations):
        return None
    title = root.value.get("name")
    return BladeDefinition(
        name=path.stem,
        stations=stations,
        chord=chord,
        twist=twist,
        axis=axis,
        section_offset_y=offset_y,
        section_offset_x=offset_x,
        pitch_axis=pitch_axis,
        relative_thickness=rthick,
        rotor=rotor,
        structure=structure,
        description=title if isinstance(title, str) else "",
        source=str(path),
        findings=tuple(root.notes.findings),
    )


def _optional(shape: Node, key: str, allowed: Range) -> Distribution | None:
    return shape[key].distribution(allowed) if shape.has(key) else None


def _axis(node: Node) -> ReferenceAxis | None:
    """Read the reference axis; x and y may be left out of a straight blade."""
    z = node["z"].distribution(POSITION, rising=True)
    curved = {}
    for key in ("x", "y"):
        if node.has(key):
            curved[key] = node[key].distribution(POSITION)
        else:
            node.finding(f"{key} is not given; taken as 0")
            curved[key] = Distribution.constant(0.0)
    x, y = curved["x"], curved["y"]
    return ReferenceAxis(x, y, z) if x and y and z else None


def _stations(
    entries: list[Entry], library: dict[str, Airfoil], rthick: Distribution | None
) -> tuple[Station, ...] | None:
    """Place the airfoils: where the schedule says, else where the thickness meets theirs."""
    if not entries or any(entry.name not in library for entry in entries):
        return None
    if all(entry.eta is None for entry in entries) and rthick is not None:
        return _by_thickness(entries, library, rthick)
    missing = [entry for entry in entries if entry.eta is None]
    for entry in missing:
        entry.node.problem(
            "spanwise_position is missing; allowed is to give it to every airfoil, or to none "
            "if there is an rthick distribution"
        )
    placed = [(entry.eta, entry) for entry in entries if entry.eta is not None]
    stations: list[Station] = []
    for eta, entry in placed:
        station = Station(eta, library[entry.name])
        last = stations[-1] if stations else None
        if last and eta == last.eta and station.airfoil is last.airfoil:
            entry.node.finding(f"{entry.name} stands twice at {eta:g}; taken once")
            continue
        if last and eta - last.eta < SMALLEST_STEP:
            entry.node.problem(f"{entry.name} at {eta:g} follows {last.eta:g}, must increase")
        stations.append(station)
    if missing:
        return None
    first, last = stations[0], stations[-1]
    if first.eta > 0:
        entries[0].node.finding(f"{first.airfoil.name} at {first.eta:g} is held to the root")
        stations.insert(0, Station(0.0, first.airfoil))
    if last.eta < 1:
        entries[-1].node.finding(f"{last.airfoil.name} at {last.eta:g} is held to the tip")
        stations.append(Station(1.0, last.airfoil))
    return tuple(stations)


def _by_thickness(
    entries: list[Entry], library: dict[str, Airfoil], rthick: Distribution
) -> tuple[Station, ...] | None:
    own = []
    for airfoil in library.values():
        stated = airfoil.relative_thickness
        own.append((thickness(airfoil.coordinates) if stated is None else stated, airfoil))
    try:
        return stations_by_thickness(own, rthick)
    except DefinitionError as error:
        entries[0].node.problem(f"spanwise_position is missing, and {error}")
        return None


def _rotor(root: Node, layout: Layout) -> Rotor:
    """Read what is said of the rotor; nothing of it needs to be there."""

    def number(allowed: Range, *paths: tuple[str, ...]) -> float | None:
        for path in paths:
            node = root
            for key in path:
                if not node.has(key):
                    break
                node = node[key]
            else:
                return node.number(allowed)
        return None

    def hub(*names: str) -> list[tuple[str, ...]]:
        return [("components", "hub", *within, name) for name in names for within in HUBS]

    diameter = number(DIAMETER, *hub("diameter"))
    cone = number(layout.turn, *hub("cone_angle"))
    tilt = number(layout.turn, *layout.tilt)
    blades = number(BLADES, ("assembly", "number_of_blades"))
    return Rotor(
        blades=Rotor.blades if blades is None else int(blades),
        hub_radius=None if diameter is None else diameter / 2.0,
        # windIO writes 0 for a diameter that is not stated
        diameter=number(DIAMETER, ("assembly", "rotor_diameter")) or None,
        cone=None if cone is None else layout.angle * cone,
        tilt=None if tilt is None else layout.angle * tilt,
        hub_drag=number(DRAG, *hub("cd", "drag_coefficient")),
        facts=layout.facts(root),
    )
