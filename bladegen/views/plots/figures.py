"""Diagrams by matplotlib: what a shape space holds.  matplotlib is imported when first needed."""

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Literal

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.perturbation import PERTURBED, told
from bladegen.errors import visible
from bladegen.shapes import affine
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array
from bladegen.support.files import require_suffix
from bladegen.views.plots.style import CATEGORIES, FAINT, INK, SEQUENTIAL

__all__ = [
    "DPI",
    "SUFFIXES",
    "draw_space",
    "dress",
    "figure",
    "figure_of",
    "heading",
    "pair",
    "physical",
    "save_figure",
    "save_pages",
    "shade",
    "titled",
]

SUFFIXES = (".png", ".svg", ".pdf")
RADIANS = re.compile(r"\S+ rad \((.*?)\)")  # which stand beside degrees
LONGEST = 100  # letters of what was changed in a title
MANY = 500  # shapes whose points would hide each other if they were large
DPI = 150  # pixels an inch


def figure(rows: int, columns: int, *, width: float, height: float) -> tuple[Any, Any]:
    """Return a matplotlib figure without any window, and its axes (rows, columns)."""
    drawn = figure_of(width, height)
    axes = drawn.subplots(rows, columns, squeeze=False)
    for axis in axes.flat:
        dress(axis)
    return drawn, axes


def figure_of(
    width: float, height: float, *, layout: Literal["constrained"] | None = "constrained"
) -> Any:
    """Return an empty matplotlib figure without any window, its size in inches."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    drawn = Figure(figsize=(width, height), layout=layout)
    FigureCanvasAgg(drawn)
    return drawn


def shade(fraction: float) -> Any:
    """Return a colour from dark to bright, told apart by everyone."""
    from matplotlib import colormaps

    return colormaps[SEQUENTIAL](0.92 * fraction)


def dress(axis: Any) -> None:
    """Give axes the common look: a faint grid behind, no box, ink instead of black."""
    axis.grid(True, color=FAINT, linewidth=0.6)
    axis.set_axisbelow(True)
    axis.spines[["top", "right"]].set_visible(False)
    axis.spines[["left", "bottom"]].set_color(INK)
    axis.tick_params(colors=INK, labelsize=9)
    for text in (axis.title, axis.xaxis.label, axis.yaxis.label):
        text.set_color(INK)
        text.set_fontsize(10)


def heading(blade: Blade) -> str:
    """Return what a picture of a blade is headed by: which blade it is, and what was changed."""
    return "; ".join(part for part in (_name(blade), _changes(blade)) if part)


def _name(blade: Blade) -> str:
    name = visible(blade.definition.description or blade.name)
    return name + (", mirrored" if blade.mirrored else "")


def _changes(blade: Blade) -> str:
    """Return what was changed of a blade, cut short where it is much."""
    words = ", ".join(told(change).removeprefix(PERTURBED) for change in blade.changes)
    words = RADIANS.sub(r"\1", words).replace("_", " ")
    if len(words) > LONGEST:
        words = words[: words.rfind(", ", 0, LONGEST)] + ", ..."
    return words and f"perturbed: {words}"


def titled(drawn: Any, blade: Blade, what: str, baseline: Blade | None = None) -> Any:
    """Give a figure of a blade its title; say what dashes are where no legend does."""
    dashes = "" if baseline is None else "; baseline dashed"
    changes = f"\n{_changes(blade)}" if blade.changes else ""
    drawn.suptitle(f"{_name(blade)}: {what}{dashes}{changes}", color=INK, fontsize=13)
    return drawn


def save_figure(drawn: Any, path: Path, about: str = "") -> None:
    """Write a figure in the format of its suffix, without a time, the same bytes each time.

    Parameters
    ----------
    drawn : matplotlib.figure.Figure
        The figure.
    path : Path
        Where to.
    about : str
        The subject of a PDF.

    Raises
    ------
    ExportError
        If the suffix is none of PNG, SVG and PDF.
    """
    require_suffix(path, SUFFIXES)
    from matplotlib import rc_context

    with rc_context({"svg.hashsalt": "bladegen"}):
        drawn.savefig(path, dpi=DPI, metadata=_described(path, about))


def _described(path: Path, about: str) -> dict[str, Any]:
    """Return a figure's metadata: no time in any, a subject in a PDF."""
    timeless: dict[str, dict[str, Any]] = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    subject = {"Subject": about} if about and path.suffix.lower() == ".pdf" else {}
    return timeless.get(path.suffix.lower(), {}) | subject


def save_pages(figures: Iterable[Any], path: Path, about: str = "") -> None:
    """Write figures as the pages of one PDF, of that subject."""
    from matplotlib.backends.backend_pdf import PdfPages

    with PdfPages(path, metadata=_described(path, about)) as pages:
        for drawn in figures:
            pages.savefig(drawn)


def draw_space(space: ShapeSpace, path: Path) -> None:
    """Draw a space's modes (mean, least and largest coordinate), spectrum and data."""
    r = space.dimension
    columns = max(2, r)
    drawn, axes = figure(2, columns, width=3.4 * columns, height=6.4)
    for k in range(r):
        axis = axes[0, k]
        for value, colour in ((space.lower[k], CATEGORIES[0]), (space.upper[k], CATEGORIES[1])):
            t = np.zeros(r)
            t[k] = value
            axis.plot(*space.decode(t).T, color=colour, label=f"t = {value:.3f}")
        axis.plot(*space.mean.T, color=INK, linewidth=0.8, label="mean")
        axis.set_title(f"mode {k + 1}, standardised")
        axis.legend(fontsize=7, loc="lower right")
        axis.set_aspect("equal")
    spectrum = axes[1, 0]
    share = 100.0 * np.cumsum(space.variance_ratio[:20])
    spectrum.plot(np.arange(1, len(share) + 1), share, "o-", color=CATEGORIES[0], markersize=3)
    spectrum.set(xlabel="modes", ylabel="variance in sum, %", title="spectrum", ylim=(0, 102))
    data = axes[1, 1]
    shown = space.coordinates[:: max(1, len(space.coordinates) // 4000)]
    second = 1 if r > 1 else 0
    size, opacity = (2.0, 0.4) if len(shown) > MANY else (14.0, 0.8)
    data.scatter(
        shown[:, 0], shown[:, second], s=size, color=CATEGORIES[0], alpha=opacity, linewidths=0
    )
    data.set(xlabel="t1, rad", ylabel=f"t{second + 1}, rad", title="shapes learned from")
    for axis in axes.flat:
        if not axis.has_data():
            axis.axis("off")
    save_figure(drawn, path)


def physical(points: Array, like: Array) -> Array:
    """Return standardised shapes (k, n, 2) with the affine part of the airfoil `like` (n, 2)."""
    X, M, b = affine.standardise(like)
    U, _, Vt = np.linalg.svd(points.mT @ X)
    return affine.restore(points @ (U @ Vt), M, b)


def pair(blade: Blade, baseline: Blade | None) -> list[tuple[Blade, str]]:
    """Return what is drawn with its line: a baseline dashed, under the blade."""
    return [*([] if baseline is None else [(baseline, "--")]), (blade, "-")]
