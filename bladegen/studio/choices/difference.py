"""Which part of the difference from the baseline is coloured.

All of it, or what is left of each section once the motion (rotation and shift), or the affine map,
that brings the baseline's landmarks nearest to its own, in least squares, is taken out: a change of
twist and prebend is a motion, one of chord and thickness an affine map.  The rotation is that of
W. Kabsch, Acta Crystallographica A32 (1976) 922.
"""

import numpy as np

from bladegen.errors import StudioError
from bladegen.support.arrays import Array

__all__ = ["PARTS", "known_part", "left"]

PARTS = {
    "all": "All of the difference",
    "rigid": "Without motions of sections: twist, prebend",
    "affine": "Without affine maps of sections: chord and thickness, too",
}


def known_part(name: str) -> str:
    """Return a name of `PARTS`, or say which there are."""
    if name not in PARTS:
        raise StudioError(f"off: got {name[:40]!r}, allowed are {', '.join(PARTS)}")
    return name


def left(sections: Array, rest: Array, part: str) -> Array:
    """Return what of the difference of sections (k, n, 3) from others is left, (k, n, 3) [m]."""
    if part == "all":
        return sections - rest
    middle, before = (points.mean(axis=1, keepdims=True) for points in (sections, rest))
    own, plain = sections - middle, rest - before
    mixed = plain.mT @ own
    if part == "affine":  # of plane sections: normal to them nothing is known
        turned = np.linalg.pinv(plain.mT @ plain, rcond=1e-9, hermitian=True) @ mixed
    else:
        U, _, V = np.linalg.svd(mixed)
        sign = np.ones((len(mixed), 3))
        sign[:, 2] = np.sign(np.linalg.det(U @ V))
        turned = (U * sign[:, None]) @ V
    found: Array = own - plain @ turned
    return found
