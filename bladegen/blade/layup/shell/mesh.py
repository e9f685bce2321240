"""Nodes and elements of a blade's shell: quadrilaterals of eight nodes on skin and webs.

Rows go along the span, columns around the section from the suction side's trailing edge; a web has
rows and columns of its own between two lines of the skin, and shares their nodes.  Wide trailing
edges are panels (`trailing_edge`), others are closed to their middle line, the sides bent to it
over the first tenths of the arc.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.layup.outlines import Outlines
from bladegen.blade.layup.shell.lines import Lines, mesh_lines
from bladegen.blade.layup.shell.trailing_edge import Panel, Sheet, openness, panels, sheets
from bladegen.definition.distribution import united
from bladegen.definition.structure.structure import Structure
from bladegen.support.arrays import Array, Indices

__all__ = ["Mesh", "mesh_of"]

BENT = 0.15  # of the arc, from the trailing edge, over which sides are bent to close it
FEW = 0.9  # quantile of a strip's width over the span that its columns are made for
SNAP = 1e-4  # of the span, between ends of webs
MIDDLE = 1e-9  # of half the trailing edge: an element about its middle lies on both halves
OUTSIDE = -9.0  # of the arc: a panel of the trailing edge lies nowhere on it


@dataclass(frozen=True, eq=False)
class Mesh:
    """A blade's shell.

    Parameters
    ----------
    points : (n, 3) array
        Nodes [m], blade frame.
    quads : (m, 8) array
        Elements: corners with the first side along the span, then the middles of the sides.
        The skin's look outward.
    part : (m,) array
        0 for the skin, i + 1 for web i.
    eta : (m,) array
        Span fractions of the elements' middles.
    bay, column : (m,) array
        The row along the span, and the place around the section or down the web.
    sides : (m, 2) array
        Fractions of the arc, or of the web's height, between which an element lies; below 0 in a
        panel of the trailing edge.
    edge : (m, 2) array
        How much of an element lies on the suction and the pressure side's half of such a panel.
    along : (m, 3) array
        There, vectors along the span; 0 elsewhere.
    shut : (bays,) array
        How much of the trailing edge is closed to its middle.
    panels : tuple of pair of float
        Span fractions between which the trailing edge is a panel.
    root, tip : (r,) array
        Nodes of the skin at the ends.
    gap, widest : float
        The widest trailing edge that was closed [m], and its span fraction, outside of panels.
    lines : Lines
        Between which the columns lie.
    """

    points: Array
    quads: Indices
    part: Indices
    eta: Array
    bay: Indices
    column: Indices
    sides: Array
    edge: Array
    along: Array
    shut: Array
    panels: tuple[tuple[float, float], ...]
    root: Indices
    tip: Indices
    gap: float
    widest: float
    lines: Lines


@dataclass(frozen=True, eq=False)
class _Part:
    """Elements of a sheet of nodes: what part they are of, their nodes (m, 8), and where."""

    part: int
    quads: Indices
    bay: Indices
    column: Indices
    sides: Array
    edge: Array
    along: Array


def mesh_of(blade: Blade, structure: Structure, size: float) -> Mesh:
    """Return the shell of a blade that is no mirror image, of elements about so large [m]."""
    eta = _spans(blade, structure, size)
    fine = np.empty(2 * len(eta) - 1)
    fine[::2], fine[1::2] = eta, 0.5 * (eta[1:] + eta[:-1])
    middle = fine[1::2]
    outlines = Outlines.of(blade, fine)
    lines = mesh_lines(structure, outlines)
    fractions, starts = _columns(lines.fractions, outlines.length, size)
    width = 2.0 * outlines.half_edge
    wide = panels(width[::2], blade.chord(eta), size)
    opened = openness(wide, width)
    grid = _closed(outlines, fractions, opened)
    rows, around = len(fine), grid.shape[1] - 1
    ids = np.arange(rows * around).reshape(rows, around)
    last = np.where(opened > 0.0, ids.size + np.arange(rows), ids[:, 0])
    ring = np.concatenate([ids, last[:, None]], axis=1)
    parts = [_gridded(ring, 0, np.arange(len(middle)), fractions[1::2, ::2])]
    points, count = [grid[:, :-1].reshape(-1, 3), grid[:, -1]], ids.size + rows
    strips, corners = list[tuple[Panel, Sheet]](), outlines.points[:, [0, -1]]
    for panel in wide:
        made = sheets(panel, ids[:, 0], last, count)
        points.append(_between(made, corners, count))
        count += len(points[-1])
        for sheet in made:
            parts.append(_panelled(sheet, corners, int(parts[-1].column.max()) + 1))
        strips.append((panel, made[0]))
    for i, web in enumerate(structure.webs, start=1):
        bays = np.flatnonzero((middle > web.extent[0]) & (middle < web.extent[1]))
        if len(bays):
            here = np.arange(2 * bays[0], 2 * bays[-1] + 3)
            at = [starts[foot] for foot in lines.feet[web.name]]
            feet = [(grid[here, foot], ring[here, foot]) for foot in at]
            inner, wall = _wall(feet, size, count)
            points.append(inner)
            count += len(inner)
            share = np.linspace(0.0, 1.0, wall.shape[1] // 2 + 1)
            cuts = np.broadcast_to(share, (len(bays), len(share)))
            parts.append(_gridded(wall, i, bays, cuts))
    quads = np.concatenate([part.quads for part in parts])
    used, again = np.unique(quads, return_inverse=True)
    number = np.full(count, -1)
    number[used] = np.arange(len(used))
    ends = []
    for end in (0, -1):
        rims = [sheet.numbers[end] for panel, sheet in strips if not panel.closes[end]]
        rim = number[np.concatenate([ring[end], *rims])]
        ends.append(np.unique(rim[rim >= 0]))
    gaps = np.where(opened > 0.0, 0.0, width)
    bay = np.concatenate([part.bay for part in parts])
    return Mesh(
        points=np.concatenate(points)[used],
        quads=again.reshape(quads.shape),
        part=np.concatenate([np.full(len(part.bay), part.part) for part in parts]),
        eta=middle[bay],
        bay=bay,
        column=np.concatenate([part.column for part in parts]),
        sides=np.concatenate([part.sides for part in parts]),
        edge=np.concatenate([part.edge for part in parts]),
        along=np.concatenate([part.along for part in parts]),
        shut=np.maximum(0.0, 1.0 - opened[1::2]),
        panels=tuple((float(eta[a]), float(eta[b])) for a, b in (one.reach for one in wide)),
        root=ends[0],
        tip=ends[1],
        gap=float(gaps.max()),
        widest=float(fine[np.argmax(gaps)]),
        lines=lines,
    )


def _between(made: list[Sheet], corners: Array, count: int) -> Array:
    """Return the nodes (n, 3) of sheets that are numbered from a count on."""
    found = np.full((max(int(sheet.numbers.max()) for sheet in made) + 1 - count, 3), np.nan)
    for sheet in made:
        new = sheet.numbers >= count
        found[sheet.numbers[new] - count] = sheet.placed(corners)[new]
    return found


def _wall(feet: list[tuple[Array, Indices]], size: float, count: int) -> tuple[Array, Indices]:
    """Return a web's own nodes (n, 3), and all of its (rows, 2 a + 1) by number, from a count on.

    `feet` are nodes (rows, 3) and their numbers (rows,) on both sides of the skin.
    """
    (upper, first), (lower, last) = feet
    down = 2 * max(1, int(np.ceil(np.linalg.norm(lower - upper, axis=-1).max() / size)))
    share = (np.arange(1, down) / down)[:, None]
    inner = upper[:, None] * (1.0 - share) + lower[:, None] * share
    own = count + np.arange(inner.shape[0] * inner.shape[1]).reshape(inner.shape[:2])
    return inner.reshape(-1, 3), np.concatenate([first[:, None], own, last[:, None]], axis=1)


def _gridded(sheet: Indices, part: int, bays: Indices, cuts: Array) -> _Part:
    """Return elements of nodes (2 a + 1, 2 b + 1) in bays (a,), between cuts (a, b + 1)."""
    quads, columns = _quads(sheet), cuts.shape[1] - 1
    return _Part(
        part,
        quads,
        np.repeat(bays, columns),
        np.tile(np.arange(columns), len(bays)),
        np.stack([cuts[:, :-1], cuts[:, 1:]], axis=-1).reshape(-1, 2),
        np.zeros((len(quads), 2)),
        np.zeros((len(quads), 3)),
    )


def _panelled(sheet: Sheet, corners: Array, column: int) -> _Part:
    """Return elements of a panel between corners (rows, 2, 3), numbered by columns from one on."""
    quads = _quads(sheet.numbers)
    across, rows = (_quads(one)[:, :4].mean(axis=1) for one in (sheet.across, sheet.rows))
    along = np.gradient(corners.mean(axis=1), axis=0)
    pressure = np.where(np.abs(across) < MIDDLE, 0.5, across > 0.0)
    return _Part(
        0,
        quads,
        (rows / 2.0).astype(np.intp),
        column + np.arange(len(quads)),
        np.full((len(quads), 2), OUTSIDE),
        np.stack([1.0 - pressure, pressure], axis=-1),
        along[np.rint(rows).astype(np.intp)],
    )


def _spans(blade: Blade, structure: Structure, size: float) -> Array:
    """Return span fractions about a size apart, those where webs end among them."""
    ends = united(*(web.extent for web in structure.webs), [0.0, 1.0], apart=SNAP)
    pieces = []
    for first, last in pairwise(ends.tolist()):
        count = max(1, int(np.ceil((last - first) * blade.length / size)))
        pieces.append(np.linspace(first, last, count + 1)[:-1])
    return np.concatenate([*pieces, [1.0]])


def _columns(lines: Array, length: Array, size: float) -> tuple[Array, Indices]:
    """Return fractions (rows, 2 columns + 1) of nodes around the skin, and where each line is."""
    middles = 0.5 * (lines[:-1:2] + lines[2::2])
    straight = lines.copy()
    straight[1::2] = middles
    widths = np.quantile(np.diff(straight, axis=1) * length[:, None], FEW, axis=0)
    counts = np.maximum(1, np.ceil(widths / size)).astype(np.intp)
    parts = []
    for i, count in enumerate(counts):
        share = np.arange(2 * count) / (2 * count)
        parts.append(straight[:, i, None] * (1.0 - share) + straight[:, i + 1, None] * share)
    parts.append(straight[:, -1:])
    return np.concatenate(parts, axis=1), 2 * np.concatenate([[0], np.cumsum(counts)])


def _closed(outlines: Outlines, fractions: Array, opened: Array) -> Array:
    """Return points (rows, columns, 3) of the skin, its trailing edge as far open as is said."""
    points = outlines.at(fractions.T).swapaxes(0, 1)
    half = 0.5 * (outlines.points[:, -1] - outlines.points[:, 0]) * (1.0 - opened)[:, None]
    weight = np.clip(1.0 - fractions / BENT, 0.0, 1.0)
    weight = weight - np.clip(1.0 - (1.0 - fractions) / BENT, 0.0, 1.0)
    return points + half[:, None] * weight[..., None]


def _quads(sheet: Any) -> Any:
    """Return elements (m, 8) of a sheet of nodes (2 a + 1, 2 b + 1), or of values at them."""
    low, mid, high = sheet[:-1:2], sheet[1::2], sheet[2::2]
    nodes = [
        *(low[:, :-1:2], high[:, :-1:2], high[:, 2::2], low[:, 2::2]),
        *(mid[:, :-1:2], high[:, 1::2], mid[:, 2::2], low[:, 1::2]),
    ]
    return np.stack(nodes, axis=-1).reshape(-1, 8)
