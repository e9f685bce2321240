"""Layers around a blade, each grown from the last along smoothed normals.

A point r is to move by one layer's height h along its normal n and, with more weight e in later
layers, towards the middle of its neighbours on either grid line, by

    s = (r+ - 2 r + r-) / (|r+ - r| + |r - r-|),

which spreads the few lines that leave an edge.  The steps d are smoothed over a length c h of the
front:

    d - (c h)^2 div grad d = h (n + e s),      |e s| < c / 4,

an elliptic equation on the front's cells (finite volumes; weights area / 2 length^2 an edge).  As
the second difference of the implicit step of the hyperbolic equations, it bounds the growth of
waves when a layer is much higher than cells are wide, and smooths corners only as far as the
layer is high.  On the wall c is small, so that lines leave it at right angles and first cells are
as high as asked for.  At the root, lines stay on its plane.

What is taken over: smoothing in proportion to a layer's height over the cells' width, which grows
with the distance from the wall, normals averaged at corners: W. M. Chan and J. L. Steger,
"Enhancements of a three-dimensional hyperbolic grid generation scheme", Appl. Math. Comput. 51
(1992), 181-205; points where other than four lines meet: N. R. Secco, G. K. W. Kenway, P. He,
C. Mader and J. R. R. A. Martins, "Efficient mesh generation and deformation for aerodynamic shape
optimization", AIAA J. 59 (2021), 1151-1168.  Normals are those of the cells weighted by their
angles: G. Thuermer and C. A. Wuethrich, J. Graph. Tools 3 (1998), 43-46.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from bladegen.support.arrays import Array, Indices
from bladegen.surface.volumes.front import Front

__all__ = ["layers", "point_normals"]

WALL, FAR = 0.5, 2.0  # c: over how many heights of a layer steps are smoothed
SPREAD = 3.0  # e, in the last layer
STEEPEST = 0.25  # of c: e s at most
RAMP = 2.0, 30.0  # distances, first heights, between which smoothing grows from WALL to FAR
LENGTHENED = 2.0  # times: steps on the wall that smoothing at an edge has made less high
LEAST_ANGLE = 1e-3


def layers(
    front: Front, first: float, growth: float, expected: float, smoothing: float
) -> Iterator[Array]:
    """Give one layer of points (p, 3) after another, without an end.

    Parameters
    ----------
    front : Front
        The wall.
    first : float
        Height of the cells on it [m].
    growth : float
        Of heights from layer to layer.
    expected : float
        How many layers there will be, about.
    smoothing : float
        Times the smoothing along the front, and the spreading.
    """
    points, k = front.points, 0
    solve = _Solver()
    while True:
        height = first * growth**k
        share = _share((growth**k - 1.0) / (growth - 1.0))
        along = smoothing * (WALL + share * (FAR - WALL))
        spread = smoothing * SPREAD * min(k / expected, 1.0)
        normals, area = _measured(front, points)
        aside = spread * _towards_middle(front, points)
        bound = STEEPEST * along  # so that what is smoothed over a length cannot fold within it
        aside /= np.sqrt(1.0 + np.sum(aside**2, axis=1) / bound**2)[:, None]
        wanted = normals + aside
        step = solve(front, points, area, height * wanted, along * height)
        step[front.root] -= np.outer(step[front.root] @ front.normal, front.normal)
        limit = 1.0 + (LENGTHENED - 1.0) * (1.0 - share)
        reached = np.sum(step * normals, axis=1) / height
        step *= np.clip(1.0 / np.maximum(reached, 1.0 / limit), 1.0 / limit, None)[:, None]
        points = points + step
        k += 1
        yield points


def point_normals(front: Front, points: Array) -> Array:
    """Return unit normals (p, 3) at a front's points; at the root they are along its plane."""
    return _measured(front, points)[0]


def _share(distance: float) -> float:
    """Return how far smoothing has grown at a distance over the first height, 0 to 1."""
    low, high = np.log(RAMP[0]), np.log(RAMP[1])
    return float(np.clip((np.log(max(distance, 1.0)) - low) / (high - low), 0.0, 1.0))


def _measured(front: Front, points: Array) -> tuple[Array, Array]:
    """Return unit normals (p, 3) at points, and areas (c,) of cells."""
    corners = points[front.cells]
    ahead, behind = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    across = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    twice = np.linalg.norm(across, axis=1)
    unit = across / twice[:, None]
    sine = np.einsum("cij,cj->ci", np.cross(ahead, behind), unit)
    angles = np.arctan2(sine, np.einsum("cij,cij->ci", ahead, behind))
    weights = np.maximum(angles, LEAST_ANGLE)
    at = front.cells.reshape(-1)
    normals = _gathered(at, (weights[:, :, None] * unit[:, None]).reshape(-1, 3), len(points))
    normals[front.root] -= np.outer(normals[front.root] @ front.normal, front.normal)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return normals, 0.5 * twice


def _towards_middle(front: Front, points: Array) -> Array:
    """Return how far points (p, 3) are off the middle of their neighbours, over these' distance.

    Both pairs of an inner point's neighbours count, once each; where other than four lines meet,
    all neighbours together stand for them.
    """
    at = points[front.centres]
    ahead, behind = points[front.ahead] - at, points[front.behind] - at
    length = np.linalg.norm(ahead, axis=1) + np.linalg.norm(behind, axis=1)
    share = np.where(front.root[front.centres], 1.0, 0.5) / length
    moved = _gathered(front.centres, share[:, None] * (ahead + behind), len(points))
    if len(front.odd):
        ways = points[front.beside] - points[front.odd]
        total = np.bincount(front.odd, np.linalg.norm(ways, axis=1), len(points))
        moved += _gathered(front.odd, 2.0 / total[front.odd, None] * ways, len(points))
    return moved


def _gathered(at: Indices, values: Array, count: int) -> Array:
    """Return sums (count, 3) of values (m, 3) by their places."""
    return np.stack([np.bincount(at, column, count) for column in values.T], axis=1)


@dataclass
class _Solver:
    """Solves the elliptic equation on layer after layer, in an order of points found once."""

    order: Indices | None = None

    def __call__(
        self, front: Front, points: Array, area: Array, wanted: Array, length: float
    ) -> Array:
        from scipy.sparse import coo_array
        from scipy.sparse.linalg import splu

        count = len(points)
        corners = points[front.cells]
        steps = np.roll(corners, -1, axis=1) - corners
        weights = (0.5 * length**2 * area[:, None] / np.sum(steps**2, axis=2)).reshape(-1)
        a, b = front.cells.reshape(-1), np.roll(front.cells, -1, axis=1).reshape(-1)
        mass = np.bincount(a, np.repeat(0.25 * area, 4), count)
        diagonal = mass + np.bincount(a, weights, count) + np.bincount(b, weights, count)
        scale = 1.0 / np.sqrt(diagonal)
        off = -weights * scale[a] * scale[b]
        every = np.arange(count)
        place = every if self.order is None else np.argsort(self.order)
        values = np.concatenate([off, off, np.ones(count)])
        rows, columns = (place[np.concatenate(each)] for each in ((a, b, every), (b, a, every)))
        matrix = coo_array((values, (rows, columns)), shape=(count, count)).tocsc()
        known = self.order is not None
        made = splu(
            matrix,
            permc_spec="NATURAL" if known else "MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        right = (mass * scale)[:, None] * wanted
        if self.order is None:
            self.order = np.argsort(made.perm_c)
            found = made.solve(right)
        else:
            found = made.solve(right[self.order])[place]
        step: Array = found * scale[:, None]
        return step
