"""Families: 1,000 perturbed blades beside memory and a plain loop, and files by the second.

    python benchmarks/families.py [BLADE] [--count N]

Sections: 100 spans of 401 landmarks, float64, every section tested; two threads. Memory is the
time to fill as many bytes, freshly taken from the system, by the same threads.  The plain loop
makes variants one after the other through `Blade.perturbed`.  Medians of several runs.
"""

import argparse
import gc
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

import bladegen as bg
from bladegen import exporters, net
from bladegen.families import BLOCK
from bladegen.family_run import Order, run

THREADS = 2
RUNS = 5


def seconds(work):
    gc.collect()
    start = time.perf_counter()
    kept = work()
    spent = time.perf_counter() - start
    del kept
    return spent


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("blade", nargs="?", default="iea15mw")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--reach", type=float, default=0.25)
    asked = parser.parse_args()
    blade = bg.Blade.from_definition(bg.read(asked.blade))
    space = bg.ShapeSpace.bundled()
    family = bg.family(blade, space, count=asked.count, seed=7, reach=asked.reach)
    blocks = [np.arange(i, min(i + BLOCK, asked.count)) for i in range(0, asked.count, BLOCK)]
    shape = family.block(blocks[0][:2]).batch.sections.shape[1:]
    size = asked.count * np.prod(shape) * 8

    def on_threads(work):
        with ThreadPoolExecutor(THREADS) as pool, threadpool_limits(1):
            return list(pool.map(work, blocks))

    def made(index):
        return family.block(index).batch.sections

    def written(index):
        return np.full((len(index), *shape), 1.0)

    sections, memory, copied = [], [], []
    source = np.ones((BLOCK, *shape))
    for _ in range(RUNS):
        sections.append(seconds(lambda: on_threads(made)))
        memory.append(seconds(lambda: on_threads(written)))
        copied.append(seconds(lambda: on_threads(lambda index: source[: len(index)].copy())))
    loop = []
    for variant in list(bg.family(blade, space, count=6, seed=7, reach=asked.reach)):
        t = np.array(variant.changes[-1]["pga"][0])
        loop.append(seconds(lambda t=t: blade.perturbed(space, t).sections(family.eta)))
    s, m, c = (float(np.median(times)) for times in (sections, memory, copied))
    one = float(np.median(loop))
    print(f"{asked.count} variants of {asked.blade}, {len(family.eta)} x {shape[1]} landmarks,")
    print(f"reach {asked.reach:g}, {size / 1e6:.0f} MB, {THREADS} threads, medians of {RUNS}:")
    print(f"  sections, tested      {s:7.2f} s   {asked.count / s:6.0f} variants/s")
    print(f"  filling memory        {m:7.2f} s   ratio {s / m:5.1f}")
    print(f"  copying memory        {c:7.2f} s   ratio {s / c:5.1f}")
    print(
        f"  plain loop            {one * asked.count:7.1f} s   ratio {one * asked.count / s:5.1f}"
    )

    with tempfile.TemporaryDirectory() as folder:
        spent = seconds(lambda: run(Order(family, Path(folder) / "f"), jobs=THREADS))
        print(
            f"  to files, {THREADS} processes  {spent:7.2f} s   "
            f"{asked.count / spent:6.0f} variants/s"
        )
        spans = net.fitted(blade, exporters.Options().tolerance)[0].v
        options = exporters.Options(spans=spans)
        target = Path(folder) / "x.step"
        step = [
            seconds(lambda v=v: exporters.write(exporters.Products(v, options), target))
            for v in list(bg.family(blade, space, count=6, seed=7, reach=asked.reach))
        ][1:]
        print(f"  STEP, one core        {np.median(step):7.2f} s a blade")


if __name__ == "__main__":
    main()
