"""Families: 1,000 perturbed blades beside memory and a plain loop, and files by the second.

    python benchmarks/families.py [BLADE] [--count N]

Sections: 100 spans of 401 landmarks, float64, every section tested; two threads. Memory is the
time to fill as many bytes, freshly taken from the system, by the same threads in the same blocks.
The plain loop makes variants one after the other through `Blade.perturbed`.  Medians of several
runs, in turn.  A virtual machine may take longer for memory that nobody held for a second or two:
so as much is filled and given back before each run, whatever is measured.  On a shared machine
the processor's seconds say more than the clock's, and the program's own leave out what the system
spends on memory; all three are printed, each beside those of memory and of the loop.
"""

import argparse
import gc
import os
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from figures import figure
from threadpoolctl import threadpool_limits

import bladegen as bg
from bladegen import exporters, net
from bladegen.families import BLOCK
from bladegen.family_run import Order, run

THREADS = 2
RUNS = 5
KINDS = "clock", "own work", "processor"


def seconds(work):
    """Time on the clock, and of the processor: the program's own and all."""
    gc.collect()
    start, before = time.perf_counter(), os.times()
    kept = work()
    spent, after = time.perf_counter() - start, os.times()
    del kept
    own = after.user - before.user
    return spent, own, own + after.system - before.system


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

    source = np.ones((BLOCK, *shape))
    works = made, written, lambda index: source[: len(index)].copy()
    taken = []
    for _ in range(RUNS):
        for work in works:
            on_threads(written)
            taken.append(seconds(lambda work=work: on_threads(work)))
    first, memory, copied = np.median(np.reshape(taken, (RUNS, len(works), 3)), axis=0)
    loop = []
    for variant in list(bg.family(blade, space, count=6, seed=7, reach=asked.reach)):
        t = np.array(variant.changes[-1]["pga"][0])
        loop.append(seconds(lambda t=t: blade.perturbed(space, t).sections(family.eta)))
    one = np.median(loop, axis=0) * asked.count
    case = f"{asked.blade}, {asked.count} variants"
    print(f"{case}: {len(family.eta)} x {shape[1]} landmarks, reach {asked.reach:g},")
    print(f"{size / 1e6:.0f} MB, {THREADS} threads, medians of {RUNS}")
    for beside, other in (
        ("filling memory", memory),
        ("copying memory", copied),
        ("plain loop", one),
    ):
        for kind, ours, baseline in zip(KINDS, first, other, strict=True):
            figure(f"sections, tested: {kind}", case, ours, "s", beside=beside, baseline=baseline)

    with tempfile.TemporaryDirectory() as folder:
        spent, *_ = seconds(lambda: run(Order(family, Path(folder) / "f"), jobs=THREADS))
        figure(f"sections to files, {THREADS} processes", case, asked.count / spent, "variants/s")
        spans = net.fitted(blade, exporters.Options().tolerance)[0].v
        options = exporters.Options(spans=spans)
        target = Path(folder) / "x.step"
        with threadpool_limits(1):  # as a family's processes do
            step = [
                seconds(lambda v=v: exporters.write(exporters.Products(v, options), target))
                for v in list(bg.family(blade, space, count=6, seed=7, reach=asked.reach))
            ][1:]
        clock, _, cpu = np.median(step, axis=0)
        figure("STEP of a variant, one core: clock", asked.blade, clock, "s")
        figure("STEP of a variant, one core: processor", asked.blade, cpu, "s")


if __name__ == "__main__":
    main()
