"""Points of a path as linear combinations of what each of its segments is made of.

A geodesic's points lie in the span of where it starts and its step, those of a spline of
logarithms in that of the mean and the spline's powers: few columns a segment, made once.
"""

from typing import NamedTuple

import numpy as np

from bladegen.support.arrays import Array, Indices

__all__ = ["Combined", "segments"]


class Combined(NamedTuple):
    """Points of a path as linear combinations of what their segment of it has.

    Parameters
    ----------
    columns : (s - 1, f, n) array
        Of the segments.
    segments : (k,) array of int
        In which the points lie.
    weights : (k, f, 2) array
        The bases' two columns are ``columns[segment].T @ weights``.
    """

    columns: Array
    segments: Indices
    weights: Array

    def mapped(self, M: Array, b: Array) -> Array:
        """Return sections (k, n, 2): the bases under maps (k, 2, 2) and (k, 2)."""
        n, k = self.columns.shape[-1], len(self.segments)
        planes = np.empty((2, k, n))
        sections, weights = planes.swapaxes(0, 1), (self.weights @ M).mT
        ends = np.flatnonzero(np.diff(self.segments, prepend=-1, append=-1))
        for first, last in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True):
            columns = self.columns[self.segments[first]]
            np.matmul(weights[first:last], columns, out=sections[first:last])
        planes += b.T[..., None]
        return planes.transpose(1, 2, 0)


def segments(knots: Array, q: Array) -> Indices:
    """Return the index of the segment between knots that holds each q."""
    return np.clip(np.searchsorted(knots, q, side="right") - 1, 0, len(knots) - 2)
