"""How other tools place a blade: lines along the chord instead of a reference axis.

A definition has a reference axis (x, y, z) and says how far behind the leading edge it lies.
AeroDyn and HAWC2 give the curve of one point of the chord instead: the aerodynamic centre, or
the half chord.  In the blade frame (x to the suction side, y to the trailing edge), with chord
c, twist t and the axis a distance o behind the leading edge, the point at the fraction f is at

    x + (f c - o) sin t,    y + (f c - o) cos t,    z

section planes normal to z, as the published files of the IEA 15 MW have it to their last digit.
The way back needs o, which those files do not hold: `axis_of_line` finds it.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.definition.blade_definition import pchip
from bladegen.errors import Finding
from bladegen.support.arrays import Array

__all__ = ["Line", "axis_finding", "axis_of_line", "curve_length", "line_of_axis", "slope_degrees"]

INSIDE = (-0.05, 1.05)  # chords; where a reference axis may lie in a section
LENGTH_STEPS = 16  # pieces an interval of a curve is measured in


@dataclass(frozen=True)
class Line:
    """A reference axis found from a line along the chord.

    Parameters
    ----------
    x, y : (m,) arrays
        The axis [m], blade frame.
    offset : (m,) array
        From the leading edge to the axis, along the chord [m].
    straight : bool
        Whether the axis was found in the plane y = 0, as that of a blade without sweep.
    """

    x: Array
    y: Array
    offset: Array
    straight: bool


def line_of_axis(
    x: Array, y: Array, chord: Array, twist: Array, offset: Array, fraction: Array | float
) -> tuple[Array, Array]:
    """Return x and y (...) of the point at `fraction` of the chord [m]."""
    ahead = fraction * chord - offset
    return x + ahead * np.sin(twist), y + ahead * np.cos(twist)


def axis_of_line(
    x: Array,
    y: Array,
    chord: Array,
    twist: Array,
    fraction: Array | float,
    pitch_axis: Array | None = None,
) -> Line:
    """Return the reference axis of a blade of which the line at `fraction` is known.

    Parameters
    ----------
    x, y : (m,) arrays
        The line [m], blade frame.
    chord, twist : (m,) arrays
        [m] and [rad].
    fraction : (m,) array or float
        Where in the chord the line runs.
    pitch_axis : (m,) array, optional
        Where in the chord the axis is to run.  If not given, it is where the chord meets
        y = 0, the plane of pitch axis and prebend, which is exact for blades without sweep;
        if that is outside of a section, the blade is swept, and the line itself is the axis.
    """
    if pitch_axis is None:
        with np.errstate(all="ignore"):  # chords of all but nothing, which are refused later
            found = fraction - y / (chord * np.cos(twist))
        straight = bool(np.all((found >= INSIDE[0]) & (found <= INSIDE[1])))
        pitch_axis = found if straight else np.broadcast_to(fraction, chord.shape)
        offset = pitch_axis * chord
        behind = offset - fraction * chord
        y = np.zeros_like(y) if straight else y
        return Line(x + behind * np.sin(twist), y, offset, straight)
    behind = (pitch_axis - fraction) * chord
    return Line(x + behind * np.sin(twist), y + behind * np.cos(twist), pitch_axis * chord, False)


def axis_finding(where: str, line: Line) -> Finding:
    """Say how the reference axis was found that the file at `where` does not hold."""
    if line.straight:
        said = "holds no reference axis: taken where the chord meets y = 0, the blade as not swept"
    else:
        said = "lies beyond the chord from y = 0, so the blade is swept, and this line its axis"
    return Finding(where, said)


def slope_degrees(x: Array, z: Array) -> Array:
    """Return the angle [deg] of a curve x(z) from z at its points, positive where x rises.

    Second-order differences, one-sided at the ends, as `numpy.gradient` has them.
    """
    slope: Array = np.degrees(np.arctan(np.gradient(x, z)))
    return slope


def curve_length(x: Array, y: Array, z: Array) -> tuple[Array, Array]:
    """Measure the PCHIP curves x(z) and y(z).

    Returns
    -------
    z, length : (16 m - 15,) arrays
        Places along z, the given ones among them, and the curve's length up to there.
    """
    steps = np.arange(1, LENGTH_STEPS + 1) / LENGTH_STEPS
    between = z[:-1, None] + np.diff(z)[:, None] * steps
    between[:, -1] = z[1:]
    fine = np.concatenate([z[:1], between.ravel()])
    pieces = [np.diff(pchip(z, values)(fine)) for values in (x, y)]
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(np.hypot(*pieces), np.diff(fine)))])
    return fine, lengths
