"""Sections in space as the elements of a rotor: radius, chord, twist, cone, and their outlines.

Rotor frame: X along the axis, downwind, R from the axis.  The cone leans blades upwind.  An
element stands where its quarter chord is; its plane's normal is the direction of the span there,
so that the cone at an element is the rotor's and the slope of the prebend.  Sweep is no part of it.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.blade.aero.kulfan import in_chords
from bladegen.curves.sides import sides
from bladegen.support.arrays import Array

__all__ = ["Elements", "elements_of"]

ENOUGH = 100  # landmarks a side: NeuralFoil takes nine numbers of one
QUARTER = 0.25  # of the chord, about which polars are
LINES = np.linspace(0.0, 1.0, 101)  # of the chord, where thickness is measured


@dataclass(frozen=True, eq=False)
class Elements:
    """Elements of rotors, root to tip.

    Parameters
    ----------
    axial, radius : (b, k) arrays
        Where they are, downwind and from the rotor's axis [m]; the first is the root, the last
        the tip.
    chord, twist : (b, k) arrays
        Of the line from nose to trailing edge [m], [rad]; positive twist moves the nose upwind.
    cone : (b, k) array
        How far the span leans upwind there [rad].
    outlines : (b, k, m, 2) array
        The sections in chords by some of their landmarks, nose in the origin, suction side
        above and first.
    thickness : (b, k) array
        Over chord.
    """

    axial: Array
    radius: Array
    chord: Array
    twist: Array
    cone: Array
    outlines: Array
    thickness: Array

    @property
    def tip_radius(self) -> Array:
        """Of the rotors, (b,) [m]."""
        return self.radius[:, -1]


def elements_of(sections: Array, hub_radius: float, cone: float) -> Elements:
    """Return the elements that sections are.

    Parameters
    ----------
    sections : (b, k, n, 3) array
        Plane sections [m], blade frame, root to tip, suction side first (no mirror images).
    hub_radius : float
        From the rotor's axis to the blade's root [m].
    cone : float
        [rad]; positive leans the tips upwind.
    """
    shape, some = sections.shape[:2], _some(sections.shape[2])
    points = np.asarray(sections[:, :, some], dtype=np.float64)
    points = points.reshape(-1, *points.shape[2:])
    normal = _normals(points)
    flat = _turned(points, normal)
    local, chord = in_chords(flat)
    outlines = np.stack([local.real, local.imag], axis=-1)
    upper, lower = sides(outlines, LINES)
    nose = points[:, points.shape[1] // 2]
    quarter = nose + QUARTER * (0.5 * (points[:, 0] + points[:, -1]) - nose)
    out = quarter[:, 2] + hub_radius
    c, s = np.cos(cone), np.sin(cone)
    return Elements(
        *(
            part.reshape(*shape, *part.shape[1:])
            for part in (
                quarter[:, 0] * c - out * s,
                quarter[:, 0] * s + out * c,
                np.abs(chord),
                np.angle(chord),
                cone + np.arctan2(-normal[:, 0], normal[:, 2]),
                outlines,
                (upper - lower).max(axis=1),
            )
        )
    )


def _some(landmarks: int) -> slice:
    """Return landmarks that are enough, the nose and both ends among them."""
    half = landmarks // 2
    steps = [step for step in range(1, max(1, half // ENOUGH) + 1) if half % step == 0]
    return slice(None, None, steps[-1])


def _normals(points: Array) -> Array:
    """Return unit normals (b, 3) of plane sections, toward the tip."""
    around = points - points[:, :1]
    following = np.roll(around, -1, axis=1)
    turned = [(1, 2), (2, 0), (0, 1)]
    parts = [
        around[..., i] * following[..., j] - around[..., j] * following[..., i] for i, j in turned
    ]
    area = np.stack([part.sum(axis=1) for part in parts], axis=-1)
    normal: Array = area * np.where(area[:, 2:] < 0.0, -1.0, 1.0)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return normal


def _turned(points: Array, normal: Array) -> Array:
    """Return sections (b, n, 2) in their planes, y and x of a frame turned from z the short way."""
    away = points - points[:, points.shape[1] // 2, None]
    nx, ny, nz = normal[:, None].transpose(2, 0, 1)
    # the rotation from the normal to z about their common perpendicular, without its z
    along = (nx * away[..., 0] + ny * away[..., 1]) / (1.0 + nz) + away[..., 2]
    return np.stack([away[..., 1] - ny * along, away[..., 0] - nx * along], axis=-1)
