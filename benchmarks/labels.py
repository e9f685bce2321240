"""Labels of families: what a variant takes, and which part of it takes most.

    python benchmarks/labels.py [--count N]

N variants (64 if not given) of the IEA 15 MW, 100 spans, 401 landmarks, in one thread as a worker
of a family has it.  Processor time of each label by itself, and of the geometry of the same
variants; and for one pass through all labels the share of NeuralFoil's networks, of the fit of
Kulfan's parameters, of momentum theory and of the layup.
"""

import cProfile
import pstats
import time
from pathlib import Path

import numpy as np
from figures import figure, parser

import bladegen as bg
from bladegen.families.labels.figures import LABELS
from bladegen.families.making import sections_of
from bladegen.families.order import Order
from bladegen.support.threads import one_thread

PARTS = {
    "NeuralFoil": ("neuralfoil/main.py", "get_aero_from_kulfan_parameters"),
    "fit of Kulfan's parameters": ("blade/aero/kulfan.py", "kulfan"),
    "momentum theory": ("blade/aero/performance.py", "coefficients"),
    "layup": ("labels/mass.py", "computed"),
}


def main() -> None:
    """Print what labels take."""
    options = parser(__doc__)
    options.add_argument("--count", type=int, default=64)
    asked = options.parse_args()
    count = 4 if asked.quick else asked.count
    blade = bg.Blade.from_definition(bg.read("iea15mw"), landmarks=401)
    planned = bg.family(blade, bg.ShapeSpace.bundled(), count=count, seed=7, reach=0.5)
    nowhere = Path("nowhere")  # nothing is written
    places = np.arange(count)
    with one_thread():
        block = sections_of(Order(planned, nowhere), places)  # compiles
        start = time.thread_time()
        sections_of(Order(planned, nowhere), places)
        spent = {"geometry": time.thread_time() - start}
        for label in LABELS:
            one = Order(planned, nowhere, labels=(label,)).labelling
            one.computed(block)  # compiles, and prepares what all variants share
            start = time.thread_time()
            one.computed(block)
            spent[label] = time.thread_time() - start
        each = {name: 1e3 * took / count for name, took in spent.items()}
        figure("processor time, a variant", f"{count} variants, one thread", "ms", each)
        all_of_them = Order(planned, nowhere, labels=LABELS).labelling
        all_of_them.computed(block)
        with cProfile.Profile() as profile:
            all_of_them.computed(block)
    told = pstats.Stats(profile).stats  # type: ignore[attr-defined]
    took = {
        part: sum(
            row[3] for (file, _, name), row in told.items() if file.endswith(end) and name == of
        )
        for part, (end, of) in PARTS.items()
    }
    total = sum(row[2] for row in told.values())
    shares = {name: 100.0 * value / total for name, value in took.items()}
    figure("share of all labels", f"{count} variants, profiled", "%", shares)


if __name__ == "__main__":
    main()
