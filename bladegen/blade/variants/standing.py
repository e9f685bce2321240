"""Where changes of shape leave the chord lines of many variants' sections: on the baseline's."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.airfoils.chord_lines import KEPT, ChordLines, Motions
from bladegen.blade.variants.features import Features
from bladegen.support.arrays import Array, Indices, Mask, laid_out

__all__ = ["Standing"]


@dataclass(frozen=True, eq=False)
class Standing:
    """The baseline's chord lines, or its motions, at the relative thickness of variants.

    Parameters
    ----------
    features : Features
        Of the baseline's sections.
    ruling : (k,) array
        Their relative thickness.
    chord_line : str
        What a change of shape does with the chord line, as for `Blade.perturbed`.
    """

    features: Features
    ruling: Array
    chord_line: str

    @cached_property
    def _own(self) -> tuple[ChordLines, Motions]:
        """The baseline's at its own relative thickness, and how they got there."""
        return self.features.blade.shape.chord_lines(self.features.eta, self.ruling)

    @property
    def alone(self) -> Mask:
        """Where the baseline's chord line is the same at any relative thickness, (k,)."""
        return self._own[0].alone

    def __call__(self, target: Array) -> Array:
        """Return where sections of relative thickness (k, b) shall stand, (k, b, 4).

        Nose and trailing-edge midpoint of the chord lines that they keep, or the motions that
        the baseline's own sections took: cosine and sine, and the shift.
        """
        result = np.repeat(self._numbers(*self._own)[:, None], target.shape[1], axis=1)
        # where two noses compete, the line depends on the thickness
        two = np.flatnonzero(~self.alone & np.any(target != self.ruling[:, None], axis=1))
        if two.size:
            result[two] = self._measured(two, target[two])
        return result

    def _numbers(self, lines: ChordLines, motions: Motions) -> Array:
        kept = self.chord_line == KEPT
        parts = [lines.nose, lines.edge] if kept else [motions.R[:, 0], motions.s]
        return np.concatenate(parts, axis=-1)

    def _measured(self, rows: Indices, target: Array) -> Array:
        """Return what a call does, (m, b, 4), for some sections, measured at their thickness."""
        features, shape = self.features, target.shape
        if features.blade.deformations or self.chord_line != KEPT:
            eta = np.repeat(features.eta[rows], shape[1])
            found = features.blade.shape.chord_lines(eta, np.ravel(target))
            return self._numbers(*found).reshape(*shape, 4)
        from bladegen.blade.variants import kernels

        raw = np.repeat(features.plain[rows], shape[1], axis=1)
        given = features.blade.u, features.values[rows], features.slopes[rows], raw, target
        result = np.empty((*shape, 4))
        kernels.lines(*laid_out(*given), result)
        return result
