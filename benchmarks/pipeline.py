"""The stages of a blade, from its file to files and a report: python benchmarks/pipeline.py

Sections in a batch stand beside the same sections made one by one.
"""

import tempfile
from pathlib import Path

import numpy as np
from figures import figure, seconds

import bladegen as bg
from bladegen.build import build

SPANS = 100


def main() -> None:
    """Print the stages of each blade."""
    eta = np.linspace(0.0, 1.0, SPANS)
    for name in bg.bundled():
        definition = bg.read(name)
        blade = bg.Blade.from_definition(definition)
        figure("reading", name, 1e3 * seconds(lambda name=name: bg.read(name)), "ms")
        made = seconds(lambda definition=definition: bg.Blade.from_definition(definition))
        figure("blade from definition", name, 1e3 * made, "ms")
        batch = seconds(lambda blade=blade: blade.sections(eta), runs=15)
        loop = seconds(lambda blade=blade: [blade.sections(e) for e in eta])
        figure(
            f"{SPANS} sections of {len(blade.u)}",
            name,
            1e3 * batch,
            "ms",
            beside="one by one",
            baseline=1e3 * loop,
        )
        with tempfile.TemporaryDirectory() as folder:
            target = Path(folder)
            all_ = seconds(lambda blade=blade, target=target: build(blade, target), runs=3)
            figure("build: STEP, STL, GLB, PNG, report", name, all_, "s")


if __name__ == "__main__":
    main()
