"""Compile the package's loops before tests need them: `python scripts/warm.py KIND`.

Numba keeps what it has compiled on the disk. In a fresh checkout that is half a minute of a
processor, and several times that where each process of the tests does it for itself while its
lines are counted.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

import bladegen as bg


def families() -> None:
    """Measure variants as families do, in both precisions."""
    from bladegen.families.order import Order
    from bladegen.families.run import run

    blade = bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=101)
    family = bg.family(blade, bg.ShapeSpace.bundled(), count=2, seed=1, spans=8)
    with tempfile.TemporaryDirectory() as folder:
        for dtype in ("float32", "float64"):
            run(Order(family, Path(folder) / dtype, dtype=dtype))


def derivatives() -> None:
    """Differentiate sections, forward and back."""
    from bladegen.parametric.parameters import AFFINE

    blade = bg.Blade.from_definition(bg.read("iea15mw"), landmarks=101)
    spans = np.linspace(0.3, 0.9, 4)
    u = np.linspace(0.0, 1.0, 21)
    for own in (None, u):
        model = bg.ParametricBlade(blade, bg.ShapeSpace.bundled(), ("pga", *AFFINE), spans, own)
        x = model.baseline
        model.vjp(x, model.sections(x))
        model.jvp(x, np.ones_like(x))


if __name__ == "__main__":
    {"families": families, "derivatives": derivatives}[sys.argv[1]]()
