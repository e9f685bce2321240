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

from bladegen.errors import GeometryError
from bladegen.support.arrays import Array

__all__ = [
    "MINIMUM_EDGE",
    "PAIRWISE",
    "AsGiven",
    "MinimumThickness",
    "Sharp",
    "TrailingEdge",
    "least_width",
]

WINDOW = (0.5, 0.8)  # of chord: nothing moves ahead of the first, all moves behind the second
LEAST_WEDGE = 0.25  # of the edge's height: what a closed edge keeps at the window's end


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

    def __str__(self) -> str:
        return "given"

    def __call__(self, profiles: Array, chord: Array) -> Array:  # noqa: ARG002
        return profiles


@dataclass(frozen=True)
class MinimumThickness:
    """Trailing edges at least so thick; thicker ones stay as they are.

    Parameters
    ----------
    thickness : float
        [m].
    most : float, optional
        Of the local chord: where that is less than `thickness`, it is what edges get at least.
    """

    thickness: float = 0.002
    most: float | None = None

    def __str__(self) -> str:
        length = f"{1e3 * self.thickness:.12g}mm"
        return length if self.most is None else f"{length},{100.0 * self.most:.12g}%"

    def width(self, chord: Array) -> Array:
        """Return how thick edges become at least, over the chord, at chords (...) [m]."""
        least: Array = self.thickness / chord
        return least if self.most is None else np.minimum(least, self.most)

    def width_slope(self, chord: Array) -> Array:
        """Return the derivative of `width` in the chord, (...); where the two meet, that of `most`.

        [1/m].
        """
        least = self.thickness / chord
        capped = np.zeros(least.shape, dtype=bool) if self.most is None else least >= self.most
        return np.where(capped, 0.0, -least / chord)

    def require_room(self, thickness: Array, chord: Array) -> None:
        """See that sections are thicker than their edges shall be.

        Parameters
        ----------
        thickness, chord : (...) arrays
            Relative thickness, and chord [m].

        Raises
        ------
        GeometryError
            If an edge would be thicker than its section.
        """
        excess = self.width(chord) - thickness
        if bool(np.any(excess > 0.0)):
            worst = np.unravel_index(np.argmax(excess), excess.shape)
            room = 1e3 * float(thickness[worst] * chord[worst])
            raise GeometryError(
                f"trailing edge: got {self}, more than the thickness of {room:.4g} mm of the "
                f"section whose chord is {float(chord[worst]):.4g} m; allowed is less, such as "
                "--trailing-edge 2mm,1%"
            )

    def __call__(self, profiles: Array, chord: Array) -> Array:
        planes = np.array(profiles.transpose(2, 0, 1), order="C")
        m = planes.shape[2] // 2
        height = planes[1, :, :m] - planes[1, :, : -m - 1 : -1]
        self.require_room(height.max(axis=1), chord)
        missing = (0.5 * self.width(chord)) ** 2 - (0.5 * height[:, 0]) ** 2
        thin = missing > 0
        along = planes[0, :, :m] + planes[0, :, : -m - 1 : -1]
        behind = int(np.max(np.arange(1, m + 1) * (along > 2.0 * WINDOW[0]).any(axis=0)))
        if behind and thin.any():
            half = 0.5 * height[:, :behind]
            window = _window(0.5 * along[:, :behind]) * np.where(thin, missing, 0.0)[:, None]
            lift = np.where(thin[:, None], np.sqrt(half * half + window) - half, 0.0)
            planes[1, :, :behind] += lift
            planes[1, :, : -behind - 1 : -1] -= lift
        return planes.transpose(1, 2, 0)


MINIMUM_EDGE = MinimumThickness(0.002, most=0.01)  # what trailing edges are by default


@dataclass(frozen=True)
class Sharp:
    """Trailing edges closed to a line, by a wedge that ends in the window.

    Where the sides come closer ahead of the edge than at it, the wedge alone would carry them
    through each other; they are kept apart by a thin one that is lost in the sides elsewhere.
    Opposite landmarks move along the line that joins them, so that sides that do not cross still
    do not.
    """

    def __str__(self) -> str:
        return "sharp"

    def __call__(self, profiles: Array, chord: Array) -> Array:  # noqa: ARG002
        half, middle = _halves(profiles)
        window, height = _window(middle[..., 0]), half[..., 1]
        edge = np.maximum(height[:, :1], 0.0)
        ahead = np.maximum(middle[:, :1, 0] - middle[..., 0], 0.0) / (1.0 - WINDOW[1])
        closed = _above(height - edge * window, LEAST_WEDGE * edge * window * ahead)
        share = np.divide(closed, height, out=np.ones_like(height), where=height > 0)
        share[:, 0] = 0.0  # ends side by side, or past each other, meet too
        return _joined(profiles, half * share[..., None], middle)


PAIRWISE = (AsGiven, MinimumThickness, Sharp)  # what moves opposite landmarks, each pair by itself


def least_width(edge: TrailingEdge, thickness: Array, chord: Array) -> Array | None:
    """Return the least width of edges over the chord, (...); None where another rule holds.

    Of sections of relative thickness and chord [m] (...); a `GeometryError` says that there is no
    room.
    """
    if type(edge) is MinimumThickness:
        edge.require_room(thickness, chord)
        return edge.width(chord)
    return np.zeros(chord.shape) if type(edge) is AsGiven else None


def _halves(profiles: Array) -> tuple[Array, Array]:
    """Return half the way between opposite landmarks, and their middles, (k, m, 2) each."""
    m = profiles.shape[1] // 2
    suction, pressure = profiles[:, :m], profiles[:, : -m - 1 : -1]
    return 0.5 * (suction - pressure), 0.5 * (suction + pressure)


def _joined(profiles: Array, half: Array, middle: Array) -> Array:
    """Return the sections with new halves about the same middles."""
    m = half.shape[1]
    result = profiles.copy()
    result[:, :m], result[:, : -m - 1 : -1] = middle + half, middle - half
    return result


def _above(values: Array, least: Array) -> Array:
    """Return values kept above `least`, smoothly, and as they are far above it or where it is 0."""
    free = values - least
    result: Array = least + 0.5 * (free + np.hypot(free, least))
    return result


def _window(along: Array) -> Array:
    """Return 0 ahead and 1 behind the window, C2 between, at places along the chord."""
    f = np.clip((along - WINDOW[0]) / (WINDOW[1] - WINDOW[0]), 0.0, 1.0)
    weight: Array = f * f * f * (10.0 - (15.0 - 6.0 * f) * f)
    return weight
