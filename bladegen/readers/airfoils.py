"""Airfoil contours of a document: found by name, checked, repeated points dropped.

A contour runs trailing edge -> leading edge -> trailing edge in chords, either side first,
open or closed at its end; which way round it runs is settled by `bladegen.landmarks`.
"""

from collections.abc import Iterable

import numpy as np

from bladegen.arrays import Array
from bladegen.crossing import first_crossing
from bladegen.definition import MAX_AIRFOIL_POINTS, MIN_AIRFOIL_POINTS, Airfoil
from bladegen.readers.document import Node, Range
from bladegen.readers.polars import polars

__all__ = ["airfoil", "airfoils", "thickest", "thickness"]

X = Range(-0.5, 1.5, "chords")
Y = Range(-1.0, 1.0, "chords")
CHORD = Range(0.9, 1.1)  # extent in x; the DTU 10 MW's cylinder is cut at 0.998
THICKNESS = Range(0.0, 1.05, "of the chord", above=True)
CENTRE = Range(0.0, 1.0, "of the chord")
TRAILING_EDGE = 0.9  # of the extent in x: a contour starts and ends behind it
REPEATED = 1e-9  # chords between points that are one
DISAGREEMENT = 0.01  # of the thickness: more is a finding
SHOWN_NAMES = 30


def airfoils(library: Node, wanted: Iterable[tuple[str, Node]], key: str) -> dict[str, Airfoil]:
    """Read the airfoils that a schedule names; others in the file are of no concern.

    Parameters
    ----------
    library : Node
        The file's list of airfoils, each with a name and coordinates.
    wanted : iterable of (name, Node)
        The names, and where the file asks for them.
    key : str
        Where an airfoil of this layout states its thickness.
    """
    known: dict[str, Node] = {}
    twice: dict[str, Node] = {}
    for node in library.members():
        name = node["name"].text()
        if name is not None:
            (twice if name in known else known)[name] = node
    found: dict[str, Airfoil | None] = {}
    for name, place in wanted:
        if name not in known:
            place.problem(f"got airfoil {name!r}, allowed are those of airfoils: {_names(known)}")
        elif name not in found:
            if name in twice:
                twice[name].problem(f"name {name!r} is that of {known[name].path}, must be unique")
            found[name] = airfoil(name, known[name], key)
    read = {name: airfoil for name, airfoil in found.items() if airfoil is not None}
    clockwise = [name for name, airfoil in read.items() if _area(airfoil.coordinates) < 0]
    if 0 < len(clockwise) < len(read):
        library.finding(
            f"run both ways round, made alike: pressure side first in {_names(clockwise)}"
        )
    return read


def thickness(points: Array) -> float:
    """Return the largest vertical distance between the sides of a contour, linear between points.

    Good to a fraction of a percent, which is what findings need.
    """
    return float(np.max(np.abs(_sides(points)[1])))


def thickest(points: Array) -> float:
    """Return the x at which the vertical distance between a contour's sides is largest."""
    x, gap, _ = _sides(points)
    return float(x[np.argmax(np.abs(gap))])


def airfoil(name: str, node: Node, key: str) -> Airfoil | None:
    """Read one airfoil; `key` is where it states its thickness."""
    points = _contour(node["coordinates"])
    stated = node[key].number(THICKNESS) if node.has(key) else None
    if points is None:
        return None
    measured = thickness(points)
    if stated is not None and abs(measured - stated) > DISAGREEMENT * stated:
        node[key].finding(f"{name} is stated {stated:g} thick; its coordinates give {measured:.4g}")
    centre = None
    if node.has("aerodynamic_center"):
        centre = node["aerodynamic_center"].number(CENTRE)
    return Airfoil(name, points, stated, polars(node), centre)


def _contour(node: Node) -> Array | None:
    """Return the points of a contour without repetitions, if it is one."""
    x, y = node["x"].numbers(X), node["y"].numbers(Y)
    if x is None or y is None:
        return None
    if len(x) != len(y):
        node.problem(f"x has {len(x)} entries and y {len(y)}, must be alike")
        return None
    points = np.stack([x, y], axis=1)
    repeated = np.flatnonzero(np.hypot(np.diff(x), np.diff(y)) <= REPEATED) + 1
    if repeated.size:
        points = np.delete(points, repeated, axis=0)
    if not MIN_AIRFOIL_POINTS <= len(points) <= MAX_AIRFOIL_POINTS:
        node.problem(
            f"has {len(points)} points that differ, allowed are {MIN_AIRFOIL_POINTS} to "
            f"{MAX_AIRFOIL_POINTS}"
        )
        return None
    wrong = _fault(points)
    if wrong is not None:
        node.problem(wrong)
        return None
    if repeated.size:
        node.finding(f"{len(repeated)} repeated points dropped")
    return points


def _fault(points: Array) -> str | None:
    """Say what keeps points from being the contour of an airfoil."""
    x = points[:, 0]
    extent = float(np.ptp(x))
    if not CHORD.holds(extent):
        return f"x spans {extent:g}, allowed is {CHORD} (a chord of 1)"
    if min(x[0], x[-1]) < x.min() + TRAILING_EDGE * extent:
        return (
            f"runs from x = {x[0]:g} to x = {x[-1]:g}, must start and end at the trailing edge "
            "(x near 1)"
        )
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


def _area(points: Array) -> float:
    """Return the signed area inside a contour, positive counter-clockwise."""
    x, y = points.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def _names(names: Iterable[str]) -> str:
    names = sorted(names)
    more = len(names) - SHOWN_NAMES
    return ", ".join(names[:SHOWN_NAMES]) + (f" and {more} more" if more > 0 else "") or "none"
