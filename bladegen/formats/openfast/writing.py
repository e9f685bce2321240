"""OpenFAST: an AeroDyn blade file, airfoil files of its nodes, and ElastoDyn's twist.

AeroDyn takes the airfoil of a node as it is, without blending, so a blade's sections and polars
are written node by node; nodes that share both share their files.  Polars are written where all
nodes have some, with the lines of AeroDyn's main input that list them.  Conventions:
`reading`.  The reference point of an airfoil, of which the curve and sweep
columns tell, is that of its published polars.  Where that is not known it is the quarter
chord; towards the round root it moves to the half chord, about which a cylinder has no moment.
"""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.blending import without_polars
from bladegen.definition.conventions import line_of_axis, slope_degrees
from bladegen.definition.estimates import force_centre
from bladegen.definition.thickness import ruled
from bladegen.errors import ExportError, Finding
from bladegen.formats.airfoils.folder_reading import companion
from bladegen.formats.common.number_text import aligned, few, write_lines
from bladegen.formats.common.resampling import MOST_NODES, common_grid, lost, shape_grid
from bladegen.formats.openfast.model import PART_SUFFIX
from bladegen.formats.openfast.polar_writing import Tables, info, part, tables_at
from bladegen.formats.openfast.reading import TWIST_SUFFIX
from bladegen.support.arrays import Array
from bladegen.support.files import folder, safe_stem

__all__ = ["parts", "write"]

LANDMARKS = 401
SAME_SHAPE = 1e-12  # chords; nodes nearer than this share an airfoil
FEWEST_NODES = 10  # of those that are asked for
TOLERANCE = 5e-4  # m; of a grid of about a hundred nodes, which AeroDyn still runs at ease


def write(definition: BladeDefinition, path: Path, nodes: int | None = None) -> tuple[Finding, ...]:
    """Write a blade for OpenFAST: the blade file at `path`, the others beside it.

    Returns what the files cannot hold.
    """
    lines, findings = parts(definition, path, nodes)
    listing = path.with_name(f"{path.stem}{PART_SUFFIX}")
    if lines:
        write_lines(listing, lines)
    else:
        listing.unlink(missing_ok=True)  # of a blade that had polars
    return findings


def parts(
    definition: BladeDefinition, path: Path, nodes: int | None = None
) -> tuple[list[str], tuple[Finding, ...]]:
    """Write a blade's files but for the lines of AeroDyn's main input that name them.

    Nodes are even over the span if their number is given, else as many as the tolerance needs.
    Returns these lines, none without polars, and what the files cannot hold.
    """
    given, definition = definition, ruled(definition)
    blade = Blade.from_definition(definition, landmarks=LANDMARKS)
    eta, loss = _nodes(definition, blade, nodes)
    profiles = blade.profiles(eta)
    thickness = blade.splines.fit(profiles).relative_thickness
    tables = tables_at(definition, eta.tolist())
    whole = all(one.polars for one in tables)
    reference = force_centre(thickness)
    changes = np.abs(np.diff(profiles, axis=0)).max(axis=(1, 2)) > SAME_SHAPE
    if whole:
        known = [np.nan if one.reference is None else one.reference for one in tables]
        reference = np.where(np.isnan(known), reference, known)
        changes |= [not one.alike(other) for one, other in pairwise(tables)]
        changes |= np.diff(reference) != 0.0
    ids = np.concatenate([[1], 1 + np.cumsum(changes)])
    stem = safe_stem(path.stem)
    airfoils = folder(companion(path))
    names = {station.eta: station.airfoil.name for station in definition.stations}
    files = []
    for k in np.unique(ids).tolist():
        first = int(np.argmax(ids == k))
        name = names.get(float(eta[first]), f"section at eta = {eta[first]:.5f}")
        coordinates = airfoils / f"{stem}_AF{k:03d}_Coords.txt"
        write_lines(coordinates, _coordinates(name, profiles[first], float(reference[first])))
        files.append(airfoils / f"{stem}_AF{k:03d}.dat")
        if whole:
            said = info(name, coordinates.name, float(thickness[first]), tables[first])
            write_lines(files[-1], said)
    for stale in airfoils.glob(f"{stem}_AF[0-9][0-9][0-9]*"):
        number = int(stale.name[len(stem) + 3 :][:3])
        if number > ids[-1] or (stale in files and not whole):  # of a blade that had more
            stale.unlink()
    lines = []
    if whole:
        most = max(len(one.polars) for one in tables)
        listed = [f"{airfoils.name}/{file.name}" for file in files]
        lines = part(path.name, listed, most, definition.rotor.blades)
    write_lines(path.with_name(f"{path.stem}{TWIST_SUFFIX}"), _twist(definition, eta))
    write_lines(path, _blade(definition, eta, ids, reference))
    found = _findings(given, len(eta), int(ids[-1]), loss, airfoils.name)
    listing = f"{path.stem}{PART_SUFFIX}"
    return lines, (*found, *_polar_findings(definition, tables, listing))


def _nodes(definition: BladeDefinition, blade: Blade, count: int | None) -> tuple[Array, float]:
    """Return the span fractions of nodes, and what is lost between them [m]."""
    if count is None:
        eta, _ = common_grid(definition, TOLERANCE, over_z=True)
        return common_grid(definition, TOLERANCE, over_z=True, also=shape_grid(blade, eta))
    if not FEWEST_NODES <= count <= MOST_NODES:
        raise ExportError(f"nodes: got {count}, allowed are {FEWEST_NODES} to {MOST_NODES}")
    eta = np.linspace(0.0, 1.0, count)
    return eta, lost(definition, eta, over_z=True)


def _blade(definition: BladeDefinition, eta: Array, ids: Array, reference: Array) -> list[str]:
    """Return the lines of AeroDyn's blade file."""
    chord, twist, axis = definition.chord(eta), definition.twist(eta), definition.axis(eta)
    aside = definition.offset_x(eta)
    span = axis[:, 2] - axis[0, 2]
    behind = definition.offset_y(eta)
    x, y = line_of_axis(axis[:, 0], axis[:, 1], chord, twist, behind, reference)
    x, y = x + aside * np.cos(twist), y - aside * np.sin(twist)
    columns = [span, x, y, slope_degrees(x, span), np.degrees(twist), chord]
    titles = ["BlSpn", "BlCrvAC", "BlSwpAC", "BlCrvAng", "BlTwist", "BlChord", "BlAFID"]
    units = ["(m)", "(m)", "(m)", "(deg)", "(deg)", "(m)", "(-)"]
    rows = zip(np.stack(columns, axis=1).tolist(), ids.tolist(), strict=True)
    title = " ".join((definition.description or definition.name).split())
    return [
        "------- AERODYN BLADE DEFINITION INPUT FILE " + "-" * 45,
        f"{title}; written by bladegen",
        "======  Blade Properties " + "=" * 65,
        f"{len(eta):<12d}NumBlNds    - Number of blade nodes used in the analysis (-)",
        aligned(titles) + "   BlCb BlCenBn BlCenBt",
        aligned(units) + "    (-)     (m)     (m)",
        *(aligned([*row, str(k)]) + "    0.0     0.0     0.0" for row, k in rows),
    ]


def _coordinates(name: str, points: Array, reference: float) -> list[str]:
    """Return the lines of an airfoil's coordinate file."""
    return [
        f"{len(points) + 1:<8d}NumCoords   ! number of coordinates, the reference point included",
        f"! airfoil: {' '.join(name.split())}",
        "! x/c and y/c of the reference point (the aerodynamic centre)",
        aligned([reference, 0.0]),
        "! x/c and y/c: trailing edge, suction side, leading edge, pressure side, trailing edge",
        *(aligned(pair) for pair in points.tolist()),
    ]


def _twist(definition: BladeDefinition, eta: Array) -> list[str]:
    """Return the columns that ElastoDyn's blade file takes from the geometry."""
    pitch_axis = definition.offset_y(eta) / definition.chord(eta)
    axis = definition.axis(eta)[:, 2]
    fraction = (axis - axis[0]) / (axis[-1] - axis[0])
    rows = np.stack([fraction, pitch_axis, np.degrees(definition.twist(eta))], axis=1)
    return [
        "Columns of ElastoDyn's blade file that follow from the geometry; written by bladegen",
        aligned(["BlFract", "PitchAxis", "StrcTwst"]),
        aligned(["(-)", "(-)", "(deg)"]),
        *map(aligned, rows.tolist()),
    ]


def _findings(
    definition: BladeDefinition, nodes: int, shapes: int, loss: float, airfoils: str
) -> list[Finding]:
    found = [
        Finding(
            "BlSpn",
            f"{nodes} nodes for all quantities; between them at most {loss * 1e3:.2f} mm off",
        ),
        Finding(
            "BlAFID",
            f"{shapes} airfoils, in {airfoils}",
        ),
        Finding(
            "BlCrvAC, BlSwpAC",
            "of each airfoil's reference point: of published polars theirs, else the quarter "
            "chord, the half chord of cylinders",
        ),
    ]
    if definition.relative_thickness is not None:
        found.append(Finding("rthick", "not held as a table; the sections have it"))
    if definition.section_offset_x is not None:
        found.append(Finding("section_offset_x", "goes into BlCrvAC and BlSwpAC"))
    if definition.axis.z.values[0] != 0:
        found.append(
            Finding(
                "BlSpn", f"starts at 0; the axis starts at z = {definition.axis.z.values[0]:g} m"
            )
        )
    if definition.rotor.hub_radius is not None:
        found.append(Finding("rotor", "hub radius, cone and tilt stand in ElastoDyn's main input"))
    return found


def _polar_findings(
    definition: BladeDefinition, tables: Sequence[Tables], listing: str
) -> list[Finding]:
    """Say where the polars are, or why there are none."""
    if not all(one.polars for one in tables):
        why = (
            "there are none"
            if not any(one.polars for one in tables)
            else few(without_polars(definition)) + " have none"
        )
        said = f"polars are not written: {why}; AFNames must list yours in the order of BlAFID"
        return [Finding("AFNames", said)]
    found = [
        Finding(
            "AFNames",
            f"the files with polars stand in {listing}: put its lines into AeroDyn's main input",
        )
    ]
    more = {
        station.airfoil.name
        for station in definition.stations
        if len({polar.configuration for polar in station.airfoil.polars}) > 1
    }
    if more:
        found.append(Finding("polars", f"of the first configuration alone: {few(sorted(more))}"))
    return found
