"""How cost and memory grow with landmarks, sections and blades: python benchmarks/scaling.py

Each row's baseline is the smallest size's figure times the growth of the size: a ratio of 1 is
linear, above 1 less than linear.
"""

import resource
import subprocess
import sys
from collections.abc import Callable, Sequence

import numpy as np
from figures import figure, seconds

import bladegen as bg
from bladegen import mesh

LANDMARKS = (101, 201, 401, 801)
SECTIONS = (50, 100, 200, 400, 800)
VARIANTS = (64, 256, 1024)
BLADE = "iea15mw"
LINEAR = "if linear"


def growth(what: str, sizes: Sequence[int], cost: Callable[[int], float], unit: str) -> None:
    """Print a cost at each size beside what it would be if it grew as the size does."""
    first = cost(sizes[0])
    for size in sizes:
        value = first if size == sizes[0] else cost(size)
        figure(
            what, f"{BLADE}, {size}", value, unit, beside=LINEAR, baseline=first * size / sizes[0]
        )


def family_seconds(count: int) -> float:
    """Time of a family's sections, dropped block by block."""
    blade, space = bg.Blade.from_definition(bg.read(BLADE)), bg.ShapeSpace.bundled()
    family = bg.family(blade, space, count=count, seed=7, reach=0.5)
    blocks = [np.arange(i, min(i + 64, count)) for i in range(0, count, 64)]

    def run() -> None:
        for block in blocks:
            family.block(block)

    return seconds(run, runs=3)


def family_memory(count: int) -> float:
    """Peak memory of a process that makes a family and drops it block by block [MB]."""
    done = subprocess.run(
        [sys.executable, __file__, str(count)], capture_output=True, text=True, check=True
    )
    return float(done.stdout)


def main() -> None:
    """Print how times and memory grow."""
    definition = bg.read(BLADE)

    def blade(landmarks: int) -> bg.Blade:
        return bg.Blade.from_definition(definition, landmarks=landmarks)

    growth(
        "blade from definition, landmarks",
        LANDMARKS,
        lambda n: 1e3 * seconds(lambda: blade(n)),
        "ms",
    )
    eta = np.linspace(0.0, 1.0, 100)

    def hundred(n: int) -> float:
        made = blade(n)
        return 1e3 * seconds(lambda: made.sections(eta))

    growth("100 sections, landmarks", LANDMARKS, hundred, "ms")
    made = blade(401)
    made.sections(eta)

    def sections(k: int) -> float:
        spans = np.linspace(0.0, 1.0, k)
        return 1e3 * seconds(lambda: made.sections(spans))

    growth("sections of 401 landmarks", SECTIONS, sections, "ms")
    growth(
        "mesh, sections of 401 landmarks",
        SECTIONS,
        lambda k: 1e3 * seconds(lambda: mesh.from_blade(made, stations=k), runs=3),
        "ms",
    )
    growth("family in one thread, variants", VARIANTS, family_seconds, "s")
    growth("peak memory of that, variants", VARIANTS, family_memory, "MB")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        family_seconds(int(sys.argv[1]))
        print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3)
    else:
        main()
