"""Arc lengths along plane curves that are piecewise polynomials."""

from typing import TYPE_CHECKING

import numpy as np

from bladegen.support.arrays import Array

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

__all__ = ["divided", "lengths"]

NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)


def lengths(spline: "PPoly", start: Array, end: Array) -> Array:
    """Return the arc lengths between parameters, by Gauss-Legendre quadrature."""
    half = 0.5 * (end - start)[:, None]
    t = 0.5 * (end + start)[:, None] + half * NODES
    speed = np.linalg.norm(spline(t, 1), axis=-1)
    return np.asarray(np.sum(half * speed * WEIGHTS, axis=1))


def divided(u: Array, middle: Array) -> Array:
    """Return the shares of a closed curve's length at places u, of which 1/2 is at share `middle`.

    Parameters
    ----------
    u : (...) array
        0 to 1, around the curve once.
    middle : (...) array
        More than 0 and less than 1; broadcast against `u`.

    Returns
    -------
    (...) array
        Rising from 0 to 1: ``cot(pi share) = cot(pi u) + cot(pi middle)``.

    Notes
    -----
    A map of the circle by fractions of linear functions, thus smooth: lengths in proportion on
    either side of u = 1/2 would change their speed there.  At u = 0 its speed is 1; to first order
    the share is u + (middle - 1/2) sin(pi u)^2.
    """
    angle, shift = np.pi * u, 1.0 / np.tan(np.pi * middle)
    share = np.arctan2(np.sin(angle), np.cos(angle) + shift * np.sin(angle)) / np.pi
    result: Array = np.where(u == 0.5, middle, np.where(u == 1.0, 1.0, share))
    return result
