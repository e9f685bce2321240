"""How cost and memory grow with landmarks, sections and blades: python benchmarks/scaling.py

Beside each cost stands its median divided by the size: it falls where a fixed part still counts,
stays where the cost is linear, and rises where it is worse.
"""

import resource
import subprocess
import sys
from collections.abc import Callable, Sequence

import numpy as np
from figures import figure, parser, seconds, spread

import bladegen as bg
from bladegen.surface import mesh

LANDMARKS = (101, 201, 401, 801)
SECTIONS = (50, 100, 200, 400, 800)
VARIANTS = (64, 256, 1024)
BLADE = "iea15mw"
RUNS = 7


def growth(
    what: str, sizes: Sequence[int], cost: Callable[[int], float | list[float]], unit: str
) -> None:
    """Print a cost at each size, and what that is a piece."""
    for size in sizes:
        value = cost(size)
        middle = spread(value)[0] if isinstance(value, list) else value
        figure(what, f"{BLADE}, {size}", unit, {"all": value, "each": middle / size})


def taken(call: Callable[[], object], runs: int) -> list[float]:
    """Return what runs of a call took [ms]."""
    return [1e3 * one for one in seconds({"": call}, runs)[""]]


def family(count: int) -> Callable[[], None]:
    """Return a call that makes a family's sections and drops them block by block."""
    blade, space = bg.Blade.from_definition(bg.read(BLADE)), bg.ShapeSpace.bundled()
    variants = bg.family(blade, space, count=count, seed=7, reach=0.5)
    blocks = [np.arange(i, min(i + 64, count)) for i in range(0, count, 64)]

    def run() -> None:
        for block in blocks:
            variants.block(block)

    return run


def family_memory(count: int) -> float:
    """Peak memory of a process that makes a family and drops it block by block [MB]."""
    done = subprocess.run(
        [sys.executable, __file__, "--family", str(count)],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    return float(done.stdout)


def main() -> None:
    """Print how times and memory grow."""
    options = parser(__doc__)
    options.add_argument("--family", type=int, help="for the processes that this one starts")
    asked = options.parse_args()
    if asked.family:
        family(asked.family)()
        print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3)
        return
    definition, runs, some = bg.read(BLADE), RUNS, slice(None)
    if asked.quick:
        runs, some = 2, slice(0, 2)

    def blade(landmarks: int) -> bg.Blade:
        return bg.Blade.from_definition(definition, landmarks=landmarks)

    growth("blade, landmarks", LANDMARKS[some], lambda n: taken(lambda: blade(n), runs), "ms")
    eta = np.linspace(0.0, 1.0, 100)

    def hundred(n: int) -> list[float]:
        made = blade(n)
        return taken(lambda: made.sections(eta), runs)

    growth("100 sections, landmarks", LANDMARKS[some], hundred, "ms")
    made = blade(401)

    def sections(k: int) -> list[float]:
        spans = np.linspace(0.0, 1.0, k)
        return taken(lambda: made.sections(spans), runs)

    def meshed(k: int) -> list[float]:
        return taken(lambda: mesh.from_blade(made, stations=k), runs)

    growth("sections of 401 landmarks", SECTIONS[some], sections, "ms")
    growth("mesh, sections of 401 landmarks", SECTIONS[some], meshed, "ms")
    growth(
        "family in one thread, variants",
        VARIANTS[some],
        lambda count: taken(family(count), runs),
        "ms",
    )
    growth("peak memory of that, variants", VARIANTS[some], family_memory, "MB")


if __name__ == "__main__":
    main()
