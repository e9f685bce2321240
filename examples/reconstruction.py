"""What a number of principal geodesics reproduces of shapes that they were not learned from.

python examples/reconstruction.py [FILE.png]
"""

import sys
from pathlib import Path

import numpy as np

import bladegen as bg
from bladegen.airfoils.landmarks import landmarks
from bladegen.formats.baselines import baselines
from bladegen.shapes import affine, cst, grassmann
from bladegen.views.plots import figures, style

RANKS = np.array([1, 2, 3, 4, 6, 8, 10, 12, 16, 20, 24])
LEARNED, HELD_OUT, SEED = 200, 20, 2022


def main(target: Path) -> None:
    """Draw the spectrum, and the distance of landmarks against the number of modes."""
    fits = np.stack([cst.fit(landmarks(xy))[0] for xy in baselines().values()])
    rng = np.random.default_rng(SEED)
    known, unknown = (cst.perturbations(fits, count, rng) for count in (LEARNED, HELD_OUT))
    space = bg.ShapeSpace.fit(cst.standardised_shapes(known), modes=int(RANKS[-1]))
    shapes = cst.shapes(unknown, space.u)
    X, M, b = affine.standardise(shapes)
    t = space.encode(X)
    rows = []
    for r in RANKS:
        kept = np.where(np.arange(t.shape[1]) < r, t, 0.0)
        again = affine.restore(grassmann.align(X, space.decode(kept)), M, b)
        off = np.linalg.norm(again - shapes, axis=-1)
        rows.append((np.median(np.sqrt((off**2).mean(axis=1))), np.median(off.max(axis=1))))
    rms, largest = np.array(rows).T

    drawn, ((left, right),) = figures.figure(1, 2, width=10, height=4)
    left.semilogy(np.arange(1, 25), space.variance_ratio[:24], "o-", color=style.CATEGORIES[0])
    left.set(xlabel="mode", ylabel="share of the variance", title="spectrum")
    right.semilogy(RANKS, rms, "o-", color=style.CATEGORIES[0], label="RMS")
    right.semilogy(RANKS, largest, "s-", color=style.CATEGORIES[1], label="largest")
    right.set(xlabel="modes", ylabel="distance, chord", title="held-out shapes, median")
    right.legend()
    figures.save_figure(drawn, target)
    print(f"wrote {target}; 4 modes: RMS {rms[3]:.1e}, largest {largest[3]:.1e} chord")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "reconstruction.png"))
