"""A net cut into pieces on which OCCT's default quadrature finds the volume, exactly.

OCCT integrates a face by 61 Gauss points each way at most, however many knot spans it has, and by
fewer where it has few: volumes of blades on faces from root to tip are off by a thousandth, which
FreeCAD shows.  On short pieces of a dozen spans or so they are right to 1e-5, and sections by
planes take a tenth of the time.  Cuts are made by knot insertion, and neighbours share their poles.
"""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from bladegen.support.arrays import Array
from bladegen.surface.splines import DEGREE

__all__ = ["ALONG", "AROUND", "Patch", "cut", "cuts", "mirrored", "shorter", "with_knots"]

ALONG, AROUND = 8, 20  # knot spans of a piece at most; profiles are smooth along the chord
LONGEST_ALONG, LONGEST_AROUND = 0.005, 0.01  # of a knot span


class Patch(NamedTuple):
    """A B-spline surface by its poles (a, b, 3) and knots with multiplicities."""

    poles: Array
    u_knots: Array
    v_knots: Array


def cuts(knots: Array, most: int) -> Array:
    """Return the knots at which to cut so that no piece has more than `most` knot spans.

    All those at which there may be a crease, and others evenly between them.
    """
    distinct, times = np.unique(knots, return_counts=True)
    creases = np.flatnonzero(times >= DEGREE)
    places = [creases[:1]]
    for first, last in pairwise(creases):
        count = -(-(last - first) // most)
        places.append(np.linspace(first, last, count + 1).round().astype(int)[1:])
    return np.asarray(distinct[np.concatenate(places)[1:-1]])


def shorter(knots: Array, longest: float) -> Array:
    """Return the knots to be inserted so that no knot span is longer than that."""
    spans = pairwise(np.unique(knots).tolist())
    return np.concatenate(
        [np.linspace(a, b, math.ceil((b - a) / longest) + 1)[1:-1] for a, b in spans]
    )


def with_knots(patch: Patch, u: Array, v: Array) -> Patch:
    """Return the same surface with more knots."""
    poles, u_knots = _inserted(patch.poles, patch.u_knots, u)
    across, v_knots = _inserted(poles.swapaxes(0, 1), patch.v_knots, v)
    return Patch(across.swapaxes(0, 1), u_knots, v_knots)


def _inserted(poles: Array, knots: Array, new: Array) -> tuple[Array, Array]:
    from scipy.interpolate import BSpline

    spline = BSpline(knots, poles, len(knots) - len(poles) - 1)
    for place in new:
        spline = spline.insert_knot(place)
    return spline.c, spline.t


def mirrored(u: Array) -> Array:
    """Return the places on one side of a section, u <= 0.5, on the other."""
    return 1.0 - u[::-1]


def cut(patch: Patch, u: Array, v: Array) -> list[list[Patch]]:
    """Return the pieces between cuts at `u` and `v`: a list along v of lists along u."""
    return [
        [
            Patch(piece, u_knots, v_knots)
            for piece, u_knots in _cut(row.swapaxes(0, 1), patch.u_knots, u)
        ]
        for row, v_knots in _cut(patch.poles.swapaxes(0, 1), patch.v_knots, v)
    ]


def _cut(poles: Array, knots: Array, places: Array) -> list[tuple[Array, Array]]:
    """Cut splines along the first axis of their poles; return poles and knots of the pieces."""
    from scipy.interpolate import BSpline

    degree = len(knots) - len(poles) - 1
    spline = BSpline(knots, poles, degree)
    for place in places:
        missing = degree - int(np.count_nonzero(spline.t == place))
        if missing > 0:
            spline = spline.insert_knot(place, missing)
    starts = [int(np.searchsorted(spline.t, place)) - 1 for place in places]
    bounds = zip([0, *starts], [*starts, len(spline.t) - degree - 2], strict=True)
    pieces = []
    for (first, last), (a, b) in zip(bounds, pairwise([knots[0], *places, knots[-1]]), strict=True):
        inner = spline.t[(spline.t > a) & (spline.t < b)]
        clamped = np.concatenate([[a] * (degree + 1), inner, [b] * (degree + 1)])
        pieces.append((spline.c[first : last + 1], clamped))
    return pieces
