"""Derivatives of a blade in its parameters, beside evaluations: python benchmarks/derivatives.py

100 sections of 401 points, in 12 parameters: four shape coordinates at three knots over span; and
in 11: four shape coordinates, thickness, camber, chord, twist, and factors of chord, twist and
prebend.  All in turns in one process, so that shares hold on a busy machine too; the first calls,
which compile or load kernels, are not counted.
"""

import numpy as np
from figures import asked, figure, seconds

import bladegen as bg

SPANS, RUNS, MANY = 100, 15, 64
STEP = 1e-5


KNOTS = (("pga", (0.3, 0.6, 0.9)),)
AFFINE = ("thickness", "camber", "chord", "twist", "chord_scale", "twist_scale", "prebend_scale")


def main() -> None:
    """Print what evaluations, products and Jacobians take."""
    quick = asked(__doc__).quick
    runs = 2 if quick else RUNS
    space = bg.ShapeSpace.bundled()
    for name in bg.bundled()[: 1 if quick else None]:
        blade = bg.Blade.from_definition(bg.read(name))
        eta = blade.stations(SPANS)
        for parameters in (KNOTS, ("pga", *AFFINE)):
            measured(name, bg.ParametricBlade(blade, space, parameters, eta), runs)


def measured(name: str, model: bg.ParametricBlade, runs: int) -> None:
    """Print the figures of one model."""
    rng = np.random.default_rng(7)
    width = model.upper - model.lower
    x = model.baseline + 0.3 * width * rng.uniform(-0.5, 0.5, len(width))
    g = rng.normal(size=(SPANS, len(model.blade.u), 3))
    many = x + 0.03 * width * rng.uniform(-0.5, 0.5, size=(MANY, len(x)))
    ways = np.eye(len(x)) * STEP

    def by_perturbed():
        return model.blade.perturbed(
            model.space, x[:4], allow_odd=True, allow_extrapolation=True
        ).sections(model.eta)

    at_once = f"one of {MANY} vectors at once"
    calls = {
        "sections": lambda: model.sections(x),
        "jvp": lambda: model.jvp(x, x),
        "vjp": lambda: model.vjp(x, g),
        "jacobian": lambda: model.jacobian(x),
        "differences, in one batch": lambda: (
            (model.sections(x + ways) - model.sections(x - ways)) / (2 * STEP)
        ),
        "perturbed, then sections": by_perturbed,
        at_once: lambda: model.sections(many),
    }
    spent = seconds(calls, runs)
    spent[at_once] = [one / MANY for one in spent[at_once]]
    label = f"{len(x)} parameters, {SPANS} x {len(model.blade.u)}"
    figure(label, name, "ms", {way: [1e3 * one for one in of] for way, of in spent.items()})
    base = np.array(spent["sections"])
    shares = {
        way: list(np.array(spent[way]) / base)
        for way in ("jvp", "vjp", "jacobian", "differences, in one batch")
    }
    figure(f"{label}, evaluations' time", name, "", shares)


if __name__ == "__main__":
    main()
