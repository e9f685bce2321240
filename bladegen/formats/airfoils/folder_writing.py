"""A folder of airfoil files beside a blade file: Selig coordinates and an index.

What `bladegen.formats.airfoils.folder_reading` reads: the index of the folder names each airfoil,
its file, its relative thickness, and, for formats that cannot say it, its place along the span.
"""

import csv
import io
from collections.abc import Sequence
from pathlib import Path

from bladegen.definition.blade_definition import Station
from bladegen.formats.airfoils.folder_reading import INDEX, INDEX_COLUMNS, companion
from bladegen.formats.airfoils.unique_names import unique_names
from bladegen.formats.common.number_text import exact, write_lines
from bladegen.support.files import folder, safe_stem

__all__ = ["write_airfoils"]


def write_airfoils(
    path: Path,
    stations: Sequence[Station],
    *,
    placed: bool,
    thickness: dict[int, float] | None = None,
) -> Path:
    """Write the airfoils of stations into the folder of the blade file `path`.

    Parameters
    ----------
    path : Path
        The blade file; the folder is named after it.
    stations : sequence of Station
        The blade's stations.
    placed : bool
        Whether the index tells where the stations are.
    thickness : dict, optional
        The relative thickness by an airfoil's `id`; if not given, what the airfoil states.
    """
    target = folder(companion(path))
    files: dict[int, str] = {}
    names = unique_names(stations)
    for k, (key, (name, airfoil)) in enumerate(names.items()):
        files[key] = f"{k + 1:03d}_{safe_stem(name)}.dat"
        rows = [f"{exact(x)} {exact(y)}" for x, y in airfoil.coordinates.tolist()]
        write_lines(target / files[key], [f"airfoil {name}", *rows])
    table = io.StringIO()
    index = csv.writer(table, lineterminator="\n")
    index.writerow(INDEX_COLUMNS)
    listed = stations if placed else [Station(0.0, airfoil) for _, airfoil in names.values()]
    for station in listed:
        key, stated = id(station.airfoil), station.airfoil.relative_thickness
        stated = stated if thickness is None else thickness[key]
        index.writerow(
            [
                names[key][0],
                files[key],
                "" if stated is None else exact(stated),
                exact(station.eta) if placed else "",
            ]
        )
    write_lines(target / INDEX, table.getvalue().splitlines())
    return target
