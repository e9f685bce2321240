"""SOWFA: the lines of a turbineProperties file that describe the blade, and airfoilProperties.

A row of BladeData is (radius chord twist airfoil), at the elements' middles: radius from the axis
along the blade [m], twist [deg] with windIO's sign, positive towards the wind; the airfoil is its
place in the list Airfoils.  The advanced model's rows have the thickness over chord, a number of
the user's, and then the airfoil.  As in FAST, PreCone and ShftTilt are negative for a rotor whose
tips lean upwind and whose shaft is tilted up; with ``rotationDir "cw"`` it turns clockwise as seen
from upwind.  Generator, controllers, tower and nacelle are the user's.
"""

from pathlib import Path

import numpy as np

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import Finding
from bladegen.formats.actuator_lines.elements import Elements, elements_of, rows, said
from bladegen.formats.common.number_text import one_line, write_lines
from bladegen.support.files import folder, safe_stem
from bladegen.support.foam import dictionary, number, vector

__all__ = ["write"]

TOOL = "SOWFA"
USER = 0.0  # of the advanced model's rows


def write(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    """Write a blade for SOWFA into a folder; return what is to be said of it."""
    made = elements_of(definition, path, TOOL)
    title = one_line(definition.description or definition.name)
    stem = safe_stem(definition.name)
    turbines, airfoils = (
        folder(folder(path) / name) for name in ("turbineProperties", "airfoilProperties")
    )
    note = f"{title}: its blade; written by bladegen\nyours: generator, controllers, tower, nacelle"
    for name, advanced in ((stem, False), (f"{stem}_advanced", True)):
        text = dictionary("turbineProperties", _turbine(made, advanced), note=note)
        write_lines(turbines / name, text.splitlines())
    for name, polar in made.tables.items():
        table = {"airfoilData": rows(polar, moment=False)}
        note = f"{said(polar, name)}\nalpha [deg]  Cl  Cd"
        text = dictionary("airfoilProperties", table, note=note)
        write_lines(airfoils / name, text.splitlines())
    use = Finding(
        path.name,
        "both folders go into constant/; BladeData of the advanced model stands in "
        f"{stem}_advanced; add generator, controllers, tower and nacelle",
    )
    return (*made.findings, use)


def _turbine(made: Elements, advanced: bool) -> dict[str, object]:
    """Return the entries of a turbineProperties file that are the blade's."""
    rotor, names = made.rotor, list(made.tables)
    radius, chord, twist = made.middles
    columns = [radius, chord, np.degrees(twist)]
    columns += [made.thickness, np.full_like(chord, USER)] if advanced else []
    which = [names.index(name) for name in made.profiles]
    table = np.stack(columns, axis=1).tolist()
    return {
        "NumBl": rotor.blades,
        "TipRad": made.tip_radius,
        "HubRad": rotor.hub_radius,
        "ShftTilt": -np.degrees(rotor.tilt or 0.0),
        "PreCone": vector([-np.degrees(rotor.cone or 0.0)] * rotor.blades),
        "Airfoils": [f'"{name}"' for name in names],
        "BladeData": [
            f"{vector(row)[:-1]} {number(k)})" for row, k in zip(table, which, strict=True)
        ],
    }
