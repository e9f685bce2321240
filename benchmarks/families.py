"""Families: 1,000 perturbed blades beside memory and a plain loop, and files by the second.

    python benchmarks/families.py [BLADE] [--count N]

Sections: 100 spans of 401 landmarks, float64, every section tested; two threads. Memory is the
time to fill, or to copy, as many bytes, freshly taken from the system, by the same threads in the
same blocks.  The plain loop makes variants one after the other through `Blade.perturbed`, a few of
them in each round, scaled to all.  All take turns, all are warm.  A virtual machine may take longer
for memory that nobody held for a second or two: so as much is filled and given back before each
run, whatever is measured.  On a shared machine the processor's seconds say more than the clock's,
and the program's own leave out what the system spends on memory; all three are printed.

The whole command is timed with compiled functions kept, and with an empty `NUMBA_CACHE_DIR` as on a
new machine.  Library calls are timed under as many BLAS threads as there are cores, beside one.

STEP files are made of the first variants, every one of them, in one process as a family's are;
those that miss their tolerance count.
"""

import gc
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from figures import figure, parser, seconds
from threadpoolctl import threadpool_limits

import bladegen as bg
from bladegen.errors import ToleranceError
from bladegen.exports import exporters
from bladegen.exports.options import Options
from bladegen.exports.products import Products
from bladegen.families.family import BLOCK
from bladegen.families.order import Order
from bladegen.families.run import run
from bladegen.shapes.learning import principal
from bladegen.surface import fitting

THREADS = 2
RUNS = 7
LOOPED = 3  # variants a round of the plain loop
STEPS = 15  # STEP files
KINDS = "clock", "own work", "processor"


def spent(work: Callable[[], object]) -> tuple[float, float, float]:
    """Time on the clock, and of the processor: the program's own and all."""
    gc.collect()
    start, before = time.perf_counter(), os.times()
    kept = work()
    clock, after = time.perf_counter() - start, os.times()
    del kept
    own = after.user - before.user
    return clock, own, own + after.system - before.system


def main() -> None:
    """Print the figures of one blade's family."""
    options = parser(__doc__)
    options.add_argument("blade", nargs="?", default="iea15mw")
    options.add_argument("--count", type=int)
    options.add_argument("--reach", type=float, default=0.25)
    asked = options.parse_args()
    count = asked.count or (2 * BLOCK if asked.quick else 1000)
    runs, steps = (2, 2) if asked.quick else (RUNS, STEPS)
    blade = bg.Blade.from_definition(bg.read(asked.blade))
    space = bg.ShapeSpace.bundled()
    family = bg.family(blade, space, count=count, seed=7, reach=asked.reach)
    blocks = [np.arange(i, min(i + BLOCK, count)) for i in range(0, count, BLOCK)]
    shape = family.block(blocks[0][:2]).batch.sections.shape[1:]
    variants = list(bg.family(blade, space, count=1 + runs * LOOPED, seed=7, reach=asked.reach))
    shapes = iter([np.array(variant.changes[-1]["pga"][0]) for variant in variants])
    blade.perturbed(space, next(shapes)).sections(family.eta)

    def on_threads(work: Callable[[np.ndarray], object]) -> list[object]:
        with ThreadPoolExecutor(THREADS) as pool, threadpool_limits(1):
            return list(pool.map(work, blocks))

    def filled(index: np.ndarray) -> np.ndarray:
        return np.full((len(index), *shape), 1.0)

    source = np.ones((BLOCK, *shape))
    works: dict[str, Callable[[], object]] = {
        "a family's blocks": lambda: on_threads(lambda index: family.block(index).batch.sections),
        "filling memory": lambda: on_threads(filled),
        "copying memory": lambda: on_threads(lambda index: source[: len(index)].copy()),
        "a plain loop": lambda: [
            blade.perturbed(space, next(shapes), allow_odd=True).sections(family.eta)
            for _ in range(LOOPED)
        ],
    }
    taken: dict[str, list[tuple[float, float, float]]] = {name: [] for name in works}
    for _ in range(runs):
        for name, work in works.items():
            on_threads(filled)
            taken[name].append(spent(work))
    case = f"{asked.blade}, {count} variants"
    print(f"{case}: {len(family.eta)} x {shape[1]} landmarks, reach {asked.reach:g},")
    print(f"{count * np.prod(shape) * 8 / 1e6:.0f} MB, {THREADS} threads")
    for k, kind in enumerate(KINDS):
        scale = {"a plain loop": count / LOOPED}
        found = {n: [scale.get(n, 1.0) * one[k] for one in v] for n, v in taken.items()}
        figure("sections, tested", f"{case}: {kind}", "s", found)

    with tempfile.TemporaryDirectory() as folder:
        rounds = 1 if asked.quick else 3
        files: dict[str, list[tuple[float, float, float]]] = {"one": [], "two threads": []}
        for k in range(rounds):
            for jobs, name in enumerate(files, start=1):
                order = Order(family, Path(folder) / f"family{k}-{jobs}")
                files[name].append(
                    spent(lambda order=order, jobs=jobs: run(order, jobs=jobs))  # type: ignore[misc]
                )
        for k, kind in enumerate(KINDS):
            found = {name: [one[k] for one in each] for name, each in files.items()}
            figure("manifest, properties and sections to files", f"{case}: {kind}", "s", found)
        whole_commands(asked.blade, 16 if asked.quick else 250, rounds, Path(folder))
        blas_threads(blade, space, 200 if asked.quick else 2000, rounds, Path(folder) / "x.step")
        write_steps(blade, space, asked.reach, steps, Path(folder) / "x.step")


def whole_commands(blade: str, count: int, rounds: int, folder: Path) -> None:
    """Print what the command takes, start and contact sheet included, warm and at first."""
    taken: dict[str, list[float]] = {"warm": [], "first on a machine": []}
    for k in range(-1, rounds):
        for name, each in taken.items():
            cache = folder / ("kept" if name == "warm" else f"fresh{k}")
            target = folder / f"command{k}-{name[:1]}"
            command = [sys.executable, "-m", "bladegen", "family", blade, "-o", str(target)]
            command += ["--count", str(count)]
            start = time.perf_counter()
            environment = {**os.environ, "NUMBA_CACHE_DIR": str(cache)}
            subprocess.run(command, env=environment, check=True, capture_output=True)
            if k >= 0:  # the round before fills files' caches
                each.append(time.perf_counter() - start)
    known = dict.fromkeys(["1.0.0, warm, another run"], 12.1) if count == 250 else {}
    figure("bladegen family, whole process", f"{blade}, {count} variants", "s", taken | known)


def blas_threads(
    blade: bg.Blade, space: bg.ShapeSpace, count: int, rounds: int, target: Path
) -> None:
    """Print library calls under as many BLAS threads as there are cores, beside one."""
    rng = np.random.default_rng(7)
    t = (
        0.2
        * np.sqrt(space.variances[: space.dimension])
        * rng.normal(size=(count, space.dimension))
    )
    shapes = np.linalg.qr(space.decode(t)).Q

    def limited(threads: int, work: Callable[[], object]) -> Callable[[], object]:
        def call() -> object:
            with threadpool_limits(threads):
                return work()

        return call

    works: dict[str, Callable[[], object]] = {
        f"principal modes of {count} shapes": lambda: principal(shapes, space.dimension),
        f"export of {blade.name} to STEP": lambda: bg.export(blade, target),
    }
    for what, work in works.items():
        calls = {f"{n} BLAS threads": limited(n, work) for n in (1, os.cpu_count() or 2)}
        figure(what, "default threads beside one", "s", seconds(calls, rounds))


def write_steps(
    blade: bg.Blade, space: bg.ShapeSpace, reach: float, count: int, target: Path
) -> None:
    """Print what STEP files of variants take; the baseline's is made first, and not counted."""
    products = Products(blade, Options())
    exporters.write(products, target)
    spans = fitting.fitted(blade, products.options.tolerance)[0].spans
    options = Options(spans=spans)
    clock, processor, off, missed = [], [], [], 0
    with threadpool_limits(1):  # as a family's processes do
        for variant in list(bg.family(blade, space, count=count, seed=7, reach=reach)):
            products = Products(variant, options)

            def write(products: Products = products) -> bool:
                try:
                    exporters.write(products, target)
                except ToleranceError:  # its file is kept, and its time counts
                    return False
                return True

            each = spent(write)
            missed += products.solid.deviation.maximum > products.options.tolerance
            clock.append(each[0])
            processor.append(each[2])
            off.append(1e3 * products.solid.deviation.maximum)
    case = f"{blade.name}, variants 0 to {count - 1}"
    figure("STEP of a variant, one core", f"{case}: clock", "s", clock)
    figure("STEP of a variant, one core", f"{case}: processor", "s", processor)
    figure("STEP of a variant, off the blade by up to", case, "mm", off)
    figure("STEP of a variant, out of tolerance", case, "files", missed)


if __name__ == "__main__":
    main()
