"""Quantities over span: values on a grid of their own, and the spline through them."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from bladegen.errors import DefinitionError
from bladegen.support.arguments import amount, function, numbers
from bladegen.support.arrays import Array, ArrayLike, readonly
from bladegen.support.values import equal, hashed

__all__ = [
    "OVER_SPAN",
    "SMALLEST_STEP",
    "Distribution",
    "Interpolant",
    "cubic_spline",
    "pchip",
    "united",
]

OVER_SPAN = "a bladegen.Distribution; Distribution.constant(value) is the same all over"
SMALLEST_STEP = 1e-9  # of the span from station to station: a tenth of a micrometre
STEEPEST = 1e15  # change over a whole span; steeper curves overflow


class Interpolant(Protocol):
    """A function of span with derivatives, as scipy's piecewise polynomials are."""

    def __call__(self, eta: ArrayLike, nu: int = 0) -> Array:
        """Return the `nu`-th derivative at `eta`."""
        ...


def pchip(grid: Array, values: Array) -> Interpolant:
    """Interpolate monotonically between points (PCHIP), as windIO recommends."""
    from scipy.interpolate import PchipInterpolator

    with np.errstate(over="ignore"):  # of 1 / slope, where slopes are denormal: they become 0
        interpolant: Interpolant = PchipInterpolator(grid, values)
    return interpolant


def cubic_spline(grid: Array, values: Array) -> Interpolant:
    """Interpolate by a cubic spline (C2) without knots at the second and the last but one point."""
    from scipy.interpolate import CubicSpline

    interpolant: Interpolant = CubicSpline(grid, values)
    return interpolant


@dataclass(frozen=True, eq=False, repr=False)
class Distribution:
    """A quantity over span: values on a grid of its own, and the spline through them.

    Parameters
    ----------
    grid : (m,) array
        Span fractions, strictly increasing within [0, 1]; at least two.
    values : (m,) array
        The quantity at the grid, in SI units and radians.
    spline : callable, optional
        Makes the interpolant from grid and values; PCHIP by default.

    Notes
    -----
    Outside its grid a distribution keeps its end values.
    """

    grid: Array
    values: Array
    spline: Callable[[Array, Array], Interpolant] = pchip

    def __post_init__(self) -> None:
        grid = readonly(numbers(self.grid, "grid", DefinitionError))
        values = readonly(numbers(self.values, "values", DefinitionError))
        function(self.spline, "spline", "a function such as definition.pchip", DefinitionError)
        if grid.ndim != 1 or grid.shape != values.shape:
            raise DefinitionError(
                f"grid and values must be lists of one length, got {grid.size} and {values.size}"
            )
        if len(grid) < 2:
            raise DefinitionError(f"{len(grid)} grid points, at least 2 are needed")
        for name, array in (("grid", grid), ("values", values)):
            bad = np.flatnonzero(~np.isfinite(array))
            if bad.size:
                raise DefinitionError(f"{name}[{bad[0]}] is {array[bad[0]]:g}, must be finite")
        if grid[0] < 0 or grid[-1] > 1:
            raise DefinitionError(f"grid runs {grid[0]:g} to {grid[-1]:g}, allowed is 0 to 1")
        bad = np.flatnonzero(np.diff(grid) <= 0)
        if bad.size:
            i = int(bad[0])
            raise DefinitionError(
                f"grid must increase strictly, got {grid[i]:g} then {grid[i + 1]:g} "
                f"(entries {i} and {i + 1})"
            )
        bad = np.flatnonzero(np.abs(np.diff(values / STEEPEST)) > np.diff(grid))
        if bad.size:
            i = int(bad[0])
            raise DefinitionError(
                f"values must not jump, got {values[i]:g} at {grid[i]:g} and {values[i + 1]:g} "
                f"only {grid[i + 1] - grid[i]:g} on (entries {i} and {i + 1})"
            )
        object.__setattr__(self, "grid", grid)
        object.__setattr__(self, "values", values)

    __eq__ = equal
    __hash__ = hashed

    def __repr__(self) -> str:
        values = self.values
        ends = (
            f"{values[0]:.4g} at eta = {self.grid[0]:.3g}, {values[-1]:.4g} at {self.grid[-1]:.3g}"
        )
        least, most = f"{values.min():.4g}", f"{values.max():.4g}"
        return f"<Distribution of {len(values)} points: {ends}, {least} to {most}>"

    @classmethod
    def constant(cls, value: float) -> "Distribution":
        """Return the distribution that is `value` everywhere."""
        one = amount(value, "value", DefinitionError)
        return cls(np.array([0.0, 1.0]), np.array([one, one]))

    @cached_property
    def _interpolant(self) -> Interpolant:
        return self.spline(self.grid, self.values)

    def __call__(self, eta: ArrayLike, nu: int = 0) -> Array:
        """Return the quantity, or its `nu`-th derivative, at span fractions `eta`."""
        eta = numbers(eta, "eta", DefinitionError)
        inside = np.clip(eta, self.grid[0], self.grid[-1])
        result = np.asarray(self._interpolant(inside, nu=nu))
        return np.where(inside == eta, result, 0.0) if nu else result


def united(*grids: ArrayLike, apart: float = SMALLEST_STEP) -> Array:
    """Return the points of several grids in one, of points nearer than `apart` only the first.

    The last point of all stays.

    >>> united([0.0, 0.1 + 0.2, 1.0], [0.3, 0.5]).tolist()
    [0.0, 0.3, 0.5, 1.0]
    """
    merged = np.unique(np.concatenate([np.asarray(grid, dtype=np.float64) for grid in grids]))
    kept: Array = merged[np.insert(np.diff(merged) >= apart, 0, True)]
    kept[-1] = merged[-1]
    return kept
