"""How fair a blade's surface is: its curvature along the span and around sections, and its jumps.

Normal curvatures [1/m], positive where the surface is hollow seen from outside, from derivatives
of the surface itself: along the section those of its spline, along the span differences.  Where
curvature jumps, reflections have a corner; where a crease is (`smoothness`), they break.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.spans import grid_points
from bladegen.measures import smoothness
from bladegen.support.arrays import Array

__all__ = ["Fairness", "chordwise", "fairness", "normals", "spanwise"]

STEP = 5e-5  # of the span, of differences; sections are exact to 1e-13 of the chord
LINES = np.concatenate([np.linspace(0.04, 0.48, 12), np.linspace(0.52, 0.96, 12)])  # u: along span
SPANS, FEW = 1001, 10  # sections along the span; of these, every so-many-th around
APART = 4.0 * STEP  # of the span: places nearer to each other or to an end are passed over
CHORD = 0.05, 0.98  # between which curvature around sections is summed up, as in combs


@dataclass(frozen=True)
class Fairness:
    """Figures of a surface's fairness.

    Parameters
    ----------
    creases : tuple of (eta, angle)
        The inner stations and by what angle [rad] the normal jumps there at most.
    jumps : tuple of (eta, jump)
        Where distributions and stations have their points, and by how much the spanwise curvature
        jumps there at most [1/m].
    spanwise : float
        The total variation of the spanwise curvature from root to tip, mean of 24 lines [1/m].
    chordwise : float
        The total variation of curvature times chord around a section, between 5 and 98 % of the
        chord, mean of all.
    """

    creases: tuple[tuple[float, float], ...]
    jumps: tuple[tuple[float, float], ...]
    spanwise: float
    chordwise: float

    @property
    def jump(self) -> tuple[float, float]:
        """The largest jump of the spanwise curvature [1/m] and where it is."""
        eta, jump = max(self.jumps, key=lambda pair: pair[1], default=(0.0, 0.0))
        return jump, eta


def fairness(blade: Blade) -> Fairness:
    """Measure how fair a blade's surface is."""
    eta, angles = smoothness.creases(blade)
    breaks = _breaks(blade)
    before, after = (spanwise(blade, breaks, LINES, side=side) for side in (-1.0, 1.0))
    jumps = np.abs(after - before).max(axis=1, initial=0.0)
    spans = np.linspace(APART, 1.0 - APART, SPANS)
    along = spanwise(blade, spans, LINES)
    around = blade.profiles(spans[::FEW])[..., 0]
    inner = (around > CHORD[0]) & (around < CHORD[1])
    turns = np.abs(np.diff(chordwise(blade, spans[::FEW]), axis=1))
    return Fairness(
        tuple(zip(eta.tolist(), angles.tolist(), strict=True)),
        tuple(zip(breaks.tolist(), jumps.tolist(), strict=True)),
        float(np.abs(np.diff(along, axis=0)).sum(axis=0).mean()),
        float(np.sum(turns * (inner[:, 1:] & inner[:, :-1]), axis=1).mean()),
    )


def spanwise(blade: Blade, eta: Array, u: Array, *, side: float = 0.0) -> Array:
    """Return normal curvatures (k, m) [1/m] along the lines of constant `u` (m,).

    Derivatives over span are central differences, or those before (-1) or behind (1) it alone.
    """
    places = (-1.0, 0.0, 1.0) if side == 0.0 else (0.0, side, 2.0 * side, 3.0 * side)
    points = [blade.sections(eta + place * STEP, u) for place in places]
    if side == 0.0:
        slope = (points[2] - points[0]) / (2.0 * STEP)
        second = (points[2] - 2.0 * points[1] + points[0]) / STEP**2
    else:
        one, two, three, four = points
        slope = side * (-1.5 * one + 2.0 * two - 0.5 * three) / STEP
        second = (2.0 * one - 5.0 * two + 4.0 * three - four) / STEP**2
    normal = _normals(blade, eta, u, slope)
    length = np.sum(slope * slope, axis=-1)
    curvature: Array = np.sum(second * normal, axis=-1) / length
    return curvature


def chordwise(blade: Blade, eta: Array) -> Array:
    """Return curvatures times chord (k, n) around sections at their landmarks, in their planes."""
    profiles = blade.trailing_edge(blade.profiles(eta), blade.chord(eta))
    first, second = (blade.splines.values(blade.u, nu) @ profiles for nu in (1, 2))
    turning = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    curvature: Array = -turning / np.linalg.norm(first, axis=-1) ** 3
    return curvature


def normals(blade: Blade, eta: Array, u: Array) -> Array:
    """Return outward unit normals (k, m, 3) of the surface at span fractions and landmarks."""
    inside = np.clip(eta, STEP, 1.0 - STEP)
    ahead, behind = (blade.sections(inside + way * STEP, u) for way in (1.0, -1.0))
    return _normals(blade, eta, u, ahead - behind)


def _normals(blade: Blade, eta: Array, u: Array, slope: Array) -> Array:
    """Return outward unit normals, given derivatives over span (k, m, 3)."""
    own = blade.sections(eta)
    around = blade.splines.values(u, 1) @ own
    normal = np.cross(slope, around)
    unit: Array = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return unit


def _breaks(blade: Blade) -> Array:
    """Return the inner span fractions at which distributions, stations and planes have points."""
    given = grid_points(blade.definition), blade.eta, [blade.planform.frames.root]
    places = np.unique(np.concatenate(given))
    places = places[(places > APART) & (places < 1.0 - APART)]
    kept: Array = places[np.insert(np.diff(places) > APART, 0, True)] if len(places) else places
    return kept
