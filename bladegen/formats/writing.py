"""Blade definitions to files, in any format of the table in `registry`."""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from bladegen.blade.blade import Blade
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.estimates import available, with_polars
from bladegen.errors import ExportError, Finding
from bladegen.formats import registry
from bladegen.formats.airfoils.writing import write_airfoil
from bladegen.formats.common.redefinition import redefined
from bladegen.formats.format import Writer, with_nodes
from bladegen.formats.proof import Marking, marked, proven, unmarked
from bladegen.support.arguments import instance, path_of, suggestion
from bladegen.support.files import require_suffix

__all__ = ["FORMATS", "format_of", "prepared", "write", "write_airfoil"]


MIRRORED = (
    "mirror: blade definitions have y to the trailing edge, so none can hold a mirror image; leave "
    "--mirror out, for tools that mirror a rotor take the definition of the plain blade"
)


FORMATS = tuple(writer for row in registry.FORMATS for writer in row.writers)


def write(
    what: Blade | BladeDefinition,
    path: str | Path,
    *,
    format: str | None = None,  # noqa: A002
    polars: str | None = None,
    reynolds: float | None = None,
    nodes: int | None = None,
    progress: Callable[[str], None] = lambda _: None,
    mark: Marking = unmarked,
) -> tuple[Finding, ...]:
    """Write a blade to a file that other tools read.

    Parameters
    ----------
    what : Blade or BladeDefinition
        A perturbed blade is written with airfoils of its own (`redefinition.redefined`).
    path : str or Path
        Where to; an existing file is replaced once the new one is whole.
    format : str, optional
        The name of a way to write, such as "windio1"; by the path's suffix if not given.
    polars : str, optional
        One of `estimates.POLICIES`.  By default those of a perturbed blade are estimated where
        NeuralFoil is installed, and all others kept as they are.
    reynolds : float, optional
        The Reynolds number of estimated polars.
    nodes : int, optional
        Of AeroDyn's blade file: as many, even over the span; as many as it takes if not given.
    progress : callable
        Told what is being done.
    mark : callable
        Marks the files that were written, before they are read back.

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
    draw = partial(row.write, **with_nodes(row, nodes))
    definition, said = prepared(
        what, polars=polars if row.polars else "keep", reynolds=reynolds, progress=progress
    )
    said = (said if row.polars else ()) + _left_out(definition, row, polars)
    mark = mark if row in FORMATS else unmarked  # those of plug-ins stay as they are
    if row.tolerance is None:
        return said + marked(partial(draw, definition), path, mark)
    return said + proven(partial(draw, definition), path, definition, row.tolerance, mark)


def _left_out(definition: BladeDefinition, row: Writer, polars: str | None) -> tuple[Finding, ...]:
    """Return a finding for each part of a definition that a format has no place for."""
    if row.tolerance is None:  # holds no blade, and nobody expects it to
        return ()
    asked = polars not in (None, "keep", "none")
    some = any(station.airfoil.polars for station in definition.stations)
    lost = (
        ("structure", "has", definition.structure is not None and not row.structure),
        ("polars", "have", (some or asked) and not row.polars),
    )
    said = f"no place in {row.title}; left out"
    return tuple(Finding(part, f"{verb} {said}") for part, verb, gone in lost if gone)


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


def format_of(path: Path, name: str | None = None) -> Writer:
    """Return the format of a name, or without one the format that a path's suffix means.

    Raises
    ------
    ExportError
        If there is none.
    """
    if name is not None:
        instance(name, str, "format", "a format's name", ExportError)
    own = {suffix for writer in FORMATS for suffix in writer.suffixes if suffix}
    for writer in _writers():
        folder = writer.suffixes == ("",)
        if writer.name == name and folder and path.suffix.lower() in own:
            raise ExportError(f"{path}: {name} is a folder of files, such as {path.stem}")
        if writer.name == name and not folder:
            require_suffix(path, writer.suffixes)
        if writer.name == name or (name is None and path.suffix.lower() in writer.suffixes):
            return writer
    if name is not None:
        names = [writer.name for writer in _writers()]
        near = suggestion(name, names)
        raise ExportError(
            f"format: got {name!r}, allowed are {', '.join(names)}{near}{registry.plugins().remark}"
        )
    known = dict.fromkeys(s for writer in _writers() for s in writer.suffixes if s)
    raise ExportError(
        f"{path}: suffix {path.suffix!r}, allowed are {', '.join(known)}, or none for "
        f"a folder of airfoil files{registry.plugins().remark}"
    )


def _writers() -> Iterator[Writer]:
    """Give each way to write; those of plug-ins last, and loaded late."""
    yield from (writer for row in registry.every() for writer in row.writers)
