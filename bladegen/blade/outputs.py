"""What a blade gives to those who use it: a window, a mesh, a file, points, its volume.

These functions are methods of `Blade`.  Rooms above it do the work, and are asked for it by name
(`support.services`), so that a blade is made of nothing that draws or writes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from bladegen.blade.crowding import Crowding
from bladegen.blade.edges import PAIRWISE
from bladegen.blade.soundness import Trial
from bladegen.blade.spans import both_sides, grid_points, landmarks_at, span_fractions
from bladegen.errors import DefinitionError, GeometryError
from bladegen.support.arguments import whole
from bladegen.support.arrays import Array, ArrayLike, Indices
from bladegen.support.services import service, shown_by

if TYPE_CHECKING:
    from trimesh import Trimesh

__all__ = [
    "at_least",
    "breaks",
    "crowding",
    "export",
    "html",
    "layup",
    "mesh",
    "plot",
    "point",
    "require_sound",
    "stations",
    "volume",
]

Tip = Callable[..., Any]
Own = TypeVar("Own")


def plot(
    blade: Any,
    *,
    baseline: Any = None,
    colour: str = "plain",
    screenshot: str | Path | None = None,
) -> None:
    """Show the blade: in a window, as a picture in a notebook, or in a file.

    Parameters
    ----------
    baseline : Blade, optional
        What it was perturbed from: its lines are shown too, and `colour` may be "distance".
    colour : str
        "plain", "curvature" [1/m] or "distance" [m].
    screenshot : str or Path, optional
        A PNG to write instead, without a window.

    Raises
    ------
    RenderError
        If this machine has no display or cannot render, or there is no such colour.
    """
    service("plot_blade")(blade, baseline=baseline, colour=colour, screenshot=screenshot)


def mesh(blade: Any, *, stations: int = 300, tip: Tip | None = None) -> Trimesh:
    """Return the blade's surface as a `trimesh.Trimesh`: watertight, outward, in metres.

    Parameters
    ----------
    stations : int
        How many sections; their landmarks are the vertices.
    tip : callable, optional
        `bladegen.surface.tips.flat_tip`, the default, or `round_tip`.
    """
    made: Trimesh = service("trimesh_of")(blade, stations=stations, tip=tip)
    return made


def point(blade: Any, eta: ArrayLike, u: ArrayLike) -> Array:
    """Return points (..., 3) [m] of the surface, blade frame, at spans and landmark parameters.

    Parameters
    ----------
    eta : (...) array
        Span fractions, 0 (root) to 1 (tip).
    u : (...) array
        0 at the trailing edge of the first of `Blade.sides`, 0.5 at the leading edge, 1 at the
        trailing edge of the second; broadcast with `eta`, so ``point(eta[:, None], u)`` is a grid.
    """
    spans, places = np.broadcast_arrays(span_fractions(eta), landmarks_at(u))
    own, row = np.unique(spans, return_inverse=True)
    symmetric, column = both_sides(places)
    points: Array = blade.sections(own, symmetric)[row.reshape(spans.shape), column]
    return points


def stations(blade: Any, count: int = 120) -> Array:
    """Return span fractions (count,) that resolve shape, planform and axis, increasing.

    The root, the tip and the definition's are among them, others crowd where the surface bends.
    """
    fixed = np.unique(np.concatenate([[0.0], blade.eta, [1.0]]))
    found: Array = blade._crowding.spans(fixed, whole(count, "stations", DefinitionError))
    return found


def at_least(blade: Any, count: int) -> Array:
    """Return `stations`, more than `count` where the definition's own are more."""
    return stations(blade, max(count, len(np.union1d(blade.eta, [0.0, 1.0]))))


def crowding(blade: Any) -> Crowding:
    """How closely a blade's sections should stand to resolve it."""

    def at_landmarks(eta: Array, some: Indices) -> Array:
        if isinstance(blade.trailing_edge, PAIRWISE):
            try:
                watched: Array = blade.placed(blade.shape.at_landmarks(eta, some), eta)
                return watched
            except GeometryError:  # the thickest landmarks may not be among them
                pass
        sections: Array = blade.sections(eta)
        return sections[:, some]

    return Crowding.along(at_landmarks, len(blade.u))


def export(blade: Any, path: str | Path, **options: Any) -> Path:
    """Write the blade to a file in the format of its suffix; return the path.

    Options are those of `bladegen.export`, such as ``tolerance`` [m] of solids, ``stations`` and
    ``unit`` ("m" or "mm") of meshes, ``tip``, ``spacing`` of grids.
    """
    written: Path = service("export")(blade, path, **options)
    return written


def breaks(blade: Any) -> Array:
    """Span fractions at which the surface may turn or bend abruptly, increasing, 0 and 1 with them.

    They are the stations and the grid points of all distributions: chord, twist, offsets, axis,
    thickness and the coordinates of deformations.
    """
    coordinates = [deformation.t.grid for deformation in blade.deformations]
    points = [[0.0, 1.0], blade.eta, grid_points(blade.definition), *coordinates]
    return np.unique(np.clip(np.concatenate(points), 0.0, 1.0))


def volume(blade: Any) -> float:
    """The volume [m3] that the sections enclose, as `bladegen info` and `check` show it."""
    enclosed: float = service("volume")(blade)
    return enclosed


def layup(blade: Any) -> Any:
    """What lies inside the skin on its sections (`bladegen.blade.layup.layup.Layup`), or None."""
    return service("layup")(blade)


html = shown_by("blade_html")


def require_sound(blade: Own, *, allow_odd: bool = False) -> Own:
    """Return the blade if its sections are sound; findings say which are odd, if allowed.

    Raises
    ------
    PerturbationError
        If a section crosses itself or, unless that is allowed, is odd.
    """
    own: Any = blade
    asked = own.changes[-1] if own.changes else {}
    found = Trial(own.shape, own.definition, asked).findings(allow_odd=allow_odd)
    return replace(own, findings=own.findings + found) if found else blade
