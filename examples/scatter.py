"""The paper's third figure: the database in CST coefficients and in normal coordinates.

python examples/scatter.py [FILE.png]
"""

import sys
from pathlib import Path

import numpy as np

import bladegen as bg
from bladegen.airfoils.landmarks import landmarks
from bladegen.formats.baselines import baselines
from bladegen.shapes import cst
from bladegen.views.plots import figures

SEED, COUNT = 2022, 1000  # those of the bundled space, so that its coordinates can be used


def main(target: Path) -> None:
    """Colour the perturbations of each of the 16 airfoils alike in both spaces."""
    airfoils = baselines()
    fits = np.stack([cst.fit(landmarks(xy))[0] for xy in airfoils.values()])
    drawn_cst = cst.perturbations(fits, COUNT, np.random.default_rng(SEED))
    space = bg.ShapeSpace.bundled()
    drawn, ((left, right),) = figures.figure(1, 2, width=11, height=5)
    for k, name in enumerate(airfoils):
        rows = slice(k * COUNT, (k + 1) * COUNT)
        style = {"s": 3, "color": figures.shade(k / 15), "linewidths": 0, "alpha": 0.6}
        left.scatter(drawn_cst[rows, 1], drawn_cst[rows, 10], label=name, **style)
        right.scatter(space.coordinates[rows, 0], space.coordinates[rows, 1], **style)
    left.set(title="2 of 18 CST coefficients", xlabel="a2, suction", ylabel="a2, pressure")
    right.set(title="2 of 4 normal coordinates", xlabel="t1, rad", ylabel="t2, rad")
    left.legend(fontsize=5.5, markerscale=3, ncols=2)
    figures.save_figure(drawn, target)
    print(f"wrote {target}")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "scatter.png"))
