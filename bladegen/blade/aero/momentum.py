"""Blade-element momentum theory, compiled: the load on each element of rotors in steady wind.

One equation in the inflow angle phi for each element, whose root is bracketed whatever the state
of the wake: S. A. Ning, A simple solution method for the blade element momentum equations with
guaranteed convergence, Wind Energy 17 (2014), doi:10.1002/we.1636.  Losses at tip and root after
Prandtl; from an induction of 0.4 on the empirical curve of M. L. Buhl, NREL/TP-500-36834, 2005.
The root is found after T. R. Chandrupatla, Advances in Engineering Software 28 (1997).

Angles in radians; velocities are over the wind speed, forces per length over 1/2 rho U^2.
"""

from math import acos, cos, exp, floor, hypot, pi, sin, sqrt

from bladegen.support.arrays import Array
from bladegen.support.compiled import compiled

__all__ = ["loads"]

LEAST = 1e-6  # rad; the equation has no value where the wind comes in the rotor's plane
TOLERANCE = 1e-10  # rad, of the inflow angle
STEPS = 100  # bisection alone would need fifty
TOUCHING = 1e-9  # of the tip's radius: elements so near to an end bear no load
MOMENTUM = 2.0 / 3.0  # kappa, up to which momentum theory holds


@compiled
def _read(row: Array, alpha: float) -> float:
    """Return a coefficient (m,) on even angles from -pi to pi, both ends there, at any angle."""
    cells = len(row) - 1
    place = (alpha / (2.0 * pi) + 0.5) * cells
    place -= cells * floor(place / cells)
    cell = min(int(place), cells - 1)
    read: float = row[cell] + (place - cell) * (row[cell + 1] - row[cell])
    return read


@compiled
def _element(
    phi: float,
    angle: float,
    solidity: float,
    wind: float,
    turning: float,
    tip: float,
    hub: float,
    cl: Array,
    cd: Array,
) -> tuple[float, float, float, float, float]:
    """Return what is left of the equation at an angle, both inductions, and both coefficients.

    The coefficients are those of forces normal to and in the plane of rotation.
    """
    s, c = sin(phi), cos(phi)
    lift, drag = _read(cl, phi - angle), _read(cd, phi - angle)
    normal, tangential = lift * c + drag * s, lift * s - drag * c
    loss = 4.0 / pi**2 * acos(exp(-tip / abs(s))) * acos(exp(-hub / abs(s)))
    kappa = solidity * normal / (4.0 * loss * s * s)
    swirl = solidity * tangential / (4.0 * loss * s * c)
    if phi < 0.0:  # the propeller's brake
        axial = kappa / (kappa - 1.0) if kappa > 1.0 else 0.0
        left = s * (1.0 - kappa) - wind / turning * c * (1.0 - swirl)
    else:
        if kappa <= MOMENTUM:
            axial = kappa / (1.0 + kappa)
        else:
            one = 2.0 * loss * kappa - (10.0 / 9.0 - loss)
            two = 2.0 * loss * kappa - loss * (4.0 / 3.0 - loss)
            three = 2.0 * loss * kappa - (25.0 / 9.0 - 2.0 * loss)
            pole = abs(three) < 1e-6
            axial = 1.0 - 0.5 / sqrt(two) if pole else (one - sqrt(two)) / three
        left = s / (1.0 - axial) - wind / turning * c * (1.0 - swirl)
    return left, axial, swirl / (1.0 - swirl), normal, tangential


@compiled
def _inflow(
    angle: float,
    solidity: float,
    wind: float,
    turning: float,
    tip: float,
    hub: float,
    cl: Array,
    cd: Array,
) -> float:
    """Return the inflow angle of an element."""
    given = (angle, solidity, wind, turning, tip, hub, cl, cd)
    a, b = LEAST, 0.5 * pi
    fa, fb = _element(a, *given)[0], _element(b, *given)[0]
    if fa * fb > 0.0:
        a, b = -0.25 * pi, -LEAST
        fa, fb = _element(a, *given)[0], _element(b, *given)[0]
        if not (fa < 0.0 < fb):
            a, b = 0.5 * pi + LEAST, pi - LEAST
            fa, fb = _element(a, *given)[0], _element(b, *given)[0]
    share, best = 0.5, a
    c, fc = a, fa
    for _ in range(STEPS):
        at = a + share * (b - a)
        f = _element(at, *given)[0]
        if (f > 0.0) == (fa > 0.0):
            c, fc = a, fa
        else:
            c, fc, b, fb = b, fb, a, fa
        a, fa = at, f
        best = a if abs(fa) < abs(fb) else b
        least = 0.5 * TOLERANCE / max(abs(b - a), 1e-300)
        if least > 0.5 or fa == 0.0:
            break
        xi, ratio = (a - b) / (c - b), (fa - fb) / (fc - fb)
        share = 0.5
        if ratio * ratio < xi and (1.0 - ratio) * (1.0 - ratio) < 1.0 - xi:
            share = fa / (fb - fa) * fc / (fb - fc)
            share += (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        share = min(max(share, least), 1.0 - least)
    return best


@compiled
def loads(
    radius: Array,
    chord: Array,
    twist: Array,
    cone: Array,
    blades: int,
    speed_ratio: Array,
    pitch: Array,
    cl: Array,
    cd: Array,
    found: Array,
) -> None:
    """Solve for the loads on all elements of rotors.

    Parameters
    ----------
    radius, chord, twist, cone : (b, k) arrays
        Elements from the root to the tip; at these two there is no load.
    blades : int
        Of a rotor.
    speed_ratio, pitch : (b, c) arrays
        Of the tip to the wind, and the blades' pitch [rad] toward feather.
    cl, cd : (b, k, m) arrays
        Coefficients at even angles from -pi to pi.
    found : (b, c, k, 4) array
        Filled with forces per length normal to the span, downwind, and in the direction of
        rotation, over 1/2 rho U^2 [m], with the axial induction and the inflow angle.
    """
    for b in range(radius.shape[0]):
        root, end = radius[b, 0], radius[b, -1]
        for k in range(radius.shape[1]):
            r = radius[b, k]
            if min(r - root, end - r) < TOUCHING * end:
                found[b, :, k] = 0.0
                continue
            solidity = blades * chord[b, k] / (2.0 * pi * r)
            tip, hub = 0.5 * blades * (end - r) / r, 0.5 * blades * (r - root) / root
            wind = cos(cone[b, k])
            for case in range(speed_ratio.shape[1]):
                turning = speed_ratio[b, case] * r / end
                angle = twist[b, k] + pitch[b, case]
                given = (angle, solidity, wind, turning, tip, hub, cl[b, k], cd[b, k])
                phi = _inflow(*given)
                _, axial, swirl, normal, tangential = _element(phi, *given)
                speed = hypot(wind * (1.0 - axial), turning * (1.0 + swirl))
                found[b, case, k, 0] = chord[b, k] * speed * speed * normal
                found[b, case, k, 1] = chord[b, k] * speed * speed * tangential
                found[b, case, k, 2] = axial
                found[b, case, k, 3] = phi
