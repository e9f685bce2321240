"""Kulfan's parameters of sections, as NeuralFoil's networks take them: a linear fit.

Eight weights a side, one of the leading edge and the edge's thickness, which is not negative, by
least squares: B. M. Kulfan, Journal of Aircraft 45 (2008), with the leading edge's term of
NeuralFoil's author (https://github.com/peterdsharpe/AeroSandbox).
"""

from math import comb
from typing import Any

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["KULFAN", "WEIGHTS", "in_chords", "kulfan"]

WEIGHTS = 8  # of Kulfan's parameters a side, as the networks take them
KULFAN = 2 * WEIGHTS + 2


def in_chords(points: Array) -> tuple[Any, Any]:
    """Return sections (b, n, 2) as complex numbers (b, n) in chords, and their chords (b,).

    The nose is the point in the middle and becomes 0, the middle of the trailing edge becomes 1.
    A chord is a complex number too: its argument is the way from nose to trailing edge.
    """
    z = points[..., 0] + 1j * points[..., 1]
    nose = z[:, z.shape[1] // 2, None]
    chord = 0.5 * (z[:, :1] + z[:, -1:]) - nose
    return (z - nose) / chord, chord[:, 0]


def kulfan(x: Array, y: Array) -> tuple[Array, Any]:
    """Fit Kulfan's parameters (b, 18) to sections in chords, leading edge in the middle.

    Upper and lower weights, the weight of the leading edge, the edge's thickness, which is not
    negative: the order in which NeuralFoil takes them.  The second result takes gradients
    (b, q, 18) in parameters back to x and y (b, q, n).
    """
    n, middle = x.shape[-1], x.shape[-1] // 2
    upper = np.arange(n) < middle
    # the nose is 0, 0 whatever the parameters are; the others lie within a chord of the edge
    x = np.where(np.arange(n) == middle, 0.5, np.maximum(x, 1e-12))
    kept = np.arange(n) != middle
    basis, slopes = _basis(x)
    nose = x * np.maximum(1.0 - x, 0.0) ** (WEIGHTS + 0.5)
    nose_slope = np.maximum(1.0 - x, 0.0) ** (WEIGHTS - 0.5) * (1.0 - (WEIGHTS + 1.5) * x)
    side = np.where(upper, 0.5, -0.5)

    def rows(basis: Array, nose: Array, edge: Array) -> Array:
        halves = basis * upper[:, None], basis * ~upper[:, None]
        made = np.concatenate([*halves, nose[..., None], edge[..., None]], axis=-1)
        return np.asarray(made * kept[:, None])

    matrix = rows(basis, nose, side * x)
    slope = rows(slopes, nose_slope, np.broadcast_to(side, x.shape))
    inverse = np.linalg.pinv(matrix)
    sharp = np.einsum("bn,bn->b", inverse[:, -1], y) < 0.0
    matrix[sharp, :, -1], slope[sharp, :, -1] = 0.0, 0.0
    if sharp.any():
        inverse[sharp] = np.linalg.pinv(matrix[sharp])
    found = np.einsum("bmn,bn->bm", inverse, y)
    missed = (y - np.einsum("bnm,bm->bn", matrix, found)) * kept

    def back(gradient: Array) -> tuple[Array, Array]:
        in_y = gradient @ inverse
        moved = in_y @ inverse.mT
        through = np.einsum("bnm,bm->bn", slope, found)[:, None]
        in_x = missed[:, None] * (moved @ slope.mT) - in_y * through
        return in_x, in_y

    return found, back


def _basis(x: Array) -> tuple[Array, Array]:
    """Return the terms (b, n, 8) of one side, class exponents 1/2 and 1, and their slopes."""
    k = np.arange(WEIGHTS)
    choose = np.array([float(comb(WEIGHTS - 1, int(j))) for j in k])
    x = x[..., None]
    # x^(k + 1/2) (1 - x)^(8 - k): at blunt edges x passes 1 by a little, where whole powers hold
    low, high = x ** (k + 0.5), (1.0 - x) ** (WEIGHTS - k)
    low_slope = (k + 0.5) * x ** (k - 0.5)
    high_slope = -(WEIGHTS - k) * (1.0 - x) ** (WEIGHTS - k - 1)
    return choose * low * high, choose * (low_slope * high + low * high_slope)
