"""Diagrams of a blade over its span, and of its sections: one function a figure.

`PLOTS` names them. Each takes a blade and, if it was perturbed, its baseline, and returns a
matplotlib figure that belongs to nobody else.  Spans are eta, lengths metres, angles degrees.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.curves.sides import sides
from bladegen.measures.spanwise import LINES, spanwise
from bladegen.shapes import affine
from bladegen.support.arrays import Array
from bladegen.views.plots import combs
from bladegen.views.plots.figures import dress, figure, figure_of, pair, shade, titled
from bladegen.views.plots.grid_plot import grid
from bladegen.views.plots.layup_plot import layup
from bladegen.views.plots.path_plot import path
from bladegen.views.plots.style import BASELINE, INK, VARIANT
from bladegen.views.plots.volume_plot import volume

__all__ = ["PLOTS", "Plot", "drawable", "overview"]

SPANS = 401  # points of a curve over the span
CURVED = (0.15, 0.3, 0.5, 0.7, 0.9)  # span fractions of the curvature's sections
CURVATURE_SHOWN = 90  # per cent of the landmarks; noses are far rounder than the rest
EDGE = 0.01  # of the contour at either end that curvature leaves out: trailing edges are corners
Drawn = Callable[[Blade, Blade | None], Any]


@dataclass(frozen=True)
class Plot:
    """A figure: what it shows, and the function that draws it."""

    about: str
    draw: Drawn


def planform(blade: Blade, baseline: Blade | None = None) -> Any:
    """Draw the outline, and chord, twist, relative thickness and prebend over the span."""
    drawn = figure_of(11.0, 8.0)
    grid = drawn.add_gridspec(3, 2, height_ratios=[0.8, 1.0, 1.0])
    outline = drawn.add_subplot(grid[0, :])
    _outline(outline, blade, baseline)
    eta = np.linspace(0.0, 1.0, SPANS)
    swept = bool(np.any(blade.axis(eta)[:, 1]))
    curves: dict[str, Callable[[Blade], Array]] = {
        "chord, m": lambda one: one.chord(eta),
        "twist, deg": lambda one: np.degrees(one.twist(eta)),
        "thickness over chord, %": lambda one: 100.0 * one.relative_thickness(eta),
        "prebend x, m": lambda one: one.axis(eta)[:, 0],
    }
    if swept:
        curves["sweep y, m"] = lambda one: one.axis(eta)[:, 1]
        grid = drawn.add_gridspec(3, 6, height_ratios=[0.8, 1.0, 1.0])
        cells = [grid[1, :3], grid[1, 3:], grid[2, :2], grid[2, 2:4], grid[2, 4:]]
    else:
        cells = [grid[1, 0], grid[1, 1], grid[2, 0], grid[2, 1]]
    for cell, (label, values) in zip(cells, curves.items(), strict=True):
        _over_span(drawn.add_subplot(cell), label, eta, values, blade, baseline)
    for axis in drawn.axes:
        dress(axis)
    return titled(drawn, blade, "planform")


def sections(blade: Blade, baseline: Blade | None = None) -> Any:
    """Draw the stations' sections in metres, in chords, and standardised."""
    drawn, ((metres, chords, standard),) = figure(1, 3, width=14, height=4.8)
    eta = np.unique(blade.eta)
    for one, line in pair(blade, baseline):
        profiles = one.profiles(eta)
        X, M, _ = affine.standardise(profiles)
        X, _ = affine.cluster(X, M)
        placed = one.sections(eta)
        for k, at in enumerate(eta):
            colour = shade(k / max(len(eta) - 1, 1))
            style = {"color": colour, "linestyle": line, "linewidth": 1.2}
            label = f"{at:.3f}" if one is blade else None
            metres.plot(placed[k, :, 1], placed[k, :, 0], label=label, **style)
            chords.plot(*profiles[k].T, **style)
            standard.plot(*X[k].T, **style)
    metres.set(title="in the blade frame", xlabel="y, m", ylabel="x, m")
    chords.set(title="physical, unit chord", xlabel="x / chord", ylabel="y / chord")
    standard.set(title="landmark-affine standardised", xlabel="X, column 1", ylabel="X, column 2")
    for axis in (metres, chords, standard):
        axis.set_aspect("equal", adjustable="datalim")
        axis.locator_params(axis="x", nbins=6)
    drawn.legend(
        *metres.get_legend_handles_labels(),
        loc="outside right upper",
        title="eta",
        fontsize=8,
        title_fontsize=9,
        frameon=False,
    )
    return titled(drawn, blade, "sections at the stations", baseline)


def curvature(blade: Blade, baseline: Blade | None = None) -> Any:
    """Draw the curvature of sections along the chord, a panel for each."""
    drawn, axes = figure(len(CURVED), 1, width=10, height=1.9 * len(CURVED))
    inner = (blade.u > EDGE) & (blade.u < 1.0 - EDGE)
    sides_of = (
        ("suction side", blade.u <= 0.5, VARIANT),
        ("pressure side", blade.u >= 0.5, BASELINE),
    )
    profiles = blade.profiles(np.array(CURVED))
    bend = _section_curvature(blade, profiles)
    reach = float(np.percentile(np.abs(bend[:, inner]), CURVATURE_SHOWN))
    if baseline is not None:
        before = baseline.profiles(np.array(CURVED))
        bend_before = _section_curvature(baseline, before)
    for k, axis in enumerate(axes[:, 0]):
        for label, side, colour in sides_of:
            kept = side & inner
            axis.plot(profiles[k, kept, 0], bend[k, kept], color=colour, lw=1.2, label=label)
            if baseline is not None:
                axis.plot(before[k, kept, 0], bend_before[k, kept], "--", color=colour, lw=0.8)
        axis.axhline(0.0, color=INK, linewidth=0.8)
        axis.set(ylim=(-reach, reach), ylabel=f"eta = {CURVED[k]:g}", xlim=(-0.01, 1.01))
        if k + 1 < len(CURVED):
            axis.tick_params(labelbottom=False)
    axes[-1, 0].set_xlabel("x / chord")
    axes[0, 0].legend(fontsize=8, frameon=False, loc="lower left", ncols=2)
    what = "curvature times chord of sections, convex positive"
    return titled(drawn, blade, what, baseline)


def thickness(blade: Blade, baseline: Blade | None = None) -> Any:
    """Draw thickness in metres and over chord, and the thickness and camber lines of sections."""
    drawn, axes = figure(2, 2, width=11, height=7.6)
    eta = np.linspace(0.0, 1.0, SPANS)
    table = {id(one): spanwise(one, eta) for one, _ in pair(blade, baseline)}
    ratio, metres = "thickness over chord, %", "thickness, m"
    _over_span(
        axes[0, 0],
        ratio,
        eta,
        lambda one: 100.0 * table[id(one)]["relative_thickness"],
        blade,
        baseline,
    )
    _over_span(
        axes[0, 1],
        metres,
        eta,
        lambda one: table[id(one)]["relative_thickness"] * table[id(one)]["chord_m"],
        blade,
        baseline,
    )
    for one, line in pair(blade, baseline):
        upper, lower = sides(one.profiles(np.array(CURVED)), LINES)
        for k, at in enumerate(CURVED):
            style = {"color": shade(k / (len(CURVED) - 1)), "linestyle": line}
            label = f"{at:.2f}" if one is blade else None
            axes[1, 0].plot(LINES, 100.0 * (upper - lower)[k], label=label, **style)
            axes[1, 1].plot(LINES, 50.0 * (upper + lower)[k], **style)
    axes[1, 0].set(xlabel="x / chord", ylabel="thickness, % chord", title="between the sides")
    axes[1, 1].set(xlabel="x / chord", ylabel="camber, % chord", title="middle of the sides")
    axes[1, 0].legend(fontsize=8, title="eta", title_fontsize=9, frameon=False)
    return titled(drawn, blade, "thickness and camber", baseline)


def overview(blade: Blade) -> Any:
    """Draw a blade in little: its outline over its chord, twist and some sections."""
    drawn, ((outline,), (shapes,)) = figure(2, 1, width=7.2, height=3.0)
    _outline(outline, blade, None)
    outline.set_ylabel("")
    eta = np.linspace(0.05, 0.98, 7)
    profiles = blade.profiles(eta)
    for k, at in enumerate(eta):
        shapes.fill(*(profiles[k] + [1.2 * k, 0.0]).T, color=shade(at), linewidth=0.8, alpha=0.35)
        shapes.plot(*(profiles[k] + [1.2 * k, 0.0]).T, color=shade(at), linewidth=1.2)
        shapes.text(1.2 * k + 0.5, -0.62, f"eta {at:.2f}", ha="center", fontsize=8, color=INK)
    shapes.set(aspect="equal", ylim=(-0.7, 0.55))
    shapes.axis("off")
    return drawn


PLOTS = {
    "planform": Plot("outline, chord, twist, thickness and prebend over the span", planform),
    "sections": Plot("the stations in metres, in chords and standardised", sections),
    "path": Plot("distances and normal coordinates on the Grassmannian over the span", path),
    "curvature": Plot("curvature along sections", curvature),
    "thickness": Plot("thickness over the span, thickness and camber along sections", thickness),
    "layup": Plot("layers and webs over the span and on sections", layup),
    "combs": Plot("curvature combs of the airfoils, as given and as faired", combs.drawing),
    "grid": Plot("the structured grid's cells at flat and round tips, by scaled Jacobian", grid),
    "volume": Plot("a cut through the volume around the blade, by scaled Jacobian", volume),
}


def drawable(blade: Blade) -> list[str]:
    """Return the names of the plots that a blade has something for; a volume is to be asked for."""
    missing = {"volume"} if blade.layup is not None else {"volume", "layup"}
    return [name for name in PLOTS if name not in missing]


def _over_span(
    axis: Any,
    label: str,
    eta: Array,
    values: Callable[[Blade], Array],
    blade: Blade,
    baseline: Blade | None,
) -> None:
    """Draw a quantity over the span, the stations marked below."""
    for one, line in pair(blade, baseline):
        colour = VARIANT if one is blade else BASELINE
        axis.plot(eta, values(one), line, color=colour, label=one.name)
    axis.plot(
        blade.eta,
        np.zeros_like(blade.eta),
        "|",
        color=INK,
        ms=7,
        transform=axis.get_xaxis_transform(),
        clip_on=False,
    )
    axis.set(xlabel="eta", ylabel=label, xlim=(0.0, 1.0))
    if baseline is not None:
        axis.legend(fontsize=8, frameon=False)


def _outline(axis: Any, blade: Blade, baseline: Blade | None) -> None:
    """Draw the blade as seen from the suction side, its stations across it."""
    eta = np.linspace(0.0, 1.0, SPANS)
    for one, line in pair(blade, baseline):
        placed = one.sections(eta)
        z, y = placed[..., 2], placed[..., 1]
        row = np.arange(len(eta))
        low, high = np.argmin(y, axis=1), np.argmax(y, axis=1)
        edges = (z[row, low], y[row, low]), (z[row, high], y[row, high])
        colour = VARIANT if one is blade else BASELINE
        for edge in edges:
            axis.plot(*edge, line, color=colour, linewidth=1.2)
        if one is blade:
            around = np.concatenate([np.stack(edges[0]), np.stack(edges[1])[:, ::-1]], axis=1)
            axis.fill(*around, color=colour, alpha=0.15, linewidth=0)
            for station in one.sections(one.eta):
                ends = station[[np.argmin(station[:, 1]), np.argmax(station[:, 1])]]
                axis.plot(ends[:, 2], ends[:, 1], color=BASELINE, linewidth=0.9)
    axis.invert_yaxis()
    axis.set_aspect("equal", adjustable="datalim")
    axis.set(xlabel="z, m", ylabel="y, m", title="suction side, stations marked")


def _section_curvature(blade: Blade, profiles: Array) -> Array:
    """Return the curvature (k, n) of sections' splines, in units of 1 / chord."""
    first, second = (blade.splines.values(blade.u, order) @ profiles for order in (1, 2))
    (dx, dy), (ddx, ddy) = np.moveaxis(first, -1, 0), np.moveaxis(second, -1, 0)
    bend: Array = (dx * ddy - dy * ddx) / np.hypot(dx, dy) ** 3
    return bend
