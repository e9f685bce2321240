"""A differentiable blade as a function that JAX differentiates through; families as data.

In: vectors of parameters x (..., p), float64.  Out: sections [m] and quantities by name.
`grad`, `vjp`, `jacrev`, `jit` and `vmap` work; forward mode and second derivatives do not.
Computed by NumPy on the host, called from where JAX runs.  `batches` gives a written family's
arrays on JAX's device.  The extra `jax` installs the library.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from bladegen.errors import MissingLibraryError, PerturbationError
from bladegen.families.dataset.loading import LoadedFamily
from bladegen.parametric.adapters.outputs import Outputs
from bladegen.parametric.model import ParametricBlade

try:
    import jax
except ImportError as error:
    raise MissingLibraryError(error) from None

__all__ = ["BladeFunction", "batches"]


@dataclass(frozen=True, eq=False)
class BladeFunction:
    """Outputs of a blade's parameters, as arrays by name.

    Parameters
    ----------
    model : ParametricBlade
        The blade.
    outputs : sequence of str
        "sections" or names of `Quantities`.

    Examples
    --------
    ``jax.grad(lambda x: BladeFunction(model, ("volume",))(x)["volume"])(model.baseline)``
    """

    model: ParametricBlade
    outputs: tuple[str, ...] = ("sections",)

    def __post_init__(self) -> None:
        object.__setattr__(self, "outputs", self._made.names)

    @cached_property
    def _made(self) -> Outputs:
        return Outputs(self.model, self.outputs)

    def __call__(self, x: Any) -> dict[str, Any]:
        """Return outputs (..., *shape) at x (..., p).

        Raises
        ------
        PerturbationError
            If JAX computes in single precision.
        """
        x = jax.numpy.asarray(x)
        if x.dtype != np.float64:
            off = "" if jax.config.jax_enable_x64 else ", and JAX's double precision is off"
            raise PerturbationError(
                f"x: got {x.dtype}, must be float64{off}; "
                "jax.config.update('jax_enable_x64', True) at the program's start"
            )
        return dict(zip(self.outputs, self._function(x), strict=True))

    @cached_property
    def _function(self) -> Any:
        """Outputs as a function of x that has its own rule for gradients."""
        made = self._made

        def results(x: Any) -> tuple[Any, ...]:
            shapes = (made.shapes[name] for name in made.names)
            return tuple(_shaped((*x.shape[:-1], *shape)) for shape in shapes)

        def values(x: Any) -> tuple[np.ndarray, ...]:
            return made.at(np.asarray(x)).values

        def gradient(x: Any, *given: Any) -> np.ndarray:
            return made.at(np.asarray(x)).vjp(tuple(np.asarray(part) for part in given))

        @jax.custom_vjp  # type: ignore[untyped-decorator]
        def function(x: Any) -> Any:
            return jax.pure_callback(values, results(x), x, vmap_method="broadcast_all")

        def back(x: Any, given: Any) -> Any:
            how = {"vmap_method": "broadcast_all"}
            return (jax.pure_callback(gradient, _shaped(x.shape), x, *given, **how),)

        function.defvjp(lambda x: (function(x), x), back)
        return function


def _shaped(shape: tuple[int, ...]) -> Any:
    return jax.ShapeDtypeStruct(shape, np.float64)


def batches(family: LoadedFamily, *given: Any, **how: Any) -> Iterator[dict[str, Any]]:
    """Give batches of a family's arrays as JAX arrays, by name: `LoadedFamily.batches`.

    The next batch is read while the device works on the one before: transfers are asynchronous.
    """
    for part in family.batches(*given, **how):
        yield {name: jax.device_put(values) for name, values in part.items()}
