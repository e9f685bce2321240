"""Airfoil points to fair ones: noise of their digits taken out, each point held to a tolerance.

Coordinates of five digits scatter by some 3e-6 chord about the airfoil that they mean; it does not
show in the contour, but in its curvature.  Points (m, 2) in chords are moved to

    minimise  sum_j (t_j+3 - t_j) / 3 |D3_j|^2     with |moved_i| <= bound_i,

where D3 are third divided differences in chord length t, so that curvature varies as little as it
can.  A point's bound is a few times the scatter of the points around it, the tolerance at most:
points that lie on a smooth curve already, to their last digit, stay.  No nose is made concave, and
none that is so more concave: moves that did are halved.
"""

import numpy as np

from bladegen.errors import GeometryError
from bladegen.support.arrays import Array

__all__ = ["TOLERANCE", "fair"]

TOLERANCE = 1e-5  # of chord: one unit of the fifth digit, the usual last one
COARSEST = 1e-2  # of chord; a tolerance above that would be a change of design
NEIGHBOURS = 3  # on either side, through which a point's scatter is measured
AROUND = 9  # points whose median scatter bounds the middle one's move
FACTOR = 3.0  # of the scatter's median: a rounding error is at most 2.4 times its median
HELD = 1e-14  # chord; the bound of points that do not scatter, and of the ends
ITERATIONS = 40  # of the weights; bounds are met to a few per cent after 20
WITHIN = 1.0 - 1e-9  # of the tolerance, so that rounding does not pass it
NOSE = 0.02  # chords, from the point farthest from the trailing edge on
FINE = 16  # places between points at which a nose is looked at
HALVINGS = 6  # of all moves, until they dent no nose; else points stay
LEVEL = 1e-9  # rad; turns that are rounding
SOFTEST = 1e-13  # of the stiffness; lesser weights leave the equations singular


def fair(points: Array, tolerance: float = TOLERANCE) -> Array:
    """Return airfoil points without their noise.

    Parameters
    ----------
    points : (m, 2) array
        Distinct neighbours, in chords; the first and the last stay.
    tolerance : float
        Largest distance that a point moves, in chords.

    Returns
    -------
    (m, 2) array
        The points moved, none by more than `tolerance`; the same where there are too few to
        tell noise.

    Raises
    ------
    GeometryError
        If the tolerance is not positive or more than a hundredth of the chord.

    Notes
    -----
    The bounds' multipliers are found by multiplicative updates of the weights of a Whittaker
    smoother, each a banded system; what they still miss is taken off at last.
    """
    if not 0.0 < tolerance <= COARSEST:
        raise GeometryError(
            f"fairing: got {tolerance:g} chord, allowed is more than 0 and at most {COARSEST:g}"
        )
    if len(points) < 2 * NEIGHBOURS + 3:
        return points
    t = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    bound = np.minimum(WITHIN * tolerance, FACTOR * _scatter(t, points))
    bound = np.maximum(bound, HELD)
    bound[[0, -1]] = HELD
    rows = _third_differences(t)
    stiffness = _banded(rows)
    roughness = np.sum(_applied(rows, points) ** 2) / len(points)
    softest, columns = SOFTEST * stiffness[-1], np.ascontiguousarray(points.T)
    weight = np.maximum(0.01 * roughness / bound**2, softest)
    for _ in range(ITERATIONS):
        moved = _smoothed(stiffness, weight, columns) - columns
        share = np.hypot(moved[0], moved[1]) / bound
        weight = np.maximum(weight * np.minimum(np.maximum(share, 0.1), 10.0), softest)
        weight[0] = weight[-1] = 1e6 * weight.max()
    moved[:, [0, -1]] = 0.0
    moves = moved.T / max(1.0, float((np.hypot(moved[0], moved[1]) / bound).max()))
    dent = _dent(points)
    for _ in range(HALVINGS):
        if _dent(points + moves) <= dent + LEVEL:
            return np.asarray(points + moves)
        moves *= 0.5
    return points


def _dent(points: Array) -> float:
    """Return by what angle the spline through points turns back at its nose [rad]."""
    from scipy.interpolate import CubicSpline

    t = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    nose = points[np.argmax(np.hypot(*(points - 0.5 * (points[0] + points[-1])).T))]
    near = np.flatnonzero(np.hypot(*(points - nose).T) < NOSE)
    cells = np.arange(max(near[0] - 1, 0), min(near[-1] + 1, len(t) - 1))
    at = (t[cells, None] + np.diff(t)[cells, None] * np.arange(FINE) / FINE).reshape(-1)
    x, y = CubicSpline(t, points)(at, 1).T
    turns = np.arctan2(x[:-1] * y[1:] - y[:-1] * x[1:], x[:-1] * x[1:] + y[:-1] * y[1:])
    return -float(np.minimum(turns, 0.0).sum())


def _scatter(t: Array, points: Array) -> Array:
    """Return how far points lie from the polynomial through their neighbours, smoothed, (m,).

    Over the share of it that independent errors of one point and its neighbours would have.
    """
    m, n = len(points) - 2 * NEIGHBOURS, 2 * NEIGHBOURS + 1
    near = [t[k : k + m] for k in range(n)]
    others = [k for k in range(n) if k != NEIGHBOURS]
    missed, gain = points[NEIGHBOURS : NEIGHBOURS + m].copy(), np.ones(m)
    ahead = [near[NEIGHBOURS] - near[b] for b in range(n)]
    for a in others:
        share = np.ones(m)
        for b in others:
            if b != a:
                share *= ahead[b] / (near[a] - near[b])
        missed -= share[:, None] * points[a : a + m]
        gain += share**2
    scatter = np.hypot(*missed.T) / np.sqrt(gain)
    padded = np.pad(scatter, NEIGHBOURS + AROUND // 2, mode="edge")
    smooth: Array = np.median(np.lib.stride_tricks.sliding_window_view(padded, AROUND), axis=-1)
    return smooth


def _third_differences(t: Array) -> Array:
    """Return the factors (4, m - 3) of four neighbours in third derivatives, by their length."""
    j = np.arange(len(t) - 3)
    rows = np.empty((4, len(j)))
    for a in range(4):
        others = [t[j + a] - t[j + b] for b in range(4) if b != a]
        rows[a] = 6.0 / (others[0] * others[1] * others[2])
    return rows * np.sqrt((t[3:] - t[:-3]) / 3.0)


def _applied(rows: Array, points: Array) -> Array:
    """Return the third differences of points, (m - 3, 2)."""
    count = rows.shape[1]
    total: Array = sum(
        (rows[a][:, None] * points[a : a + count] for a in range(4)), np.zeros((count, 2))
    )
    return total


def _banded(rows: Array) -> Array:
    """Return the matrix of the squared differences in upper banded form, (4, m)."""
    count = rows.shape[1]
    bands = np.zeros((4, count + 3))
    for a in range(4):
        for b in range(a, 4):
            bands[3 + a - b, b : b + count] += rows[a] * rows[b]
    return np.asfortranarray(bands)


def _smoothed(stiffness: Array, weight: Array, columns: Array) -> Array:
    """Return the points (2, m) of least roughness plus weighted squared moves."""
    from scipy.linalg.lapack import dpbsv  # solveh_banded without its checks, a third of the time

    bands = stiffness.copy(order="F")  # as LAPACK wants it, or it is copied once more
    bands[-1] += weight
    _, solved, failed = dpbsv(bands, (weight * columns).T, overwrite_ab=1, overwrite_b=1)
    if failed:
        raise GeometryError("fairing: points lie too unevenly; fairing=None keeps them")
    return np.asarray(solved).T
