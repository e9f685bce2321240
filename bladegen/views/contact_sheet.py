"""A family at a glance: pictures of its first blades over all sections at a few spans.

Colours say how far each lies from the baseline along its normal, and two sections of each stand
over the baseline's, so that variants can be told apart.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import RenderError
from bladegen.support.arrays import Array, Indices, Mask
from bladegen.support.files import replacing
from bladegen.views import preview
from bladegen.views.plots.figures import DPI, dress, figure_of, save_figure
from bladegen.views.plots.style import BASELINE, INK, VARIANT
from bladegen.views.rendering.blade_scene import MILLIMETRES
from bladegen.views.rendering.offsets import offsets
from bladegen.views.rendering.scene import Field

__all__ = ["contact_sheet"]

COLUMNS, ROWS = 3, 4
OVERLAID = (0.15, 0.35, 0.6, 0.9)  # of the span: thick, transition, mid and outer sections
MOST = 1000  # sections drawn at a span; of more variants every so many-th
AT_ONCE = 64
THINNED = 2  # every so many-th landmark of overlaid sections
SIZE = (13.0, 8.4)  # inches
PICTURES = (0.0, 0.44, 1.0, 0.5)  # of the sheet: left, bottom, width, height
SCALE = (0.72, 0.966, 0.25, 0.012)  # of the sheet: the legend of colours
SECTIONS = (0.35, 0.9)  # of the span: sections beside each picture, in chords
INSET = (0.42, 0.0, 0.55, 0.42)  # of a picture: theirs
REACH = 99.5  # per cent of the offsets that the colours tell apart
OVERLAYS = {"left": 0.045, "right": 0.99, "bottom": 0.06, "top": 0.4, "wspace": 0.16}


def contact_sheet(
    sections: Any, names: list[str], valid: Mask, baseline: Blade, eta: Array, path: Path
) -> str:
    """Draw a family.

    Parameters
    ----------
    sections : (b, k, n, 3) Zarr array
        All variants' sections [m], read a few at a time.
    names : list of str
        Of the variants.
    valid : (b,) array of bool
        Which are sound; the others are not drawn.
    baseline : Blade
        Drawn over them.
    eta : (k,) array
        The sections' span fractions.
    path : Path
        A PNG.

    Returns
    -------
    str
        What a reader should know of the sheet: how many are overlaid, what is missing.
    """
    sound = np.flatnonzero(valid)
    first = sound[: COLUMNS * ROWS]
    drawn = figure_of(*SIZE, layout=None)
    drawn.suptitle(
        f"{baseline.name}: {len(sound)} sound of {len(valid)} variants",
        **{"x": 0.01, "y": 0.985, "ha": "left", "color": INK, "fontsize": 12},
    )
    remark = _pictures(drawn, sections, names, first, baseline.sections(eta), eta)
    spans = [int(np.argmin(np.abs(eta - wanted))) for wanted in OVERLAID]
    chosen = sound[:: max(1, -(-len(sound) // MOST))]
    _overlays(drawn, _parts(sections, chosen, spans), baseline, eta[spans], len(chosen))
    with replacing(path) as temporary:
        save_figure(drawn, temporary)
    return f"{len(chosen)} of {len(sound)} sound variants overlaid{remark}"


def _pictures(
    drawn: Any, sections: Any, names: list[str], first: Indices, reference: Array, eta: Array
) -> str:
    """Draw the first variants above, with their names and sections; say what is missing."""
    axis = drawn.add_axes(PICTURES)
    axis.axis("off")
    width, height = (round(DPI * SIZE[i] * PICTURES[2 + i]) for i in (0, 1))
    try:
        shown = np.stack([np.asarray(sections[int(i)], dtype=np.float64) for i in first])
        apart = MILLIMETRES * offsets(shown, reference)
        reach = max(float(np.percentile(np.abs(apart), REACH)), 1e-3)
        field = Field.within("apart", "from the baseline along its normal, mm", apart, reach)
        picture = preview.gallery(shown, columns=COLUMNS, size=(width, height), field=field)
    except (RenderError, ValueError) as error:
        return f"; without pictures ({error})" if len(first) else "; no variant is sound"
    axis.imshow(picture, aspect="auto", interpolation="nearest")
    _scale(drawn, field)
    rows = -(-len(first) // COLUMNS)
    places = [int(np.argmin(np.abs(eta - wanted))) for wanted in SECTIONS]
    for place, one in enumerate(first.tolist()):
        row, column = divmod(place, COLUMNS)
        at = (column + 0.03) / COLUMNS, 1.0 - (row + 0.97) / rows
        axis.text(*at, names[one], transform=axis.transAxes, color=INK, fontsize=7, va="bottom")
        left, bottom = (column + INSET[0]) / COLUMNS, 1.0 - (row + 1.0 - INSET[1]) / rows
        inset = axis.inset_axes((left, bottom, INSET[2] / COLUMNS, INSET[3] / rows))
        _sections(inset, shown[place, places], reference[places])
    return ""


def _scale(drawn: Any, field: Field) -> None:
    """Draw the legend of the colours."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    colours = ScalarMappable(Normalize(field.low, field.high), field.colours)
    bar = drawn.colorbar(colours, cax=drawn.add_axes(SCALE), orientation="horizontal")
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=7, colors=INK, length=2)
    bar.ax.set_ylabel(field.label, fontsize=8, color=INK, rotation=0, ha="right", va="center")


def _sections(axis: Any, shown: Array, reference: Array) -> None:
    """Draw sections (2, n, 3) of a variant over the baseline's, side by side, in its chords."""
    axis.axis("off")
    axis.set_aspect("equal")
    for place, (one, before) in enumerate(zip(shown, reference, strict=True)):
        nose = before.shape[0] // 2
        chord = np.linalg.norm(before[0] - before[nose])
        for loop, colour in ((before, BASELINE), (one, VARIANT)):
            flat = (loop - before[nose])[:, 1::-1] / chord
            axis.plot(flat[:, 0] + 1.3 * place, flat[:, 1], color=colour, linewidth=0.7)


def _overlays(drawn: Any, parts: Iterator[Array], baseline: Blade, eta: Array, count: int) -> None:
    """Draw sections at some spans below, of all variants, with the baseline's."""
    from matplotlib.collections import LineCollection

    axes = drawn.subplots(1, len(eta), gridspec_kw=OVERLAYS)
    opacity = float(np.clip(12.0 / max(count, 1), 0.03, 0.5))
    for span, axis, one in zip(eta, axes, baseline.sections(eta), strict=True):
        dress(axis)
        axis.set_title(f"eta = {span:.3f}", fontsize=9)
        axis.plot(one[:, 1], one[:, 0], color=BASELINE, linewidth=1.4, zorder=3, label="baseline")
        axis.set_aspect("equal", adjustable="datalim")
        axis.set_xlabel("y, m", fontsize=8)
        axis.tick_params(labelsize=7)
    axes[0].set_ylabel("x, m", fontsize=8)
    for part in parts:
        for place, axis in enumerate(axes):
            lines = part[:, place, ::THINNED, 1::-1]  # (b, n, 2): y, x
            axis.add_collection(
                LineCollection(list(lines), colors=VARIANT, linewidths=0.5, alpha=opacity)
            )
    for axis in axes:
        axis.autoscale_view()
    axes[0].legend(fontsize=7, loc="upper right")


def _parts(sections: Any, chosen: Indices, spans: list[int]) -> Iterator[Array]:
    """Read the chosen variants' sections at some spans, a few variants at a time."""
    for start in range(0, len(chosen), AT_ONCE):
        yield np.asarray(sections.oindex[chosen[start : start + AT_ONCE], spans])
