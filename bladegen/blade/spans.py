"""Where on a blade: span fractions and landmark parameters, as people give them."""

import numpy as np

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import DefinitionError
from bladegen.support.arguments import numbers
from bladegen.support.arrays import Array, ArrayLike, Indices, readonly

__all__ = [
    "MIRROR",
    "around",
    "both_sides",
    "grid_points",
    "landmarks_at",
    "reflected",
    "span_fractions",
]

MIRROR = readonly([1.0, -1.0, 1.0])


def span_fractions(eta: ArrayLike) -> Array:
    """Return span fractions as an array, or say which is not allowed."""
    spans = numbers(eta, "eta", DefinitionError, "span fractions from 0 (root) to 1 (tip)")
    if not bool(np.all((spans >= 0) & (spans <= 1))):
        bad = spans[~((spans >= 0) & (spans <= 1))][0]
        raise DefinitionError(f"eta: got {bad:g}, allowed is 0 (root) to 1 (tip)")
    return spans


def landmarks_at(u: ArrayLike, dimensions: int | None = None) -> Array:
    """Return landmark parameters as an array, of so many dimensions, or say that they are none."""
    values = numbers(u, "u", DefinitionError, "landmark parameters from 0 to 1")
    inside = bool(np.all((values >= 0) & (values <= 1)))
    if not inside or dimensions not in (None, values.ndim):
        listed = "a list of " if dimensions else ""
        raise DefinitionError(f"u: must be {listed}landmark parameters from 0 to 1")
    return values


def both_sides(u: Array) -> tuple[Array, Indices]:
    """Return parameters (m,) that hold `u` (...), the ends and 0.5, and where each stands.

    They are symmetric about 0.5, as those of sections whose trailing edges are finished must be.
    """
    side = np.unique(np.concatenate([[0.0, 0.5], np.minimum(u, 1.0 - u).reshape(-1)]))
    at = np.searchsorted(side, np.minimum(u, 1.0 - u))
    both = np.concatenate([side, 1.0 - side[-2::-1]])
    return both, np.where(u <= 0.5, at, len(both) - 1 - at)


def around(u: ArrayLike | None) -> tuple[Array | None, Indices | slice]:
    """Return parameters that are symmetric and hold both ends, and where those asked for stand.

    Trailing edges are finished by opposite points and by the ends, whatever points are wanted.
    """
    if u is None:
        return None, slice(None)
    values = landmarks_at(u, 1)
    if values.size > 1 and values[0] == 0.0 and np.allclose(values, 1.0 - values[::-1], 0.0, 1e-12):
        return values, slice(None)
    return both_sides(values)


def reflected(sections: Array) -> Array:
    """Return the mirror image in y of sections (..., n, 3), which goes round the same way."""
    image: Array = sections[..., ::-1, :] * MIRROR.astype(sections.dtype)
    return image


def grid_points(definition: BladeDefinition) -> Array:
    """Return the grid points of a definition's distributions, in no order, some many times.

    They are those of chord, twist, offsets, axis and thickness.
    """
    axis = definition.axis
    given = (
        definition.chord,
        definition.twist,
        definition.section_offset_x,
        definition.section_offset_y,
        definition.pitch_axis,
        definition.relative_thickness,
        axis.x,
        axis.y,
        axis.z,
    )
    return np.concatenate([quantity.grid for quantity in given if quantity is not None])
