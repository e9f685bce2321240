"""Where one looks from: named views of a blade, all but one with the root at the left.

A view is a direction towards the eye and one that points up, both in the blade frame.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["ANGLE", "VIEWS", "View", "camera", "perspective"]

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
    axes, up = _axes(view), np.array(view.up)
    towards = axes[:, 2]
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


def perspective(
    points: Array, view: View, aspect: float
) -> Callable[[Array, Array], tuple[Array, Array]]:
    """Return what brings points (m, 3) and normals there to how they are seen by `camera`.

    What is seen in parallel along -z then looks as the blade does through that camera: x in
    [-aspect, aspect], y and z in [-1, 1] for all of `points`; planes stay planes.
    """
    eye, _, _ = camera(points, view, aspect)
    axes = _axes(view)
    depth = (eye - points) @ axes[:, 2]
    near, far = float(depth.min()), float(depth.max())
    scale = 1.0 / np.tan(np.radians(ANGLE / 2.0))

    def seen(at: Array, normals: Array) -> tuple[Array, Array]:
        there = (at - eye) @ axes
        away = -there[:, 2]
        z = ((near + far) - 2.0 * near * far / away) / (near - far)
        return np.concatenate([scale * there[:, :2] / away[:, None], z[:, None]], axis=1), (
            normals @ axes
        )

    return seen


def _axes(view: View) -> Array:
    """Return what points right, up and towards the eye, as columns."""
    towards = np.array(view.towards) / np.linalg.norm(view.towards)
    right = np.cross(view.up, towards)
    right = right / np.linalg.norm(right)
    return np.stack([right, np.cross(towards, right), towards], axis=1)
