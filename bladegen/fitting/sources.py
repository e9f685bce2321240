"""What a blade is fitted to: a file or an array, as one surface, and the points of a cloud."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from bladegen.errors import BladegenError, FileError, GeometryError
from bladegen.fitting.clouds.reading import TEXTS, is_cloud, points_of, sound
from bladegen.fitting.clouds.surface import Progress, quiet, surface_of_points
from bladegen.fitting.placing.copies import one_of_copies
from bladegen.fitting.placing.finding import SHORTEST, UNITS
from bladegen.fitting.tables.lofting import surface_of_sections
from bladegen.fitting.tables.reading import Table, table_of
from bladegen.measures import surfaces
from bladegen.measures.foreign import SOLIDS
from bladegen.measures.sides import Side, surface_of
from bladegen.support.arguments import numbers
from bladegen.support.arrays import Array
from bladegen.surface.mesh import TriangleMesh

__all__ = ["source_of"]


def source_of(
    source: str | Path | Side | TriangleMesh | Array,
    length: float | None,
    unit: str | None,
    progress: Progress = quiet,
) -> tuple[Side, Array | None, float]:
    """Return a source's surface, its points if it has no surface of its own, and their noise.

    Parameters
    ----------
    source : str, Path, Side, TriangleMesh or (m, 3) array
        See `fit`.
    length : float, optional
        Of the blade [m], for tables of sections at span fractions.
    unit : str, optional
        Of `UNITS`: what the millimetres of a CAD file are.
    progress : callable
        Told what is being done.
    """
    if isinstance(source, np.ndarray):
        points = numbers(source, "source", BladegenError, "points (m, 3)")
        return _clouded(points, "the points", progress)
    if isinstance(source, str | Path) and Path(source).suffix.lower() in TEXTS:
        return _tabled(table_of(Path(source)), length, unit, progress)
    if length is not None:
        raise BladegenError(
            "length: is for tables of sections at span fractions; other sources have their own"
        )
    if isinstance(source, str | Path) and is_cloud(Path(source)):
        return _clouded(points_of(Path(source)), str(source), progress)
    if isinstance(source, Side):
        side = source
    elif isinstance(source, TriangleMesh):
        side = Side("the mesh", surfaces.of_mesh(source))
    else:
        side = _filed(Path(source), unit)
    if not side.surface.patches:
        mesh, said = one_of_copies(side.surface.mesh)
        side = replace(side, surface=surfaces.of_mesh(mesh), remarks=side.remarks + said)
    return side, None, 0.0


def _filed(path: Path, unit: str | None) -> Side:
    """Return the surface of a CAD or mesh file."""
    if path.suffix.lower() not in SOLIDS:
        return surface_of(path)
    side = surface_of(path, millimetres=UNITS[unit or "mm"])
    if unit is None and side.surface.size < SHORTEST:
        raise GeometryError(
            f"{path}: is {side.surface.size:.3g} m long, no blade's length: if its millimetres are "
            "metres, --unit m; if it is a model as small as that, --unit mm"
        )
    if unit is None:
        return side
    return replace(
        side, remarks=(*side.remarks, f"its millimetres are taken to be {unit}, as asked")
    )


def _tabled(
    table: Table, length: float | None, unit: str | None, progress: Progress
) -> tuple[Side, Array | None, float]:
    """Return the surface through a table's sections, or about its points."""
    if unit is not None and table.metres not in (None, UNITS[unit]):
        raise FileError(
            table.path, [f"its titles say a unit of {table.metres:g} m, --unit {unit} another"]
        )
    rows = table.sections()
    metres = table.metres
    if rows is None:
        points = sound(table.points * (metres or 1.0), table.path)
        return _clouded(points, table.path, progress, measured=metres is not None)
    told = None if length is None else length / (metres or UNITS[unit or "m"])
    mesh, said = surface_of_sections(table, rows, told)
    vertices = sound(mesh.vertices * (metres or 1.0), table.path)
    surface = surfaces.of_mesh(TriangleMesh(vertices, mesh.faces))
    return Side(table.path, surface, measured=metres is not None, remarks=said), None, 0.0


def _clouded(
    points: Array, name: str, progress: Progress, *, measured: bool = False
) -> tuple[Side, Array, float]:
    if points.ndim != 2 or points.shape[1] != 3:
        raise BladegenError(f"source: got the shape {points.shape}, must be points (m, 3)")
    cloud = surface_of_points(points, name, progress)
    said = f"{len(points)} points, smoothed; they scatter by {cloud.noise:.3g} of their unit"
    rim = (
        "their axis is normal to the rim of the root"
        if cloud.rimmed
        else "they show no flat rim of a root: their axis is the longest, which leans where a "
        "blade is prebent or swept; --root circles takes that of a round root"
    )
    side = Side(name, surfaces.of_mesh(cloud.mesh), measured=measured, remarks=(said, rim))
    return side, points, cloud.noise
