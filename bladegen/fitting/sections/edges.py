"""Where sections end at their trailing edges, tracked over span.

Corners tell where an edge is, from 75 % of the span to both ends.  Toward a round root they fade:
from the first thick section on whose edge is not where that of the one before leads to expect it,
edges are held at their angle about the section's middle, and close until the root is round.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.fitting.sections.outlines import Outline, edge_at, edge_of, fullness, middle_of
from bladegen.support.arrays import Array, Mask

__all__ = ["Edges", "edges_about", "edges_of"]

START = 0.75  # of the span
THICK = 0.6  # of the largest width: thinner sections show their edge
TURN = 0.12  # rad, by which an edge may turn from section to section
WIDER, AND = 0.6, 0.01  # of the edge, and of the section's size, by which it may widen


@dataclass(frozen=True, eq=False)
class Edges:
    """Outlines opened at their trailing edges.

    Parameters
    ----------
    outlines : list of Outline
        Each from its suction side's end to its pressure side's.
    angles, widths : (k,) arrays
        Directions of the edges from the sections' middles [rad], and how wide they are [m].
    held : (k,) array of bool
        Whether an edge was not seen, but held.
    """

    outlines: list[Outline]
    angles: Array
    widths: Array
    held: Mask


def edges_of(outlines: list[Array], eta: Array, rounded: Mask) -> Edges:
    """Find the edges of outlines at span fractions (k,), of which some at the root are round."""
    count = len(outlines)
    opened: list[Outline | None] = [None] * count
    angles, widths = np.zeros(count), np.zeros(count)
    held = np.zeros(count, dtype=bool)
    middle = int(np.argmin(np.abs(eta - START)))
    along = np.array([1.0, 0.0])
    for k in range(middle, count):
        opened[k], along = _seen(outlines[k], along)
        angles[k], widths[k] = _place(outlines[k], opened[k])
    along = np.array([1.0, 0.0])
    for k in range(middle, -1, -1):
        one, ahead = _seen(outlines[k], along)
        angles[k], widths[k] = _place(outlines[k], one)
        thick = k < middle and fullness(outlines[k]) > THICK
        if thick and not _alike(outlines[k], one, angles[k + 1], widths[k + 1]):
            _hold(outlines, eta, rounded, k, opened, angles, widths)
            held[: k + 1] = True
            break
        opened[k], along = one, ahead
    return Edges([one for one in opened if one is not None], angles, widths, held)


def edges_about(outlines: list[Array], angles: Array, widths: Array, held: Mask) -> Edges:
    """Open outlines about where edges are expected, or there exactly where they are `held`."""
    opened, angles, widths = [], angles.copy(), widths.copy()
    for k, outline in enumerate(outlines):
        along = np.array([np.cos(angles[k]), np.sin(angles[k])])
        one = None if held[k] else edge_of(outline, along)
        thick = fullness(outline) > THICK
        if one is None or (thick and not _alike(outline, one, angles[k], widths[k])):
            one = edge_at(outline, angles[k], widths[k])
        else:
            angles[k], widths[k] = _place(outline, one)
        opened.append(one)
    return Edges(opened, angles, widths, held)


def _seen(outline: Array, along: Array) -> tuple[Outline, Array]:
    """Return an outline opened at its corners, and the direction of its chord line."""
    one = edge_of(outline, along)
    away = one.edge - one.points[np.argmax(np.hypot(*(one.points - one.edge).T))]
    return one, np.asarray(away / np.hypot(*away))


def _place(outline: Array, one: Outline | None) -> tuple[float, float]:
    assert one is not None
    away = one.edge - middle_of(outline)
    return float(np.arctan2(away[1], away[0])), one.width


def _alike(outline: Array, one: Outline, angle: float, width: float) -> bool:
    """Tell whether an edge is seen, and where it is expected, to what it may change by."""
    if not one.cornered:
        return False
    own, wide = _place(outline, one)
    size = float(np.ptp(outline, axis=0).max())
    return abs(own - angle) < TURN and abs(wide - width) < WIDER * width + AND * size


def _hold(
    outlines: list[Array],
    eta: Array,
    rounded: Mask,
    last: int,
    opened: list[Outline | None],
    angles: Array,
    widths: Array,
) -> None:
    """Open outlines up to the `last` one where the next one's edge leads to."""
    start = eta[rounded].max(initial=0.0)
    angle, width, end = angles[last + 1], widths[last + 1], eta[last + 1]
    for k in range(last, -1, -1):
        share = np.clip((eta[k] - start) / max(end - start, 1e-9), 0.0, 1.0)
        angles[k], widths[k] = angle, width * share
        opened[k] = edge_at(outlines[k], angle, float(widths[k]))
