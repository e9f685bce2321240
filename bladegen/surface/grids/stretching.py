"""Points on [0, 1] whose first and last cells have given sizes and whose others grow smoothly.

The two-sided hyperbolic tangent of Vinokur, On one-dimensional stretching functions for
finite-difference calculations, J. Comput. Phys. 50 (1983), 215-234, equations 61 to 66.  It
fixes slopes at the ends; here these are adjusted until the end cells themselves fit.
"""

from collections.abc import Callable

import numpy as np

from bladegen.errors import GeometryError
from bladegen.support.arrays import Array

__all__ = [
    "FASTEST",
    "LARGEST",
    "MINIMUM_CELLS",
    "between",
    "eased",
    "growth",
    "lines",
    "partial_sums",
    "require_sizes",
    "symmetric",
    "two_sided",
    "vinokur",
]

MINIMUM_CELLS = 4
LARGEST = 1.5  # times the mean cell; two larger ends would leave too little between them
MOST = 0.6  # of the whole length, that one cell takes unless geometric growth asks for more
SMALLEST = 1e-9  # cell, of the whole length
FASTEST = 1.28  # growth from cell to cell beyond which end cells give way
ADJUSTMENTS = 200
FIT = 1e-10  # relative, of the end cells' sizes
BISECTIONS = 80  # halve the bracket below rounding
STEPS = 5  # of Newton from first guesses that are a tenth off at most


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
    require_sizes(cells, first, last, names)
    points: Array = lines(cells, np.array([first]), np.array([last]), fit=FIT)[0]
    return points


def require_sizes(cells: int, first: float, last: float, names: tuple[str, str]) -> None:
    """See that `two_sided` can have such cells, or raise its errors."""
    if cells < MINIMUM_CELLS:
        raise GeometryError(f"got {cells} cells, at least {MINIMUM_CELLS} are needed")
    for name, size in zip(names, (first, last), strict=True):
        if not 0 < size <= LARGEST / cells:
            raise GeometryError(
                f"{name}: got {size:g}, allowed is more than 0 and up to "
                f"{LARGEST / cells:.4g}, {LARGEST:g} times the mean of {cells} cells"
            )


def lines(cells: int, first: Array, last: Array, *, fit: float = 1e-4) -> Array:
    """Return points (m, cells + 1) from 0 to 1 whose end cells have the sizes (m,) given.

    Sizes are taken as they are, and fitted to a relative accuracy `fit`.
    """
    wanted = np.log(np.stack([first, last]))
    slopes = wanted
    for _ in range(ADJUSTMENTS):
        points = vinokur(cells, *np.exp(slopes))
        missing = wanted - np.log(np.stack([points[:, 1], 1.0 - points[:, -2]]))
        if np.abs(missing).max() < fit:
            break
        slopes = slopes + missing
    return points


def between(cells: int, first: Array, last: Array) -> Array:
    """Return points (m, cells + 1) from 0 to 1 with end cells as near to sizes (m,) as can be.

    The first is at most 1.5 times the mean, the last 1.5 times that or what cells that grow
    geometrically from the first would have; fewer than 4 cells do grow so.
    """
    first = np.clip(first, SMALLEST, LARGEST / cells)
    if cells < MINIMUM_CELLS:
        points = first[:, None] * partial_sums(cells, growth(cells, 1.0 / first))
        made: Array = points / points[:, -1:]
        return made
    grown = first * growth(cells, 1.0 / first) ** (cells - 1)
    most = np.minimum(LARGEST * np.maximum(grown, 1.0 / cells), np.maximum(grown, MOST))
    last = np.clip(last, SMALLEST, most)
    return lines(cells, first, last)


def vinokur(cells: int, first: Array, last: Array) -> Array:
    """Return points (m, cells + 1) whose slopes at the ends are those of cells of sizes (m,)."""
    t = np.linspace(0.0, 1.0, cells + 1)
    middle = (1.0 / (cells * np.sqrt(first * last)))[:, None]
    ratio = np.sqrt(last / first)[:, None]
    fine = middle > 1.0
    growth = _hyperbolic(np.where(fine, middle, 2.0))
    plain = 0.5 * (1.0 + np.tanh(growth * (t - 0.5)) / np.tanh(growth / 2.0))
    growth = _circular(np.where(middle < 1.0, middle, 0.5))
    coarse = 0.5 * (1.0 + np.tan(growth * (t - 0.5)) / np.tan(growth / 2.0))
    plain = np.where(fine, plain, np.where(middle < 1.0, coarse, t))
    points: Array = plain / (ratio + (1.0 - ratio) * plain)
    points[:, 0], points[:, -1] = 0.0, 1.0
    return points


def _hyperbolic(value: Array) -> Array:
    """Return x > 0 where sinh(x) / x takes values > 1: Newton's steps on its logarithm."""
    over, log = value - 1.0, np.log(np.maximum(value, 2.0))
    many = log + (1.0 + 1.0 / log) * np.log(2.0 * log)  # as x grows, x = log(2 x value)
    x: Array = np.where(value < 2.8, np.sqrt(6.0 * over) / (1.0 + 0.13 * over), many)
    for _ in range(STEPS):
        x = x - np.log(np.sinh(x) / x / value) / (1.0 / np.tanh(x) - 1.0 / x)
    return x


def _circular(value: Array) -> Array:
    """Return x > 0 where sin(x) / x takes values < 1: Newton's steps."""
    under = 1.0 - value
    x: Array = np.sqrt(6.0 * under * (1.0 + 0.3 * under + 0.345 * under**2))  # pi for 0
    for _ in range(STEPS):
        x = x - (np.sin(x) - value * x) / (np.cos(x) - np.sin(x) / x)
    return x


def symmetric(cells: int, first: Array) -> Array:
    """Return points (..., cells + 1) from 0 to 1 that grow geometrically up to the middle.

    Parameters
    ----------
    cells : int
        How many, even.
    first : (...) array
        Sizes of the end cells, less than 1 / 2; see `eased`.
    """
    half, size = cells // 2, 2.0 * first
    points = size[..., None] * partial_sums(half, growth(half, 1.0 / size))
    points[..., -1] = 1.0
    both: Array = 0.5 * np.concatenate([points, 2.0 - points[..., -2::-1]], axis=-1)
    return both


def eased(cells: int, first: Array) -> Array:
    """Return end cells (...) of `symmetric` for wanted ones, over the whole length.

    They are at most 1.5 times the mean.  Where cells would have to grow by more than 1.28, they
    are larger than wanted, by up to 1.28; where that does not do, by as much as the others grow.
    """
    half = cells // 2
    wanted = np.minimum(first, LARGEST / cells)
    fastest = np.full(wanted.shape, FASTEST)
    slow = 0.5 / partial_sums(half, fastest)[..., -1]
    even = wanted * growth(half + 1, 1.0 + 0.5 / wanted)
    result: Array = np.minimum(
        np.where(slow <= FASTEST * wanted, np.maximum(wanted, slow), even), LARGEST / cells
    )
    return result


def growth(cells: int, length: Array) -> Array:
    """Return by how much each cell is larger than the one before.

    Parameters
    ----------
    cells : int
        How many cells.
    length : (...) array
        What they fill, over the first cell.
    """
    if cells == 1:
        return np.ones_like(length)
    return _root(lambda r: partial_sums(cells, r)[..., -1], length, 1e-6, 1e3)


def partial_sums(cells: int, ratio: Array) -> Array:
    """Return where cells end, (..., cells + 1), that begin with 1 and grow by a ratio (...)."""
    sizes = np.power(ratio[..., None], np.arange(cells))
    sums: Array = np.concatenate([np.zeros((*ratio.shape, 1)), np.cumsum(sizes, axis=-1)], axis=-1)
    return sums


def _root(increasing: Callable[[Array], Array], value: Array, low: float, high: float) -> Array:
    """Return where an increasing function takes values, by bisection."""
    below, above = np.full(value.shape, low), np.full(value.shape, high)
    with np.errstate(over="ignore"):
        for _ in range(BISECTIONS):
            middle = 0.5 * (below + above)
            less = increasing(middle) < value
            below, above = np.where(less, middle, below), np.where(less, above, middle)
    result: Array = 0.5 * (below + above)
    return result
