"""One blade: its sections, a variant that is tested, its making: python benchmarks/core.py

Times are of the processor, on one core.  Beside sections in space stand their 2D shapes alone;
beside a variant, the first of a blade whose sections nobody asked for yet, and a batch of one in
compiled code that is ready for these spans.  Spans of `sections` are new in each call: what a
blade remembers of the last ones does not count; variants of a blade begin with it.
"""

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import gc
import time
from collections.abc import Callable, Mapping
from itertools import count

import numpy as np
from figures import asked, figure

import bladegen as bg
from bladegen.airfoils import landmarks
from bladegen.blade.changes.affine_change import AffineChange
from bladegen.blade.changes.window import Window
from bladegen.blade.lofting.paths import PATHS
from bladegen.blade.variants.batch import SectionBatch

SPANS = 100
RUNS, SLOW = 41, 9
SPACE = bg.ShapeSpace.bundled()


def spent(contenders: Mapping[str, Callable[[], object]], runs: int) -> dict[str, list[float]]:
    """Return what calls took of the processor's time [ms], in turn, after one that warms each."""
    taken: dict[str, list[float]] = {name: [] for name in contenders}
    for run in range(runs + 1):
        for name, call in contenders.items():
            gc.collect()
            start = time.process_time()
            kept = call()
            if run:
                taken[name].append(1e3 * (time.process_time() - start))
            del kept
    return taken


def main() -> None:
    """Print the rows of each blade and path."""
    quick = asked(__doc__).quick
    runs, slow = (2, 1) if quick else (RUNS, SLOW)
    for name in bg.bundled()[: 1 if quick else None]:
        definition = bg.read(name)
        for path in PATHS:
            rows(definition, path, f"{name}, {path}", runs, slow)


def rows(definition: bg.BladeDefinition, path: str, case: str, runs: int, slow: int) -> None:
    """Print the rows of one blade."""
    blade = bg.Blade.from_definition(definition, path=path)
    eta, turn = np.linspace(0.0, 1.0, SPANS), count(1)
    window = Window.beyond_circles(definition.stations)
    batch = SectionBatch(blade, SPACE, window, eta)

    def spans() -> np.ndarray:
        return eta * (1.0 - 1e-7 * next(turn))

    def t() -> np.ndarray:
        return np.array([0.01 + 1e-6 * next(turn), 0.005, 0.0, 0.0])

    def made() -> bg.Blade:
        landmarks._fitted.cache_clear()
        landmarks._placed.cache_clear()
        return bg.Blade.from_definition(definition, path=path)

    ways = {
        "in space": lambda: blade.sections(spans()),
        "2D shapes alone": lambda: blade.profiles(spans()),
    }
    figure(f"{SPANS} sections of {len(blade.u)}", case, "ms", spent(ways, runs))
    ways = {
        "tested": lambda: blade.perturbed(SPACE, t()).sections(eta),
        "compiled, one": lambda: batch.evaluate(t()[None], AffineChange()),
    }
    figure("a variant's sections", case, "ms", spent(ways, runs))
    firsts = [bg.Blade.from_definition(definition, path=path) for _ in range(2 * (slow + 1))]
    ways = {
        "tested": lambda: firsts.pop().perturbed(SPACE, t()).sections(eta),
        "stations": lambda: firsts.pop().stations(),
        "airfoils to blade": made,
    }
    for what, times in spent(ways, slow).items():
        figure(f"first of a blade: {what}", case, "ms", times)


if __name__ == "__main__":
    main()
