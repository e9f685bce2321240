"""Mean and principal modes of many shapes, which are handled in chunks that bound memory."""

from collections.abc import Iterator

import numpy as np

from bladegen.airfoils.landmarks import landmark_parameters
from bladegen.errors import GeometryError, SpaceError
from bladegen.shapes import grassmann
from bladegen.shapes.saved_spaces import NO_SPREAD
from bladegen.support.arguments import numbers
from bladegen.support.arrays import Array
from bladegen.support.threads import one_thread

__all__ = ["checked", "chunks", "parameters", "principal"]

CHUNK = 1000  # shapes handled at once: bounds memory to some tens of megabytes
TOLERANCE = 1e-10  # mean tangent at the Karcher mean [rad]
STEPS = 100


def principal(points: Array, modes: int) -> tuple[Array, Array, Array]:
    """Return the Karcher mean of shapes, principal modes there, and all variances.

    Parameters
    ----------
    points : (m, n, 2) array
        Orthonormal bases, any representatives.
    modes : int
        How many principal modes.

    Returns
    -------
    mean, modes, variances : (n, 2), (modes, n, 2), (2 n,) arrays
        Modes are tangent vectors; variances are those of all directions, largest first [rad^2].

    Raises
    ------
    SpaceError
        If too few of the shapes differ.
    GeometryError
        If the mean does not converge.
    """
    with one_thread():
        return _principal(points, modes)


def _principal(points: Array, modes: int) -> tuple[Array, Array, Array]:
    count, n, _ = points.shape
    mean = _karcher_mean(points)
    # The covariance acts on tangent vectors as 2n numbers: its Gram matrix is summed up
    # over chunks of shapes, and no n x n projector is formed.
    gram = np.zeros((2 * n, 2 * n))
    for part in chunks(count):
        logs = grassmann.log(mean[None], points[part]).reshape(-1, 2 * n)
        gram += logs.T @ logs
    variances, vectors = np.linalg.eigh(gram / count)
    variances = np.maximum(variances[::-1], 0.0)
    if not variances[modes - 1] >= NO_SPREAD**2:
        spread = int(np.count_nonzero(variances >= NO_SPREAD**2))
        raise SpaceError(f"modes: got {modes}, the shapes vary in {spread} directions only")
    kept = _horizontal(mean, vectors[:, : -modes - 1 : -1].T.reshape(modes, n, 2))
    return mean, kept, variances


def chunks(count: int) -> Iterator[slice]:
    """Give slices of so many shapes as are handled at once."""
    return (slice(first, first + CHUNK) for first in range(0, count, CHUNK))


def _karcher_mean(points: Array) -> Array:
    """Return the Karcher mean of many points, by gradient steps.

    The sum of the logarithms Y G - X H is (sum of Y G) - X (sum of H) with 2 x 2 matrices G and
    H, so a step is two products with the matrix of all landmarks and never forms a logarithm.
    """
    count, n, _ = points.shape
    landmarks = np.ascontiguousarray(np.moveaxis(points, 0, 1)).reshape(n, 2 * count)
    mean, length = points[0], np.inf
    for _ in range(STEPS):
        overlaps = np.moveaxis((mean.T @ landmarks).reshape(2, count, 2), 0, 1)
        G, H = grassmann.log_factors(overlaps)
        tangent = (landmarks @ G.reshape(2 * count, 2) - mean @ H.sum(axis=0)) / count
        length = float(grassmann.norm(tangent))
        if length <= TOLERANCE:
            return grassmann.align(points[0], mean)
        mean = np.linalg.qr(grassmann.exp(mean, tangent)).Q
    raise GeometryError(
        f"Karcher mean of {count} shapes: not converged after {STEPS} steps: the mean tangent is "
        f"{length:.1e} rad, allowed is {TOLERANCE:.1e}"
    )


def _horizontal(mean: Array, modes: Array) -> Array:
    """Make modes horizontal at the mean and orthonormal, to rounding; fix their signs.

    A mode's sign is free; its largest entry is made positive, so that fits can be compared.
    """
    horizontal = modes - mean @ (mean.T @ modes)
    flat = horizontal.reshape(len(modes), -1)
    Q, R = np.linalg.qr(flat.T)
    flat = (Q * np.sign(np.diag(R))).T
    largest = flat[np.arange(len(flat)), np.argmax(np.abs(flat), axis=1)]
    signed: Array = (flat * np.sign(largest)[:, None]).reshape(modes.shape)
    return signed


def parameters(n: int) -> Array:
    """Return landmark parameters of n points that may be no airfoil's."""
    return landmark_parameters(n) if n % 2 and n >= 5 else np.linspace(0.0, 1.0, n)


def checked(points: Array, field: str, n: int | None = None) -> Array:
    """Return shapes (..., n, 2) as an array, or say that they are none."""
    values = numbers(points, field, SpaceError, "points of Gr(n, 2), (..., n, 2)")
    if values.ndim < 2 or values.shape[-1] != 2 or (n is not None and values.shape[-2] != n):
        wanted = f"(..., {'n' if n is None else n}, 2)"
        raise SpaceError(f"{field}: got the shape {values.shape}, must be {wanted}")
    return values
