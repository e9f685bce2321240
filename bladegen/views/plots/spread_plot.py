"""How the numbers of a family's variants spread: a histogram of each."""

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from bladegen.support.arrays import Array, Mask
from bladegen.views.plots.figures import figure, save_figure
from bladegen.views.plots.style import BASELINE, VARIANT

__all__ = ["draw"]

COLUMNS = 4


def draw(
    numbers: Mapping[str, tuple[Array, str]], held: Mask | None, title: str, path: Path
) -> None:
    """Draw histograms into a PNG, SVG or PDF.

    Parameters
    ----------
    numbers : mapping of str to ((variants,) array, str)
        What each variant has one of, NaN where it has none, with the unit.
    held : (variants,) array of bool, optional
        Which variants fulfil conditions: theirs are drawn over the others.
    title : str
        What stands above all.
    path : Path
        Where to.

    Raises
    ------
    ExportError
        If the suffix is none of PNG, SVG and PDF.
    """
    rows = max(1, math.ceil(len(numbers) / COLUMNS))
    drawn, axes = figure(rows, COLUMNS, width=12.0, height=0.5 + 2.4 * rows)
    for axis, (name, (values, unit)) in zip(axes.flat, numbers.items(), strict=False):
        known = values[np.isfinite(values)]
        edges = np.histogram_bin_edges(known, bins=min(40, max(8, math.isqrt(known.size))))
        axis.hist(known, edges, color=VARIANT, alpha=1.0 if held is None else 0.35)
        if held is not None:
            own = values[held]
            axis.hist(own[np.isfinite(own)], edges, color=BASELINE)
        axis.set_title(name, fontsize=9)
        axis.set_xlabel(unit if unit not in ("", "1") else "", fontsize=8)
        axis.tick_params(labelsize=7)
        axis.locator_params(axis="x", nbins=5)
    for axis in axes.flat:
        if not axis.has_data():
            axis.axis("off")
    drawn.suptitle(title, fontsize=10, ha="left", x=0.01)
    save_figure(drawn, path)
