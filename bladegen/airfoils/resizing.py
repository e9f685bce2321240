"""Maps of GL2 that bring measured sections to unit chord and to a relative thickness.

With rows for points, ``points @ A + c``: a stretch normal to the chord line, which keeps leading
edge and trailing-edge midpoint, and a scaling.  No point of the Grassmannian is moved.
"""

from typing import NamedTuple

import numpy as np

from bladegen.support.arrays import Array, Indices, Mask

__all__ = ["LITTLE", "Sizing", "stretching"]

LITTLE = 0.02  # of a thickness; stretches by less make no sharp nose a round one


class Sizing(NamedTuple):
    """Maps that bring sections to size.

    Parameters
    ----------
    A, c : (k, 2, 2), (k, 2) arrays
        The maps, ``points @ A + c``.
    rows : (m,) array of int
        The sections that may have a round or another nose then.
    noses, alone : (m, 2), (m,) arrays
        Their leading edges then, and where one point is clearly the farthest.
    """

    A: Array
    c: Array
    rows: Indices
    noses: Array
    alone: Mask

    def but(self, places: Indices, others: "Sizing | None") -> "Sizing":
        """Return these with others at some places (m,)."""
        if others is None:
            return self
        A, c = self.A.copy(), self.c.copy()
        A[places], c[places] = others.A, others.c
        stay = ~np.isin(self.rows, places)
        rows = np.concatenate([self.rows[stay], places[others.rows]])
        noses = np.concatenate([self.noses[stay], others.noses])
        return Sizing(A, c, rows, noses, np.concatenate([self.alone[stay], others.alone]))


def stretching(start: Array, normal: Array, stretch: Array, reach: Array) -> tuple[Array, Array]:
    """Return the maps that stretch along a normal from a point, then bring a reach to unit chord.

    Parameters
    ----------
    start, normal : (k, 2) arrays
        A point of the chord line, and its unit normal.
    stretch, reach : (k,) arrays

    Returns
    -------
    A, c : (k, 2, 2), (k, 2) arrays
        ``points @ A + c``; the chord line stays but for the scaling.
    """
    lift = (stretch - 1.0)[..., None, None] * normal[..., :, None] * normal[..., None, :]
    scale = 1.0 / reach
    shift = -(start[..., None, :] @ lift)[..., 0, :] * scale[..., None]
    return scale[..., None, None] * (np.eye(2) + lift), shift
