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

from bladegen.definition.blade_definition import (
    Airfoil,
    BladeDefinition,
    Distribution,
    Station,
    united,
)
from bladegen.errors import Finding
from bladegen.formats.common.redefinition import sampled
from bladegen.support.arrays import Array
from bladegen.support.files import replacing

__all__ = [
    "OFFSET",
    "Document",
    "Note",
    "airfoil_entries",
    "axis",
    "curve",
    "dump",
    "pairs",
    "thickness",
    "turbine",
    "within",
    "write",
]

Document = dict[str, Any]
Note = Callable[[str, str], None]
LINE = 100
OFFSET = 5e-7  # m, by which a sampled offset may be off
MOVED = 2e-5  # m, the same where it takes up what airfoils were moved
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


def airfoil_entries(
    stations: Iterable[Station], key: str, polars: Callable[[Airfoil], list[Document]]
) -> list[Document]:
    """Return the file's list of airfoils, each once.

    Parameters
    ----------
    stations : iterable of Station
        Their airfoils differ in name if they differ.
    key : str
        Where the thickness is stated.
    polars : callable
        From an airfoil to the version's list of polars.
    """
    airfoils = {station.airfoil.name: station.airfoil for station in stations}
    entries = []
    for airfoil in airfoils.values():
        x, y = airfoil.coordinates.T
        entry: Document = {
            "name": airfoil.name,
            "coordinates": {"x": x.tolist(), "y": y.tolist()},
        }
        stated = airfoil.relative_thickness
        if stated is not None:
            entry[key] = min(stated, 1.0)
        if airfoil.aerodynamic_center is not None:
            entry["aerodynamic_center"] = airfoil.aerodynamic_center
        if airfoil.polars:
            entry["polars"] = polars(airfoil)
        entries.append(entry)
    return entries


def within(definition: BladeDefinition, note: Note, off: float = MOVED) -> BladeDefinition:
    """Return the same blade with airfoils whose x lies within windIO's 0 to 1, but for `off` [m].

    They are moved along their chords and made smaller where that takes it; the blade has unit
    chords anyway, and the offset along the chord takes up the move.
    """
    moved: dict[int, Airfoil] = {}
    most = 0.0
    for station in definition.stations:
        points = station.airfoil.coordinates
        low, high = min(float(points[:, 0].min()), 0.0), float(points[:, 0].max())
        if low < 0.0 or high > 1.0:
            fitted = (points - [low, 0.0]) / max(high - low, 1.0)
            fitted[:, 0] = np.clip(fitted[:, 0], 0.0, 1.0)  # rounding
            moved[id(station.airfoil)] = replace(station.airfoil, coordinates=fitted)
            most = max(most, -low, high - 1.0)
    if not moved:
        return definition
    from bladegen.blade.blade import Blade

    result = replace(
        definition,
        stations=tuple(
            Station(station.eta, moved.get(id(station.airfoil), station.airfoil))
            for station in definition.stations
        ),
    )
    note(
        "airfoils",
        f"{len(moved)} with x up to {most:.2g} outside of 0 to 1, which windIO does not allow: "
        "moved along their chords and scaled; the offset along the chord takes it up",
    )
    before, after = (Blade.from_definition(one).profiles for one in (definition, result))
    shift = _shift(before, after)
    stations = [station.eta for station in definition.stations]
    offset, pitch, chord = definition.section_offset_y, definition.pitch_axis, definition.chord
    if pitch is not None:
        share = off / float(chord.values.max())
        made = sampled(lambda eta: pitch(eta) + shift(eta), united(pitch.grid, stations), share)
        return replace(result, pitch_axis=made)
    assert offset is not None  # a definition has one of both
    grid = united(offset.grid, chord.grid, stations)
    made = sampled(lambda eta: offset(eta) + chord(eta) * shift(eta), grid, off)
    return replace(result, section_offset_y=made)


def _shift(
    before: Callable[[Array], Array], after: Callable[[Array], Array]
) -> Callable[[Array], Array]:
    """Return by how much one blade's profiles lie behind another's, in chords, over span.

    They are the same but for this; each place is looked at once.
    """
    known: dict[float, float] = {}

    def shift(eta: Array) -> Array:
        places = [place for place in eta.reshape(-1).tolist() if place not in known]
        if places:
            new = np.array(places)
            by = after(new)[..., 0] - before(new)[..., 0]
            known.update(zip(places, by.mean(axis=-1).tolist(), strict=True))
        return np.array([known[place] for place in eta.reshape(-1).tolist()]).reshape(eta.shape)

    return shift


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
