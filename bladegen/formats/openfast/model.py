"""OpenFAST's main inputs: a turbine's .fst file, and AeroDyn's, which names blade and airfoils.

A .fst file names AeroDyn's main input (AeroFile) and ElastoDyn's (EDFile); each input names
others relative to itself.  Published models share files between turbines in folders side by side
(``../IEA-15-240-RWT/``), so a .fst file leads to what lies below its own folder's parent; AeroDyn's
main input by itself leads to what lies below its own folder.  Anything else is refused.
ElastoDyn's TipRad and HubRad [m], PreCone(1) and ShftTilt [deg, both negative upwind] and NumBl
become the rotor.
"""

import re
from dataclasses import dataclass
from math import radians
from pathlib import Path

from bladegen.definition.blade_definition import Rotor
from bladegen.errors import FileError, Finding
from bladegen.formats.airfoils.folder_reading import files_of
from bladegen.formats.common.document import Notes, Range
from bladegen.formats.common.text_file import head, number, read_lines, referred
from bladegen.formats.openfast.polar_reading import COLUMNS, Columns

__all__ = [
    "PART_SUFFIX",
    "TURBINE",
    "Main",
    "is_main",
    "is_turbine",
    "main_beside",
    "main_input",
    "turbine",
]

TURBINE = ".fst"
PART_SUFFIX = "_AeroDyn_part.dat"  # the lines of AeroDyn's main input that bladegen writes
NEIGHBOURS = 200  # files beside a blade file that are looked into for AeroDyn's main input
MOST_COLUMNS = 20
SHOWN = 60  # letters of a name in a message
HUB = Range(0.0, 100.0, "m")
TIP = Range(0.0, 1000.0, "m", above=True)
ANGLE = Range(-45.0, 45.0, "deg")
BLADES = Range(1, 10)


@dataclass(frozen=True)
class Main:
    """AeroDyn's main input.

    Parameters
    ----------
    lines : list of str
        Of the file.
    folder : Path
        Where it lies; names start here.
    root : Path
        Below which the files must lie that it names.
    """

    lines: list[str]
    folder: Path
    root: Path

    def named(self, name: str) -> Path | None:
        """Return the file of a name, if it lies where it may."""
        return referred(name, [self.folder], self.root)

    def blade(self, notes: Notes) -> Path | None:
        """Return the blade file; None if there is none, which `notes` then tells."""
        name = _value(self.lines, r"ADBlFile\(1\)")
        found = self.named(name or "")
        if found is None:
            notes.problems.append(
                f"ADBlFile(1): got {name and name[:SHOWN]!r}, must be a file in {self._where}; "
                "convert the blade file itself where it lies elsewhere"
            )
        return found

    def airfoils(self, notes: Notes) -> list[Path] | None:
        """Return the airfoil files in the order of AFID; None if one is out of reach."""
        files = []
        for k, name in enumerate(self._airfoil_names()):
            found = self.named(name)
            if found is None:
                notes.problems.append(
                    f"AFNames, entry {k + 1}: {name[:SHOWN]!r} is no file in {self._where}; "
                    "name the folder (--airfoils DIR)"
                )
                return None
            files.append(found)
        return files

    @property
    def columns(self) -> Columns:
        """Where the airfoil files hold what; as usual where that is not stated or odd."""
        found = []
        for usual, key in zip(COLUMNS, ("Alfa", "Cl", "Cd", "Cm"), strict=True):
            stated = number(_value(self.lines, f"InCol_{key}") or "")
            fewest = 0 if key == "Cm" else 1
            sound = stated is not None and stated in range(fewest, MOST_COLUMNS)
            found.append(int(stated) if sound and stated is not None else usual)
        return Columns(*found)

    @property
    def _where(self) -> str:
        return f"{self.root.resolve().name or '.'} or below it"

    def _airfoil_names(self) -> list[str]:
        for k, line in enumerate(self.lines):
            if re.search(r"\sAFNames(\s|$)", line):
                names = []
                for entry in self.lines[k:]:
                    match = re.match(r"\s*(\"[^\"]*\"|'[^']*')", entry)
                    if match is None:
                        break
                    names.append(match[1].strip("\"'"))
                return names
        return []


def is_main(text: str) -> bool:
    """Tell whether a text begins as AeroDyn's main input."""
    return bool(re.search(r"\s(ADBlFile\(1\)|AFNames)(\s|$)", text, re.MULTILINE))


def is_turbine(text: str) -> bool:
    """Tell whether a text begins as a .fst file."""
    return bool(re.search(r"\s(CompAero|AeroFile)(\s|$)", text, re.MULTILINE))


def main_input(path: Path, lines: list[str]) -> Main:
    """Return AeroDyn's main input that stands for itself."""
    return Main(lines, path.parent, path.parent)


def main_beside(blade: Path) -> Main | None:
    """Return AeroDyn's main input that names a blade file, if it lies beside it.

    The part that bladegen writes with a blade goes before other inputs.
    """
    own = blade.with_name(f"{blade.stem}{PART_SUFFIX}")
    others = [path for path in files_of(blade.parent, (".dat",))[:NEIGHBOURS] if path != own]
    for path in ([own] if own.is_file() else []) + others:
        if path != blade and is_main(head(path)):
            main = main_input(path, read_lines(path))
            if main.named(_value(main.lines, r"ADBlFile\(1\)") or "") == blade.resolve():
                return main
    return None


def turbine(path: Path, notes: Notes) -> tuple[Main, Rotor] | None:
    """Return what a .fst file names: AeroDyn's main input, and the rotor of ElastoDyn's.

    None if AeroDyn's is out of reach, which `notes` then tells.
    """
    lines = read_lines(path)
    folder = path.resolve().parent
    root = folder if folder.parent == Path(folder.anchor) else folder.parent
    name = _value(lines, "AeroFile")
    found = referred(name or "", [folder], root)
    named = [] if found is None else read_lines(found)
    if found is None or not is_main("\n".join(named)):
        what = "AeroDyn's main input" + (
            " (with ADBlFile(1))" if found else f", a file in {root.name or '.'} or below it"
        )
        notes.problems.append(f"AeroFile: got {(name or 'nothing')[:SHOWN]!r}, must be {what}")
        return None
    structure = _value(lines, "EDFile")
    return Main(named, found.parent, root), _rotor(structure, folder, root, notes)


def _rotor(name: str | None, folder: Path, root: Path, notes: Notes) -> Rotor:
    """Return what ElastoDyn's main input says of the rotor; what is not there stays unknown."""
    found = referred(name or "", [folder], root)
    try:
        lines = None if found is None else read_lines(found)
    except FileError as error:
        lines, name = None, f"{name}: {error.problems[0]}"
    if lines is None:
        notes.findings.append(
            Finding(
                "EDFile",
                f"{(name or 'none')[:SHOWN]!r} is no file in {root.name or '.'} or below it; hub "
                "radius, cone and tilt stay unknown",
            )
        )
        return Rotor()

    def fact(label: str, allowed: Range) -> float | None:
        text = _value(lines, re.escape(label))
        value = number(text or "")
        if value is not None and allowed.holds([value]).all():
            return value
        got = "is missing" if text is None else f"got {text[:SHOWN]!r}, allowed is {allowed}"
        notes.findings.append(Finding(f"EDFile, {label}", f"{got}; passed over"))
        return None

    tip, hub = fact("TipRad", TIP), fact("HubRad", HUB)
    cone, tilt = fact("PreCone(1)", ANGLE), fact("ShftTilt", ANGLE)
    blades = fact("NumBl", BLADES)
    return Rotor(
        blades=3 if blades is None else int(blades),
        hub_radius=hub,
        diameter=None if tip is None else 2.0 * tip,
        cone=None if cone is None else -radians(cone) + 0.0,
        tilt=None if tilt is None else -radians(tilt) + 0.0,
    )


def _value(lines: list[str], label: str) -> str | None:
    """Return the value, quoted or not, that stands before a label (a pattern)."""
    for line in lines:
        match = re.match(rf"\s*(\"[^\"]*\"|'[^']*'|\S+)\s+{label}(\s|$)", line)
        if match:
            return match[1].strip("\"'")
    return None
