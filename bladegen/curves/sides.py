"""Heights of the two sides of closed sections at places along the chord."""

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["sides"]


def sides(profiles: Array, x: Array) -> tuple[Array, Array]:
    """Return heights of the suction and the pressure side (k, m) at places x (m,) of the chord.

    The chord line runs from the landmark farthest from the trailing-edge midpoint to that
    midpoint; all sections are put side by side on one axis and read off at once.
    """
    k, n, _ = profiles.shape
    edge = 0.5 * (profiles[:, 0] + profiles[:, -1])
    nose_at = np.argmax(np.linalg.norm(profiles - edge[:, None], axis=-1), axis=1)
    nose = profiles[np.arange(k), nose_at]
    along = edge - nose
    length = np.linalg.norm(along, axis=-1)
    along /= length[:, None]
    axes = np.stack([along, np.stack([-along[:, 1], along[:, 0]], axis=-1)], axis=-1)
    local = (profiles - nose[:, None]) @ axes / length[:, None, None]
    heights = []
    shift = 4.0 * np.arange(k)[:, None]
    for rows in (slice(n // 2, None, -1), slice(n // 2, None)):
        side = local[:, rows]
        front = np.maximum.accumulate(side[..., 0], axis=1)
        flat = np.interp((x + shift).reshape(-1), (front + shift).reshape(-1), side[..., 1].ravel())
        heights.append(flat.reshape(k, len(x)))
    return heights[0], heights[1]
