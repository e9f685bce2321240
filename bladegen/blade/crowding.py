"""Where along the span a surface bends, and how to spread sections so that they resolve it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bladegen.errors import DefinitionError
from bladegen.support.arrays import Array, Indices

__all__ = ["Crowding"]

RESOLVING_SPANS = 1001  # spans at which bends are looked for
RESOLVING_LANDMARKS = 40  # landmarks that are watched for bends, about
EVEN_SHARE = 0.35  # of the sections: spread evenly, so that no part of the span is left bare
ROUNDING = 1e-12  # of the blade's size; second differences below are no bends
DECIMALS = 9  # of spans: sums differ in their last digits with the number of threads
SMOOTHING = 5  # samples over which the density is averaged


@dataclass(frozen=True, eq=False)
class Crowding:
    """How closely sections should stand, as the running total of their density.

    Parameters
    ----------
    grid : (m,) array
        Span fractions.
    total : (m,) array
        Strictly increasing.
    """

    grid: Array
    total: Array

    @classmethod
    def of(cls, grid: Array, points: Array) -> "Crowding":
        """Measure a surface.

        Parameters
        ----------
        grid : (m,) array
            Even span fractions.
        points : (m, n, 3) array
            Some landmarks of the sections there.

        Notes
        -----
        The density is the square root of the largest second difference along the span, which
        spreads the error of a piecewise linear surface evenly.
        """
        bend = np.abs(np.diff(points, 2, axis=0)).max(axis=(1, 2))
        bend[bend < ROUNDING * np.ptp(points)] = 0.0
        density = np.sqrt(np.concatenate([bend[:1], bend, bend[-1:]]))
        padded = np.pad(density, SMOOTHING // 2, mode="edge")
        density = np.convolve(padded, np.full(SMOOTHING, 1.0 / SMOOTHING), mode="valid")
        even = np.full(len(grid), 1.0 / len(grid))
        if density.sum() > 0:
            even = (1.0 - EVEN_SHARE) * density / density.sum() + EVEN_SHARE * even
        steps = 0.5 * (even[1:] + even[:-1])
        return cls(grid, np.concatenate([[0.0], np.cumsum(steps)]))

    @classmethod
    def along(cls, sections: Callable[[Array, Indices], Array], landmarks: int) -> "Crowding":
        """Measure a blade by some landmarks (k, m, 3) of its sections as a function of span.

        As many are asked for from either end, and each with the one that lies opposite.
        """
        grid = np.linspace(0.0, 1.0, RESOLVING_SPANS)
        some = np.arange(0, landmarks, max(1, landmarks // RESOLVING_LANDMARKS))
        both = np.union1d(some, landmarks - 1 - some)
        return cls.of(grid, sections(grid, both)[:, np.searchsorted(both, some)])

    def spans(self, fixed: Array, count: int) -> Array:
        """Return `count` increasing span fractions, `fixed` (increasing) among them.

        Raises
        ------
        DefinitionError
            If `count` is too small to hold the fixed ones.
        """
        if count < len(fixed):
            raise DefinitionError(
                f"stations: got {count}, at least {len(fixed)} are needed: root, tip and the "
                "definition's own"
            )
        marks = np.interp(fixed, self.grid, self.total)
        share = np.diff(marks) / (marks[-1] - marks[0]) * (count - len(fixed))
        inner = np.floor(share).astype(int)
        rest = count - len(fixed) - int(inner.sum())
        inner[np.argsort(inner - share, kind="stable")[:rest]] += 1
        cells = np.repeat(np.arange(len(inner)), inner + 1)
        first = np.concatenate([[0], np.cumsum(inner + 1)[:-1]])
        within = np.arange(len(cells)) - first[cells]
        level = marks[cells] + np.diff(marks)[cells] * within / (inner + 1)[cells]
        spans = np.round(np.interp(level, self.total, self.grid), DECIMALS)
        spans[within == 0] = fixed[:-1]
        return np.append(spans, fixed[-1])
