"""A blade from numbers of your own, without a file: own_blade.py [FOLDER]."""

import sys
from pathlib import Path

import numpy as np

import bladegen as bg


def over_span(*values: float) -> bg.Distribution:
    """Values at equal steps from root to tip."""
    return bg.Distribution(np.linspace(0.0, 1.0, len(values)), np.array(values))


def main(folder: Path) -> None:
    """Join two of the NREL 5 MW's airfoils to a small swept blade and write it."""
    airfoils = {s.airfoil.name: s.airfoil for s in bg.read("nrel5mw").stations}
    definition = bg.BladeDefinition(
        name="small-swept",
        stations=(
            bg.Station(0.0, airfoils["Cylinder2"]),
            bg.Station(0.3, airfoils["DU30_A17"]),
            bg.Station(1.0, airfoils["NACA64_A17"]),
        ),
        chord=over_span(1.0, 1.6, 1.3, 0.8, 0.4),
        twist=over_span(*np.radians([16.0, 8.0, 2.0, 0.0])),
        axis=bg.ReferenceAxis(
            x=over_span(0.0, -0.1, -0.6), y=over_span(0.0, 0.1, 0.8), z=over_span(0.0, 10.0, 20.0)
        ),
        pitch_axis=over_span(0.5, 0.35, 0.3),
    )
    blade = bg.Blade.from_definition(definition, landmarks=201)
    folder.mkdir(exist_ok=True)
    for suffix in ("step", "stl", "png"):
        print("wrote", bg.export(blade, folder / f"small-swept.{suffix}"))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out"))
