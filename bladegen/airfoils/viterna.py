"""Polars beyond stall, to -180 and 180 degrees: Viterna's equations, and a flat plate's moment.

With the drag at 90 degrees D = 1.11 + 0.018 A for an aspect ratio A (at most 50) and the
coefficients CLs, CDs at stall, as, between stall and 90 degrees

    CD = D sin^2 a + B cos a            B = (CDs - D sin^2 as) / cos as
    CL = D/2 sin 2a + C cos^2 a / sin a C = (CLs - D sin as cos as) sin as / cos^2 as

(L. A. Viterna and R. D. Corrigan, Fixed pitch rotor performance of large horizontal axis wind
turbines, NASA CP-2230, 1982).  From 90 degrees on the flow meets the trailing edge: lift is that
of 180 degrees less the angle, times -0.7, drag the same; both run straight to no lift and to the
smallest drag at 180 degrees (as in NREL's AirfoilPrep).  Negative angles are the mirror image
with a stall of their own.  The moment beyond stall is that of the normal force at the centre of
pressure of a plate, which goes from a quarter to three quarters of the chord; it is joined to
the moment at stall by a difference that fades out to 90 degrees.
"""

from typing import Any

import numpy as np

from bladegen.support.arrays import Array, Indices

__all__ = ["ASPECT_RATIO", "STALL", "around", "extended", "normal_moment", "stalls"]

ASPECT_RATIO = 10.0  # usual for blades; gives the drag 1.29 at 90 degrees
REVERSED = 0.7  # of the lift, where the flow meets the trailing edge
STEP = np.radians(5.0)
STALL = np.radians(3.0)  # stalls nearer to 0 than this are none
QUARTER = 0.25
Coefficients = tuple[Array, Array, Array]


def extended(
    alpha: Array, cl: Array, cd: Array, cm: Array, *, aspect_ratio: float = ASPECT_RATIO
) -> tuple[Array, Array, Array, Array]:
    """Extend a polar from negative to positive stall to all angles.

    Parameters
    ----------
    alpha : (m,) array
        Angles of attack [rad], increasing; the first below 0 and the last above, both within a
        quarter turn: the two stalls.
    cl, cd, cm : (m,) arrays
        Coefficients; the moment about the quarter chord.
    aspect_ratio : float
        Of the blade.

    Returns
    -------
    alpha, cl, cd, cm : (k,) arrays
        From -pi to pi; the given points are among them, and both ends are alike.
    """
    most, least = _plate_drag(aspect_ratio), float(cd.min())
    after = _angles(float(alpha[-1]))
    before = _angles(float(-alpha[0]))
    stalled = _stalled(after, alpha[-1], (cl[-1], cd[-1], cm[-1]), most, least)
    mirrored = _stalled(before, -alpha[0], (-cl[0], cd[0], -cm[0]), most, least)
    parts = zip((-1.0, 1.0, -1.0), mirrored, (cl, cd, cm), stalled, strict=True)
    joined = [np.concatenate([sign * low[::-1], mid, high]) for sign, low, mid, high in parts]
    return np.concatenate([-before[::-1], alpha, after]), joined[0], joined[1], joined[2]


def around(
    grid: Array, alpha: Array, cl: Array, cd: Array, *, aspect_ratio: float = ASPECT_RATIO
) -> tuple[Array, Array]:
    """Return lift and drag (b, k) of many polars at the same angles all around, as `extended`.

    Parameters
    ----------
    grid : (k,) array
        From -pi to pi [rad]; the angles `alpha` are a stretch of it.
    alpha : (m,) array
        Where the polars are known [rad]; what lies between the stalls of each is kept.
    cl, cd : (b, m) arrays
        Coefficients.
    """
    low, high = stalls(alpha, cl)
    at = np.arange(len(alpha))
    between = (at >= low) & (at <= high)
    least = np.where(between, cd, np.inf).min(axis=1, keepdims=True)
    most = _plate_drag(aspect_ratio)
    lift, drag = np.empty((2, len(cl), len(grid)))
    for sign, stall in ((1.0, high), (-1.0, low)):
        beyond = sign * grid >= 0.0
        ends = sign * np.take_along_axis(cl, stall, 1), np.take_along_axis(cd, stall, 1)
        there = sign * grid[beyond], sign * alpha[stall]
        found = _stalled(*there, (*ends, np.zeros_like(ends[0])), most, least)
        lift[:, beyond], drag[:, beyond] = sign * found[0], found[1]
    start = int(np.argmin(np.abs(grid - alpha[0])))
    part = slice(start, start + len(alpha))
    lift[:, part] = np.where(between, cl, lift[:, part])
    drag[:, part] = np.where(between, cd, drag[:, part])
    return lift, drag


def stalls(alpha: Array, cl: Array) -> tuple[Indices, Indices]:
    """Return where polars (..., m) have least and most lift, beyond `STALL`: places (..., 1)."""
    low = np.argmin(np.where(alpha < -STALL, cl, np.inf), axis=-1, keepdims=True)
    high = np.argmax(np.where(alpha > STALL, cl, -np.inf), axis=-1, keepdims=True)
    return low, high


def normal_moment(alpha: Array, cl: Array, cd: Array) -> Array:
    """Return the moment of the normal force about the quarter chord, as on a plate."""
    arm = 0.5 * np.abs(alpha) / np.pi
    moment: Array = -(cl * np.cos(alpha) + cd * np.sin(alpha)) * arm
    return moment


def _plate_drag(aspect_ratio: float) -> float:
    """Return the drag coefficient at 90 degrees."""
    return 1.11 + 0.018 * min(aspect_ratio, 50.0)


def _angles(stall: float) -> Array:
    """Return angles behind stall; a quarter turn, the image of stall, half a turn among them."""
    first = np.linspace(stall, 0.5 * np.pi, int(np.ceil((0.5 * np.pi - stall) / STEP)) + 1)[1:]
    last = np.linspace(np.pi - stall, np.pi, int(np.ceil(stall / STEP)) + 1)[1:]
    return np.concatenate([first, (np.pi - first[:-1])[::-1], [np.pi - stall], last])


def _stalled(
    alpha: Array, stall: Any, at_stall: tuple[Any, Any, Any], most: float, least: Any
) -> Coefficients:
    """Return coefficients at positive angles beyond stall."""
    lift, drag, moment = at_stall
    sine, cosine = np.sin(stall), np.cos(stall)
    b = (drag - most * sine**2) / cosine
    c = (lift - most * sine * cosine) * sine / cosine**2
    near = np.clip(np.minimum(alpha, np.pi - alpha), stall, None)  # the angle to the nearer edge
    cl = 0.5 * most * np.sin(2.0 * near) + c * np.cos(near) ** 2 / np.sin(near)
    cd = np.maximum(most * np.sin(near) ** 2 + b * np.cos(near), least)
    left = np.clip((np.pi - alpha) / stall, 0.0, 1.0)  # 1 up to the last part, 0 at half a turn
    cl = np.where(alpha > 0.5 * np.pi, -REVERSED * left, 1.0) * cl
    cd = least + left * (cd - least)
    fade = np.clip((0.5 * np.pi - alpha) / (0.5 * np.pi - stall), 0.0, 1.0)
    ends = np.atleast_1d(stall), np.atleast_1d(lift), np.atleast_1d(drag)
    return cl, cd, normal_moment(alpha, cl, cd) + fade * (moment - normal_moment(*ends))
