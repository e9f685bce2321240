"""From a surface to a blade: the whole way, as one function.

Read (`sources`), find the blade in it (`pose`), measure sections along its axis where they are
needed (`surveying`), keep as few airfoils as hold the tolerance (`stations`), and measure what the
blade of these misses (`fitted`).
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.edges import AsGiven
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import BladegenError, Finding, GeometryError
from bladegen.fitting.fitted import NORMAL, Fitted
from bladegen.fitting.like import model_like, parameters_of
from bladegen.fitting.measuring import Cutting, uncrossed
from bladegen.fitting.placing.finding import FRAMES, UNITS, found
from bladegen.fitting.placing.root import ROOTS
from bladegen.fitting.sections.chains import Cut
from bladegen.fitting.sections.cutting import Cutter
from bladegen.fitting.sources import source_of
from bladegen.fitting.stations import definition_of, fewest
from bladegen.fitting.surveying import surveyed
from bladegen.measures import distances, surfaces
from bladegen.measures.sides import MILLIMETRES, Side
from bladegen.parametric.model import ParametricBlade
from bladegen.support.arguments import amount, one_of, whole
from bladegen.support.arrays import Array
from bladegen.surface.mesh import TriangleMesh

__all__ = ["fit"]

TOLERANCE = 1e-3  # m
BEFORE = 1e-3  # m before the root, from which on points are of no blade
AIRFOILS = 0.4  # of the tolerance and the noise, for shapes between stations
SAMPLES = 6_000  # points of the source that are held against the blade


def fit(
    source: str | Path | Side | TriangleMesh | Array,
    *,
    like: Blade | BladeDefinition | ParametricBlade | None = None,
    tolerance: float = TOLERANCE,
    unit: str | None = None,
    frame: str = "auto",
    root: str = "auto",
    name: str | None = None,
    length: float | None = None,
    samples: int = SAMPLES,
    progress: Callable[[str], None] = lambda _: None,
) -> Fitted:
    """Fit a blade's definition to a surface of unknown origin.

    Parameters
    ----------
    source : str, Path, TriangleMesh or (m, 3) array
        A CAD file (STEP, IGES, BREP), a mesh file (STL, PLY, OBJ, GLB, ...), points (.xyz, .csv,
        .ply without triangles) or a table of sections (.csv, .txt); triangles or points [m].
    like : Blade, BladeDefinition or ParametricBlade, optional
        A blade whose parameters are fitted besides, with their covariance: `Fitted.parameters`.
    tolerance : float
        Distance to the surface that 99 % of its points shall keep [m].
    unit : str, optional
        "m", "mm", "cm", "in" or "ft"; by default what the file says, or what its size suggests. Of
        a CAD file, what its millimetres are.
    frame : str
        "auto", "file" or "blade": see `finding.found`.
    root : str
        What the pitch axis follows: the root's "flange", its "circles" where its end is a cut, or
        "auto": the flange, unless it is more than 4 degrees off the circles' axis.
    name : str, optional
        The blade's name; by default the file's.
    length : float, optional
        Of the blade [m], for tables of sections that give span fractions alone.
    samples : int
        Points of the source that are held against the blade, at most.
    progress : callable
        Told what is being done.

    Returns
    -------
    Fitted
        Whether the tolerance is held is `Fitted.held`.

    Raises
    ------
    FileError
        If the file cannot be read.
    GeometryError
        If it holds no blade; the message says what is missing.
    """
    amount(tolerance, "tolerance", BladegenError)
    if not tolerance > 0.0:
        raise BladegenError(f"tolerance: got {tolerance:g} m, must be positive")
    if length is not None and not amount(length, "length", BladegenError) > 0.0:
        raise BladegenError(f"length: got {length:g} m, must be positive")
    one_of(frame, FRAMES, "frame", BladegenError)
    one_of(root, ROOTS, "root", BladegenError)
    if unit is not None:
        one_of(unit, UNITS, "unit", BladegenError)
    model = None if like is None else model_like(like)
    progress("reading")
    side, cloud, noise = source_of(source, length, unit, progress)
    if unit is not None and side.surface.patches:  # they are in metres by now
        side = side if isinstance(source, str | Path) else _scaled(side, unit)
        unit = None
    called = name or (Path(source).stem if isinstance(source, str | Path) else "blade")
    said_of = str(source) if isinstance(source, str | Path) else called
    progress("finding the blade")
    pose = found(
        side.surface,
        said_of,
        metres=1.0 if side.measured else None,
        unit=unit,
        frame=frame,
        root=root,
        flanged=cloud is None,
    )
    surface = pose.surface(side.surface)
    progress("measuring sections")
    cuts = _counted(Cutter(surface).cuts, progress)
    text = said_of if isinstance(source, str | Path) else ""
    try:
        sections, length = surveyed(cuts, surface.mesh.vertices, tolerance, said_of)
        remarks = side.remarks
        if cloud is not None:
            sections, said = uncrossed(sections, said_of)
            remarks = (*remarks, *said)
        progress("choosing stations")
        allowed = tolerance + NORMAL * pose.scale * noise
        rows = fewest(sections, length, AIRFOILS * allowed, name=called, progress=progress)
        definition = definition_of(sections, rows, length, name=called, source=text)
        skin = surfaces.of_blade(Blade.from_definition(definition, trailing_edge=AsGiven()))
    except GeometryError as error:
        if str(error).startswith(said_of):
            raise
        raise GeometryError(
            f"{said_of}: its sections make no blade ({error}); is it one whole blade, and does its "
            "surface not cross itself?"
        ) from None
    progress("measuring distances")
    points = _sample(
        surface.mesh.vertices[np.unique(surface.mesh.faces)] if cloud is None else pose(cloud),
        whole(samples, "samples", BladegenError),
    )
    points = points[points[:, 2] > -BEFORE]
    residuals = distances.signed(points, skin)
    findings = [Finding("source", text) for text in (*pose.said, *remarks)]
    spans = np.clip(points[:, 2] / length, 0.0, 1.0)
    if model is not None:
        progress("fitting parameters")
    return Fitted(
        definition,
        pose,
        sections,
        surface,
        points,
        residuals,
        spans,
        tolerance,
        pose.scale * noise,
        tuple(findings),
        None if model is None else parameters_of(points, model),
    )


def _counted(cuts: Cutting, progress: Callable[[str], None]) -> Cutting:
    """Let cuts say how many they are."""
    done = 0

    def cut(origins: Array, frames: Array) -> list[Cut]:
        nonlocal done
        found = cuts(origins, frames)
        done += len(found)
        progress(f"measuring sections, {done} cuts so far")
        return found

    return cut


def _scaled(side: Side, unit: str) -> Side:
    """Return a surface in metres whose millimetres are another unit."""
    factor = UNITS[unit] / MILLIMETRES
    return replace(
        side,
        surface=side.surface.scaled(factor),
        remarks=(*side.remarks, f"its millimetres are taken to be {unit}, as asked"),
    )


def _sample(points: Array, count: int) -> Array:
    """Return some of the points (m, 3), evenly over the file."""
    return points[:: max(1, -(-len(points) // max(count, 1)))]
