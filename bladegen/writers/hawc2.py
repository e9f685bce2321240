"""HAWC2: c2_def and aero of a blade in a partial htc file, its ae file, airfoils by thickness.

The files hold the geometry only; structure (st) and polars (pc) are the user's.  Conventions:
`bladegen.readers.hawc2`.  HAWC2 has no place for the pitch axis, so it stands in comments behind
the sections of c2_def, where our reader finds it again.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np

from bladegen.arrays import Array
from bladegen.blade import Blade
from bladegen.conventions import curve_length, line_of_axis
from bladegen.definition import THICKNESS_RIPPLE, Airfoil, BladeDefinition, Station
from bladegen.errors import Finding
from bladegen.readers.hawc2 import AE_SUFFIX, HALF
from bladegen.resampling import common_grid, shape_grid
from bladegen.writers.airfoil_folder import write_airfoils
from bladegen.writers.text import aligned, exact, write_lines

__all__ = ["write"]

LANDMARKS = 401
SHOWN = 4  # airfoils that a finding names


def write(definition: BladeDefinition, path: Path) -> tuple[Finding, ...]:
    """Write a blade for HAWC2: the htc part at `path`, the others beside it.

    Returns what the files cannot hold.
    """
    eta, loss = common_grid(definition, over_z=True)
    eta, rthick, stations = _shapes(definition, eta)
    chord, twist, axis = definition.chord(eta), definition.twist(eta), definition.axis(eta)
    behind, aside = definition.offset_y(eta), definition.offset_x(eta)
    x, y = line_of_axis(axis[:, 0], axis[:, 1], chord, twist, behind, HALF)
    x, y, z = x + aside * np.cos(twist), y - aside * np.sin(twist), axis[:, 2]
    spans, lengths = curve_length(-y, x, z)
    at = {s.eta: float(np.interp(s.eta, eta, rthick)) for s in stations}
    thickness = {id(s.airfoil): at[s.eta] for s in reversed(stations)}
    whole = z[-1] - z[0]
    along = [float((definition.axis.z(s.eta) - z[0]) / whole) for s in stations]
    placed = [Station(share, s.airfoil) for share, s in zip(along, stations, strict=True)]
    folder = write_airfoils(path, placed, placed=True, thickness=thickness)
    radius = np.interp(z, spans, lengths)
    ae = path.with_name(f"{path.stem}{AE_SUFFIX}")
    write_lines(ae, _ae(radius, chord, rthick))
    centreline = np.stack([-y, x, z, -np.degrees(twist)], axis=1)
    write_lines(path, _htc(definition, path, centreline, behind / chord))
    found = [
        Finding(
            "c2_def",
            f"{len(eta)} sections for all quantities; between them at most {loss * 1e3:.2f} mm off",
        ),
        Finding("htc", "holds c2_def and aero only; structure (st) and polars (pc) are yours"),
        Finding("airfoils", f"HAWC2 has no shapes; they stand in {folder.name}"),
    ]
    return (*found, *_findings(definition, stations, at))


def _shapes(definition: BladeDefinition, eta: Array) -> tuple[Array, Array, tuple[Station, ...]]:
    """Return the grid, the thickness there, and airfoils that this thickness blends rightly.

    Between airfoils, shape follows thickness once there is a distribution of it; where the
    definition has none, its sections are written at the whole grid instead of its stations.
    """
    if definition.relative_thickness is not None:
        return eta, definition.relative_thickness(eta), definition.stations
    blade = Blade.from_definition(definition, landmarks=LANDMARKS)
    eta = shape_grid(blade, eta)
    names = {station.eta: station.airfoil.name for station in definition.stations}
    sections = blade.profiles(eta)
    stations = [
        Station(at, Airfoil(names.get(at, f"section at eta = {at:.5f}"), points))
        for at, points in zip(eta.tolist(), sections, strict=True)
    ]
    return eta, blade.splines.fit(sections).relative_thickness, tuple(stations)


def _htc(
    definition: BladeDefinition, path: Path, centreline: Array, pitch_axis: Array
) -> list[str]:
    """Return the lines of the htc file."""
    title = " ".join((definition.description or definition.name).split())
    sections = [
        f"      sec {k + 1:4d} {aligned(row)} ; pitch axis {exact(at)}"
        for k, (row, at) in enumerate(zip(centreline.tolist(), pitch_axis.tolist(), strict=True))
    ]
    return [
        f"; {title}: the geometry of its blade; written by bladegen",
        "; a part of an htc file, to be taken into your own: structure and polars are not in it",
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
        f"    ae_sets {' '.join(['1'] * definition.rotor.blades)} ;",
        "end aero ;",
        "exit ;",
    ]


def _ae(radius: Array, chord: Array, thickness: Array) -> list[str]:
    """Return the lines of the ae file: one set."""
    rows = np.stack([radius, chord, 100.0 * thickness], axis=1).tolist()
    return [
        "1 radius [m] along the half chord, chord [m], thickness [%], polar set",
        f"1 {len(rows)}",
        *(f"{aligned(row)} 1" for row in rows),
    ]


def _findings(
    definition: BladeDefinition, stations: tuple[Station, ...], at: dict[float, float]
) -> list[Finding]:
    """Say what HAWC2 has no place for."""
    found = [Finding("pitch axis", "HAWC2 has none; it stands in comments of c2_def")]
    alike: set[str] = set()
    for one, other in pairwise(stations):
        same = one.airfoil is other.airfoil or np.array_equal(
            one.airfoil.coordinates, other.airfoil.coordinates
        )
        if not same and at[one.eta] - at[other.eta] < THICKNESS_RIPPLE:
            alike.add(other.airfoil.name)
    if alike:
        shown = ", ".join(sorted(alike)[:SHOWN]) + (" and more" if len(alike) > SHOWN else "")
        found.append(
            Finding(
                "airfoils",
                f"not thinner than their inner neighbours: {shown}; HAWC2 tells polars by "
                "thickness alone, so these need a polar set of their own",
            )
        )
    if definition.section_offset_x is not None:
        found.append(Finding("section_offset_x", "goes into the half-chord line"))
    if definition.rotor.hub_radius is not None:
        found.append(Finding("rotor", "hub radius, cone and tilt stand in other parts of the htc"))
    return found
