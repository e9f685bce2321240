"""HAWC2: c2_def and aero of a blade in a partial htc file, its ae and pc files, its airfoils.

Polars (pc) are written where all stations have some (`polar_writing`);
structure (st) is the user's.  Conventions: `reading`.  HAWC2 has no place for
the pitch axis, so it stands in comments behind the sections of c2_def, where our reader finds
it again.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np

from bladegen.definition.blade_definition import THICKNESS_RIPPLE, BladeDefinition, Station
from bladegen.definition.blending import without_polars
from bladegen.definition.conventions import curve_length, line_of_axis
from bladegen.definition.thickness import ruled
from bladegen.errors import Finding
from bladegen.formats.airfoils.folder_writing import write_airfoils
from bladegen.formats.common.number_text import aligned, exact, few, write_lines
from bladegen.formats.common.resampling import common_grid
from bladegen.formats.hawc2.polar_writing import Sets, profile_sets
from bladegen.formats.hawc2.reading import AE_SUFFIX, HALF, PC_SUFFIX
from bladegen.support.arrays import Array

__all__ = ["parts", "write"]


def write(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    """Write a blade for HAWC2: the htc part at `path`, the others beside it.

    Returns what the files cannot hold.
    """
    lines, findings = parts(definition, path)
    write_lines(path, lines)
    return findings


def parts(definition: BladeDefinition, path: Path) -> tuple[list[str], tuple[Finding, ...]]:
    """Write the files that the htc part at `path` names; return its lines, and the findings."""
    definition = ruled(definition)
    stations, thickness = definition.stations, definition.relative_thickness
    assert thickness is not None  # it rules
    eta, loss = common_grid(definition, over_z=True)
    rthick = thickness(eta)
    chord, twist, axis = definition.chord(eta), definition.twist(eta), definition.axis(eta)
    behind, aside = definition.offset_y(eta), definition.offset_x(eta)
    x, y = line_of_axis(axis[:, 0], axis[:, 1], chord, twist, behind, HALF)
    x, y, z = x + aside * np.cos(twist), y - aside * np.sin(twist), axis[:, 2]
    spans, lengths = curve_length(-y, x, z)
    at = {s.eta: float(np.interp(s.eta, eta, rthick)) for s in stations}
    own = {id(s.airfoil): at[s.eta] for s in reversed(stations)}
    whole = z[-1] - z[0]
    along = [float((definition.axis.z(s.eta) - z[0]) / whole) for s in stations]
    placed = [Station(share, s.airfoil) for share, s in zip(along, stations, strict=True)]
    folder = write_airfoils(path, placed, placed=True, thickness=own)
    radius = np.interp(z, spans, lengths)
    ae = path.with_name(f"{path.stem}{AE_SUFFIX}")
    sets = profile_sets(definition, [(s.eta, s.airfoil.name) for s in stations], eta, rthick)
    pc = path.with_name(f"{path.stem}{PC_SUFFIX}")
    if sets is None:
        pc.unlink(missing_ok=True)  # of a blade that had polars
    else:
        write_lines(pc, sets.lines)
    write_lines(ae, _ae(radius, chord, rthick, [1] * len(eta) if sets is None else sets.numbers))
    centreline = np.stack([-y, x, z, -np.degrees(twist)], axis=1)
    named = "" if sets is None else pc.name
    lines = _htc(definition, path, centreline, behind / chord, named)
    found = [
        Finding(
            "c2_def",
            f"{len(eta)} sections for all quantities; between them at most {loss * 1e3:.2f} mm off",
        ),
        Finding("htc", "holds c2_def and aero only; structure (st) is yours"),
        Finding("airfoils", f"HAWC2 has no shapes; they stand in {folder.name}"),
        *_polar_findings(definition, stations, at, sets, pc.name),
    ]
    return lines, (*found, *_findings(definition))


def _htc(
    definition: BladeDefinition, path: Path, centreline: Array, pitch_axis: Array, pc: str
) -> list[str]:
    """Return the lines of the htc file."""
    title = " ".join((definition.description or definition.name).split())
    sections = [
        f"      sec {k + 1:4d} {aligned(row)} ; pitch axis {exact(at)}"
        for k, (row, at) in enumerate(zip(centreline.tolist(), pitch_axis.tolist(), strict=True))
    ]
    return [
        f"; {title}: the geometry of its blade; written by bladegen",
        "; a part of an htc file, to be taken into your own: structure is not in it",
        "; x to the leading edge, y downwind, z to the tip [m], of the half chord; twist [deg]",
        "begin main_body;",
        "    name blade1 ;",
        "    type timoschenko ;",
        "    node_distribution c2_def ;",
        "    begin c2_def;",
        f"      nsec {len(centreline)} ;",
        *sections,
        "    end c2_def ;",
        "end main_body ;",
        "begin aero ;",
        f"    nblades {definition.rotor.blades} ;",
        *(f"    link {k + 1} mbdy_c2_def blade{k + 1} ;" for k in range(definition.rotor.blades)),
        f"    ae_filename ./{path.stem}{AE_SUFFIX} ;",
        *([f"    pc_filename ./{pc} ;"] if pc else []),
        f"    ae_sets {' '.join(['1'] * definition.rotor.blades)} ;",
        "end aero ;",
        "exit ;",
    ]


def _ae(radius: Array, chord: Array, thickness: Array, numbers: list[int]) -> list[str]:
    """Return the lines of the ae file: one set."""
    rows = np.stack([radius, chord, 100.0 * thickness], axis=1).tolist()
    return [
        "1 radius [m] along the half chord, chord [m], thickness [%], polar set",
        f"1 {len(rows)}",
        *(f"{aligned(row)} {k}" for row, k in zip(rows, numbers, strict=True)),
    ]


def _polar_findings(
    definition: BladeDefinition,
    stations: tuple[Station, ...],
    at: dict[float, float],
    sets: Sets | None,
    pc: str,
) -> list[Finding]:
    """Say what became of the polars, or what those that are yours must have."""
    if sets is not None:
        several = {
            station.airfoil.name
            for station in definition.stations
            if len(station.airfoil.polars) > 1
        }
        said = [f"{sets.count} sets in {pc}"]
        if sets.count > 1:
            said.append("one where thickness turns or stays and polars change; ae names them")
        if several:
            said.append(
                f"of several Reynolds numbers the one nearest the chord's: {few(sorted(several))}"
            )
        if sets.moved:
            said.append(f"moments brought to the quarter chord: {few(sorted(set(sets.moved)))}")
        return [Finding("pc", "; ".join(said))]
    every = all(not s.airfoil.polars for s in definition.stations)
    why = "there are none" if every else f"{few(without_polars(definition))} have none"
    found = [Finding("pc", f"polars are not written: {why}; yours must be by thickness")]
    alike: set[str] = set()
    for one, other in pairwise(stations):
        same = one.airfoil is other.airfoil or np.array_equal(
            one.airfoil.coordinates, other.airfoil.coordinates
        )
        if not same and at[one.eta] - at[other.eta] < THICKNESS_RIPPLE:
            alike.add(other.airfoil.name)
    if alike:
        found.append(
            Finding(
                "airfoils",
                f"not thinner than their inner neighbours: {few(sorted(alike))}; HAWC2 tells "
                "polars by thickness alone, so these need a polar set of their own",
            )
        )
    return found


def _findings(definition: BladeDefinition) -> list[Finding]:
    """Say what HAWC2 has no place for."""
    found = [Finding("pitch axis", "HAWC2 has none; it stands in comments of c2_def")]
    if definition.section_offset_x is not None:
        found.append(Finding("section_offset_x", "goes into the half-chord line"))
    if definition.rotor.hub_radius is not None:
        found.append(Finding("rotor", "hub radius, cone and tilt stand in other parts of the htc"))
    return found
