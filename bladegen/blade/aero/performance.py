"""Power, thrust and root bending moment of rotors over tip speed ratio and pitch.

Coefficients are over 1/2 rho U^2 and the disc pi R^2, that of the moment over R besides; steady
uniform wind along the axis, rigid blades.  The bending moment is that of one blade at its root,
out of the plane of rotation.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bladegen.blade.aero.elements import Elements
from bladegen.support.arrays import Array

__all__ = [
    "PITCHES",
    "RATIOS",
    "Performance",
    "angles_of_attack",
    "coefficients",
    "performance",
]

RATIOS = np.linspace(3.0, 14.0, 23)
PITCHES = np.radians(np.linspace(-5.0, 7.0, 13))
FINER, NEAR = np.linspace(-1.5, 1.5, 9), np.array([-1, 0, 1])
SIZES = (1.0, 0.25)  # of finer grids, in steps of the first


@dataclass(frozen=True, eq=False)
class Performance:
    """What rotors do at their best pitch.

    Parameters
    ----------
    ratios : (c,) array
        Tip speed ratios.
    power, thrust, moment : (b, c) arrays
        Coefficients at the optimum pitch.
    pitch : (b,) array
        The optimum pitch [rad], toward feather: with it and `ratio` power is largest.
    ratio : (b,) array
        The optimum tip speed ratio.
    best : (b, 3) array
        Power, thrust and moment coefficients there.
    """

    ratios: Array
    power: Array
    thrust: Array
    moment: Array
    pitch: Array
    ratio: Array
    best: Array


def coefficients(
    elements: Elements, polars: tuple[Array, Array], blades: int, ratios: Array, pitch: Array
) -> Array:
    """Return power, thrust and moment coefficients (b, c, 3).

    Parameters
    ----------
    elements : Elements
        Of rotors (b, k).
    polars : two (b, k, m) arrays
        Lift and drag at even angles from -pi to pi.
    blades : int
        Of a rotor.
    ratios, pitch : (b, c) arrays
        Tip speed ratios, and pitch [rad].
    """
    radius, end = elements.radius, elements.tip_radius[:, None]
    cases = np.broadcast_arrays(ratios, pitch)
    found = _solved(elements, polars, blades, *cases)
    normal, tangential = found[..., 0], found[..., 1]
    weights = 0.5 * (
        np.diff(radius, axis=1, append=end) + np.diff(radius, axis=1, prepend=radius[:, :1])
    )
    along = weights / np.cos(elements.cone)
    torque = np.einsum("bck,bk->bc", tangential, along * radius)
    thrust = np.einsum("bck,bk->bc", normal, weights)
    lever = (radius - radius[:, :1]) * np.cos(elements.cone)
    lever -= (elements.axial - elements.axial[:, :1]) * np.sin(elements.cone)
    moment = np.einsum("bck,bk->bc", normal, along * lever)
    disc = np.pi * end**2
    power = blades * torque * cases[0] / (disc * end)
    return np.stack([power, blades * thrust / disc, moment / (disc * end)], axis=-1)


def angles_of_attack(
    elements: Elements, polars: tuple[Array, Array], blades: int, ratios: Array, pitch: Array
) -> Array:
    """Return angles of attack (b, c, k) from the chord lines [rad]; NaN at root and tip.

    Parameters are those of `coefficients`.
    """
    cases = np.broadcast_arrays(ratios, pitch)
    inflow = _solved(elements, polars, blades, *cases)[..., 3]
    found: Array = inflow - elements.twist[:, None] - cases[1][..., None]
    found[..., [0, -1]] = np.nan
    return found


def _solved(
    elements: Elements, polars: tuple[Array, Array], blades: int, ratios: Array, pitch: Array
) -> Array:
    """Return what `momentum.loads` finds, (b, c, k, 4)."""
    from bladegen.blade.aero.momentum import loads

    radius = elements.radius
    given = (radius, elements.chord, elements.twist, elements.cone, ratios, pitch, *polars)
    found: Array = np.empty((*ratios.shape, radius.shape[1], 4))
    even = [np.ascontiguousarray(part, dtype=np.float64) for part in given]
    loads(*even[:4], blades, *even[4:], found)
    return found


def performance(
    elements: Elements,
    polars: tuple[Array, Array],
    blades: int,
    *,
    ratios: Array = RATIOS,
    pitches: Array = PITCHES,
) -> Performance:
    """Return what rotors do, at the pitch and the tip speed ratio of the largest power.

    The optimum is looked for on finer grids around the largest of that of `ratios` and `pitches`;
    coefficients are computed there.
    """
    count = len(elements.radius)
    grid = [part.ravel() for part in np.meshgrid(ratios, pitches, indexing="ij")]
    cases = (np.broadcast_to(part, (count, part.size)) for part in grid)
    power = coefficients(elements, polars, blades, *cases)[..., 0]
    power = power.reshape(count, len(ratios), len(pitches))
    row, column = np.unravel_index(power.reshape(count, -1).argmax(axis=1), power.shape[1:])
    start = np.stack([ratios[row], pitches[column]], axis=-1)
    ends = np.array([[ratios[0], pitches[0]], [ratios[-1], pitches[-1]]])
    ratio, pitch = _highest(
        lambda at: coefficients(elements, polars, blades, at[..., 0], at[..., 1])[..., 0],
        start,
        np.array([ratios[1] - ratios[0], pitches[1] - pitches[0]]),
        ends,
    ).T
    own = np.broadcast_to(ratios, (count, len(ratios)))
    all_ratios = np.concatenate([own, ratio[:, None]], axis=1)
    found = coefficients(elements, polars, blades, all_ratios, pitch[:, None])
    power, thrust, moment = found[:, :-1].transpose(2, 0, 1)
    return Performance(ratios, power, thrust, moment, pitch, ratio, found[:, -1])


def _highest(value: Callable[[Array], Array], start: Array, step: Array, ends: Array) -> Array:
    """Return where functions of two variables are highest, (b, 2), near places (b, 2) of a grid.

    Finer grids around the best place so far, and at last the vertex of the paraboloid through its
    eight neighbours, by least squares: the ridge of power runs across the axes, so that two
    parabolas along them miss its top by steps of the grid.
    """
    points = np.stack(np.meshgrid(FINER, FINER, indexing="ij"), axis=-1).reshape(-1, 2)
    at, m, rows = start, len(FINER), np.arange(len(start))
    for size in SIZES:
        tried = np.clip(at[:, None] + size * step * points, *ends)
        around = value(tried)
        best = around.argmax(axis=1)
        at = tried[rows, best]
    row, column = (np.clip(part, 1, m - 2) for part in np.divmod(best, m))
    near = np.add.outer(m * NEAR, NEAR).ravel() + (m * row + column)[:, None]
    s, t = (part.ravel() for part in np.meshgrid(NEAR, NEAR, indexing="ij"))
    nine = np.take_along_axis(around, near, axis=1)
    b, c, d = nine @ s / 6.0, nine @ t / 6.0, nine @ (s * t) / 4.0
    e, f = nine @ (3.0 * s**2 - 2.0) / 3.0, nine @ (3.0 * t**2 - 2.0) / 3.0
    bend = e * f - d * d
    hill = (bend > 0.0) & (e < 0.0)
    off = np.stack([d * c - f * b, d * b - e * c], axis=-1) / np.where(hill, bend, 1.0)[:, None]
    vertex = tried[rows, m * row + column] + size * step * (FINER[1] - FINER[0]) * off
    there = hill & (np.abs(off).max(axis=-1) <= 1.5)
    return np.where(there[:, None], np.clip(vertex, *ends), at)
