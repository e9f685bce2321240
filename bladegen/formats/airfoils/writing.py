"""Airfoil coordinate files in the formats of Selig and Lednicer, in chords.

Selig: a title, then one loop, trailing edge -> suction side -> leading edge -> pressure side ->
trailing edge.  Lednicer: a title, the numbers of points of both sides, then the suction and the
pressure side, each from leading to trailing edge, with the leading edge in both.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from bladegen.airfoils.landmarks import oriented
from bladegen.definition.blade_definition import Airfoil, BladeDefinition
from bladegen.errors import ExportError, Finding
from bladegen.formats.airfoils.unique_names import uniquely_named
from bladegen.formats.common.number_text import write_lines
from bladegen.support.arguments import instance, one_of, path_of
from bladegen.support.arrays import Array
from bladegen.support.files import folder, safe_stem

__all__ = ["LAYOUTS", "write_airfoil", "write_folder"]


def _selig(points: Array) -> list[str]:
    return _rows(points)


def _lednicer(points: Array) -> list[str]:
    middle = 0.5 * (points[0] + points[-1])
    nose = int(np.argmax(np.sum((points - middle) ** 2, axis=1)))
    suction, pressure = points[nose::-1], points[nose:]
    counts = f"{len(suction):10d}. {len(pressure):10d}."
    return [counts, "", *_rows(suction), "", *_rows(pressure)]


def _rows(points: Array) -> list[str]:
    return [f"{x:13.10f} {y:13.10f}" for x, y in points.tolist()]


LAYOUTS: dict[str, Callable[[Array], list[str]]] = {"selig": _selig, "lednicer": _lednicer}


def write_airfoil(airfoil: Airfoil, path: str | Path, *, layout: str = "selig") -> None:
    """Write one airfoil to a file, ten digits behind the point.

    Parameters
    ----------
    airfoil : Airfoil
        Either side may come first in its coordinates; the file has the suction side first.
    path : str or Path
        Where to; an existing file is replaced once the new one is whole.
    layout : str
        One of `LAYOUTS`: "selig" or "lednicer".

    Raises
    ------
    ExportError
        If there is no such layout, or the file cannot be written.
    """
    instance(airfoil, Airfoil, "airfoil", "a bladegen.Airfoil", ExportError)
    one_of(layout, LAYOUTS, "layout", ExportError)
    title = " ".join(airfoil.name.split()) or "airfoil"
    lines = [title, *LAYOUTS[layout](oriented(airfoil.coordinates))]
    write_lines(path_of(path, "path", ExportError), lines)


def write_folder(definition: BladeDefinition, path: Path, layout: str) -> tuple[Finding, ...]:
    """Write a definition's airfoils into a folder, one file each."""
    target = folder(path)
    stems: dict[str, str] = {}
    for station in uniquely_named(definition.stations):
        name = station.airfoil.name
        if name in stems:
            continue
        stem, count = safe_stem(name), 2
        while stem in stems.values():
            stem, count = f"{safe_stem(name)}-{count}", count + 1
        stems[name] = stem
        write_airfoil(station.airfoil, target / f"{stem}.dat", layout=layout)
    return (
        Finding("airfoil files", f"{len(stems)} airfoils; chord, twist, axis and places left out"),
    )
