"""What lies inside the skin as a diagram: layers over span and arc, and on some sections."""

from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.layup.laid import Laid
from bladegen.blade.layup.pieces import Section, section
from bladegen.errors import ExportError
from bladegen.views.plots.figures import dress, figure_of, titled
from bladegen.views.plots.style import CATEGORIES, FAINT, INK

__all__ = ["layup"]

SHOWN = (0.15, 0.4, 0.7)  # span fractions of the sections
TIMES = 4  # as thick as they are, in the lower row
SPANS = 401
WHOLE = 0.98  # of the arc, covered by a layer: no strip of it is drawn over the span


def layup(blade: Blade, baseline: Blade | None = None) -> Any:
    """Draw layers over span and arc, and sections with layers and webs to scale and thicker.

    Raises
    ------
    ExportError
        If the blade's definition has no webs and layers.
    """
    del baseline  # strips of two blades over each other cannot be told apart
    inside = blade.layup
    if inside is None:
        raise ExportError(f"{blade.name}: its definition has no webs and layers to be drawn")
    own = blade.mirror_image() if blade.mirrored else blade
    materials = dict.fromkeys(layer.material for layer in inside.structure.layers)
    colours = {name: CATEGORIES[i % len(CATEGORIES)] for i, name in enumerate(materials)}
    drawn = figure_of(13.0, 9.0)
    grid = drawn.add_gridspec(3, len(SHOWN), height_ratios=[1.3, 1.0, 1.0])
    strips = drawn.add_subplot(grid[0, :])
    _strips(strips, inside.structure, own.layup.at(np.linspace(0.0, 1.0, SPANS)), colours)
    for k, eta in enumerate(SHOWN):
        laid = own.layup.at(np.array([eta]))
        for row, times in ((1, 1), (2, TIMES)):
            axis = drawn.add_subplot(grid[row, k])
            _section(axis, section(own, eta, times=times, laid=laid), colours)
            said = "to scale" if times == 1 else f"layers {times} times as thick"
            axis.set(title=f"eta {eta:g}, {said}", xlabel="along the chord, m", ylabel="m")
    for axis in drawn.axes:
        dress(axis)
    handles, labels = strips.get_legend_handles_labels()
    kept = dict(zip(labels, handles, strict=True))
    drawn.legend(
        kept.values(), kept.keys(), loc="outside lower center", ncols=6, fontsize=8, frameon=False
    )
    return titled(drawn, blade, f"layers and webs, {inside.mass / 1e3:.1f} t")


def _strips(axis: Any, structure: Any, laid: Laid, colours: dict[str, str]) -> None:
    """Draw where strips of layers and feet of webs lie, over span and fraction of the arc."""
    eta, order = laid.eta, np.argsort(-laid.width.sum(axis=1))  # the narrow ones over the wide
    for layer in structure.layers:  # so that the legend names all materials in their order
        axis.fill_between([], [], [], color=colours[layer.material], label=layer.material)
    for i in order.tolist():
        layer, (start, end) = structure.layers[i], laid.arcs[i].T
        there = (laid.thickness[i] > 0.0) & (end > start) & (end - start < WHOLE)
        if layer.web or not there.any():
            continue
        colour = colours[layer.material]
        drawn = (
            [(0.0 * end, end), (1.0 + start, 1.0 + 0.0 * end)] if layer.around else [(start, end)]
        )
        for low, high in drawn:
            axis.fill_between(eta, low, high, where=there, linewidth=0, alpha=0.6, color=colour)
        at = int(np.flatnonzero(there)[np.count_nonzero(there) // 2])
        middle = 0.5 * (max(start[at], 0.0) + end[at])
        axis.text(eta[at], middle, layer.name, fontsize=7, color=INK, va="center", ha="center")
    for web, feet in zip(structure.webs, laid.web_arcs, strict=True):
        for i in (0, 1):
            axis.plot(eta, feet[:, i], color=INK, linewidth=1.2)
        there = np.flatnonzero(np.isfinite(feet[:, 0]))
        if there.size:
            axis.text(eta[there[-1]], feet[there[-1], 0], f" {web.name}", fontsize=7, color=INK)
    axis.set(
        title="layers that cover a part of the section, feet of webs",
        xlabel="span fraction",
        ylabel="arc: suction TE 0, pressure TE 1",
        xlim=(0.0, 1.0),
        ylim=(0.0, 1.0),
    )


def _section(axis: Any, drawn: Section, colours: dict[str, str]) -> None:
    """Draw a section's layers from the outside to the inside, and its webs."""
    for piece in drawn.pieces:
        axis.fill(*piece.border.T, color=colours[piece.material], linewidth=0)
    axis.plot(*drawn.outline.T, color=INK, linewidth=0.7)
    axis.set_aspect("equal", adjustable="datalim")
    axis.grid(False)
    axis.axhline(0.0, color=FAINT, linewidth=0.6, zorder=0)
