"""The paper's first figure: a blade's airfoils, physical and standardised.

python examples/standardised.py [FILE.png]
"""

import sys
from pathlib import Path

import bladegen as bg
from bladegen.shapes import affine
from bladegen.views.plots import figures


def main(target: Path) -> None:
    """Draw the IEA 15 MW's stations in chords, and as clustered points of Gr(n, 2)."""
    blade = bg.Blade.from_definition(bg.read("iea15mw"))
    profiles = blade.profiles(blade.eta)
    X, M, _ = affine.standardise(profiles)
    X, _ = affine.cluster(X, M)
    drawn, ((physical, standard),) = figures.figure(1, 2, width=11, height=4.4)
    for k, station in enumerate(blade.definition.stations):
        colour = figures.shade(k / (len(profiles) - 1))
        label = f"{station.eta:.2f} {station.airfoil.name}"
        physical.plot(*profiles[k].T, color=colour)
        standard.plot(*X[k].T, color=colour, label=label)
    physical.set(title="physical, in chords", xlabel="x", ylabel="y", aspect="equal")
    standard.set(title="landmark-affine standardised", xlabel="first column of X", aspect="equal")
    standard.set_xticks([-0.05, 0.0, 0.05])
    standard.legend(
        fontsize=7,
        title="eta, airfoil",
        title_fontsize=8,
        loc="center left",
        bbox_to_anchor=(1, 0.5),
    )
    figures.save_figure(drawn, target)
    print(f"wrote {target}")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "standardised.png"))
