"""Consistent deformations of a blade: where they act, and what they do to shape and planform.

A `Deformation` carries one tangent vector of a shape space by parallel transport from the mean
to the blade's shape at each span and follows it there: inner products, and so normal
coordinates, are the same at every span ("Consistent blade deformations" of the paper).  The
paper's affine parameters are an `affine_change.AffineChange`; a `window.Window` says where along
the span they act.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.airfoils.chord_lines import KEPT, known_convention
from bladegen.blade.changes.affine_change import RANGES, AffineChange, Thickening, faded, in_units
from bladegen.blade.changes.displacement import factors
from bladegen.blade.changes.window import Window
from bladegen.definition.blade_definition import Distribution, Interpolant, pchip
from bladegen.errors import PerturbationError
from bladegen.shapes import grassmann
from bladegen.shapes.domain import BEYOND
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arguments import amount, numbers, shown
from bladegen.support.arrays import Array, ArrayLike, readonly
from bladegen.support.values import brief, equal, hashed

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


@dataclass(frozen=True, eq=False, repr=False)
class Coordinates:
    """Normal coordinates over span: the same everywhere, or monotone between knots.

    Parameters
    ----------
    grid : (m,) array
        Span fractions of the knots, increasing; one knot means the same everywhere.
    values : (m, r) array
        Coordinates there [rad]; the end values hold beyond.
    spline : callable, optional
        Joins them, as that of a `Distribution`: PCHIP by default.
    """

    grid: Array
    values: Array
    spline: Callable[[Array, Array], Interpolant] = pchip

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

    __eq__ = equal
    __hash__ = hashed

    def __repr__(self) -> str:
        if len(self.grid) == 1:
            return f"<Coordinates t = {', '.join(f'{one:.4g}' for one in self.values[0])}>"
        spans = f"{len(self.grid)} spans from eta = {self.grid[0]:.3g} to {self.grid[-1]:.3g}"
        return f"<Coordinates of {self.values.shape[1]} modes at {spans}>"

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

    @classmethod
    def displacing(
        cls,
        blade: Any,
        space: ShapeSpace,
        t: ArrayLike,
        displacement: float,
        *,
        each: bool = False,
        window: Window | None = None,
        chord_line: str = KEPT,
        spans: int = 41,
    ) -> "Coordinates":
        """Scale coordinates so that they move a blade's skin by a stated length.

        |t| is an angle: the same t moves thick sections by more of their chord than thin ones.

        Parameters
        ----------
        blade : Blade
            What is to be perturbed.
        space, t : ShapeSpace and (r,) array
            The modes, and coordinates of which the direction counts.
        displacement : float
            The farthest that a point of a section moves along its normal [chord].
        each : bool
            Move each section so far, by coordinates that vary over span; if not, one multiple
            of t for the whole blade moves that section so far which moves farthest.
        window, chord_line : Window, str
            As for `Blade.perturbed`; sections are looked at where the window acts fully.
        spans : int
            How many are looked at.

        Raises
        ------
        PerturbationError
            If no multiple of t does that.

        >>> import bladegen as bg
        >>> blade = bg.Blade.from_definition(bg.read("nrel5mw"))
        >>> space = bg.ShapeSpace.bundled()
        >>> t = bg.Coordinates.displacing(blade, space, [1, 0, 0, 0], 0.005)
        >>> blade.perturbed(space, t).name
        'nrel5mw'
        """
        if not amount(displacement, "displacement", PerturbationError) > 0.0:
            raise PerturbationError(
                f"displacement: got {displacement:g}, must be above 0, in chords; the sign is t's"
            )
        own = Window.beyond_circles(blade.definition.stations) if window is None else window
        eta = blade.stations(spans)
        eta = eta[own(eta) >= 1.0]
        constant = cls.constant(t)
        direction = cls(eta, np.repeat(constant.values, len(eta), axis=0))
        how: dict[str, Any] = {"window": window, "chord_line": chord_line}
        scale = factors(blade, space, direction, displacement, together=not each, **how)
        if not each:
            return cls.constant(scale[0] * constant.values[0])
        return cls(eta, scale[:, None] * direction.values)

    def __call__(self, eta: Array) -> Array:
        """Return coordinates (k, r) at span fractions (k,)."""
        if len(self.grid) == 1:
            return np.broadcast_to(self.values, (len(eta), self.values.shape[1]))
        columns = [Distribution(self.grid, column, self.spline)(eta) for column in self.values.T]
        return np.stack(columns, axis=-1)


@dataclass(frozen=True, repr=False)
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

    __repr__ = brief

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
