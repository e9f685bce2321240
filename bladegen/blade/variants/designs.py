"""Designs of experiments: which variants a family holds.

A design says for each variant where it lies along some factors: coordinates along the modes of
a shape space (t1, t2, ... in radians) and the affine parameters of `affine_change.AffineChange`.
Points of the unit cube (scipy.stats.qmc, or independent ones) are carried to a region: the box
between bounds, the ellipsoid that contains the data of a space, or the normal distribution with
the data's covariance.  Variant i depends on the seed and on i alone (with a Latin hypercube on
the count as well), whoever asks and in whatever order.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from bladegen.blade.changes.deformation import RANGES, in_units
from bladegen.blade.variants import draws
from bladegen.blade.variants.draws import Points, Seed, seed_of
from bladegen.blade.variants.factors import Factors, factors
from bladegen.errors import DesignError
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.shapes.statistics.distributions import Distribution
from bladegen.support.arguments import numbers, one_of, whole
from bladegen.support.arrays import Array, Indices, readonly

__all__ = ["DESIGNS", "Design", "tabulated"]

MOST = 10**7  # variants
MOST_LATIN = 10**6
Region = Callable[[Factors, Array], Array]


def _box(what: Factors, unit: Array) -> Array:
    return what.low + unit * (what.high - what.low)


def _ellipsoid(what: Factors, unit: Array) -> Array:
    """Carry points uniform in a cube to points uniform in the ellipsoid of the data.

    Normal deviates give the direction, and the distribution function of their length, which is
    that of chi, a radius whose r-th power is uniform.  What has no spread fills its box.
    """
    from scipy.special import chdtr, ndtri  # not scipy.stats, which takes a second to load

    result, shape = _box(what, unit), what.spread > 0
    r = int(np.count_nonzero(shape))
    if r:
        normal = ndtri(np.clip(unit[:, shape], 1e-15, 1 - 1e-15))
        squares = np.sum(normal**2, axis=1, keepdims=True)
        radius = chdtr(r, squares) ** (1.0 / r) / np.sqrt(squares)
        result[:, shape] = what.reach * radius * normal * what.spread[shape]
    return result


def _normal(what: Factors, unit: Array) -> Array:
    """Carry points of a cube to the normal distribution of the data; the rest fills its box."""
    from scipy.special import ndtri

    result, shape = _box(what, unit), what.spread > 0
    result[:, shape] = ndtri(np.clip(unit[:, shape], 1e-15, 1 - 1e-15)) * what.spread[shape]
    return result


DESIGNS: dict[str, tuple[str, Points, Region]] = {
    "sobol": ("Sobol points (scrambled) in the box of the bounds", draws.sobol, _box),
    "lhs": ("a Latin hypercube in the box", draws.latin, _box),
    "box": ("independent, uniform in the box", draws.independent, _box),
    "ellipsoid": (
        "independent, in the ellipsoid of the data",
        draws.independent,
        _ellipsoid,
    ),
    "normal": ("independent, with the data's covariance", draws.independent, _normal),
    "sweep": (
        "from corner to opposite corner of the box, each diagonal in turn",
        draws.corners,
        _box,
    ),
}
DISTRIBUTED = {  # designs that follow a distribution of the space's data, by its name
    "smallest": ("ellipsoid", "independent, in the smallest ellipsoid that holds the data"),
    "hull": ("hull", "independent, in the convex hull of the data"),
    "mixture": ("mixture", "independent, of normal distributions that overlap, by BIC"),
}
FIXED = ("sweep", "table")  # designs whose points are wanted as they are


@dataclass(frozen=True, eq=False)
class Design:
    """A plan of variants, each drawn when it is asked for: a plan of millions takes no memory.

    Parameters
    ----------
    what : Factors
        What varies.
    kind : str
        One of `DESIGNS`, or "table".
    seed : int
        Of the draws, not negative.
    count : int
        How many variants.
    table : (count, d) array, optional
        Where each variant of a "table" lies.
    distribution : Distribution, optional
        What coordinates of shape follow, as a share of them.
    share : float
        Of the distribution's coordinates.
    """

    what: Factors
    kind: str
    seed: int
    count: int
    table: Array | None = field(default=None, repr=False)
    distribution: Distribution | None = field(default=None, repr=False)
    share: float = 1.0

    def __repr__(self) -> str:
        names = ", ".join(self.what.names)
        return f"<Design of {self.count} variants: {self.kind}, seed {self.seed}, of {names}>"

    def __post_init__(self) -> None:
        if self.table is not None:
            object.__setattr__(self, "table", readonly(self.table))

    @classmethod
    def of(
        cls, what: Factors, kind: str, count: int, seed: Seed, space: ShapeSpace | None = None
    ) -> "Design":
        """Plan `count` variants; those that follow a distribution of data need their space.

        Raises
        ------
        DesignError
            If there is no such kind, or count or seed are out of range.
        """
        one_of(kind, DESIGNS | DISTRIBUTED, "design", DesignError)
        count = whole(count, "count", DesignError)
        if not 1 <= count <= MOST:
            raise DesignError(f"count: got {count}, allowed is 1 to {MOST}")
        if kind == "lhs" and count > MOST_LATIN:
            raise DesignError(
                f"count: got {count}, a Latin hypercube is drawn whole: allowed is 1 to "
                f"{MOST_LATIN}; sobol takes any number"
            )
        if kind not in DISTRIBUTED:
            return cls(what, kind, seed_of(seed), count)
        if space is None:
            raise DesignError(f"design: {kind!r} follows the data of a shape space; give one")
        distribution = space.distribution(DISTRIBUTED[kind][0])
        share = what.reach / space.extent
        return cls(what, kind, seed_of(seed), count, distribution=distribution, share=share)

    def __len__(self) -> int:
        return self.count

    def at(self, index: Indices) -> Array:
        """Return where variants lie, their first attempts, (b, d)."""
        if self.table is not None:
            return self.table[index]
        if self.distribution is not None:
            unit = draws.independent(index, self.count, len(self.what.names) + 1, self.seed)
            return self._distributed(unit)
        _, points, region = DESIGNS[self.kind]
        unit = points(np.asarray(index), self.count, len(self.what.names), self.seed)
        return region(self.what, unit)

    @property
    def values(self) -> Array:
        """Where all variants lie, first attempts, (count, d)."""
        return self.at(np.arange(self.count))

    @property
    def redraws(self) -> bool:
        """Whether a variant that is not sound may be drawn again."""
        return self.kind not in FIXED

    def redrawn(self, index: Indices, attempt: int | Indices) -> Array:
        """Return other values (m, d) of some variants: independent draws in the same region."""
        follows = self.distribution is not None
        dimension = len(self.what.names) + follows
        each = (some.tolist() for some in np.broadcast_arrays(index, attempt))
        unit = [draws.point(self.seed, i, a, dimension) for i, a in zip(*each, strict=True)]
        if follows:
            return self._distributed(np.stack(unit))
        return DESIGNS[self.kind][2](self.what, np.stack(unit))

    def _distributed(self, unit: Array) -> Array:
        """Carry points (m, d + 1) of a cube to where the distribution and bounds have them."""
        assert self.distribution is not None
        result, shape = _box(self.what, unit[:, :-1]), np.flatnonzero(self.what.spread > 0)
        of_data = [*range(self.distribution.dimension), -1]
        t = self.share * self.distribution.density.carried(unit[:, of_data])
        result[:, shape] = t[:, shape]  # coordinates come first among factors
        return result


def tabulated(space: ShapeSpace | None, columns: Mapping[str, Sequence[float] | Array]) -> Design:
    """Return the design that a table of the user's own lists.

    Parameters
    ----------
    space : ShapeSpace, optional
        Whose coordinates t1, t2, ... may be columns.
    columns : mapping of str to (count,) arrays
        Names of factors and their values; radians.

    Raises
    ------
    DesignError
        If a column is unknown, of another length, or not finite.
    """
    modes = 0 if space is None else space.dimension
    allowed = [*(f"t{j + 1}" for j in range(modes)), *RANGES]
    names = [name for name in allowed if name in columns]
    unknown = [name for name in columns if name not in allowed]
    if unknown or not names:
        given = unknown[0] if unknown else "no factor"
        raise DesignError(f"table: got {given!r}, allowed columns are {', '.join(allowed)}")
    lists = [numbers(columns[name], f"table: {name}", DesignError) for name in names]
    if len({column.shape for column in lists}) > 1 or lists[0].ndim != 1:
        lengths = ", ".join(f"{n}: {c.size}" for n, c in zip(names, lists, strict=True))
        raise DesignError(f"table: columns must be lists of one length, got {lengths}")
    values = np.stack(lists, axis=1)
    bad = np.argwhere(~np.isfinite(values))
    if bad.size:
        row, column = bad[0]
        raise DesignError(f"table: row {row + 1}, {names[column]}: must be a number")
    if not len(values):
        raise DesignError("table: holds no rows")
    for name, column in zip(names, values.T, strict=True):
        low, high = RANGES.get(name, (-np.inf, np.inf))
        wrong = np.flatnonzero((column < low) | (column > high))
        if wrong.size:
            raise DesignError(
                f"table: row {wrong[0] + 1}, {name}: got {in_units(name, column[wrong[0]])}, "
                f"allowed is {in_units(name, low)} to {in_units(name, high)}"
            )
    known = factors(space, {name: RANGES[name] for name in names if name in RANGES})
    at = [known.names.index(name) for name in names]
    what = Factors(tuple(names), known.low[at], known.high[at], known.spread[at], known.reach)
    return Design(what, "table", 0, len(values), values)
