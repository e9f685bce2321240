"""From the columns of a spanwise table, in SI units, to a blade definition.

Columns have a value a row, NaN where the table has none: each quantity keeps the rows that hold
it as its grid.  What a plain table usually leaves out is taken as usual, and said.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bladegen.definition.blade_definition import (
    Airfoil,
    BladeDefinition,
    Distribution,
    ReferenceAxis,
    Station,
)
from bladegen.definition.by_thickness import stations_by_thickness
from bladegen.errors import DefinitionError, Finding
from bladegen.formats.common.document import Notes
from bladegen.support.arrays import Array

__all__ = ["Library", "Schedule", "assemble", "span_fractions"]

Schedule = list[tuple[float, str, int]]  # span fraction, airfoil, row of the file
QUARTER = 0.25  # of the chord, from the leading edge


@dataclass(frozen=True)
class Library:
    """Where the airfoils of a table come from.

    Parameters
    ----------
    named : callable
        From names to airfoils; notes what is missing.
    every : callable
        All airfoils, each with its relative thickness.
    """

    named: Callable[[list[str]], dict[str, Airfoil]]
    every: Callable[[], list[tuple[float, Airfoil]]]


def assemble(
    path: Path,
    values: dict[str, Array],
    rows: tuple[int, ...],
    schedule: Schedule,
    library: Library,
    notes: Notes,
) -> BladeDefinition | None:
    """Make a definition; None if there are problems, which `notes` then holds.

    Parameters
    ----------
    path : Path
        The file.
    values : dict of (m,) arrays
        By the keys of `table`: eta, z, chord, twist, ...; NaN where there is none.
    rows : tuple of int
        The table's rows in the file.
    schedule : list of (eta, name, row)
        Airfoils along the span; if empty, they are placed by thickness.
    library : Library
        Where the airfoils are.
    """
    eta = span_fractions(values, rows, notes)
    if eta is None:
        return None
    missing = [key for key in ("z", "chord", "twist") if key not in values]
    if missing:
        notes.problems.append(
            f"columns: {', '.join(missing)} missing, must be given, such as z_m, chord_m, twist_deg"
        )
        return None
    if "thickness" in values and "rthick" not in values:
        full = ~np.isnan(values["chord"])
        chord = np.interp(eta, eta[full], values["chord"][full])
        values = {**values, "rthick": values["thickness"] / chord}
    curves = {key: _curve(key, eta, column, notes) for key, column in values.items()}
    z, chord_curve, twist = curves["z"], curves["chord"], curves["twist"]
    if notes.problems or z is None or chord_curve is None or twist is None:
        return None
    rthick = curves.get("rthick")
    try:
        stations = _stations(schedule, rthick, library, notes)
        if notes.problems:
            return None
        offset_y, pitch_axis = curves.get("offset_y"), curves.get("pitch_axis")
        if offset_y is None and pitch_axis is None:
            notes.findings.append(
                Finding("pitch_axis", f"is not given; taken as {QUARTER:g} of the chord")
            )
            pitch_axis = Distribution.constant(QUARTER)
        if offset_y is not None and pitch_axis is not None:
            notes.findings.append(
                Finding("pitch_axis", "is passed over, since section_offset_y is given")
            )
            pitch_axis = None
        return BladeDefinition(
            name=path.stem,
            stations=stations,
            chord=chord_curve,
            twist=twist,
            axis=ReferenceAxis(
                _or_zero("prebend", curves, notes), _or_zero("sweep", curves, notes), z
            ),
            section_offset_y=offset_y,
            pitch_axis=pitch_axis,
            section_offset_x=curves.get("offset_x"),
            relative_thickness=rthick,
            source=str(path),
            findings=tuple(notes.findings),
        )
    except DefinitionError as error:
        notes.problems.append(str(error))
        return None


def span_fractions(values: dict[str, Array], rows: tuple[int, ...], notes: Notes) -> Array | None:
    """Return the rows' span fractions: as given, or z over the length."""
    if "eta" in values:
        key, span = "eta", np.clip(values["eta"], 0.0, 1.0)
    elif "z" in values:
        key, z = "z", values["z"]
        span = (z - z[0]) / (z[-1] - z[0]) if len(z) > 1 and z[-1] > z[0] else z
    else:
        notes.problems.append("columns: no span, must have eta (0 to 1) or z_m")
        return None
    empty = np.flatnonzero(np.isnan(span))
    if empty.size:
        notes.problems.append(f"row {rows[empty[0]]}, {key}: is empty, must be given in every row")
        return None
    bad = np.flatnonzero(~(np.diff(span) > 0)) + 1
    for i in bad[:3]:
        before, here = values[key][i - 1], values[key][i]
        notes.problems.append(f"row {rows[i]}, {key}: got {here:g} after {before:g}, must increase")
    return None if bad.size or len(span) < 2 else span


def _curve(key: str, eta: Array, column: Array, notes: Notes) -> Distribution | None:
    """Return a quantity on the rows that hold it."""
    held = ~np.isnan(column)
    if held.sum() < 2:
        notes.problems.append(f"{key}: {held.sum()} values, at least 2 are needed")
        return None
    grid = eta[held]
    if grid[0] > 0 or grid[-1] < 1:
        notes.findings.append(
            Finding(key, f"runs from {grid[0]:g} to {grid[-1]:g}; beyond it the end value is held")
        )
    return Distribution(grid, column[held])


def _or_zero(key: str, curves: dict[str, Distribution | None], notes: Notes) -> Distribution:
    curve = curves.get(key)
    if curve is None:
        notes.findings.append(Finding(key, "is not given; taken as 0"))
        return Distribution.constant(0.0)
    return curve


def _stations(
    schedule: Schedule, rthick: Distribution | None, library: Library, notes: Notes
) -> tuple[Station, ...]:
    """Place the airfoils: where the schedule says, else where the thickness meets theirs."""
    if not schedule:
        if rthick is None:
            notes.problems.append(
                "airfoil: no names and no relative thickness, must have one of these columns"
            )
            return ()
        every = library.every()
        return () if notes.problems else stations_by_thickness(every, rthick)
    found = library.named([name for _, name, _ in schedule])
    if any(name not in found for _, name, _ in schedule):
        return ()
    stations: list[Station] = []
    for eta, name, row in schedule:
        if stations and eta <= stations[-1].eta:
            notes.problems.append(
                f"row {row}, airfoil: {name} at {eta:g} follows {stations[-1].eta:g}, must increase"
            )
            return ()
        stations.append(Station(eta, found[name]))
    if stations[0].eta > 0:
        notes.findings.append(
            Finding("airfoil", f"{schedule[0][1]} at {stations[0].eta:g} is held to the root")
        )
        stations.insert(0, Station(0.0, stations[0].airfoil))
    if stations[-1].eta < 1:
        notes.findings.append(
            Finding("airfoil", f"{schedule[-1][1]} at {stations[-1].eta:g} is held to the tip")
        )
        stations.append(Station(1.0, stations[-1].airfoil))
    return tuple(stations)
