"""Arc lengths along plane curves that are piecewise polynomials."""

from typing import TYPE_CHECKING

import numpy as np

from bladegen.support.arrays import Array

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

__all__ = ["lengths"]

NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)


def lengths(spline: "PPoly", start: Array, end: Array) -> Array:
    """Return the arc lengths between parameters, by Gauss-Legendre quadrature."""
    half = 0.5 * (end - start)[:, None]
    t = 0.5 * (end + start)[:, None] + half * NODES
    speed = np.linalg.norm(spline(t, 1), axis=-1)
    return np.asarray(np.sum(half * speed * WEIGHTS, axis=1))
