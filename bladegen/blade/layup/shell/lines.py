"""Lines along a blade between which the columns of its shell elements lie.

Webs' feet and the leading edge are lines, so that webs and skin share their nodes; edges of layers
are lines where there is room between those: one that would cross another is moved beside it, and
the layer then covers a part of the elements there (`laminates`).
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from bladegen.blade.layup.outlines import Outlines
from bladegen.definition.distribution import Distribution
from bladegen.definition.structure.positions import (
    LEADING_EDGE,
    Between,
    Limited,
    PlaneCut,
    Position,
    Shifted,
)
from bladegen.definition.structure.structure import Structure
from bladegen.support.arrays import Array

__all__ = ["Lines", "mesh_lines"]

APART = 0.004  # of the arc, least between two lines
SAME = 0.006  # of the arc, in the mean over the span: one line is enough for both
EDGE = 0.02  # of the arc: layers that end so near to the trailing edge have no line of their own


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines at some spans.

    Parameters
    ----------
    fractions : (k, lines) array
        Of the arc, increasing, from 0 to 1.
    nose : int
        Which line is the leading edge.
    feet : dict of (int, int)
        For each web which lines it stands on.
    moved : dict of float
        By how much of the arc the feet of webs were moved to keep their distance.
    """

    fractions: Array
    nose: int
    feet: dict[str, tuple[int, int]]
    moved: dict[str, float]


def mesh_lines(
    structure: Structure,
    outlines: Outlines,
    *,
    apart: float = APART,
    same: float = SAME,
    edge: float = EDGE,
) -> Lines:
    """Return the lines of a blade's shell at the spans of its outlines.

    `apart` is the least distance between two, of the arc; ends of layers that are nearer than
    `same` to another line, or than `edge` to the trailing edge, in the mean have none of their own.
    """
    ends = {
        f"{web.name}/{i}": _everywhere(end, outlines)
        for web in structure.webs
        for i, end in enumerate((web.start, web.end))
    }
    hard = ends | {"nose": _everywhere(LEADING_EDGE, outlines)}
    order = sorted(hard, key=lambda name: float(hard[name].mean()))
    wanted = np.stack([hard[name] for name in order], axis=-1)
    kept = _spread(wanted, np.zeros(len(wanted)), np.ones(len(wanted)), apart)
    names = ["start", *order, "end"]
    count = len(outlines.eta)
    rows = [np.zeros(count), *kept.T, np.ones(count)]
    for layer in structure.layers:
        for end in () if layer.web else (layer.start, layer.end):
            line = _everywhere(end, outlines)
            middle = float(line.mean())
            near = min(float(np.abs(line - row).mean()) for row in rows)
            if edge < middle < 1.0 - edge and near > same:
                place = sum(float(row.mean()) < middle for row in rows)
                rows.insert(place, line)
                names.insert(place, "")
    lines = np.stack(rows, axis=-1)
    fixed = [i for i, name in enumerate(names) if name]
    for first, last in pairwise(fixed):
        inner = slice(first + 1, last)
        lines[:, inner] = _spread(lines[:, inner], lines[:, first], lines[:, last], apart)
    at = {name: i for i, name in enumerate(names) if name}
    feet = {web.name: (at[f"{web.name}/0"], at[f"{web.name}/1"]) for web in structure.webs}
    moved = {
        web.name: max(
            float(np.abs(lines[:, at[name]] - ends[name]).max())
            for name in (f"{web.name}/0", f"{web.name}/1")
        )
        for web in structure.webs
    }
    return Lines(lines, at["nose"], feet, moved)


def _everywhere(place: Position, outlines: Outlines) -> Array:
    """Return the fractions (k,) of a place, held where its rule gives none: there is no web."""
    found = np.clip(outlines.places(_held(place)), 0.0, 1.0)
    there = np.isfinite(found)
    if not there.any():
        return np.full(len(found), 0.5)
    return np.interp(outlines.eta, outlines.eta[there], found[there])


def _held(place: Position) -> Position:
    """Return a place whose plane goes on beyond the ends of its grid."""
    if isinstance(place, Shifted | Limited):
        return replace(place, base=_held(place.base))
    if isinstance(place, Between):
        return replace(place, first=_held(place.first), last=_held(place.last))
    if not isinstance(place, PlaneCut):
        return place
    grid, values = place.offset.grid, place.offset.values
    low, high = grid[0] > 0.0, grid[-1] < 1.0
    longer = np.pad(grid, (int(low), int(high)), constant_values=(0.0, 1.0))
    return replace(
        place, offset=Distribution(longer, np.pad(values, (int(low), int(high)), mode="edge"))
    )


def _spread(lines: Array, low: Array, high: Array, least: float) -> Array:
    """Return lines (k, n) in order between two others (k,), at their least distance at least."""
    n = lines.shape[-1]
    if not n:
        return lines
    apart = np.minimum(least, 0.5 * (high - low) / (n + 1))[:, None]
    steps = apart * np.arange(1, n + 1)
    up = np.maximum.accumulate(np.maximum(lines, low[:, None] + apart) - steps, axis=-1) + steps
    back = apart * np.arange(n, 0, -1)
    down = np.minimum(up, high[:, None] - apart) + back
    found: Array = np.minimum.accumulate(down[:, ::-1], axis=-1)[:, ::-1] - back
    return found
