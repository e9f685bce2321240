"""How long a blade takes to build and to evaluate: medians, with a plain loop beside it."""

import time
from collections.abc import Callable
from statistics import median

import numpy as np

import bladegen as bg

RUNS = 15


def seconds(call: Callable[[], object]) -> float:
    """Median of `RUNS` calls, after one that warms up."""
    call()
    spent = []
    for _ in range(RUNS):
        start = time.perf_counter()
        call()
        spent.append(time.perf_counter() - start)
    return median(spent)


def main() -> None:
    """Print a row a blade."""
    eta = np.linspace(0.0, 1.0, 100)
    print("blade     read ms  build ms  100 x 401 sections ms  one by one ms  ratio")
    for name in bg.bundled():
        definition = bg.read(name)
        blade = bg.Blade.from_definition(definition)
        row = [
            seconds(lambda name=name: bg.read(name)),
            seconds(lambda definition=definition: bg.Blade.from_definition(definition)),
            batch := seconds(lambda blade=blade: blade.sections(eta)),
            loop := seconds(lambda blade=blade: [blade.sections(e) for e in eta]),
        ]
        read, build, *_ = (1e3 * value for value in row)
        print(
            f"{name:9s} {read:7.1f} {build:9.1f} {1e3 * batch:22.1f} {1e3 * loop:14.1f} "
            f"{loop / batch:6.1f}"
        )


if __name__ == "__main__":
    main()
