"""A mean shape and modes at other landmark parameters: splines through their own landmarks."""

import numpy as np

from bladegen.airfoils.section_splines import SectionSplines
from bladegen.errors import SpaceError
from bladegen.shapes.saved_spaces import ORTHONORMAL
from bladegen.support.arrays import Array

__all__ = ["evaluated"]

HALVED = 16  # times the error of a cubic spline through half of the landmarks is that of all
COARSE = 1e-3  # of a shape's root mean square size; splines must be right to this share


def evaluated(u: Array, mean: Array, modes: Array, at: Array) -> tuple[Array, Array]:
    """Return a mean and modes with landmarks at other parameters.

    Parameters
    ----------
    u : (n,) array
        The landmark parameters that they have.
    mean, modes : (n, 2), (r, n, 2) arrays
        An orthonormal basis, and tangent vectors there.
    at : (m,) array
        The landmark parameters that they shall have.

    Returns
    -------
    mean, modes : (m, 2), (r, m, 2) arrays
        The mean orthonormal, modes horizontal there; orthonormal they need not be.

    Raises
    ------
    SpaceError
        If their own landmarks are too few for it, or those asked for too few for the modes.
    """
    _require_fine(u, mean, modes)
    matrix = SectionSplines(u).values(at)
    mean = matrix @ mean
    mean -= mean.mean(axis=0)
    squares, axes = np.linalg.eigh(mean.T @ mean)
    if len(at) < len(modes) + 3 or squares[0] < ORTHONORMAL * squares[1]:
        raise SpaceError(f"{len(at)} landmarks are too few for {len(modes)} modes")
    scale = (axes / np.sqrt(squares)) @ axes.T
    modes = matrix @ modes @ scale
    modes -= modes.mean(axis=-2, keepdims=True)
    mean = mean @ scale
    return mean, modes - mean @ (mean.T @ modes)


def _require_fine(u: Array, mean: Array, modes: Array) -> None:
    """Raise if the landmarks are too few to say what lies between them."""
    columns = np.concatenate([mean[None], modes])
    half = np.union1d(np.arange(0, len(u), 2), [len(u) - 1])  # both ends, of an even number too
    halves = SectionSplines(u[half]).values(u) if len(u) >= 9 else None
    missed = np.inf if halves is None else np.abs(halves @ columns[:, half] - columns).max()
    error = float(missed) * np.sqrt(len(u)) / HALVED
    if not error <= COARSE:
        raise SpaceError(
            f"space: its {len(u)} landmarks are too coarse to be evaluated at others "
            f"(an error of {error:.1g}, allowed is {COARSE:g} of a shape's size); build the "
            f"blade with landmarks={len(u)} (--landmarks {len(u)})"
        )
