"""A scene's curves as SVG: the section over the baseline's, and four plots over span.

Colours and line widths are those of the page's style sheet, by class, so that a chart follows
its light or dark theme; what a chart shows is also said in words, for those who do not see it.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.studio.choices.drawn import CURVES, KNOTS
from bladegen.studio.page.drawing.svg import line, path, picture, text, ticks
from bladegen.studio.scene import Scene
from bladegen.support.arrays import Array

__all__ = ["planform", "section"]

SECTION_SIZE = 480, 210
PLANFORM_SIZE = 480, 260
MARGIN = 32, 16, 20, 18  # of one plot: left, right, top, bottom
GAP = 0.06  # of a plot's height, left free above and below the curves
ROOMY = 1.08


def section(scene: Scene, plain: Scene, *, placed: bool = False) -> str:
    """Draw the section looked at over the baseline's, at the same scale both ways.

    Parameters
    ----------
    scene, plain : Scene
        What is shown, and the baseline seen at the same section.
    placed : bool
        As it stands in the blade [m], instead of in chords along its own chord.
    """
    now, before = (s.placed if placed else s.profile for s in (scene, plain))
    width, height = SECTION_SIZE
    both = np.concatenate([now, before])
    low, high = both.min(axis=0), both.max(axis=0)
    if not placed:  # a section keeps its place while its thickness moves
        low[0], high[0] = min(low[0], -0.01), max(high[0], 1.01)
    middle = 0.5 * (low + high)
    scale = min((width - 20) / (ROOMY * (high[0] - low[0])), (height - 40) / (high[1] - low[1]))

    def at(points: Array) -> Array:
        spots: Array = (points - middle) * [scale, -scale] + [0.5 * width, 0.5 * height - 6]
        return spots

    half = 0.5 * width / scale
    lines = []
    for value in ticks(middle[0] - half, middle[0] + half, 5):
        x = at(np.array([value, 0.0]))[0]
        lines.append(line(x, 0, x, height - 16))
        unit = f"{value:g} m" if placed else f"{100 * value:.0f} %"
        lines.append(text(x, height - 4, unit))
    k = scene.place
    now_here, before_here = (
        f"chord {s.chord[k]:.3f} m, thickness {s.thickness[k]:.1f} %, twist {s.twist[k]:.2f} deg"
        for s in (scene.curves, plain.curves)
    )
    words = (
        f"Section at {100 * scene.eta[k]:.0f} % of the span, "
        f"{scene.sections[k, :, 2].mean():.1f} m from the root: {now_here}; baseline: {before_here}"
    )
    return picture(
        SECTION_SIZE,
        words,
        [*lines, path(at(before), "before"), path(at(now), "now", closed=True)],
    )


@dataclass(frozen=True)
class Plot:
    """One of the plots over span: what, its unit, its least height, whether 0 shows."""

    name: str
    label: str
    unit: str
    least: float
    from_zero: bool
    step: float = 0.0  # of a key on a handle


PLOTS = (
    Plot("chord", "Chord", "m", 0.5, True, 0.02),
    Plot("twist", "Twist", "deg", 5.0, False, 0.1),
    Plot("thickness", "Thickness", "%", 20.0, True),
    Plot("prebend", "Prebend", "m", 1.0, False, 0.05),
)


def planform(scene: Scene, plain: Scene) -> str:
    """Draw chord, twist, relative thickness and prebend over span, with the baseline's."""
    width, height = PLANFORM_SIZE[0] / 2, PLANFORM_SIZE[1] / 2
    parts, words = [], []
    for i, plot in enumerate(PLOTS):
        corner = np.array([width * (i % 2), height * (i // 2)])
        now, before = (getattr(s.curves, plot.name) for s in (scene, plain))
        parts += _plot(plot, scene, now, before, corner, np.array([width, height]))
        words.append(
            f"{plot.label} {now.min():.2f} to {now.max():.2f} {plot.unit} "
            f"(baseline {before.min():.2f} to {before.max():.2f})"
        )
    return picture(PLANFORM_SIZE, "Over span: " + "; ".join(words), parts, "group")


def _plot(
    plot: Plot, scene: Scene, now: Array, before: Array, corner: Array, size: Array
) -> list[str]:
    left, right, top, bottom = MARGIN
    low, high = float(min(now.min(), before.min())), float(max(now.max(), before.max()))
    if plot.from_zero:
        low = min(low, 0.0)
    short = plot.least - (high - low)
    if short > 0:
        low, high = low - 0.5 * short, high + 0.5 * short
    reach = (high - low) * GAP
    low, high = (low if plot.from_zero and low == 0 else low - reach), high + reach
    box = size - [left + right, top + bottom]

    def at(eta: Array, values: Array) -> Array:
        unit = np.stack([eta, (high - values) / (high - low)], axis=-1)
        spots: Array = corner + [left, top] + unit * box
        return spots

    parts = [
        f'<text class="title" x="{corner[0] + left:.0f}" y="{corner[1] + 13:.0f}">'
        f"{plot.label} <tspan>{plot.unit}</tspan></text>"
    ]
    for value in ticks(low, high, 3):
        x, y = at(np.zeros(1), np.array([value]))[0]
        parts.append(line(x, y, x + box[0], y))
        parts.append(text(x - 5, y + 3, f"{value:g}", "end"))
    for share in (0.0, 0.5, 1.0):
        x, y = at(np.array([share]), np.array([low]))[0]
        parts.append(text(x, y + 13, f"{100 * share:.0f} %"))
    mark = at(np.full(2, scene.state.at), np.array([low, high]))
    eta = scene.eta
    curves = [path(mark, "mark"), path(at(eta, before), "before"), path(at(eta, now), "now")]
    if plot.name not in CURVES:
        return parts + curves
    per = (high - low) / box[1]
    scale = f'data-top="{corner[1] + top:.1f}" data-high="{high:.9g}" data-per="{per:.9g}"'
    for knot, share in enumerate(KNOTS):
        value = float(now[np.argmin(np.abs(eta - share))])
        spot = at(np.array([share]), np.array([value]))[0]
        words = f"{plot.label} at {100 * share:.0f} % of the span"
        ends = f'aria-valuemin="{low:.4g}" aria-valuemax="{high:.4g}" aria-valuenow="{value:.4g}"'
        curves.append(
            f'<circle class="handle" r="4.5" cx="{spot[0]:.1f}" cy="{spot[1]:.1f}" tabindex="0" '
            f'role="slider" aria-orientation="vertical" aria-label="{words}" {ends} '
            f'aria-valuetext="{value:.2f} {plot.unit}" data-curve="{plot.name}" '
            f'data-knot="{knot}" data-value="{value:.9g}" data-step="{plot.step:g}" {scale}/>'
        )
    return parts + curves
