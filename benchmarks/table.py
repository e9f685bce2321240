"""All benchmarks in one table: python benchmarks/table.py [FILE.md] [--only NAME ...]

Runs each benchmark of this folder as a process of its own and writes what they measured, ours and
the baseline of the same run side by side, with the machine and the versions: `docs/measured.md`.
"""

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from figures import TABLE

HERE = Path(__file__).resolve().parent
LIBRARIES = ("bladegen", "numpy", "scipy", "numba", "cadquery-ocp", "trimesh", "pyvista", "zarr")
SKIPPED = {"figures", "table", "wisdem_run"}  # the last needs another environment
HEAD = """# Measured

All of `benchmarks/`, in one run: `make bench`. Times are medians; a ratio is the baseline's figure
over ours. Machines differ and are shared: compare within a row.
"""


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


def rows_of(script: Path) -> list[dict[str, Any]]:
    """Run one benchmark and return the figures it gave."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "figures.jsonl"
        environment = {**os.environ, TABLE: str(path)}
        done = subprocess.run([sys.executable, str(script)], env=environment, check=False)
        if done.returncode:
            sys.exit(f"{script.name} ended with {done.returncode}")
        lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    return [json.loads(line) for line in lines]


def shown(value: float | None, unit: str) -> str:
    """Return a figure with its unit, or nothing."""
    return "" if value is None else f"{value:.3g} {unit}".strip()


def markdown(title: str, rows: Iterable[dict[str, Any]]) -> str:
    """Return one benchmark's rows as a table."""
    lines = [
        f"\n## `benchmarks/{title}.py`\n",
        "| what | on | bladegen | baseline | | ratio |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for row in rows:
        compared = row["baseline"] is not None and row["value"]
        ratio = f"{row['baseline'] / row['value']:.3g}" if compared else ""
        cells = (
            row["what"],
            row["case"],
            shown(row["value"], row["unit"]),
            row["beside"],
            shown(row["baseline"], row["unit"]),
            ratio,
        )
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Run the benchmarks and write the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("target", nargs="?", type=Path, default=HERE.parent / "docs/measured.md")
    parser.add_argument("--only", nargs="*", help="names of benchmarks, all if not given")
    asked = parser.parse_args()
    scripts = [path for path in sorted(HERE.glob("*.py")) if path.stem not in SKIPPED]
    text = HEAD + f"\n{machine()}\n"
    for script in scripts:
        if asked.only and script.stem not in asked.only:
            continue
        print(f"== {script.name}", flush=True)
        if rows := rows_of(script):
            text += markdown(script.stem, rows)
    asked.target.write_text(text, encoding="utf-8")
    print(f"wrote {asked.target}")


if __name__ == "__main__":
    main()
