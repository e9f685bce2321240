"""How far a blade's points lie from another's, landmark by landmark: quick, for many variants."""

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["offsets", "outward_normals"]


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
    return np.asarray(np.sum((sections - reference) * outward_normals(reference), axis=-1))


def outward_normals(sections: Array) -> Array:
    """Return unit normals (k, n, 3) of a surface, outward; zero where it has none."""
    normals = np.cross(np.gradient(sections, axis=0), np.gradient(sections, axis=1))
    if np.sum(normals * (sections - sections.mean(axis=1, keepdims=True))) < 0.0:
        normals = -normals
    length = np.linalg.norm(normals, axis=-1, keepdims=True)
    unit: Array = np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)
    return unit
