"""What a blade's sections are before they are placed in space: a loft, deformed and thickened.

Span fractions to sections of unit chord and of the relative thickness that rules.  A deformed
shape shares its `Loft` with the shape that it was made from, and with it all that the loft has
computed.
"""

from dataclasses import dataclass, replace

from bladegen.airfoils.chord_lines import KEPT, ChordLines, Motions
from bladegen.blade.deformation import Deformation, Thickening
from bladegen.blade.loft import Loft
from bladegen.blade.spans import landmarks_at, span_fractions
from bladegen.shapes import affine
from bladegen.support.arrays import Array, ArrayLike

__all__ = ["Shape"]


@dataclass(frozen=True, eq=False)
class Shape:
    """Unit-chord sections as a function of span.

    Parameters
    ----------
    loft : Loft
        The stations' airfoils joined over span.
    deformations : tuple of Deformation
        Applied to the loft's shapes, one after the other.
    thickenings : tuple of callable
        Factors of the relative thickness over span.
    """

    loft: Loft
    deformations: tuple[Deformation, ...] = ()
    thickenings: tuple[Thickening, ...] = ()

    def __repr__(self) -> str:
        return f"<Shape of {self.loft!r}, {len(self.deformations)} deformations>"

    @property
    def points(self) -> Array:
        """The stations' shapes as points of Gr(n, 2), deformations included, (s, n, 2)."""
        return self._deformed(self.loft.representatives, self.loft.eta)

    def profiles(self, eta: ArrayLike, u: Array | None = None) -> Array:
        """Return unit-chord sections (..., n, 2): see `Blade.profiles`."""
        spans = span_fractions(eta)
        u = u if u is None else landmarks_at(u, 1)
        flat, loft = spans.reshape(-1), self.loft
        path = loft.at(flat)
        opening = loft.opening(flat, *path)
        points = opening(affine.restore(*path))
        wanted = self._target(flat, points)
        finer = points
        if u is not None:
            finer = opening(affine.restore(loft.between(u) @ path[0], *path[1:]))
        if self.deformations:
            stages = self._stages(flat, points)
            change = stages[-1] - points
            finer = finer + (change if u is None else loft.splines.values(u) @ change)
            A, c, *_ = self._restored(stages, wanted)
        else:
            A, c = loft.splines.normalising(points, wanted)
        result = affine.restore(finer, A, c)
        return result.reshape(*spans.shape, *result.shape[1:])

    def relative_thickness(self, eta: ArrayLike) -> Array:
        """Return the relative thickness of the sections at `eta`."""
        spans = span_fractions(eta)
        curves = self.loft.splines.fit(self.profiles(spans.reshape(-1)))
        return curves.relative_thickness.reshape(spans.shape)

    def shapes(self, eta: Array) -> tuple[Array, Array, Array, Array]:
        """Return the shapes (k, n, 2) at span fractions (k,), the same deformed, and M and b.

        Shapes are the path's, their trailing edges brought to width.  ``points @ M + b`` are
        sections before they are brought to unit chord and thickness; bases join over span.
        """
        plain, M, b = self.loft.shapes(eta)
        return plain, self._deformed(plain, eta), M, b

    def wanted_thickness(self, eta: Array) -> Array | None:
        """Return the relative thickness that rules at span fractions (k,), None if none does."""
        return self._target(eta, affine.restore(*self.loft.shapes(eta)))

    def chord_lines(self, eta: Array, thickness: Array | None) -> tuple[ChordLines, Motions]:
        """Return chord lines of the sections at span fractions (k,), and how they got there.

        That is where these sections have them if they are brought to the relative `thickness`
        (k,), and the motions that the last deformation that keeps them took.
        """
        stages = self._stages(eta, affine.restore(*self.loft.shapes(eta)))
        return self._restored(stages, thickness)[2:]

    def _deformed(self, X: Array, eta: Array) -> Array:
        for deformation in self.deformations:
            X = deformation(X, eta)
        return X

    def _stages(self, eta: Array, points: Array) -> list[Array]:
        """Return sections (k, n, 2) before and after each deformation, not brought to size."""
        X, M, _ = affine.standardise(points)
        stages = [points]
        for deformation in self.deformations:
            deformed = deformation(X, eta)
            stages.append(stages[-1] + (deformed - X) @ M)
            X = deformed
        return stages

    def _restored(
        self, stages: list[Array], thickness: Array | None
    ) -> tuple[Array, Array, ChordLines, Motions]:
        """Return the maps that bring the last of `_stages` to size and to its chord line.

        The line is that of the stage before, but where a deformation leaves it as the paper
        does.  The lines and the last motions are returned besides.
        """
        motions = Motions.none(len(stages[0]))
        curves = self.loft.splines.fit(stages[0])
        A, c = curves.normalising(thickness)
        lines = ChordLines.of(curves.mapped(A, c))
        alone = lines.alone
        for deformation, points in zip(self.deformations, stages[1:], strict=True):
            curves = self.loft.splines.fit(points)
            A, c = curves.normalising(thickness)
            own = ChordLines.of(curves.mapped(A, c))
            alone = alone & own.alone
            if deformation.chord_line == KEPT:
                motions = own.onto(lines)
            else:
                lines = own.moved(motions)
        return *motions.after(A, c), replace(lines, alone=alone), motions

    def _target(self, eta: Array, points: Array) -> Array | None:
        """Return the relative thickness that sections shall have; None if nothing rules it.

        Without a distribution, a perturbed shape keeps the thickness it had.
        """
        target = self.loft.ruling(eta)
        if target is None and (self.deformations or self.thickenings):
            target = self.loft.splines.fit(points).relative_thickness
        if target is not None:
            for thickening in self.thickenings:
                target = target * thickening(eta)
        return target
