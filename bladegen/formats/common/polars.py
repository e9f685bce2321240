"""Polars of a document's airfoils, and what tools ask of a blade's.

A blade's shape does not depend on polars, so nothing that is wrong with them refuses a file: what
cannot be read is left out, and said.  Files of tools that do not run without are refused.
"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from bladegen.airfoils.polars import Polar
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.blending import Between
from bladegen.errors import DefinitionError, ExportError
from bladegen.formats.common.document import Node, Notes, Range

__all__ = ["QUARTER", "about_quarter", "polars", "require_polars"]

TURN = 180.0 + 1e-3
ANGLE = {"deg": Range(-TURN, TURN, "deg"), "rad": Range(-math.pi - 1e-4, math.pi + 1e-4, "rad")}
COEFFICIENT = Range(-100.0, 100.0)
REYNOLDS = Range(0.0, 1e10)
PARAMETER = Range(-1e6, 1e6)
GIVEN = ("re", "cl", "cd", "cm")
QUARTER = 0.25  # of the chord
TURNS = np.radians(np.arange(-180.0, 181.0, 5.0))
SHOWN = 4  # airfoils that a message names


def polars(airfoil: Node) -> tuple[Polar, ...]:
    """Return the polars of an airfoil entry of windIO 1 or 2."""
    if not airfoil.has("polars"):
        return ()
    notes = Notes()
    entry = Node(airfoil.value, airfoil.path, notes)
    found: list[Polar] = []
    try:
        for item in entry["polars"].members():
            configuration = item["configuration"].text() if item.has("configuration") else None
            source = item["description"].text() if item.has("description") else None
            marks = configuration or "default", source or ""
            if item.has("re_sets"):
                found += [_polar(row, "c{}", "deg", *marks) for row in item["re_sets"].members()]
            else:
                found.append(_polar(item, "c_{}", "rad", *marks))
    except (DefinitionError, _MissingError) as error:
        notes.problems.append(str(error))
    if notes.problems:
        airfoil["polars"].finding(f"left out: {notes.problems[0]}")
        return ()
    return tuple(found)


class _MissingError(Exception):
    """A polar without one of its curves; the notes say which."""


def _polar(node: Node, key: str, unit: str, configuration: str, source: str) -> Polar:
    """Read one polar, its curves brought to one grid of angles."""
    curves = []
    for letter in "ldm":
        curve = node[key.format(letter)]
        grid, values = curve["grid"].numbers(ANGLE[unit]), curve["values"].numbers(COEFFICIENT)
        if grid is None or values is None:
            raise _MissingError(node.notes.problems[0])
        if len(grid) != len(values):
            raise _MissingError(f"{curve.path}: {len(grid)} angles and {len(values)} values")
        if not np.all(np.diff(grid) > 0):
            raise _MissingError(f"{curve.path}: angles must increase strictly")
        curves.append((grid, values))
    grid = curves[0][0]
    for other, _ in curves[1:]:
        grid = grid if np.array_equal(grid, other) else np.union1d(grid, other)
    cl, cd, cm = (
        values if np.array_equal(grid, own) else np.interp(grid, own, values)
        for own, values in curves
    )
    parameters = []
    if unit == "deg" and isinstance(node.value, dict):
        parameters = [
            (name, value)
            for name in node.value
            if name not in GIVEN and (value := node[name].number(PARAMETER)) is not None
        ]
    alpha = np.radians(grid) if unit == "deg" else grid
    return Polar(
        np.clip(alpha, -math.pi, math.pi),
        cl,
        cd,
        cm,
        reynolds=node["re"].number(REYNOLDS) if node.has("re") else None,
        configuration=configuration,
        source=source,
        parameters=tuple(parameters),
    )


def require_polars(definition: BladeDefinition, path: Path, tool: str) -> None:
    """Raise unless all airfoils of a blade have polars, without which a tool does not run.

    Raises
    ------
    ExportError
        If some have none.
    """
    from bladegen.definition.blending import without_polars

    bare = without_polars(definition)
    if bare:
        raise ExportError(
            f"{path}: {tool} needs polars, {', '.join(bare[:SHOWN])} have none; --polars estimate "
            "makes some"
        )


def about_quarter(place: Between, reynolds: float) -> tuple[Polar | None, bool]:
    """Return one polar at a place along the span, its moment about the quarter chord.

    Parameters
    ----------
    place : Between
        Between which airfoils.
    reynolds : float
        Of the chord; of several tables of the first configuration the nearest one is taken.

    Returns
    -------
    polar : Polar or None
        None where an airfoil has none.
    moved : bool
        Whether its moment was about another point, from which it was brought here.
    """
    known = place.polars()
    kept = [polar for polar in known if polar.configuration == known[0].configuration]
    if not kept:
        return None, False
    polar = min(kept, key=lambda p: abs(np.log((p.reynolds or reynolds) / reynolds)))
    centre = place.centre
    if centre is None or centre == QUARTER or polar.is_estimate:
        return polar, False
    inner = TURNS[(polar.alpha[0] < TURNS) & (polar.alpha[-1] > TURNS)]
    alpha = np.union1d(polar.alpha, inner)  # the normal force turns with the angle
    cl, cd, cm = polar.at(alpha)
    normal = cl * np.cos(alpha) + cd * np.sin(alpha)
    moment = cm - (centre - QUARTER) * normal
    return replace(polar, alpha=alpha, cl=cl, cd=cd, cm=moment), True
