"""Where the points of a tip's rim and core lie, so that cells there join the sides'.

Cells begin at the outline as high as the sides' last cells are and grow geometrically up to the
middle, on lines across the tip, on which the rim ends after so many of them; rim and core have
cells as large where they meet.  Towards the nose the core takes the shape that it has there.
Names are those of `caps`.  Metres, blade frame.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.support.arrays import Array
from bladegen.surface.grids.caps import Layout, divisions
from bladegen.surface.grids.measuring import (
    LEAST_SINE,
    TipSurface,
    along_rows,
    away,
    facing_cells,
    lengths,
    sines,
)
from bladegen.surface.grids.stretching import (
    FASTEST,
    LARGEST,
    between,
    eased,
    growth,
    partial_sums,
    symmetric,
)

__all__ = ["layout"]

DEPTH = 0.3  # a flat core ends where the nose is so deep for its half width: 45 degrees turned
CLOSEST = 1.6  # but no nearer than so many times the distance at which the rim leaves the sides
NARROWED = 0.75  # there the core is as wide as the rim, nearly
ROUND_CLOSEST = 1.4  # the same on a round tip, where the core need not narrow
ROUND_ENDS = 0.25  # w of a round core's corner: 45 degrees of the half plane
FARTHEST = 0.25  # e, half way to the trailing edge
REACHED = 1.3  # times what cells that grow geometrically reach: a rim's last ones at the nose
LONGER = 1.0  # times as wide: a core's cells at the nose at most
STEP = 0.01  # of w, for a direction
NARROW = 8.0  # cells over which a core's length shrinks to the nose
NOSE_CELL = 0.5  # the last cell of a rim at the nose, of the core's there, at least


def layout(last: Array, u: Array, edge: int, poles: Array | None) -> Layout:
    """Lay out a tip's cap.

    Parameters
    ----------
    last : (2, n, 3) array
        The sides' last two sections [m]; the rim starts from the second.
    u : (n,) array
        The landmark parameters of their points.
    edge : int
        Cells across the tip, even, at least 4.
    poles : (n // 2 + 1, 4, 3) array or None
        Of a round tip's arcs there.
    """
    outline, flat = last[1], poles is None
    layers, across = divisions(edge, flat=flat)
    n, middle = len(u), len(u) // 2
    corner = middle - across // 2  # the core's nose faces so many cells of the outline
    e = np.abs(u - 0.5)
    surface = TipSurface(outline, e[: middle + 1], poles)
    heights = away(last[1] - last[0], outline)

    nose = _core_ends(surface, e[: corner + 1], float(heights[middle]), layers)
    ends = 0.5 * (1.0 - NARROWED * e[corner] / nose) if flat else ROUND_ENDS
    first = float(heights[middle])
    deep = surface(np.array([nose, 0.0]), np.array(0.5))
    depth = np.linalg.norm(deep[:1] - outline[middle], axis=-1)
    first = min(first, float(depth[0]) / layers)
    grown = float(first * growth(layers, depth / first)[0] ** (layers - 1))
    inner = _chordwise(surface, e[: corner + 1], nose, ends, across, REACHED * grown)
    within = np.concatenate([inner, np.full(across - 1, nose), inner[::-1]])
    near = (nose / inner - 2.0 * nose) / (1.0 - 2.0 * nose)  # 0 at the trailing edge, 1 there
    suction, pressure = (
        _half(one, inner, near, heights[::turn], ends, edge)
        for one, turn in ((surface, 1), (surface.mirrored, -1))
    )
    heights = np.concatenate(
        [suction.heights, heights[corner + 1 : -corner - 1], pressure.heights[::-1]]
    )

    place = np.linspace(0.0, 1.0, surface.samples)
    way = _across(surface, inner)
    width = way[:, -1] - suction.deep - pressure.deep
    least = 0.5 / partial_sums(across // 2, np.array(FASTEST))[-1]
    laws = [
        symmetric(across, np.clip(half.cell / width, least, LARGEST / across))
        for half in (suction, pressure)
    ]
    law = np.concatenate([laws[0][:, : across // 2], laws[1][:, across // 2 :]], axis=1)
    core_w = along_rows(way, place, suction.deep[:, None] + width[:, None] * law).T
    core_w[[0, -1]] = [suction.begin, 1.0 - pressure.begin]
    core_e = np.broadcast_to(inner, core_w.shape)

    w, t = np.where(np.arange(n) > middle, 1.0, 0.0), place[:, None]
    straight = (not flat) * np.concatenate([near, np.ones(across - 1), near[::-1]])
    opposite = np.concatenate([core_w[0], core_w[1:-1, -1], core_w[-1, ::-1]])
    points = surface(*_ways(e, w, within, opposite, t, straight))
    if flat:
        points = points[0] + t[..., None] * (points[-1] - points[0])
    edges = [surface(a, b) for a, b in zip(*_beside(core_e, core_w), strict=True)]
    facing = [away(edges[i + 1] - edges[i], edges[i]) for i in (0, 2, 4)]
    t = _rim_cells(points, heights, facing, layers)
    rim_e, rim_w = _ways(e, w, within, opposite, t, straight)
    columns = _edge_columns(rim_e, core_e), _edge_columns(rim_w, core_w)
    beside = [surface(a, b) for a, b in zip(*columns, strict=True)]
    edge_cells = away(beside[1] - beside[0], beside[0])
    return Layout(rim_e, rim_w, core_e, core_w, corner, t, flat, edge_cells)


@dataclass(frozen=True, eq=False)
class _Half:
    """How a tip's suction side is divided, on lines across the tip.

    The rim ends at places `begin` (m,), so `deep` [m] from the side; its cells begin as high as
    `heights` [m] and end as large as `cell` [m].
    """

    begin: Array
    deep: Array
    heights: Array
    cell: Array


def _half(
    surface: TipSurface, inner: Array, near: Array, heights: Array, ends: float, edge: int
) -> _Half:
    """Divide lines at distances `inner` (m,) from the nose; the sides' cells are `heights` (n,).

    At the nose, where `near` is 1, the rim ends at the place `ends`.
    """
    flat, e = surface.poles is None, surface.e[: len(inner)]
    layers, _ = divisions(edge, flat=flat)
    place = np.linspace(0.0, 1.0, surface.samples)
    way = _across(surface, inner)
    sine = sines(surface(inner, place[1:2]) - surface(inner, place[:1]), surface(inner, place[:1]))
    wanted = heights[: len(inner)] / sine / way[:, -1]
    first = eased(edge, wanted)
    share = symmetric(edge, first)[:, layers]
    begin = along_rows(way, place, (share * way[:, -1])[:, None])[:, 0]
    begin += (max(ends, begin[-1]) - begin) * near

    rim_e, rim_w = _ways(e, 0.0 * e, inner, begin, place[:, None], near * (not flat))
    points = surface(rim_e, rim_w)
    if flat:
        points = points[0] + place[:, None, None] * (points[-1] - points[0])
    rim = lengths(points.swapaxes(0, 1))[:, -1]
    rim[0] = rim[1] if rim[0] <= 0.0 else rim[0]
    small = first * way[:, -1]
    cell = small * growth(layers, rim / small) ** (layers - 1)
    row = surface(inner[-2:], begin[[-1, -1]])
    column = surface(inner[[-1, -1]], begin[-1] + np.array([0.0, STEP]))
    arriving = np.stack([points[-2, -1] - points[-1, -1]] * 2)
    turned = sines(arriving, points[-1, -2:])[1] / sines(arriving, column)[0]
    cell *= (turned * float(np.linalg.norm(row[1] - row[0])) / cell[-1]) ** near
    deep = along_rows(np.broadcast_to(place, way.shape), way, begin[:, None])[:, 0]
    return _Half(begin, deep, heights[: len(inner)] * first / wanted, cell)


def _across(surface: TipSurface, inner: Array) -> Array:
    """Return lengths along lines across the tip, (m, samples); a sharp edge has its neighbour's."""
    place = np.linspace(0.0, 1.0, surface.samples)
    way = lengths(surface(np.broadcast_to(inner[:, None], (len(inner), len(place))), place))
    way[0] = way[1] if way[0, -1] <= 0.0 else way[0]
    return way


def _beside(*core: Array) -> list[list[Array]]:
    """Return e and w of the core's edges, each followed by the line beside it."""
    return [[c[0], c[1], c[:, -1], c[:, -2], c[-1, ::-1], c[-2, ::-1]] for c in core]


def _edge_columns(rim: Array, core: Array) -> list[Array]:
    """Return e or w of a tip's points at the trailing edge and beside it, from suction side."""
    return [np.concatenate([rim[:-1, j], core[:, j], rim[-2::-1, -1 - j]]) for j in (0, 1)]


def _chordwise(
    surface: TipSurface, e: Array, nose: float, ends: float, across: int, longest: float
) -> Array:
    """Return the core's distances from the nose, (m,), for those of the outline.

    Its cells are as long as the outline's, in proportion, but for those next to the nose, which
    are no longer than they are wide.
    """
    column = surface(np.full(surface.samples, nose), np.linspace(ends, 1.0 - ends, surface.samples))
    wide = min(LONGER * float(lengths(column)[-1]) / across, longest)
    narrow = min(1.0, wide / _corner_cell(surface, e))
    ahead = np.arange(len(e) - 2, -1, -1)  # cells from each to the nose
    cells = np.diff(e) * (1.0 - (1.0 - narrow) * np.exp(-ahead / NARROW))
    result: Array = e[0] + np.concatenate([[0.0], np.cumsum(cells)]) * (e[0] - nose) / -cells.sum()
    result[-1] = nose
    return result


def _ways(
    e: Array, w: Array, within: Array, opposite: Array, t: Array, straight: Array
) -> tuple[Array, Array]:
    """Return e and w of the rim's lines at parameters t (m, n) or (m, 1).

    They are linear in e and w, and by a share `straight` (n,) straight in the half plane.
    """
    rim_e, rim_w = (1.0 - t) * e + t * within, (1.0 - t) * w + t * opposite
    start, stop = (a * np.exp(1j * np.pi * b) for a, b in ((e, w), (within, opposite)))
    bent, line = rim_e * np.exp(1j * np.pi * rim_w), (1.0 - t) * start + t * stop
    line = bent + straight * (line - bent)
    inside = (straight > 0.0) & (t > 0.0) & (t < 1.0)
    rim_e = np.where(inside, np.abs(line), rim_e)
    rim_w = np.where(inside, np.angle(line) / np.pi, rim_w)
    return rim_e, rim_w


def _rim_cells(points: Array, first: Array, facing: list[Array], layers: int) -> Array:
    """Return where a rim's points lie, t (layers + 1, n), on lines given by points (m, n, 3).

    Their first cells are to be as high as `first` (n,), normal to the outline, their last as high
    as the core's that they are `facing`: on its suction side, at its nose, on its pressure side.
    Its corners face two of them.
    """
    way = lengths(points.swapaxes(0, 1))
    empty = way[:, -1] <= 0.0
    way[empty] = np.linspace(0.0, 1.0, way.shape[1])
    total = way[:, -1]
    begin = first / np.maximum(sines(points[1] - points[0], points[0]), LEAST_SINE)
    last = facing_cells(points[-2] - points[-1], points[-1], facing)
    places = between(layers, begin / total, last / total)
    t = along_rows(way, np.linspace(0.0, 1.0, way.shape[1]), places * total[:, None]).T
    t[0], t[-1] = 0.0, 1.0
    return t


def _corner_cell(surface: TipSurface, e: Array) -> float:
    """Return how long the outline's last cells are that face the core's sides, e (m,)."""
    return float(
        np.mean([np.linalg.norm(np.diff(surface(e[-2:], np.array(w)), axis=0)) for w in (0.0, 1.0)])
    )


def _core_ends(surface: TipSurface, e: Array, first: float, layers: int) -> float:
    """Return the distance e from the nose at which the core ends.

    `e` are the outline's points up to that which the core's corner faces.  The rim's cells grow
    from `first` to what the outline's are there.
    """
    middle, sides = surface(e, np.array(0.5)), surface(e, np.array(0.0))
    depth = np.linalg.norm(middle - surface(np.zeros(1), np.array(0.0)), axis=-1)
    cell = NOSE_CELL * _corner_cell(surface, e)
    first = min(first, cell)
    ratio = (cell / first) ** (1.0 / layers)
    needed = first * partial_sums(layers, np.array(ratio))[-1]
    nearest = ROUND_CLOSEST * e[-1]
    if surface.poles is None:
        half = np.linalg.norm(sides - middle, axis=-1)
        nearest = max(e[int(np.argmax(depth <= DEPTH * half))], CLOSEST * e[-1])
    deep = float(np.interp(needed, depth[::-1], e[::-1]))
    return float(min(max(nearest, deep), FARTHEST))
