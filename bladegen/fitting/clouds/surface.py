"""The smooth surface that a cloud of points scatters about, as a mesh.

rho(phi, z) of `coordinates` is a tensor product of cubic B-splines, periodic in phi, fitted to cell
means by least squares with penalties on second differences of its coefficients along phi and z
(Eilers and Marx, Stat. Sci. 11 (1996)).  Their weights are those that predict cells best that were
left out.  Points that lie far off get little weight (Tukey).
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import count
from typing import Any

import numpy as np

from bladegen.errors import GeometryError
from bladegen.fitting.clouds.axis import along
from bladegen.fitting.clouds.coordinates import Ellipses, about
from bladegen.support.arrays import Array, Indices
from bladegen.surface.mesh import TriangleMesh

__all__ = ["Cloud", "Progress", "quiet", "surface_of_points"]

Progress = Callable[[str], None]

FEWEST = 2000  # points of a cloud
AROUND, ALONG = 144, 56  # coefficients along phi and z
CELLS = 720, 480  # along phi and z
WEIGHTS = (1e-6, 1e-4, 1e-2, 1e0)  # of the penalties, times the mean weight of a coefficient
ROUNDS = 3  # of weighting points that lie far off
FITS = 2 * len(WEIGHTS) + ROUNDS
LEFT_OUT = 8  # every so-manieth block of cells: holes are to be bridged
BLOCKS = 4.0, 60.0  # a radian, and a span
FAR, FARTHER = 4.685, 0.1  # standard deviations, Tukey's; and of rho, at least: edges are sharp
ROWS, COLUMNS = 360, 480  # of the mesh
END = 0.002  # of the span, where caps lie


def quiet(_: str) -> None:
    """Say nothing of what is being done."""


@dataclass(frozen=True, eq=False)
class Cloud:
    """A cloud as a surface.

    Parameters
    ----------
    mesh : TriangleMesh
        Open at both ends, in the cloud's axes and unit.
    noise : float
        Standard deviation of the points about it, in that unit.
    rimmed : bool
        Whether its ends are normal to the axis of a root whose rim was seen.
    """

    mesh: TriangleMesh
    noise: float
    rimmed: bool = False


def surface_of_points(points: Array, name: str, progress: Progress = quiet) -> Cloud:
    """Return the surface that points (m, 3) scatter about, telling `progress` what is being done.

    Raises
    ------
    GeometryError
        If they are too few, or no slender body.
    """
    if len(points) < FEWEST:
        raise GeometryError(f"{name}: {len(points)} points, at least {FEWEST} are needed")
    progress(f"smoothing {len(points)} points")
    axes, start, rimmed = along(points, name)
    own = points @ axes - start
    ellipses = about(own)
    length = float(own[:, 2].max())
    inside = (own[:, 2] > END * length) & (own[:, 2] < (1.0 - END) * length)
    rho, phi = ellipses.flattened(own[inside])
    z = own[inside, 2] / length
    cells, counts = _cells(rho, phi, z)
    solved = count(1)
    coefficients = _fitted(
        *cells,
        counts,
        lambda: progress(f"smoothing {len(points)} points, fit {next(solved)} of {FITS}"),
    )
    at_z = np.linspace(0.0, 1.0, ROWS)
    at_phi = _eased(np.linspace(-np.pi, np.pi, COLUMNS, endpoint=False))
    surface = _basis_z(at_z) @ coefficients @ _basis_phi(at_phi).T.toarray()
    flat = ellipses.points(
        surface.ravel(), np.tile(at_phi, ROWS), np.repeat(at_z * length, COLUMNS)
    )
    noise = _noise(ellipses, own[inside], rho, phi, z, coefficients)
    return Cloud(TriangleMesh((flat + start) @ axes.T, _faces()), noise, rimmed)


def _cells(rho: Array, phi: Array, z: Array) -> tuple[tuple[Array, Array, Array], Array]:
    """Return means of rho, phi and z of points in cells, and how many each has."""
    across, along = CELLS
    place = np.interp(phi, _eased(_TABLE), _TABLE)
    i = np.minimum((place + np.pi) / (2.0 * np.pi) * across, across - 1).astype(np.int64)
    j = np.minimum(z * along, along - 1).astype(np.int64)
    cell = j * across + i
    count = np.bincount(cell, minlength=across * along)
    held = np.flatnonzero(count)
    sums = [np.bincount(cell, v, minlength=across * along)[held] for v in (rho, phi, z)]
    n = count[held].astype(np.float64)
    return (sums[0] / n, sums[1] / n, sums[2] / n), n


def _knots() -> Array:
    inner = np.linspace(0.0, 1.0, ALONG - 2)
    inner = inner - 0.12 * np.sin(2.0 * np.pi * inner) / (2.0 * np.pi) * 2.0  # closer at the ends
    return np.concatenate([[0.0] * 3, inner, [1.0] * 3])


def _basis_z(z: Array) -> Any:
    from scipy.interpolate import BSpline

    return BSpline.design_matrix(np.clip(z, 0.0, 1.0), _knots(), 3)


def _basis_phi(phi: Array) -> Any:
    """Return the periodic B-splines at angles, (m, AROUND), whose knots cluster at the edges."""
    from scipy.interpolate import BSpline
    from scipy.sparse import csr_array

    step = 2.0 * np.pi / AROUND
    knots = -np.pi + step * np.arange(-3, AROUND + 4)
    inside = np.clip(np.interp(phi, _eased(_TABLE), _TABLE), -np.pi, np.pi - 1e-12)
    matrix = BSpline.design_matrix(inside, knots, 3).tocoo()
    columns = matrix.coords[1] % AROUND
    return csr_array((matrix.data, (matrix.coords[0], columns)), shape=(len(phi), AROUND))


def _eased(places: Array) -> Array:
    """Return angles phi of even places: those at both edges are five times as close."""
    eased: Array = places - EASE * np.sin(2.0 * places)
    return eased


EASE = 0.4
_TABLE = np.linspace(-np.pi, np.pi, 4001)


def _fitted(rho: Array, phi: Array, z: Array, count: Array, told: Callable[[], None]) -> Array:
    """Return the coefficients (ALONG, AROUND) of cells' means; each fit is told of."""
    design = _rows(_basis_z(z), _basis_phi(phi))
    weight = count.copy()
    chosen = None
    for _ in range(ROUNDS):
        if chosen is None:
            patch = 7 * np.floor(z * BLOCKS[1]) + 3 * np.floor((phi + np.pi) * BLOCKS[0])
            test = patch % LEFT_OUT == 0
            chosen = _best(design, rho, weight, test, told)
        told()
        made = _solved(design, rho, weight, *chosen)
        off = rho - design @ made
        scale = 1.4826 * float(np.median(np.abs(off)))
        share = np.clip(off / max(FAR * scale, FARTHER), -1.0, 1.0)
        weight = count * (1.0 - share * share) ** 2
    return np.asarray(made.reshape(ALONG, AROUND))


def _best(
    design: Any, rho: Array, weight: Array, test: Any, told: Callable[[], None]
) -> tuple[float, float]:
    """Return the penalties' weights that predict the cells best that are left out."""
    kept = np.where(test, 0.0, weight)
    best, least = (WEIGHTS[1], WEIGHTS[1]), np.inf
    rows = design[np.flatnonzero(test)]

    def missed(pair: tuple[float, float]) -> float:
        told()
        off = rho[test] - rows @ _solved(design, rho, kept, *pair)
        return float(np.mean(np.minimum(off * off * weight[test], _most(off, weight[test]))))

    for axis in (0, 1):
        for value in WEIGHTS:
            pair = (value, best[1]) if axis == 0 else (best[0], value)
            found = missed(pair)
            if found < least:
                best, least = pair, found
    return best


def _most(off: Array, weight: Array) -> float:
    """Return the squared error that counts at most: far points are no noise."""
    return float(9.0 * np.median(off * off * weight))


def _solved(design: Any, rho: Array, weight: Array, around: float, along: float) -> Array:
    from scipy.linalg import solveh_banded
    from scipy.sparse import csr_array, diags_array, eye_array, kron

    weighted = csr_array(design.multiply(weight[:, None]))
    normal = weighted.T @ design
    size = float(weight.sum()) / design.shape[1]
    ring = diags_array([1.0, -2.0, 1.0], offsets=[-1, 0, 1], shape=(AROUND, AROUND)).tolil()
    ring[0, -1] = ring[-1, 0] = 1.0
    line = diags_array([1.0, -2.0, 1.0], offsets=[0, 1, 2], shape=(ALONG - 2, ALONG))
    ring = csr_array(ring)
    total = (
        normal
        + size * around * kron(eye_array(ALONG), ring.T @ ring)
        + size * along * kron(line.T @ line, eye_array(AROUND))
        + size * 1e-9 * eye_array(ALONG * AROUND)
    ).tocoo()
    i, j = total.coords
    upper = j >= i
    band = 4 * AROUND
    stored = np.zeros((band + 1, ALONG * AROUND))
    stored[band + i[upper] - j[upper], j[upper]] = total.data[upper]
    return np.asarray(
        solveh_banded(stored, weighted.T @ rho, overwrite_ab=True, check_finite=False)
    )


def _rows(one: Any, other: Any) -> Any:
    """Return the products of B-splines along z and phi, (m, ALONG * AROUND)."""
    from scipy.sparse import csr_array

    m = one.shape[0]
    a, b = csr_array(one), csr_array(other)
    i, u = a.indices.reshape(m, -1), a.data.reshape(m, -1)
    j, v = b.indices.reshape(m, -1), b.data.reshape(m, -1)
    columns = (i[:, :, None].astype(np.int64) * AROUND + j[:, None, :]).reshape(m, -1)
    values = (u[:, :, None] * v[:, None, :]).reshape(m, -1)
    starts = np.arange(m + 1) * columns.shape[1]
    return csr_array((values.ravel(), columns.ravel(), starts), shape=(m, ALONG * AROUND))


def _noise(
    ellipses: Ellipses, points: Array, rho: Array, phi: Array, z: Array, coefficients: Array
) -> float:
    """Return the scatter of points about the surface, from the median of some of them."""
    some = slice(None, None, max(1, len(rho) // 50_000))
    design = _rows(_basis_z(z[some]), _basis_phi(phi[some]))
    there = design @ coefficients.ravel()
    foot = ellipses.points(there, phi[some], points[some, 2])
    step = 1e-4
    aside = ellipses.points(design @ coefficients.ravel(), phi[some] + step, points[some, 2])
    tangent = aside[:, :2] - foot[:, :2]
    normal = tangent[:, ::-1] * [1.0, -1.0]
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    off = np.sum((points[some, :2] - foot[:, :2]) * normal, axis=1)
    return 1.4826 * float(np.median(np.abs(off)))


def _faces() -> Indices:
    i, j = np.meshgrid(np.arange(ROWS - 1), np.arange(COLUMNS), indexing="ij")
    a, b = i * COLUMNS + j, i * COLUMNS + (j + 1) % COLUMNS
    c, d = a + COLUMNS, b + COLUMNS
    one, other = np.stack([a, b, d], axis=-1), np.stack([a, d, c], axis=-1)
    return np.concatenate([one.reshape(-1, 3), other.reshape(-1, 3)])
