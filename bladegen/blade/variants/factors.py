"""What varies in a family, and between which bounds: coordinates of shape and affine parameters."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from bladegen.blade.changes.deformation import RANGES, AffineChange, in_units
from bladegen.errors import DesignError
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arguments import amount, instance, numbers, shown, suggestion
from bladegen.support.arrays import Array, Mask, readonly
from bladegen.support.values import brief

__all__ = ["Factors", "factors"]


@dataclass(frozen=True, eq=False)
class Factors:
    """What varies, and between which bounds.

    Parameters
    ----------
    names : tuple of str
        "t1" to "tr", then parameters of `AffineChange`; radians.
    low, high : (d,) arrays
        Bounds.
    spread : (d,) array
        Standard deviation of the data along coordinates, zero for affine parameters.
    reach : float
        How many standard deviations the ellipsoid of the data extends.
    """

    names: tuple[str, ...]
    low: Array
    high: Array
    spread: Array
    reach: float = 0.0

    __repr__ = brief

    def __post_init__(self) -> None:
        for name in ("low", "high", "spread"):
            object.__setattr__(self, name, readonly(getattr(self, name)))

    @property
    def shape(self) -> Mask:
        """Which factors are coordinates of shape, (d,)."""
        return np.array([name not in RANGES for name in self.names], dtype=bool)

    def split(self, values: Array, modes: int) -> tuple[Array, AffineChange]:
        """Return coordinates (b, modes) and affine parameters of variants (b, d)."""
        t = np.zeros((len(values), modes))
        changes = {}
        for name, column in zip(self.names, values.T, strict=True):
            if name in RANGES:
                changes[name] = column
            else:
                t[:, int(name[1:]) - 1] = column
        return t, AffineChange(**changes)

    def outside(self, values: Array) -> list[str]:
        """Say of each variant (b, d) which factor leaves its bounds; "" if none does.

        Coordinates may lie in the box of the bounds or in the data's ellipsoid.
        """
        beyond = (values < self.low) | (values > self.high)
        shape = self.shape & (self.spread > 0)
        scaled = values[:, shape] / self.spread[shape]
        within = np.linalg.norm(scaled, axis=1) <= self.reach * (1.0 + 1e-12)
        beyond &= ~(within[:, None] & shape)
        first, any_beyond = np.argmax(beyond, axis=1), np.any(beyond, axis=1).tolist()
        return [
            f"{self.names[j]} = {row[j]:.6g} is outside {self.low[j]:.6g} to {self.high[j]:.6g}"
            if leaves
            else ""
            for row, j, leaves in zip(values, first, any_beyond, strict=True)
        ]


def factors(
    space: ShapeSpace | None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    *,
    reach: float = 1.0,
) -> Factors:
    """Return what varies: all coordinates of a space, and what bounds are given for.

    Parameters
    ----------
    space : ShapeSpace, optional
        Whose coordinates vary between the least and largest of its data.
    bounds : mapping of str to (low, high), optional
        Bounds of the user's own, of coordinates or affine parameters; equal ones hold a factor.
    reach : float
        Share of the space's bounds and of its ellipsoid that is used.

    Raises
    ------
    DesignError
        If a name is unknown, or bounds are reversed or not allowed.
    """
    bounds = {} if bounds is None else bounds
    must = "a mapping such as {'thickness': (0.9, 1.1)}"
    instance(bounds, Mapping, "bounds", must, DesignError)
    bounds = dict(bounds)
    reach = amount(reach, "reach", DesignError)
    if not 0 < reach <= 1:
        raise DesignError(f"reach: got {reach:g}, allowed is more than 0 and at most 1")
    names = [] if space is None else [f"t{j + 1}" for j in range(space.dimension)]
    allowed = [*names, *RANGES]
    for name, pair in bounds.items():
        if name not in allowed:
            near = suggestion(name, allowed)
            raise DesignError(f"factor {name!r}: allowed are {', '.join(allowed)}{near}")
        if np.shape(numbers(pair, name, DesignError, "two bounds, (low, high)")) != (2,):
            raise DesignError(f"{name}: got {shown(pair)}, must be two bounds, (low, high)")
        low, high = pair
        if not low <= high:
            raise DesignError(f"{name}: bounds are {low:g} to {high:g}, must not fall")
        least, most = RANGES.get(name, (-np.inf, np.inf))
        if not least <= low <= high <= most:
            raise DesignError(
                f"{name}: bounds are {in_units(name, low)} to {in_units(name, high)}, allowed is "
                f"{in_units(name, least)} to {in_units(name, most)}"
            )
    lows: list[float] = []
    highs: list[float] = []
    spread: list[float] = []
    extent = 0.0
    if space is not None:
        for j, name in enumerate(names):
            given = bounds.get(name)
            least, most = given or (reach * space.lower[j], reach * space.upper[j])
            lows.append(float(least))
            highs.append(float(most))
            spread.append(0.0 if given else float(np.sqrt(space.variances[j])))
        extent = reach * space.extent
    for name in RANGES:
        if name in bounds:
            names.append(name)
            lows.append(bounds[name][0])
            highs.append(bounds[name][1])
            spread.append(0.0)
    if not names:
        raise DesignError("nothing varies: give a shape space, or bounds of a factor")
    return Factors(tuple(names), np.array(lows), np.array(highs), np.array(spread), extent)
