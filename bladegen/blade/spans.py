"""Where on a blade: span fractions and landmark parameters, as people give them."""

import numpy as np

from bladegen.errors import DefinitionError
from bladegen.support.arguments import numbers
from bladegen.support.arrays import Array, ArrayLike

__all__ = ["landmarks_at", "span_fractions"]


def span_fractions(eta: ArrayLike) -> Array:
    """Return span fractions as an array, or say which is not allowed."""
    spans = numbers(eta, "eta", DefinitionError, "span fractions from 0 (root) to 1 (tip)")
    if not bool(np.all((spans >= 0) & (spans <= 1))):
        bad = spans[~((spans >= 0) & (spans <= 1))][0]
        raise DefinitionError(f"eta: got {bad:g}, allowed is 0 (root) to 1 (tip)")
    return spans


def landmarks_at(u: ArrayLike) -> Array:
    """Return landmark parameters as an array, or say that they are none."""
    values = numbers(u, "u", DefinitionError, "landmark parameters from 0 to 1")
    if values.ndim != 1 or not bool(np.all((values >= 0) & (values <= 1))):
        raise DefinitionError("u: must be a list of landmark parameters from 0 to 1")
    return values
