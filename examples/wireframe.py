"""The paper's second figure: the wire frame of a consistently perturbed IEA 15 MW blade.

python examples/wireframe.py [FILE.png]
"""

import sys
from pathlib import Path

import numpy as np

import bladegen as bg
from bladegen.views.plots import figures

T = [0.06, -0.05, 0.03, 0.02]  # rad along the four modes


def oblique(points: np.ndarray) -> np.ndarray:
    """Project points (..., 3): span to the right, sections drawn three times as large."""
    x, y, z = np.moveaxis(points, -1, 0)
    return np.stack([z + 1.6 * y, 3.0 * x + 1.1 * y], axis=-1)


def main(target: Path) -> None:
    """Draw the perturbed sections grey, the stations nominal (dotted) and perturbed in colour."""
    blade = bg.Blade.from_definition(bg.read("iea15mw"))
    variant = blade.perturbed(bg.ShapeSpace.bundled(), T)
    drawn, ((axis,),) = figures.figure(1, 1, width=13, height=4.2)
    wires = oblique(variant.sections(variant.stations(80)))
    for wire in wires:
        axis.plot(*wire.T, color="0.8", linewidth=0.5)
    for landmark in range(0, wires.shape[1], 40):
        axis.plot(*wires[:, landmark].T, color="0.8", linewidth=0.5)
    stations = zip(blade.sections(blade.eta), variant.sections(blade.eta), strict=True)
    for k, (nominal, perturbed) in enumerate(stations):
        colour = figures.shade(k / (len(blade.eta) - 1))
        axis.plot(*oblique(nominal).T, color=colour, linewidth=1.2, linestyle=":")
        axis.plot(*oblique(perturbed).T, color=colour, linewidth=1.8)
    axis.set(
        aspect="equal",
        xlabel="span, m (sections three times as large)",
        yticks=[],
        title=f"IEA 15 MW, t = {T}: stations nominal (dotted) and perturbed (solid)",
    )
    figures.save_figure(drawn, target)
    moved = np.abs(variant.profiles(blade.eta) - blade.profiles(blade.eta)).max()
    print(f"wrote {target}; stations moved by up to {moved:.3f} chord")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "wireframe.png"))
