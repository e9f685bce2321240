"""QBlade: the blade definition file ``.bld``.

A header names the columns, each row is a station: POS [m], CHORD [m], TWIST [deg, leading edge
upwind], OFFSET_X [m, toward the trailing edge], OFFSET_Y [m, downwind], TAXIS or P_AXIS [of the
chord], POLAR_FILE.  The section is turned about its axis, which then lies at the offsets: QBlade's
NREL 5 MW has its mid-chords at (0.5 - 0.375) chord behind the pitch axis, along the twisted chord.
POS counts from the root, or from the hub's centre as in that file.  A polar file's FOILNAME is the
airfoil's; shapes are ``.afl`` files in ``Airfoils/`` or beside the blade.
"""

import math
import re
from dataclasses import replace
from pathlib import Path, PurePosixPath

from bladegen.definition.blade_definition import BladeDefinition, Rotor
from bladegen.errors import FileError, Finding
from bladegen.formats.airfoils.folder_reading import beside, files_of, shapes
from bladegen.formats.common.assembly import Library, Schedule, assemble
from bladegen.formats.common.document import Notes, Range
from bladegen.formats.common.text_file import head, number, numbers, read_lines, referred
from bladegen.support.arrays import Array

__all__ = ["POLAR_FILES", "read", "recognises"]

SHAPES = (".afl",)
POLAR_FILES = ".plr"
COLUMNS = {
    "POS": ("z", 1.0, Range(0.0, 1000.0, "m")),
    "CHORD": ("chord", 1.0, Range(0.0, 100.0, "m", above=True)),
    "TWIST": ("twist", math.pi / 180.0, Range(-90.0, 90.0, "deg")),
    "OFFSET_X": ("sweep", 1.0, Range(-1000.0, 1000.0, "m")),
    "OFFSET_Y": ("prebend", 1.0, Range(-1000.0, 1000.0, "m")),
    "TAXIS": ("pitch_axis", 1.0, Range(-1.0, 2.0, "of the chord")),
    "P_AXIS": ("pitch_axis", 1.0, Range(-1.0, 2.0, "of the chord")),
}
NEEDED = ("POS", "CHORD", "TWIST")
POLARS = "POLAR_FILE"
LONGEST_HUB = 0.2  # of the tip radius; positions that start beyond it are from no hub
BLADES = Range(1, 10)
_TITLE = re.compile(r"([A-Z][A-Z_]*[A-Z])_?\s*(?:\[[^\]]*\])?")


def recognises(path: Path) -> bool:
    """Tell whether a file is a QBlade blade."""
    return any(_titles(line) for line in head(path).splitlines())


def read(path: Path, notes: Notes, airfoils: Path | None = None) -> BladeDefinition | None:
    """Read a blade; None if there are problems, which `notes` then holds."""
    lines = read_lines(path)
    start = next((k for k, line in enumerate(lines) if _titles(line)), len(lines) - 1)
    titles = _titles(lines[start])
    said = {words[1]: words[0] for line in lines[:start] if len(words := line.split()) > 1}
    if said.get("ROTORTYPE") == "VAWT":
        notes.problems.append("ROTORTYPE: got VAWT, allowed is HAWT (a horizontal axis)")
    rows: list[tuple[int, list[str]]] = []
    for k, line in enumerate(lines[start + 1 :], start + 2):
        words = line.split()
        if not words or (rows and number(words[0]) is None):
            break
        if len(words) < len(titles):
            notes.problems.append(f"line {k}: must hold {len(titles)} entries: {', '.join(titles)}")
            return None
        rows.append((k, words))
    if len(rows) < 2:
        notes.problems.append(
            f"line {start + 2}: holds {len(rows)} stations, at least 2 are needed"
        )
    if notes.problems:
        return None
    places = [f"line {k}" for k, _ in rows]
    values: dict[str, Array] = {}
    for column, title in enumerate(titles):
        if title not in COLUMNS:
            continue
        key, factor, allowed = COLUMNS[title]
        found = numbers([words[column] for _, words in rows], places, title, allowed, notes)
        if found is not None:
            values[key] = factor * found
    if notes.problems:
        return None
    rotor = _rotor(said, values, notes)
    at = titles.index(POLARS) if POLARS in titles else len(titles)
    polars = [(k, " ".join(words[at : at + 1])) for k, words in rows]
    folder = _folder(path, airfoils, notes)
    z = values["z"]
    if notes.problems or folder is None or not z[-1] > z[0]:
        notes.problems += [] if z[-1] > z[0] else ["POS: must increase"]
        return None
    names = _airfoil_names(path, folder, [polar for _, polar in polars])
    schedule: Schedule = [
        (float((z[i] - z[0]) / (z[-1] - z[0])), names[polar], k)
        for i, (k, polar) in enumerate(polars)
    ]
    library = Library(lambda wanted: shapes(folder, wanted, notes), list)
    made = assemble(path, values, tuple(k for k, _ in rows), schedule, library, notes)
    if made is None or notes.problems:
        return None
    return replace(made, rotor=rotor, description=said.get("OBJECTNAME", "").replace("_", " "))


def _titles(line: str) -> list[str]:
    """Return the columns that a header names; none of any other line."""
    titles: list[str] = _TITLE.findall(line)
    return titles if all(title in titles for title in NEEDED) else []


def _rotor(said: dict[str, str], values: dict[str, Array], notes: Notes) -> Rotor:
    """Return what is known of the rotor; take the hub radius off positions that hold it."""
    blades = number(said.get("NUMBLADES", ""))
    count = Rotor.blades if blades is None or not BLADES.holds(blades) else int(blades)
    z = values["z"]
    hub = float(z[0])
    if not 0 < hub < LONGEST_HUB * z[-1]:
        return Rotor(blades=count)
    values["z"] = z - hub
    notes.findings.append(
        Finding("POS", f"starts at {hub:g} m, taken as the hub radius; measured from there")
    )
    return Rotor(blades=count, hub_radius=hub)


def _folder(path: Path, given: Path | None, notes: Notes) -> Path | None:
    """Return the folder of shapes: the one given, one beside the blade, or the blade's own."""
    own = path.parent
    apart = any((own / name).is_dir() for name in ("airfoils", "Airfoils"))
    if given is None and not apart and files_of(own, SHAPES):
        return own
    return beside(path, given, notes)


def _airfoil_names(path: Path, folder: Path, polars: list[str]) -> dict[str, str]:
    """Return the airfoil of each polar file: its FOILNAME, else the shape its name begins with."""
    stems = sorted((file.stem for file in files_of(folder)), key=len, reverse=True)
    found = {}
    for polar in dict.fromkeys(polars):
        name = _foil_name(path, polar)
        if name is None:
            stem = Path(polar).stem
            name = next((one for one in stems if stem.startswith(one)), stem)
        found[polar] = name
    return found


def _foil_name(path: Path, polar: str) -> str | None:
    """Return the name of the airfoil that a polar file is of, if the file is there."""
    file = referred(polar, [path.parent, path.parent / "Polars"])
    if file is None:
        return None
    try:
        lines = read_lines(file)
    except FileError:
        return None
    for line in lines:
        words = line.split()
        if words[1:2] == ["FOILNAME"]:
            shape = PurePosixPath(words[0].replace("\\", "/"))
            return shape.stem if shape.suffix.lower() in SHAPES else shape.name
    return None
