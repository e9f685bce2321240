"""turbinesFoam: elementData, elementProfiles and profileData of axialFlowTurbineALSource.

A row of elementData is (axialDistance radius azimuth chord chordMount pitch), metres and degrees,
at the ends of the elements.  With ``axis (1 0 0)`` in a wind along +x the rotor turns clockwise as
seen from upwind, the axial distance is positive downwind, and the azimuth turns with the rotor:
a point of the blade behind its radial line has a negative one.  The pitch is the twist with the
other sign: a pitch turns the chord by the right hand about the span, from root to tip, which
moves the leading edge downwind (`actuatorLineElement::rotate`).  Points are those of the quarter
chord, so that chordMount is 0.25.
"""

from pathlib import Path

import numpy as np

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import Finding
from bladegen.formats.actuator_lines.elements import ELEMENTS, elements_of, rows, said
from bladegen.formats.common.number_text import one_line, write_lines
from bladegen.formats.common.polars import QUARTER
from bladegen.support.files import folder
from bladegen.support.foam import number, vector

__all__ = ["write"]

TOOL = "turbinesFoam"


def write(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    """Write a blade for turbinesFoam into a folder; return what is to be said of it."""
    made = elements_of(definition, path, TOOL)
    target = folder(path)
    x, y, z = made.points.T
    columns = [
        x,
        np.hypot(y, z),
        np.degrees(np.arctan2(-y, z)),
        made.chord,
        np.full_like(x, QUARTER),
        -np.degrees(made.twist),
    ]
    title = one_line(definition.description or definition.name)
    head = [f"// {title}; written by bladegen"]
    write_lines(
        target / "elementData",
        [
            *head,
            f"// nElements {ELEMENTS}; axis (1 0 0), wind along +x: clockwise seen from upwind",
            "// axialDistance [m]  radius [m]  azimuth [deg]  chord [m]  chordMount  pitch [deg]",
            *(vector(row) for row in np.stack(columns, axis=1).tolist()),
        ],
    )
    write_lines(target / "elementProfiles", [*head, *made.profiles])
    lines = list(head)
    for name, polar in made.tables.items():
        known = [f"    Re {number(polar.reynolds)};"] if polar.reynolds else []
        lines += [name, "{", *known, f'    data (#include "{name}");', "}"]
        table = ["// alpha [deg]  Cl  Cd  Cm", *rows(polar, moment=True)]
        write_lines(target / name, [f"// {said(polar, name)}", *table])
    write_lines(target / "profileData", lines)
    use = Finding(
        path.name,
        f"include elementData, elementProfiles and profileData in fvOptions; nElements {ELEMENTS}, "
        f"rotorRadius {number(made.points[-1, 2])}",
    )
    return (*made.findings, use)
