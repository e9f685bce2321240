"""The features of sections at any points of their contours, not only at landmarks.

Between landmarks a blade's section follows its airfoils' own contours, and what a deformation adds
follows splines through the landmarks.  So there are two features more than landmarks have: by
how much the contours differ from the splines.  They vanish at landmarks.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.blade.variants.batch import SectionBatch
from bladegen.support.arrays import Array

__all__ = ["Outline"]


@dataclass(frozen=True, eq=False)
class Outline:
    """Features of a batch's sections at landmark parameters u (m,), or at its landmarks.

    Parameters
    ----------
    batch : SectionBatch
        Whose sections.
    u : (m,) array, optional
        Landmark parameters, symmetric about 0.5, 0 and 1 among them.
    """

    batch: SectionBatch
    u: Array | None = None

    @cached_property
    def values(self) -> Array:
        """The features (k, F, m) at the points."""
        if self.u is None:
            return self.batch.features
        blade, parts, eta = self.batch.blade, self.batch.parts, self.batch.eta
        loft = blade.shape.loft
        splined = parts.values[:, :-1] @ loft.splines.values(self.u).T
        finer = loft.finer(loft.sections(eta), eta, self.u)
        _, _, M, b = parts.shapes
        own = ((finer - b[:, None]) @ np.linalg.inv(M)).mT - splined[:, :2]
        return np.concatenate([splined, own, np.ones((len(own), 1, len(self.u)))], axis=1)

    @cached_property
    def landmarks(self) -> Array:
        """The same features (k, F, n) at the landmarks."""
        values = self.batch.features
        if self.u is None:
            return values
        return np.concatenate(
            [values[:, :-1], np.zeros_like(values[:, :2]), values[:, -1:]], axis=1
        )

    @cached_property
    def slopes(self) -> Array:
        """The slopes (k, n, F) of their splines at the landmarks."""
        slopes = self.batch.parts.slopes
        if self.u is None:
            return slopes
        still = np.zeros_like(slopes[..., :2])
        return np.concatenate([slopes[..., :-1], still, slopes[..., -1:]], axis=-1)

    def coefficients(self, t: Array) -> Array:
        """Return the coefficients (k, b, F, 2) of raw sections at coordinates t."""
        raw = self.batch.coefficients(t)
        if self.u is None:
            return raw
        M = np.broadcast_to(self.batch.parts.shapes[2][:, None], (*raw.shape[:2], 2, 2))
        return np.concatenate([raw[:, :, :-1], M, raw[:, :, -1:]], axis=2)
