"""The paper's affine parameters, and scalings of the planform: they move no shape.

An `AffineChange` changes a definition's chord, twist, offsets and axis, within a window where the
paper's maps act; what it does to the relative thickness is a factor over span, a `Thickening`.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from bladegen.blade.changes.window import Window
from bladegen.definition.blade_definition import (
    BladeDefinition,
    Distribution,
    ReferenceAxis,
    united,
)
from bladegen.errors import PerturbationError
from bladegen.support.arguments import numbers
from bladegen.support.arrays import Array, ArrayLike

__all__ = ["RANGES", "WHOLE", "AffineChange", "Thickening", "faded", "in_units"]

Amount = float | Array | Distribution
WHOLE = ("chord_scale", "twist_scale", "prebend_scale")  # of whole distributions
RANGES = {
    "thickness": (0.2, 5.0),
    "camber": (0.2, 1.8),
    "chord": (0.2, 5.0),
    "twist": (-np.pi / 4, np.pi / 4),  # a degree that is given for a radian leaves it
    "chord_scale": (0.2, 5.0),
    "twist_scale": (-5.0, 5.0),
    "prebend_scale": (-5.0, 5.0),
}


Rule = float | Callable[[Array], Array]  # a number, or a function of span
RESOLVED = 33  # span fractions that resolve a parameter over span


def in_units(name: str, value: float) -> str:
    """Return the value of a parameter of `AffineChange` with its units, angles in both.

    >>> in_units("thickness", 1.05), in_units("twist", 1.0)
    ('1.05', '1 rad (57.3 deg)')
    """
    return f"{value:.4g} rad ({np.degrees(value):.3g} deg)" if name == "twist" else f"{value:.4g}"


@dataclass(frozen=True)
class AffineChange:
    """The paper's affine parameters and scalings of the planform; identity by default.

    The first four act within the window, through the maps of the paper; their effect on chord
    and relative thickness is exact, and no point of the Grassmannian moves.  Each is a number, a
    `Distribution` of it over span, or one a variant where many are made at once (`batch`).

    Parameters
    ----------
    thickness : float
        diag(1, s): thickness times s; 1 is the identity, 0.8 to 1.2 is usual.
    camber : float
        diag(2 - s, s), the paper's 2 diag(1 - s/2, s/2): chord against thickness and camber;
        identity at 1, 0.9 to 1.1 is usual.
    chord : float
        diag(s, 1): chord times s at the same thickness in metres; 1 is the identity.
    twist : float
        A turn of the sections [rad], leading edge upwind positive; 0 is the identity.
    chord_scale, twist_scale, prebend_scale : float
        Factors of the whole distributions; 1 is the identity.
    prebend : Distribution, optional
        What is added to the prebend, after its factor [m], along the whole span.
    """

    thickness: Amount = 1.0
    camber: Amount = 1.0
    chord: Amount = 1.0
    twist: Amount = 0.0
    chord_scale: Amount = 1.0
    twist_scale: Amount = 1.0
    prebend_scale: Amount = 1.0
    prebend: Distribution | None = None

    def __post_init__(self) -> None:
        if not (self.prebend is None or isinstance(self.prebend, Distribution)):
            raise PerturbationError(
                f"prebend: got {self.prebend!r}, must be a bladegen.Distribution of what is added "
                "over span [m]; prebend_scale is a factor"
            )
        for name, (low, high) in RANGES.items():
            given = getattr(self, name)
            if isinstance(given, Distribution) and name in WHOLE:
                raise PerturbationError(
                    f"{name}: got {given!r}, must be a number: it scales a whole distribution"
                )
            plain = given.values if isinstance(given, Distribution) else given
            values = np.atleast_1d(numbers(plain, name, PerturbationError))
            outside = values[~((low <= values) & (values <= high))]
            if outside.size:
                raise PerturbationError(
                    f"{name}: got {in_units(name, outside[0])}, allowed is "
                    f"{in_units(name, low)} to {in_units(name, high)}"
                )

    def changed(self) -> dict[str, Any]:
        """Return the parameters that are not the identity; those over span as lists."""
        amounts = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        return {
            entry.name: _listed(amounts[entry.name])
            for entry in fields(self)
            if isinstance(amounts[entry.name], Distribution) or amounts[entry.name] != entry.default
        }

    @property
    def over_span(self) -> tuple[Distribution, ...]:
        """The parameters of the window that are distributions."""
        own = (getattr(self, name) for name in RANGES)
        return tuple(amount for amount in own if isinstance(amount, Distribution))

    def at(self, eta: Array) -> "AffineChange":
        """Return the parameters at span fractions (k,)."""
        amounts = {key: getattr(self, key) for key in RANGES}
        own: Any = {key: a(eta) for key, a in amounts.items() if isinstance(a, Distribution)}
        return replace(self, **own) if own else self

    def plain(self, name: str) -> float | Array:
        """Return a parameter that is no distribution."""
        amount: float | Array = getattr(self, name)
        return amount

    @property
    def widening(self) -> float | Array:
        """The factor along the chord of the three diagonal maps; of parameters `at` spans."""
        return (2.0 - self.plain("camber")) * self.plain("chord")

    @property
    def thickening(self) -> float | Array:
        """The factor of the relative thickness of the three diagonal maps."""
        return self.plain("thickness") * self.plain("camber") / self.widening

    def rule(self, name: str) -> "Rule":
        """Return "widening", "thickening" or a parameter, a number or a function of span."""
        if self.over_span:
            return lambda eta: np.broadcast_to(getattr(self.at(eta), name), np.shape(eta))
        return float(getattr(self, name))

    def applied(self, definition: BladeDefinition, window: Window) -> BladeDefinition:
        """Return a definition with chord, twist, offsets and axis changed.

        Between grid points the change is that of the window, exactly; offsets in metres follow
        the chord.
        """

        def scaled(
            quantity: Distribution, factor: Rule, whole: float = 1.0, shift: Rule = 0.0
        ) -> Distribution:
            if whole != 1.0:
                quantity = replace(quantity, values=whole * quantity.values)
            if factor == 1.0 and shift == 0.0:
                return quantity
            changed = Faded(quantity, window, factor, shift)
            grid = window.with_ramp(quantity.grid)
            for amount in self.over_span:
                grid = united(grid, np.linspace(amount.grid[0], amount.grid[-1], RESOLVED))
            return replace(quantity, grid=grid, values=changed(grid), spline=changed.as_spline)

        widening, whole = self.rule("widening"), float(self.plain("chord_scale"))
        twist = scaled(definition.twist, 1.0, float(self.plain("twist_scale")), self.rule("twist"))
        offset, axis = definition.section_offset_y, definition.axis
        prebend = scaled(axis.x, 1.0, float(self.plain("prebend_scale")))
        if self.prebend is not None:
            prebend = raised(prebend, self.prebend)
        return replace(
            definition,
            chord=scaled(definition.chord, widening, whole),
            twist=twist,
            section_offset_y=None if offset is None else scaled(offset, widening, whole),
            axis=axis if prebend is axis.x else ReferenceAxis(prebend, axis.y, axis.z),
        )


def raised(quantity: Distribution, added: Distribution) -> Distribution:
    """Return the sum of two distributions, exact between grid points, too."""
    grid = united(quantity.grid, np.linspace(added.grid[0], added.grid[-1], RESOLVED))
    both = Raised(quantity, added)
    return replace(quantity, grid=grid, values=both(grid), spline=both.as_spline)


@dataclass(frozen=True)
class Raised:
    """A distribution plus another one, with its derivatives."""

    base: Distribution
    added: Distribution

    def __call__(self, eta: ArrayLike, nu: int = 0) -> Array:
        result: Array = self.base(eta, nu) + self.added(eta, nu)
        return result

    def as_spline(self, _grid: Array, _values: Array) -> "Raised":
        """Stand in for the spline through a grid of its values."""
        return self


@dataclass(frozen=True)
class Faded:
    """A distribution times a factor, plus a shift, both faded in by a window."""

    base: Distribution
    window: Window
    factor: Rule
    shift: Rule

    def __call__(self, eta: ArrayLike, nu: int = 0) -> Array:
        """Return the quantity at span fractions; derivatives are not needed and not there."""
        if nu:
            raise PerturbationError("derivatives of a windowed distribution are not defined")
        at = np.asarray(eta, dtype=np.float64)
        weight = self.window(at)
        return faded(self.base(at), weight, ruled(self.factor, at), ruled(self.shift, at))

    def as_spline(self, _grid: Array, _values: Array) -> "Faded":
        """Stand in for the spline through a grid of its values."""
        return self


def faded(values: Array, weight: Array, factor: float | Array, shift: float | Array = 0.0) -> Array:
    """Return values times a factor, plus a shift, both faded in by a weight."""
    result: Array = values * (1.0 + weight * (factor - 1.0)) + weight * shift
    return result


@dataclass(frozen=True)
class Thickening:
    """A windowed factor of the relative thickness over span."""

    factor: Rule
    window: Window

    def __call__(self, eta: Array) -> Array:
        return faded(np.ones_like(eta), self.window(eta), ruled(self.factor, eta))


def ruled(rule: Rule, eta: Array) -> float | Array:
    """Return a number, or what a function of span gives at span fractions (k,)."""
    return rule(eta) if callable(rule) else rule


def _listed(amount: Amount) -> Any:
    if isinstance(amount, Distribution):
        return {"at_eta": amount.grid.tolist(), "values": amount.values.tolist()}
    return amount
