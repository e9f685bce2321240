"""Distributions over span without the noise of what they were measured on.

Penalised cubic splines; the weight of the penalty is that of least generalised cross-validation
(Craven and Wahba, Numer. Math. 31 (1979)), so that what does not scatter is not smoothed.
"""

from dataclasses import replace

import numpy as np

from bladegen.fitting.measuring import Sections
from bladegen.support.arrays import Array

__all__ = ["CLEAR", "smoothed", "steady", "with_twist"]

CLEAR, VAGUE = 0.45, 0.6  # of the chord: thicker sections have no leading edge to speak of
SHARP, BLUNT = 0.004, 0.012  # rad, by which a leading edge may lie elsewhere on its nose
BESIDE = 0.08  # of the span, beyond vague sections, that is smoothed with them


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


def steady(sections: Sections, values: Array, vague: Array) -> Array:
    """Return values (k,) that change steadily over span where chord lines are vague.

    Parameters
    ----------
    sections : Sections
        That the values belong to.
    values : (k,) array
        Such as their twist.
    vague : (k,) array
        By what angle a leading edge may lie elsewhere on its nose [rad]: `noses.vagueness`.

    Notes
    -----
    Nearly round sections and blunt noses have many points that are nearly as far from the trailing
    edge, so that the direction of their chord line scatters.
    """
    share = _share(sections.thickness, CLEAR, VAGUE)
    share = np.maximum(share, _share(vague, SHARP, BLUNT))
    if not share.any():
        return values
    last = sections.eta[share > 0.0].max()
    inner = sections.eta <= last + BESIDE
    wanted = values.copy()
    weight = 1.0 / np.maximum(vague[inner], SHARP) ** 2
    wanted[inner] = smoothed(sections.eta[inner], values[inner], weight)
    return np.asarray(values + share * (wanted - values))


def _share(values: Array, low: float, high: float) -> Array:
    share = np.clip((values - low) / (high - low), 0.0, 1.0)
    smooth: Array = share * share * (3.0 - 2.0 * share)
    return smooth


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
