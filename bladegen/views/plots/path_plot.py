"""The path of a blade's shapes on the Grassmannian: distances over span, normal coordinates."""

from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.shapes import grassmann
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array
from bladegen.views.plots.figures import figure, pair, titled
from bladegen.views.plots.style import BASELINE, CATEGORIES, INK, VARIANT

__all__ = ["path"]

SHAPES = 201  # of the path on the Grassmannian
LANDMARKS = 401  # that the bundled space was learned with
SAME_SHAPE = 1e-9  # rad


def path(blade: Blade, baseline: Blade | None = None) -> Any:
    """Draw the path on the Grassmannian: distances over the span, and normal coordinates."""
    drawn, ((away, speed), (coordinates, plane)) = figure(2, 2, width=11, height=7.6)
    eta = np.linspace(0.0, 1.0, SHAPES)
    space = ShapeSpace.bundled()
    known = len(blade.u) == LANDMARKS and bool(np.allclose(blade.u, space.u))
    for one, line in pair(blade, baseline):
        X = _shapes(one, eta)
        stations = _shapes(one, one.eta)
        own = grassmann.karcher_mean(_distinct(stations))
        colour = VARIANT if one is blade else BASELINE
        away.plot(eta, grassmann.distance(own[None], X), line, color=colour, label=one.name)
        away.plot(one.eta, grassmann.distance(own[None], stations), "o", color=colour, ms=4)
        rate = grassmann.distance(X[:-1], X[1:]) / np.diff(eta)
        speed.plot(0.5 * (eta[1:] + eta[:-1]), rate, line, color=colour)
        if known:
            t, marks = space.encode(X), space.encode(stations)
            for k in range(space.dimension):
                label = f"t{k + 1}" if one is blade else None
                shown = CATEGORIES[k % len(CATEGORIES)]
                coordinates.plot(eta, t[:, k], line, color=shown, label=label)
            plane.plot(t[:, 0], t[:, 1], line, color=colour)
            plane.plot(marks[:, 0], marks[:, 1], "o", color=colour, ms=4)
    away.set(title="from the stations' Karcher mean", xlabel="eta", ylabel="distance, rad")
    speed.set(title="speed of the path", xlabel="eta", ylabel="distance over eta, rad")
    coordinates.set(title="in the bundled space", xlabel="eta", ylabel="normal coordinates, rad")
    plane.set(title="the path in its first two coordinates", xlabel="t1, rad", ylabel="t2, rad")
    if known:
        some = space.coordinates[:: max(1, len(space.coordinates) // 2000)]
        plane.plot(*some[:, :2].T, ".", color="0.85", ms=2, zorder=0, label="the space's airfoils")
        plane.legend(fontsize=8, markerscale=4, frameon=False)
        coordinates.legend(fontsize=8, ncols=2, frameon=False)
    else:
        for axis in (coordinates, plane):
            note = f"needs {LANDMARKS} landmarks, the space's"
            axis.text(0.5, 0.5, note, ha="center", transform=axis.transAxes, color=INK)
    if baseline is not None:
        away.legend(fontsize=8, frameon=False)
    return titled(drawn, blade, "path on the Grassmannian")


def _shapes(blade: Blade, eta: Array) -> Array:
    """Return the blade's shapes (k, n, 2) on the Grassmannian, deformations included."""
    return blade.shapes(eta)[1]


def _distinct(points: Array) -> Array:
    """Return points of which no neighbours are the same: repeated stations count once."""
    fresh = grassmann.distance(points[:-1], points[1:]) > SAME_SHAPE
    return np.concatenate([points[:1], points[1:][fresh]])
