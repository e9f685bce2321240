"""Chord lines of sections, and the motions in the plane that bring one onto another.

A chord line runs from the leading edge, as `noses` finds it, to the middle of the trailing edge.  A
deformation of shape turns it and moves its nose; a rotation and a shift bring both back, and no
point of the Grassmannian moves.  Lengths in chords, rows are points: ``points @ R + s``.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.airfoils.fronts import Front
from bladegen.airfoils.section_curves import SectionCurves
from bladegen.errors import PerturbationError
from bladegen.support.arrays import Array, Mask
from bladegen.support.values import brief

__all__ = ["CONVENTIONS", "KEPT", "PAPER", "ChordLines", "Motions", "angles", "known_convention"]

KEPT, PAPER = "kept", "paper"
CONVENTIONS = (KEPT, PAPER)  # what a deformation does with the chord line


def known_convention(chord_line: str) -> str:
    """Return the name of a convention, or say which there are.

    Raises
    ------
    PerturbationError
        If it is none of `CONVENTIONS`.
    """
    if chord_line not in CONVENTIONS:
        raise PerturbationError(
            f"chord_line: got {chord_line!r}, allowed are {' and '.join(CONVENTIONS)}: the "
            "baseline's, or where the paper's formula leaves it"
        )
    return chord_line


@dataclass(frozen=True, eq=False)
class Motions:
    """Rotations R (k, 2, 2) and shifts s (k, 2), ``points @ R + s``."""

    R: Array
    s: Array

    __repr__ = brief

    @classmethod
    def none(cls, count: int) -> "Motions":
        """Return motions that move nothing."""
        return cls(np.broadcast_to(np.eye(2), (count, 2, 2)), np.zeros((count, 2)))

    def after(self, A: Array, c: Array) -> tuple[Array, Array]:
        """Return the maps ``points @ A + c`` followed by the motions."""
        return A @ self.R, (c[:, None] @ self.R)[:, 0] + self.s


@dataclass(frozen=True, eq=False)
class ChordLines:
    """Leading edges and trailing-edge midpoints, (k, 2) each.

    `alone` (k,) tells where one point is clearly the farthest from the trailing edge: there the
    line is the same whatever relative thickness the section is brought to.
    """

    nose: Array
    edge: Array
    alone: Mask

    __repr__ = brief

    @classmethod
    def of(cls, curves: SectionCurves) -> "ChordLines":
        """Return those of sections."""
        return cls(curves.leading_edge, curves.trailing_edge, ~curves.may_be_round)

    @classmethod
    def sized(
        cls, curves: SectionCurves, thickness: Array | None
    ) -> tuple[Array, Array, "ChordLines"]:
        """Return the maps that bring sections to relative thickness (k,), and the lines then.

        A stretch normal to the chord line keeps a nose that is alone, and the line with it; where
        sections have or may get another, it was measured again.
        """
        A, c, rows, noses, alone_then = curves.sizing(thickness)
        nose, edge = (
            (p[:, None] @ A)[:, 0] + c for p in (curves.leading_edge, curves.trailing_edge)
        )
        alone = ~curves.may_be_round
        nose[rows], alone[rows] = noses, alone_then
        return A, c, cls(nose, edge, alone)

    def moved(self, motions: Motions) -> "ChordLines":
        """Return the lines after motions."""
        nose, edge = (motions.after(np.eye(2), p)[1] for p in (self.nose, self.edge))
        return ChordLines(nose, edge, self.alone)

    def onto(self, other: "ChordLines") -> Motions:
        """Return the motions that bring these lines onto others, nose onto nose."""
        own, wanted = self.edge - self.nose, other.edge - other.nose
        (x, y), (x1, y1) = own.T, wanted.T
        scale = np.hypot(x, y) * np.hypot(x1, y1)
        c, s = (x * x1 + y * y1) / scale, (x * y1 - y * x1) / scale
        R = np.empty((len(c), 2, 2))
        R[:, 0, 0], R[:, 0, 1], R[:, 1, 0], R[:, 1, 1] = c, s, -s, c
        return Motions(R, other.nose - (self.nose[:, None] @ R)[:, 0])


def angles(points: Array, u: Array) -> Array:
    """Return the angles (k,) of chord lines of sections (k, n, 2), from landmarks alone [rad].

    The farthest point is the top of the parabola of distances through the farthest landmark and
    its neighbours: quick, and right to 1e-6 chord on 401 landmarks.  `u` (n,) are their parameters.
    """
    edge = 0.5 * (points[:, 0] + points[:, -1])
    away = points - edge[:, None]
    squares = away[..., 0] ** 2 + away[..., 1] ** 2
    at = np.clip(np.argmax(squares, axis=-1), 1, points.shape[-2] - 2)[:, None]
    a, b, c = (np.take_along_axis(squares, at + i, axis=-1) for i in (-1, 0, 1))
    bend = a - 2.0 * b + c
    h = np.divide(0.5 * (a - c), bend, out=np.zeros_like(bend), where=bend < 0.0)
    before, here, after = (
        np.take_along_axis(away, (at + i)[..., None], axis=-2)[..., 0, :] for i in (-1, 0, 1)
    )
    nose = here + 0.5 * h * (after - before) + 0.5 * h * h * (after - 2.0 * here + before)
    front = Front(u)
    planes, squares = np.moveaxis(points, -1, 0), squares[:, front.ahead]
    places = 0.5 * (np.take(u, at[:, 0] + 1) - np.take(u, at[:, 0] - 1)) * h[:, 0]
    places += np.take(u, at[:, 0])
    top = nose[:, 0] ** 2 + nose[:, 1] ** 2
    shares, means, _, _ = front.led(planes, edge.T, squares, top, places)
    nose += shares[:, None] * (means - nose)
    result: Array = np.arctan2(-nose[..., 1], -nose[..., 0])
    return result
