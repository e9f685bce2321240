"""Integrals of sections and of the blade: area, first moments, volume.

All are exact for the sections' cubic splines (Gauss-Legendre on each cell, closed over the
trailing edge by a straight line), by Green's theorem.
"""

import numpy as np

from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.blade import Blade
from bladegen.support.arrays import Array

__all__ = ["area_moments", "volume"]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(5)  # exact to degree 9; x^2 dy has 8
FRAME_STEP = 1e-6  # of span, for the turning of section planes


def area_moments(u: Array, points: Array) -> tuple[Array, Array]:
    """Return areas and first moments of plane sections.

    Parameters
    ----------
    u : (n,) array
        Landmark parameters.
    points : (k, n, 2) array
        Landmarks, counter-clockwise.

    Returns
    -------
    area : (k,) array
    moments : (k, 2) array
        The integrals of x and of y over the section.
    """
    splines = SectionSplines(u)
    half = 0.5 * np.diff(u)
    nodes = (u[:-1] + half)[:, None] + half[:, None] * _NODES
    weights = (half[:, None] * _WEIGHTS).reshape(-1)
    at = splines.values(nodes.reshape(-1)).mT
    along = splines.values(nodes.reshape(-1), 1).mT * weights
    x, y = points[..., 0] @ at, points[..., 1] @ at  # one product for all sections, not one each
    dx, dy = points[..., 0] @ along, points[..., 1] @ along
    area = np.sum(x * dy - y * dx, axis=1) / 2.0
    moment_x = np.sum(x * x * dy, axis=1) / 2.0
    moment_y = -np.sum(y * y * dx, axis=1) / 2.0
    (x0, y0), (x1, y1) = points[:, 0].T, points[:, -1].T  # the closing line runs 1 -> 0
    area += (x1 * y0 - x0 * y1) / 2.0
    moment_x += (x0 * x0 + x0 * x1 + x1 * x1) * (y0 - y1) / 6.0
    moment_y -= (y0 * y0 + y0 * y1 + y1 * y1) * (x0 - x1) / 6.0
    return area, np.stack([moment_x, moment_y], axis=-1)


def volume(blade: Blade) -> float:
    """Return the blade's volume [m3], the integral of its sections along the axis.

    Notes
    -----
    A plane section sweeps its area times the velocity of its plane, which is that of the axis
    plus that of the plane's turning at each point: with the axis r, the plane's unit vectors
    e1, e2 and normal n, and the section's area A and moments S about the axis,
    dV/d eta = A r'.n + S1 e1'.n + S2 e2'.n.  Gauss-Legendre between the knots of all
    distributions, where everything is smooth.
    """
    if blade.mirrored:
        return volume(blade.mirror_image())
    definition = blade.definition
    grids = [
        quantity.grid
        for quantity in (
            definition.chord,
            definition.twist,
            definition.axis.x,
            definition.axis.y,
            definition.axis.z,
            definition.section_offset_y,
            definition.section_offset_x,
            definition.pitch_axis,
            definition.relative_thickness,
        )
        if quantity is not None
    ]
    ends = [0.0, blade.planform.frames.root, 1.0]
    knots = np.unique(np.concatenate([*grids, blade.eta, ends]))
    half = 0.5 * np.diff(knots)
    eta = ((knots[:-1] + half)[:, None] + half[:, None] * _NODES).reshape(-1)
    weights = (half[:, None] * _WEIGHTS).reshape(-1)

    frames = blade.planform.frames(eta)
    local = (blade.sections(eta) - blade.axis(eta)[:, None]) @ frames[:, :2].mT
    area, moments = area_moments(blade.u, local[..., ::-1])
    normal = frames[:, 2]
    before, after = np.maximum(eta - FRAME_STEP, 0.0), np.minimum(eta + FRAME_STEP, 1.0)
    turning = blade.planform.frames(after) - blade.planform.frames(before)
    turning /= (after - before)[:, None, None]
    velocity = np.sum(blade.definition.axis(eta, 1) * normal, axis=1)
    tilt = turning[:, 1::-1] @ normal[..., None]
    swept = area * velocity + np.sum(moments * tilt[..., 0], axis=1)
    return float(np.sum(swept * weights))
