"""Points on [0, 1] whose first and last cells have given sizes and whose others grow smoothly.

The two-sided hyperbolic tangent of Vinokur, On one-dimensional stretching functions for
finite-difference calculations, J. Comput. Phys. 50 (1983), 215-234, equations 61 to 66.  It
fixes slopes at the ends; here these are adjusted until the end cells themselves fit.
"""

from collections.abc import Callable

import numpy as np

from bladegen.errors import GeometryError
from bladegen.support.arrays import Array

__all__ = ["MINIMUM_CELLS", "two_sided", "vinokur"]

MINIMUM_CELLS = 4
LARGEST = 1.5  # times the mean cell; two larger ends would leave too little between them
ADJUSTMENTS = 200
FIT = 1e-10  # relative, of the end cells' sizes
BISECTIONS = 80  # halve the bracket below rounding


def two_sided(
    cells: int, first: float, last: float, *, names: tuple[str, str] = ("first cell", "last cell")
) -> Array:
    """Return points from 0 to 1 with end cells of given sizes.

    Parameters
    ----------
    cells : int
        How many cells, at least 4.
    first, last : float
        Sizes of the first and the last cell, up to 1.5 times the mean size.
    names : (str, str)
        What errors call these.

    Returns
    -------
    (cells + 1,) array
        Increasing.

    Raises
    ------
    GeometryError
        If there are too few cells, or a size is not positive or too large.

    >>> two_sided(4, 0.25, 0.25).tolist()
    [0.0, 0.25, 0.5, 0.75, 1.0]
    """
    if cells < MINIMUM_CELLS:
        raise GeometryError(f"got {cells} cells, at least {MINIMUM_CELLS} are needed")
    for name, size in zip(names, (first, last), strict=True):
        if not 0 < size <= LARGEST / cells:
            raise GeometryError(
                f"{name}: got {size:g}, allowed is more than 0 and up to "
                f"{LARGEST / cells:.4g}, {LARGEST:g} times the mean of {cells} cells"
            )
    wanted = np.log([first, last])
    slopes = wanted
    for _ in range(ADJUSTMENTS):
        points = vinokur(cells, *np.exp(slopes))
        missing = wanted - np.log([points[1], 1.0 - points[-2]])
        if np.abs(missing).max() < FIT:
            break
        slopes = slopes + missing
    return points


def vinokur(cells: int, first: float, last: float) -> Array:
    """Return points from 0 to 1 whose slopes at the ends are those of cells of given sizes."""
    t = np.linspace(0.0, 1.0, cells + 1)
    middle = 1.0 / (cells * np.sqrt(first * last))
    ratio = np.sqrt(last / first)
    if middle > 1.0:
        growth = _root(lambda x: np.sinh(x) / x, middle, 1e-9, 500.0)
        plain = 0.5 * (1.0 + np.tanh(growth * (t - 0.5)) / np.tanh(growth / 2.0))
    elif middle < 1.0:
        growth = _root(lambda x: -np.sin(x) / x, -middle, 1e-9, np.pi)
        plain = 0.5 * (1.0 + np.tan(growth * (t - 0.5)) / np.tan(growth / 2.0))
    else:
        plain = t
    points: Array = plain / (ratio + (1.0 - ratio) * plain)
    points[0], points[-1] = 0.0, 1.0
    return points


def _root(increasing: Callable[[float], float], value: float, low: float, high: float) -> float:
    """Return where an increasing function takes a value, by bisection."""
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if increasing(middle) < value else (low, middle)
    return 0.5 * (low + high)
