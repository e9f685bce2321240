"""Definitions as windIO turbine documents: what versions 1 and 2 share.

A document is made of plain dicts, lists, texts and numbers, and holds what the definition
says: the blade's outer shape and reference axis, its airfoils, and what is known of the rotor.
"""

from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from bladegen.arrays import Array
from bladegen.definition import Airfoil, BladeDefinition, Distribution, Station
from bladegen.errors import Finding
from bladegen.files import replacing

__all__ = [
    "Document",
    "Note",
    "airfoil_entries",
    "axis",
    "curve",
    "dump",
    "pairs",
    "thickness",
    "turbine",
    "uniquely_named",
    "write",
]

Document = dict[str, Any]
Note = Callable[[str, str], None]
LINE = 100
NEGLIGIBLE = 1e-5  # chords by which an airfoil may move without a word
_DUMPER: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)


def pairs(quantity: Distribution, factor: float = 1.0) -> Document:
    """Return `grid` and `values`, the latter in the file's unit."""
    return {"grid": quantity.grid.tolist(), "values": (factor * quantity.values).tolist()}


def axis(definition: BladeDefinition) -> Document:
    """Return the reference axis [m]."""
    curve = definition.axis
    return {key: pairs(part) for key, part in (("x", curve.x), ("y", curve.y), ("z", curve.z))}


def thickness(quantity: Distribution, note: Note) -> Distribution:
    """Return a distribution of relative thickness within windIO's 0 to 1."""
    if np.all(quantity.values <= 1.0):
        return quantity
    note("rthick", f"{quantity.values.max():.6g} is above 1, the most that windIO allows; cut to 1")
    return replace(quantity, values=np.minimum(quantity.values, 1.0))


def uniquely_named(stations: Iterable[Station]) -> tuple[Station, ...]:
    """Return stations whose airfoils differ in name if they differ in shape.

    windIO finds airfoils by name.
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


def airfoil_entries(
    stations: Iterable[Station], key: str, note: Note, polars: Callable[[Airfoil], list[Document]]
) -> list[Document]:
    """Return the file's list of airfoils, each once.

    Parameters
    ----------
    stations : iterable of Station
        Their airfoils differ in name if they differ.
    key : str
        Where the thickness is stated.
    note : callable
        Told what had to be changed.
    polars : callable
        From an airfoil to the version's list of polars.
    """
    airfoils = {station.airfoil.name: station.airfoil for station in stations}
    entries = []
    scales: dict[str, float] = {}
    for airfoil in airfoils.values():
        points, scale = _within(airfoil.coordinates)
        if scale is not None:
            scales[airfoil.name] = scale
        entry: Document = {
            "name": airfoil.name,
            "coordinates": {"x": points[:, 0].tolist(), "y": points[:, 1].tolist()},
        }
        stated = airfoil.relative_thickness
        if stated is not None:
            entry[key] = min(stated, 1.0)
        if airfoil.aerodynamic_center is not None:
            entry["aerodynamic_center"] = airfoil.aerodynamic_center
        if airfoil.polars:
            entry["polars"] = polars(airfoil)
        entries.append(entry)
    if scales:
        most = max(scales, key=lambda name: scales[name])
        note(
            "airfoils",
            f"{len(scales)} with x outside of 0 to 1, which windIO does not allow: moved to 0 and "
            f"divided by up to {scales[most]:.6f} ({most}), and so moved along their chords",
        )
    return entries


def curve(alpha: Array, values: Array) -> Document:
    """Return a coefficient over the angle of attack, the latter in the file's unit."""
    return {"grid": alpha.tolist(), "values": values.tolist()}


def turbine(
    definition: BladeDefinition, version: str, components: Document, airfoils: list[Document]
) -> Document:
    """Return a turbine document of its parts."""
    rotor = definition.rotor
    assembly: Document = {"number_of_blades": rotor.blades}
    if rotor.diameter is not None:
        assembly["rotor_diameter"] = rotor.diameter
    return {
        "windIO_version": version,
        "name": definition.description or definition.name,
        "assembly": assembly,
        "components": components,
        "airfoils": airfoils,
    }


def write(
    definition: BladeDefinition,
    path: Path,
    *,
    version: str,
    document: Callable[[BladeDefinition, Note], Document],
) -> tuple[Finding, ...]:
    """Write a definition; return what the version cannot hold, or holds only within a distance."""
    findings: list[Finding] = []
    content = document(definition, lambda where, said: findings.append(Finding(where, said)))
    dump(content, path, f"A blade in the layout of windIO {version}, written by bladegen.")
    return tuple(findings)


def dump(document: Document, path: Path, title: str) -> None:
    """Write a document as YAML, lists of numbers on lines of their own."""
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8") as stream:
        stream.write(f"# {title}\n")
        yaml.dump(
            document,
            stream,
            Dumper=_DUMPER,
            default_flow_style=None,
            sort_keys=False,
            width=LINE,
            allow_unicode=True,
        )


def _alike(one: Airfoil, other: Airfoil) -> bool:
    return (
        one.relative_thickness == other.relative_thickness
        and np.array_equal(one.coordinates, other.coordinates)
        and one.polars is other.polars
    )


def _within(points: Array) -> tuple[Array, float | None]:
    """Return points with x within windIO's 0 to 1, by a shift and a scale where it takes them.

    The scale is given if it or the shift is worth a word.
    """
    low, high = points[:, 0].min(), points[:, 0].max()
    if low >= 0.0 and high <= 1.0:
        return points, None
    low = min(float(low), 0.0)
    scale = max(float(high) - low, 1.0)
    told = scale if max(-low, scale - 1.0) > NEGLIGIBLE else None
    moved = (points - [low, 0.0]) / scale
    moved[:, 0] = np.clip(moved[:, 0], 0.0, 1.0)  # rounding
    return moved, told
