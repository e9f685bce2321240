"""A blade's inner surface as a B-spline net, and what is to be said of it.

The net is fitted to the inner side of the wall (`wall`) with knots where it strays.  Whether it
crosses itself or the outer surface is looked for on polygons around the wall, which know nothing
of how it was made.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.airfoils.landmarks import landmark_parameters
from bladegen.blade.layup.layup import Layup
from bladegen.blade.remembered import Remembered
from bladegen.curves.crossing import first_crossing
from bladegen.errors import Finding
from bladegen.support.arrays import Array
from bladegen.surface.deviation import Deviation, measured
from bladegen.surface.inner.limits import limited
from bladegen.surface.inner.wall import Wall
from bladegen.surface.net import SurfaceNet, on_knots
from bladegen.surface.splines import Knots

__all__ = ["TOLERANCE", "InnerSurface", "crossing_spans", "inner_surface"]

TOLERANCE = 1e-3  # m
FIRST = 65  # knots around the section to begin with
MAX_POLES = 60_000  # some 6 MB of STEP
ROUNDS = 12
SHARE = 0.5  # of the tolerance, by which an interval may stray around the section or along the span
TIGHT, LEAST = 0.03, 0.03  # of the room and, at least, of the tolerance: allowed where that is less
LEVEL = 0.1  # of the most that it strays by in a round, below which nothing is done in it
NARROWEST, CLOSEST = 5e-4, 2e-4  # of the way round, of the span: intervals that are not halved
WATCHED = 301, 401  # spans, and places around the section, at which crossings are looked for


@dataclass(frozen=True, eq=False)
class InnerSurface:
    """The inner surface of a blade's wall.

    Parameters
    ----------
    net : SurfaceNet or None
        From the first to the last span at which it is to be had; None if it is nowhere.
    deviation : Deviation
        Of its sides from the offset sections, between its knots.
    volume : float
        Of the wall between the outer surface and this one, as far as this one goes [m3].
    left_out : float
        Volume of the layers for which there was no room [m3].
    findings : tuple of Finding
        Where walls do not fit, where the surface ends before the blade does, and if it strays.
    """

    net: SurfaceNet | None
    deviation: Deviation
    volume: float
    left_out: float
    findings: tuple[Finding, ...]


def inner_surface(net: SurfaceNet, layup: Layup, tolerance: float = TOLERANCE) -> InnerSurface:
    """Return the surface inside of a blade's layers.

    Parameters
    ----------
    net : SurfaceNet
        The blade's outer surface.
    layup : Layup
        Its layers.
    tolerance : float
        Largest distance to the offset sections aimed at [m].
    """
    wall = Wall(net, layup)
    left_out, findings = limited(wall)
    made, deviation = _fitted(wall, tolerance)
    if deviation.maximum > tolerance:
        off = f"{1e3 * deviation.maximum:.2g} mm off the layers at eta = {deviation.eta:.3f}"
        findings += (Finding("inner surface", f"{off}, asked were {1e3 * tolerance:g} mm"),)
    first, last, said = _sound(wall, made)
    if first == last:
        return InnerSurface(None, deviation, 0.0, left_out, findings + said)
    ends = made.between(first, last)
    volume = net.between(first, last).volume() - ends.volume()
    return InnerSurface(ends, deviation, volume, left_out, findings + said)


def _fitted(wall: Wall, tolerance: float) -> tuple[SurfaceNet, Deviation]:
    """Return the best net of up to `MAX_POLES`, with more knots where it strays most."""
    known = Remembered(wall)
    u = Knots.simple(landmark_parameters(FIRST))
    v = Knots(*np.unique(wall.net.v_knots, return_counts=True))
    best = None
    for _ in range(ROUNDS):
        net = on_knots(known, u, v)
        found = measured(net, known)
        deviation = Deviation.of(found.parts)
        narrow = np.clip(TIGHT * wall.room(found.v, found.u), LEAST * tolerance, tolerance)
        offsets, across = (np.abs(one) / narrow for one in (found.offsets, found.across))
        worst = float(offsets.max())
        if best is None or worst < best[0]:
            best = worst, net, deviation
        if worst <= 1.0:
            break
        most = SHARE * max(1.0, LEVEL * worst)
        along = (np.abs(found.offsets - found.across) / narrow).max(axis=1)
        finer = _halved(u, found.u, across.max(axis=0), most, NARROWEST)
        closer = _halved(v, found.v, along, most, CLOSEST)
        if finer.poles * closer.poles > MAX_POLES or (finer is u and closer is v):
            break
        u, v = finer, closer
    assert best is not None
    return best[1:]


def _halved(knots: Knots, at: Array, off: Array, most: float, least: float) -> Knots:
    """Return knots with one more in each interval that strays by more than `most` at places."""
    cells = np.clip(np.searchsorted(knots.at, at, side="right") - 1, 0, len(knots.at) - 2)
    worst = np.zeros(len(knots.at) - 1)
    np.maximum.at(worst, cells, off)
    split = np.flatnonzero((worst > most) & (np.diff(knots.at) > 2.0 * least))
    if not split.size:
        return knots
    middles = 0.5 * (knots.at[split] + knots.at[split + 1])
    return Knots(np.insert(knots.at, split + 1, middles), np.insert(knots.times, split + 1, 1))


def crossing_spans(wall: Wall, inner: SurfaceNet, eta: Array) -> Array:
    """Return at which spans (k,) the inner outline crosses itself or the outer one, (k,) of bool.

    Looked at is the polygon around the wall: along the outer outline, and back along the inner.
    """
    u, plane = landmark_parameters(WATCHED[1]), wall.planes(eta)
    outer, inside = wall.net.evaluate(u, eta), inner.evaluate(u, eta)
    nose = outer[:, len(u) // 2]
    chord = nose - 0.5 * (outer[:, 0] + outer[:, -1])
    chord -= np.sum(chord * plane, axis=-1, keepdims=True) * plane
    square = np.sum(chord**2, axis=-1)[:, None, None]
    axes = np.stack([chord, np.cross(plane, chord)], axis=-1) / square
    around = np.concatenate([outer, inside[:, ::-1], outer[:, :1]], axis=1) - nose[:, None]
    return np.array([first_crossing(loop) is not None for loop in around @ axes])


def _sound(wall: Wall, inner: SurfaceNet) -> tuple[float, float, tuple[Finding, ...]]:
    """Return from where to where an inner surface crosses nothing, the longest such part."""
    eta = np.linspace(0.0, 1.0, WATCHED[0])
    crossing = crossing_spans(wall, inner, eta)
    if not crossing.any():
        return 0.0, 1.0, ()
    bounds = np.flatnonzero(np.concatenate([[True], crossing, [True]]))  # of runs, 1 too far
    longest = int(np.argmax(np.diff(bounds)))
    first, last = bounds[longest], max(bounds[longest], bounds[longest + 1] - 2)
    places = eta[crossing]
    said = f"crosses itself at {len(places)} of {len(eta)} spans from eta = {places[0]:.3f} on"
    if last > first:
        said += f"; it goes from eta = {eta[first]:.3f} to {eta[last]:.3f}"
    else:
        said, first = f"{said}; it is left out", last
    return float(eta[first]), float(eta[last]), (Finding("inner surface", said),)
