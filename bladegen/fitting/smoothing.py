"""Distributions over span without the noise of what they were measured on.

Penalised cubic splines; the weight of the penalty is that of least generalised cross-validation
(Craven and Wahba, Numer. Math. 31 (1979)), so that what does not scatter is not smoothed.
"""

from dataclasses import replace

import numpy as np

from bladegen.fitting.measuring import Sections
from bladegen.support.arrays import Array

__all__ = ["smoothed", "steady_twist", "with_twist"]

CLEAR, VAGUE = 0.45, 0.6  # of the chord: thicker sections have no leading edge to speak of
THICK = 0.35  # of the chord: sections from this on are smoothed together


def smoothed(x: Array, y: Array, weight: Array | None = None) -> Array:
    """Return values y (k,) at places x (k,) without their scatter.

    Parameters
    ----------
    x, y : (k,) arrays
        Places, increasing, and values.
    weight : (k,) array, optional
        Inverse variances, up to a factor.
    """
    from scipy.interpolate import make_smoothing_spline

    if len(x) < 5 or not np.ptp(y) > 0.0:
        return y
    span, size = float(np.ptp(x)), float(np.ptp(y))
    spline = make_smoothing_spline((x - x[0]) / span, (y - y[0]) / size, weight)
    result: Array = y[0] + size * spline((x - x[0]) / span)
    return result


def steady_twist(sections: Sections) -> Array:
    """Return the twist (k,) of chord lines that turn steadily where sections are thick.

    Nearly round sections have many points that are nearly as far from the trailing edge, so that
    the direction of their chord line scatters.
    """
    share = np.clip((sections.thickness - CLEAR) / (VAGUE - CLEAR), 0.0, 1.0)
    share = share * share * (3.0 - 2.0 * share)
    if not share.any():
        return sections.twist
    thick = sections.thickness > THICK
    wanted = sections.twist.copy()
    wanted[thick] = smoothed(sections.eta[thick], sections.twist[thick])
    twist: Array = sections.twist + share * (wanted - sections.twist)
    return twist


def with_twist(sections: Sections, twist: Array) -> Sections:
    """Return the same sections with another twist (k,) [rad].

    What is taken from the twist is given to the airfoil, turned about its trailing edge, so that
    no point of a section moves; the axis does, to the new chord line.
    """
    turn = twist - sections.twist
    # the edge from the axis: along the old chord line, and normal to it
    behind = sections.chord - sections.offset
    c, s = np.cos(turn), np.sin(turn)
    along, normal = behind * c, -behind * s
    # the new chord line goes through the edge and meets y = 0, a line normal to the axis' y
    slope = np.tan(twist)
    offset = sections.chord - (along - normal * slope)
    shift = normal / np.cos(twist)
    away = sections.airfoils - [1.0, 0.0]
    x = away[..., 0] * c[:, None] + away[..., 1] * s[:, None] + 1.0
    y = away[..., 1] * c[:, None] - away[..., 0] * s[:, None]
    return replace(
        sections,
        twist=twist,
        offset=offset,
        prebend=sections.prebend + shift,
        shift=sections.shift + shift,
        airfoils=np.stack([x, y], axis=-1),
    )
