"""Where one looks from: named views of a blade, all but one with the root at the left.

A view is a direction towards the eye and one that points up, both in the blade frame.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["ANGLE", "VIEWS", "View", "camera"]

ANGLE = 30.0  # degrees from the lower to the upper edge of a view, VTK's own
FILLED = 0.92  # of a view's width or height
CENTRINGS = 12  # centring changes the distance, and the other way round


@dataclass(frozen=True)
class View:
    """Towards the eye, up, and whether lines of sight are parallel."""

    towards: tuple[float, float, float]
    up: tuple[float, float, float]
    parallel: bool = True


VIEWS = {
    "oblique": View((0.8, 0.34, -0.5), (0.35, -1.0, 0.0), parallel=False),
    "suction side": View((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)),
    "pressure side": View((-1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    "trailing edge": View((0.0, 1.0, 0.0), (1.0, 0.0, 0.0)),
    "leading edge": View((0.0, -1.0, 0.0), (-1.0, 0.0, 0.0)),
    "tip": View((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)),
}


def camera(points: Array, view: View, aspect: float) -> tuple[Array, Array, Array]:
    """Return eye, focus and up: as near as all points can be seen.

    Parameters
    ----------
    points : (m, 3) array
        What shall be seen [m].
    view : View
        Where from.
    aspect : float
        Width of the picture over its height.

    Returns
    -------
    eye, focus, up : (3,) arrays
        With parallel lines of sight, the half height of the picture is the distance of eye and
        focus times tan(`ANGLE` / 2).
    """
    towards, up = np.array(view.towards), np.array(view.up)
    towards = towards / np.linalg.norm(towards)
    right = np.cross(up, towards)
    right = right / np.linalg.norm(right)
    axes = np.stack([right, np.cross(towards, right), towards], axis=1)
    reach = np.tan(np.radians(ANGLE / 2.0)) * FILLED * np.array([aspect, 1.0])
    if view.parallel:
        low, high = (points @ axes).min(axis=0), (points @ axes).max(axis=0)
        focus = axes @ (0.5 * (low + high))
        distance = float(np.max(0.5 * (high - low)[:2] / reach))
        return focus + distance * towards, focus, up
    focus, distance = points.mean(axis=0), 0.0
    for _ in range(CENTRINGS):
        seen = (points - focus) @ axes
        distance = float(np.max(seen[:, 2:] + np.abs(seen[:, :2]) / reach))
        angles = seen[:, :2] / (distance - seen[:, 2:])
        focus = focus + axes[:, :2] @ (0.5 * distance * (angles.max(axis=0) + angles.min(axis=0)))
    return focus + distance * towards, focus, up
