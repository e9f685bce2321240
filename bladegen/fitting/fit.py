"""From a surface to a blade: the whole way, as one function.

Read, find the blade in it (`pose`), measure sections along its axis (`measuring`) where they are
needed, keep as few airfoils as hold the tolerance (`stations`), and measure what the blade of
these misses (`fitted`).
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.edges import AsGiven
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.distribution import pchip
from bladegen.definition.reference_axis import ReferenceAxis
from bladegen.errors import BladegenError, Finding, GeometryError
from bladegen.fitting.clouds.reading import is_cloud, points_of
from bladegen.fitting.clouds.surface import surface_of_points
from bladegen.fitting.fitted import Fitted
from bladegen.fitting.like import model_like, parameters_of
from bladegen.fitting.measuring import Cutting, Sections, axis_of, measured, settled
from bladegen.fitting.placing.copies import one_of_copies
from bladegen.fitting.placing.finding import FRAMES, UNITS, found
from bladegen.fitting.sections.cutting import Cutter
from bladegen.fitting.smoothing import steady_twist, with_twist
from bladegen.fitting.stations import definition_of, fewest
from bladegen.fitting.tips import length_along
from bladegen.measures import distances, surfaces
from bladegen.measures.sides import Side, surface_of
from bladegen.parametric.model import ParametricBlade
from bladegen.support.arguments import amount, numbers, one_of, whole
from bladegen.support.arrays import Array
from bladegen.surface.mesh import TriangleMesh

__all__ = ["fit"]

TOLERANCE = 1e-3  # m
COARSE = np.concatenate([np.linspace(1e-4, 0.05, 8), np.linspace(0.08, 0.985, 30)])
FIRST = np.unique(
    np.concatenate(
        [
            np.linspace(0.0, 0.05, 9),
            np.linspace(0.05, 0.95, 37),
            1.0 - 0.05 * 0.5 ** np.arange(7),
            [1.0],
        ]
    )
)
INSIDE = (1e-6, 1e-5, 1e-4, 5e-4, 2e-3, 5e-3)  # of the length, by which the last plane is inside
NEAR_TIP = (np.array([0.01, 0.006]), np.array([0.003, 0.0015]), np.array([0.0008, 0.0004]))
WHOLE, ALIKE = 0.5, 1.25  # of chord and thickness next to the tip: else it is half cut off
DISTRIBUTIONS = 0.2  # of the tolerance, for each of chord, twist, offset and prebend
AIRFOILS = 0.4  # of the tolerance, for shapes between stations
ROUNDS = 4  # of halving the steps between sections
MOST = 240  # sections
TURNS = 3  # of axis and planes, at last
SAMPLES = 6_000  # points of the source that are held against the blade


def fit(
    source: str | Path | Side | TriangleMesh | Array,
    *,
    like: Blade | BladeDefinition | ParametricBlade | None = None,
    tolerance: float = TOLERANCE,
    unit: str | None = None,
    frame: str = "auto",
    name: str | None = None,
    samples: int = SAMPLES,
    progress: Callable[[str], None] = lambda _: None,
) -> Fitted:
    """Fit a blade's definition to a surface of unknown origin.

    Parameters
    ----------
    source : str, Path, TriangleMesh or (m, 3) array
        A CAD file (STEP, IGES, BREP), a mesh file (STL, PLY, OBJ, GLB, ...) or points (.xyz, .csv,
        .ply without triangles); triangles or points [m].
    like : Blade, BladeDefinition or ParametricBlade, optional
        A blade whose parameters are fitted besides, with their covariance: `Fitted.parameters`.
    tolerance : float
        Distance to the surface that 99 % of its points shall keep [m].
    unit : str, optional
        "m", "mm", "cm", "in" or "ft"; by default what the file says, or what its size suggests. Of
        a CAD file, what its millimetres are.
    frame : str
        "auto", "file" or "blade": see `pose.found`.
    name : str, optional
        The blade's name; by default the file's.
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
    one_of(frame, FRAMES, "frame", BladegenError)
    if unit is not None:
        one_of(unit, UNITS, "unit", BladegenError)
    model = None if like is None else model_like(like)
    progress("reading")
    side, cloud, noise = _side(source)
    if unit is not None and side.surface.patches:  # CAD files are read as millimetres
        side = replace(side, surface=side.surface.scaled(1e3))
    called = name or (Path(source).stem if isinstance(source, str | Path) else "blade")
    said_of = str(source) if isinstance(source, str | Path) else called
    progress("finding the blade")
    pose = found(
        side.surface, said_of, metres=1.0 if side.measured else None, unit=unit, frame=frame
    )
    surface = pose.surface(side.surface)
    cuts = Cutter(surface).cuts
    progress("measuring sections")
    sections, length = _sections(cuts, surface.mesh.vertices, tolerance, said_of)
    progress("choosing stations")
    rows = fewest(sections, length, AIRFOILS * tolerance, name=called)
    text = said_of if isinstance(source, str | Path) else ""
    definition = definition_of(sections, rows, length, name=called, source=text)
    progress("measuring distances")
    points = _sample(
        surface.mesh.vertices[np.unique(surface.mesh.faces)] if cloud is None else pose(cloud),
        whole(samples, "samples", BladegenError),
    )
    blade = Blade.from_definition(definition, trailing_edge=AsGiven())
    residuals = distances.signed(points, surfaces.of_blade(blade))
    findings = [Finding("source", text) for text in (*pose.said, *side.remarks)]
    spans = np.clip(points[:, 2] / length, 0.0, 1.0)
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


def _side(
    source: str | Path | Side | TriangleMesh | Array,
) -> tuple[Side, Array | None, float]:
    """Return a source's surface, its points if it has no surface of its own, and their noise."""
    if isinstance(source, np.ndarray):
        return _clouded(numbers(source, "source", BladegenError, "points (m, 3)"), "the points")
    if isinstance(source, str | Path) and is_cloud(Path(source)):
        return _clouded(points_of(Path(source)), str(source))
    if isinstance(source, Side):
        side = source
    elif isinstance(source, TriangleMesh):
        side = Side("the mesh", surfaces.of_mesh(source))
    else:
        side = surface_of(Path(source))
    if not side.surface.patches:
        mesh, said = one_of_copies(side.surface.mesh)
        side = replace(side, surface=surfaces.of_mesh(mesh), remarks=side.remarks + said)
    return side, None, 0.0


def _clouded(points: Array, name: str) -> tuple[Side, Array, float]:
    if points.ndim != 2 or points.shape[1] != 3:
        raise BladegenError(f"source: got the shape {points.shape}, must be points (m, 3)")
    cloud = surface_of_points(points, name)
    said = f"{len(points)} points, smoothed; they scatter by {cloud.noise:.3g} of their unit"
    side = Side(name, surfaces.of_mesh(cloud.mesh), measured=False, remarks=(said,))
    return side, points, cloud.noise


def _sections(cuts: Cutting, points: Array, tolerance: float, name: str) -> tuple[Sections, float]:
    """Measure sections as close as the distributions need, and the blade's length."""
    rough = float(points[:, 2].max())
    coarse, axis = settled(cuts, COARSE, rough, name=name)
    z, prebend = coarse.eta * rough, coarse.prebend
    length = length_along(points, axis)
    for near in NEAR_TIP:  # the tip's plane is as good as the axis' end
        axis = axis_of(z / length, prebend, length)
        more = measured(cuts, axis, 1.0 - near, name=name, guide=coarse)
        z, prebend = np.append(z, more.eta * length), np.append(prebend, more.prebend)
        order = np.argsort(z)
        z, prebend = z[order], prebend[order]
        length = length_along(points, axis_of(z / length, prebend, length))
    axis = axis_of(z / length, prebend, length)
    last = _to_the_tip(cuts, axis, name)
    axis = axis_of(last.eta, last.prebend, length)
    eta = _refined(cuts, last, axis, tolerance, name)
    sections = measured(cuts, axis, eta, name=name)
    twist = steady_twist(sections)
    for _ in range(TURNS):  # planes follow the axis, and the axis the chord lines
        sections = with_twist(sections, twist)
        axis = axis_of(eta, sections.prebend, length)
        sections = measured(cuts, axis, eta, name=name)
    sections = with_twist(sections, twist)
    reach = length * float(sections.eta[-1])
    eta = sections.eta / sections.eta[-1]
    eta[0] = 0.0
    return replace(sections, eta=eta), reach


def _to_the_tip(cuts: Cutting, axis: ReferenceAxis, name: str) -> Sections:
    """Measure first sections, the last one so far inside that it is whole."""
    found = None
    for inside in INSIDE:
        at = FIRST.copy()
        at[[0, -1]] = inside, 1.0 - inside
        try:
            sections = measured(cuts, axis, at, name=name)
        except GeometryError:
            if inside == INSIDE[-1] and found is None:
                raise
            continue
        found = sections
        same = sections.thickness[-1] / sections.thickness[-2]
        if 1.0 / ALIKE < same < ALIKE and sections.chord[-1] > WHOLE * sections.chord[-2]:
            break
    assert found is not None
    return found


def _refined(
    cuts: Cutting, sections: Sections, axis: ReferenceAxis, tolerance: float, name: str
) -> Array:
    """Return spans between which chord, twist, offset and prebend are as their splines have it."""
    start, end = sections.eta[:-1], sections.eta[1:]
    for _ in range(ROUNDS):
        middle = 0.5 * (start + end)
        if not middle.size or len(sections.eta) + len(middle) > MOST:
            break
        between = measured(cuts, axis, middle, name=name, guide=sections)
        off = np.zeros(len(middle))
        for quantity, size in (
            ("chord", 1.0),
            ("twist", between.chord),
            ("offset", 1.0),
            ("prebend", 1.0),
            ("thickness", between.chord),
        ):
            wanted = pchip(sections.eta, getattr(sections, quantity))(middle)
            off = np.maximum(off, size * np.abs(getattr(between, quantity) - wanted))
        sections = sections.joined(between)
        wide = off > DISTRIBUTIONS * tolerance
        start, middle, end = start[wide], middle[wide], end[wide]
        start, end = np.concatenate([start, middle]), np.concatenate([middle, end])
    return sections.eta


def _sample(points: Array, count: int) -> Array:
    """Return some of the points (m, 3), evenly over the file."""
    return points[:: max(1, -(-len(points) // max(count, 1)))]
