"""How far a blade's points lie from another's, landmark by landmark: quick, for many variants."""

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["offsets"]


def offsets(sections: Array, reference: Array) -> Array:
    """Return the distances (..., k, n) [m] of points from a reference's along its normals.

    Parameters
    ----------
    sections : (..., k, n, 3) array
        Of variants [m].
    reference : (k, n, 3) array
        Of the baseline, at the same spans and landmarks.

    Returns
    -------
    (..., k, n) array
        Positive outside of the reference.  What a point moves along the skin does not count.
    """
    along, around = np.gradient(reference, axis=0), np.gradient(reference, axis=1)
    normals = np.cross(along, around)
    inward = np.sum(normals * (reference - reference.mean(axis=1, keepdims=True))) < 0.0
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True) * (-1.0 if inward else 1.0)
    return np.asarray(np.sum((sections - reference) * normals, axis=-1))
