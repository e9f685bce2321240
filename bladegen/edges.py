"""Trailing edges that can be built: at least a minimum thickness, as given, or sharp.

A section's sides are moved normal to the chord line, near the trailing edge only: with half
height h between the sides, the half height at the edge h0, and the wanted half height H,

    h' = sqrt(h^2 + w (H^2 - h0^2))        where h0 < H

meets H at the edge and falls off like 1 / h ahead of it, so that a wedge opens by H without
a corner, and a closed circle of radius R stays a circle to H^2 / (2 R), a micrometre.  The
window w ends the change ahead of the thickest place; chord and thickness stay as they are.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from bladegen.arrays import Array

__all__ = ["AsGiven", "MinimumThickness", "Sharp", "TrailingEdge"]

WINDOW = (0.5, 0.8)  # of chord: nothing moves ahead of the first, all moves behind the second


class TrailingEdge(Protocol):
    """A policy for trailing edges."""

    def __call__(self, profiles: Array, chord: Array) -> Array:
        """Return sections (k, n, 2) in chords with their trailing edges finished.

        `chord` (k,) is in metres.
        """
        ...


@dataclass(frozen=True)
class AsGiven:
    """Trailing edges as the airfoils give them, open or closed."""

    def __call__(self, profiles: Array, chord: Array) -> Array:  # noqa: ARG002
        return profiles


@dataclass(frozen=True)
class MinimumThickness:
    """Trailing edges at least `thickness` [m] thick; thicker ones stay as they are."""

    thickness: float = 0.002

    def __call__(self, profiles: Array, chord: Array) -> Array:
        half, middle, first = _halves(profiles)
        wanted = 0.5 * self.thickness / chord
        missing = np.maximum(wanted**2 - first**2, 0.0)[:, None]
        opened = np.sqrt(half**2 + _window(profiles) * missing)
        return _joined(profiles, np.where(missing > 0, opened, half), middle)


@dataclass(frozen=True)
class Sharp:
    """Trailing edges closed to a line, by a wedge that ends in the window."""

    def __call__(self, profiles: Array, chord: Array) -> Array:  # noqa: ARG002
        half, middle, first = _halves(profiles)
        return _joined(profiles, half - first[:, None] * _window(profiles), middle)


def _halves(profiles: Array) -> tuple[Array, Array, Array]:
    """Return half heights and mid heights of landmark pairs (k, m), and the half at the edge."""
    m = profiles.shape[1] // 2
    suction, pressure = profiles[:, :m, 1], profiles[:, : -m - 1 : -1, 1]
    half = 0.5 * (suction - pressure)
    return half, 0.5 * (suction + pressure), half[:, 0]


def _joined(profiles: Array, half: Array, middle: Array) -> Array:
    """Return the sections with new half heights about the same mid heights."""
    m = half.shape[1]
    result = profiles.copy()
    result[:, :m, 1] = middle + half
    result[:, : -m - 1 : -1, 1] = middle - half
    return result


def _window(profiles: Array) -> Array:
    """Return 0 ahead and 1 behind the window, C2 between, for landmark pairs (k, m)."""
    m = profiles.shape[1] // 2
    x = 0.5 * (profiles[:, :m, 0] + profiles[:, : -m - 1 : -1, 0])
    f = np.clip((x - WINDOW[0]) / (WINDOW[1] - WINDOW[0]), 0.0, 1.0)
    return f**3 * (10.0 - 15.0 * f + 6.0 * f**2)
