"""A tip as a surface of two parameters, on which lines are measured to space a grid's points.

What is measured here only places points, at parameters e and w; the points themselves are then
taken from the blade.  Metres.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.support.arrays import Array
from bladegen.surface.tips import on_arcs

__all__ = ["LEAST_SINE", "TipSurface", "along_rows", "away", "facing_cells", "lengths", "sines"]

LEAST_SINE = 0.1  # of lines that run nearly along an edge


@dataclass(frozen=True, eq=False)
class TipSurface:
    """Points of a tip at distances e from the nose and places w between the sides: see `caps`.

    Parameters
    ----------
    outline : (2 m - 1, 3) array
        The last section.
    e : (m,) array
        Its points' distances, from the trailing edge on.
    poles : (m, 4, 3) array or None
        The arcs' poles; None on a flat tip.
    """

    outline: Array
    e: Array
    poles: Array | None
    samples: int = 65  # of a line that is measured

    @property
    def mirrored(self) -> "TipSurface":
        """The same from the pressure side: places are 1 - w."""
        poles = None if self.poles is None else self.poles[:, ::-1]
        return TipSurface(self.outline[::-1], self.e, poles, self.samples)

    def __call__(self, e: Array, w: Array) -> Array:
        """Return points (..., 3), between those given on straight lines."""
        m = len(self.e)
        if self.poles is None:
            table = np.stack([self.outline[:m], self.outline[: m - 2 : -1]], axis=1)
        else:
            table = self.poles
        e, w = np.broadcast_arrays(e, w)
        at = np.clip(np.searchsorted(-self.e, -e, side="right") - 1, 0, m - 2)
        share = ((self.e[at] - e) / (self.e[at] - self.e[at + 1]))[..., None, None]
        made = (1.0 - share) * table[at] + share * table[at + 1]
        if self.poles is not None:
            return on_arcs(made, w)
        points: Array = (1.0 - w[..., None]) * made[..., 0, :] + w[..., None] * made[..., 1, :]
        return points


def lengths(points: Array) -> Array:
    """Return the lengths (..., m) of lines of points (..., m, 3) up to each point."""
    steps = np.linalg.norm(np.diff(points, axis=-2), axis=-1)
    zero = np.zeros((*steps.shape[:-1], 1))
    sums: Array = np.concatenate([zero, np.cumsum(steps, axis=-1)], axis=-1)
    return sums


def along_rows(x: Array, y: Array, at: Array) -> Array:
    """Interpolate in each row: y (k, m) or (m,) over increasing x (k, m) at places (k, p)."""
    y = np.broadcast_to(y, x.shape)
    index = np.sum(at[:, :, None] >= x[:, None, 1:-1], axis=-1)
    rows = np.arange(len(x))[:, None]
    left, right = x[rows, index], x[rows, index + 1]
    gap = right - left
    share = np.divide(at - left, gap, out=np.zeros_like(gap), where=gap > 0.0)
    result: Array = (1.0 - share) * y[rows, index] + share * y[rows, index + 1]
    return result


def facing_cells(steps: Array, edge: Array, facing: list[Array]) -> Array:
    """Return how long steps (m, d) from an edge's points (m, d) must be to be as high as cells.

    These cells are `facing` its three parts in turn, normal to each; the points where parts meet
    face two of them, and get the mean.
    """
    first, last = len(facing[0]) - 1, len(edge) - len(facing[2])
    sizes = [
        cells / np.maximum(sines(steps[part], edge[part]), LEAST_SINE)
        for cells, part in zip(
            facing, (slice(0, first + 1), slice(first, last + 1), slice(last, None)), strict=True
        )
    ]
    sizes[0][-1] = np.sqrt(sizes[0][-1] * sizes[1][0])
    sizes[2][0] = np.sqrt(sizes[2][0] * sizes[1][-1])
    return np.concatenate([sizes[0], sizes[1][1:-1], sizes[2]])


def sines(steps: Array, line: Array) -> Array:
    """Return sines (m,) of the angles between steps (m, d) and a line's points (m, d)."""
    length = np.linalg.norm(steps, axis=-1)
    found: Array = np.divide(
        away(steps, line), length, out=np.ones_like(length), where=length > 0.0
    )
    return found


def away(steps: Array, line: Array) -> Array:
    """Return the lengths (m,) of steps (m, d) from the points (m, d) of a line, normal to it."""
    way = np.gradient(line, axis=0)
    length = np.linalg.norm(way, axis=-1, keepdims=True)
    way = np.divide(way, length, out=np.zeros_like(way), where=length > 0.0)
    normal = steps - way * np.sum(way * steps, axis=-1, keepdims=True)
    height: Array = np.linalg.norm(normal, axis=-1)
    return height
