"""The statistics of 16,000 shapes, beside a plain loop; and what r modes reproduce, beside CST.

The loop takes one shape after the other through the textbook formulas: the projector I - X X^T,
a singular value decomposition of the n x 2 matrix it gives, and an outer product for the
covariance. It is timed on a few hundred shapes and scaled to all and to as many steps.
"""

import resource
import time
from math import comb

import numpy as np
from figures import figure, seconds

from bladegen import affine, cst, grassmann
from bladegen.database import baselines
from bladegen.landmarks import landmarks
from bladegen.pga import ShapeSpace

LOOPED, STEPS = 200, 7  # shapes that are looped over; gradient steps to 1e-10 rad
RANKS = (1, 2, 4, 8, 12, 16, 24)
HELD_OUT = 500
RUNS = 5


def loop_seconds(points: np.ndarray) -> float:
    """Seconds that a plain loop would take for all shapes."""
    mean, n = points[0], points.shape[1]
    start = time.perf_counter()
    gram = np.zeros((2 * n, 2 * n))
    for X in points[:LOOPED]:
        projector = np.eye(n) - mean @ mean.T
        U, s, Vt = np.linalg.svd(projector @ X @ np.linalg.inv(mean.T @ X), full_matrices=False)
        log = (U * np.arctan(s)) @ Vt
    per_log = (time.perf_counter() - start) / LOOPED
    start = time.perf_counter()
    for _ in range(LOOPED // 4):
        gram += np.outer(log, log)
    per_outer = (time.perf_counter() - start) / (LOOPED // 4)
    return len(points) * ((STEPS + 1) * per_log + per_outer)


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


def main() -> None:
    """Print the timing, and a row a number of parameters."""
    fits = np.stack([cst.fit(landmarks(xy))[0] for xy in baselines().values()])
    rng = np.random.default_rng(2022)
    points = cst.standardised_shapes(cst.perturbations(fits, 1000, rng))
    spent = seconds(lambda: ShapeSpace.fit(points), RUNS)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    loop = float(np.median([loop_seconds(points) for _ in range(RUNS)]))
    case = f"{len(points)} shapes of {points.shape[1]}"
    figure("mean and 4 modes", case, spent, "s", beside="a plain loop", baseline=loop)
    figure("peak memory of that", case, peak, "GB")

    space = ShapeSpace.fit(points, modes=max(RANKS))
    coefficients = cst.perturbations(fits, 1 + HELD_OUT // 16, np.random.default_rng(99))
    shapes = cst.shapes(coefficients, space.u)
    X, M, b = affine.standardise(shapes)
    t = space.encode(X)
    for r in RANKS:
        kept = np.where(np.arange(t.shape[1]) < r, t, 0.0)
        again = affine.restore(grassmann.align(X, space.decode(kept)), M, b)
        off = [np.linalg.norm(again - shapes, axis=-1)]
        if r % 2 == 0:
            off.append(np.stack([np.abs(by_cst(s, r) - s)[:, 1] for s in shapes]))
        rms = [float(np.median(np.sqrt((d**2).mean(1)))) for d in off]
        top = [float(np.median(d.max(1))) for d in off]
        for what, values in (("RMS", rms), ("largest", top)):
            figure(
                f"modes miss held-out shapes by, {what}",
                f"{r} parameters",
                values[0],
                "chord",
                beside="CST" if len(values) > 1 else "",
                baseline=values[1] if len(values) > 1 else None,
            )
        variance = 100 * float(space.variance_ratio[:r].sum())
        figure("variance of so many modes", f"{r} parameters", variance, "%")


if __name__ == "__main__":
    main()
