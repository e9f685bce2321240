"""Nodes and elements of a blade's shell: quadrilaterals of eight nodes on skin and webs.

Rows go along the span, columns around the section from the suction side's trailing edge; a web has
rows and columns of its own between two lines of the skin, and shares their nodes.  Trailing edges
are closed to their middle line, the sides bent to it over the first tenths of the arc.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.layup.outlines import Outlines
from bladegen.blade.layup.shell.lines import Lines, mesh_lines
from bladegen.definition.distribution import united
from bladegen.definition.structure.structure import Structure
from bladegen.support.arrays import Array, Indices

__all__ = ["Mesh", "mesh_of"]

BENT = 0.15  # of the arc, from the trailing edge, over which sides are bent to close it
FEW = 0.9  # quantile of a strip's width over the span that its columns are made for
SNAP = 1e-4  # of the span, between ends of webs


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
        Fractions of the arc, or of the web's height, between which an element lies.
    root, tip : (r,) array
        Nodes of the skin at the ends.
    gap, widest : float
        The widest trailing edge that was closed [m], and its span fraction.
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
    root: Indices
    tip: Indices
    gap: float
    widest: float
    lines: Lines


def mesh_of(blade: Blade, structure: Structure, size: float) -> Mesh:
    """Return the shell of a blade that is no mirror image, of elements about so large [m]."""
    eta = _spans(blade, structure, size)
    fine = np.empty(2 * len(eta) - 1)
    fine[::2], fine[1::2] = eta, 0.5 * (eta[1:] + eta[:-1])
    outlines = Outlines.of(blade, fine)
    lines = mesh_lines(structure, outlines)
    fractions, starts = _columns(lines.fractions, outlines.length, size)
    grid, gaps = _closed(outlines, fractions)
    rows, around = len(fine), grid.shape[1]
    ids = np.arange(rows * around).reshape(rows, around)
    ring = np.concatenate([ids, ids[:, :1]], axis=1)
    ends = np.concatenate([fractions, np.ones((rows, 1))], axis=1)[1::2, ::2]
    sheets = [(ring, np.arange(len(eta) - 1), np.stack([ends[:, :-1], ends[:, 1:]], axis=-1))]
    points = [grid.reshape(-1, 3)]
    middle, count = fine[1::2], ids.size
    for web in structure.webs:
        feet = [int(starts[line]) for line in lines.feet[web.name]]
        bays = np.flatnonzero((middle > web.extent[0]) & (middle < web.extent[1]))
        if not len(bays):
            continue
        here = np.arange(2 * bays[0], 2 * bays[-1] + 3)
        first, last = (grid[here, foot % around] for foot in feet)
        height = float(np.linalg.norm(last - first, axis=-1).max())
        down = 2 * max(1, int(np.ceil(height / size)))
        share = (np.arange(1, down) / down)[:, None]
        inner = first[:, None] * (1.0 - share) + last[:, None] * share
        own = count + np.arange(inner.shape[0] * inner.shape[1]).reshape(inner.shape[:2])
        count += own.size
        points.append(inner.reshape(-1, 3))
        sheet = np.concatenate([ids[here, feet[0], None], own, ids[here, feet[1], None]], axis=1)
        cut = np.broadcast_to(np.arange(down // 2 + 1) / (down // 2), (len(bays), down // 2 + 1))
        sheets.append((sheet, bays, np.stack([cut[:, :-1], cut[:, 1:]], axis=-1)))
    stood = [0, *(i + 1 for i, web in enumerate(structure.webs) if _stands(web.extent, middle))]
    quads = np.concatenate([_quads(sheet) for sheet, _, _ in sheets])
    used, again = np.unique(quads, return_inverse=True)
    number = np.full(count, -1)
    number[used] = np.arange(len(used))
    bay = [np.repeat(bays, sides.shape[1]) for _, bays, sides in sheets]
    return Mesh(
        points=np.concatenate(points)[used],
        quads=again.reshape(quads.shape),
        part=np.concatenate([np.full(b.size, k) for b, k in zip(bay, stood, strict=True)]),
        eta=middle[np.concatenate(bay)],
        bay=np.concatenate(bay),
        column=np.concatenate(
            [np.tile(np.arange(sides.shape[1]), len(bays)) for _, bays, sides in sheets]
        ),
        sides=np.concatenate([sides.reshape(-1, 2) for _, _, sides in sheets]),
        root=number[ids[0]][number[ids[0]] >= 0],
        tip=number[ids[-1]][number[ids[-1]] >= 0],
        gap=float(gaps.max()),
        widest=float(fine[np.argmax(gaps)]),
        lines=lines,
    )


def _stands(extent: tuple[float, float], middle: Array) -> bool:
    return bool(np.any((middle > extent[0]) & (middle < extent[1])))


def _spans(blade: Blade, structure: Structure, size: float) -> Array:
    """Return span fractions about a size apart, those where webs end among them."""
    ends = united(*(web.extent for web in structure.webs), [0.0, 1.0], apart=SNAP)
    pieces = []
    for first, last in pairwise(ends.tolist()):
        count = max(1, int(np.ceil((last - first) * blade.length / size)))
        pieces.append(np.linspace(first, last, count + 1)[:-1])
    return np.concatenate([*pieces, [1.0]])


def _columns(lines: Array, length: Array, size: float) -> tuple[Array, Indices]:
    """Return fractions (rows, 2 columns) of nodes around the skin, and where each line is."""
    middles = 0.5 * (lines[:-1:2] + lines[2::2])
    straight = lines.copy()
    straight[1::2] = middles
    widths = np.quantile(np.diff(straight, axis=1) * length[:, None], FEW, axis=0)
    counts = np.maximum(1, np.ceil(widths / size)).astype(np.intp)
    parts = []
    for i, count in enumerate(counts):
        share = np.arange(2 * count) / (2 * count)
        parts.append(straight[:, i, None] * (1.0 - share) + straight[:, i + 1, None] * share)
    return np.concatenate(parts, axis=1), 2 * np.concatenate([[0], np.cumsum(counts)])


def _closed(outlines: Outlines, fractions: Array) -> tuple[Array, Array]:
    """Return points (rows, around, 3) of the skin, closed behind, and how wide it was (rows,)."""
    points = outlines.at(fractions.T).swapaxes(0, 1)
    half = 0.5 * (outlines.points[:, -1] - outlines.points[:, 0])
    weight = np.clip(1.0 - fractions / BENT, 0.0, 1.0)
    weight = weight - np.clip(1.0 - (1.0 - fractions) / BENT, 0.0, 1.0)
    return points + half[:, None] * weight[..., None], 2.0 * np.linalg.norm(half, axis=-1)


def _quads(sheet: Indices) -> Indices:
    """Return elements (m, 8) of a sheet of nodes (2 a + 1, 2 b + 1), row by row."""
    low, mid, high = sheet[:-1:2], sheet[1::2], sheet[2::2]
    nodes = [
        *(low[:, :-1:2], high[:, :-1:2], high[:, 2::2], low[:, 2::2]),
        *(mid[:, :-1:2], high[:, 1::2], mid[:, 2::2], low[:, 1::2]),
    ]
    return np.stack(nodes, axis=-1).reshape(-1, 8)
