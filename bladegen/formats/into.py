"""A blade put back into a full model of a tool, everything else of which stays as it is."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from bladegen.definition.blade_definition import Airfoil, BladeDefinition, Station
from bladegen.errors import FileError, Finding
from bladegen.formats.format import Format, PutBack, with_nodes
from bladegen.formats.proof import (
    Marking,
    marked,
    put_in_place,
    read_back,
    taken_back,
    unmarked,
)
from bladegen.formats.reading import read
from bladegen.formats.registry import every
from bladegen.support.files import content_of, require_suffix

__all__ = ["with_polars_of", "write_into"]

YAML = ".yaml"
SAME = 1e-6  # of the chord: tables and airfoil files hold six digits and more
LARGEST = 2**28  # bytes; the readers of models have lower bounds of their own


def write_into(
    definition: BladeDefinition,
    turbine: Path,
    path: Path,
    mark: Marking = unmarked,
    nodes: int | None = None,
) -> tuple[Finding, ...]:
    """Write a model of a tool with its blade replaced, in the format that it is in.

    Parameters
    ----------
    definition : BladeDefinition
        The blade.
    turbine : Path
        The full turbine file of windIO, AeroDyn's main input (.dat), an htc file, or a file of
        another format whose row in `registry` puts blades back.
    path : Path
        Where to; may be `turbine` itself.
    mark : callable
        Marks the files that were written, before they are read back; a model that is the same as
        before to the byte stays so.
    nodes : int, optional
        Of AeroDyn's blade file: as many, even over the span; as many as it takes if not given.

    Returns
    -------
    tuple of Finding
        What the format cannot hold, and what of the turbine may no longer fit the blade.

    Raises
    ------
    FileError
        If the turbine file cannot be read or holds no blade.
    ExportError
        If the file with the blade in it cannot be read, by what was wrong before or else.
    """
    if turbine.is_dir() or not turbine.suffix:
        is_what = "is a folder" if turbine.is_dir() else "has no suffix"
        must = "must be the file of a model, such as turbine.yaml, AeroDyn.dat, model.htc"
        raise FileError(str(turbine), [f"{is_what}, {must}"])
    own = turbine.suffix.lower()
    row, way = _way(own)
    told = with_nodes(way, nodes)
    require_suffix(path, way.suffixes if own in way.suffixes else (own,))
    before = content_of(turbine, LARGEST) if turbine.is_file() else b""

    def changed(files: Iterable[Path]) -> None:
        mark(file for file in files if file.name != path.name or file.read_bytes() != before)

    def write(target: Path) -> tuple[Finding, ...]:
        return way.write(definition, turbine, target, **told)

    if row.alone:
        with put_in_place(path) as draft:
            said = marked(write, draft, changed)
            return said + read_back(draft, path, definition, way.tolerance, turbine)
    with taken_back(path):
        said = marked(write, path, changed)
        partly = any(finding.where == "aero" for finding in said)
        if partly or path.parent.resolve() != turbine.parent.resolve():
            return said  # names lead to files that are elsewhere
        return said + read_back(path, path, definition, way.tolerance)


def with_polars_of(
    definition: BladeDefinition, turbine: Path
) -> tuple[BladeDefinition, tuple[Finding, ...]]:
    """Return a blade with the polars that a model has for its airfoils, where it has none itself.

    A blade that went through a table has lost them.  An airfoil is the model's if it has the name
    and the shape; a model that cannot be read has none, which `write_into` says.
    """
    if all(station.airfoil.polars for station in definition.stations):
        return definition, ()
    try:
        known = {s.airfoil.name: s.airfoil for s in read(turbine).stations}
    except FileError:
        return definition, ()
    made: dict[str, Airfoil] = {}
    for station in definition.stations:
        own = station.airfoil
        there = known.get(own.name)
        if not own.polars and there is not None and there.polars and _alike(own, there):
            centre = there.aerodynamic_center
            made[own.name] = replace(own, polars=there.polars, aerodynamic_center=centre)
    if not made:
        return definition, ()
    stations = tuple(
        Station(s.eta, made.get(s.airfoil.name, s.airfoil)) for s in definition.stations
    )
    keep = "airfoils of {} keep theirs" if len(made) > 1 else "airfoil of {} keeps its own"
    said = Finding("polars", f"{len(made)} {keep.format(turbine.name)}")
    return replace(definition, stations=stations), (said,)


def _alike(one: Airfoil, other: Airfoil) -> bool:
    """Tell whether two airfoils have the same points."""
    a, b = one.coordinates, other.coordinates
    return a.shape == b.shape and bool(np.abs(a - b).max() <= SAME)


def _way(suffix: str) -> tuple[Format, PutBack]:
    """Return what puts blades back into models with a suffix; windIO says best what is wrong."""
    for row in every():
        if row.put_back is not None and suffix in row.put_back.suffixes:
            return row, row.put_back
    return _way(YAML)
