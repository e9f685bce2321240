"""Fuzz bladegen at length: bad input to every reader, watched by a parent process.

    python scripts/fuzz.py --count 100000 --seed 1 --seconds 3600

Input i of a seed is always the same, so runs may be done in pieces (`--first`) and failures are
found again; each is also saved as a file (`--save`).  Ends with 1 if anything failed.
"""

import argparse
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

import foreign_fuzzing  # noqa: E402
import fuzzing  # noqa: E402
from fuzzing import Tally, fuzz, trial  # noqa: E402

TARGETS = fuzzing.TARGETS + foreign_fuzzing.TARGETS


def main() -> int:
    """Try inputs and print what came of them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100_000, help="inputs to try")
    parser.add_argument("--first", type=int, default=0, help="index of the first")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=3600.0, help="stop after so long")
    parser.add_argument("--only", action="append", help="targets whose name holds this or another")
    parser.add_argument("--save", type=Path, help="a folder for inputs that failed")
    asked = parser.parse_args()
    names = asked.only or [""]
    targets = tuple(target for target in TARGETS if any(name in target.name for name in names))
    start, shown, saved = time.monotonic(), 0.0, 0

    def told(tally: Tally) -> None:
        nonlocal shown, saved
        for index, outcome in tally.failures[saved:]:
            sys.stdout.write(f"input {index}: {outcome}\n")
            sys.stdout.flush()
            if asked.save:
                asked.save.mkdir(parents=True, exist_ok=True)
                for name, data in trial(targets, asked.seed, index)[2].items():
                    plain = name.replace("/", "_")
                    (asked.save / f"{asked.seed}-{index}-{plain}").write_bytes(data)
        saved = len(tally.failures)
        if time.monotonic() - shown > 10.0:
            shown = time.monotonic()
            rate = tally.inputs / (shown - start)
            sys.stderr.write(
                f"\r{tally.inputs} inputs, {rate:.0f}/s, {len(tally.failures)} failures "
            )
            sys.stderr.flush()

    tally = fuzz(
        targets,
        seed=asked.seed,
        count=asked.count,
        first=asked.first,
        seconds=asked.seconds,
        told=told,
    )
    told(tally)
    sys.stderr.write("\r")
    out = sys.stdout.write
    out(f"inputs {tally.inputs} of seed {asked.seed} from {asked.first}, {tally.seconds:.0f} s\n")
    out(f"slowest input {1e3 * tally.slowest[0]:.0f} ms (index {tally.slowest[1]})\n")
    out(f"peak memory of a worker {tally.memory:.0f} MB\n")
    for outcome, count in sorted(tally.outcomes.items()):
        out(f"{count:8d}  {outcome}\n")
    return 1 if tally.failures else 0


if __name__ == "__main__":
    sys.exit(main())
