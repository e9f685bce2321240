"""What the sections of all variants of a blade are linear in: shapes, carried modes, a constant.

Shapes at the spans, the modes carried there by parallel transport, and the splines of both are
made once.  A variant's section is then ``values.T @ coefficients``, F features a span, with
coefficients from its 2 x 2 matrices,

    (X cos S + D sin S / S) M A + ...,   D = w sum_j t_j V_j,   S^2 = D^T D.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.airfoils.chord_lines import angles
from bladegen.blade.blade import Blade
from bladegen.shapes import affine, grassmann
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array

__all__ = ["Features"]


@dataclass(frozen=True, eq=False)
class Features:
    """A blade's features at span fractions `eta` (k,), with the modes of a space or without."""

    blade: Blade
    space: ShapeSpace | None
    eta: Array

    @cached_property
    def shapes(self) -> tuple[Array, Array, Array, Array]:
        """The sections' shapes as `Blade.shapes` gives them."""
        return self.blade.shapes(self.eta)

    @cached_property
    def _carried(self) -> Array:
        """The modes at the spans' shapes, (k, r, n, 2)."""
        X = self.shapes[1]
        if self.space is None:
            return np.zeros((len(X), 0, *X.shape[1:]))
        return grassmann.transport(self.space.modes, self.space.mean, X[:, None])

    @cached_property
    def values(self) -> Array:
        """The shapes, the carried modes, and a constant, (k, F, n)."""
        X, V = self.shapes[1], self._carried
        k, n, _ = X.shape
        rows = [np.moveaxis(X, -1, 1), np.moveaxis(V, -1, 2).reshape(k, -1, n), np.ones((k, 1, n))]
        return np.concatenate(rows, axis=1)

    @cached_property
    def slopes(self) -> Array:
        """The slopes of the features' splines, (k, n, F)."""
        slopes = self.blade.splines.values(self.blade.u, 1) @ self.values.mT
        return np.ascontiguousarray(slopes)

    @cached_property
    def _gram(self) -> Array:
        """V_i^T V_j, (k, r * r, 4)."""
        V = self._carried
        k, r = V.shape[:2]
        return (V.mT[:, :, None] @ V[:, None]).reshape(k, r * r, 4)

    @staticmethod
    def weighted(t: Array, weight: Array) -> Array:
        """Return coordinates t, (b, r) or (b, k, r), times weights (k,), (k, b, r)."""
        result: Array = (t if t.ndim == 2 else t.swapaxes(0, 1)) * weight[:, None, None]
        return result

    @property
    def gram(self) -> Array:
        """The products V_i^T V_j of the modes at the spans, (k, r, r, 2, 2)."""
        k, r = self._carried.shape[:2]
        return self._gram.reshape(k, r, r, 2, 2)

    def coefficients(self, t: Array, weight: Array) -> Array:
        """Return the coefficients (k, b, F, 2) of shapes, at weights (k,) of coordinates t.

        These are (b, r), or (b, k, r) where they differ along the span.
        """
        _, _, M, b = self.shapes
        k, r = self._carried.shape[:2]
        count = len(t)
        weighted = self.weighted(t, weight)
        squares, gram = np.zeros((k, count, 4)), self._gram.reshape(k, r, r, 1, 4)
        for i in range(r):  # a matrix product would round by how many variants there are
            for j in range(i, r):
                both = gram[:, i, j] if i == j else gram[:, i, j] + gram[:, j, i]
                squares += (weighted[..., i] * weighted[..., j])[..., None] * both
        cosine, sinc = grassmann.exp_factors(squares.reshape(k, count, 2, 2))
        result = np.empty((k, count, 2 * r + 3, 2))
        result[:, :, :2] = cosine @ M[:, None]
        result[:, :, 2:-1] = (weighted[..., None, None] * (sinc @ M[:, None])[:, :, None]).reshape(
            k, count, 2 * r, 2
        )
        result[:, :, -1] = b[:, None]
        return result

    @cached_property
    def plain(self) -> Array:
        """The coefficients (k, 1, F, 2) of the baseline's own shapes."""
        return self.coefficients(np.zeros((1, self._carried.shape[1])), np.ones(len(self.eta)))

    def turned(self, sections: Array, to_space: Array) -> Array:
        """Return how far chord lines of sections (b, k, n, 3) turn from the baseline's, (b, k)."""
        plain, _, M, b = self.shapes
        before = angles(affine.restore(plain, M, b), self.blade.u)
        result = np.empty(sections.shape[:2])
        for i, (section, axes) in enumerate(zip(sections, to_space, strict=True)):
            x, y, z = np.moveaxis(section - axes[:, None, 2], -1, 0).copy()
            local = [x * a + y * b + z * c for a, b, c in axes[:, :2].transpose(1, 2, 0)[..., None]]
            result[i] = (
                angles(np.moveaxis(np.stack(local), 0, -1), self.blade.u) - before
            )  # chords squared
        return result
