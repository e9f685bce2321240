"""Which share of shapes is sound, by where their coordinates are drawn from: airfoils and blades.

    python benchmarks/distributions.py

Airfoils: shapes at 2,000 draws from each distribution of a space's coordinates, at all of its 401
landmarks; sound is a shape that does not cross itself.  Beside it, which share of the draws lies in
the convex hull of the data, and how large the region is over that of the hull (of uniform ones).
"Centred ellipsoid" is `ShapeSpace.sample`'s and the design `ellipsoid`'s: axes along the modes,
centred at the mean.  For CST, the box that holds the coefficients of the same database.  Sweeps run
from corner to opposite corner of the box.

Blades: variants of the IEA 15 MW at first draws of each design, 60 spans; sound at all, and within
the rules of `bladegen family` (data of the space, no oddity).
"""

import numpy as np
from figures import asked, figure

import bladegen as bg
from bladegen.airfoils.landmarks import landmarks
from bladegen.blade.variants.designs import DESIGNS, DISTRIBUTED
from bladegen.curves.crossing import crossing_sections
from bladegen.formats.baselines import baselines
from bladegen.shapes import cst
from bladegen.shapes.shape_space import FILES
from bladegen.shapes.statistics.densities import KINDS

DRAWS, VARIANTS, SWEEPS, STEPS = 2000, 192, 200, 11
SEED = 7
LEFT_OUT = ("sobol", "lhs", "sweep")  # the box's, otherwise spread


def crossing_share(shapes: np.ndarray) -> float:
    """The share of shapes (m, n, 2) that do not cross themselves [%]."""
    parts = [shapes[i : i + 250] for i in range(0, len(shapes), 250)]
    return 100.0 * (1.0 - sum(len(crossing_sections(part)) for part in parts) / len(shapes))


def of_space(name: str, draws: int) -> None:
    """Shares of one space."""
    space = bg.ShapeSpace.bundled(name)
    hull = space.distribution("hull")
    volume = -float(hull.log_prob(np.zeros(space.dimension)))
    rng = np.random.default_rng(SEED)
    start = np.where(rng.uniform(size=(SWEEPS, space.dimension)) < 0.5, space.lower, space.upper)
    along = np.linspace(0.0, 1.0, STEPS)[:, None]
    sweeps = start[:, None] + along * (space.lower + space.upper - 2.0 * start)[:, None]
    drawn = {"centred ellipsoid": space.sample(draws, np.random.default_rng(SEED))}
    drawn |= {
        kind: space.distribution(kind).sample(draws, np.random.default_rng(SEED)) for kind in KINDS
    }
    drawn |= {"the data": space.coordinates, "sweeps": sweeps.reshape(-1, space.dimension)}
    for kind, t in drawn.items():
        figure("sound shapes", kind, "%", {name: 100.0 * float(space.sound(t).mean())})
        figure(
            "draws in the data's hull", kind, "%", {name: 100.0 * float(hull.contains(t).mean())}
        )
    sizes = {
        kind: -space.distribution(kind).log_prob(np.zeros(space.dimension))
        for kind in ("box", "ellipsoid")
    }
    for kind, size in sizes.items():
        figure("volume over the hull's", kind, "", {name: float(np.exp(size - volume))})
    for kind in KINDS:
        kept = space.distribution(kind, sound=True)
        t = kept.sample(draws, np.random.default_rng(SEED))
        figure(
            "sound shapes after truncation", kind, "%", {name: 100.0 * float(space.sound(t).mean())}
        )


def of_cst(draws: int) -> None:
    """Shares of the box of CST coefficients."""
    fits = np.stack([cst.fit(landmarks(xy))[0] for xy in baselines().values()])
    rng = np.random.default_rng(SEED)
    data = cst.perturbations(fits, 1000, rng)
    low, high = data.min(axis=0), data.max(axis=0)
    u = bg.ShapeSpace.bundled().u
    boxes = low + rng.random((draws, len(low))) * (high - low)
    start = np.where(rng.uniform(size=(SWEEPS, len(low))) < 0.5, low, high)
    along = np.linspace(0.0, 1.0, STEPS)[:, None]
    sweeps = (start[:, None] + along * (low + high - 2.0 * start)[:, None]).reshape(-1, len(low))
    for edge, name in ((0.0, "CST, sharp edges"), (0.01, "CST, edges of 1 %")):
        for kind, each in (("the data", data[::8]), ("box", boxes), ("sweeps", sweeps)):
            figure("sound shapes", kind, "%", {name: crossing_share(cst.shapes(each, u, edge))})


def of_blades(count: int) -> None:
    """Shares of variants of a blade."""
    blade = bg.Blade.from_definition(bg.read("iea15mw"))
    for name in FILES:
        space = bg.ShapeSpace.bundled(name)
        for design in (*(kind for kind in DESIGNS if kind not in LEFT_OUT), *DISTRIBUTED):
            for reach in (1.0, 0.5):
                how = {"count": count, "seed": 1, "reach": reach, "spans": 60, "design": design}
                found = {}
                for word, free in (("not crossing", True), ("by all rules", False)):
                    rules = {"allow_extrapolation": free, "allow_odd": free, "invalid": "keep"}
                    family = bg.family(blade, space, **how, **rules)
                    found[word] = 100.0 * family.block(np.arange(count)).valid.mean()
                figure(f"sound variants, {name}", f"{design}, reach {reach:g}", "%", found)


def main() -> None:
    """Print all shares."""
    quick = asked(__doc__).quick
    for name in FILES:
        of_space(name, 200 if quick else DRAWS)
    of_cst(200 if quick else DRAWS)
    of_blades(24 if quick else VARIANTS)


if __name__ == "__main__":
    main()
