"""A differentiable blade as a function that JAX differentiates through; families as data.

In: vectors of parameters x (..., p), float64.  Out: sections [m] and quantities by name.
`grad`, `jvp`, `vjp`, `jacfwd`, `jacrev`, `jit` and `vmap` work; second derivatives do not.
Computed by NumPy on the host, called from where JAX runs.  `batches` gives a written family's
arrays on JAX's device.  The extra `jax` installs the library.

Products with first derivatives are two primitives, each the other's transpose: a rule for
gradients alone (`jax.custom_vjp`) would rule out forward mode.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from bladegen.errors import FamilyError, MissingLibraryError, PerturbationError
from bladegen.families.dataset.loading import LoadedFamily
from bladegen.families.dataset.reading import named, of_numbers
from bladegen.parametric.adapters.outputs import FIRST_ONLY, Outputs
from bladegen.parametric.model import ParametricBlade
from bladegen.support.arguments import instance

try:
    import jax
    from jax.extend.core import Primitive
    from jax.interpreters import ad, batching, mlir
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
            If JAX computes in single precision, or x is not what the model takes.  What is wrong
            with numbers that are not known yet, under `jit` and `grad`, JAX says, with our error
            at the end.
        """
        x = jax.numpy.asarray(x)
        if x.dtype != np.float64:
            off = "" if jax.config.jax_enable_x64 else ", and JAX's double precision is off"
            raise PerturbationError(
                f"x: got {x.dtype}, must be float64{off}; "
                "jax.config.update('jax_enable_x64', True) at the program's start"
            )
        self.model.require_shape(x.shape)
        if not isinstance(x, jax.core.Tracer):
            self._made.at(np.asarray(x)).values  # noqa: B018  # says what is wrong; remembered
        return dict(zip(self.outputs, self._function(x), strict=True))

    @cached_property
    def _function(self) -> Any:
        """Outputs as a function of x that has its own rule for derivatives."""
        made = self._made

        def values(x: Any) -> tuple[np.ndarray, ...]:
            return made.at(np.asarray(x)).values

        @jax.custom_jvp  # type: ignore[untyped-decorator]
        def function(x: Any) -> Any:
            return jax.pure_callback(values, _results(made, x), x, vmap_method="broadcast_all")

        @function.defjvp  # type: ignore[untyped-decorator]
        def _(at: Any, along: Any) -> Any:
            return function(*at), tuple(_ALONG.bind(*at, *along, made=made))

        return function


def _shaped(shape: tuple[int, ...]) -> Any:
    return jax.ShapeDtypeStruct(shape, np.float64)


def _results(made: Outputs, x: Any) -> tuple[Any, ...]:
    return tuple(_shaped((*x.shape[:-1], *made.shapes[name])) for name in made.names)


def _along(x: Any, dx: Any, *, made: Outputs) -> Any:
    """Derivatives of all outputs along dx (..., p)."""

    def found(x: Any, dx: Any) -> tuple[np.ndarray, ...]:
        return made.at(np.asarray(x)).jvp(np.asarray(dx))

    return jax.pure_callback(found, _results(made, x), x, dx)


def _back(x: Any, *given: Any, made: Outputs) -> Any:
    """The gradient (..., p) of what has given gradients in all outputs."""

    def found(x: Any, *given: Any) -> tuple[np.ndarray, ...]:
        return (made.at(np.asarray(x)).vjp(tuple(np.asarray(part) for part in given)),)

    return jax.pure_callback(found, (_shaped(x.shape),), x, *given)


def _primitive(name: str, function: Any, results: Any) -> Any:
    """A product of first derivatives at x: linear in all but x, in which it cannot be derived."""
    made = Primitive(name)
    made.multiple_results = True
    made.def_impl(function)
    made.def_abstract_eval(
        lambda x, *_, **how: [jax.core.ShapedArray(s.shape, s.dtype) for s in results(x, **how)]
    )
    mlir.register_lowering(made, mlir.lower_fun(function, multiple_results=True))

    def batched(given: Any, places: Any, **how: Any) -> Any:
        pairs = list(zip(given, places, strict=True))
        size = next(part.shape[place] for part, place in pairs if place is not None)
        ahead = [
            jax.numpy.broadcast_to(part, (size, *part.shape))
            if place is None
            else jax.numpy.moveaxis(part, place, 0)
            for part, place in pairs
        ]
        found = made.bind(*ahead, **how)
        return found, [0] * len(found)

    def along(at: Any, ways: Any, **how: Any) -> Any:
        if not isinstance(ways[0], ad.Zero):
            raise PerturbationError(FIRST_ONLY)
        ways = [ad.instantiate_zeros(way) for way in ways[1:]]
        return made.bind(*at, **how), made.bind(at[0], *ways, **how)

    batching.primitive_batchers[made] = batched
    ad.primitive_jvps[made] = along
    return made


_ALONG = _primitive("bladegen_along", _along, lambda x, *, made: _results(made, x))
_BACK = _primitive("bladegen_back", _back, lambda x, *, made: (_shaped(x.shape),))  # noqa: ARG005


def _transposed(other: Any, given: Any, x: Any, *_: Any, made: Outputs) -> Any:
    found = other.bind(x, *(ad.instantiate_zeros(part) for part in given), made=made)
    return [None, *found]


ad.primitive_transposes[_ALONG] = partial(_transposed, _BACK)
ad.primitive_transposes[_BACK] = partial(_transposed, _ALONG)


def batches(family: LoadedFamily, *given: Any, **how: Any) -> Iterator[dict[str, Any]]:
    """Give batches of a family's arrays as JAX arrays, by name: `LoadedFamily.batches`.

    The next batch is read while the device works on the one before: transfers are asynchronous.
    """
    must = "a LoadedFamily; bladegen.load_family(path) opens one"
    instance(family, LoadedFamily, "family", must, FamilyError)
    names = given[0] if given else how.get("names", ("parameters", "sections"))
    of_numbers(family, named(family, names))
    return _put(family.batches(*given, **how))


def _put(parts: Iterator[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    for part in parts:
        yield {name: jax.device_put(values) for name, values in part.items()}
