"""The stages of a blade, from its file to files and a report: python benchmarks/pipeline.py

Sections in a batch stand beside the same sections made one by one; all stages are warm.
"""

import tempfile
from pathlib import Path

import numpy as np
from figures import asked, figure, seconds

import bladegen as bg
from bladegen.exports.build import build

SPANS = 100
RUNS, BUILDS = 15, 3


def main() -> None:
    """Print the stages of each blade."""
    quick = asked(__doc__).quick
    runs, builds = (2, 1) if quick else (RUNS, BUILDS)
    eta = np.linspace(0.0, 1.0, SPANS)
    for name in bg.bundled()[: 1 if quick else None]:
        definition = bg.read(name)
        blade = bg.Blade.from_definition(definition)
        stages = {
            "reading": lambda name=name: bg.read(name),
            "blade from definition": lambda definition=definition: bg.Blade.from_definition(
                definition
            ),
        }
        for what, spent in seconds(stages, runs).items():
            figure(what, name, "ms", [1e3 * one for one in spent])
        ways = {
            "in a batch": lambda blade=blade: blade.sections(eta),
            "one by one": lambda blade=blade: [blade.sections(e) for e in eta],
        }
        spent = {way: [1e3 * one for one in of] for way, of in seconds(ways, runs).items()}
        figure(f"{SPANS} sections of {len(blade.u)}", name, "ms", spent)
        with tempfile.TemporaryDirectory() as folder:
            whole = {"": lambda blade=blade, folder=folder: build(blade, Path(folder))}
            figure("build: STEP, STL, GLB, PNG, report", name, "s", seconds(whole, builds))


if __name__ == "__main__":
    main()
