"""Reading a family as training loops do, beside reading as many bytes: variants per second.

    python benchmarks/datasets.py [--count N]

A family of N variants (512 if not given) of 100 spans and 401 landmarks, float32, lies in the
system's cache.  Contenders read all its sections: the plain bytes of its files into memory;
`LoadedFamily.batches` in order, and shuffled; one variant after the other in random order by
`FamilyDataset`'s way (`arrays_at` of 64 random places); and xarray without Dask, 64 at a time.  All
take turns, in one thread.

Then the command itself makes 1,000 and 10,000 variants in two threads (not with `--quick`): time by
the clock and of the processor, disk, and the most memory that its process held.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import xarray
from figures import figure, parser, seconds

import bladegen as bg
from bladegen.families.dataset.reading import arrays_at
from bladegen.families.order import Order
from bladegen.families.run import run

SPANS, BATCH = 100, 64
COUNTS = (1000, 10000)


def raw(folder: Path) -> int:
    """Read the bytes of all sections."""
    files = sorted((folder / "sections.zarr" / "sections" / "c").rglob("*"))
    return sum(len(file.read_bytes()) for file in files if file.is_file())


def drained(parts: object) -> int:
    """Go through batches; return how many variants they held."""
    return sum(len(part["sections"]) for part in parts)  # type: ignore[attr-defined]


def by_xarray(folder: Path) -> int:
    """Read all sections through xarray, some at a time."""
    with xarray.open_zarr(folder / "sections.zarr", chunks=None) as data:
        sections = data["sections"]
        return sum(len(sections[i : i + BATCH].values) for i in range(0, len(sections), BATCH))


def peak(command: list[str]) -> tuple[float, float, float]:
    """Return seconds that a command took, by the clock and of the processor; most memory [GB]."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    if status:
        sys.exit(f"{command} ended with {status}")
    took = time.perf_counter() - start
    return took, used.ru_utime + used.ru_stime, used.ru_maxrss / 1e6


def main() -> None:
    """Print what reading takes, and what making does."""
    options = parser(__doc__)
    options.add_argument("--count", type=int, default=512)
    asked = options.parse_args()
    count = 64 if asked.quick else asked.count
    blade, space = bg.Blade.from_definition(bg.read("iea15mw")), bg.ShapeSpace.bundled()
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "family"
        run(Order(bg.family(blade, space, count=count, seed=7, reach=0.25, spans=SPANS), target))
        family, names = bg.load_family(target), ("parameters", "sections")
        rng = np.random.default_rng(0)
        order = rng.permutation(count)
        pieces = [order[i : i + BATCH] for i in range(0, count, BATCH)]
        spent = seconds(
            {
                "the bytes": lambda: raw(target),
                "batches, in order": lambda: drained(family.batches(names, BATCH)),
                "batches, shuffled": lambda: drained(family.batches(names, BATCH, rng=rng)),
                "64 random places": lambda: drained(
                    arrays_at(family, names, piece) for piece in pieces
                ),
                "xarray, in order": lambda: by_xarray(target),
            },
            3 if asked.quick else 7,
        )
        case = f"{count} variants, {raw(target) / 1e6:.0f} MB"
        rates = {name: [count / one for one in each] for name, each in spent.items()}
        figure("read, variants per second", case, "1/s", rates)
        bytes_alone = float(np.median(spent["the bytes"]))
        for name, each in spent.items():
            figure(
                "read, time over that of the bytes", name, "", float(np.median(each)) / bytes_alone
            )
    for number in () if asked.quick else COUNTS:
        with tempfile.TemporaryDirectory() as folder:
            words = ["--count", str(number), "--seed", "7", "--reach", "0.25", "--jobs", "2"]
            command = [sys.executable, "-m", "bladegen", "family", "iea15mw", "-o", folder, *words]
            took, worked, held = peak(command)
            size = sum(file.stat().st_size for file in Path(folder).rglob("*") if file.is_file())
            case = f"{number} variants of {SPANS} spans, two threads, whole command"
            figure("made, variants per second", case, "1/s", number / took)
            figure("made, processor's time", case, "s", worked)
            figure("made, most memory", case, "GB", held)
            figure("made, disk", case, "GB", size / 1e9)


if __name__ == "__main__":
    main()
