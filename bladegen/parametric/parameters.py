"""What varies in a differentiable blade: parameters by name, at knots over span or everywhere.

A parameter is a shape coordinate or an affine parameter; with knots it is one number a knot, and
between knots a clamped cubic spline, which is linear in the numbers, has no kinks and is level at
its ends and beyond.  Vectors x (p,) become amounts over span.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from bladegen.blade.changes.affine_change import RANGES, WHOLE, AffineChange
from bladegen.blade.changes.deformation import Coordinates
from bladegen.definition.distribution import Distribution
from bladegen.errors import PerturbationError
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arguments import numbers, shown, suggestion
from bladegen.support.arrays import Array, readonly
from bladegen.support.values import brief

__all__ = ["AFFINE", "USUAL", "Parameters", "by_name", "clamped"]

AFFINE = tuple(RANGES)
IDENTITY = AffineChange()
USUAL = {  # bounds where the space's data give none: what the user's guide calls usual
    "thickness": (0.8, 1.2),
    "camber": (0.9, 1.1),
    "chord": (0.9, 1.1),
    "twist": (-math.radians(5.0), math.radians(5.0)),
    "chord_scale": (0.9, 1.1),
    "twist_scale": (0.5, 1.5),
    "prebend_scale": (0.0, 2.0),
}


def by_name(x: Any, names: tuple[str, ...]) -> Any:
    """Return vectors with their numbers in order, where they come with names.

    Names are those of a mapping, of a Series' index or of a table's columns; "t1" is "pga[0]", as
    families call it.  What has no names is returned as it is.
    """
    labels = list(x) if isinstance(x, Mapping) else getattr(x, "columns", getattr(x, "index", None))
    if labels is None or callable(labels):
        return x
    known = {_called(label): label for label in labels if isinstance(label, str)}
    if not known and not isinstance(x, Mapping):
        return x
    missing = [name for name in names if name not in known]
    if missing or len(known) > len(names):
        other = [str(label) for called, label in known.items() if called not in names]
        said = f"no {missing[0]!r}" if missing else f"{other[0]!r}, which is no parameter"
        raise PerturbationError(
            f"x: has {said}; names must be {', '.join(names)}, in any order, or there must be none"
        )
    return np.stack([np.asarray(x[known[name]]) for name in names], axis=-1)


def _called(label: str) -> str:
    """Return a parameter's name for a coordinate's that families have."""
    number = label[1:] if label.startswith("t") else ""
    return f"pga[{int(number) - 1}]" if number.isdecimal() else label


def clamped(grid: Array, values: Array) -> Any:
    """Return the cubic spline through values (m, ...) at a grid (m,) that is level at its ends."""
    from scipy.interpolate import CubicSpline

    return CubicSpline(grid, values, bc_type="clamped")


@dataclass(frozen=True, eq=False)
class Parameters:
    """Parameters of a blade at span fractions.

    Parameters
    ----------
    entries : sequence of str or (str, knots)
        "pga" for all coordinates of the space, or a parameter of `AffineChange`; with knots,
        span fractions (m,), it takes a value at each.
    space : ShapeSpace, optional
        Whose coordinates they are.
    eta : (k,) array
        Span fractions.
    bounds : mapping of str to (low, high), optional
        By a parameter's name with or without its place; else those of the space's data and of
        `USUAL`.
    """

    entries: tuple[Any, ...]
    space: ShapeSpace | None
    eta: Array
    bounds: Mapping[str, tuple[float, float]]

    __repr__ = brief

    def __post_init__(self) -> None:
        seen = [entry.name for entry in self._columns]
        twice = {name for name in seen if seen.count(name) > 1}
        if twice:
            raise PerturbationError(f"parameters: {min(twice)} is given twice")
        for name in self.bounds:
            known = [*seen, *(entry.base for entry in self._columns), "pga"]
            if name not in known:
                near = suggestion(name, known)
                raise PerturbationError(f"bounds: {name!r} is no parameter of this model{near}")
        reversed_ = np.flatnonzero(~(self.lower <= self.upper))
        if reversed_.size:
            j = int(reversed_[0])
            raise PerturbationError(
                f"bounds: {seen[j]}: got {self.lower[j]:g} to {self.upper[j]:g}, must not fall"
            )

    @cached_property
    def _columns(self) -> tuple["Column", ...]:
        must = f"'pga' or one of {', '.join(AFFINE)}"
        if not self.entries:
            raise PerturbationError(f"parameters: got none, must be a list of {must}")
        columns: list[Column] = []
        for entry in self.entries:
            name, knots = (
                entry if isinstance(entry, tuple | list) and len(entry) == 2 else (entry, None)
            )
            if not isinstance(name, str) or name not in ("pga", *AFFINE):
                near = suggestion(name, ["pga", *AFFINE]) if isinstance(name, str) else ""
                raise PerturbationError(f"parameters: got {shown(entry)}, must be {must}{near}")
            if name == "pga" and self.space is None:
                raise PerturbationError(
                    "parameters: 'pga' needs a shape space, such as ShapeSpace.bundled()"
                )
            weights, places = self._spread(name, knots)
            bases = [name]
            if name == "pga" and self.space is not None:
                bases = [f"pga[{j}]" for j in range(self.space.dimension)]
            for weight, place in zip(weights, places, strict=True):
                columns += [Column(base, base + place, weight) for base in bases]
        return tuple(columns)

    @property
    def _entries(self) -> list[tuple[str, tuple[float, ...]]]:
        """Names and knots, none where a parameter is the same everywhere."""
        parted = [_parted(entry) for entry in self.entries]
        return [(name, () if knots is None else tuple(knots)) for name, knots in parted]

    def _spread(self, name: str, knots: Any) -> tuple[Array, list[str]]:
        """Return the weights (m, k) of a parameter's values over span, and their places' names."""
        if knots is None:
            return np.ones((1, len(self.eta))), [""]
        field = f"knots of {name}"
        if name in WHOLE:
            raise PerturbationError(f"{field}: {name} scales a whole distribution; leave them out")
        grid = numbers(knots, field, PerturbationError, "span fractions, such as [0.3, 0.6, 0.9]")
        right = grid.ndim == 1 and len(grid) and grid[0] >= 0.0 and grid[-1] <= 1.0
        if not right or not bool(np.all(np.diff(grid) > 0.0)):
            raise PerturbationError(
                f"{field}: got {shown(knots)}, must increase within 0 (root) to 1 (tip)"
            )
        places = [f" at {place:g}" for place in grid]
        if len(grid) == 1:
            return np.ones((1, len(self.eta))), places
        weights = clamped(grid, np.eye(len(grid)))(np.clip(self.eta, grid[0], grid[-1]))
        return np.ascontiguousarray(weights.T), places

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Their names, (p,): "pga[0]", "thickness", or with a place, "chord at 0.3"."""
        return tuple(column.name for column in self._columns)

    @property
    def modes(self) -> int:
        """The number of shape coordinates, r."""
        return 0 if self.space is None else self.space.dimension

    @cached_property
    def baseline(self) -> Array:
        """The values (p,) that change nothing."""
        return readonly([identity(column.base) for column in self._columns])

    @cached_property
    def lower(self) -> Array:
        """Lower bounds, (p,)."""
        return readonly([self._bounds(column)[0] for column in self._columns])

    @cached_property
    def upper(self) -> Array:
        """Upper bounds, (p,)."""
        return readonly([self._bounds(column)[1] for column in self._columns])

    def _bounds(self, column: "Column") -> tuple[float, float]:
        group = column.base.partition("[")[0]
        for name in (column.name, column.base, group):
            if name in self.bounds:
                given, must = self.bounds[name], "two numbers, (low, high)"
                pair = numbers(given, f"bounds: {name}", PerturbationError, must)
                if pair.shape != (2,):
                    raise PerturbationError(f"bounds: {name}: got {shown(given)}, must be {must}")
                return float(pair[0]), float(pair[1])
        if group == "pga" and self.space is not None:
            j = int(column.base[4:-1])
            return float(self.space.lower[j]), float(self.space.upper[j])
        return USUAL[group]

    @cached_property
    def quantities(self) -> tuple[str, ...]:
        """What amounts are of: the space's coordinates, then `AFFINE`."""
        return (*(f"pga[{j}]" for j in range(self.modes)), *AFFINE)

    @cached_property
    def places(self) -> tuple[int, ...]:
        """Which of the quantities each parameter is one of, (p,)."""
        return tuple(self.quantities.index(column.base) for column in self._columns)

    @cached_property
    def weights(self) -> Array:
        """How much each parameter counts at the spans, (p, k)."""
        return readonly([column.weight for column in self._columns])

    def over_span(self, x: Array) -> tuple[Coordinates, AffineChange]:
        """Return what `Blade.perturbed` needs for one vector (p,).

        Raises
        ------
        PerturbationError
            If a parameter is given at two sets of knots.
        """
        grids: dict[str, tuple[float, ...]] = {}
        for name, knots in self._entries:
            if grids.get(name) and knots:
                raise PerturbationError(f"parameters: {name} is given at two sets of knots")
            grids[name] = grids.get(name) or knots
        parts: dict[str, Any] = {}
        for name, knots in grids.items():
            values = self._at(x, name, np.array(knots or [0.0]))
            if name == "pga":
                parts[name] = Coordinates(np.array(knots or [0.0]), values, clamped)
            elif len(knots) > 1:
                parts[name] = Distribution(np.array(knots), values[:, 0], clamped)
            else:
                parts[name] = float(values[0, 0])
        t = parts.pop("pga", Coordinates.constant(()))
        return t, AffineChange(**parts)

    def _at(self, x: Array, name: str, eta: Array) -> Array:
        """Return a quantity, or all coordinates, at span fractions (m,): (m, 1) or (m, r)."""
        other = replace(self, eta=eta)
        start = [j for j, one in enumerate(self.quantities) if one.partition("[")[0] == name]
        amounts: Array = other.amounts(x[None])[0][:, start]
        return amounts

    def amounts(self, x: Array) -> Array:
        """Return the amounts (b, k, r + 7) of all quantities at the spans, of vectors x (b, p)."""
        start = np.array([identity(name) for name in self.quantities])
        result: Array = np.tile(start, (len(x), len(self.eta), 1))
        # a matrix product would round by how many variants there are
        for place, weight, column, rest in zip(
            self.places, self.weights, x.T, self.baseline, strict=True
        ):
            result[..., place] += (column - rest)[:, None] * weight
        return result


@dataclass(frozen=True)
class Column:
    """One parameter: what it is of, its name with its place, and its weights (k,) over span."""

    base: str
    name: str
    weight: Array


def _parted(entry: Any) -> tuple[Any, Any]:
    """Return a parameter's name and its knots, None if it has none."""
    if isinstance(entry, tuple | list) and len(entry) == 2:
        return entry[0], entry[1]
    return entry, None


def identity(name: str) -> float:
    """Return the amount of a quantity that changes nothing."""
    return 0.0 if name.startswith("pga") else float(IDENTITY.plain(name))
