"""Derivatives of a blade in its parameters, beside evaluations: python benchmarks/derivatives.py

100 sections of 401 points, 12 parameters: four shape coordinates at three knots over span.  All in
turns in one process, so that shares hold on a busy machine too; the first calls, which compile or
load kernels, are not counted.
"""

import numpy as np
from figures import asked, figure, seconds

import bladegen as bg

SPANS, RUNS, MANY = 100, 15, 64
STEP = 1e-5


def main() -> None:
    """Print what evaluations, products and Jacobians take."""
    quick = asked(__doc__).quick
    runs = 2 if quick else RUNS
    space = bg.ShapeSpace.bundled()
    for name in bg.bundled()[: 1 if quick else None]:
        blade = bg.Blade.from_definition(bg.read(name))
        eta = blade.stations(SPANS)
        model = bg.ParametricBlade(blade, space, (("pga", (0.3, 0.6, 0.9)),), eta)
        rng = np.random.default_rng(7)
        x = 0.3 * (model.upper - model.lower) * rng.uniform(-0.5, 0.5, len(model.names))
        g = rng.normal(size=(SPANS, len(blade.u), 3))
        many = x * rng.uniform(0.9, 1.1, size=(MANY, len(x)))
        ways = np.eye(len(x)) * STEP

        def differences(model=model, x=x, ways=ways):
            return (model.sections(x + ways) - model.sections(x - ways)) / (2 * STEP)

        def by_perturbed(blade=blade, t=x[:4], eta=eta):
            variant = blade.perturbed(space, t, allow_odd=True, allow_extrapolation=True)
            return variant.sections(eta)

        calls = {
            "sections": lambda model=model, x=x: model.sections(x),
            "jvp": lambda model=model, x=x, dx=x: model.jvp(x, dx),
            "vjp": lambda model=model, x=x, g=g: model.vjp(x, g),
            "jacobian": lambda model=model, x=x: model.jacobian(x),
            "differences, in one batch": differences,
            "perturbed, then sections": by_perturbed,
            f"one of {MANY} vectors at once": lambda model=model, many=many: model.sections(many),
        }
        spent = seconds(calls, runs)
        spent[f"one of {MANY} vectors at once"] = [
            one / MANY for one in spent[f"one of {MANY} vectors at once"]
        ]
        label = f"{len(x)} parameters, {SPANS} x {len(blade.u)}"
        figure(label, name, "ms", {way: [1e3 * one for one in of] for way, of in spent.items()})
        base = np.array(spent["sections"])
        shares = {
            way: list(np.array(spent[way]) / base)
            for way in ("jvp", "vjp", "jacobian", "differences, in one batch")
        }
        figure(f"{label}, evaluations' time", name, "", shares)


if __name__ == "__main__":
    main()
