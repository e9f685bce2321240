"""Layers of a mesh around a closed curve, marched outward by the hyperbolic equations.

Lines off the wall are orthogonal to the layer, and cells have given areas:

    r_xi . r_eta = 0,        x_xi y_eta - y_xi x_eta = dA

with xi along the curve and eta outward, to its left.  Each layer is one linear step of the
equations about the last one, with smoothing that grows from the wall outward: J. L. Steger and
D. S. Chaussee, SIAM J. Sci. Stat. Comput. 1 (1980), 431-437; W. M. Chan and J. L. Steger, Appl.
Math. Comput. 51 (1992), 181-205, in two dimensions.
"""

import numpy as np

from bladegen.errors import GeometryError
from bladegen.support.arrays import Array

__all__ = ["GROWTH", "crossed", "marched"]

GROWTH = (1.02, 1.4)  # of a cell's height from layer to layer
MOST = 1000  # layers
SMOOTHING = 0.5  # explicit; implicit twice as much
LEAST = 0.1  # of it, on the wall
SPREADING = 5  # times that areas are averaged with their neighbours', a layer
SHARE = 0.08  # of either neighbour in this


def marched(curve: Array, first: float, growth: float, distance: float) -> Array:
    """Return layers (m, n, 2) around a closed curve, the curve itself first.

    Parameters
    ----------
    curve : (n, 2) array
        Clockwise, so that outward is left.
    first : float
        Height of the cells on it [m].
    growth : float
        Of heights from layer to layer.
    distance : float
        From the curve's middle, that the last layer reaches all around [m].

    Raises
    ------
    GeometryError
        If growth is out of range, or a cell would be folded.
    """
    if not GROWTH[0] <= growth <= GROWTH[1]:
        raise GeometryError(f"growth: got {growth:g}, allowed is {GROWTH[0]:g} to {GROWTH[1]:g}")
    middle = 0.5 * (curve.min(axis=0) + curve.max(axis=0))
    expected = np.log1p(distance * (growth - 1.0) / first) / np.log(growth)
    layers = [curve]
    while np.linalg.norm(layers[-1] - middle, axis=1).min() < distance:
        k = len(layers) - 1
        if k == MOST:
            raise GeometryError(
                f"growth: got {growth:g}, {MOST} layers do not reach {distance:g} m; give more"
            )
        smoothing = SMOOTHING * max(LEAST, min(1.0, np.sqrt(k / expected)))
        layers.append(_next(layers[-1], first * growth**k, smoothing))
        if not crossed(layers[-2], layers[-1]).min() > 0.0:
            raise GeometryError(
                f"mesh: folds in layer {k + 1}; give other cells around, or more growth"
            )
    return np.stack(layers)


def crossed(inner: Array, outer: Array) -> Array:
    """Return the four corners' cross products (4, ..., n) of the cells between layers (..., n, 2).

    All positive if the cells are convex and none is folded.
    """
    a, b = inner, np.roll(inner, -1, axis=-2)
    c, d = np.roll(outer, -1, axis=-2), outer
    corners = (b - a, d - a), (c - b, a - b), (d - c, b - c), (a - d, c - d)
    return np.stack([u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0] for u, v in corners])


def _next(layer: Array, height: float, smoothing: float) -> Array:
    """Return the next layer of (n, 2)."""
    from scipy.sparse import bsr_array
    from scipy.sparse.linalg import spsolve

    n = len(layer)
    ahead, behind = np.roll(layer, -1, axis=0), np.roll(layer, 1, axis=0)
    along = 0.5 * (ahead - behind)
    square = np.sum(along**2, axis=1)
    sides = np.linalg.norm(ahead - layer, axis=1)
    area = height * 0.5 * (sides + np.roll(sides, 1))
    for _ in range(SPREADING):
        area += SHARE * (np.roll(area, 1) + np.roll(area, -1) - 2.0 * area)
    x, y = along.T
    out = (area / square)[:, None] * np.stack([-y, x], axis=1)  # r_eta of the equations
    own = np.array([[x, -y], [y, x]]).transpose(2, 0, 1) / square[:, None, None]
    p, q = out.T
    slope = 0.5 * own @ np.array([[p, q], [q, -p]]).transpose(2, 0, 1)
    explicit = smoothing * np.linalg.norm(out, axis=1) / np.sqrt(square)
    damped = 2.0 * explicit[:, None, None] * np.eye(2)
    at = np.arange(n)
    blocks = np.stack([-slope - damped, np.eye(2) + 2.0 * damped, slope - damped], axis=1)
    columns = np.stack([at - 1, at, at + 1], axis=1) % n
    matrix = bsr_array((blocks.reshape(-1, 2, 2), columns.ravel(), 3 * np.arange(n + 1)))
    right = out + explicit[:, None] * (ahead - 2.0 * layer + behind)
    step: Array = spsolve(matrix.tocsc(), right.ravel()).reshape(n, 2)
    return layer + step
