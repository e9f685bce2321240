"""Blade definitions to files: one module a format, one row in `FORMATS`.

A new format is a function that writes a definition to a path and returns what the format cannot
hold, and a row that says what it is called and by which suffixes it is meant.  A format of one
file writes it through `files.replacing`; one of several files writes its main file to the path,
and the others beside it, under names that start with the main file's.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from bladegen.blade.blade import Blade
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.estimates import available, with_polars
from bladegen.errors import ExportError, Finding
from bladegen.formats.airfoils import writing as airfoil_files
from bladegen.formats.airfoils.writing import write_airfoil
from bladegen.formats.common.redefinition import redefined
from bladegen.formats.hawc2 import writing as hawc2
from bladegen.formats.openfast import writing as openfast
from bladegen.formats.proof import GRID, WHOLE, proven
from bladegen.formats.tables import writing as spanwise_table
from bladegen.formats.windio import version1, version2
from bladegen.support.arguments import instance, path_of, suggestion
from bladegen.support.files import require_suffix

__all__ = ["FORMATS", "Format", "format_of", "prepared", "write", "write_airfoil"]


MIRRORED = (
    "mirror: blade definitions have y to the trailing edge, so none can hold a mirror image; leave "
    "--mirror out, for tools that mirror a rotor take the definition of the plain blade"
)


@dataclass(frozen=True)
class Format:
    """A file format.

    Parameters
    ----------
    name : str
        By which it is asked for: one word, lower case.
    title : str
        What it is called.
    suffixes : tuple of str
        Of its files, lower case, "" for a folder; the first row with a suffix is meant by it.
    write : callable
        From a definition and a path to what the format cannot hold.
    polars : bool
        Whether it holds polars.
    tolerance : float, optional
        How far a blade may be off that is read back [m] without a finding; None for formats that
        hold no blade.
    """

    name: str
    title: str
    suffixes: tuple[str, ...]
    write: Callable[[BladeDefinition, Path], tuple[Finding, ...]]
    polars: bool = False
    tolerance: float | None = WHOLE


FORMATS = (
    Format("windio2", "windIO 2", (".yaml", ".yml"), version2.write, polars=True),
    Format("windio1", "windIO 1", (".yaml", ".yml"), version1.write, polars=True),
    Format("openfast", "OpenFAST (AeroDyn blade)", (".dat",), openfast.write, True, GRID),
    Format("hawc2", "HAWC2", (".htc",), hawc2.write, True, GRID),
    Format("csv", "spanwise table (CSV)", (".csv",), spanwise_table.write),
    Format("xlsx", "spanwise table (IEA workbook)", (".xlsx",), spanwise_table.write, False, GRID),
    *(
        Format(name, f"a folder of airfoil files ({name.title()})", ("",), write, False, None)
        for name, write in (
            ("selig", airfoil_files.write_selig),
            ("lednicer", airfoil_files.write_lednicer),
        )
    ),
)


def write(
    what: Blade | BladeDefinition,
    path: str | Path,
    *,
    format: str | None = None,  # noqa: A002
    polars: str | None = None,
    reynolds: float | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> tuple[Finding, ...]:
    """Write a blade to a file that other tools read.

    Parameters
    ----------
    what : Blade or BladeDefinition
        A perturbed blade is written with airfoils of its own (`redefinition.redefined`).
    path : str or Path
        Where to; an existing file is replaced once the new one is whole.
    format : str, optional
        The name of one of `FORMATS`; by the path's suffix if not given.
    polars : str, optional
        One of `estimates.POLICIES`.  By default those of a perturbed blade are estimated where
        NeuralFoil is installed, and all others kept as they are.
    reynolds : float, optional
        The Reynolds number of estimated polars.
    progress : callable
        Told what is being done.

    Returns
    -------
    tuple of Finding
        What the format cannot hold, or holds only within a distance.

    Raises
    ------
    ExportError
        If there is no such format, or the file cannot be written or read back.
    BladegenError
        If the polars asked for cannot be had.
    """
    path = path_of(path, "path", ExportError)
    row = format_of(path, format)
    definition, said = prepared(
        what, polars=polars if row.polars else "keep", reynolds=reynolds, progress=progress
    )
    said = said if row.polars else ()
    if row.tolerance is None:
        return said + row.write(definition, path)
    return said + proven(partial(row.write, definition), path, definition, row.tolerance)


def prepared(
    what: Blade | BladeDefinition,
    *,
    polars: str | None = None,
    reynolds: float | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> tuple[BladeDefinition, tuple[Finding, ...]]:
    """Return what is written of a blade, and what is to be said of it; see `write`."""
    must = "a Blade, or a BladeDefinition such as bladegen.read('iea15mw') gives"
    instance(what, (Blade, BladeDefinition), "what", must, ExportError)
    if isinstance(what, BladeDefinition):
        definition, made = what, tuple[Finding, ...]()
        policy = polars or "keep"
    elif what.mirrored:
        raise ExportError(MIRRORED)
    else:
        progress("giving the blade airfoils of its own")
        definition, known = redefined(what), what.definition.findings
        made = tuple(finding for finding in definition.findings if finding not in known)
        policy = polars or ("estimate" if what.changes and available() else "keep")
    definition, said = with_polars(definition, policy, reynolds=reynolds, progress=progress)
    return definition, made + said


def format_of(path: Path, name: str | None = None) -> Format:
    """Return the format of a name, or without one the format that a path's suffix means.

    Raises
    ------
    ExportError
        If there is none.
    """
    if name is not None:
        instance(name, str, "format", "a format's name", ExportError)
    known = dict.fromkeys(suffix for row in FORMATS for suffix in row.suffixes if suffix)
    for row in FORMATS:
        if row.name == name and row.suffixes == ("",) and path.suffix.lower() in known:
            raise ExportError(f"{path}: {name} is a folder of files, such as {path.stem}")
        if row.name == name and row.suffixes != ("",):
            require_suffix(path, row.suffixes)
        if row.name == name or (name is None and path.suffix.lower() in row.suffixes):
            return row
    if name is not None:
        names = ", ".join(row.name for row in FORMATS)
        near = suggestion(name, [row.name for row in FORMATS])
        raise ExportError(f"format: got {name!r}, allowed are {names}{near}")
    suffixes = ", ".join(known)
    raise ExportError(
        f"{path}: suffix {path.suffix!r}, allowed are {suffixes}, or none for "
        "a folder of airfoil files"
    )
