"""Class-shape transformation: airfoils from Bernstein coefficients, and the paper's database.

With x over chord, y = sqrt(x) (1 - x) sum_k a_k B_k(x) for each side, B_k the Bernstein
polynomials of degree 8: 9 coefficients a side, 18 in all, suction side first; the trailing-edge
thickness is zero (Kulfan, J. Aircraft 45 (2008), with class exponents 1/2 and 1).
"""

from collections.abc import Iterator
from math import comb

import numpy as np

from bladegen import affine
from bladegen.arrays import Array
from bladegen.landmarks import landmark_parameters

__all__ = ["COEFFICIENTS", "fit", "perturbations", "shapes", "standardised_shapes"]

DEGREE = 8
COEFFICIENTS = 2 * (DEGREE + 1)
FIT_POINTS = 200  # a side, spaced like a cosine
CELLS = 1200  # of the curve's parameter, over both sides; arc length is right to 1e-10
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


def shapes(coefficients: Array, u: Array) -> Array:
    """Return landmarks of airfoils, (m, 18) to (m, n, 2), in chords.

    Parameters
    ----------
    coefficients : (m, 18) array
    u : (n,) array
        Landmark parameters, as `landmarks.landmark_parameters` makes them: the leading edge is
        the point farthest from the trailing edge, each side is divided by arc length.
    """
    phi, x, value, slope = _grid()
    points, tangents = _curve(coefficients, phi, x, value, slope)
    step = phi[1] - phi[0]
    speed = np.linalg.norm(tangents, axis=-1)
    nose = _farthest(points, tangents)
    arc = _running_length(points, tangents, speed, step)
    at_nose = _hermite_at(nose, arc, speed * step)
    total = arc[:, -1]
    target = np.where(
        u <= 0.5,
        2.0 * u * at_nose[:, None],
        at_nose[:, None] + (2.0 * u - 1.0) * (total - at_nose)[:, None],
    )
    place = _inverse(target, arc, speed * step)
    return np.stack(
        [_hermite_at(place, points[..., i], tangents[..., i] * step) for i in (0, 1)], axis=-1
    )


def standardised_shapes(coefficients: Array, n: int = 401) -> Array:
    """Return the points of Gr(n, 2) of airfoils, (m, 18) to (m, n, 2), in chunks."""
    u = landmark_parameters(n)
    result = np.empty((len(coefficients), n, 2))
    for part in _chunks(len(coefficients)):
        result[part] = affine.standardise(shapes(coefficients[part], u))[0]
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

    x = (1 - cos phi) / 2 makes y analytic at the nose: sqrt(x) = sin(|phi| / 2).
    """
    phi = np.linspace(-np.pi, np.pi, CELLS + 1)
    x = 0.5 * (1.0 - np.cos(phi))
    half = 0.5 * np.abs(phi)
    shape = np.sin(half) * np.cos(half) ** 2
    rate = 0.5 * np.cos(half) * (np.cos(half) ** 2 - 2.0 * np.sin(half) ** 2) * np.sign(phi)
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
    coefficients: Array, phi: Array, x: Array, value: Array, slope: Array
) -> tuple[Array, Array]:
    """Points and derivatives in phi of the airfoils on the grid, (m, c, 2) each."""
    middle = len(phi) // 2
    sides = coefficients[:, : DEGREE + 1], coefficients[:, DEGREE + 1 :]
    y, dy = (
        np.concatenate([sides[0] @ f[:middle].T, sides[1] @ f[middle:].T], axis=1)
        for f in (value, slope)
    )
    # At the nose itself y' jumps if the two sides' first coefficients differ; take the mean.
    dy[:, middle] = 0.25 * (sides[1][:, 0] - sides[0][:, 0])
    points = np.stack([np.broadcast_to(x, y.shape), y], axis=-1)
    return points, np.stack([np.broadcast_to(0.5 * np.sin(phi), y.shape), dy], axis=-1)


def _farthest(points: Array, tangents: Array) -> Array:
    """Return where each curve is farthest from the trailing edge (1, 0), in cells."""
    away = points - [1.0, 0.0]
    rate = np.sum(away * tangents, axis=-1)
    cell = np.argmax(np.sum(away * away, axis=-1), axis=1)
    row = np.arange(len(points))
    cell = np.where(rate[row, cell] < 0, cell - 1, cell)
    before, after = rate[row, cell], rate[row, cell + 1]
    place: Array = cell + before / (before - after)
    return place


def _running_length(points: Array, tangents: Array, speed: Array, step: float) -> Array:
    """Arc length along each curve at the grid, by Simpson's rule on Hermite cells."""
    chord = np.diff(points, axis=1)
    middle = 1.5 * chord / step - 0.25 * (tangents[:, 1:] + tangents[:, :-1])
    lengths = step / 6.0 * (speed[:, 1:] + speed[:, :-1] + 4.0 * np.linalg.norm(middle, axis=-1))
    return np.concatenate([np.zeros((len(points), 1)), np.cumsum(lengths, axis=1)], axis=1)


def _hermite_at(place: Array, values: Array, slopes: Array) -> Array:
    """Evaluate cubic Hermite functions (m, c) at places (m, ...) counted in cells."""
    cell = np.clip(place.astype(np.int64), 0, values.shape[1] - 2)
    row = np.arange(len(values)).reshape((-1,) + (1,) * (place.ndim - 1))
    f = place - cell
    a, b = values[row, cell], values[row, cell + 1]
    da, db = slopes[row, cell], slopes[row, cell + 1]
    secant = b - a
    return a + f * (da + f * (3.0 * secant - 2.0 * da - db + f * (da + db - 2.0 * secant)))


def _inverse(target: Array, arc: Array, slopes: Array) -> Array:
    """Return the places, counted in cells, where the rising functions `arc` meet `target`."""
    count = arc.shape[1]
    shift = (np.arange(len(arc)) * 2.0 * (arc.max() + 1.0))[:, None]
    flat = np.searchsorted((arc + shift).reshape(-1), (target + shift).reshape(-1), side="right")
    row = np.arange(len(arc))[:, None]
    cell = np.clip(flat.reshape(target.shape) - 1 - row * count, 0, count - 2)
    start, end = arc[row, cell], arc[row, cell + 1]
    place: Array = cell + (target - start) / (end - start)
    for _ in range(2):
        place = place - (_hermite_at(place, arc, slopes) - target) / (end - start)
        place = np.clip(place, cell, cell + 1.0 - 1e-12)
    return place
