"""All benchmarks in one document: python benchmarks/table.py [FILE.md] [--only NAME ...] [--quick]

Runs each benchmark of this folder as a process of its own and writes what they measured, all
contenders of one run side by side, with the machine and the versions: `docs/measured.md`.  With
`--only`, what the document holds of the others stays.  If that document is written, and not at a
small size, the tables of README.md and of the other pages that stand between

    <!-- measured: BENCHMARK | FIGURE; FIGURE | CASE; CASE -->
    <!-- end -->

are made anew too, of the figures named there and of the cases that contain one of the texts, of all
if none is given.
"""

import argparse
import json
import os
import platform
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from datetime import date
from importlib.metadata import PackageNotFoundError, version
from itertools import groupby
from pathlib import Path
from typing import Any

from figures import SPREAD, TABLE
from headlines import summary

HERE = Path(__file__).resolve().parent
MEASURED = HERE.parent / "docs" / "measured.md"
LIBRARIES = ("bladegen", "numpy", "scipy", "numba", "cadquery-ocp", "trimesh", "pyvista", "zarr")
SKIPPED = {"figures", "headlines", "table"}
SKIPPED |= {"numad_workbook", "wisdem_run"}  # these need another environment
SKIPPED |= {"rotor_flow", "snapped_section"}  # and these OpenFOAM, and a case or a blade's name
HEAD = f"""# Measured

What `benchmarks/` print, each in one run of its own; `make bench` runs all. Contenders take turns
within a run, all warm.
Where a cell holds four figures they are the {SPREAD} of as many runs, variants or
stations as the head says. Machines differ and are shared: compare within a row. The rules that all
benchmarks keep are at the head of `benchmarks/figures.py`.
"""
TOP = "## The twenty that most ask for"
LARGE = 1e7  # whole numbers below it are shown digit by digit
Row = dict[str, Any]
BLOCK = re.compile(r"<!-- measured:([^|>]*)\|([^|>]*)\|([^|>]*)-->\n.*?<!-- end -->", re.DOTALL)


def machine() -> str:
    """Say what the figures were measured on."""
    model = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        lines = info.read_text(encoding="utf-8").splitlines()
        names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
        model = names[0] if names else model
    cores = len(os.sched_getaffinity(0))
    found = []
    for name in LIBRARIES:
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            continue
    python = f"Python {platform.python_version()}"
    return f"{model}, {cores} cores, {platform.system()}; {', '.join([python, *found])}."


def rows_of(script: Path, quick: bool) -> list[Row]:
    """Run one benchmark and return the figures it gave."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "figures.jsonl"
        environment = {**os.environ, TABLE: str(path)}
        command = [sys.executable, str(script), *(["--quick"] if quick else [])]
        done = subprocess.run(command, env=environment, check=False)
        if done.returncode:
            sys.exit(f"{script.name} ended with {done.returncode}")
        lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    return [json.loads(line) for line in lines]


def shown(values: Sequence[float] | None) -> str:
    """Return a contender's figure, or its spread without the count."""
    if values is None:
        return "not done"
    return " / ".join(
        f"{value:,.0f}" if value == round(value) and abs(value) < LARGE else f"{value:.3g}"
        for value in values[:4]
    )


def tables(rows: Sequence[Row]) -> list[str]:
    """Return a benchmark's rows as tables: a line a case, a column a contender of a figure.

    Figures that were taken on the same cases by the same contenders stand in one table.
    """
    by_what: dict[str, list[Row]] = {}
    for row in rows:
        by_what.setdefault(row["what"], []).append(row)
    return [
        table([of for _, of in group])
        for _, group in groupby(by_what.items(), key=lambda item: cases(item[1]))
    ]


def cases(rows: Sequence[Row]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return what rows of one figure were taken on, and by whom."""
    return tuple(row["case"] for row in rows), tuple(rows[0]["found"])


def table(columns: Sequence[Sequence[Row]]) -> str:
    """Return one table of figures that were taken on the same cases; one figure is its title."""
    names = tuple(columns[0][0]["found"])
    titled = len(columns) == 1 and names != ("",)
    title, heads = "", []
    for rows in columns:
        what = rows[0]["what"] + (f" [{rows[0]['unit']}]" if rows[0]["unit"] else "")
        for name in names:
            of = counted([row["found"][name] for row in rows])
            heads.append(", ".join(filter(None, (name, of) if titled else (what, name, of))))
        title = f"{what[:1].upper()}{what[1:]}:\n\n" if titled else ""
    lines = [f"| on | {' | '.join(heads)} |", "| --- " * (1 + len(heads)) + "|"]
    for rows in zip(*columns, strict=True):
        cells = [shown(row["found"][name]) for row in rows for name in names]
        lines.append(f"| {rows[0]['case']} | {' | '.join(cells)} |")
    return title + "\n".join(lines) + "\n"


def counted(found: Sequence[Sequence[float] | None]) -> str:
    """Return of how many values the spreads of a column are; nothing for single values."""
    counts = sorted({int(values[-1]) for values in found if values and len(values) > 1})
    return f"of {' to '.join(map(str, dict.fromkeys((counts[0], counts[-1]))))}" if counts else ""


def chosen(rows: Sequence[Row], figures: Sequence[str], parts_of_cases: Sequence[str]) -> str:
    """Return one table of some figures of a benchmark, and of some cases.

    Raises
    ------
    ValueError
        If the benchmark has none of a figure, or its figures were taken on different cases.
    """
    columns = [
        [
            row
            for row in rows
            if row["what"] == what and any(part in row["case"] for part in parts_of_cases or [""])
        ]
        for what in figures
    ]
    if len({cases(column) for column in columns if column}) != 1 or not all(columns):
        raise ValueError(f"no one table of {'; '.join(figures)}")
    return table(columns)


def refreshed(text: str, made: Mapping[str, Sequence[Row]]) -> str:
    """Return a page with its measured tables made anew, as far as their benchmarks were run."""

    def anew(found: re.Match[str]) -> str:
        name, figures, of = ([one.strip() for one in part.split(";")] for part in found.groups())
        if name[0] not in made:
            return found[0]
        some = chosen(made[name[0]], figures, [part for part in of if part])
        return f"<!-- measured:{found[1]}|{found[2]}|{found[3]}-->\n\n{some}\n<!-- end -->"

    return BLOCK.sub(anew, text)


def parts(text: str) -> dict[str, str]:
    """Return what a document holds of each benchmark."""
    pieces = re.split(r"\n## `benchmarks/(\w+)\.py`\n", text)
    return dict(zip(pieces[1::2], pieces[2::2], strict=True))


def main() -> None:
    """Run the benchmarks and write the document."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("target", nargs="?", type=Path, default=MEASURED)
    options.add_argument("--only", nargs="*", help="names of benchmarks, all if not given")
    options.add_argument("--quick", action="store_true", help="try all at a small size")
    asked = options.parse_args()
    scripts = [path for path in sorted(HERE.glob("*.py")) if path.stem not in SKIPPED]
    made: dict[str, str] = {}
    found: dict[str, list[Row]] = {}
    if asked.only and asked.target.exists():
        made = parts(asked.target.read_text(encoding="utf-8"))
    for script in scripts:
        if asked.only and script.stem not in asked.only:
            continue
        print(f"== {script.name}", flush=True)
        start = time.perf_counter()
        found[script.stem] = rows_of(script, asked.quick)
        rows = "\n".join(tables(found[script.stem]))
        made[script.stem] = rows and f"\nMeasured on {date.today()}.\n\n{rows}"
        print(f"== {script.name} took {time.perf_counter() - start:.0f} s", flush=True)
    text = HEAD + f"\n{machine()}\n\n{TOP}\n\n{summary(made)}"
    for name in sorted(name for name in made if made[name].strip()):
        text += f"\n## `benchmarks/{name}.py`\n{made[name]}"
    asked.target.write_text(text, encoding="utf-8")
    print(f"wrote {asked.target}")
    if asked.target.resolve() == MEASURED and not asked.quick:
        for page in (HERE.parent / "README.md", *sorted(MEASURED.parent.glob("*.md"))):
            page.write_text(refreshed(page.read_text(encoding="utf-8"), found), encoding="utf-8")


if __name__ == "__main__":
    main()
