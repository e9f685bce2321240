"""Consistent deformations of a blade: where they act, and what they do to shape and planform.

A `Deformation` carries one tangent vector of a shape space by parallel transport from the mean
to the blade's shape at each span and follows it there: inner products, and so normal
coordinates, are the same at every span ("Consistent blade deformations" of the paper).  An
`AffineChange` holds the paper's affine parameters, which move no point of the Grassmannian, and
scalings of the planform.  A `Window` says where along the span they act.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from bladegen.airfoils.chord_lines import KEPT, known_convention
from bladegen.definition.blade_definition import (
    BladeDefinition,
    Distribution,
    ReferenceAxis,
    Station,
    united,
)
from bladegen.errors import PerturbationError
from bladegen.shapes import grassmann
from bladegen.shapes.domain import BEYOND
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arguments import amount, numbers, shown
from bladegen.support.arrays import Array, ArrayLike, readonly

__all__ = [
    "RANGES",
    "AffineChange",
    "Coordinates",
    "Deformation",
    "Thickening",
    "Window",
    "deformation_of",
    "faded",
    "in_units",
]

ROUND = 0.02  # of the chord; an airfoil nearer to its circle than this is round
RAMP = 33  # span fractions that resolve a window's rise
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
class Window:
    """A weight over span: 0 up to `start`, 1 from `end` on, C2 between."""

    start: float = 0.0
    end: float = 0.0

    def __post_init__(self) -> None:
        start, end = (amount(edge, "window", PerturbationError) for edge in (self.start, self.end))
        if not 0.0 <= start <= end <= 1.0:
            raise PerturbationError(
                f"window: got {start:g} to {end:g}, must rise within 0 (root) to 1 (tip)"
            )

    @classmethod
    def beyond_circles(cls, stations: Sequence[Station]) -> "Window":
        """Rise from the last round station to the first lifting one; 1 all over without any."""
        lifting = [not _is_round(station) for station in stations]
        first = lifting.index(True) if True in lifting else len(stations) - 1
        if first == 0:
            return cls()
        return cls(stations[first - 1].eta, stations[first].eta)

    def __call__(self, eta: Array) -> Array:
        """Return the weight at span fractions `eta`."""
        if self.end == self.start:
            return np.where(eta >= self.end, 1.0, 0.0) if self.end > 0 else np.ones_like(eta)
        f = np.clip((eta - self.start) / (self.end - self.start), 0.0, 1.0)
        weight: Array = f**3 * (10.0 - 15.0 * f + 6.0 * f**2)
        return weight

    def with_ramp(self, grid: Array) -> Array:
        """Return a grid united with span fractions that resolve the rise."""
        return united(grid, np.linspace(self.start, self.end, RAMP))


def _is_round(station: Station) -> bool:
    """Tell whether an airfoil is a circle, whole or cut open at its edge."""
    points = station.airfoil.coordinates
    low, high = points.min(axis=0), points.max(axis=0)
    size = float(np.max(high - low))
    radius = np.linalg.norm(points - 0.5 * (low + high), axis=1)
    return bool(np.all(np.abs(radius - 0.5 * size) < ROUND * size))


@dataclass(frozen=True, eq=False)
class Coordinates:
    """Normal coordinates over span: the same everywhere, or monotone between knots.

    Parameters
    ----------
    grid : (m,) array
        Span fractions of the knots, increasing; one knot means the same everywhere.
    values : (m, r) array
        Coordinates there [rad]; the end values hold beyond.
    """

    grid: Array
    values: Array

    def __post_init__(self) -> None:
        what = "coordinates over span"
        grid = readonly(numbers(self.grid, what, PerturbationError))
        values = readonly(numbers(self.values, what, PerturbationError))
        if grid.ndim != 1 or values.ndim != 2 or len(grid) != len(values) or not len(grid):
            raise PerturbationError(
                f"coordinates over span: got {grid.shape} knots and {values.shape} values, must be "
                "m knots and m rows"
            )
        if not (np.all(np.diff(grid) > 0) and grid[0] >= 0 and grid[-1] <= 1):
            places = ", ".join(f"{place:g}" for place in grid)
            raise PerturbationError(
                f"coordinates over span: got knots at {places}, must increase within 0 (root) to 1 "
                "(tip)"
            )
        object.__setattr__(self, "grid", grid)
        object.__setattr__(self, "values", values)

    @classmethod
    def constant(cls, t: ArrayLike) -> "Coordinates":
        """The same coordinates (r,) everywhere."""
        values = numbers(t, "t", PerturbationError)
        if values.ndim > 1:
            raise PerturbationError(
                f"t: got {shown(values)}, must be as many numbers as the space has modes; "
                "bladegen.Coordinates(eta, values) holds others at other spans"
            )
        return cls(np.zeros(1), np.atleast_2d(values))

    def __call__(self, eta: Array) -> Array:
        """Return coordinates (k, r) at span fractions (k,)."""
        if len(self.grid) == 1:
            return np.broadcast_to(self.values, (len(eta), self.values.shape[1]))
        columns = [Distribution(self.grid, column)(eta) for column in self.values.T]
        return np.stack(columns, axis=-1)


@dataclass(frozen=True, eq=False)
class Deformation:
    """A consistent deformation of shapes.

    Parameters
    ----------
    space : ShapeSpace
        Mean and modes.
    t : Coordinates
        How far along each mode [rad].
    window : Window
        Where it acts.
    chord_line : str
        "kept": sections are turned and shifted in their plane until chord line and nose are
        those they had; "paper": they stay where the formula leaves them.
    """

    space: ShapeSpace
    t: Coordinates
    window: Window
    chord_line: str = KEPT

    def __call__(self, X: Array, eta: Array) -> Array:
        """Return deformed shapes (k, n, 2) of shapes X at span fractions (k,), bases joined."""
        return grassmann.exp(X, self.space.carried(self.step(eta), X))

    def step(self, eta: Array) -> Array:
        """Return by how much coordinates change at span fractions (k,), (k, r)."""
        return self.t(eta) * self.window(eta)[:, None]


def deformation_of(
    space: ShapeSpace | None,
    t: Coordinates,
    window: Window,
    u: Array,
    *,
    allow_extrapolation: bool = False,
    chord_line: str = KEPT,
) -> Deformation:
    """Return a deformation for shapes with landmarks at `u`, or say why there is none.

    Raises
    ------
    PerturbationError
        If there is no space, or `t` leaves its data's range.
    SpaceError
        If the space cannot be evaluated at these landmarks.
    """
    if space is None:
        raise PerturbationError("t: coordinates need a shape space, such as ShapeSpace.bundled()")
    if t.values.shape[1] != space.dimension:
        raise PerturbationError(
            f"t: got {t.values.shape[1]} coordinates (--pga), the space has {space.dimension} "
            f"modes: give t1 to t{space.dimension}, 0 where one shall stay"
        )
    beyond = space.outside(t.values)
    if beyond and not allow_extrapolation:
        raise PerturbationError(f"{beyond}; {BEYOND}")
    return Deformation(space.at(u), t, window, known_convention(chord_line))


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
        offset = definition.section_offset_y
        axis = definition.axis
        return replace(
            definition,
            chord=scaled(definition.chord, widening, whole),
            twist=twist,
            section_offset_y=None if offset is None else scaled(offset, widening, whole),
            axis=ReferenceAxis(scaled(axis.x, 1.0, float(self.prebend_scale)), axis.y, axis.z),
        )


@dataclass(frozen=True, eq=False)
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
