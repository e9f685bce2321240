"""A blade's sections, edges and axes as curves for other CAD systems, on the solid's own surface.

Sections at stations are loops of the suction side's curve, the pressure side's and, where the edge
is blunt, the line across it; the edges run along the same surface.  All are its isoparametric
curves, so that a loft through them, or a curve on it, is held to them exactly.  The axes are
the definition's.  Millimetres.
"""

from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.cad import shaping, step_documents
from bladegen.cad.shapes import MILLIMETRES, members
from bladegen.cad.solids import Solid
from bladegen.cad.step_documents import Part
from bladegen.support.arrays import Array
from bladegen.surface.net import SurfaceNet
from bladegen.surface.regions import COLOURS, EDGE, ROOT, SUCTION, TIP
from bladegen.surface.splines import DEGREE

__all__ = ["curves", "write_curves"]

SAME = 1e-9  # m; an axis of lower smoothness is missed by more between its grid points


def write_curves(solid: Solid, blade: Blade, path: Path, **options: Any) -> None:
    """Write a blade's curves as STEP, each a part of its own; options as of `step_documents`.

    Raises
    ------
    CadError
        If OCCT cannot write the file.
    """
    step_documents.write_parts(f"{solid.name} curves", curves(solid, blade), path, **options)


def curves(solid: Solid, blade: Blade) -> list[Part]:
    """Return a blade's curves as named wires [mm]: stations from the root on, edges, axes."""
    net = solid.net
    first, second = net.halves()
    blunt = net.blunt
    parts = [
        _part(f"station {number}, eta {eta:.4f}", _loop(first, second, eta, blunt), ROOT)
        for number, eta in enumerate(blade.eta.tolist(), start=1)
    ]
    parts.append(_part("leading edge", [_edge(first.poles[-1], net.v_knots)], SUCTION))
    ends = (net.poles[0], net.poles[-1]) if blunt else (net.poles[0],)
    names = [f"{EDGE}, {side}" for side in blade.sides] if blunt else [EDGE]
    for name, row in zip(names, ends, strict=True):
        parts.append(_part(name, [_edge(row, net.v_knots)], EDGE))
    parts.append(_part("reference axis", [_edge(*_axis(blade))], TIP))
    pitch = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, blade.length]]) * MILLIMETRES
    parts.append(_part("pitch axis", [shaping.line(*pitch)], TIP))
    return parts


def _loop(first: SurfaceNet, second: SurfaceNet, eta: float, blunt: bool) -> list[Any]:
    """Return the edges of a station: the curves of both sides, and the line between their ends."""
    rows = [_row(half, eta) for half in (first, second)]
    edges = [_edge(row, half.u_knots) for row, half in zip(rows, (first, second), strict=True)]
    if blunt:
        edges.append(shaping.line(rows[1][-1] * MILLIMETRES, rows[0][0] * MILLIMETRES))
    return edges


def _row(net: SurfaceNet, v: float) -> Array:
    """Return the poles of a surface's curve at a span, exactly."""
    from scipy.interpolate import BSpline

    return np.asarray(BSpline(net.v_knots, net.poles, DEGREE, axis=1)(v))


def _axis(blade: Blade) -> tuple[Array, Array]:
    """Return poles [m] and knots of the reference axis, piecewise cubics in eta."""
    from scipy.interpolate import BSpline, make_interp_spline

    axis = blade.definition.axis
    grid = np.unique(np.concatenate([[0.0, 1.0], axis.x.grid, axis.y.grid, axis.z.grid]))
    grid = grid[(grid >= 0.0) & (grid <= 1.0)]
    starts, steps = grid[:-1, None], np.diff(grid)[:, None]
    for times, shares in ((2, [1 / 3, 2 / 3]), (3, [0.0, 1 / 3, 2 / 3])):
        inner = np.repeat(grid[1:-1], times)
        knots = np.concatenate([[0.0] * 4, inner, [1.0] * 4])
        at = np.unique(np.concatenate([[0.0], (starts + steps * shares).ravel(), [1.0]]))
        spline: BSpline = make_interp_spline(at, blade.axis(at), DEGREE, t=knots)
        between = (starts + steps * [0.15, 0.5, 0.85]).ravel()
        if np.abs(spline(between) - blade.axis(between)).max() <= SAME:
            break
    return np.asarray(spline.c), np.asarray(spline.t)


def _edge(poles: Array, knots: Array) -> Any:
    """Return the edge [mm] along a spline of poles [m]."""
    return shaping.edge(shaping.curve(poles * MILLIMETRES, knots))


def _part(name: str, edges: list[Any], like: str) -> Part:
    """Return a wire of edges under a name, in the colour of a region."""
    wire = shaping.wire(edges)
    return Part(name, wire, [("", edge, COLOURS[like]) for edge in members(wire, "edge")])
