"""The shape half of a blade: what its sections are before they are placed in space.

Stations' shapes are joined on Gr(n, 2) by a path, and their affine maps by splines; trailing
edges are brought to their width over span; deformations act on what results.  Span fractions
(k,) to unit-chord sections (k, n, 2).
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from bladegen.airfoils.chord_lines import KEPT, ChordLines, Motions
from bladegen.airfoils.curves import SectionSplines
from bladegen.airfoils.landmarks import Contour
from bladegen.blade.edge_widths import EdgeWidths, Joining
from bladegen.blade.paths import Parameter, Path, PathMaker, SectionSpline
from bladegen.blade.perturbation import Perturbable
from bladegen.definition.blade_definition import pchip
from bladegen.shapes import affine
from bladegen.support.arrays import Array

__all__ = ["Shaped"]

SAME_SHAPE = 1e-10  # of the largest singular value; stations may repeat an airfoil


class Shaped(Perturbable):
    """The shape half of `Blade`, which is its only kind and holds these fields."""

    if TYPE_CHECKING:
        representatives: Array
        M: Array
        b: Array
        path: PathMaker
        edge_width: Joining | None
        contours: tuple[Contour, ...] | None

    @cached_property
    def splines(self) -> SectionSplines:
        """Splines through sections with the blade's landmarks."""
        return SectionSplines(self.u)

    @cached_property
    def parameter(self) -> Parameter:
        """The path's parameter as a function of span."""
        return Parameter(self.eta, self.definition.relative_thickness)

    @cached_property
    def _joined(self) -> tuple[Path, SectionSpline]:
        # A representative's rotation is moved to the tip's M first, so that no result
        # depends on which representatives `points` holds.
        knots = self.parameter.knots
        angle, _ = affine.polar(self.M[-1:])
        turn = affine.from_polar(angle, np.zeros((1, 2, 2)))
        path, M = self.path(knots, self.representatives @ turn, turn.mT @ self.M)
        return path, SectionSpline(knots, M, self.b)

    @property
    def shape_path(self) -> Path:
        """The path on the Grassmannian, a function of `parameter`."""
        return self._joined[0]

    def wanted_thickness(self, eta: Array) -> Array | None:
        """Return the relative thickness that rules at span fractions (k,), None if none does."""
        plain, _, M, b = self.shapes(eta)
        return self._target(eta, affine.restore(plain, M, b))

    @property
    def points(self) -> Array:
        """The stations' shapes as points of Gr(n, 2), deformations included, (s, n, 2)."""
        return self._deformed(self.representatives, self.eta)

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
        curves = self.splines.fit(stages[0])
        A, c = curves.normalising(thickness)
        lines = ChordLines.of(curves.mapped(A, c))
        alone = lines.alone
        for deformation, points in zip(self.deformations, stages[1:], strict=True):
            curves = self.splines.fit(points)
            A, c = curves.normalising(thickness)
            own = ChordLines.of(curves.mapped(A, c))
            alone = alone & own.alone
            if deformation.chord_line == KEPT:
                motions = own.onto(lines)
            else:
                lines = own.moved(motions)
        return *motions.after(A, c), replace(lines, alone=alone), motions

    def chord_lines(self, eta: Array, thickness: Array | None) -> tuple[ChordLines, Motions]:
        """Return chord lines of the sections at span fractions (k,), and how they got there.

        That is where sections of this blade have them if they are brought to the relative
        `thickness` (k,), and the motions that the last deformation that keeps them took.
        """
        plain, _, M, b = self.shapes(eta)
        return self._restored(self._stages(eta, affine.restore(plain, M, b)), thickness)[2:]

    def shapes(self, eta: Array) -> tuple[Array, Array, Array, Array]:
        """Return the shapes (k, n, 2) at span fractions (k,), the same deformed, and M and b.

        Shapes are the path's, their trailing edges brought to width.  ``points @ M + b`` are
        sections before they are brought to unit chord and thickness; bases join over span.
        """
        path = self._path(eta)
        opening = self._opening(eta, *path)
        plain, M, b = affine.standardise(opening(affine.restore(*path)))
        return plain, self._deformed(plain, eta), M, b

    def _path(self, eta: Array) -> tuple[Array, Array, Array]:
        """Return the path's points X, M and b at span fractions (k,)."""
        path, spline = self._joined
        q = self.parameter(eta)
        return path(q), *spline(q)

    @cached_property
    def _widths(self) -> EdgeWidths:
        airfoils = affine.restore(self.representatives, self.M, self.b)
        thickness = self._ruling(self.eta)
        return EdgeWidths.through(
            airfoils, self.splines, thickness, self.parameter.knots, self.edge_width or pchip
        )

    def _opening(self, eta: Array, X: Array, M: Array, b: Array) -> Callable[[Array], Array]:
        """Return the map that brings the path's sections, at any points, to their edge's width."""
        if self.edge_width is None:
            return lambda points: points
        landmarks = affine.restore(X, M, b)
        return self._widths.opening(landmarks, self._ruling(eta), self.parameter(eta))

    def _ruling(self, eta: Array) -> Array | None:
        """Return the definition's relative thickness at span fractions (k,), if it has one."""
        thickness = self.definition.relative_thickness
        return None if thickness is None else thickness(eta)

    def _target(self, eta: Array, points: Array) -> Array | None:
        """Return the relative thickness that sections shall have; None if nothing rules it.

        Without a distribution, a perturbed blade keeps the thickness it had.
        """
        target = self._ruling(eta)
        if target is None and (self.deformations or self.thickenings):
            target = self.splines.fit(points).relative_thickness
        if target is not None:
            for thickening in self.thickenings:
                target = target * thickening(eta)
        return target

    def _between(self, u: Array) -> Array:
        """Return the linear map (m, n) from a path's landmarks to its points at `u`.

        Paths run in the span of the stations' shapes, so a map that is right for these is
        right for all that lies between them.
        """
        if self.contours is None:
            return SectionSplines(self.u).values(u)
        airfoils = np.stack([contour.landmarks(u) for contour in self.contours])
        finer = (airfoils - self.b[:, None]) @ np.linalg.inv(self.M)
        columns = np.concatenate([*self.representatives], axis=1)
        return np.concatenate([*finer], axis=1) @ np.linalg.pinv(columns, rcond=SAME_SHAPE)
