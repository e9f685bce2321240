"""A differentiable blade as a function that PyTorch differentiates through; families as data.

In: vectors of parameters x (..., p), float64.  Out: sections [m] and quantities by name.
Gradients (`backward`, `torch.func.grad`), forward mode (`jvp`) and `vmap` work; second
derivatives are not known.  Computed on the CPU.  `FamilyDataset` is a written family as a
`torch.utils.data.Dataset`.  The extra `torch` installs the library.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from bladegen.errors import FamilyError, MissingLibraryError, PerturbationError
from bladegen.families.dataset.loading import LoadedFamily
from bladegen.families.dataset.reading import arrays_at, chosen, named, of_numbers
from bladegen.parametric.adapters.outputs import FIRST_ONLY, Evaluated, Outputs
from bladegen.parametric.model import ParametricBlade
from bladegen.support.arguments import instance

try:
    import torch
    from torch.autograd import Function
    from torch.utils.data import Dataset
except ImportError as error:
    raise MissingLibraryError(error) from None

__all__ = ["BladeFunction", "FamilyDataset"]


@dataclass(frozen=True, eq=False)
class BladeFunction:
    """Outputs of a blade's parameters, as tensors by name.

    Parameters
    ----------
    model : ParametricBlade
        The blade.
    outputs : sequence of str
        "sections" or names of `Quantities`.

    Examples
    --------
    ``BladeFunction(model, ("volume",))(x)["volume"].backward()``
    """

    model: ParametricBlade
    outputs: tuple[str, ...] = ("sections",)

    def __post_init__(self) -> None:
        object.__setattr__(self, "outputs", self._made.names)

    @cached_property
    def _made(self) -> Outputs:
        return Outputs(self.model, self.outputs)

    @torch.compiler.disable  # type: ignore[untyped-decorator]  # NumPy computes what it returns
    def __call__(self, x: Any) -> dict[str, Any]:
        """Return outputs (..., *shape) at a tensor x (..., p).

        Raises
        ------
        PerturbationError
            If x is not of type float64.
        """
        if not isinstance(x, torch.Tensor) or x.dtype != torch.float64:
            kind = x.dtype if isinstance(x, torch.Tensor) else type(x).__name__
            raise PerturbationError(
                f"x: got {kind}, must be a tensor of type torch.float64; "
                "torch.as_tensor(x).double() makes one"
            )
        return dict(zip(self.outputs, _Values.apply(self._made, x), strict=True))


def _at(made: Outputs, x: Any) -> Evaluated:
    return made.at(x.detach().cpu().numpy())


def _tensors(arrays: tuple[Any, ...], like: Any) -> tuple[Any, ...]:
    # a copy: what is computed may be read-only, or a view that others hold
    return tuple(torch.tensor(array, dtype=like.dtype, device=like.device) for array in arrays)


def _batched(function: Any, size: int, places: tuple[Any, ...], made: Outputs, *given: Any) -> Any:
    """Apply a function under vmap: bladegen takes leading axes itself."""
    ahead = (
        part.movedim(place, 0) if place is not None else part.expand(size, *part.shape)
        for part, place in zip(given, places[1:], strict=True)
    )
    found = function.apply(made, *ahead)
    return found, 0 if isinstance(found, torch.Tensor) else (0,) * len(found)


class _Values(Function):  # type: ignore[misc]
    """All outputs."""

    @staticmethod
    def forward(made: Outputs, x: Any) -> Any:
        return _tensors(_at(made, x).values, x)

    @staticmethod
    def setup_context(ctx: Any, inputs: Any, output: Any) -> None:  # noqa: ARG004
        ctx.made, x = inputs
        ctx.save_for_backward(x)
        ctx.save_for_forward(x)

    @staticmethod
    def backward(ctx: Any, *gradients: Any) -> Any:
        return None, _Back.apply(ctx.made, *ctx.saved_tensors, *gradients)

    @staticmethod
    def jvp(ctx: Any, _: Any, dx: Any) -> Any:
        return _Along.apply(ctx.made, *ctx.saved_tensors, dx)

    @staticmethod
    def vmap(info: Any, places: Any, made: Outputs, x: Any) -> Any:
        return _batched(_Values, info.batch_size, places, made, x)


class _First(Function):  # type: ignore[misc]
    """A product with first derivatives, which cannot be differentiated again."""

    @staticmethod
    def setup_context(ctx: Any, inputs: Any, output: Any) -> None:
        pass

    @staticmethod
    def backward(*_: Any) -> Any:
        raise PerturbationError(FIRST_ONLY)

    @staticmethod
    def jvp(*_: Any) -> Any:
        raise PerturbationError(FIRST_ONLY)


class _Back(_First):
    """The gradient in x."""

    @staticmethod
    def forward(made: Outputs, x: Any, *gradients: Any) -> Any:
        parts = tuple(g.detach().cpu().numpy() for g in gradients)
        return _tensors((_at(made, x).vjp(parts),), x)[0]

    @staticmethod
    def vmap(info: Any, places: Any, made: Outputs, *given: Any) -> Any:
        return _batched(_Back, info.batch_size, places, made, *given)


class _Along(_First):
    """Derivatives along a direction."""

    @staticmethod
    def forward(made: Outputs, x: Any, dx: Any) -> Any:
        return _tensors(_at(made, x).jvp(dx.detach().cpu().numpy()), x)

    @staticmethod
    def vmap(info: Any, places: Any, made: Outputs, *given: Any) -> Any:
        return _batched(_Along, info.batch_size, places, made, *given)


class FamilyDataset(Dataset):  # type: ignore[misc]
    """A written family as a map-style dataset: tensors of a variant by name.

    Parameters
    ----------
    family : LoadedFamily
        `bladegen.load_family(path)`.
    names : sequence of str
        Arrays of numbers of the family, or "parameters".
    places : (b,) array of int, optional
        Which variants, such as ``family.split("train")``; all if not given.
    dtype : torch.dtype
        Of the tensors, torch.float32 by default, also of what the family holds in float64.

    Notes
    -----
    `DataLoader` reads a batch at once (`__getitems__`).  Shuffled batches read each variant where
    it lies; `LoadedFamily.batches` shuffles so that every shard is read once, which is quicker.
    """

    def __init__(
        self,
        family: LoadedFamily,
        names: Any = ("parameters", "sections"),
        places: Any = None,
        dtype: Any = torch.float32,
    ) -> None:
        must = "a LoadedFamily; bladegen.load_family(path) opens one"
        instance(family, LoadedFamily, "family", must, FamilyError)
        self.family, self.names, self.dtype = family, named(family, names), dtype
        self.places = chosen(family, places)
        of_numbers(family, self.names)
        instance(dtype, torch.dtype, "dtype", "a torch.dtype, such as torch.float32", FamilyError)

    def __len__(self) -> int:
        return len(self.places)

    def __getitem__(self, row: int) -> dict[str, Any]:
        if not -len(self) <= row < len(self):
            raise IndexError(row)
        return self.__getitems__([row])[0]

    def __getitems__(self, rows: list[int]) -> list[dict[str, Any]]:
        """Return several variants, read at once."""
        read = arrays_at(self.family, self.names, self.places[np.asarray(rows)])
        tensors = {name: torch.as_tensor(v).to(self.dtype) for name, v in read.items()}
        return [{name: v[i] for name, v in tensors.items()} for i in range(len(rows))]
