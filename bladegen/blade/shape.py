"""What a blade's sections are before they are placed in space: a loft, deformed and thickened.

Span fractions to sections of unit chord and of the relative thickness that rules.  A deformed
shape shares its `Loft` with the shape that it was made from, and with it all that the loft has
computed.
"""

from dataclasses import dataclass, replace

import numpy as np

from bladegen.airfoils.chord_lines import KEPT, ChordLines, Motions
from bladegen.airfoils.section_curves import SectionCurves
from bladegen.blade.changes.deformation import Deformation, Thickening
from bladegen.blade.lofting.joined import JoinedSections
from bladegen.blade.lofting.loft import Loft
from bladegen.blade.spans import landmarks_at, span_fractions
from bladegen.shapes import affine
from bladegen.support.arrays import Array, ArrayLike, Indices

__all__ = ["Shape"]

CHUNK = 260  # spans at once, whose sections a processor's cache holds


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
        result = affine.restore(*self._sized(spans.reshape(-1), u))
        return result.reshape(*spans.shape, *result.shape[1:])

    def at_landmarks(self, eta: Array, some: Indices) -> Array:
        """Return some of the landmarks of the sections at span fractions (k,), (k, m, 2)."""
        parts = []
        for chunk in np.array_split(eta, -(-len(eta) // CHUNK) or 1):
            points, A, c = self._sized(chunk, None)
            parts.append(affine.restore(points[:, some], A, c))
        return np.concatenate(parts)

    def _sized(self, flat: Array, u: Array | None) -> tuple[Array, Array, Array]:
        """Return sections (k, n, 2), and the maps that bring them to size and chord line."""
        loft, joined = self.loft, self.loft.sections(flat)
        wanted = self._target(flat, joined)
        finer = joined.curves.points if u is None else loft.finer(joined, flat, u)
        if self.deformations:
            stages = self._stages(flat, joined)
            points = stages[-1].points
            finer = (
                points
                if u is None
                else finer + loft.splines.between(u, points - joined.curves.points)
            )
            A, c, *_ = self._restored(joined, stages, wanted)
        else:
            A, c = joined.curves.normalising(wanted)
        return finer, A, c

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
        return self._target(eta, self.loft.sections(eta))

    def chord_lines(self, eta: Array, thickness: Array | None) -> tuple[ChordLines, Motions]:
        """Return chord lines of the sections at span fractions (k,), and how they got there.

        That is where these sections have them if they are brought to the relative `thickness`
        (k,), and the motions that the last deformation that keeps them took.
        """
        joined = self.loft.sections(eta)
        return self._restored(joined, self._stages(eta, joined), thickness)[2:]

    def deformed(self, eta: Array) -> SectionCurves:
        """Return the sections at span fractions (k,) deformed, not brought to size."""
        return self._stages(eta, self.loft.sections(eta))[-1]

    def _deformed(self, X: Array, eta: Array) -> Array:
        for deformation in self.deformations:
            X = deformation(X, eta)
        return X

    def _stages(self, eta: Array, joined: JoinedSections) -> list[SectionCurves]:
        """Return sections before and after each deformation, not brought to size."""
        stages = [joined.curves]
        if not self.deformations:
            return stages
        X, M, _ = joined.standardised
        first, *others = self.deformations
        change = joined.carried(first.space).change(first.step(eta), M)
        stages.append(self.loft.splines.fit(joined.curves.points + change))
        if others:
            X = first(X, eta)
        for deformation in others:
            deformed = deformation(X, eta)
            points = stages[-1].points + (deformed - X) @ M
            stages.append(self.loft.splines.fit(points))
            X = deformed
        return stages

    def _restored(
        self, joined: JoinedSections, stages: list[SectionCurves], thickness: Array | None
    ) -> tuple[Array, Array, ChordLines, Motions]:
        """Return the maps that bring the last of `_stages` to size and to its chord line.

        The line is that of the stage before, but where a deformation leaves it as the paper
        does.  The lines and the last motions are returned besides.
        """
        motions = Motions.none(len(joined.curves.points))
        A, c, lines = joined.sized(thickness)
        alone = lines.alone
        for deformation, curves in zip(self.deformations, stages[1:], strict=True):
            A, c, own = ChordLines.sized(curves, thickness)
            alone = alone & own.alone
            if deformation.chord_line == KEPT:
                motions = own.onto(lines)
            else:
                lines = own.moved(motions)
        return *motions.after(A, c), replace(lines, alone=alone), motions

    def _target(self, eta: Array, joined: JoinedSections) -> Array | None:
        """Return the relative thickness that sections shall have; None if nothing rules it.

        Without a distribution, a perturbed shape keeps the thickness it had.
        """
        target = joined.ruling
        if target is None and (self.deformations or self.thickenings):
            target = joined.thickness
        if target is not None:
            for thickening in self.thickenings:
                target = target * thickening(eta)
        return target
