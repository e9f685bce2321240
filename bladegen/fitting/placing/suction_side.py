"""Which edge of a blade is the trailing edge, and which side the suction side.

Outer sections tell: their leading edge is thicker, and they are cambered toward suction.
"""

import numpy as np

from bladegen.errors import GeometryError
from bladegen.fitting.placing.pose import Pose, cuts_across
from bladegen.measures.surfaces import Surface
from bladegen.support.arrays import Array

__all__ = ["chord_of", "sided"]

FEW = 5  # points that an outline has more than
OUTER = np.linspace(0.6, 0.9, 13)  # of the span, where edges and sides are told apart
CAMBERED = 1e-3  # of the chord; less camber tells no suction side
POINTED = 1.05  # times as thick one end's half as the other's: less tells no trailing edge


def sided(pose: Pose, surface: Surface, name: str, said: list[str]) -> Pose:
    """Turn y to the trailing edge and x to the suction side, by outer sections."""
    cuts, _ = cuts_across(pose, surface, OUTER)
    outlines = [cut.outline for cut in cuts if len(cut.outline) > FEW]
    if not outlines:
        raise GeometryError(f"{name}: no blade: the outer half has no closed sections")
    chords = np.array([chord_of(outline) for outline in outlines])
    lead = chords[len(chords) // 2]
    chords *= np.where(chords @ lead < 0.0, -1.0, 1.0)[:, None]
    ends = [_end_areas(o, c) for o, c in zip(outlines, chords, strict=True)]
    thick = np.median([one / other for one, other in ends])
    if 1.0 / POINTED < thick < POINTED:
        raise GeometryError(
            f"{name}: no blade: both edges of its outer sections are as blunt, so that none is the "
            "trailing edge"
        )
    chords *= 1.0 if thick < 1.0 else -1.0
    y = chords[len(chords) // 2]
    cambers = [_camber(o, c) for o, c in zip(outlines, chords, strict=True)]
    camber = float(np.median(cambers))
    x = np.array([-y[1], y[0]]) * (1.0 if camber > 0.0 else -1.0)
    if abs(camber) < CAMBERED:
        said.append(
            f"outer sections have a camber of {camber:.2g} chord: which side is the suction side "
            "is a guess"
        )
    axes = np.eye(3)
    axes[:2, 0], axes[:2, 1] = x, y
    return pose.then(axes, np.zeros(3))


def chord_of(outline: Array) -> Array:
    """Return the unit vector between the two points of an outline that are farthest apart."""
    start = outline[np.argmax(np.hypot(*(outline - outline.mean(axis=0)).T))]
    for _ in range(3):
        end = outline[np.argmax(np.hypot(*(outline - start).T))]
        start, end = end, start
    return np.asarray((end - start) / np.hypot(*(end - start)))


def _end_areas(outline: Array, chord: Array) -> tuple[float, float]:
    """Return the areas of an outline ahead of 20 % and behind 80 % of the extent along a chord."""
    reach, height = outline @ chord, outline @ np.array([-chord[1], chord[0]])
    low, high = reach.min(), reach.max()
    x = np.linspace(0.0, 1.0, 101)
    top, bottom = _sides(reach, height, low + x * (high - low))
    apart = np.abs(top - bottom)
    return float(apart[x > 0.8].mean()), float(apart[x < 0.2].mean())


def _camber(outline: Array, chord: Array) -> float:
    """Return the mean height of an outline's middle over its chord line, in chords.

    Heights are along the chord turned by +90 degrees.
    """
    reach, height = outline @ chord, outline @ np.array([-chord[1], chord[0]])
    low, high = reach.min(), reach.max()
    x = np.linspace(0.02, 0.98, 97)
    top, bottom = _sides(reach, height, low + x * (high - low))
    middle = 0.5 * (top + bottom)
    line = np.interp(x, x[[0, -1]], middle[[0, -1]])
    return float(np.mean(middle - line) / (high - low))


def _sides(reach: Array, height: Array, at: Array) -> tuple[Array, Array]:
    """Return heights of the two sides of an outline at places along the chord."""
    one, other = int(np.argmin(reach)), int(np.argmax(reach))
    order = np.roll(np.arange(len(reach)), -one)
    split = int(np.flatnonzero(order == other)[0])
    first, second = order[: split + 1], np.append(order[split:], one)
    heights = []
    for side in (first, second):
        by = np.argsort(reach[side], kind="stable")
        heights.append(np.interp(at, reach[side][by], height[side][by]))
    return heights[0], heights[1]
