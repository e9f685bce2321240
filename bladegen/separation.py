"""Proofs that a contour does not cross itself, for many contours at once.

A contour runs trailing edge -> suction side -> leading edge -> pressure side, and is closed
over the trailing edge.  Both tests below are certain where they say yes, and leave the others
open.  They cost a few operations a landmark, while an exact test costs many.

Seen along some axis, a closed contour that goes back and forth only once is two graphs, and
winds about any point 1, 0 or -1 times.  `ladders` adds that the strip between opposite
landmarks is covered by triangles that all turn the same way: then no point is wound about
-1 times, and the graphs do not cross.  `graphs` compares the two graphs themselves.
"""

import numpy as np

from bladegen.arrays import Array, Mask

__all__ = ["graphs", "ladders", "once_back_and_forth", "upright"]

APART = 1e-9  # chord; sides closer than this are left to the exact test
FLAT = -1e-14  # chord^2; closed edges make triangles of no area, to rounding
ANGLES = np.linspace(0.0, np.pi, 8, endpoint=False)


def ladders(points: Array) -> Mask:
    """Tell which contours (..., n, 2) are proved sound by triangles between their sides."""
    middle = points.shape[-2] // 2
    upper, lower = points[..., : middle + 1, :], points[..., : -middle - 2 : -1, :]
    rungs, steps = upper - lower, (np.diff(upper, axis=-2), np.diff(lower, axis=-2))
    x, y = np.moveaxis(rungs, -1, 0)
    (ux, uy), (lx, ly) = (np.moveaxis(step, -1, 0) for step in steps)
    return once_back_and_forth(points[..., 0]) & upright(x, y, ux, uy, lx, ly)


def upright(x: Array, y: Array, ux: Array, uy: Array, lx: Array, ly: Array) -> Mask:
    """Tell where all triangles between two sides turn the same way.

    Parameters
    ----------
    x, y : (..., m + 1) arrays
        From the pressure side's to the suction side's landmark, from the trailing edge on.
    ux, uy, lx, ly : (..., m) arrays
        From landmark to landmark along the suction (u) and the pressure side (l).
    """
    below = ly * x[..., :-1] - lx * y[..., :-1]
    above = uy * x[..., 1:] - ux * y[..., 1:]
    turned: Mask = np.minimum(below, above).min(axis=-1) >= FLAT
    return turned


def once_back_and_forth(x: Array) -> Mask:
    """Tell which closed contours go back and forth only once in x (..., n)."""
    ahead = np.empty(x.shape, dtype=bool)
    np.greater(x[..., 1:], x[..., :-1], out=ahead[..., :-1])
    np.greater(x[..., 0], x[..., -1], out=ahead[..., -1])
    turns = np.count_nonzero(ahead[..., 1:] != ahead[..., :-1], axis=-1)
    once: Mask = turns + (ahead[..., 0] != ahead[..., -1]) <= 2
    return once


def graphs(points: Array) -> Mask:
    """Tell which contours (k, n, 2) are proved sound by comparing their sides as graphs.

    The axis is the first of `ANGLES` along which a contour goes back and forth only once.
    """
    sound = np.zeros(len(points), dtype=bool)
    open_ = np.arange(len(points))
    for angle in ANGLES:
        c, s = np.cos(angle), np.sin(angle)
        turned = points[open_] @ np.array([[c, -s], [s, c]])
        once = once_back_and_forth(turned[..., 0])
        sound[open_[once]] = _above(turned[once])
        open_ = open_[~once]
        if not open_.size:
            break
    return sound


def _above(points: Array) -> Mask:
    """Tell where the side that goes back lies above the side that goes forth, (k, n, 2).

    The contours start at their largest x once rolled, so one side comes after the other; all
    are put side by side on one axis, so that they are compared by one interpolation.
    """
    k, n, _ = points.shape
    if not k:
        return np.zeros(0, dtype=bool)
    x = points[..., 0]
    start = (np.argmax(x, axis=1)[:, None] + np.arange(n + 1)) % n
    loop = np.take_along_axis(points, start[..., None], axis=1)
    x, y = np.moveaxis(loop, -1, 0)
    turn = np.argmin(x, axis=1)[:, None]
    low, high = x.min(axis=1, keepdims=True), x.max(axis=1, keepdims=True)
    shifted = (x - low) / (high - low) + 2.0 * np.arange(k)[:, None]
    place = np.arange(n + 1)
    back, forth = place <= turn, place >= turn
    # np.interp wants rising x: the way back is read from its end
    over = np.interp(shifted[forth], shifted[:, ::-1][back[:, ::-1]], y[:, ::-1][back[:, ::-1]])
    under = np.interp(shifted[back], shifted[forth], y[forth])
    gap = np.full((2, k, n + 1), np.inf)
    gap[0][forth], gap[1][back] = over - y[forth], y[back] - under
    ends = (place == 0) | (place == n) | (place == turn)
    gap[:, ends] = np.inf
    above: Mask = gap.min(axis=(0, 2)) >= APART
    return above
