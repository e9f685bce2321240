"""windIO 1 and 2: turbine files in YAML, read for the blade's outer shape.

Both versions hold the same things under other names and units; `V1` and `V2` say which.
Conventions: windIO documentation and schema, https://windio.readthedocs.io.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bladegen.arrays import Array
from bladegen.crossing import first_crossing
from bladegen.definition import (
    MAX_AIRFOIL_POINTS,
    MIN_AIRFOIL_POINTS,
    Airfoil,
    BladeDefinition,
    Distribution,
    ReferenceAxis,
    Rotor,
    Station,
    stations_by_thickness,
)
from bladegen.errors import DefinitionError, FileError
from bladegen.readers.document import Node, Notes

__all__ = ["V1", "V2", "is_v1", "is_v2", "read_v1", "read_v2"]

RADIANS_PER_DEGREE = np.pi / 180.0
MAX_AIRFOILS = 1000
CLOSED = 1e-9  # chords between repeated points


@dataclass(frozen=True)
class Layout:
    """Where a version of windIO keeps the blade's shape, and in which units."""

    shape: str
    axis_beside_shape: bool
    angle: float


V1 = Layout(shape="outer_shape_bem", axis_beside_shape=False, angle=1.0)
V2 = Layout(shape="outer_shape", axis_beside_shape=True, angle=RADIANS_PER_DEGREE)


def is_v1(document: object) -> bool:
    """Tell whether a document is a windIO 1 turbine."""
    return V1.shape in _blade(document)


def is_v2(document: object) -> bool:
    """Tell whether a document is a windIO 2 turbine."""
    return V2.shape in _blade(document)


def read_v1(document: object, path: Path) -> BladeDefinition:
    """Read a windIO 1 document: radians, pitch axis as a fraction of the chord."""
    return _read(document, path, V1)


def read_v2(document: object, path: Path) -> BladeDefinition:
    """Read a windIO 2 document: degrees, offsets of the axis in metres."""
    return _read(document, path, V2)


def _blade(document: object) -> dict[object, object]:
    """Return the blade component of a document, empty if there is none."""
    for key in ("components", "blade"):
        document = document.get(key) if isinstance(document, dict) else None
    return document if isinstance(document, dict) else {}


def _read(document: object, path: Path, layout: Layout) -> BladeDefinition:
    notes = Notes()
    root = Node(document, "", notes)
    blade = root["components"]["blade"]
    shape = blade[layout.shape]

    chord = shape["chord"].distribution(lowest=0.0)
    twist = shape["twist"].distribution(factor=layout.angle)
    thickness = _optional(shape, ("rthick", "relative_thickness"), lowest=0.0)
    offset_y = _optional(shape, ("section_offset_y",))
    offset_x = _optional(shape, ("section_offset_x",))
    pitch_axis = _optional(shape, ("pitch_axis",)) if offset_y is None else None
    if not any(shape.has(key) for key in ("section_offset_y", "pitch_axis")):
        wanted = "pitch_axis" if layout is V1 else "section_offset_y"
        shape.problem(f"{wanted} is missing, must be given")
    axis = _axis((blade if layout.axis_beside_shape else shape)["reference_axis"])
    schedule = _schedule(shape, layout)
    stations = _stations(schedule, _airfoils(root, schedule), thickness, shape)

    if notes.problems:
        raise FileError(str(path), notes.problems)
    assert chord is not None  # else there was a problem
    assert twist is not None
    assert axis is not None
    assert stations is not None
    try:
        return BladeDefinition(
            name=path.stem,
            stations=stations,
            chord=chord,
            twist=twist,
            axis=axis,
            section_offset_y=offset_y,
            section_offset_x=offset_x,
            pitch_axis=pitch_axis,
            relative_thickness=thickness,
            rotor=_rotor(root, layout),
            description=str(root.value.get("description") or root.value.get("name") or ""),
            source=str(path),
            findings=tuple(notes.findings),
        )
    except DefinitionError as error:
        raise FileError(str(path), [str(error)]) from None


def _optional(
    shape: Node, names: tuple[str, ...], lowest: float | None = None
) -> Distribution | None:
    """Return the first of the named distributions that is there."""
    for name in names:
        if shape.has(name):
            return shape[name].distribution(lowest=lowest)
    return None


def _axis(node: Node) -> ReferenceAxis | None:
    """Read the reference axis; x and y may be left out of a straight blade."""
    z = node["z"].distribution(rising=True)
    x, y = (
        node[name].distribution() if node.has(name) else Distribution.constant(0.0)
        for name in ("x", "y")
    )
    return None if x is None or y is None or z is None else ReferenceAxis(x, y, z)


@dataclass(frozen=True)
class _Entry:
    """An airfoil's name in the schedule, where it stands, and the place in the file."""

    name: str
    eta: float | None
    node: Node


def _schedule(shape: Node, layout: Layout) -> list[_Entry]:
    """Read which airfoil stands where."""
    if layout is V1:
        position = shape["airfoil_position"]
        labels, grid = list(position["labels"]), list(position["grid"])
        if len(labels) != len(grid):
            position.problem(
                f"grid has {len(grid)} entries and labels {len(labels)}, must be alike"
            )
        pairs = list(zip(labels, grid, strict=False))
        entries = [(label.text(), place.span(), label) for label, place in pairs]
    else:
        entries = [
            (
                item["name"].text(),
                item["spanwise_position"].span() if item.has("spanwise_position") else None,
                item,
            )
            for item in shape["airfoils"]
        ]
    return [_Entry(name, eta, node) for name, eta, node in entries if name is not None]


def _airfoils(root: Node, schedule: list[_Entry]) -> dict[str, Airfoil]:
    """Read the airfoils that the schedule names; others in the file are of no concern."""
    wanted = {entry.name for entry in schedule}
    nodes = list(root["airfoils"])
    if len(nodes) > MAX_AIRFOILS:
        root["airfoils"].problem(f"has {len(nodes)} entries, allowed are {MAX_AIRFOILS}")
        return {}
    known: dict[str, Node] = {}
    for node in nodes:
        name = node["name"].text()
        if name is not None:
            known.setdefault(name, node)
    for entry in schedule:
        if entry.name not in known:
            names = ", ".join(sorted(known)) or "none"
            entry.node.problem(f"airfoil {entry.name!r} is not in the file; there are: {names}")
    airfoils = {name: _airfoil(name, known[name]) for name in wanted & known.keys()}
    read = {name: airfoil for name, airfoil in airfoils.items() if airfoil is not None}
    _say_if_orders_differ(read, known)
    return read


def _airfoil(name: str, node: Node) -> Airfoil | None:
    coordinates = node["coordinates"]
    x, y = coordinates["x"].numbers(), coordinates["y"].numbers()
    if x is None or y is None:
        return None
    if len(x) != len(y):
        coordinates.problem(f"x has {len(x)} entries and y {len(y)}, must be alike")
        return None
    if not MIN_AIRFOIL_POINTS <= len(x) <= MAX_AIRFOIL_POINTS:
        coordinates.problem(
            f"has {len(x)} points, allowed are {MIN_AIRFOIL_POINTS} to {MAX_AIRFOIL_POINTS}"
        )
        return None
    points = np.stack([x, y], axis=1)
    if not _is_contour(coordinates, points):
        return None
    nominal = None
    for key in ("relative_thickness", "rthick"):
        if node.has(key):
            nominal = node[key].number()
    return Airfoil(name, points, nominal)


def _is_contour(coordinates: Node, points: Array) -> bool:
    """Note what keeps points from being the contour of an airfoil."""
    repeated = int(np.count_nonzero(np.hypot(*np.diff(points, axis=0).T) <= CLOSED))
    if repeated:
        coordinates.finding(f"{repeated} repeated points dropped")
    if len(points) - repeated < MIN_AIRFOIL_POINTS:
        coordinates.problem(
            f"has {len(points) - repeated} distinct points, at least {MIN_AIRFOIL_POINTS} are "
            "needed"
        )
        return False
    if abs(_area(points)) < CLOSED:
        coordinates.problem(f"encloses an area of {_area(points):.1e}, must be more than 0")
        return False
    crossing = first_crossing(points)
    if crossing is not None:
        i, j = crossing
        coordinates.problem(
            f"crosses itself between points {i}, {i + 1} and {j}, {j + 1} near "
            f"({points[i, 0]:g}, {points[i, 1]:g}), must not"
        )
    return crossing is None


def _area(points: Array) -> float:
    """Return the signed area inside a contour, positive counter-clockwise."""
    x, y = points.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def _say_if_orders_differ(airfoils: dict[str, Airfoil], nodes: dict[str, Node]) -> None:
    """Note the airfoils that run pressure side first where others run suction side first."""
    clockwise = [name for name, foil in airfoils.items() if _area(foil.coordinates) < 0]
    if 0 < len(clockwise) < len(airfoils):
        for name in sorted(clockwise):
            nodes[name].finding(f"airfoil {name!r} runs pressure side first, unlike others; turned")


def _stations(
    schedule: list[_Entry],
    airfoils: dict[str, Airfoil],
    thickness: Distribution | None,
    shape: Node,
) -> tuple[Station, ...] | None:
    """Place the airfoils: where the schedule says, else where the thickness meets theirs."""
    if any(entry.name not in airfoils for entry in schedule):
        return None
    if any(entry.eta is None for entry in schedule):
        return _by_thickness(schedule, airfoils, thickness)
    stations: list[Station] = []
    for entry in schedule:
        assert entry.eta is not None
        station = Station(entry.eta, airfoils[entry.name])
        if stations and station.eta == stations[-1].eta:
            if station.airfoil is stations[-1].airfoil:
                entry.node.finding(f"{entry.name} stands twice at {entry.eta:g}; taken once")
                continue
            entry.node.problem(
                f"{entry.name} stands at {entry.eta:g} like {stations[-1].airfoil.name}, "
                "positions must increase"
            )
        elif stations and station.eta < stations[-1].eta:
            entry.node.problem(
                f"{entry.name} stands at {entry.eta:g} after {stations[-1].eta:g}, "
                "positions must increase"
            )
        stations.append(station)
    if len(stations) < 2:
        shape.problem(f"has {len(stations)} airfoils over span, at least 2 are needed")
        return None
    return tuple(stations)


def _by_thickness(
    schedule: list[_Entry], airfoils: dict[str, Airfoil], thickness: Distribution | None
) -> tuple[Station, ...] | None:
    first = next(entry for entry in schedule if entry.eta is None)
    if thickness is None:
        first.node.problem(
            "spanwise_position is missing, must be given where there is no rthick distribution"
        )
        return None
    own = {}
    for name, airfoil in airfoils.items():
        if airfoil.relative_thickness is None:
            first.node.problem(
                f"airfoil {name!r} has no spanwise_position, and no relative thickness to "
                "place it by"
            )
            return None
        own[name] = (airfoil.relative_thickness, airfoil)
    try:
        return stations_by_thickness(list(own.values()), thickness)
    except DefinitionError as error:
        first.node.problem(str(error))
        return None


def _rotor(root: Node, layout: Layout) -> Rotor:
    """Read what is said of the rotor; anything odd here is left out, as nothing depends on it."""

    def number(*keys: str) -> float | None:
        value = root.value
        for key in keys:
            value = value.get(key) if isinstance(value, dict) else None
        plain = isinstance(value, int | float) and not isinstance(value, bool)
        return float(value) if plain else None

    hub: tuple[str, ...] = ("components", "hub")
    hub += () if layout is V2 else ("outer_shape_bem",)
    diameter = number(*hub, "diameter")
    cone = number(*hub, "cone_angle")
    tilt = number(
        *(
            ("components", "drivetrain", "outer_shape", "uptilt")
            if layout is V2
            else ("components", "nacelle", "drivetrain", "uptilt")
        )
    )
    blades = number("assembly", "number_of_blades")
    return Rotor(
        blades=int(blades) if blades else 3,
        hub_radius=None if diameter is None else diameter / 2.0,
        diameter=number("assembly", "rotor_diameter"),
        cone=None if cone is None else layout.angle * cone,
        tilt=None if tilt is None else layout.angle * tilt,
    )
