"""Blade definitions to files that say what they are made from.

`formats.writing` and `formats.into` write; here each file that they wrote gets the line, before it
is read back.  Airfoil coordinates have no place for it: a report beside them lists them
(`inventory`).
"""

from collections.abc import Callable, Iterable
from pathlib import Path

from bladegen.blade.blade import Blade
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import ExportError, Finding
from bladegen.exports import marks
from bladegen.exports.inventory import list_files
from bladegen.exports.provenance import Provenance, made_from
from bladegen.formats import into, writing
from bladegen.formats.proof import Marking
from bladegen.support.arguments import instance

__all__ = ["marking", "write", "write_into"]


def write(
    what: Blade | BladeDefinition,
    path: str | Path,
    *,
    format: str | None = None,  # noqa: A002
    polars: str | None = None,
    reynolds: float | None = None,
    nodes: int | None = None,
    progress: Callable[[str], None] = lambda _: None,
    command: str = "",
) -> tuple[Finding, ...]:
    """Write a blade to a file that other tools read, and that says what it is made from.

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
    command : str
        What was typed, for the file to say.

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
    must = "a Blade, or a BladeDefinition such as bladegen.read('iea15mw') gives"
    instance(what, (Blade, BladeDefinition), "what", must, ExportError)
    given = {"polars": polars, "reynolds": reynolds, "nodes": nodes}
    told = {key: str(value) for key, value in given.items() if value is not None}
    return writing.write(
        what,
        path,
        format=format,
        polars=polars,
        reynolds=reynolds,
        nodes=nodes,
        progress=progress,
        mark=marking(made_from(what, told, command)),
    )


def write_into(
    definition: BladeDefinition,
    turbine: Path,
    path: Path,
    *,
    nodes: int | None = None,
    command: str = "",
) -> tuple[Finding, ...]:
    """Write a model of a tool with its blade replaced (`formats.into.write_into`).

    A model that stays the same to the byte says no more than before.
    """
    made = made_from(definition, {"into": turbine.name}, command)
    return into.write_into(definition, turbine, path, marking(made), nodes)


def marking(made: Provenance) -> Marking:
    """Return what lets files say what they are made from, those without a place by a report."""

    def mark(files: Iterable[Path]) -> None:
        silent: dict[Path, list[Path]] = {}
        for file in files:
            marks.put(file, made)
            if file.suffix == ".dat" and marks.read(file) is None:
                silent.setdefault(file.parent, []).append(file)
        for folder, those in silent.items():
            list_files(folder, those, made)

    return mark
