"""A blade as the elements of an actuator line: where they are, chord, twist, one polar each.

Rotor frame: x along the axis, downwind; the blade points to z, its precone leans it to -x; y to the
trailing edge.  A rotor turns clockwise as seen from upwind, about +x.  Elements divide the span
evenly, as cells of a flow do.  Their points are those of the quarter chord, about which polars are.
Neither code blends polars, so an element has its own, blended between the blade's airfoils as
everywhere (`definition.blending`); elements that share one share its table.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from bladegen.airfoils.polars import Polar
from bladegen.definition.blade_definition import BladeDefinition, Rotor
from bladegen.definition.blending import Between, between, completed
from bladegen.definition.conventions import line_of_axis
from bladegen.definition.estimates import chord_reynolds
from bladegen.errors import ExportError, Finding
from bladegen.formats.common.number_text import few, one_line
from bladegen.formats.common.polars import QUARTER, about_quarter, require_polars
from bladegen.support.arrays import Array
from bladegen.support.files import safe_stem
from bladegen.support.foam import vector

__all__ = ["ELEMENTS", "Elements", "elements_of", "rows", "said"]

ENDS = (0.0, 1.0)
ALIKE = 1e-4  # of angles [rad] and coefficients; elements whose polars differ by less share one
ELEMENTS = 40  # of a blade; SOWFA's examples have as many points, published tables 17 to 50


@dataclass(frozen=True, eq=False)
class Elements:
    """The elements of a blade.

    Parameters
    ----------
    rotor : Rotor
        Its number of blades, hub radius, cone and tilt, all of them known.
    tip_radius : float
        Hub radius and length of the blade, along it [m].
    points : (n + 1, 3) array
        Ends of the elements, rotor frame [m].
    radius : (n + 1,) array
        Ends of the elements, from the axis along the blade [m].
    chord, twist : (n + 1,) arrays
        There [m], [rad]; positive twist moves the leading edge upwind.
    middles : (3, n) array
        Radius along the blade, chord and twist of the elements' middles.
    thickness : (n,) array
        There, over chord.
    profiles : tuple of str
        The name of each element's table.
    tables : dict of str to Polar
        From -180 to 180 degrees.
    findings : tuple of Finding
        What is to be said of them.
    """

    rotor: Rotor
    tip_radius: float
    points: Array
    radius: Array
    chord: Array
    twist: Array
    middles: Array
    thickness: Array
    profiles: tuple[str, ...]
    tables: dict[str, Polar]
    findings: tuple[Finding, ...]


def elements_of(definition: BladeDefinition, path: Path, tool: str) -> Elements:
    """Divide a blade into elements.

    Parameters
    ----------
    definition : BladeDefinition
        Its airfoils have polars, its rotor a hub radius.
    path : Path
        What is to be written, for errors.
    tool : str
        For which code.

    Raises
    ------
    ExportError
        If there are no polars, or no hub radius.
    """
    from bladegen.definition.thickness import ruled

    require_polars(definition, path, tool)
    definition = ruled(definition)
    facts = definition.rotor
    if facts.hub_radius is None or facts.hub_radius <= 0.0:
        raise ExportError(
            f"{path}: {tool} measures radii from the axis, and the definition names no hub radius; "
            "give one (--hub-radius LENGTH, such as 2m)"
        )
    cone = facts.cone or 0.0
    rotor = replace(facts, cone=cone, tilt=facts.tilt or 0.0)
    spans = np.linspace(0.0, 1.0, 2 * ELEMENTS + 1)
    axis = definition.axis(spans)
    span = axis[:, 2] - axis[0, 2]
    eta = np.interp(np.linspace(0.0, span[-1], 2 * ELEMENTS + 1), span, spans)
    axis, chord, twist = definition.axis(eta), definition.chord(eta), definition.twist(eta)
    behind, aside = definition.offset_y(eta), definition.offset_x(eta)
    x, y = line_of_axis(axis[:, 0], axis[:, 1], chord, twist, behind, QUARTER)
    x, y = x + aside * np.cos(twist), y - aside * np.sin(twist)
    radius = facts.hub_radius + axis[:, 2] - axis[0, 2]
    c, s = np.cos(cone), np.sin(cone)
    points = np.stack([c * x - s * radius, y, s * x + c * radius], axis=-1)
    thickness = definition.relative_thickness
    assert thickness is not None  # `ruled` saw to it
    tables: dict[str, Polar] = {}
    moved: dict[str, None] = {}
    profiles = []
    for at in eta[1::2].tolist():
        place = between(definition, at)
        polar, brought = about_quarter(place, chord_reynolds(definition, at))
        assert polar is not None  # all airfoils have some
        if brought:
            moved[place.near.name] = None
        profiles.append(_named(place, completed(polar), tables))
    found = [
        Finding("elements", f"{ELEMENTS} of one length, {len(tables)} tables of polars"),
        Finding(
            "twist, chord, polars",
            "all of an element's middle or ends; moments are about the quarter chord",
        ),
    ]
    if moved:
        found.append(Finding("polars", f"moments brought to the quarter chord: {few([*moved])}"))
    return Elements(
        rotor,
        float(radius[-1]),
        points[::2],
        radius[::2],
        chord[::2],
        twist[::2],
        np.stack([radius, chord, twist])[:, 1::2],
        thickness(eta[1::2]),
        tuple(profiles),
        tables,
        tuple(found),
    )


def _named(place: Between, polar: Polar, tables: dict[str, Polar]) -> str:
    """Return the name of a polar among tables, to which it is added if none is like it."""
    for name, known in tables.items():
        if _alike(known, polar):
            return name
    name = safe_stem(place.near.name)
    if place.weight not in ENDS and place.one.name != place.other.name:
        share = f"{100.0 * place.weight:.3g}".replace(".", "p")
        name = f"{safe_stem(place.one.name)}_{safe_stem(place.other.name)}_{share}"
    stem, count = name, 1
    while name in tables:
        count += 1
        name = f"{stem}_{count}"
    tables[name] = polar
    return name


def _alike(one: Polar, other: Polar) -> bool:
    """Tell whether two polars are the same to what a table is worth."""
    return len(one.alpha) == len(other.alpha) and all(
        np.abs(getattr(one, key) - getattr(other, key)).max() < ALIKE
        for key in ("alpha", "cl", "cd", "cm")
    )


def rows(polar: Polar, *, moment: bool) -> list[str]:
    """Return the rows of a table: angle [deg], lift, drag, and the moment if it is asked for."""
    columns = [np.degrees(polar.alpha).round(9), polar.cl, polar.cd]
    columns += [polar.cm] if moment else []
    return [vector(row) for row in np.stack(columns, axis=1).tolist()]


def said(polar: Polar, name: str) -> str:
    """Return a line on where a polar is from."""
    number = f", Re = {polar.reynolds:.4g}" if polar.reynolds else ""
    return one_line(f"{name}{number}: {polar.source or 'of the definition'}")
