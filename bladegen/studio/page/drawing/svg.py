"""Parts of charts as SVG; colours and widths stand in the page's style sheet, by class."""

from html import escape
from math import floor, log10

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["line", "path", "picture", "text", "ticks"]

FLAT = 1e-9


def ticks(low: float, high: float, count: int = 4) -> list[float]:
    """Return about `count` round numbers within an interval, steps of 1, 2 or 5.

    >>> ticks(0.0, 5.8)
    [0.0, 2.0, 4.0]
    """
    raw = max(high - low, FLAT) / count
    scale = 10.0 ** floor(log10(raw))
    step = next(m * scale for m in (1.0, 2.0, 5.0, 10.0) if m * scale >= raw * (1.0 - FLAT))
    first = int(np.ceil(low / step - FLAT))
    last = int(np.floor(high / step + FLAT))
    return [round(k * step, 12) for k in range(first, last + 1)]


def picture(size: tuple[int, int], words: str, parts: list[str], role: str = "img") -> str:
    """Return a chart of a size, and what it shows in words for those who do not see it."""
    return (
        f'<svg class="chart" viewBox="0 0 {size[0]} {size[1]}" role="{role}" '
        f'aria-label="{escape(words)}">{"".join(parts)}</svg>'
    )


def path(points: Array, kind: str, *, closed: bool = False) -> str:
    """Return a line through points (m, 2), of a class."""
    words = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<path class="{kind}" d="M{words}{"Z" if closed else ""}"/>'


def line(x0: float, y0: float, x1: float, y1: float) -> str:
    """Return a line of a grid."""
    return f'<path class="grid" d="M{x0:.1f},{y0:.1f} {x1:.1f},{y1:.1f}"/>'


def text(x: float, y: float, words: str, anchor: str = "middle") -> str:
    """Return a text of one line."""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(words)}</text>'
