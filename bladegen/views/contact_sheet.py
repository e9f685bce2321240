"""A family at a glance: pictures of its first blades over all sections at a few spans."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import RenderError
from bladegen.plots.figures import dress, figure_of, save_figure
from bladegen.plots.style import BASELINE, INK, VARIANT
from bladegen.support.arrays import Array, Indices, Mask
from bladegen.support.files import replacing
from bladegen.views import preview

__all__ = ["contact_sheet"]

COLUMNS, ROWS = 3, 4
OVERLAID = (0.15, 0.35, 0.6, 0.9)  # of the span: thick, transition, mid and outer sections
MOST = 1000  # sections drawn at a span; of more variants every so many-th
AT_ONCE = 64
PICTURE = (2100, 720)  # pixels


def contact_sheet(
    sections: Any, names: list[str], valid: Mask, baseline: Blade, eta: Array, path: Path
) -> str:
    """Draw a family.

    Parameters
    ----------
    sections : (b, k, n, 3) array or Zarr array
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
    drawn = figure_of(13.0, 8.4)
    upper, lower = drawn.subfigures(2, 1, height_ratios=[4.5, 3.6])
    remark = ""
    axis = upper.subplots()
    axis.axis("off")
    try:
        shown = np.stack([np.asarray(sections[int(i)], dtype=np.float64) for i in first])
        picture = preview.gallery(shown, [names[i] for i in first], columns=COLUMNS, size=PICTURE)
        axis.imshow(picture)
    except (RenderError, ValueError) as error:
        remark = f"; without pictures ({error})" if len(first) else "; no variant is sound"
    drawn.suptitle(
        f"{baseline.name}: {len(sound)} sound of {len(valid)} variants", color=INK, fontsize=12
    )
    spans = [int(np.argmin(np.abs(eta - wanted))) for wanted in OVERLAID]
    chosen = sound[:: max(1, -(-len(sound) // MOST))]
    axes = lower.subplots(1, len(spans))
    opacity = float(np.clip(12.0 / max(len(chosen), 1), 0.03, 0.5))
    given = baseline.sections(eta[spans])
    for span, axis, one in zip(spans, axes, given, strict=True):
        dress(axis)
        axis.set_title(f"eta = {eta[span]:.3f}", fontsize=9)
        axis.plot(one[:, 1], one[:, 0], color=BASELINE, linewidth=1.4, zorder=3, label="baseline")
        axis.set_aspect("equal", adjustable="datalim")
        axis.set_xlabel("y, m", fontsize=8)
        axis.tick_params(labelsize=7)
    axes[0].set_ylabel("x, m", fontsize=8)
    for part in _parts(sections, chosen, spans):
        for place, axis in enumerate(axes):
            lines = np.moveaxis(part[:, place, :, 1::-1], 0, -1)  # (n, 2, b): y, x
            axis.plot(lines[:, 0], lines[:, 1], color=VARIANT, linewidth=0.5, alpha=opacity)
    axes[0].legend(fontsize=7, loc="upper right")
    with replacing(path) as temporary:
        save_figure(drawn, temporary)
    return f"{len(chosen)} of {len(sound)} sound variants overlaid{remark}"


def _parts(sections: Any, chosen: Indices, spans: list[int]) -> Iterator[Array]:
    """Read the chosen variants' sections at some spans, a few variants at a time."""
    for start in range(0, len(chosen), AT_ONCE):
        some = chosen[start : start + AT_ONCE]
        yield np.stack([np.asarray(sections[int(i)])[spans] for i in some])
