"""A blade put back into a HAWC2 model: an htc file with its c2_def and the names of its files.

The ``c2_def`` of the blade's ``main_body`` and, in ``aero``, ``ae_filename``, ``pc_filename`` and
``ae_sets`` change; every other line stays as it is.  The blade's own files are written beside the
new htc file, under names that begin with its own.  HAWC2 runs in the folder above ``htc/``, so
names start there.
"""

from pathlib import Path

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import FileError, Finding
from bladegen.formats.airfoils.folder_reading import PUT_BACK
from bladegen.formats.common.document import Notes
from bladegen.formats.common.number_text import line_end, write_lines
from bladegen.formats.common.polars import require_polars
from bladegen.formats.common.text_file import read_lines
from bladegen.formats.hawc2 import writing as hawc2
from bladegen.formats.hawc2.reading import AE_SUFFIX, PC_SUFFIX, blade_name

__all__ = ["write_into_htc"]


def write_into_htc(definition: BladeDefinition, htc: Path, path: Path) -> tuple[Finding, ...]:
    """Write an htc file with another blade, and that blade's files beside it.

    Parameters
    ----------
    definition : BladeDefinition
        The blade; all of its airfoils must have polars.
    htc : Path
        The file that holds the blade's c2_def and, here or in a file that continues it, aero.
    path : Path
        Where to; may be `htc` itself.

    Returns
    -------
    tuple of Finding
        What the files cannot hold, and what of the model may no longer fit the blade.

    Raises
    ------
    FileError
        If there is no blade in `htc`.
    ExportError
        If airfoils have no polars.
    """
    lines, end = read_lines(htc, errors="surrogateescape"), line_end(htc)
    notes = Notes()
    name = blade_name(htc, notes)
    if name is None:
        raise FileError(str(htc), notes.shown())
    require_polars(definition, path, "HAWC2")
    blocks = _blocks(lines)
    own = [
        k for k, (inside, body) in enumerate(blocks) if inside[-1:] == ["c2_def"] and body == name
    ]
    if not own:
        raise FileError(
            str(htc),
            [f"holds no c2_def of {name}; name the file that it continues in instead"],
        )
    part = path.with_name(f"{path.stem}{PUT_BACK}.htc")
    new, found = hawc2.parts(definition, part)
    findings = list(found)
    sections = [line for (at, _), line in zip(_blocks(new), new, strict=True) if "c2_def" in at]
    here = "./htc/" if path.resolve().parent.name == "htc" else "./"
    named = {
        "ae_filename": f"{here}{part.stem}{AE_SUFFIX}",
        "pc_filename": f"{here}{part.stem}{PC_SUFFIX}",
        "ae_sets": " ".join(["1"] * definition.rotor.blades),
    }
    result: list[str] = []
    met: set[str] = set()
    for k, (line, (inside, _)) in enumerate(zip(lines, blocks, strict=True)):
        word = (line.split(None, 1) or [""])[0].lower()
        if k in own:
            result += sections if k == own[0] else []
        elif inside[-1:] == ["aero"] and word in named:
            met.add(word)
            result.append(f"  {word} {named[word]} ;")
        else:
            result.append(line)
    write_lines(path, result, end)
    missing = [f"{word} {value}" for word, value in named.items() if word not in met]
    if missing:
        said = f"is not all in this file; give it {', '.join(missing)}"
        findings.append(Finding("aero", f"{said} (folders as HAWC2 sees them from where it runs)"))
    findings.append(Finding("structure", "st of the blade is that of the blade before"))
    return tuple(finding for finding in findings if finding.where != "htc")


def _blocks(lines: list[str]) -> list[tuple[list[str], str]]:
    """Return for each line the blocks that it stands in and the name of its main_body.

    A line that begins a block stands outside of it, and one that ends it inside.
    """
    places: list[tuple[list[str], str]] = []
    names: dict[int, str] = {}
    bodies: list[int] = []
    inside: list[str] = []
    body = -1
    for line in lines:
        words = line.partition(";")[0].lower().split()
        places.append((list(inside), ""))
        bodies.append(body)
        if words[:1] == ["begin"] and len(words) > 1:
            if words[1] == "main_body":
                body = len(places)
            inside.append(words[1])
        elif words[:1] == ["end"] and inside:
            inside.pop()
        elif words[:1] == ["name"] and inside[-1:] == ["main_body"] and len(words) > 1:
            names[body] = words[1]
    return [(at, names.get(k, "")) for (at, _), k in zip(places, bodies, strict=True)]
