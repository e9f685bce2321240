"""What every benchmark here shares: medians of runs, and figures with their baseline beside them.

A figure is printed as it is measured.  Where `TABLE` names a file (benchmarks/table.py does), it
is also added there as a line of JSON, from which one table is made of all.
"""

import gc
import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

__all__ = ["TABLE", "figure", "seconds"]

TABLE = "BLADEGEN_FIGURES"


def seconds(call: Callable[[], object], runs: int = 5, warm: bool = True) -> float:
    """Return the median time of `runs` calls [s], after one that warms up."""
    if warm:
        call()
    spent = []
    for _ in range(runs):
        gc.collect()
        start = time.perf_counter()
        kept = call()  # what it returns is freed after the time is taken
        spent.append(time.perf_counter() - start)
        del kept
    return median(spent)


def figure(
    what: str,
    case: str,
    value: float,
    unit: str,
    *,
    beside: str = "",
    baseline: float | None = None,
) -> None:
    """Print one figure, and the baseline's from the same run beside it.

    Parameters
    ----------
    what, case : str
        What is measured, and on which blade or size.
    value : float
        Ours, in `unit`.
    beside : str
        What the baseline is.
    baseline : float, optional
        Its figure, in the same unit.
    """
    ours = f"{value:.4g} {unit}".strip()
    other = "" if baseline is None else f"{beside} {baseline:.4g} {unit}"
    if other and value:
        other += f", {baseline / value:.3g} x"
    print(f"{what:40s} {case:22s} {ours:>16s}   {other}", flush=True)
    if os.environ.get(TABLE):
        row = {"what": what, "case": case, "value": value, "unit": unit}
        with Path(os.environ[TABLE]).open("a", encoding="utf-8") as stream:
            stream.write(json.dumps({**row, "beside": beside, "baseline": baseline}) + "\n")
