"""HAWC2: the centreline of a blade in an htc file, and chord and thickness in its ae file.

Conventions (as the published models of the IEA 15 MW and the DTU 10 MW have them): c2_def is the
half-chord line, x toward the leading edge, y toward the suction side (downwind), z to the
tip [m]; twist [deg] of opposite sign to windIO's.  The radius of the ae file runs along that
line and is scaled to its length; the thickness is in per cent.  HAWC2 knows no shapes, only
polars by thickness (`polar_reading`): airfoils are placed where the thickness
meets theirs.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bladegen.definition.blade_definition import (
    Airfoil,
    BladeDefinition,
    Distribution,
    ReferenceAxis,
)
from bladegen.definition.by_thickness import stations_by_thickness
from bladegen.definition.conventions import axis_finding, axis_of_line, curve_length
from bladegen.errors import DefinitionError, Finding
from bladegen.formats.airfoils.folder_reading import beside, placed_airfoils, thick_airfoils
from bladegen.formats.common.document import Notes, Range
from bladegen.formats.common.text_file import head, number, numbers, read_lines, rising
from bladegen.formats.hawc2.model import MAX_LINES, Command, Finder, commands, finder, value
from bladegen.formats.hawc2.polar_reading import Profile, profile_sets, with_profiles
from bladegen.formats.hawc2.rotor import rotor
from bladegen.support.arrays import Array

__all__ = ["AE_SUFFIX", "HALF", "PC_SUFFIX", "blade_name", "read", "recognises"]

AE_SUFFIX = "_ae.dat"
PC_SUFFIX = "_pc.dat"
HALF = 0.5
POSITION = Range(-1000.0, 1000.0, "m")
TWIST = Range(-90.0, 90.0, "deg")
RADIUS = Range(0.0, 1000.0, "m")
CHORD = Range(0.0, 100.0, "m", above=True)
THICKNESS = Range(0.0, 105.0, "%", above=True)
PITCH_AXIS = Range(-1.0, 2.0, "of the chord")
LENGTHS_ALIKE = 0.01  # of the length; ae files that end farther from c2_def's are a finding
EDGE = 2e-3  # of the chord; an airfoil may be so much out of the blade's range and be its end
WHOLE = range(1, 10_000)  # numbers of polar sets
SEVERAL = "names several polar sets; shapes go by thickness alone"
_PITCH_AXIS = re.compile(r";\s*pitch axis\s+([-+0-9.eE]+)")


@dataclass
class _Body:
    """A main_body: its name, and the sections of its c2_def."""

    name: str
    place: str
    sections: list[Command]


def recognises(path: Path) -> bool:
    """Tell whether a file is an htc file, whole or in part."""
    text = head(path).lower()
    return "begin" in text or "continue_in_file" in text


def read(path: Path, notes: Notes, airfoils: Path | None = None) -> BladeDefinition | None:
    """Read a blade; None if there are problems, which `notes` then holds."""
    find = finder(path)
    lines = commands(path, find, notes)
    body = _blade_body(lines, notes)
    if body is None:
        return None
    columns = _centreline(body, notes)
    table = _ae(path, lines, find, notes)
    if columns is None or table is None:
        return None
    folder = beside(path, airfoils, notes)
    placed = () if folder is None else placed_airfoils(folder, notes)
    shapes = [] if folder is None or placed else thick_airfoils(folder, notes)
    if notes.problems:
        return None
    (ahead, downwind, z, turn, pitch_axis), (radius, chord, thickness, polar_sets) = columns, table
    sets = _profiles(lines, find, notes)
    eta = (z - z[0]) / (z[-1] - z[0])
    spans, lengths = curve_length(ahead, downwind, z)
    stated, measured = float(radius[-1]), float(lengths[-1])
    if abs(stated - measured) > LENGTHS_ALIKE * measured:
        notes.findings.append(
            Finding("ae", f"ends at {stated:g} m, c2_def is {measured:g} m long; scaled to it")
        )
    at = np.interp(radius / stated * measured, lengths, spans)
    grid = np.clip((at - z[0]) / (z[-1] - z[0]), 0.0, 1.0)
    chords, rthick = Distribution(grid, chord), Distribution(grid, thickness / 100.0)
    twist = -np.radians(turn)
    line = axis_of_line(downwind, -ahead, chords(eta), twist, HALF, pitch_axis)
    if pitch_axis is None:
        notes.findings.append(axis_finding("c2_def", line))
    try:
        stations = placed or stations_by_thickness(_within(shapes, rthick, notes), rthick)
        if sets:
            stations = with_profiles(stations, sets, grid, polar_sets, rthick, notes)
        elif len(set(polar_sets.tolist())) > 1:
            notes.findings.append(Finding("ae", SEVERAL))
        return BladeDefinition(
            name=path.stem,
            stations=stations,
            chord=chords,
            twist=Distribution(eta, twist),
            axis=ReferenceAxis(
                Distribution(eta, line.x), Distribution(eta, line.y), Distribution(eta, z)
            ),
            pitch_axis=Distribution(eta, line.offset / chords(eta)),
            relative_thickness=rthick,
            rotor=rotor(lines, body.name),
            source=str(path),
            findings=tuple(notes.findings),
        )
    except DefinitionError as error:
        notes.problems.append(str(error))
        return None


def blade_name(path: Path, notes: Notes) -> str | None:
    """Return the name of the main_body that is the blade, lower case; None if there is none."""
    body = _blade_body(commands(path, finder(path), notes), notes)
    return None if body is None else body.name


def _blade_body(lines: list[Command], notes: Notes) -> _Body | None:
    """Return the main_body that is the blade: the one that aero links to, else by its name."""
    bodies: list[_Body] = []
    linked, open_blocks = "", []
    for line in lines:
        words = [word.lower() for word in line.words]
        if words[0] == "begin" and len(words) > 1:
            open_blocks.append(words[1])
            if words[1] == "main_body":
                bodies.append(_Body("", line.place, []))
        elif words[0] == "end" and open_blocks:
            open_blocks.pop()
        elif open_blocks[-1:] == ["main_body"] and words[0] == "name" and bodies and len(words) > 1:
            bodies[-1].name = words[1]
        elif open_blocks[-1:] == ["c2_def"] and words[0] == "sec" and bodies:
            bodies[-1].sections.append(line)
        elif words[0] == "link" and len(words) > 3 and words[2] == "mbdy_c2_def" and not linked:
            linked = words[3]
    held = [body for body in bodies if body.sections]
    for chosen in (
        [body for body in held if body.name == linked],
        [body for body in held if "blade" in body.name],
        held if len(held) == 1 else [],
    ):
        if chosen:
            return chosen[0]
    names = ", ".join(body.name or "without name" for body in bodies) or "none"
    notes.problems.append(
        "main_body: no blade with c2_def; must be the one that aero links to, or named blade; "
        f"got {names}"
    )
    return None


def _centreline(
    body: _Body, notes: Notes
) -> tuple[Array, Array, Array, Array, Array | None] | None:
    """Return x, y, z [m], twist [deg] of c2_def as they stand, and the pitch axis if noted."""
    rows, places = [line.words for line in body.sections], [line.place for line in body.sections]
    short = [k for k, row in enumerate(rows) if len(row) < 6]
    if short or len(rows) < 2:
        at = places[short[0]] if short else body.place
        notes.problems.append(
            f"{at}, c2_def: must be rows of sec, number, x, y, z, twist, at least 2"
        )
        return None
    fields = (("x", POSITION), ("y", POSITION), ("z", POSITION), ("twist", TWIST))
    columns = [
        numbers([row[k + 2] for row in rows], places, f"c2_def {name}", allowed, notes)
        for k, (name, allowed) in enumerate(fields)
    ]
    x, y, z, twist = columns
    if x is None or y is None or z is None or twist is None:
        return None
    if not rising(z, places, "c2_def z", notes):
        return None
    noted = [_PITCH_AXIS.search(line.comment) for line in body.sections]
    axis = [number(match[1]) if match else None for match in noted]
    pitch_axis = None
    if None not in axis and PITCH_AXIS.holds([value for value in axis if value is not None]).all():
        pitch_axis = np.array(axis, dtype=np.float64)
    return x, y, z, twist, pitch_axis


def _ae(path: Path, lines: list[Command], find: Finder, notes: Notes) -> tuple[Array, ...] | None:
    """Return radius and chord [m], thickness [%] and polar set of the blade's ae rows."""
    name, wanted = value(lines, "ae_filename"), number(value(lines, "ae_sets") or "1")
    found = find(name)
    if found is None:
        own = path.with_name(f"{path.stem}{AE_SUFFIX}")
        if not own.is_file():
            notes.problems.append(
                f"ae_filename: got {name[:60] or 'nothing'!r}, must be a file of this model; "
                f"or put chord and thickness into {own.name} beside this file"
            )
            return None
        found = own
    text = read_lines(found)
    k = 1
    while k < len(text):
        stated = [number(word) for word in text[k].split()[:2]]
        if len(stated) < 2 or None in stated or not 2 <= (stated[1] or 0) <= MAX_LINES:
            break
        count = int(stated[1] or 0)
        if stated[0] == wanted:
            return _ae_set(found.name, text[k + 1 : k + 1 + count], k + 2, count, notes)
        k += 1 + count
    notes.problems.append(f"{found.name}: holds no set {wanted:g} (a row of its number and rows)")
    return None


def _ae_set(
    name: str, text: list[str], first: int, count: int, notes: Notes
) -> tuple[Array, ...] | None:
    """Return the columns of one set of an ae file."""
    rows = [line.split() for line in text]
    short = [k for k, row in enumerate(rows) if len(row) < 3]
    if short or len(rows) < count:
        at = first + (short[0] if short else len(rows))
        notes.problems.append(
            f"{name}, line {at}: must be radius, chord, thickness, polar set, in {count} rows"
        )
        return None
    places = [f"{name}, line {first + k}" for k in range(count)]
    fields = (("radius", RADIUS), ("chord", CHORD), ("thickness", THICKNESS))
    radius, chord, thickness = (
        numbers([row[k] for row in rows], places, field, allowed, notes)
        for k, (field, allowed) in enumerate(fields)
    )
    if radius is None or chord is None or thickness is None:
        return None
    if not rising(radius, places, "radius", notes):
        return None
    stated = [number(row[3]) if len(row) > 3 else 1.0 for row in rows]
    sets = [value if value is not None and value in WHOLE else 0.0 for value in stated]
    return radius, chord, thickness, np.array(sets)


def _profiles(lines: list[Command], find: Finder, notes: Notes) -> list[list[Profile]]:
    """Return the sets of the pc file that aero names; none if it is out of reach."""
    name = value(lines, "pc_filename")
    if not name:
        return []
    found = find(name)
    if found is None:
        said = f"{name[:60]!r} is no file of this model; polars left out"
        notes.findings.append(Finding("pc_filename", said))
        return []
    return profile_sets(found, notes)


def _within(
    shapes: list[tuple[float, Airfoil]], rthick: Distribution, notes: Notes
) -> list[tuple[float, Airfoil]]:
    """Leave out airfoils that are thicker or thinner than the blade anywhere is."""
    low, high = rthick.values.min() - EDGE, rthick.values.max() + EDGE
    kept = [(thick, airfoil) for thick, airfoil in shapes if low <= thick <= high]
    out = [f"{airfoil.name} ({thick:.3f})" for thick, airfoil in shapes if not low <= thick <= high]
    if out:
        notes.findings.append(
            Finding(
                "airfoils", f"not used, thinner or thicker than the blade: {', '.join(out[:5])}"
            )
        )
    if not kept:
        raise DefinitionError(
            f"airfoils: none is {low:.3f} to {high:.3f} of the chord thick, as the blade is"
        )
    return [
        (float(np.clip(thick, rthick.values.min(), rthick.values.max())), a) for thick, a in kept
    ]
