"""Airfoils of a document: found by name, checked, and made contours by `contours`.

A contour runs trailing edge -> leading edge -> trailing edge in chords, either side first,
open or closed at its end; which way round it runs is settled by `bladegen.airfoils.landmarks`.
"""

from collections.abc import Iterable

import numpy as np

from bladegen.definition.blade_definition import MIN_AIRFOIL_POINTS, Airfoil
from bladegen.errors import Finding
from bladegen.formats.airfoils.contours import THICKNESS, ContourError, contour, thickness
from bladegen.formats.airfoils.reading import AirfoilFile
from bladegen.formats.common.document import Node, Notes, Range
from bladegen.formats.common.polars import polars
from bladegen.support.arrays import Array

__all__ = ["airfoil", "airfoils", "of_file"]

X = Range(-0.5, 1.5, "chords")
Y = Range(-1.0, 1.0, "chords")
CENTRE = Range(0.0, 1.0, "of the chord")
DISAGREEMENT = 0.01  # of the thickness: more is a finding
SHOWN_NAMES = 30


def airfoils(library: Node, wanted: Iterable[tuple[str, Node]], key: str) -> dict[str, Airfoil]:
    """Read the airfoils that a schedule names; others in the file are of no concern.

    Parameters
    ----------
    library : Node
        The file's list of airfoils, each with a name and coordinates.
    wanted : iterable of (name, Node)
        The names, and where the file asks for them.
    key : str
        Where an airfoil of this layout states its thickness.
    """
    known: dict[str, Node] = {}
    twice: dict[str, Node] = {}
    for node in library.members():
        name = node["name"].text()
        if name is not None:
            (twice if name in known else known)[name] = node
    found: dict[str, Airfoil | None] = {}
    for name, place in wanted:
        if name not in known:
            place.problem(f"got airfoil {name!r}, allowed are those of airfoils: {_names(known)}")
        elif name not in found:
            if name in twice:
                twice[name].problem(f"name {name!r} is that of {known[name].path}, must be unique")
            found[name] = airfoil(name, known[name], key)
    read = {name: airfoil for name, airfoil in found.items() if airfoil is not None}
    clockwise = [name for name, airfoil in read.items() if _area(airfoil.coordinates) < 0]
    if 0 < len(clockwise) < len(read):
        library.finding(
            f"run both ways round, made alike: pressure side first in {_names(clockwise)}"
        )
    return read


def airfoil(name: str, node: Node, key: str) -> Airfoil | None:
    """Read one airfoil; `key` is where it states its thickness."""
    place = node["coordinates"]
    points = _points(place)
    stated = node[key].number(THICKNESS) if node.has(key) else None
    if points is None:
        return None
    try:
        loop = contour(points, fewest=MIN_AIRFOIL_POINTS)
    except ContourError as error:
        place.problem(str(error))
        return None
    for said in loop.said:
        place.finding(said)
    if stated is not None:
        told = _disagreement(name, stated, loop.points)
        if told:
            node[key].finding(told)
    centre = None
    if node.has("aerodynamic_center"):
        centre = node["aerodynamic_center"].number(CENTRE)
    return Airfoil(name, loop.points, stated, polars(node), centre)


def of_file(name: str, file: str, read: AirfoilFile, stated: float | None, notes: Notes) -> Airfoil:
    """Return the airfoil of a coordinate file, and note what was said of it.

    Parameters
    ----------
    name, file : str
        The airfoil's, and the name of its file.
    read : AirfoilFile
        The file.
    stated : float, optional
        Its relative thickness, where an index tells it.
    notes : Notes
        Takes the findings.
    """
    notes.findings += [Finding(file, said) for said in read.said]
    if stated is not None:
        told = _disagreement(name, stated, read.points)
        if told:
            notes.findings.append(Finding(file, told))
    return Airfoil(name, read.points, stated)


def _disagreement(name: str, stated: float, points: Array) -> str | None:
    measured = thickness(points)
    if abs(measured - stated) <= DISAGREEMENT * stated:
        return None
    return f"{name} is stated {stated:g} thick; its coordinates give {measured:.4g}"


def _points(node: Node) -> Array | None:
    """Return the points that a document gives, if it does."""
    x, y = node["x"].numbers(X), node["y"].numbers(Y)
    if x is None or y is None:
        return None
    if len(x) != len(y):
        node.problem(f"x has {len(x)} entries and y {len(y)}, must be alike")
        return None
    return np.stack([x, y], axis=1)


def _area(points: Array) -> float:
    """Return the signed area inside a contour, positive counter-clockwise."""
    x, y = points.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def _names(names: Iterable[str]) -> str:
    names = sorted(names)
    more = len(names) - SHOWN_NAMES
    return ", ".join(names[:SHOWN_NAMES]) + (f" and {more} more" if more > 0 else "") or "none"
