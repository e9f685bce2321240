"""Inflections over span that a blade has and its definition has not: wiggles and dents.

Chord-normalised thickness, trailing edge's width and the heights of both sides at places along
the chord (whose second derivatives are the surface's curvature along the span, chord, twist and
axis apart) are functions of span.  Each is held against what the definition says of it: its
thickness distribution, or a monotone spline through the stations' own values in the path's
parameter.  Where a quantity changes the sense in which it bends, by more than noise on both sides,
and that spline does not bend so over the same two stretches, there is a finding.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.curves.sides import sides
from bladegen.definition.blade_definition import pchip
from bladegen.support.arrays import Array, Indices

__all__ = ["DEPTH", "Inflection", "bends", "inflections"]

DEPTH = 1e-3  # of chord; shallower bends are noise of airfoils and of their blending
OWN_SHARE = 0.25  # of a bend: what the definition must have of it, so as not to be told of it
SPANS = 601
PLACES = np.array([0.05, 0.15, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95])  # of chord


@dataclass(frozen=True)
class Inflection:
    """A change of the sense in which something bends over span.

    Parameters
    ----------
    quantity : str
        What bends.
    eta : float
        Where.
    depth : float
        How deep the shallower of the bends on both sides is, in chords.
    """

    quantity: str
    eta: float
    depth: float


def inflections(blade: Blade) -> list[Inflection]:
    """Return the inflections that a blade's definition does not have, the deepest first."""
    stations = blade.eta
    grid = np.union1d(np.linspace(stations[0], stations[-1], SPANS), stations)
    at = np.searchsorted(grid, stations)
    found = []
    for name, values, own in _quantities(blade, grid, at):
        for before, behind in pairwise(bends(grid, values, DEPTH)):
            shares = [
                _depth(grid, own, first, last, sense) / depth
                for first, last, sense, depth in (before, behind)
            ]
            if min(shares) < OWN_SHARE:
                place = float(0.5 * (grid[before[1]] + grid[behind[0]]))
                found.append(Inflection(name, place, min(before[3], behind[3])))
    return sorted(found, key=lambda inflection: -inflection.depth)


def bends(grid: Array, values: Array, depth: float) -> list[tuple[int, int, int, float]]:
    """Return the stretches of a function over which it bends in one sense.

    Parameters
    ----------
    grid, values : (k,) arrays
        The function.
    depth : float
        Shallower bends are taken for parts of their neighbours.

    Returns
    -------
    list of (first, last, sense, depth)
        Indices, 1 where it bends upward (a dent) or -1, and how far it departs from a straight
        line between the two; senses take turns.
    """
    slope = np.diff(values) / np.diff(grid)
    runs: list[tuple[int, int, int]] = []
    for i, sense in enumerate(np.sign(np.diff(slope)).astype(int).tolist(), start=1):
        if runs and sense in (0, runs[-1][2]):
            runs[-1] = (runs[-1][0], i + 1, runs[-1][2])
        elif sense:
            runs.append((i - 1, i + 1, sense))
    depths = [_depth(grid, values, *run) for run in runs]
    while runs and min(depths) < depth:
        least = int(np.argmin(depths))
        around = slice(max(least - 1, 0), least + 2)
        first, last = runs[around][0][0], runs[around][-1][1]
        others = [run[2] for run in runs[around] if run[2] != runs[least][2]]
        runs[around] = [(first, last, sense) for sense in others[:1]]
        depths[around] = [_depth(grid, values, first, last, sense) for sense in others[:1]]
    return [(*run, deep) for run, deep in zip(runs, depths, strict=True)]


def _depth(grid: Array, values: Array, first: int, last: int, sense: int) -> float:
    """Return how far a function departs from the straight line between two indices."""
    part = slice(first, last + 1)
    ends = np.interp(grid[part], grid[[first, last]], values[[first, last]])
    return float(np.max(sense * (ends - values[part])))


def _quantities(blade: Blade, grid: Array, at: Indices) -> list[tuple[str, Array, Array]]:
    """Return names, values over span, and what the definition says of them."""
    profiles = blade.profiles(grid)
    curves = blade.splines.fit(profiles)
    knots, q = blade.parameter.knots, blade.parameter(grid)
    thickness = curves.relative_thickness
    ruling = blade.wanted_thickness(grid)
    own = pchip(knots, thickness[at])(q) if ruling is None else ruling
    width = curves.edge_width
    upper, lower = sides(profiles, PLACES)
    found = [
        ("relative thickness", thickness, own),
        ("trailing edge's width", width, pchip(knots, width[at])(q)),
    ]
    for side, heights in (("suction", upper), ("pressure", lower)):
        shares = heights / np.where(thickness > 0, thickness, 1.0)[:, None]  # 0 where sides cross
        expected = pchip(knots, shares[at])(q) * own[:, None]
        found += [
            (f"{side} side at {100 * x:.0f} % chord", heights[:, i], expected[:, i])
            for i, x in enumerate(PLACES)
        ]
    return found
