"""Polars: lift, drag and moment coefficients of an airfoil over the angle of attack.

Angles in radians, -pi to pi where a polar is whole; the moment is about the quarter chord, nose up
positive.  bladegen computes no blade from polars; it keeps them, blends them between airfoils,
and says where they are from.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from bladegen.errors import DefinitionError
from bladegen.support.arrays import Array, readonly
from bladegen.support.values import brief, equal, hashed

__all__ = ["BORROWED", "ESTIMATED", "Polar", "blended"]

BORROWED = "of the baseline"  # how the source of such a polar begins, in files too
ESTIMATED = "estimate"  # and that of one that was estimated
FEWEST = 2
FIGURES = ("alpha", "cl", "cd", "cm")


@dataclass(frozen=True, eq=False, repr=False)
class Polar:
    """The coefficients of an airfoil at one Reynolds number.

    Parameters
    ----------
    alpha : (m,) array
        Angles of attack [rad], strictly increasing.
    cl, cd, cm : (m,) arrays
        Lift, drag and moment coefficients.
    reynolds : float, optional
        The Reynolds number, if it is known.
    configuration : str
        What the file calls the set, such as "default" or "clean".
    source : str
        Where the figures are from, in words.
    parameters : tuple of (name, value)
        Constants that windIO 2 states beside a polar (unsteady aerodynamics); kept as they are.
    """

    alpha: Array
    cl: Array
    cd: Array
    cm: Array
    reynolds: float | None = None
    configuration: str = "default"
    source: str = ""
    parameters: tuple[tuple[str, float], ...] = ()

    def __post_init__(self) -> None:
        for name in FIGURES:
            values = readonly(getattr(self, name))
            if values.ndim != 1 or len(values) != len(self.alpha) or len(values) < FEWEST:
                raise DefinitionError(
                    f"polar: {name} has shape {values.shape}, must be a list as long as alpha, of "
                    f"at least {FEWEST}"
                )
            if not np.isfinite(values).all():
                raise DefinitionError(f"polar: {name} holds a value that is not finite")
            object.__setattr__(self, name, values)
        if not np.all(np.diff(self.alpha) > 0):
            raise DefinitionError("polar: alpha must increase strictly")

    __eq__ = equal
    __hash__ = hashed
    __repr__ = brief

    @property
    def is_borrowed(self) -> bool:
        """Whether it is that of a baseline, kept for another shape."""
        return self.source.startswith(BORROWED)

    @property
    def is_estimate(self) -> bool:
        """Whether it was estimated, not measured or published."""
        return self.source.startswith(ESTIMATED)

    def has_figures_of(self, other: "Polar") -> bool:
        """Tell whether angles and coefficients are the same, whatever is said of them."""
        return self is other or all(
            np.array_equal(getattr(self, name), getattr(other, name)) for name in FIGURES
        )

    def at(self, alpha: Array) -> tuple[Array, Array, Array]:
        """Return lift, drag and moment at angles [rad], linear between the polar's own."""
        cl, cd, cm = (np.interp(alpha, self.alpha, part) for part in (self.cl, self.cd, self.cm))
        return cl, cd, cm


def blended(
    one: Sequence[Polar], other: Sequence[Polar], weight: float, source: str
) -> tuple[Polar, ...]:
    """Return polars between those of two airfoils, marked with a source.

    Parameters
    ----------
    one, other : sequence of Polar
        Of both airfoils.
    weight : float
        0 for the first, 1 for the second.
    source : str
        What the result says of itself.

    Returns
    -------
    tuple of Polar
        Pair by pair on both grids of angles united; where the airfoils have other sets than each
        other, those of the nearer one.  The Reynolds number is the nearer one's: WISDEM makes
        tables over every one that a file names, so that blended ones take its memory.
    """
    nearer = one if weight < 0.5 else other
    if [p.configuration for p in one] != [p.configuration for p in other]:
        return tuple(replace(polar, source=source) for polar in nearer)
    result = []
    for first, second, near in zip(one, other, nearer, strict=True):
        alpha = np.union1d(first.alpha, second.alpha)
        parts = [
            (1.0 - weight) * a + weight * b
            for a, b in zip(first.at(alpha), second.at(alpha), strict=True)
        ]
        result.append(
            replace(near, alpha=alpha, cl=parts[0], cd=parts[1], cm=parts[2], source=source)
        )
    return tuple(result)
