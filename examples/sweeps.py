"""The paper's fourth figure: corner-to-corner sweeps through CST and principal geodesic space.

    python examples/sweeps.py [FILE.png]

Corners are those of the boxes that hold the database. A shape is valid if its sides do not cross
and it encloses a positive area; the shares are printed.
"""

import sys
from pathlib import Path

import numpy as np

import bladegen as bg
from bladegen.airfoils.landmarks import landmarks
from bladegen.curves.crossing import crossing_sections
from bladegen.formats.baselines import baselines
from bladegen.shapes import cst
from bladegen.views.plots import figures

SEED, SWEEPS, STEPS, SHOWN = 7, 200, 11, 4
EVERY = 4  # landmarks are thinned to 101 for the test of validity


def corners(low: np.ndarray, high: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Sweeps (SWEEPS, STEPS, r) from random corners of a box to the opposite ones."""
    start = np.where(rng.uniform(size=(SWEEPS, len(low))) < 0.5, low, high)
    fraction = np.linspace(0.0, 1.0, STEPS)[:, None]
    return start[:, None] + fraction * (low + high - 2.0 * start)[:, None]


def valid(shapes: np.ndarray) -> np.ndarray:
    """Which shapes (k, n, 2) are airfoils."""
    thin = shapes[:, ::EVERY]
    x, y = np.moveaxis(thin, -1, 0)
    area = np.sum(x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y, axis=1)
    sound = area > 0
    sound[crossing_sections(thin)] = False
    return sound


def main(target: Path) -> None:
    """Draw four sweeps through either space and count the valid shapes of all."""
    rng = np.random.default_rng(SEED)
    space = bg.ShapeSpace.bundled()
    airfoils = [landmarks(xy) for xy in baselines().values()]
    fits = np.stack([cst.fit(shape)[0] for shape in airfoils])
    drawn_cst = cst.perturbations(fits, 1000, rng)
    by_cst = corners(drawn_cst.min(axis=0), drawn_cst.max(axis=0), rng)
    by_pga = corners(space.lower, space.upper, rng)
    flat_cst = cst.shapes(by_cst.reshape(-1, 18), space.u)
    flat_pga = figures.physical(space.decode(by_pga.reshape(-1, 4)), airfoils[4])
    shares = [100.0 * valid(shapes).mean() for shapes in (flat_cst, flat_pga)]

    drawn, axes = figures.figure(2, SHOWN, width=12, height=5.2)
    for row, (shapes, title) in enumerate(((flat_cst, "CST"), (flat_pga, "principal geodesics"))):
        for column, sweep in enumerate(shapes.reshape(SWEEPS, STEPS, -1, 2)[:SHOWN]):
            for k, shape in enumerate(sweep):
                axes[row, column].plot(
                    *shape.T, color=figures.shade(k / (STEPS - 1)), linewidth=0.8
                )
            axes[row, column].set(
                aspect="equal", ylim=(-0.32, 0.32), title=f"{title}, sweep {column + 1}"
            )
    figures.save_figure(drawn, target)
    print(
        f"wrote {target}; valid shapes along {SWEEPS} sweeps of {STEPS} steps, seed {SEED}: "
        f"CST {shares[0]:.1f} %, principal geodesics {shares[1]:.1f} %"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "sweeps.png"))
