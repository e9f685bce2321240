"""The ellipsoid of least volume that holds given points: Khachiyan's algorithm.

In: points (m, r).  Out: its centre c and a matrix A with |A (x - c)| <= 1 for all of them.  Weights
of the points rise and fall by turns (M. J. Todd & E. A. Yildirim, On Khachiyan's algorithm for the
computation of minimum-volume enclosing ellipsoids, Discrete Appl. Math. 155 (2007), 1731-1744).
"""

import numpy as np

from bladegen.errors import SpaceError
from bladegen.support.arrays import Array

__all__ = ["smallest"]

TOLERANCE = 1e-6  # of the squared radius: how far the volume may be from the least
STEPS = 200_000


def smallest(points: Array) -> tuple[Array, Array]:
    """Return the centre (r,) and the matrix (r, r) of the smallest ellipsoid around points (m, r).

    It holds all of them: what is left of the tolerance makes it larger, by less than a millionth.

    Raises
    ------
    SpaceError
        If the points span fewer dimensions than r, or the weights do not converge.
    """
    count, r = points.shape
    middle, size = points.mean(axis=0), np.abs(points - points.mean(axis=0)).max(axis=0)
    if count <= r or not np.all(size > 0):
        raise SpaceError(f"ellipsoid: {count} points do not span {r} dimensions")
    scaled = (points - middle) / size
    Q = np.column_stack([scaled, np.ones(count)])
    weights = np.full(count, 1.0 / count)
    inverse = _inverse(Q, weights)
    squares = np.einsum("ij,jk,ik->i", Q, inverse, Q)
    d = r + 1.0
    for step in range(STEPS):
        most = int(np.argmax(squares))
        held = np.flatnonzero(weights)
        least = int(held[np.argmin(squares[held])])
        up, down = squares[most] / d - 1.0, 1.0 - squares[least] / d
        if max(up, down) <= TOLERANCE:
            break
        j = most if up > down else least
        share = (squares[j] - d) / (d * (squares[j] - 1.0))
        share = max(share, -weights[j] / (1.0 - weights[j]))  # a weight that falls ends at zero
        row = inverse @ Q[j]
        factor = share / (1.0 - share + share * squares[j])
        inverse = (inverse - factor * np.outer(row, row)) / (1.0 - share)
        squares = (squares - factor * (Q @ row) ** 2) / (1.0 - share)
        weights *= 1.0 - share
        weights[j] = max(weights[j] + share, 0.0)
        if step % 500 == 499:  # rounding adds up
            inverse = _inverse(Q, weights)
            squares = np.einsum("ij,jk,ik->i", Q, inverse, Q)
    else:
        raise SpaceError(f"ellipsoid: not converged after {STEPS} steps")
    centre = weights @ scaled
    spread = (scaled * weights[:, None]).T @ scaled - np.outer(centre, centre)
    root = np.asarray(np.linalg.cholesky(np.linalg.inv(spread) / r).T, dtype=np.float64)
    farthest = float(np.linalg.norm((scaled - centre) @ root.T, axis=1).max())
    return middle + size * centre, root / (farthest * size)


def _inverse(Q: Array, weights: Array) -> Array:
    return np.asarray(np.linalg.inv((Q * weights[:, None]).T @ Q), dtype=np.float64)
