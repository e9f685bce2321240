"""Class-shape transformation: airfoils from Bernstein coefficients, and the paper's database.

With x over chord, y = sqrt(x) (1 - x) sum_k a_k B_k(x) for each side, B_k the Bernstein
polynomials of degree 8: 9 coefficients a side, 18 in all, suction side first; the trailing-edge
thickness is zero (Kulfan, J. Aircraft 45 (2008), with class exponents 1/2 and 1).
"""

from collections.abc import Iterator
from math import comb

import numpy as np

from bladegen.airfoils.landmarks import landmark_parameters
from bladegen.curves.arc_lengths import divided
from bladegen.shapes import affine
from bladegen.support.arrays import Array

__all__ = ["COEFFICIENTS", "fit", "perturbations", "shapes", "standardised_shapes"]

DEGREE = 8
COEFFICIENTS = 2 * (DEGREE + 1)
FIT_POINTS = 200  # a side, spaced like a cosine
# Of the curve's parameter, over both sides.  Landmarks are right to 1e-10 chord, to 1e-9 where the
# leading edge lies behind x = 0 (a first coefficient above sqrt 2).
CELLS = 1200
STEPS = 3  # towards a place within a cell; each divides what is left by a hundred or more
WITHIN = 1.0 - 1e-12  # of a cell: a place stays in it
CHUNK = 500  # shapes handled at once: bounds memory to some tens of megabytes


def fit(xy: Array) -> tuple[Array, float]:
    """Fit coefficients to an airfoil's landmarks, its trailing-edge wedge taken off.

    Parameters
    ----------
    xy : (n, 2) array
        Landmarks in chords, leading edge in the middle, suction side first.

    Returns
    -------
    coefficients : (18,) array
    residual : float
        RMS distance in y of the landmarks from the fit, the wedge taken off [chord].
    """
    middle = len(xy) // 2
    edge = 0.5 * (xy[0] + xy[-1])
    along = edge - xy[middle]
    chord = float(np.hypot(*along))
    turn = np.array([[along[0], -along[1]], [along[1], along[0]]]) / chord**2
    flat = (xy - xy[middle]) @ turn
    coefficients, squares = [], 0.0
    for side in (flat[middle::-1], flat[middle:]):
        x = np.clip(side[:, 0], 0.0, 1.0)
        y = side[:, 1] - x * side[-1, 1]
        basis = _class(x)[:, None] * _bernstein(x)
        a = np.linalg.lstsq(basis, y, rcond=None)[0]
        coefficients.append(a)
        squares += float(np.sum((basis @ a - y) ** 2))
    return np.concatenate(coefficients), float(np.sqrt(squares / (len(xy) + 1)))


def perturbations(
    coefficients: Array, count: int, rng: np.random.Generator, *, reach: float = 0.2
) -> Array:
    """Return `count` perturbations of each set of coefficients, (m, 18) to (m * count, 18).

    Every coefficient is multiplied by its own number, uniform in 1 - reach to 1 + reach.
    """
    factors = rng.uniform(1.0 - reach, 1.0 + reach, size=(len(coefficients), count, COEFFICIENTS))
    return (coefficients[:, None] * factors).reshape(-1, COEFFICIENTS)


def shapes(coefficients: Array, u: Array, edge: float = 0.0) -> Array:
    """Return landmarks of airfoils, (m, 18) to (m, n, 2), in chords.

    Parameters
    ----------
    coefficients : (m, 18) array
    u : (n,) array
        Landmark parameters, as `landmarks.landmark_parameters` makes them: the leading edge is
        the point farthest from the trailing edge.
    edge : float
        Thickness of the trailing edge [chord]: a wedge added to both sides.

    Returns
    -------
    (m, n, 2) array
        Right to 1e-10 chord, to 1e-9 where the leading edge lies behind x = 0.
    """
    points, tangents = _curve(coefficients, *_grid(), edge)
    speed = np.linalg.norm(tangents, axis=-1)
    nose = _farthest(points, tangents)
    arc = _running_length(points, tangents, speed)
    at_nose = _hermite_at(nose, arc, speed)
    total = arc[:, -1]
    target = total[:, None] * divided(u, (at_nose / total)[:, None])
    place = _inverse(target, arc, speed)
    return np.stack([_hermite_at(place, points[..., i], tangents[..., i]) for i in (0, 1)], axis=-1)


def standardised_shapes(
    coefficients: Array, n: int = 401, *, u: Array | None = None, edge: float = 0.0
) -> Array:
    """Return the points of Gr(n, 2) of airfoils, (m, 18) to (m, n, 2), in chunks.

    `u` and `edge` are those of `shapes`; without `u` the n landmarks lie as `landmarks` has them.
    """
    u = landmark_parameters(n) if u is None else u
    result = np.empty((len(coefficients), len(u), 2))
    for part in _chunks(len(coefficients)):
        result[part] = affine.standardise(shapes(coefficients[part], u, edge))[0]
    return result


def _chunks(count: int) -> Iterator[slice]:
    return (slice(first, first + CHUNK) for first in range(0, count, CHUNK))


def _bernstein(x: Array) -> Array:
    """Bernstein polynomials of degree 8 at x, (..., 9)."""
    k = np.arange(DEGREE + 1)
    weights = np.array([comb(DEGREE, i) for i in k], dtype=np.float64)
    basis: Array = weights * x[..., None] ** k * (1.0 - x[..., None]) ** (DEGREE - k)
    return basis


def _class(x: Array) -> Array:
    """The class function of round-nosed, sharp-tailed airfoils."""
    value: Array = np.sqrt(x) * (1.0 - x)
    return value


def _grid() -> tuple[Array, Array, Array, Array]:
    """A parameter from -pi (suction TE) over 0 (nose) to pi, x, and y's basis and slopes.

    x = (1 - cos phi) / 2 makes y analytic on either side: sqrt(x) = sin(|phi| / 2).  Slopes at
    the nose are those of phi > 0.
    """
    phi = np.pi * np.arange(-(CELLS // 2), CELLS // 2 + 1) / (CELLS // 2)  # 0 is exact
    x = 0.5 * (1.0 - np.cos(phi))
    half = 0.5 * np.abs(phi)
    shape = np.sin(half) * np.cos(half) ** 2
    side = np.where(phi < 0, -1.0, 1.0)
    rate = 0.5 * side * np.cos(half) * (np.cos(half) ** 2 - 2.0 * np.sin(half) ** 2)
    value = shape[:, None] * _bernstein(x)
    lower, upper = np.zeros((2, len(x), DEGREE + 1))
    k = np.arange(DEGREE)
    reduced = np.array([comb(DEGREE - 1, i) for i in k], dtype=np.float64)
    inner = reduced * x[:, None] ** k * (1.0 - x[:, None]) ** (DEGREE - 1 - k)
    lower[:, 1:], upper[:, :-1] = inner, inner
    bernstein_rate = DEGREE * (lower - upper) * (0.5 * np.sin(phi))[:, None]
    slope = rate[:, None] * _bernstein(x) + shape[:, None] * bernstein_rate
    return phi, x, value, slope


def _curve(
    coefficients: Array, phi: Array, x: Array, value: Array, slope: Array, edge: float
) -> tuple[Array, Array]:
    """Points (m, c, 2) of the airfoils on the grid, and slopes (m, c - 1, 2, 2) a cell.

    Slopes are those at each cell's start and end: where the two sides' first coefficients
    differ, the slope of y in phi jumps at the nose.
    """
    middle = len(phi) // 2
    suction, pressure = coefficients[:, : DEGREE + 1], coefficients[:, DEGREE + 1 :]
    y = np.concatenate([suction @ value[:middle].T, pressure @ value[middle:].T], axis=1)
    wedge = np.where(np.arange(len(phi)) < middle, 0.5 * edge, -0.5 * edge)
    points = np.stack([np.broadcast_to(x, y.shape), y + wedge * x], axis=-1)
    # At the nose itself `slope` is that of the pressure side; the suction side's is its negative.
    to_nose = np.concatenate([slope[:middle], -slope[middle : middle + 1]])
    dy = np.concatenate([_ends(suction @ to_nose.T), _ends(pressure @ slope[middle:].T)], axis=1)
    dx = np.broadcast_to(_ends(0.5 * np.sin(phi)), dy.shape)
    dy = dy + wedge[:-1, None] * dx
    return points, np.stack([dx, dy], axis=-1) * (phi[1] - phi[0])


def _ends(values: Array) -> Array:
    """Return values (..., c) on the grid as those at each cell's two ends, (..., c - 1, 2)."""
    return np.stack([values[..., :-1], values[..., 1:]], axis=-1)


def _farthest(points: Array, tangents: Array) -> Array:
    """Return where each curve is farthest from the trailing edge (1, 0), in cells."""
    away = points - [1.0, 0.0]
    row = np.arange(len(points))
    cell = np.argmax(np.sum(away * away, axis=-1), axis=1)
    cell = np.where(np.sum(away[row, cell] * tangents[row, cell, 0], axis=-1) < 0, cell - 1, cell)
    before = np.sum(away[row, cell] * tangents[row, cell, 0], axis=-1)
    after = np.sum(away[row, cell + 1] * tangents[row, cell, 1], axis=-1)
    place: Array = cell + before / (before - after)
    for _ in range(STEPS):
        there = [_hermite_at(place, points[..., i], tangents[..., i]) for i in (0, 1)]
        slope = [_hermite_at(place, points[..., i], tangents[..., i], order=1) for i in (0, 1)]
        rate = (there[0] - 1.0) * slope[0] + there[1] * slope[1]
        place = np.clip(place + rate / (before - after), cell, cell + WITHIN)
    return place


def _running_length(points: Array, tangents: Array, speed: Array) -> Array:
    """Arc length along each curve at the grid, by Simpson's rule on Hermite cells."""
    middle = 1.5 * np.diff(points, axis=1) - 0.25 * tangents.sum(axis=2)
    lengths = (speed.sum(axis=2) + 4.0 * np.linalg.norm(middle, axis=-1)) / 6.0
    return np.concatenate([np.zeros((len(points), 1)), np.cumsum(lengths, axis=1)], axis=1)


def _hermite_at(place: Array, values: Array, slopes: Array, *, order: int = 0) -> Array:
    """Evaluate cubic Hermite functions, or their derivatives, at places (m, ...) in cells.

    `values` are (m, c) on the grid, `slopes` (m, c - 1, 2) at the two ends of each cell.
    """
    cell = np.clip(place.astype(np.int64), 0, values.shape[1] - 2)
    row = np.arange(len(values)).reshape((-1,) + (1,) * (place.ndim - 1))
    f = place - cell
    a, secant = values[row, cell], values[row, cell + 1] - values[row, cell]
    da, db = slopes[row, cell, 0], slopes[row, cell, 1]
    c, d = 3.0 * secant - 2.0 * da - db, da + db - 2.0 * secant
    found: Array = da + f * (2.0 * c + f * 3.0 * d) if order else a + f * (da + f * (c + f * d))
    return found


def _inverse(target: Array, arc: Array, slopes: Array) -> Array:
    """Return the places, counted in cells, where the rising functions `arc` meet `target`."""
    count = arc.shape[1]
    shift = (np.arange(len(arc)) * 2.0 * (arc.max() + 1.0))[:, None]
    flat = np.searchsorted((arc + shift).reshape(-1), (target + shift).reshape(-1), side="right")
    row = np.arange(len(arc))[:, None]
    cell = np.clip(flat.reshape(target.shape) - 1 - row * count, 0, count - 2)
    start, end = arc[row, cell], arc[row, cell + 1]
    place: Array = cell + (target - start) / (end - start)
    for _ in range(STEPS):
        place = place - (_hermite_at(place, arc, slopes) - target) / (end - start)
        place = np.clip(place, cell, cell + WITHIN)
    return place
