"""How far a change of shape moves the skin, and coordinates that move it by a stated length.

Coordinates are angles on the Grassmannian: vectors t of the same length |t| move sections of
different thickness by different lengths, since shapes are standardised before and brought to
their thickness after.  Here a displacement is the farthest that any landmark of a section moves
along the contour's normal, in chords, with chord line and thickness as the blade keeps them.
"""

from typing import Any, Protocol

import numpy as np

from bladegen.blade.changes.affine_change import AffineChange
from bladegen.errors import GeometryError, PerturbationError
from bladegen.support.arrays import Array

__all__ = ["displacements", "factors"]

ROUNDS = 20
CLOSE = 1e-4  # of the displacement
FIRST = 0.01  # rad: |t| of the first try, small on all airfoils
STILL = 1e-9  # chord; sections that move by less are not moved by these coordinates


class Shaped(Protocol):
    """What has sections in chords."""

    def profiles(self, eta: Any) -> Array:
        """Return sections (k, n, 2) at span fractions (k,)."""
        ...


def displacements(blade: Shaped, variant: Shaped, eta: Array) -> Array:
    """Return how far a variant's skin lies from a blade's at span fractions (k,), in chords."""
    return _moved(blade.profiles(eta), variant.profiles(eta))


def _moved(before: Array, after: Array) -> Array:
    along = np.gradient(before, axis=-2)
    along /= np.linalg.norm(along, axis=-1, keepdims=True)
    away = after - before
    across = along[..., 0] * away[..., 1] - along[..., 1] * away[..., 0]
    found: Array = np.abs(across).max(axis=-1)
    return found


def factors(
    blade: Any, space: Any, direction: Any, displacement: float, *, together: bool, **how: Any
) -> Array:
    """Return by what coordinates are multiplied at each span so that sections move so far, (k,).

    Parameters
    ----------
    blade : Blade
        Whose sections are moved.
    space : ShapeSpace
        The modes.
    direction : Coordinates
        At the spans that are looked at, of any size.
    displacement : float
        In chords: of each section, or with `together` of that which moves farthest.
    how : dict
        `window` and `chord_line`, as for `Blade.perturbed`.

    Raises
    ------
    PerturbationError
        If the coordinates move no section, or none of so many tries comes close.
    """
    eta, t = direction.grid, direction.values
    before = blade.profiles(eta)
    length = np.linalg.norm(t, axis=1).max()
    scale = np.full(len(eta), FIRST / length if length > 0 else 1.0)
    for _ in range(ROUNDS):
        at = type(direction)(eta, scale[:, None] * t)
        variant = blade.untested(space, at, AffineChange(), allow_extrapolation=True, **how)
        try:
            reached = _moved(before, variant.profiles(eta))
        except GeometryError:  # no sections are left
            break
        reached = np.full_like(reached, reached.max()) if together else reached
        if reached.min() < STILL:
            place = eta[int(np.argmin(reached))]
            raise PerturbationError(
                f"t: moves the section at {place:.3g} of the span by nothing, so no multiple of it "
                "moves that by a stated displacement; give another t"
            )
        if np.abs(reached / displacement - 1.0).max() < CLOSE:
            return scale
        scale = scale * displacement / reached
    raise PerturbationError(
        f"displacement: got {displacement:g}, which no multiple of t reaches; give less"
    )
