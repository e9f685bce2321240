"""What a differentiable blade hands to other libraries: outputs by name, and their products.

An output is "sections" [m] or one of `Quantities`.  Products with derivatives of sections go
along the chain, so that no derivatives (k, n, 3, p) are kept.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from bladegen.errors import PerturbationError
from bladegen.parametric.model import ParametricBlade
from bladegen.parametric.quantities import Quantities
from bladegen.support.arguments import instance, one_of
from bladegen.support.arrays import Array

__all__ = ["FIRST_ONLY", "SECTIONS", "UNITS", "Evaluated", "Outputs", "follows"]

SECTIONS = "sections"
FIRST_ONLY = (
    "bladegen knows first derivatives only, and these are second ones; differences of exact "
    "gradients, or a method that needs none (L-BFGS, SLSQP), do instead"
)
UNITS = {  # as OpenMDAO spells them; the others have none
    "sections": "m",
    "volume": "m**3",
    "area": "m**2",
    "chord": "m",
    "twist": "rad",
    "section_area": "m**2",
    "section_centroid_x": "m",
    "section_centroid_y": "m",
    "section_inertia_xx": "m**4",
    "section_inertia_yy": "m**4",
    "section_inertia_xy": "m**4",
    "section_perimeter": "m",
}
PLANFORM = {  # the only kinds of parameter that such an output follows
    "chord": ("camber", "chord", "chord_scale"),
    "twist": ("twist", "twist_scale"),
    "relative_thickness": ("thickness", "camber", "chord"),
}
PLACING = ("twist", "twist_scale", "prebend_scale")  # no section changes in its own axes


def follows(output: str, kind: str) -> bool:
    """Tell whether an output can follow a kind of parameter, such as "pga"; "x" is all of them."""
    if output in PLANFORM and kind != "x":
        return kind in PLANFORM[output]
    return not (output.startswith("section_") and kind in PLACING)


@dataclass(frozen=True, eq=False)
class Outputs:
    """Outputs of a model, by name.

    Parameters
    ----------
    model : ParametricBlade
        The blade.
    names : sequence of str
        "sections", or names of `Quantities`.

    Raises
    ------
    PerturbationError
        If there is no such output.
    """

    model: ParametricBlade
    names: tuple[str, ...]

    def __post_init__(self) -> None:
        must = "a bladegen.ParametricBlade"
        instance(self.model, ParametricBlade, "model", must, PerturbationError)
        names = (self.names,) if isinstance(self.names, str) else tuple(self.names)
        if not names:
            raise PerturbationError("outputs: got none, must be names such as 'sections', 'volume'")
        for name in names:
            one_of(name, (SECTIONS, *self._baseline.quantities), "outputs", PerturbationError)
        object.__setattr__(self, "names", names)

    def __repr__(self) -> str:
        return f"<Outputs {', '.join(self.names)} of {self.model!r}>"

    def at(self, x: Array) -> "Evaluated":
        """Return the outputs at vectors x (..., p); the last ones are remembered.

        A gradient is asked for where values have just been.
        """
        x = np.ascontiguousarray(x, dtype=np.float64)
        return self._remembered(x.tobytes(), x.shape)

    @cached_property
    def _remembered(self) -> Callable[[bytes, tuple[int, ...]], "Evaluated"]:
        def made(data: bytes, shape: tuple[int, ...]) -> Evaluated:
            return Evaluated(self.model.quantities(np.frombuffer(data).reshape(shape)), self.names)

        return lru_cache(1)(made)

    @cached_property
    def _baseline(self) -> "Evaluated":
        return Evaluated(self.model.quantities(self.model.baseline), ())

    @cached_property
    def shapes(self) -> dict[str, tuple[int, ...]]:
        """Shapes of outputs at one vector."""
        return {name: self._baseline.value(name).shape for name in self.names}


@dataclass(frozen=True, eq=False)
class Evaluated:
    """Outputs at vectors x (..., p), prepared once."""

    quantities: Quantities
    names: tuple[str, ...]

    @property
    def values(self) -> tuple[Array, ...]:
        """All outputs, each (..., *shape)."""
        return tuple(self.value(name) for name in self.names)

    def value(self, name: str) -> Array:
        """Return an output (..., *shape)."""
        if name != SECTIONS:
            return self.quantities[name]
        made = self.quantities.linear.sections()
        return made.reshape(*self.quantities.lead, *made.shape[1:])

    def jacobian(self, name: str) -> Array:
        """Return derivatives (..., *shape, p) of an output."""
        if name != SECTIONS:
            return self.quantities.jacobian(name)
        made = self.quantities.linear.jacobian()[1]
        return made.reshape(*self.quantities.lead, *made.shape[1:])

    def jvp(self, dx: Array) -> tuple[Array, ...]:
        """Return derivatives of all outputs along directions dx (..., p)."""
        return tuple(self.along(name, dx) for name in self.names)

    def vjp(self, gradients: tuple[Array, ...]) -> Array:
        """Return gradients (..., p) of what has gradients (..., *shape) in all outputs."""
        pairs = zip(self.names, gradients, strict=True)
        result: Array = sum(self.back(name, g) for name, g in pairs)  # type: ignore[assignment]
        return result

    def along(self, name: str, dx: Array) -> Array:
        """Return derivatives (..., *shape) of an output along directions dx (..., p)."""
        linear, lead = self.quantities.linear, self.quantities.lead
        dx = np.broadcast_to(dx, (*lead, linear.x.shape[-1]))
        if name == SECTIONS:
            made = linear.jvp(dx.reshape(linear.x.shape))[1]
            return made.reshape(*lead, *made.shape[1:])
        jacobian = self.quantities.jacobian(name)
        between = (1,) * (jacobian.ndim - dx.ndim)
        result: Array = np.sum(jacobian * dx.reshape(*lead, *between, -1), axis=-1)
        return result

    def back(self, name: str, gradient: Array) -> Array:
        """Return gradients (..., p) of what has a gradient (..., *shape) in an output."""
        linear, lead = self.quantities.linear, self.quantities.lead
        if name == SECTIONS:
            made = linear.vjp(gradient.reshape(len(linear.x), *gradient.shape[-3:]))
            return made.reshape(*lead, -1)
        jacobian = self.quantities.jacobian(name)
        inner = tuple(range(len(lead), jacobian.ndim - 1))
        return np.asarray(np.sum(jacobian * gradient[..., None], axis=inner))
