"""What every benchmark shares: contenders in turn, spreads of what they took, a printed line.

Rules, for every benchmark: contenders run in turn in one process or in processes of the same kind,
all warm or all cold; none is left out, nor any variant; where runs differ, the median, mean, 90th
percentile and maximum are shown; where contenders are not equally exact, what each missed by
stands beside its time.

A figure is printed as it is measured.  Where `TABLE` names a file (benchmarks/table.py does), it
is also added there as a line of JSON, from which tables are made.
"""

import argparse
import gc
import json
import os
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

__all__ = ["SPREAD", "TABLE", "asked", "figure", "parser", "seconds", "spread"]

TABLE = "BLADEGEN_FIGURES"
SPREAD = "median / mean / 90 % / max"
Values = float | Sequence[float]


def parser(doc: str | None) -> argparse.ArgumentParser:
    """Return a parser of a benchmark's options: `--quick` tries it at a small size."""
    options = argparse.ArgumentParser(description=(doc or "").splitlines()[0])
    options.add_argument("--quick", action="store_true", help="try it at a small size")
    return options


def asked(doc: str | None) -> argparse.Namespace:
    """Return the options of a benchmark that has `--quick` only."""
    return parser(doc).parse_args()


def seconds(
    contenders: Mapping[str, Callable[[], object]], runs: int = 7, *, warm: bool = True
) -> dict[str, list[float]]:
    """Return what `runs` calls of each contender took [s], in turn, each warmed by one call."""
    spent: dict[str, list[float]] = {name: [] for name in contenders}
    for call in contenders.values() if warm else ():
        call()
    for _ in range(runs):
        for name, call in contenders.items():
            gc.collect()
            start = time.perf_counter()
            kept = call()  # what it returns is freed after the time is taken
            spent[name].append(time.perf_counter() - start)
            del kept
    return spent


def spread(values: Sequence[float]) -> tuple[float, float, float, float]:
    """Return median, mean, 90th percentile and maximum."""
    v = np.asarray(values, dtype=float)
    return float(np.median(v)), float(v.mean()), float(np.percentile(v, 90)), float(v.max())


def figure(what: str, case: str, unit: str, found: Values | Mapping[str, Values | None]) -> None:
    """Print one figure of one case, of all contenders.

    Parameters
    ----------
    what, case : str
        What is measured, and on which blade or size.
    unit : str
        Of all values.
    found : float, list or mapping
        A value, or several of which the spread is shown; or those of each contender by its name,
        None of one that did not get there.
    """
    each = found if isinstance(found, Mapping) else {"": found}
    row: dict[str, list[float] | None] = {}
    for name, values in each.items():
        if values is None:
            shown, row[name] = "not done", None
        elif isinstance(values, Sequence):
            row[name] = [*spread(values), len(values)]
            shown = f"{' / '.join(f'{v:.4g}' for v in spread(values))} {unit}, of {len(values)}"
        else:
            row[name] = [float(values)]
            shown = f"{values:.4g} {unit}".strip()
        print(f"{what:36s} {case:30s} {name:16s} {shown}", flush=True)
    if os.environ.get(TABLE):
        line = {"what": what, "case": case, "unit": unit, "found": row}
        with Path(os.environ[TABLE]).open("a", encoding="utf-8") as stream:
            stream.write(json.dumps(line) + "\n")
