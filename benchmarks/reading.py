"""How long a blade file takes to read: python benchmarks/reading.py

Readings (parse and definition) beside the bare parsing of the same file by PyYAML's safe loaders,
for the bundled blades and for a file of about 250 kB: the NREL 5 MW with polars, as windIO files
carry them.
"""

import tempfile
from functools import partial
from pathlib import Path

import yaml
from figures import asked, figure, seconds

from bladegen.formats.bundled import bundled
from bladegen.formats.reading import read
from bladegen.formats.windio.yaml_file import load_yaml

RUNS = 15
ANGLES = 160  # angles of attack a polar: brings the file to about 250 kB


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
    """Print each file's figures."""
    quick = asked(__doc__).quick
    loaders = {"CSafeLoader": getattr(yaml, "CSafeLoader", None), "safe_load": yaml.SafeLoader}
    with tempfile.TemporaryDirectory() as folder:
        large = Path(folder) / "nrel5mw_polars.yaml"
        paths = [Path(read(name).source) for name in bundled()]
        large.write_text(with_polars(paths[-1]), encoding="utf-8")
        for path in (*paths, large)[: 1 if quick else None]:
            content = path.read_bytes()
            calls = {"bladegen, to a definition": partial(read, path)} | {
                f"PyYAML, {name}, parsed only": partial(yaml.load, content, loader)
                for name, loader in loaders.items()
                if loader is not None
            }
            spent = seconds(calls, 2 if quick else RUNS)
            case = f"{path.stem}, {len(content) / 1e3:.0f} kB"
            figure("reading", case, "ms", {who: [1e3 * s for s in of] for who, of in spent.items()})


if __name__ == "__main__":
    main()
