"""Proofs that a contour does not cross itself, for many contours at once.

A contour runs trailing edge -> suction side -> leading edge -> pressure side, and is closed
over the trailing edge.  Both tests below are certain where they say so, and leave the others
open.  They cost a few operations a landmark, while an exact test costs many.

Seen along some axis, a closed contour that goes back and forth only once is two graphs, and
winds about any point 1, 0 or -1 times.  `ladders` adds that the strip between opposite
landmarks is covered by triangles that all turn the same way: then no point is wound about
-1 times, and the graphs do not cross.  `graphs` compares the two graphs themselves.
"""

import numpy as np

from bladegen.support.arrays import Array, Mask

__all__ = ["FLAT", "graphs", "ladders", "once_back_and_forth", "turning_twice"]

APART = 1e-9  # chord; sides closer than this are left to the exact test
FLAT = -1e-14  # chord^2; closed edges make triangles of no area, to rounding
ANGLES = np.linspace(0.0, np.pi, 8, endpoint=False)


def ladders(points: Array) -> Mask:
    """Tell which contours (..., n, 2) are proved sound by triangles between their sides."""
    middle = points.shape[-2] // 2
    x, y = points[..., 0], points[..., 1]
    xs = x[..., : middle + 1], x[..., : -middle - 2 : -1]
    ys = y[..., : middle + 1], y[..., : -middle - 2 : -1]
    across, up = xs[0] - xs[1], ys[0] - ys[1]  # from the pressure to the suction side
    turned = np.ones(x.shape[:-1], dtype=bool)
    for along, rise, at in ((xs[1], ys[1], slice(None, -1)), (xs[0], ys[0], slice(1, None))):
        area = across[..., at] * np.diff(rise) - up[..., at] * np.diff(along)
        turned &= area.min(axis=-1) >= FLAT
    return turned & once_back_and_forth(x)


def once_back_and_forth(x: Array) -> Mask:
    """Tell which closed contours go back and forth only once in x (..., n)."""
    ahead = np.empty(x.shape, dtype=bool)
    np.greater(x[..., 1:], x[..., :-1], out=ahead[..., :-1])
    np.greater(x[..., 0], x[..., -1], out=ahead[..., -1])
    return turning_twice(ahead)


def turning_twice(ahead: Mask) -> Mask:
    """Tell which closed contours change direction at most twice, given each step's (..., n)."""
    turns = np.count_nonzero(ahead[..., 1:] != ahead[..., :-1], axis=-1)
    once: Mask = turns + (ahead[..., 0] != ahead[..., -1]) <= 2
    return once


def graphs(points: Array) -> tuple[Mask, Mask]:
    """Tell which contours (k, n, 2) are proved sound, and which to cross, as pairs of graphs.

    The axis is the first of `ANGLES` along which a contour goes back and forth only once.  Two
    graphs of which each lies above the other somewhere cross.
    """
    sound, crossing = np.zeros((2, len(points)), dtype=bool)
    open_ = np.arange(len(points))
    for angle in ANGLES:
        c, s = np.cos(angle), np.sin(angle)
        turned = points[open_] @ np.array([[c, -s], [s, c]])
        once = once_back_and_forth(turned[..., 0])
        least, most = _gaps(turned[once])
        sound[open_[once]] = least >= APART
        crossing[open_[once]] = (least <= -APART) & (most >= APART)
        open_ = open_[~once]
        if not open_.size:
            break
    return sound, crossing


def _gaps(points: Array) -> tuple[Array, Array]:
    """Return how high the side that goes back lies above the side that goes forth (k, n, 2).

    The least and the largest height at a landmark of either, but for the ends that they share.

    The contours start at their largest x once rolled, so one side comes after the other; all
    are put side by side on one axis, so that they are compared by one interpolation.
    """
    k, n, _ = points.shape
    if not k:
        return np.zeros(0), np.zeros(0)
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
    gap = np.full((2, k, n + 1), np.nan)
    gap[0][forth], gap[1][back] = over - y[forth], y[back] - under
    ends = (place == 0) | (place == n) | (place == turn)
    gap[:, ends] = np.nan
    return np.nanmin(gap, axis=(0, 2)), np.nanmax(gap, axis=(0, 2))
