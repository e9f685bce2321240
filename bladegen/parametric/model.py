"""`ParametricBlade`: a blade as a function of a vector of parameters, with exact derivatives.

Sections are those of `Blade.perturbed` at the same parameters.  Derivatives are derived by hand
(`section_slopes`): through the exponential map, unit chord, the rule for the relative thickness,
the chord line that is kept, the edge's finish and the section planes.

They exist but where a trailing edge reaches its least width, or 2 mm reach 1 % of the chord
(`blade.edges`): there one side's derivative is given.  A section with two noses far apart that is
made much thinner may have a chord line through either; where it changes to the other, sections
themselves jump (`airfoils.section_curves`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from bladegen.airfoils.chord_lines import KEPT, known_convention
from bladegen.blade.blade import Blade
from bladegen.blade.changes.window import Window
from bladegen.blade.outputs import at_least
from bladegen.blade.perturbation import Where
from bladegen.blade.spans import around, span_fractions
from bladegen.blade.variants.batch import Batch, SectionBatch
from bladegen.blade.variants.verdicts import strayed, unsound
from bladegen.errors import PerturbationError
from bladegen.parametric import outputs
from bladegen.parametric.chain import change_of
from bladegen.parametric.linearisation import Linearisation
from bladegen.parametric.outline import Outline
from bladegen.parametric.parameters import Parameters, by_name
from bladegen.parametric.quantities import Quantities
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arguments import instance, numbers, shown
from bladegen.support.arrays import Array, ArrayLike, Mask, readonly
from bladegen.support.threads import shares_of

__all__ = ["ParametricBlade"]

SPANS = 100


@dataclass(frozen=True, eq=False)
class ParametricBlade:
    """A blade as a differentiable function of parameters.

    Parameters
    ----------
    blade : Blade
        The baseline, its shape not perturbed.
    space : ShapeSpace, optional
        Modes of deformation, for the parameter "pga".
    parameters : sequence of str or (str, knots)
        "pga" is all coordinates of the space [rad]; others are those of `Blade.perturbed`:
        "thickness", "camber", "chord", "twist" [rad], "chord_scale", "twist_scale",
        "prebend_scale".  A pair such as ``("pga", [0.3, 0.6, 0.9])`` has values at span
        fractions, joined by a cubic spline that is level at its ends.
    eta : (k,) array, optional
        Span fractions of the sections; `Blade.stations(100)` by default.
    u : (n,) array, optional
        Landmark parameters of their points, from 0 to 1, symmetric about 0.5; the blade's by
        default.
    window : Window, optional
        Where shape, thickness, camber, chord and twist change; as for `Blade.perturbed`.
    chord_line : str
        What a change of shape does with the chord line: "kept" or "paper".
    bounds : mapping of str to (low, high), optional
        For `lower` and `upper`; by default those of the space's data for coordinates, and what
        the user's guide calls usual for others.

    Raises
    ------
    PerturbationError
        If a parameter is unknown, or the blade cannot be differentiated.

    Examples
    --------
    >>> import bladegen as bg
    >>> blade = bg.Blade.from_definition(bg.read("iea15mw"))
    >>> model = bg.ParametricBlade(blade, bg.ShapeSpace.bundled(), ("pga", "thickness"), eta=[0.8])
    >>> model.names
    ('pga[0]', 'pga[1]', 'pga[2]', 'pga[3]', 'thickness')
    >>> model.jacobian(model.baseline).shape
    (1, 401, 3, 5)
    """

    blade: Blade
    space: ShapeSpace | None = None
    parameters: Sequence[Any] = ("pga",)
    eta: Array = None  # type: ignore[assignment]
    u: Array | None = None
    window: Window = None  # type: ignore[assignment]
    chord_line: str = KEPT
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        must = "a Blade; bladegen.Blade.from_definition(bladegen.read('iea15mw')) makes one"
        instance(self.blade, Blade, "blade", must, PerturbationError)
        if self.blade.deformations:
            raise PerturbationError(
                "blade: its shape is perturbed already; make the model of the baseline, and start "
                "from the vector of the variant"
            )
        if self.blade.mirrored:
            raise PerturbationError("blade: is a mirror image; make the model of the blade")
        known_convention(self.chord_line)
        eta = at_least(self.blade, SPANS) if self.eta is None else span_fractions(self.eta)
        window = self.window or Window.beyond_circles(self.blade.definition.stations)
        instance(window, Window, "window", "a bladegen.Window(start, end)", PerturbationError)
        changed: dict[str, Any] = {"eta": readonly(eta.reshape(-1)), "window": window}
        if self.u is not None:
            places, kept = around(self.u)
            if not isinstance(kept, slice):
                raise PerturbationError("u: must run from 0 to 1 and be symmetric about 0.5")
            changed["u"] = readonly(places)
        if self.space is not None:
            must = "a ShapeSpace, such as bladegen.ShapeSpace.bundled()"
            instance(self.space, ShapeSpace, "space", must, PerturbationError)
            changed["space"] = self.space.at(self.blade.u)
        given = self.parameters
        changed["parameters"] = (given,) if isinstance(given, str) else tuple(given)
        for name, value in changed.items():
            object.__setattr__(self, name, value)
        self._known.names  # noqa: B018  # says at once what is unknown

    def __repr__(self) -> str:
        return (
            f"<ParametricBlade of {self.blade.name}: {len(self.eta)} sections, "
            f"{len(self.names)} parameters: {', '.join(self.names)}>"
        )

    @cached_property
    def _known(self) -> Parameters:
        return Parameters(tuple(self.parameters), self.space, self.eta, dict(self.bounds))

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters' names, (p,): "pga[0]", "thickness", or with a place "chord at 0.3"."""
        return self._known.names

    @property
    def baseline(self) -> Array:
        """The vector (p,) that changes nothing."""
        return self._known.baseline

    @property
    def lower(self) -> Array:
        """Lower bounds, (p,)."""
        return self._known.lower

    @property
    def upper(self) -> Array:
        """Upper bounds, (p,)."""
        return self._known.upper

    @cached_property
    def _batch(self) -> SectionBatch:
        return SectionBatch(self.blade, self.space, self.window, self.eta, self.chord_line)

    @cached_property
    def _outline(self) -> Outline:
        return Outline(self._batch, self.u)

    def _vectors(self, x: ArrayLike) -> tuple[Array, tuple[int, ...]]:
        """Return vectors as (b, p), and the shape (...) that they have."""
        values = numbers(by_name(x, self.names), "x", PerturbationError)
        self.require_shape(values.shape)
        if not bool(np.isfinite(values).all()):
            raise PerturbationError("x: must be finite")
        return values.reshape(-1, len(self.names)), values.shape[:-1]

    def require_shape(self, shape: tuple[int, ...]) -> None:
        """Raise if arrays of a shape are no vectors of this model's parameters."""
        count = len(self.names)
        if not shape or shape[-1] != count:
            raise PerturbationError(
                f"x: got an array of shape {shape}, must be {count} numbers or arrays "
                f"(..., {count}): {', '.join(self.names)}"
            )

    def _linear(self, x: ArrayLike) -> tuple[Linearisation, tuple[int, ...]]:
        vectors, lead = self._vectors(x)
        return Linearisation(self._outline, self._known, vectors), lead

    def _evaluated(self, vectors: Array, **how: Any) -> Batch:
        amounts, modes = self._known.amounts(vectors), self._known.modes
        how["shares"] = shares_of(len(vectors) * len(self.eta) * len(self.blade.u))
        return self._batch.evaluate(amounts[..., :modes], change_of(amounts, modes), **how)

    def sections(self, x: ArrayLike) -> Array:
        """Return sections (..., k, n, 3) [m] at vectors x (..., p), blade frame.

        They are those of `Blade.sections` of the perturbed blade, sound or not: see `valid`.
        """
        vectors, lead = self._vectors(x)
        if self.u is None:
            made = self._evaluated(vectors, tested=False).sections
        else:
            made = Linearisation(self._outline, self._known, vectors).sections()
        return made.reshape(*lead, *made.shape[1:])

    def variant(self, x: ArrayLike, *, name: str | None = None) -> Blade:
        """Return the blade at one vector (p,), to look at, to write or to perturb further.

        Its sections are the model's; nobody has tested them: see `valid`.
        """
        t, change = self._known.over_span(self.vector(x))
        space = self.space if t.values.size else None
        how: Where = {"window": self.window, "chord_line": self.chord_line}
        how["allow_extrapolation"] = True
        return self.blade.untested(space, t, change, name=name, **how)

    def jacobian(self, x: ArrayLike) -> Array:
        """Return derivatives (..., k, n, 3, p) of `sections` in the parameters."""
        linear, lead = self._linear(x)
        made = linear.jacobian()[1]
        return made.reshape(*lead, *made.shape[1:])

    def jvp(self, x: ArrayLike, dx: ArrayLike) -> Array:
        """Return derivatives (..., k, n, 3) of `sections` along directions dx (..., p)."""
        linear, lead = self._linear(x)
        ways, shape = (
            numbers(by_name(dx, self.names), "dx", PerturbationError),
            (*lead, len(self.names)),
        )
        if ways.shape not in (shape, shape[-1:]):
            raise PerturbationError(f"dx: got {shown(ways)}, must be of shape {shape}, as x")
        made = linear.jvp(np.broadcast_to(ways, shape).reshape(linear.x.shape))[1]
        return made.reshape(*lead, *made.shape[1:])

    def vjp(self, x: ArrayLike, g: ArrayLike) -> Array:
        """Return gradients (..., p) of what has gradients g (..., k, n, 3) in `sections`."""
        linear, lead = self._linear(x)
        points = len(self.blade.u if self.u is None else self.u)
        shape = (*lead, len(self.eta), points, 3)
        gradient = numbers(g, "g", PerturbationError)
        if gradient.shape != shape:
            raise PerturbationError(f"g: got {shown(gradient)}, must be of shape {shape}")
        made = linear.vjp(gradient.reshape(-1, *shape[-3:]))
        return made.reshape(*lead, -1)

    def at(self, eta: ArrayLike, u: Array | None = None) -> "ParametricBlade":
        """Return the model of sections at other span fractions and landmark parameters."""
        return replace(self, eta=span_fractions(eta), u=u)

    mesh, mesh_jacobian = outputs.mesh, outputs.mesh_jacobian
    grid, grid_jacobian = outputs.grid, outputs.grid_jacobian

    def vector(self, x: ArrayLike) -> Array:
        """Return one vector (p,), or say that it is none."""
        vectors, lead = self._vectors(x)
        if lead:
            raise PerturbationError(f"x: got {shown(x)}, must be one vector of {len(self.names)}")
        vector: Array = vectors[0]
        return vector

    def quantities(self, x: ArrayLike) -> Quantities:
        """Return quantities by name at vectors x (..., p), and their derivatives.

        ``quantities(x)["volume"]`` and ``quantities(x).jacobian("volume")``: see `Quantities`.
        """
        return Quantities(*self._linear(x))

    def valid(self, x: ArrayLike) -> Mask:
        """Tell which vectors (..., p) make sound sections within the space's data, (...)."""
        _, lead = self._vectors(x)
        result: Mask = np.array([not reason for reason in self._reasons(x)], dtype=bool)
        return result.reshape(lead)

    def faults(self, x: ArrayLike) -> list[str]:
        """Say what is wrong with each of the vectors (..., p) and where; "" if nothing is."""
        return self._reasons(x)

    def _reasons(self, x: ArrayLike) -> list[str]:
        vectors, _ = self._vectors(x)
        amounts, modes = self._known.amounts(vectors), self._known.modes
        t, change = amounts[..., :modes], change_of(amounts, modes)
        found = unsound(self._batch, *self._batch.tested(t, change))
        return [one or other for one, other in zip(strayed(self._batch, t), found, strict=True)]
