"""Points of any airfoil file to a contour from trailing edge to trailing edge, in chords.

Files list an airfoil as one loop from the trailing edge or from the nose, or as two sides; in
chords, per cent or lengths; with its trailing edge open, closed, or closed with its point listed
once.  What is done to the points is said: nothing is turned, closed, scaled or shifted in silence.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.curves.crossing import first_crossing
from bladegen.definition.blade_definition import MAX_AIRFOIL_POINTS
from bladegen.formats.airfoils.closing import ends
from bladegen.formats.common.document import Range
from bladegen.support.arrays import Array

__all__ = ["Contour", "ContourError", "contour", "joined", "sides", "thickest", "thickness"]

CHORD = Range(0.9, 1.1)  # extent in x; the DTU 10 MW's cylinder is cut at 0.998
LENGTHS = Range(1e-3, 1e5)  # of a chord in a file: in metres, chords, per cent or millimetres
UNITS = {100.0: "in per cent", 1000.0: "in thousandths"}
HIGHEST = 2.0  # chords from the lowest to the highest point; a circle has 1
THICKNESS = Range(0.0, 1.05, "of the chord", above=True)
TRAILING_EDGE = 0.9  # of the extent in x: a contour starts and ends behind it
FEWEST = 10  # points below which a file is no airfoil
REPEATED = 1e-9  # chords between points that are one
UNLIKE_ONE = 5e-4  # of the chord; a chord that is farther from 1 is a finding
SHIFTED = 0.01  # chords; noses farther from 0 are brought there
INCLINED = 1.0  # degrees; a chord line inclined by more is a finding
HALF = 0.5  # of the extent in x: a longer step leads from one side's end to the other's start
WHOLE = 0.8  # of the extent in x that each of two sides has


class ContourError(Exception):
    """Why points are no contour of an airfoil."""


@dataclass(frozen=True)
class Contour:
    """A contour in chords, trailing edge to trailing edge, and what was done to it.

    Parameters
    ----------
    points : (m, 2) array
        ``scale`` times the file's points less ``shift``, in another order perhaps.
    said : tuple of str
        What was done.
    scale : float
        From the file's unit to chords.
    shift : (2,) array
        Of the origin, in chords.
    """

    points: Array
    said: tuple[str, ...]
    scale: float
    shift: Array


def contour(points: Array, *, any_unit: bool = False, fewest: int = FEWEST) -> Contour:
    """Make a contour of points in the order of their file.

    Parameters
    ----------
    points : (m, 2) array
        Along the contour, from any place, either way round.
    any_unit : bool
        Whether the file leaves the unit open; otherwise points are in chords.
    fewest : int
        Points that an airfoil has at least.

    Raises
    ------
    ContourError
        If they are none.
    """
    said: list[str] = []
    if not np.isfinite(points).all():
        raise ContourError("has a coordinate that is not finite")
    if any_unit and len(points) > MAX_AIRFOIL_POINTS:
        raise ContourError(
            f"has {len(points)} points, allowed are {fewest} to {MAX_AIRFOIL_POINTS}"
        )
    scale = _scale(points, said) if any_unit and len(points) >= fewest else 1.0
    points = _distinct(scale * points, said)
    if not fewest <= len(points) <= MAX_AIRFOIL_POINTS:
        raise ContourError(
            f"has {len(points)} points that differ, allowed are {fewest} to {MAX_AIRFOIL_POINTS}"
        )
    extent = float(np.ptp(points[:, 0]))
    if not CHORD.holds(extent):
        raise ContourError(f"x spans {extent:g}, allowed is {CHORD} (a chord of 1)")
    points = _from_trailing_edge(points, said)
    fault = _fault(points)
    if fault is not None:
        raise ContourError(fault)
    shift = _shift(points, said)
    points = points - shift
    _remark(points, said)
    return Contour(points, tuple(said), scale, shift)


def joined(upper: Array, lower: Array) -> Array:
    """Return two sides, each from end to end, as one loop from trailing to trailing edge."""
    first = upper if upper[0, 0] >= upper[-1, 0] else upper[::-1]
    second = lower if lower[-1, 0] >= lower[0, 0] else lower[::-1]
    same = bool(np.allclose(first[-1], second[0], rtol=0, atol=REPEATED * np.ptp(upper[:, 0])))
    return np.concatenate([first, second[1:] if same else second])


def sides(points: Array) -> Array:
    """Return points as one loop where a file lists one side after the other, else unchanged.

    The step from one side to the other is then longer than half the chord.
    """
    if len(points) < FEWEST:
        return points
    x = points[:, 0]
    extent = float(np.ptp(x))
    far = np.flatnonzero(np.abs(np.diff(x)) > HALF * extent) + 1
    if far.size != 1:
        return points
    first, second = points[: far[0]], points[far[0] :]
    if min(np.ptp(first[:, 0]), np.ptp(second[:, 0])) < WHOLE * extent:
        return points
    return joined(first, second)


def thickness(points: Array) -> float:
    """Return the largest vertical distance between the sides of a contour, over its extent in x.

    Linear between points: good to a fraction of a percent, which is what findings need.
    """
    return float(np.max(np.abs(_sides(points)[1])) / np.ptp(points[:, 0]))


def thickest(points: Array) -> float:
    """Return the x at which the vertical distance between a contour's sides is largest."""
    x, gap, _ = _sides(points)
    return float(x[np.argmax(np.abs(gap))])


def _scale(points: Array, said: list[str]) -> float:
    """Return the factor from a file's unit to chords."""
    with np.errstate(over="ignore"):
        extent, height = (float(size) for size in np.ptp(points, axis=0))
    if not LENGTHS.holds(extent):
        raise ContourError(f"x spans {extent:g}, allowed is {LENGTHS}")
    if height > HIGHEST * extent:
        raise ContourError(
            f"y spans {height:g}, allowed is up to {HIGHEST:g} times the chord of {extent:g}"
        )
    if CHORD.holds(extent):
        return 1.0
    for unit, name in UNITS.items():
        if CHORD.holds(extent / unit):
            said.append(f"x spans {extent:g}: taken as {name} of the chord, divided by {unit:g}")
            return 1.0 / unit
    said.append(
        f"x spans {extent:.6g}, a chord of 1 is expected: the shape is scaled by {1 / extent:.6g}"
    )
    return 1.0 / extent


def _distinct(points: Array, said: list[str]) -> Array:
    """Drop points that repeat the one before them."""
    repeated = np.flatnonzero(np.hypot(*np.diff(points, axis=0).T) <= REPEATED) + 1
    if repeated.size:
        said.append(f"{len(repeated)} repeated points dropped")
    return np.delete(points, repeated, axis=0)


def _from_trailing_edge(points: Array, said: list[str]) -> Array:
    """Let a contour start and end at the trailing edge, closed where its shape says so."""
    x = points[:, 0]
    behind = x.min() + TRAILING_EDGE * float(np.ptp(x))
    if max(x[0], x[-1]) < behind:
        return _turned(points, said)
    taken = ends(points)
    if not taken.closed and min(x[0], x[-1]) < behind:
        raise ContourError(
            f"does not run from trailing edge to trailing edge: from x = {x[0]:g} to "
            f"x = {x[-1]:g}, must start and end there (x near 1) or at the nose"
        )
    if taken.said is not None:
        said.append(taken.said)
    return taken.points


def _turned(points: Array, said: list[str]) -> Array:
    """Let a ring that starts at its nose start at its trailing edge."""
    x = points[:, 0]
    gap = float(np.hypot(*(points[-1] - points[0])))
    before = x.min() + (1.0 - TRAILING_EDGE) * float(np.ptp(x))
    if gap > REPEATED and max(x[0], x[-1]) > before:
        raise ContourError(
            f"does not run from trailing edge to trailing edge: from x = {x[0]:g} to "
            f"x = {x[-1]:g}, must start and end there (x near 1) or at the nose"
        )
    said.append(
        f"starts at x = {x[0]:.4g}, not at the trailing edge; the points are turned to start there"
    )
    ring = points[:-1] if gap <= REPEATED else points
    last = int(np.argmax(ring[:, 0]))
    ways = [np.roll(ring, -last, axis=0), np.roll(ring, -last - 1, axis=0)]
    open_ = [way for way in ways if ends(way).apart]
    if open_:  # an edge with two corners, one of the steps that meet in the hindmost point
        return max(open_, key=lambda way: float(np.hypot(*(way[0] - way[-1]))))
    return np.concatenate([ways[0], ways[0][:1]])


def _fault(points: Array) -> str | None:
    """Say what keeps points from being the contour of an airfoil."""
    _, gap, single = _sides(points)
    apart = single and bool(np.all(gap >= 0) or np.all(gap <= 0))
    crossing = None if apart else first_crossing(points)
    if crossing is not None:
        i, j = crossing
        near = points[[i, i + 1, j, j + 1]].mean(axis=0)
        return (
            f"the contour crosses itself near ({near[0]:.3g}, {near[1]:.3g}), between points {i} "
            f"and {i + 1} and points {j} and {j + 1}; must not"
        )
    thick = float(np.max(np.abs(gap)))
    if not THICKNESS.holds(thick):
        return f"the contour is {thick:.4g} thick, allowed is {THICKNESS}"
    return None


def _shift(points: Array, said: list[str]) -> Array:
    """Return what brings the nose to x = 0, and a chord line that lies beside y = 0 there."""
    start = float(points[:, 0].min())
    nose, edge = _chord_line(points)
    aside = float(np.sign(edge[1])) * min(abs(nose[1]), abs(edge[1]))
    beside = nose[1] * edge[1] > 0 and abs(aside) > SHIFTED
    shift = np.array([start if abs(start) > SHIFTED else 0.0, aside if beside else 0.0])
    if shift[0]:
        said.append(f"its nose lies at x = {shift[0]:.4g}; shifted to 0")
    if shift[1]:
        said.append(f"its chord line lies at y = {shift[1]:.4g}; shifted to 0")
    return shift


def _remark(points: Array, said: list[str]) -> None:
    """Say where the chord line is not from (0, 0) to (1, 0)."""
    nose, edge = _chord_line(points)
    start, end = float(points[:, 0].min()), float(edge[0])
    chord = max(float(np.hypot(*(edge - nose))), end - start)
    if abs(chord - 1.0) > UNLIKE_ONE:
        said.append(
            f"its chord is {chord:.4f}, from x = {start:.4f} to {end:.4f}; stretched by "
            f"{1 / chord:.4f} to a chord of 1"
        )
    inclined = float(np.degrees(np.arctan2(edge[1] - nose[1], edge[0] - nose[0])))
    if abs(inclined) > INCLINED:
        said.append(f"its chord line is inclined by {inclined:.2f} deg, which adds to the twist")


def _chord_line(points: Array) -> tuple[Array, Array]:
    """Return the point farthest from the middle of the trailing edge, and that middle."""
    edge = 0.5 * (points[0] + points[-1])
    far = np.sum((points - edge) ** 2, axis=1)
    return points[int(np.argmax(far))], edge


def _sides(points: Array) -> tuple[Array, Array, bool]:
    """Return x, how far the first side lies above the second there, and whether x tells it fully.

    It does where x runs strictly one way on each side: then the sides cross only if the
    distance changes its sign, and the search for crossings can be spared.
    """
    x, y = points.T
    nose = int(np.argmin(x))
    first, second = np.arange(nose, -1, -1), np.arange(nose, len(x))
    single = bool(np.all(np.diff(x[first]) > 0) and np.all(np.diff(x[second]) > 0))
    if not single:
        first, second = (side[np.argsort(x[side], kind="stable")] for side in (first, second))
    inside = x[x <= min(x[first[-1]], x[second[-1]])]
    above = np.interp(inside, x[first], y[first]) - np.interp(inside, x[second], y[second])
    return inside, above, single
