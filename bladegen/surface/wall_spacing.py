"""How high the first cell on a wall is, by the friction of a turbulent flat plate.

y+ is the distance from the wall times the friction velocity over the kinematic viscosity.  The
local friction is Schlichting's interpolation, cf = (2 log10(Re) - 0.65)^-2.3 (Boundary-Layer
Theory, 7th edition, chapter XXI, for Re up to 1e9), at the chord's Reynolds number: an estimate
before a run, within some ten percent on the aft half of a section.
"""

import numpy as np

from bladegen.errors import GeometryError
from bladegen.support.arrays import Array, ArrayLike

__all__ = ["REYNOLDS", "first_height", "friction"]

REYNOLDS = 1e4, 1e9  # where the friction law is used


def first_height(reynolds: ArrayLike, chord: ArrayLike, y_plus: ArrayLike) -> Array:
    """Return the distance from the wall at which y+ is reached.

    Arguments are broadcast against each other.

    Parameters
    ----------
    reynolds : float or array
        Reynolds number of the chord, 1e4 to 1e9.
    chord : float or array
        Chord [m].
    y_plus : float or array
        Distance in wall units: about 1 to resolve the sublayer, 30 to 300 for wall functions.

    Returns
    -------
    array
        Distance [m], that of the first point off the wall.  A solver that keeps values in cell
        centres needs cells twice as high.

    Raises
    ------
    GeometryError
        If a value is not positive or a Reynolds number out of range.

    >>> round(float(first_height(1e7, 5.0, 1.0)) * 1e6, 2)
    13.92
    """
    for name, value, unit in (("chord", chord, " m"), ("y+", y_plus, "")):
        bad = np.asarray(value, dtype=np.float64)
        bad = bad[~(np.isfinite(bad) & (bad > 0))]
        if bad.size:
            raise GeometryError(f"{name}: got {bad.flat[0]:g}{unit}, must be positive")
    size = np.asarray(chord, dtype=np.float64)
    number = np.asarray(reynolds, dtype=np.float64)
    result: Array = np.asarray(y_plus) * size / (number * np.sqrt(0.5 * friction(number)))
    return result


def friction(reynolds: ArrayLike) -> Array:
    """Return the local friction coefficient of a flat plate, wall stress over dynamic pressure.

    Raises
    ------
    GeometryError
        If a Reynolds number is out of range.

    >>> round(float(friction(1e7)), 6)
    0.002579
    """
    number = np.asarray(reynolds, dtype=np.float64)
    bad = number[~((number >= REYNOLDS[0]) & (number <= REYNOLDS[1]))]
    if bad.size:
        raise GeometryError(
            f"Reynolds number: got {bad.flat[0]:g}, allowed are {REYNOLDS[0]:g} to {REYNOLDS[1]:g}"
        )
    result: Array = (2.0 * np.log10(number) - 0.65) ** -2.3
    return result
