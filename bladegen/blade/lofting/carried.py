"""Modes of a shape space carried to the shapes of a blade, to deform these by many coordinates.

Parallel transport is linear, so a deformed shape is a combination of a shape X and the modes V_j
that were carried there:

    X cos S + D sin S / S,      D = sum_j t_j V_j,      S^2 = D^T D.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.shapes import grassmann
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array

__all__ = ["Carried"]


@dataclass(frozen=True, eq=False)
class Carried:
    """The modes of a space at shapes.

    Parameters
    ----------
    space : ShapeSpace
        Which one.
    shapes : (k, n, 2) array
        Orthonormal bases X.
    columns : (k, 2 r + 2, n) array
        The two of each shape, and of each mode carried there.
    """

    space: ShapeSpace
    shapes: Array
    columns: Array

    @classmethod
    def to(cls, space: ShapeSpace, shapes: Array) -> "Carried":
        """Carry the modes of a space to shapes (k, n, 2)."""
        modes = grassmann.transport(space.modes, space.mean, shapes[:, None])
        k, r, n, _ = modes.shape
        columns = np.concatenate([shapes.mT, modes.mT.reshape(k, 2 * r, n)], axis=1)
        return cls(space, shapes, columns)

    @cached_property
    def _products(self) -> Array:
        """The inner products of the modes' columns, (k, 2 r, 2 r)."""
        modes = self.columns[:, 2:]
        return modes @ modes.mT

    @cached_property
    def coordinates(self) -> Array:
        """The normal coordinates of the shapes themselves, (k, r)."""
        return self.space.encode(self.shapes)

    def change(self, t: Array, M: Array) -> Array:
        """Return by how much coordinates t (k, r) change sections of maps M (k, 2, 2), (k, n, 2).

        Nothing changes where t is zero, bit by bit.
        """
        k, r = t.shape
        along = (t[:, :, None, None] * np.eye(2)).reshape(k, 2 * r, 2)
        cosine, sinc = grassmann.exp_factors(along.mT @ (self._products @ along))
        weights = np.concatenate([cosine - np.eye(2), along @ sinc], axis=1) @ M
        planes: Array = np.empty((2, k, self.columns.shape[-1]))
        np.matmul(weights.mT, self.columns, out=planes.swapaxes(0, 1))
        return planes.transpose(1, 2, 0)
