"""The sections of variants at vectors x, and how they change: prepared once, used often.

What sections are made of changes with the parameters by small arrays, the `Chain`; kernels carry
them on to points, or a gradient of points back to the parameters.
"""

from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from bladegen.airfoils.chord_lines import KEPT
from bladegen.parametric.chain import Chain
from bladegen.parametric.outline import Outline
from bladegen.parametric.parameters import Parameters
from bladegen.support.arrays import Array, Indices, laid_out
from bladegen.support.threads import shares_of, side_by_side

__all__ = ["Linearisation"]


@dataclass(frozen=True, eq=False)
class Linearisation:
    """Sections of variants x (b, p), and their derivatives.

    Parameters
    ----------
    outline : Outline
        The sections' features.
    parameters : Parameters
        What varies.
    x : (b, p) array
        Where.
    """

    outline: Outline
    parameters: Parameters
    x: Array

    @cached_property
    def chain(self) -> Chain:
        """What the sections are made of."""
        return Chain(self.outline.batch, self.parameters, self.x)

    @cached_property
    def coefficients(self) -> tuple[Array, Array]:
        """Coefficients (k, b, F, 2) of sections in chords, and derivatives (k, b, r + 1, F, 2)."""
        from bladegen.parametric import coefficient_kernels as kernels
        from bladegen.support.compiled import announced

        announced(kernels.linearised)
        outline, t = self.outline, self.chain.t
        batch, parts = outline.batch, outline.batch.parts
        raw, target = outline.coefficients(t), np.ascontiguousarray(self.chain.target.T)
        standing = batch.standing(target)
        moving = np.zeros_like(standing)
        rows = np.flatnonzero(~batch.standing.alone)
        if batch.chord_line == KEPT and rows.size:
            moving[rows] = self._line_slopes(rows, target[rows])
        result = np.empty(raw.shape)
        changes = np.empty((*raw.shape[:2], self.parameters.modes + 1, *raw.shape[2:]))
        given = [batch.blade.u, outline.landmarks, outline.slopes, raw]
        given += [parts.weighted(t, batch.weight), parts.gram, parts.shapes[2], target]
        given = laid_out(*given, standing, moving)
        kept = batch.chord_line == KEPT
        side_by_side(
            partial(kernels.linearised, *given, kept, result, changes),
            shares_of(target.size * changes.shape[2] * len(batch.blade.u)),
        )
        return result, changes

    def _line_slopes(self, rows: Indices, target: Array) -> Array:
        """Return how the baseline's chord lines (m, b, 4) move with relative thickness (m, b)."""
        from bladegen.parametric import coefficient_kernels as kernels

        batch = self.outline.batch
        plain = batch.parts.plain[rows]
        raw, result = np.repeat(plain, target.shape[1], axis=1), np.zeros((*target.shape, 4))
        given = [batch.blade.u, batch.features[rows], batch.parts.slopes[rows], raw, target]
        kernels.lines_slopes(*laid_out(*given), result)
        return result

    def points(
        self, chain: Array, width_chain: Array, space_chain: Array, to_space: Array | None = None
    ) -> tuple[Array, Array]:
        """Return sections (b, k, n, 3), and derivatives (b, k, n, 3, q) along directions.

        The directions are given as `Chain.ways`; the maps to space are the variants' or others.
        """
        from bladegen.parametric import kernels

        c, changes = self.coefficients
        kind, width, _ = self.chain.edge
        values = self.outline.values
        shape = (*width.shape, values.shape[-1], 3)
        sections, result = np.empty(shape), np.empty((*shape, chain.shape[-1]))
        to_space = self.chain.space[0] if to_space is None else to_space
        placed = laid_out(width, to_space, chain, width_chain, space_chain)
        given = *laid_out(values), c, changes, kind, *placed, sections, result
        side_by_side(partial(kernels.points_slopes, *given), shares_of(result.size))
        return sections, result

    def jacobian(self) -> tuple[Array, Array]:
        """Return sections (b, k, n, 3) and their derivatives (b, k, n, 3, p)."""
        return self.points(*self.chain.ways)

    def jvp(self, dx: Array) -> tuple[Array, Array]:
        """Return sections and derivatives (b, k, n, 3) along directions dx (b, p)."""
        ways = (
            np.sum(part * dx.reshape(len(dx), *(1,) * (part.ndim - 2), -1), axis=-1, keepdims=True)
            for part in self.chain.ways
        )
        sections, result = self.points(*ways)
        return sections, result[..., 0]

    def flat(self) -> tuple[Array, Array]:
        """Return sections (b, k, n, 2) [m] in their planes, and derivatives (b, k, n, 2, p).

        Along the chord from the leading edge, and normal to it.
        """
        chain = self.chain
        plane = np.zeros((3, 3))
        plane[0, 0] = plane[1, 1] = 1.0
        chord, slopes = chain.planform[0], chain.chord_slopes
        to_plane = chord[..., None, None] * plane
        changes = slopes[:, :, None, None] * plane[..., None]
        points, made = self.points(chain.own_slopes, chain.edge[2], changes, to_plane)
        return points[..., :2], made[..., :2, :]

    def vjp(self, gradient: Array) -> Array:
        """Return the gradient (b, p) in x of what has a gradient (b, k, n, 3) in points."""
        from bladegen.parametric import kernels

        c, changes = self.coefficients
        kind, width, _ = self.chain.edge
        shape = width.shape
        own, in_width = np.empty((*shape, changes.shape[2])), np.empty(shape)
        in_space = np.empty((*shape, 3, 3))
        placed = laid_out(width, self.chain.space[0], gradient)
        made = own, in_width, in_space
        given = *laid_out(self.outline.values), c, changes, kind, *placed, *made
        side_by_side(partial(kernels.points_gradient, *given), shares_of(gradient.size))
        parts = (
            np.einsum(how, given, way)
            for how, given, way in zip(
                ("bkq,bkqp->bp", "bk,bkp->bp", "bkij,bkijp->bp"),
                (own, in_width, in_space),
                self.chain.ways,
                strict=True,
            )
        )
        result: Array = sum(parts, np.zeros(self.x.shape))
        return result

    def sections(self) -> Array:
        """Return sections (b, k, n, 3) alone."""
        shape = self.chain.target.shape
        none = [np.zeros((*shape, *size, 0)) for size in ((self.parameters.modes + 1,), (), (3, 3))]
        return self.points(*none)[0]
