"""Compiled loops from sections' own derivatives to those of points, and back.

Arrays are (k, b, ...), spans first, as in `variants.kernels`; points and directions (b, k, ...).
"""

import numpy as np

from bladegen.curves.plane_maps import combine
from bladegen.parametric.edge_slopes import SLOPES, back, carried_on, finished
from bladegen.support.arrays import Array
from bladegen.support.compiled import compiled

__all__ = ["points_gradient", "points_slopes"]

REVISION = 15  # of all that is compiled with these: with another text it is compiled anew
BLOCK = 128  # points


@compiled
def points_slopes(
    values: Array,
    c: Array,
    changes: Array,
    kind: int,
    width: Array,
    to_space: Array,
    chain: Array,
    width_chain: Array,
    space_chain: Array,
    sections: Array,
    result: Array,
    first: int,
    step: int,
) -> None:
    """Fill points of sections and their derivatives in p directions.

    Parameters
    ----------
    values : (k, F, n) array
        Features at the points that are wanted, symmetric about the leading edge.
    c, changes : (k, b, F, 2), (k, b, q, F, 2) arrays
        Coefficients in chords, and their derivatives.
    kind : int
        Of the edge's finish: `edge_slopes.GIVEN`, `MINIMUM` or `SHARP`.
    width : (b, k) array
        Of the edges, in chords.
    to_space : (b, k, 3, 3) array
        Maps of (x, y, 1) to space.
    chain, width_chain, space_chain : (b, k, q, p), (b, k, p), (b, k, 3, 3, p) arrays
        Derivatives in the directions: of a section's own coordinates, of its edge's width, and of
        its map to space.
    sections, result : (b, k, n, 3), (b, k, n, 3, p) arrays
        Filled.
    first, step : int
        Which of the spans, as in a range.
    """
    spans, count, own = changes.shape[:3]
    n, p = values.shape[-1], chain.shape[-1]
    points = np.empty((2, n))
    rules, parts = np.empty((n // 2, SLOPES)), np.empty((own + 1, 2, n))
    rows, ways = np.empty((own + 4, n)), np.empty((own + 4, p))
    for k in range(first, spans, step):
        for b in range(count):
            combine(values[k], c[k, b], points)
            gap = finished(points, kind, width[b, k], rules)
            for q in range(own):
                combine(values[k], changes[k, b, q], parts[q])
                carried_on(rules, kind, gap, width[b, k], 0.0, parts[q])
            for i in range(n):
                parts[own, 0, i] = parts[own, 1, i] = 0.0
            carried_on(rules, kind, gap, width[b, k], 1.0, parts[own])
            axes = to_space[b, k]
            for i in range(n):
                rows[own + 1, i], rows[own + 2, i], rows[own + 3, i] = (
                    points[0, i],
                    points[1, i],
                    1.0,
                )
            for g in range(p):
                for q in range(own):
                    ways[q, g] = chain[b, k, q, g]
                ways[own, g] = width_chain[b, k, g]
            for j in range(3):
                x, y = axes[0, j], axes[1, j]
                mixed(points[0], points[1], x, y, axes[2, j], sections[b, k, :, j])
                for q in range(own + 1):
                    mixed(parts[q, 0], parts[q, 1], x, y, 0.0, rows[q])
                for g in range(p):
                    for q in range(3):
                        ways[own + 1 + q, g] = space_chain[b, k, q, j, g]
                summed(rows, ways, j, result[b, k])


@compiled
def mixed(one: Array, two: Array, a: float, b: float, c: float, result: Array) -> None:
    """Fill an array (n,) with ``a one + b two + c``."""
    for i in range(len(result)):
        result[i] = a * one[i] + b * two[i] + c


@compiled
def summed(rows: Array, ways: Array, j: int, result: Array) -> None:
    """Fill ``result[:, j]`` (n, p) of (n, 3, p) with rows (q, n) times ways (q, p), mostly zeros.

    Block by block of points, so that what is summed lies in the processor's nearest cache.
    """
    count, n = rows.shape
    p = ways.shape[1]
    block = np.empty((p, BLOCK))
    for first in range(0, n, BLOCK):
        length = min(BLOCK, n - first)
        for g in range(p):
            column = block[g, :length]
            for i in range(len(column)):
                column[i] = 0.0
            for q in range(count):
                way, row = ways[q, g], rows[q, first : first + length]
                if way != 0.0:
                    for i in range(len(row)):
                        column[i] += way * row[i]
        for i in range(length):
            there = result[first + i, j]
            for g in range(len(there)):
                there[g] = block[g, i]


@compiled
def points_gradient(
    values: Array,
    c: Array,
    changes: Array,
    kind: int,
    width: Array,
    to_space: Array,
    gradient: Array,
    own: Array,
    in_width: Array,
    in_space: Array,
    first: int,
    step: int,
) -> None:
    """Carry a gradient of points (b, k, n, 3) back to what sections are made of.

    Filled are `own` (b, k, q), the gradient in a section's own coordinates, `in_width` (b, k), in
    its edge's width, and `in_space` (b, k, 3, 3), in its map to space.  Spans are those of a range.
    """
    spans, count, directions, features = changes.shape[:4]
    n = values.shape[-1]
    points, g = np.empty((2, n)), np.empty((2, n))
    rules = np.empty((n // 2, SLOPES))
    for k in range(first, spans, step):
        for b in range(count):
            combine(values[k], c[k, b], points)
            gap = finished(points, kind, width[b, k], rules)
            axes, there = to_space[b, k], in_space[b, k]
            for i in range(3):
                for j in range(3):
                    there[i, j] = 0.0
            for i in range(n):
                x, y = points[0, i], points[1, i]
                g[0, i] = g[1, i] = 0.0
                for j in range(3):
                    one = gradient[b, k, i, j]
                    there[0, j] += x * one
                    there[1, j] += y * one
                    there[2, j] += one
                    g[0, i] += axes[0, j] * one
                    g[1, i] += axes[1, j] * one
            in_width[b, k] = back(rules, kind, gap, width[b, k], g)
            for q in range(directions):
                own[b, k, q] = 0.0
            for f in range(features):
                x = y = 0.0
                for i in range(n):
                    x += values[k, f, i] * g[0, i]
                    y += values[k, f, i] * g[1, i]
                for q in range(directions):
                    own[b, k, q] += changes[k, b, q, f, 0] * x + changes[k, b, q, f, 1] * y
