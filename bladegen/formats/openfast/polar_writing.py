"""OpenFAST: airfoil files with polars, and the lines of AeroDyn's main input that list them.

Layout AirfoilInfo v1.01 of OpenFAST 3 to 5 (`polar_reading`).  AeroDyn takes
angles from -180 to 180 degrees and, where there are several Reynolds numbers, one table each.
Constants of unsteady aerodynamics that are not known are DEFAULT: AeroDyn finds them from the
table.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from bladegen.airfoils.polars import Polar
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.blending import between, completed
from bladegen.definition.estimates import chord_reynolds
from bladegen.formats.common.number_text import aligned, exact, one_line
from bladegen.formats.openfast.polar_reading import CONSTANTS, MILLION, UNKNOWN

__all__ = ["Tables", "info", "part", "tables_at"]

DIGITS = 12  # of angles in degrees, so that those of a file in degrees come back
VALUE = 24  # columns of a value before its label
LABEL = 12
REST = (  # of AeroDyn's main input, between AFTabMod and the files
    (1, "InCol_Alfa", "the column of the angle of attack"),
    (2, "InCol_Cl", "the column of the lift coefficient"),
    (3, "InCol_Cd", "the column of the drag coefficient"),
    (4, "InCol_Cm", "the column of the moment coefficient"),
    (0, "InCol_Cpmin", "the column of Cpmin; there is none"),
)


@dataclass(frozen=True)
class Tables:
    """The polars of a node, as AeroDyn takes them.

    Parameters
    ----------
    polars : tuple of Polar
        From -180 to 180 degrees, their Reynolds numbers increasing.
    reynolds : float
        What is written where a polar knows none: that of the chord.
    reference : float, optional
        The point that they are about, of the chord, where that is known.
    """

    polars: tuple[Polar, ...]
    reynolds: float
    reference: float | None = None

    def alike(self, other: "Tables") -> bool:
        """Tell whether both hold the same figures and say the same of them."""
        return len(self.polars) == len(other.polars) and all(
            (one.reynolds, one.source, one.parameters) == (two.reynolds, two.source, two.parameters)
            and one.has_figures_of(two)
            for one, two in zip(self.polars, other.polars, strict=True)
        )


def tables_at(definition: BladeDefinition, spans: Sequence[float]) -> list[Tables]:
    """Return the polars of a blade at span fractions, blended between its airfoils.

    Where an airfoil has several configurations the first one is taken.
    """
    found = []
    for eta in spans:
        place = between(definition, eta)
        kept = _ordered(place.polars())
        reference = place.centre if kept and not kept[0].is_estimate else None
        polars = tuple(map(completed, kept))
        found.append(Tables(polars, chord_reynolds(definition, eta), reference))
    return found


def _ordered(polars: Sequence[Polar]) -> list[Polar]:
    """Return the polars of the first configuration by Reynolds number, one if unknown."""
    kept = [polar for polar in polars if polar.configuration == polars[0].configuration]
    kept.sort(key=lambda polar: polar.reynolds or 0.0)
    known = [polar.reynolds or 0.0 for polar in kept]
    return kept if all(a < b for a, b in pairwise([0.0, *known])) else kept[:1]


def info(name: str, coordinates: str, thickness: float, tables: Tables) -> list[str]:
    """Return the lines of an airfoil file.

    Parameters
    ----------
    name : str
        What the airfoil is called, in a comment.
    coordinates : str
        The name of the file of its coordinates, in the same folder.
    thickness : float
        Over the chord.
    tables : Tables
        Its polars.
    """
    lines = [
        "! ------------ AirfoilInfo v1.01.x Input File -----------------------------------",
        f"! airfoil: {one_line(name)}",
        "! written by bladegen; the source of each table stands before it",
        _entry("DEFAULT", "InterpOrd", "interpolation in the tables"),
        _entry(exact(round(thickness, 9)), "RelThickness", "thickness over chord"),
        _entry(1, "NonDimArea", "area over chord squared; AeroDyn does not use it"),
        _entry(f'@"{coordinates}"', "NumCoords", "file of coordinates"),
        _entry('"unused"', "BL_file", "boundary layers, for noise"),
        _entry(len(tables.polars), "NumTabs", "tables, one a Reynolds number"),
    ]
    for k, polar in enumerate(tables.polars):
        lines += [
            f"! {'-' * 78}",
            f"! data for table {k + 1}",
            *([f"! source: {one_line(polar.source)}"] if polar.source else []),
            f"! configuration: {one_line(polar.configuration) or 'default'}",
            *([] if polar.reynolds else [f"! reynolds: {UNKNOWN}"]),
            *_table(polar, polar.reynolds or tables.reynolds),
        ]
    return lines


def part(blade: str, files: Sequence[str], count: int, blades: int) -> list[str]:
    """Return the lines of AeroDyn's main input that name a blade's files.

    Parameters
    ----------
    blade : str
        The blade file's name.
    files : sequence of str
        The airfoil files, in the order of BlAFID.
    count : int
        The most tables that one of them has.
    blades : int
        Of the rotor.
    """
    mode = (2, "by angle and Reynolds number") if count > 1 else (1, "by angle of attack")
    return [
        "------- LINES OF AERODYN'S MAIN INPUT that name this blade; written by bladegen --------",
        "Put them in place of yours, and the files where these names find them.",
        "======  Airfoil Information " + "=" * 60,
        _entry(mode[0], "AFTabMod", f"interpolation {mode[1]}"),
        *(_entry(*row) for row in REST),
        _entry(len(files), "NumAFfiles", "airfoil files"),
        _entry(f'"{files[0]}"', "AFNames", "in the order of BlAFID"),
        *(f'"{name}"' for name in files[1:]),
        "======  Rotor/Blade Properties " + "=" * 57,
        _entry("True", "UseBlCm", "the moment is in the tables"),
        *(_entry(f'"{blade}"', f"ADBlFile({k + 1})") for k in range(blades)),
    ]


def _table(polar: Polar, reynolds: float) -> list[str]:
    """Return the lines of one table from its Reynolds number on."""
    known = dict(polar.parameters)
    rows = np.stack(
        [np.degrees(polar.alpha).round(DIGITS), polar.cl, polar.cd, polar.cm], axis=1
    ).tolist()
    return [
        _entry(exact(reynolds / MILLION), "Re", "Reynolds number in millions"),
        _entry(0, "UserProp", "control setting"),
        _entry("True", "InclUAdata", "constants of unsteady aerodynamics; AeroDyn finds DEFAULT"),
        *(
            _entry(exact(known[theirs]) if theirs in known else "DEFAULT", ours)
            for ours, theirs in CONSTANTS.items()
        ),
        _entry(len(rows), "NumAlf", "rows"),
        "! " + aligned(["Alpha", "Cl", "Cd", "Cm"]),
        "! " + aligned(["(deg)", "(-)", "(-)", "(-)"]),
        *(f"  {aligned(row)}" for row in rows),
    ]


def _entry(value: object, label: str, said: str = "") -> str:
    """Return a line of a value, its label and what it means."""
    line = f"{value!s:<{VALUE - 1}} {label:<{LABEL}}"
    return f"{line} ! {said}" if said else line.rstrip()
