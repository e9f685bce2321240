"""Whether a contour whose ends do not meet is open, or closed with its edge point listed once.

NuMAD lists the point of the trailing edge once, at the start; as it stands such a contour would
have a slanted open edge.  Its own shape tells: one side runs on straight into the other end,
while the sides of an open edge both turn into the gap by nearly a right angle.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["Ends", "ends"]

ROUNDING = 1e-5  # chords; ends nearer than this meet but for the digits of their file
RUNS_ON = np.radians(45.0)  # turn of a side into the gap; a corner turns by more
CLEARLY = np.radians(30.0), np.radians(90.0)  # turns at the end that goes on and at the other
SLANTED = 0.15  # of the gap along the chord: its hinder end is the edge
LEVEL = 0.02  # of the gap in x: both ends stand at one x, as those of an open edge do
CUT = 1e-3  # of the gap in x: exactly so; a closed circle has such ends from 3,000 points on
CLEARLY_SLANTED = 0.5  # flatbacks are cut within 30 degrees of upright
SPACINGS = 3.0  # a gap longer than so many steps beside it is no step itself
LONGEST = 0.2  # chords of a gap that is closed
DIGITS = 5  # of a point that is named
PAIRS = 2  # points on either side of the edge that are compared
OPEN = "taken as an open edge (in doubt: list the first point again at the end to close it)"
DOUBT = "in doubt: it may be open; end both sides alike to keep it open"
LIKER = 0.5  # the mismatch of points about one end, over that about the gap's middle


@dataclass(frozen=True)
class Ends:
    """A contour as its ends are taken.

    Parameters
    ----------
    points : (m, 2) array
        It starts and ends at one point if closed.
    closed : bool
        Whether a point was listed again to close it.
    apart : bool
        Whether it is plainly open: two corners, or ends much farther apart than points are.
    said : str, optional
        What was taken, where it is not plain.
    """

    points: Array
    closed: bool = False
    apart: bool = False
    said: str | None = None


def ends(points: Array) -> Ends:
    """Close a contour (m, 2) in chords where its shape says that it is closed."""
    gap = points[0] - points[-1]
    length = float(np.hypot(*gap))
    if length <= ROUNDING:
        return Ends(points)
    before, after = points[-1] - points[-2], points[1] - points[0]
    turns = _turn(before, gap), _turn(gap, after)
    near = length <= SPACINGS * max(float(np.hypot(*before)), float(np.hypot(*after)))
    if min(turns) > RUNS_ON:
        return Ends(points, apart=True)
    slant = float(gap @ _chord_direction(points)) / length
    if length <= LONGEST and abs(slant) > (SLANTED if near else CLEARLY_SLANTED):
        first: bool | None = slant > 0
        doubt = not near or min(turns) > CLEARLY[0] or max(turns) < CLEARLY[1]
    elif near:
        first, doubt = None if _is_cut(points, length) else _tip(points), False
    else:
        return Ends(points, apart=True)
    if first is None:
        level = abs(gap[0]) <= LEVEL * length
        return Ends(points, said=None if level else f"its ends are {length:.3g} apart; {OPEN}")
    end = points[:1] if first else points[-1:]
    closed = np.concatenate([points, end] if first else [end, points])
    x, y = (np.round(end[0], DIGITS) + 0.0).tolist()  # no -0
    said = (
        f"the edge point ({x:g}, {y:g}) is listed once, {length:.3g} from the "
        "other end; closed there"
    )
    return Ends(closed, closed=True, said=f"{said} ({DOUBT})" if doubt else said)


def _turn(one: Array, other: Array) -> float:
    """Return the angle between two directions [rad]."""
    cross, dot = one[0] * other[1] - one[1] * other[0], one @ other
    return abs(float(np.arctan2(cross, dot)))


def _chord_direction(points: Array) -> Array:
    """Return the unit vector from the nose to the trailing edge."""
    edge = 0.5 * (points[0] + points[-1])
    nose = points[int(np.argmax(np.sum((points - edge) ** 2, axis=1)))]
    direction: Array = (edge - nose) / np.hypot(*(edge - nose))
    return direction


def _is_cut(points: Array, gap: float) -> bool:
    """Tell whether both ends stand at one x, all other points ahead of them."""
    x = points[:, 0]
    ahead = min(x[0], x[-1]) - max(x[1], x[-2])
    return bool(abs(x[0] - x[-1]) <= CUT * gap < ahead)


def _tip(points: Array) -> bool | None:
    """Tell which end a round edge is symmetric about: the first, the last (False) or neither.

    Points on both sides then have the same x in turn.
    """
    x = points[:, 0]
    k = np.arange(min(PAIRS, len(x) // 2 - 1))
    about_gap = float(np.abs(x[k] - x[-1 - k]).sum())
    about_first = float(np.abs(x[k + 1] - x[-1 - k]).sum())
    about_last = float(np.abs(x[k] - x[-2 - k]).sum())
    if min(about_first, about_last) >= LIKER * about_gap:
        return None
    return about_first <= about_last
