"""The paper's affine parameters, and scalings of the planform: they move no shape.

An `AffineChange` changes a definition's chord, twist, offsets and axis, within a window where the
paper's maps act; what it does to the relative thickness is a factor over span, a `Thickening`.
"""

from dataclasses import dataclass, fields, replace

import numpy as np

from bladegen.blade.window import Window
from bladegen.definition.blade_definition import BladeDefinition, Distribution, ReferenceAxis
from bladegen.errors import PerturbationError
from bladegen.support.arguments import numbers
from bladegen.support.arrays import Array, ArrayLike

__all__ = ["RANGES", "AffineChange", "Thickening", "faded", "in_units"]

Amount = float | Array
RANGES = {
    "thickness": (0.2, 5.0),
    "camber": (0.2, 1.8),
    "chord": (0.2, 5.0),
    "twist": (-np.pi / 4, np.pi / 4),  # a degree that is given for a radian leaves it
    "chord_scale": (0.2, 5.0),
    "twist_scale": (-5.0, 5.0),
    "prebend_scale": (-5.0, 5.0),
}


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
    and relative thickness is exact, and no point of the Grassmannian moves.  Each is a number,
    or one a variant where many are made at once (`batch`).

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
    """

    thickness: Amount = 1.0
    camber: Amount = 1.0
    chord: Amount = 1.0
    twist: Amount = 0.0
    chord_scale: Amount = 1.0
    twist_scale: Amount = 1.0
    prebend_scale: Amount = 1.0

    def __post_init__(self) -> None:
        for name, (low, high) in RANGES.items():
            values = np.atleast_1d(numbers(getattr(self, name), name, PerturbationError))
            outside = values[~((low <= values) & (values <= high))]
            if outside.size:
                raise PerturbationError(
                    f"{name}: got {in_units(name, outside[0])}, allowed is "
                    f"{in_units(name, low)} to {in_units(name, high)}"
                )

    def changed(self) -> dict[str, float]:
        """Return the parameters that are not the identity."""
        return {
            entry.name: getattr(self, entry.name)
            for entry in fields(self)
            if getattr(self, entry.name) != entry.default
        }

    @property
    def widening(self) -> Amount:
        """The factor along the chord of the three diagonal maps."""
        return (2.0 - self.camber) * self.chord

    @property
    def thickening(self) -> Amount:
        """The factor of the relative thickness of the three diagonal maps."""
        return self.thickness * self.camber / self.widening

    def applied(self, definition: BladeDefinition, window: Window) -> BladeDefinition:
        """Return a definition with chord, twist, offsets and axis changed.

        Between grid points the change is that of the window, exactly; offsets in metres follow
        the chord.
        """

        def scaled(
            quantity: Distribution, factor: float, whole: float = 1.0, shift: float = 0.0
        ) -> Distribution:
            if whole != 1.0:
                quantity = replace(quantity, values=whole * quantity.values)
            if factor == 1.0 and shift == 0.0:
                return quantity
            changed = Faded(quantity, window, factor, shift)
            grid = window.with_ramp(quantity.grid)
            return replace(quantity, grid=grid, values=changed(grid), spline=changed.as_spline)

        widening, whole = float(self.widening), float(self.chord_scale)
        twist = scaled(definition.twist, 1.0, float(self.twist_scale), float(self.twist))
        offset, axis = definition.section_offset_y, definition.axis
        prebend = scaled(axis.x, 1.0, float(self.prebend_scale))
        return replace(
            definition,
            chord=scaled(definition.chord, widening, whole),
            twist=twist,
            section_offset_y=None if offset is None else scaled(offset, widening, whole),
            axis=axis if prebend is axis.x else ReferenceAxis(prebend, axis.y, axis.z),
        )


@dataclass(frozen=True)
class Faded:
    """A distribution times a factor, plus a shift, both faded in by a window."""

    base: Distribution
    window: Window
    factor: float
    shift: float

    def __call__(self, eta: ArrayLike, nu: int = 0) -> Array:
        """Return the quantity at span fractions; derivatives are not needed and not there."""
        if nu:
            raise PerturbationError("derivatives of a windowed distribution are not defined")
        at = np.asarray(eta, dtype=np.float64)
        weight = self.window(at)
        return faded(self.base(at), weight, self.factor, self.shift)

    def as_spline(self, _grid: Array, _values: Array) -> "Faded":
        """Stand in for the spline through a grid of its values."""
        return self


def faded(values: Array, weight: Array, factor: Amount, shift: Amount = 0.0) -> Array:
    """Return values times a factor, plus a shift, both faded in by a weight."""
    result: Array = values * (1.0 + weight * (factor - 1.0)) + weight * shift
    return result


@dataclass(frozen=True)
class Thickening:
    """A windowed factor of the relative thickness over span."""

    factor: float
    window: Window

    def __call__(self, eta: Array) -> Array:
        return faded(np.ones_like(eta), self.window(eta), self.factor)
