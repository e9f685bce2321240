"""The statistics of 16,000 shapes beside plain loops; and what modes reproduce, beside CST.

    python benchmarks/spaces.py

The textbook's loop takes one shape after the other through its formulas: the projector I - X X^T,
a singular value decomposition of the n x 2 matrix it gives, and an outer product for the
covariance.  A careful one forms no projector and multiplies all logarithms at once.  Loops are
timed on 200 shapes in each round, and scaled to all and to as many steps.

Reproduction: shapes that the space was not learned from, by modes and by class-shape functions of
as many numbers.  A section of unit chord has two numbers beside its modes, the thickness and the
shear of its affine map, so r modes count as r + 2.  Both are measured alike: the distance of the
shape's landmarks from the polygon of what reproduces it.  The shapes are themselves CST shapes,
which favours CST.
"""

import resource
import time
from math import comb

import numpy as np
from figures import asked, figure, seconds

from bladegen.airfoils.landmarks import landmarks
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.formats.baselines import baselines
from bladegen.shapes import affine, cst, grassmann
from bladegen.shapes.shape_space import ShapeSpace

LOOPED, STEPS = 200, 7  # shapes that are looped over; gradient steps to 1e-10 rad
AFFINE = 2  # numbers of a section of unit chord beside its modes
PARAMETERS = (4, 6, 8, 12, 16, 18, 24)
HELD_OUT = 128
RUNS = 7


def textbook(points: np.ndarray) -> float:
    """Seconds that a loop by the textbook's formulas would take for all shapes."""
    mean, n = points[0], points.shape[1]
    some = points[:LOOPED]
    gram = np.zeros((2 * n, 2 * n))
    start = time.perf_counter()
    for X in some:
        projector = np.eye(n) - mean @ mean.T
        U, s, Vt = np.linalg.svd(projector @ X @ np.linalg.inv(mean.T @ X), full_matrices=False)
        log = (U * np.arctan(s)) @ Vt
    per_log = (time.perf_counter() - start) / len(some)
    start = time.perf_counter()
    for _ in some[::4]:
        gram += np.outer(log, log)
    per_outer = (time.perf_counter() - start) / len(some[::4])
    return len(points) * ((STEPS + 1) * per_log + per_outer)


def careful(points: np.ndarray) -> float:
    """Seconds of a loop that forms no n x n matrix, and multiplies all logarithms at once."""
    mean, some = points[0], points[:LOOPED]
    start = time.perf_counter()
    logs = []
    for X in some:
        normal = X @ np.linalg.inv(mean.T @ X) - mean
        U, s, Vt = np.linalg.svd(normal, full_matrices=False)
        logs.append(((U * np.arctan(s)) @ Vt).reshape(-1))
    per_log = (time.perf_counter() - start) / len(some)
    all_ = np.resize(np.stack(logs), (len(points), logs[0].size))
    start = time.perf_counter()
    np.linalg.eigh(all_.T @ all_)
    return len(points) * (STEPS + 1) * per_log + time.perf_counter() - start


def by_cst(shape: np.ndarray, parameters: int) -> np.ndarray:
    """An airfoil fitted by a class-shape transformation of so many coefficients."""
    k = np.arange(parameters // 2)
    weights = np.array([comb(len(k) - 1, int(i)) for i in k], dtype=float)
    middle = len(shape) // 2
    fitted = shape.copy()
    for side in (slice(middle, None, -1), slice(middle, None)):
        x = np.clip(shape[side, 0], 0.0, 1.0)
        basis = weights * x[:, None] ** k * (1 - x[:, None]) ** (len(k) - 1 - k)
        basis = (np.sqrt(x) * (1 - x))[:, None] * basis
        y = shape[side, 1]
        fitted[side, 1] = basis @ np.linalg.lstsq(basis, y, rcond=None)[0]
    return fitted


def by_modes(space: ShapeSpace, shapes: np.ndarray, modes: int) -> np.ndarray:
    """Shapes from so many of their normal coordinates, brought to unit chord."""
    X, M, b = affine.standardise(shapes)
    t = space.encode(X)
    kept = np.where(np.arange(t.shape[1]) < modes, t, 0.0)
    again = affine.restore(grassmann.align(X, space.decode(kept)), M, b)
    return affine.restore(again, *SectionSplines(space.u).normalising(again, None))


def distances(shapes: np.ndarray, again: np.ndarray) -> np.ndarray:
    """Distances (m, n) of shapes' landmarks from the polygons of what reproduces them."""
    side = np.diff(again, axis=1)[:, None]
    to = shapes[:, :, None] - again[:, None, :-1]
    along = np.sum(to * side, axis=-1) / np.maximum(np.sum(side**2, axis=-1), 1e-30)
    to -= np.clip(along, 0.0, 1.0)[..., None] * side
    return np.sqrt(np.min(np.sum(to**2, axis=-1), axis=-1))


def main() -> None:
    """Print the timing, and a row a number of parameters."""
    quick = asked(__doc__).quick
    fits = np.stack([cst.fit(landmarks(xy))[0] for xy in baselines().values()])
    rng = np.random.default_rng(2022)
    points = cst.standardised_shapes(cst.perturbations(fits, 20 if quick else 1000, rng))
    loops: dict[str, list[float]] = {"textbook's loop": [], "careful loop": []}
    spent = seconds(
        {
            "bladegen": lambda: ShapeSpace.fit(points),
            "textbook": lambda: loops["textbook's loop"].append(textbook(points)),
            "careful": lambda: loops["careful loop"].append(careful(points)),
        },
        2 if quick else RUNS,
    )
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    case = f"{len(points)} shapes of {points.shape[1]}"
    warm = {name: taken[1:] for name, taken in loops.items()}
    figure("mean and 4 modes", case, "s", {"bladegen": spent["bladegen"], **warm})
    figure("peak memory of the process", case, "GB", peak)

    space = ShapeSpace.fit(points, modes=max(PARAMETERS) - AFFINE)
    held_out = cst.perturbations(fits, 1 if quick else HELD_OUT // 16, np.random.default_rng(99))
    shapes = cst.shapes(held_out, space.u)
    for count in PARAMETERS:
        found = {
            "modes": distances(shapes, by_modes(space, shapes, count - AFFINE)),
            "CST": distances(shapes, np.stack([by_cst(shape, count) for shape in shapes])),
        }
        case = f"{count} parameters"
        rms = {who: list(np.sqrt((d**2).mean(axis=1))) for who, d in found.items()}
        figure("held-out shapes missed by, RMS", case, "chord", rms)
        most = {who: list(d.max(axis=1)) for who, d in found.items()}
        figure("held-out shapes missed by, largest", case, "chord", most)
    for count in PARAMETERS:
        variance = 100 * float(space.variance_ratio[: count - AFFINE].sum())
        figure("variance of the modes among them", f"{count} parameters", "%", variance)


if __name__ == "__main__":
    main()
