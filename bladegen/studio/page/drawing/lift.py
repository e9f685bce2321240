"""Lift, and lift over drag, of the section looked at, over the angle of attack."""

from dataclasses import dataclass

import numpy as np

from bladegen.studio.page.drawing.svg import line, path, picture, text, ticks
from bladegen.studio.results.aerodynamics import Lift
from bladegen.support.arrays import Array

__all__ = ["lift"]

SIZE = 480, 210
MARGIN = 36, 14, 22, 20  # of one plot: left, right, top, bottom
ANGLES = -10.0, 20.0  # deg
PLOTS = ("Lift coefficient", "Lift over drag")


@dataclass(frozen=True, eq=False)
class _Frame:
    """Where a plot stands, and what its corners mean."""

    corner: Array
    size: Array
    low: float
    high: float

    def at(self, alpha: Array, values: Array) -> Array:
        left, right, top, bottom = MARGIN
        box = self.size - [left + right, top + bottom]
        x = (np.asarray(alpha) - ANGLES[0]) / (ANGLES[1] - ANGLES[0])
        y = (self.high - np.asarray(values)) / (self.high - self.low)
        spots: Array = self.corner + [left, top] + np.stack([x, y], axis=-1) * box
        return spots


def lift(now: Lift, before: Lift) -> str:
    """Draw both, side by side, a mark where the section works."""
    width, height = SIZE
    parts: list[str] = []
    for i, title in enumerate(PLOTS):
        corner = np.array([0.5 * width * i, 0.0])
        some = (now.alpha >= ANGLES[0]) & (now.alpha <= ANGLES[1])
        curves = [(one.cl / one.cd if i else one.cl)[some] for one in (before, now)]
        low, high = (f(np.concatenate(curves)) for f in (np.min, np.max))
        reach = 0.06 * (high - low)
        frame = _Frame(
            corner, np.array([0.5 * width, height]), float(low - reach), float(high + reach)
        )
        parts += _grid(frame, title)
        mark = frame.at(np.full(2, now.at), np.array([frame.low, frame.high]))
        parts.append(path(mark, "mark"))
        for kind, values in zip(("before", "now curve"), curves, strict=True):
            parts.append(path(frame.at(now.alpha[some], values), kind))
    figures = (
        f"lift coefficient {one.lift:.3f}, drag coefficient {one.drag:.5f}" for one in (now, before)
    )
    said, plain = figures
    words = f"At {now.at:.1f} deg and Reynolds number {now.reynolds:.3g}: {said}; baseline: {plain}"
    return picture(SIZE, words, parts)


def _grid(frame: _Frame, title: str) -> list[str]:
    (x0, y0), (x1, _) = frame.at(np.array(ANGLES), np.full(2, frame.low))
    parts = [
        f'<text class="title" x="{x0:.0f}" y="14">{title}</text>',
        text(x1, y0 + 15, "deg", "end"),
    ]
    for value in ticks(frame.low, frame.high, 4):
        y = frame.at(np.zeros(1), np.array([value]))[0, 1]
        parts += [line(x0, y, x1, y), text(x0 - 5, y + 3, f"{value:g}", "end")]
    for value in ticks(*ANGLES, 3)[:-1]:
        x = frame.at(np.array([value]), np.zeros(1))[0, 0]
        parts.append(text(x, y0 + 15, f"{value:g}"))
    return parts
