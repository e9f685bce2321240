"""Airfoil coordinates of any file to n ordered landmarks that mean the same place everywhere.

Landmarks run trailing edge -> suction side -> leading edge -> pressure side -> trailing
edge, in chords, in the airfoil's own axes.  The leading edge is the point of the contour's
spline farthest from the trailing-edge midpoint; it is the middle landmark of an odd n.
Landmark i is the same place on every airfoil, the root circle included: arc length is a smooth
function of the landmark parameter that knows nothing of the airfoil but how long its sides are.
"""

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from bladegen.airfoils.fairing import fair
from bladegen.curves.arc_lengths import divided, lengths
from bladegen.errors import GeometryError
from bladegen.support.arguments import numbers
from bladegen.support.arrays import Array, readonly
from bladegen.support.values import brief

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

__all__ = [
    "Contour",
    "Spacing",
    "clustered",
    "contour",
    "cosine",
    "landmark_parameters",
    "landmarks",
    "oriented",
    "uniform",
]

Spacing = Callable[[Array], Array]

REPEATED = 1e-9  # chords; points nearer than this are one point
LARGEST = 1e6  # chords; points farther apart than this cannot be told from repeated ones
CORNER_TURN = np.radians(40.0)  # leading edges turn by up to 28 degrees a point in real files
BLUNT_BASE = 0.02  # chords; corners nearer than this to the trailing edge end the sides
LEANING = 0.5  # of a base's height: farther along the chord it is a side, not a base
BLUNT_MINIMUM = 1e-3  # chords; a base lower than this is rounding, not a flatback
SETTLED = 1e-9  # chords; a step below that leaves its square
REMEMBERED = 512  # contours, and sets of landmarks; some 20 MB


def uniform(fraction: Array) -> Array:
    """Space landmarks evenly by arc length."""
    return fraction


def cosine(fraction: Array) -> Array:
    """Cluster landmarks at the trailing and the leading edge, like a cosine."""
    spaced: Array = 0.5 * (1.0 - np.cos(np.pi * fraction))
    return spaced


def clustered(fraction: Array) -> Array:
    """Cluster landmarks at both edges, but keep the smallest step at a tenth of the mean.

    The noses of published airfoils need steps of 1e-3 chord (FFA-W3-211 turns by 27 degrees
    at one point); a pure cosine goes on to steps of 6e-5 chord that serve nobody.
    """
    return 0.9 * cosine(fraction) + 0.1 * fraction


def landmark_parameters(n: int, spacing: Spacing = clustered) -> Array:
    """Return where n landmarks lie: 0 at the suction TE, 0.5 at the LE, 1 at the pressure TE.

    Parameters
    ----------
    n : int
        An odd number of landmarks, at least 5.
    spacing : callable
        Maps [0, 1] (trailing to leading edge) onto itself, increasing.

    Returns
    -------
    (n,) array
        Symmetric about 0.5; fractions of the contour's length where both sides are as long, and
        what becomes of them elsewhere is `arc_lengths.divided`'s.
    """
    if n < 5 or n % 2 == 0:
        raise GeometryError(f"landmarks: got {n}, allowed are odd numbers from 5, such as 401")
    even = np.linspace(0.0, 1.0, n // 2 + 1)
    spaced = numbers(spacing(even), "spacing", GeometryError)
    whole = spaced.shape == even.shape and (spaced[0], spaced[-1]) == (0.0, 1.0)
    if not (whole and np.all(np.diff(spaced) > 0)):
        raise GeometryError("spacing: must map an array from 0 to 1 onto 0 to 1, rising")
    side = 0.5 * spaced
    return np.concatenate([side, 1.0 - side[-2::-1]])


@dataclass(frozen=True, eq=False)
class Contour:
    """An airfoil's contour as a spline, cut into its two sides.

    Parameters
    ----------
    spline : PPoly
        Point at a parameter that runs TE -> suction side -> LE -> pressure side -> TE.
    leading_edge : float
        The parameter of the leading edge.
    opened : float
        Height of a blunt base that the file pulled to one point, in chords; 0 if none.
    moved : float
        Largest distance of a given point to the spline, in chords; 0 if not faired.
    """

    spline: "PPoly"
    leading_edge: float
    opened: float = 0.0
    moved: float = 0.0

    __repr__ = brief

    def landmarks(self, parameters: Array) -> Array:
        """Return the points (n, 2) at landmark parameters.

        Parameters
        ----------
        parameters : (n,) array
            0 to 0.5 along the suction side, 0.5 to 1 along the pressure side, as
            `landmark_parameters` makes them.  The contour is a smooth function of them.
        """
        return _placed(self, np.asarray(parameters, dtype=np.float64).tobytes())


def landmarks(coordinates: Array, n: int = 401, *, spacing: Spacing = clustered) -> Array:
    """Place n landmarks on an airfoil.

    Parameters
    ----------
    coordinates : (m, 2) array
        Points from trailing edge to trailing edge, either side first, open or closed.
    n : int
        Number of landmarks, odd.
    spacing : callable
        Spacing along sides of one length from trailing to leading edge.

    Returns
    -------
    (n, 2) array
        Landmarks on the airfoil's spline.

    Raises
    ------
    GeometryError
        If the points do not enclose an area.
    """
    return contour(coordinates).landmarks(landmark_parameters(n, spacing))


def oriented(coordinates: Array) -> Array:
    """Return the points suction side first, without repeated neighbours.

    Suction side first is counter-clockwise with x to the trailing edge and y to suction.
    """
    extent = float(np.ptp(coordinates, axis=0).max())
    if not extent <= LARGEST:
        raise GeometryError(f"airfoil spans {extent:g} chords, allowed is up to {LARGEST:g}")
    points = _distinct(coordinates)
    if len(points) < 3:
        raise GeometryError(f"airfoil has {len(points)} distinct points, at least 3 are needed")
    x, y = points.T
    area = 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    if abs(area) < REPEATED:
        raise GeometryError(f"airfoil encloses an area of {area:.1e} chord^2, needs more than 0")
    return points if area > 0 else points[::-1]


def _distinct(points: Array) -> Array:
    """Drop points that repeat the one before them."""
    steps = np.hypot(*np.diff(points, axis=0).T)
    kept: Array = points[np.concatenate([[True], steps > REPEATED])]
    return kept


def contour(coordinates: Array, *, fairing: float | None = None) -> Contour:
    """Fit an airfoil's points by a cubic spline and find its leading edge.

    A blunt base that the file pulled to one point at the trailing edge (IEA 15 MW's
    SNL-FFA-W3-500) is no part of the sides: it is taken as the open edge that it is.

    With `fairing`, the spline passes the points by at most that distance in chords, and noise of
    their digits is left out (`fairing`); without, it passes through them.  The same points get
    the same contour, fitted once: blades share their airfoils with their variants and copies.
    """
    points = numbers(coordinates, "airfoil", GeometryError)
    if points.ndim != 2 or points.shape[1] != 2:
        raise GeometryError(f"airfoil: got the shape {points.shape}, must be (m, 2)")
    return _fitted(points.tobytes(), fairing)


@lru_cache(maxsize=REMEMBERED)
def _fitted(points_in_bytes: bytes, fairing: float | None) -> Contour:
    coordinates = np.frombuffer(points_in_bytes).reshape(-1, 2)
    given, opened = _without_base(oriented(coordinates))
    points = given if fairing is None else fair(given, fairing)
    spline = _spline(points)
    moved = float(np.hypot(*(points - given).T).max())
    return Contour(spline, _farthest(spline, 0.5 * (points[0] + points[-1])), opened, moved)


@lru_cache(maxsize=REMEMBERED)
def _placed(curve: Contour, parameters_in_bytes: bytes) -> Array:
    """Return the points of a contour at landmark parameters; see `Contour.landmarks`."""
    parameters = np.frombuffer(parameters_in_bytes)
    knots = np.union1d(curve.spline.x, [curve.leading_edge])
    arc = np.concatenate([[0.0], np.cumsum(lengths(curve.spline, knots[:-1], knots[1:]))])
    nose = arc[np.searchsorted(knots, curve.leading_edge)]
    target = arc[-1] * divided(parameters, nose / arc[-1])
    segment = np.clip(np.searchsorted(arc, target, side="right") - 1, 0, len(knots) - 2)
    start, end = knots[segment], knots[segment + 1]
    t = start + (end - start) * (target - arc[segment]) / (arc[segment + 1] - arc[segment])
    for _ in range(4):  # Newton; the parameter is nearly arc length, so two steps are usual
        excess = arc[segment] + lengths(curve.spline, start, t) - target
        speed = np.hypot(*curve.spline(t, 1).T)  # 0 where a contour turns back on itself
        step = np.divide(excess, speed, out=np.zeros_like(excess), where=speed > 0)
        t = np.clip(t - step, start, end)
        if np.abs(step).max(initial=0.0) <= SETTLED:
            break
    return readonly(curve.spline(t))


def _without_base(points: Array) -> tuple[Array, float]:
    """Cut a closed blunt base off at its corners, one of which may be the point that closes it."""
    if np.hypot(*(points[0] - points[-1])) > REPEATED:
        return points, 0.0
    suction, pressure = _base_corner(points), _base_corner(points[::-1])
    base = np.abs(points[suction] - points[len(points) - 1 - pressure])
    upright = (suction and pressure) or base[0] < LEANING * base[1]
    if not upright or not np.hypot(*base) >= BLUNT_MINIMUM:
        return points, 0.0
    sides = points[suction : len(points) - pressure]
    first = _prolonged(sides[0], sides[1], points[0, 0])
    last = _prolonged(sides[-1], sides[-2], points[0, 0])
    opened = _distinct(np.concatenate([first[None], sides, last[None]]))
    return opened, float(np.hypot(*(first - last)))


def _base_corner(points: Array) -> int:
    """Return the index of the last corner close behind the first point, 0 if there is none."""
    half = points[: len(points) // 2 + 1]
    steps = np.diff(half, axis=0)
    heading = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    near = np.hypot(*(half[1:-1] - half[0]).T) < BLUNT_BASE
    corners = np.flatnonzero(near & (np.abs(np.diff(heading)) > CORNER_TURN))
    return int(corners[-1]) + 1 if corners.size else 0


def _prolonged(corner: Array, before: Array, x: float) -> Array:
    """Prolong the line from `before` through `corner` to the abscissa `x`, unless it is steep."""
    run, rise = corner - before
    missing = x - corner[0]
    if abs(missing * rise) > BLUNT_BASE * abs(run):
        return corner
    return np.array([x, corner[1] + (missing * rise / run if missing else 0.0)])


def _spline(points: Array) -> "PPoly":
    """Interpolate points by a C2 cubic in chord-length parameter."""
    from scipy.interpolate import CubicSpline

    t = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    ends = "not-a-knot" if len(points) > 3 else "natural"
    return CubicSpline(t, points, bc_type=ends)


def _farthest(spline: "PPoly", middle: Array) -> float:
    """Return the parameter of the point farthest from the trailing-edge midpoint."""
    from scipy.optimize import brentq

    fine = (spline.x[:-1, None] + np.diff(spline.x)[:, None] * np.arange(4) / 4.0).reshape(-1)
    best = int(np.argmax(np.sum((spline(fine) - middle) ** 2, axis=1)))
    low, high = fine[max(best - 1, 0)], fine[min(best + 1, len(fine) - 1)]
    first, last = np.clip(np.searchsorted(spline.x, (low, high)) - 1, 0, len(spline.x) - 2)
    knots = spline.x[first : last + 1].tolist()
    cubics = spline.c[:, first : last + 1].transpose(1, 2, 0).tolist()

    def slope(t: float) -> float:
        i = max(bisect_right(knots, t) - 1, 0)
        h, total = t - knots[i], 0.0
        for (a, b, c, d), edge in zip(cubics[i], middle.tolist(), strict=True):
            total += (((a * h + b) * h + c) * h + d - edge) * ((3.0 * a * h + 2.0 * b) * h + c)
        return total

    if not slope(low) > 0 > slope(high):  # points in pairs make ripples of a spline
        near = np.linspace(low, high, 33)
        best = int(np.clip(np.argmax(np.sum((spline(near) - middle) ** 2, axis=1)), 1, 31))
        low, high = near[best - 1], near[best + 1]
    if not slope(low) > 0 > slope(high):
        raise GeometryError("airfoil has no leading edge: its farthest point is a corner or an end")
    return float(brentq(slope, low, high, xtol=1e-14))
