"""What windIO files say of the turbine besides the blade: kept as it is, and written back.

Nothing here is used by bladegen; tools that run the turbine (WISDEM) ask for it.  A fact is a
number or a short text under the path at which it stands in windIO 2, in the file's own unit;
windIO 1 has the same members of the assembly.  How its rotor turns stands elsewhere there, and in
other units (rad/s and m/s), and is brought to windIO 2's.
"""

from collections.abc import Iterable
from math import inf, pi

from bladegen.formats.common.document import Node
from bladegen.formats.windio.writing import Document

__all__ = ["Facts", "add", "read", "read_older"]

Facts = tuple[tuple[str, str | float], ...]
LONGEST = 100  # characters of a text
KEPT = {
    "assembly": (
        "turbine_class",
        "turbulence_class",
        "drivetrain",
        "rotor_orientation",
        "hub_height",
        "rated_power",
        "lifetime",
        "cut_in_wind_speed",
        "cut_out_wind_speed",
    ),
    "components.drivetrain.outer_shape": ("distance_tt_hub", "overhang"),
    "components.drivetrain.gearbox": ("gear_ratio", "efficiency"),
    "control": (
        "min_rotor_speed",
        "rated_rotor_speed",
        "max_rotor_speed",
        "rated_power",
        "optimal_tsr",
        "fine_pitch",
        "min_pitch_limit",
        "max_pitch_limit",
        "max_pitch_rate",
        "max_torque_rate",
    ),
}


RPM, DEGREES = 30.0 / pi, 180.0 / pi
OLDER = {  # where windIO 1 has the same, and its unit in that of windIO 2
    "assembly.cut_in_wind_speed": ("control.supervisory.Vin", 1.0),
    "assembly.cut_out_wind_speed": ("control.supervisory.Vout", 1.0),
    "components.drivetrain.outer_shape.distance_tt_hub": (
        "components.nacelle.drivetrain.distance_tt_hub",
        1.0,
    ),
    "components.drivetrain.outer_shape.overhang": ("components.nacelle.drivetrain.overhang", 1.0),
    "components.drivetrain.gearbox.gear_ratio": ("components.nacelle.drivetrain.gear_ratio", 1.0),
    "control.min_rotor_speed": ("control.torque.VS_minspd", RPM),
    "control.max_rotor_speed": ("control.torque.VS_maxspd", RPM),
    "control.min_pitch_limit": ("control.pitch.min_pitch", DEGREES),
    "control.max_pitch_limit": ("control.pitch.max_pitch", DEGREES),
    "control.max_pitch_rate": ("control.pitch.max_pitch_rate", DEGREES),
    "control.max_torque_rate": ("control.torque.max_torque_rate", 1.0),
}


def read(root: Node, places: Iterable[str] = tuple(KEPT)) -> Facts:
    """Return the facts at some places of a document, if they are numbers or short texts."""
    found: list[tuple[str, str | float]] = []
    for path in places:
        held = root.value
        for key in path.split("."):
            held = held.get(key) if isinstance(held, dict) else None
        for name in KEPT[path]:
            value = held.get(name) if isinstance(held, dict) else None
            if isinstance(value, str | int | float) and _plain(value):
                found.append((f"{path}.{name}", value))
    return tuple(found)


def read_older(root: Node) -> Facts:
    """Return the facts of a windIO 1 document: its assembly, and how its rotor is controlled.

    The rated speed is the lower of the largest rotor speed and the one at which the tip is as fast
    as it may be: the windIO 2 file of IEA 22 MW has what its windIO 1 file makes by that.
    """
    control = {
        name: _number(root, f"control.{place}")
        for name, place in (
            ("tsr", "torque.tsr"),
            ("turning", "torque.VS_maxspd"),  # rad/s
            ("tip", "supervisory.maxTS"),  # m/s
        )
    }
    found = dict(read(root, ("assembly",)))
    for name, (place, factor) in OLDER.items():
        value = _number(root, place, -inf)
        if value is not None:
            found.setdefault(name, value * factor)
    diameter, tip = _number(root, "assembly.rotor_diameter"), control["tip"]
    bounds = [] if control["turning"] is None else [control["turning"]]
    if tip is not None and diameter is not None:
        bounds.append(2.0 * tip / diameter)
    if bounds:
        found["control.rated_rotor_speed"] = min(bounds) * RPM
    if control["tsr"] is not None:
        found["control.optimal_tsr"] = control["tsr"]
    order = [f"{path}.{name}" for path, names in KEPT.items() for name in names]
    return tuple((name, found[name]) for name in order if name in found)


def _number(root: Node, path: str, above: float = 0.0) -> float | None:
    """Return what stands at a path, if it is a number, above nought if nothing else is said."""
    held = root.value
    for key in path.split("."):
        held = held.get(key) if isinstance(held, dict) else None
    if isinstance(held, bool) or not isinstance(held, int | float):
        return None
    return float(held) if above < held < inf else None


def _plain(value: str | float) -> bool:
    if isinstance(value, str):
        return len(value) <= LONGEST
    return not isinstance(value, bool)


def add(document: Document, facts: Facts) -> None:
    """Write facts into a document, beside what stands there."""
    for path, value in facts:
        *holders, name = path.split(".")
        held = document
        for key in holders:
            held = held.setdefault(key, {})
        held.setdefault(name, value)
