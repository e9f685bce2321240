"""How smooth a blade's surface is along the span: creases at its stations, dents between them.

The paper's path is made of geodesics that meet at stations with a kink; a spline path has none.
A crease is the angle by which the surface's normal jumps across a station.
"""

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.support.arrays import Array

__all__ = ["creases", "edge_bulges", "edge_widths", "steps"]

STEP = 1e-4  # of span, for one-sided derivatives: off by 1e-8 of a third derivative
SPANS = 400  # spans at which edge widths are compared with the stations'
FINE = 4001  # spans between which sections may step
BLOCK = 400  # of these are made at once
BESIDE = 81  # neighbours to either side whose median a step is held against
LEAST_STEP = 1e-3  # of chord, from span to span: of a blade 20 chords long a slope of 11 degrees
STEEP = 5.0  # times the median beside; published blades have up to 2.3
BULGE = 5e-4  # of chord; smaller excursions of the edge's width are noise of the airfoils


def creases(blade: Blade) -> tuple[Array, Array]:
    """Return the spans of the inner stations and the largest jump of the normal there.

    Returns
    -------
    eta, angle : (s,) arrays
        Span fractions, and angles [rad] between the normals just before and just after.

    Notes
    -----
    Derivatives along the span are one-sided differences of second order; along the section they
    are those of its spline, the same on both sides.
    """
    eta = blade.eta[(blade.eta > 2 * STEP) & (blade.eta < 1 - 2 * STEP)]
    if not eta.size:
        return eta, np.zeros(0)
    at = blade.sections(eta)
    along = blade.splines.values(blade.u, 1) @ at
    normals = []
    for side in (-1.0, 1.0):
        one, two = (blade.sections(eta + side * k * STEP) for k in (1, 2))
        slope = side * (-3.0 * at + 4.0 * one - two) / (2.0 * STEP)
        normal = np.cross(along, slope)
        normals.append(normal / np.linalg.norm(normal, axis=-1, keepdims=True))
    before, after = normals
    sine = np.linalg.norm(np.cross(before, after), axis=-1)
    return eta, np.arctan2(sine, np.sum(before * after, axis=-1)).max(axis=1)


def edge_widths(blade: Blade, eta: Array) -> Array:
    """Return the trailing edges' widths over chord (k,), as the definition gives them."""
    profiles = blade.profiles(eta)
    return np.asarray(np.linalg.norm(profiles[:, 0] - profiles[:, -1], axis=-1))


def edge_bulges(blade: Blade) -> list[tuple[float, float]]:
    """Return where the trailing edge's width leaves the range of the stations beside it.

    Returns
    -------
    list of (eta, excess)
        For each stretch between stations that does, the worst span and by how much of the
        chord: a dent or a bulge that the airfoils themselves do not have.
    """
    grid = np.union1d(np.linspace(blade.eta[0], blade.eta[-1], SPANS), blade.eta)
    widths, ends = edge_widths(blade, grid), edge_widths(blade, blade.eta)
    cell = np.clip(np.searchsorted(blade.eta, grid, side="right") - 1, 0, len(blade.eta) - 2)
    low = np.minimum(ends[cell], ends[cell + 1])
    high = np.maximum(ends[cell], ends[cell + 1])
    excess = np.maximum(low - widths, widths - high)
    worst = [
        int(rows[np.argmax(excess[rows])])
        for rows in (np.flatnonzero(cell == k) for k in range(len(blade.eta) - 1))
        if rows.size
    ]
    return [(float(grid[i]), float(excess[i])) for i in worst if excess[i] > BULGE]


def steps(blade: Blade) -> list[tuple[float, float, float]]:
    """Return where sections change on a sliver of the span by far more than beside it.

    That is what a leading edge does which changes from one nose to another: the chord line turns,
    and the surface has a step there.  Stations that lie as near to each other are not meant.

    Returns
    -------
    list of (eta, change, times)
        The worst span of each such place, by how much of the chord a unit section changes over
        1 / (FINE - 1) of the span, and how many times as much that is as the median beside it.
    """
    eta = np.linspace(0.0, 1.0, FINE)
    changes, last = [], np.empty((0, len(blade.u), 2))
    for part in np.split(eta, range(BLOCK, FINE, BLOCK)):
        profiles = np.concatenate([last, blade.profiles(part)])
        changes.append(np.abs(np.diff(profiles, axis=0)).max(axis=(1, 2)))
        last = profiles[-1:]
    change = np.concatenate(changes)
    padded = np.pad(change, BESIDE, mode="edge")
    beside = np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * BESIDE + 1), axis=1)
    steep = (change > LEAST_STEP) & (change > STEEP * beside)
    near = np.diff(blade.eta) < 4.0 / (FINE - 1)
    for low in blade.eta[:-1][near]:
        steep &= np.abs(eta[:-1] - low) > 8.0 / (FINE - 1)
    places = np.flatnonzero(steep)
    groups = np.split(places, np.flatnonzero(np.diff(places) > BESIDE) + 1) if places.size else []
    worst = [int(group[np.argmax(change[group])]) for group in groups]
    return [
        (float(eta[i]), float(change[i]), float(change[i] / max(beside[i], 1e-12))) for i in worst
    ]
