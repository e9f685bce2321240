"""A blade put back into an OpenFAST model: AeroDyn's main input with its lines replaced.

Only the values that name the blade and its airfoils change (``AFTabMod`` to ``AFNames`` and
``ADBlFile``); every other line stays as it is.  The blade's own files are written beside the new
main input, under names that begin with its own.
"""

import re
from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import FileError, Finding
from bladegen.formats.airfoils.folder_reading import PUT_BACK
from bladegen.formats.common.number_text import line_end, write_lines
from bladegen.formats.common.polars import require_polars
from bladegen.formats.common.text_file import read_lines
from bladegen.formats.openfast import writing as openfast
from bladegen.formats.openfast.model import is_main

__all__ = ["write_into_main"]

LABELS = ("AFTabMod", "InCol_Alfa", "InCol_Cl", "InCol_Cd", "InCol_Cm", "InCol_Cpmin", "NumAFfiles")
NEEDED = ("NumAFfiles", "AFNames", "ADBlFile(1)")
_ENTRY = re.compile(r"(\s*)(\"[^\"]*\"|'[^']*'|\S+)(\s+)([\w()]+)(?=\s|$)(.*)")


def write_into_main(
    definition: BladeDefinition, main: Path, path: Path, nodes: int | None = None
) -> tuple[Finding, ...]:
    """Write AeroDyn's main input with another blade, and that blade's files beside it.

    Parameters
    ----------
    definition : BladeDefinition
        The blade; all of its airfoils must have polars, since AeroDyn does not run without.
    main : Path
        AeroDyn's main input.
    path : Path
        Where to; may be `main` itself.
    nodes : int, optional
        As many, even over the span; as many as the tolerance needs if not given.

    Returns
    -------
    tuple of Finding
        What the files cannot hold, and what of the model may no longer fit the blade.

    Raises
    ------
    FileError
        If `main` is not AeroDyn's main input.
    ExportError
        If airfoils have no polars.
    """
    lines, end = read_lines(main, errors="surrogateescape"), line_end(main)
    labels = {match[4] for match in map(_ENTRY.match, lines) if match}
    missing = [label for label in NEEDED if label not in labels]
    if not is_main("\n".join(lines)) or missing:
        raise FileError(str(main), [f"is no main input of AeroDyn: {', '.join(missing)} missing"])
    require_polars(definition, path, "AeroDyn")
    blade = path.with_name(f"{path.stem}{PUT_BACK}.dat")
    new, findings = openfast.parts(definition, blade, nodes)
    write_lines(path, _replaced(lines, new, blade.name), end)
    said = [finding for finding in findings if finding.where != "AFNames"]
    if path.parent.resolve() != main.parent.resolve():
        said.append(Finding(path.name, f"names other files as from {main.parent}, as before"))
    said.append(Finding("structure", "ElastoDyn's or BeamDyn's is that of the blade before"))
    return tuple(said)


def _replaced(lines: list[str], part: list[str], blade: str) -> list[str]:
    """Return the lines of a main input with the values of a part that bladegen wrote."""
    entries = [match for match in map(_ENTRY.match, part) if match]
    values = {match[4]: match[2] for match in entries if match[4] in LABELS}
    start = next(k for k, line in enumerate(part) if "AFNames" in line)
    count = int(values["NumAFfiles"])
    names = [line.split('"')[1] for line in part[start : start + count]]
    result: list[str] = []
    listing = False
    for line in lines:
        match = _ENTRY.match(line)
        if listing and re.match(r"\s*[\"'][^\"']*[\"']\s*$", line):
            continue  # the other names of the list that was
        listing = False
        if match is None:
            result.append(line)
        elif match[4] in values:
            result.append(f"{match[1]}{values[match[4]]}{match[3]}{match[4]}{match[5]}")
        elif match[4] == "AFNames":
            result.append(f'{match[1]}"{names[0]}"{match[3]}{match[4]}{match[5]}')
            result += [f'"{name}"' for name in names[1:]]
            listing = True
        elif match[4].startswith("ADBlFile("):
            result.append(f'{match[1]}"{blade}"{match[3]}{match[4]}{match[5]}')
        else:
            result.append(line)
    return result
