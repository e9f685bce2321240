"""Modes of a clamped straight beam that does not turn, and ElastoDyn's polynomials of them.

In: mass and stiffness at places along the beam, which change evenly in between.  Out: frequencies
and shapes.  Bending by cubic (Hermite) elements of Euler and Bernoulli, torsion by linear ones,
both consistent (Przemieniecki, Theory of Matrix Structural Analysis, 1968, chapters 5 and 11).
"""

import numpy as np

from bladegen.support.arrays import Array

__all__ = ["POWERS", "bending", "polynomial", "torsion"]

ELEMENTS = 80  # more lose digits
GAUSS = np.polynomial.legendre.leggauss(4)  # exact for even properties times cubics squared
POWERS = np.arange(2, 7)  # of ElastoDyn's shapes


def bending(along: Array, stiffness: Array, mass: Array, count: int) -> tuple[Array, Array]:
    """Return the first frequencies (count,) [Hz] and shapes (count, m) of a beam that bends.

    Shapes are at m places, even over the length, and 1 at the tip.
    """
    size = along[-1] / ELEMENTS
    t = 0.5 * (GAUSS[0] + 1.0)
    value = np.stack(
        [
            1.0 - 3.0 * t**2 + 2.0 * t**3,
            size * (t - 2.0 * t**2 + t**3),
            3.0 * t**2 - 2.0 * t**3,
            size * (t**3 - t**2),
        ]
    )
    curved = np.stack(
        [12.0 * t - 6.0, size * (6.0 * t - 4.0), 6.0 - 12.0 * t, size * (6.0 * t - 2)]
    )
    stiff = _assembled(along, stiffness, curved / size**2, 2)
    heavy = _assembled(along, mass, value, 2)
    values, vectors = _clamped(stiff, heavy, 2, count)
    shapes = np.concatenate([np.zeros((1, count)), vectors[::2]])
    return np.sqrt(values) / (2.0 * np.pi), (shapes / shapes[-1]).T


def torsion(along: Array, stiffness: Array, inertia: Array) -> float:
    """Return the first frequency of a beam that twists [Hz]."""
    size = along[-1] / ELEMENTS
    t = 0.5 * (GAUSS[0] + 1.0)
    slope = np.stack([-np.ones_like(t), np.ones_like(t)]) / size
    stiff = _assembled(along, stiffness, slope, 1)
    heavy = _assembled(along, inertia, np.stack([1.0 - t, t]), 1)
    return float(np.sqrt(_clamped(stiff, heavy, 1, 1)[0][0]) / (2.0 * np.pi))


def polynomial(shape: Array) -> Array:
    """Return the factors (5,) of the powers 2 to 6 that are nearest to a shape, 1 in their sum."""
    x = np.linspace(0.0, 1.0, len(shape))
    powers = x[:, None] ** POWERS
    found, *_ = np.linalg.lstsq(powers[:, :-1] - powers[:, -1:], shape - powers[:, -1], rcond=None)
    return np.append(found, 1.0 - found.sum())


def _assembled(along: Array, values: Array, form: Array, each: int) -> Array:
    """Return the matrix of all elements: the integral of values times forms (f, g) squared."""
    size = along[-1] / ELEMENTS
    places = size * (np.arange(ELEMENTS)[:, None] + 0.5 * (GAUSS[0] + 1.0))
    weight = 0.5 * size * GAUSS[1] * np.interp(places, along, values)
    own = np.einsum("eg,ig,jg->eij", weight, form, form)
    whole = np.zeros((each * (ELEMENTS + 1),) * 2)
    for k, element in enumerate(own):
        part = slice(each * k, each * k + len(element))
        whole[part, part] += element
    return whole


def _clamped(stiff: Array, heavy: Array, held: int, count: int) -> tuple[Array, Array]:
    from scipy.linalg import eigh

    found = eigh(stiff[held:, held:], heavy[held:, held:], subset_by_index=[0, count - 1])
    return np.asarray(found[0]), np.asarray(found[1])
