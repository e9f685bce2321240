"""Curvature combs of a blade's airfoils, as given and as faired: noise that contours hide.

A comb's teeth stand on the contour, normal to it, as long as the curvature there; the line
through their tips is ragged where the coordinates carry noise.  Drawn by matplotlib.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.airfoils.landmarks import Contour, contour
from bladegen.blade.blade import Blade
from bladegen.support.arrays import Array, Mask
from bladegen.views.plots.figures import figure, save_figure, titled
from bladegen.views.plots.style import BASELINE, INK, VARIANT

__all__ = ["Comb", "comb", "draw", "drawing", "figures", "roughness"]

BETWEEN = 4  # teeth a span of the contour's spline
NOSE, EDGE = 0.05, 0.98  # of chord; ahead and behind, curvature is of another size
HEIGHT = 0.25  # of chord: the tooth at the largest curvature that is drawn
LARGEST = 98.0  # per cent of the faired teeth are drawn to scale, longer ones are cut
AS_GIVEN, FAIRED = BASELINE, VARIANT  # colours
COLUMNS = 3
MOST = 12  # airfoils that are drawn; the report has the figures of all


@dataclass(frozen=True, eq=False)
class Comb:
    """Curvature along a contour.

    Parameters
    ----------
    points, normal : (m, 2) arrays
        Where the teeth stand, and their directions, outward; in chords.
    curvature : (m,) array
        Signed, positive where the contour is convex [1/chord].
    """

    points: Array
    normal: Array
    curvature: Array


def comb(curve: Contour) -> Comb:
    """Return a contour's comb, `BETWEEN` teeth a span of its spline."""
    knots = curve.spline.x
    steps = np.arange(0.0, len(knots) - 1 + 0.5 / BETWEEN, 1.0 / BETWEEN)
    t = np.interp(steps, np.arange(len(knots)), knots)
    one, two = curve.spline(t, 1), curve.spline(t, 2)
    speed = np.hypot(*one.T)
    curvature = (one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]) / speed**3
    normal = np.stack([one[:, 1], -one[:, 0]], axis=-1) / speed[:, None]
    return Comb(np.asarray(curve.spline(t)), normal, curvature)


def roughness(curve: Contour) -> float:
    """Return the total variation of the curvature between nose and trailing edge [1/chord]."""
    teeth = comb(curve)
    x = teeth.points[:-1, 0]
    between = (x > NOSE) & (x < EDGE)
    return float(np.abs(np.diff(teeth.curvature))[between].sum())


def figures(blade: Blade) -> list[dict[str, Any]]:
    """Return how far each airfoil was moved, and its roughness as given and as faired."""
    return [
        {
            "airfoil": name,
            "moved_by_chord": faired.moved,
            "roughness_given": roughness(given),
            "roughness_faired": roughness(faired),
        }
        for name, (given, faired) in _pairs(blade).items()
    ]


def draw(blade: Blade, path: Path) -> None:
    """Draw the combs of a blade's airfoils, as given and as faired, into a PNG, SVG or PDF.

    Raises
    ------
    ExportError
        If the path has none of these suffixes.
    """
    save_figure(drawing(blade), path)


def drawing(blade: Blade, _baseline: Blade | None = None) -> Any:
    """Return a figure of the combs of a blade's airfoils, as given and as faired.

    A perturbation leaves a blade the airfoils of its baseline, so there is one of each; of many,
    those are drawn that are roughest as given, in their order.
    """
    every = _pairs(blade)
    roughest = sorted(every, key=lambda name: roughness(every[name][0]), reverse=True)[:MOST]
    curves = {name: pair for name, pair in every.items() if name in roughest}
    rows = max(1, -(-len(curves) // COLUMNS))
    drawn, axes = figure(rows, COLUMNS, width=5.2 * COLUMNS, height=3.6 * rows + 0.4)
    for axis, (name, pair) in zip(axes.flat, curves.items(), strict=False):
        given, faired = (comb(curve) for curve in pair)
        longest = float(np.percentile(np.abs(faired.curvature[_behind(faired)]), LARGEST))
        for teeth, colour, width, label in (
            (given, AS_GIVEN, 0.6, "as given"),
            (faired, FAIRED, 1.0, "faired"),
        ):
            length = HEIGHT * np.clip(teeth.curvature / longest, -1.5, 1.5)
            tips = teeth.points + length[:, None] * teeth.normal
            shown = np.where(_behind(teeth)[:, None], tips, np.nan)
            axis.plot(*shown.T, color=colour, linewidth=width, label=label)
        axis.plot(*faired.points.T, color=INK, linewidth=0.8)
        before, after = (roughness(curve) for curve in pair)
        axis.set_title(f"{name}: {before:.3g} to {after:.3g}", fontsize=9)
        axis.set(xlabel="x, chords", ylabel="y, chords", aspect="equal")
        axis.tick_params(labelsize=7)
        if axis is axes.flat[0]:
            axis.legend(fontsize=7, loc="lower right")
    for axis in axes.flat[len(curves) :]:
        axis.remove()
    which = "the airfoils" if len(curves) == len(every) else f"the {MOST} roughest airfoils"
    return titled(
        drawn,
        blade,
        f"curvature combs of {which} behind {100 * NOSE:.0f} % chord, and the total variation "
        "of curvature, as given to as faired [1/chord]",
    )


def _pairs(blade: Blade) -> dict[str, tuple[Contour, Contour]]:
    """Return the contours of a blade's airfoils by name, as given and as faired."""
    faired = blade.contours or ()
    airfoils = [station.airfoil for station in blade.definition.stations[: len(faired)]]
    once = {airfoil.name: (airfoil, curve) for airfoil, curve in zip(airfoils, faired, strict=True)}
    return {name: (contour(airfoil.coordinates), curve) for name, (airfoil, curve) in once.items()}


def _behind(teeth: Comb) -> Mask:
    """Tell which teeth are drawn, (m,)."""
    x = teeth.points[:, 0]
    behind: Mask = (x > NOSE) & (x < EDGE)
    return behind
