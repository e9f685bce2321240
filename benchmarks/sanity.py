"""Sanity: how far changes of shape turn chord lines, and how many draws of families are taken.

    python benchmarks/sanity.py [--quick]

Chord lines: 12 random t within twice the standard deviation a blade that are sound, spans 0.2 to
0.98, as the paper's formula leaves them and as they are kept.  Families: ellipsoid, seed 0.
"""

import numpy as np
from figures import asked, figure

import bladegen as bg
from bladegen.airfoils.chord_lines import ChordLines
from bladegen.blade.changes.deformation import AffineChange
from bladegen.errors import PerturbationError

SPANS = np.linspace(0.2, 0.98, 79)
DRAWS = 12
COUNT = 40  # of a family


def lines(blade):
    """Return chord-line angles [deg] and noses."""
    found = ChordLines.of(blade.splines.fit(blade.profiles(SPANS)))
    along = found.edge - found.nose
    return np.degrees(np.arctan2(along[:, 1], along[:, 0])), found.nose


def main():
    quick = asked(__doc__).quick
    count, reaches = (8, [0.25]) if quick else (COUNT, [1.0, 0.5, 0.25])
    space = bg.ShapeSpace.bundled()
    spread = np.sqrt(space.variances[: space.dimension])
    for name in bg.bundled()[: 1 if quick else None]:
        blade = bg.Blade.from_definition(bg.read(name))
        angle, nose = lines(blade)
        turned = {"paper": [], "kept": []}
        moved = {"paper": [], "kept": []}
        rng = np.random.default_rng(0)
        while len(turned["kept"]) < DRAWS:
            t = rng.uniform(-2.0, 2.0, space.dimension) * spread
            if space.outside(t):
                continue
            try:
                for rule in ("paper", "kept"):
                    ways = {"chord_line": rule, "allow_extrapolation": True}
                    variant = blade.untested(space, t, AffineChange(), **ways)
                    if rule == "paper":
                        variant.require_sound(allow_odd=True)
                    other, there = lines(variant)
                    turned[rule].append(np.abs(other - angle).max())
                    moved[rule].append(np.linalg.norm(there - nose, axis=1).max())
            except PerturbationError:
                continue
        figure("chord line turned, a variant", name, "deg", turned)
        figure("nose moved, a variant", name, "chord", moved)
        for reach in reaches:
            block = bg.family(blade, space, count=count, seed=0, reach=reach).block(
                np.arange(count)
            )
            figure(f"draws a variant, reach {reach:g}", name, "", list(map(float, block.attempts)))


if __name__ == "__main__":
    main()
