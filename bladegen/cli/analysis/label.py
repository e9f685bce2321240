"""`bladegen label`: labels of a family that is there already."""

from typing import Annotated

import typer

from bladegen.cli.family import SHOWN, cluster, figure_range
from bladegen.cli.options.common import MAKING, Making, Mirror
from bladegen.cli.options.groups import grouped
from bladegen.cli.terminal import print_table, variants_bar
from bladegen.support.stopping import Stopped

__all__ = ["label"]


@grouped
def label(
    family: Annotated[
        str, typer.Argument(metavar="FOLDER", help="A family that `bladegen family` made.")
    ],
    labels: Annotated[
        list[str],
        typer.Argument(
            metavar="LABELS",
            help="polars of sections, rotor: what a rotor does (both by NeuralFoil, the extra "
            "aero), mass of the layers; several, or with commas.",
        ),
    ],
    blade: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="The baseline, where it is no bundled blade."),
    ] = None,
    space: Annotated[
        str | None,
        typer.Option(
            metavar="FILE", help="The space of its modes, where its landmarks are not the blade's."
        ),
    ] = None,
    making: Making = MAKING,
    mirror: Mirror = False,
    jobs: Annotated[int, typer.Option(help="Threads at work.")] = 1,
    dask: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="A Dask scheduler instead of --jobs.")
    ] = None,
) -> None:
    """Add labels to a family: polars, what rotors do, mass of each sound variant.

    The same command goes on after it was stopped. A baseline from a file needs the options that the
    family was made with.
    """
    from bladegen.families.additions.later_labels import add_labels
    from bladegen.families.dataset.loading import load_family
    from bladegen.families.labels.figures import FIGURES
    from bladegen.shapes.shape_space import ShapeSpace

    words = [word.strip().lower() for text in labels for word in text.split(",")]
    loaded, baseline = load_family(family), None
    if blade is not None:
        made = making.blade(blade, loaded.identity["landmarks"])
        baseline = made.mirror_image() if mirror else made
    modes = None if space is None else ShapeSpace.load(space)
    loaded = load_family(family, blade=baseline, space=modes)
    try:
        with cluster(dask) as client, variants_bar(len(loaded)) as progress:
            computed = add_labels(loaded, words, jobs=jobs, client=client, progress=progress)
    except Stopped as stop:
        raise stop.saying(f"{family}: the same command goes on; ") from None
    loaded = load_family(family)
    own = {one.name for word in words for one in FIGURES[word]}
    rows = [
        ["variants", f"{len(loaded)}, {computed} of them labelled now"],
        ["labels", ", ".join(loaded.identity["labels"])],
        *([said, figure_range(loaded[name][:])] for name, said in SHOWN.items() if name in own),
    ]
    print_table(["figure", "value"], rows, title=f"labels of {loaded.identity['blade']}")
