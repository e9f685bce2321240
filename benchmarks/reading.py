"""How long a blade file takes to read: python benchmarks/reading.py

Prints the best of several readings (parse and definition) beside the bare parsing of the same
file by PyYAML's safe loaders, for the bundled blades and for a file of about 250 kB: the NREL
5 MW with polars, as windIO files carry them.
"""

import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import yaml

from bladegen.readers import bundled, read
from bladegen.readers.yaml_file import load_yaml

REPEATS = 5
ANGLES = 160  # angles of attack a polar: brings the file to about 250 kB


def best(function: Callable[[], object], repeats: int = REPEATS) -> float:
    """Return the shortest of several runs [ms]."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return 1e3 * min(times)


def with_polars(path: Path) -> str:
    """Return a blade file with polars of `ANGLES` angles of attack for every airfoil."""
    document, _ = load_yaml(path)
    grid = [-180.0 + 360.0 * i / (ANGLES - 1) for i in range(ANGLES)]
    for airfoil in document["airfoils"]:
        curves = {
            name: {"grid": grid, "values": [factor * angle / 180.0 for angle in grid]}
            for name, factor in (("cl", 1.1), ("cd", 0.3), ("cm", -0.1))
        }
        airfoil["polars"] = [{"configuration": "default", "re_sets": [{"re": 1e7, **curves}]}]
    dumper = type("Dumper", (yaml.SafeDumper,), {"ignore_aliases": lambda *_: True})
    return yaml.dump(document, Dumper=dumper, default_flow_style=None, width=100)


def main() -> None:
    """Print one row a file."""
    fast = getattr(yaml, "CSafeLoader", None)
    heads = "".join(f"{head:>13}" for head in ("read [ms]", "CSafeLoader", "safe_load"))
    print(f"{'file':24}{'kB':>8}", heads)
    with tempfile.TemporaryDirectory() as folder:
        large = Path(folder) / "nrel5mw_polars.yaml"
        paths = [Path(read(name).source) for name in bundled()]
        large.write_text(with_polars(paths[-1]), encoding="utf-8")
        for path in (*paths, large):
            content = path.read_bytes()
            figures = [f"{best(partial(read, path)):.1f}"]
            for loader, repeats in ((fast, REPEATS), (yaml.SafeLoader, 1)):
                parse = partial(yaml.load, content, loader)
                figures.append("-" if loader is None else f"{best(parse, repeats):.1f}")
            print(f"{path.name:24}{len(content) / 1e3:8.0f}", "".join(f"{f:>13}" for f in figures))


if __name__ == "__main__":
    main()
