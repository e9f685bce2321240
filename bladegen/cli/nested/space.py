"""`bladegen space`: make and look at shape spaces."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from bladegen.cli.options.common import ending_in
from bladegen.cli.options.slips import Answering
from bladegen.cli.terminal import print_findings, print_space, print_table, progress_bar

__all__ = ["app"]

OPEN = 0.01  # of the chord: edges of perturbed airfoils that are all sound

app = typer.Typer(
    help="Make and look at shape spaces.",
    no_args_is_help=True,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]


@app.command("build", cls=Answering)
def build_space(
    output: Annotated[
        Path,
        typer.Option("-o", "--output", help="The npz file to write.", callback=ending_in(".npz")),
    ],
    seed: Annotated[int, typer.Option(help="Of the perturbations.")] = 2022,
    airfoils: Annotated[
        Path | None,
        typer.Option(help="A folder of airfoil files; the paper's 16 baselines if not given."),
    ] = None,
    count: Annotated[
        int, typer.Option(min=0, help="CST perturbations of each airfoil; 0: the airfoils alone.")
    ] = 1000,
    modes: Annotated[int, typer.Option(help="Modes to keep.")] = 4,
    landmarks: Annotated[int, typer.Option(help="Landmarks a section, odd.")] = 401,
    sound: Annotated[
        bool,
        typer.Option(
            "--sound",
            help="Perturbed airfoils with edges open by 1 % of the chord and evenly spaced "
            "landmarks, without those that cross themselves.",
        ),
    ] = False,
    skip_unusable: Annotated[
        bool, typer.Option("--skip-unusable", help="Leave out files that hold no airfoil.")
    ] = False,
) -> None:
    """Learn a shape space from airfoils."""
    from bladegen.airfoils.landmarks import uniform
    from bladegen.errors import FileError
    from bladegen.formats.airfoils.reading import airfoil_folder
    from bladegen.formats.baselines import baselines
    from bladegen.shapes.database import build_space as learn

    if airfoils is None:
        found = baselines()
    else:
        held = airfoil_folder(airfoils)
        found, unusable = held.airfoils, held.unusable
        print_findings([str(one) for one in held.said])
        for file, reason in unusable.items():
            typer.echo(f"unusable: {file}: {reason}", err=True)
        if unusable and not skip_unusable:
            raise FileError(
                str(airfoils), [f"{len(unusable)} unusable files; --skip-unusable leaves them out"]
            )
        if not found:
            raise FileError(str(airfoils), ["holds no airfoil files"])
    with progress_bar() as progress:
        progress(f"learning from {len(found)} airfoils")
        how: dict[str, Any] = {"edge": OPEN, "spacing": uniform, "sound": True} if sound else {}
        space, residuals = learn(found, seed=seed, count=count, modes=modes, n=landmarks, **how)
    space.save(output)
    if residuals:
        rows = [[name, f"{residual:.1e}"] for name, residual in residuals.items()]
        print_table(["airfoil", "RMS of its CST fit, chord"], rows)
    print_space(space)
    typer.echo(f"wrote {output}")


SpaceFile = Annotated[
    Path | None,
    typer.Argument(metavar="[SPACE]", help="An npz file, or 'sound'; the paper's if none."),
]


@app.command("info", cls=Answering)
def info_of_space(space: SpaceFile = None, as_json: Json = False) -> None:
    """Show a shape space: modes, variances, bounds."""
    from bladegen.shapes.shape_space import ShapeSpace
    from bladegen.views.tables import space_figures

    loaded = ShapeSpace.load(space) if space else ShapeSpace.bundled()
    if as_json:
        typer.echo(json.dumps(space_figures(loaded), indent=2))
    else:
        print_space(loaded)


@app.command("plot", cls=Answering)
def plot_space(
    output: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            help="The picture, PNG, SVG or PDF.",
            callback=ending_in(".png", ".svg", ".pdf"),
        ),
    ],
    space: SpaceFile = None,
) -> None:
    """Draw a shape space: its modes, its spectrum and its data."""
    from bladegen.shapes.shape_space import ShapeSpace
    from bladegen.support.files import replacing
    from bladegen.views.plots.figures import draw_space

    loaded = ShapeSpace.load(space) if space else ShapeSpace.bundled()
    with replacing(output) as temporary:
        draw_space(loaded, temporary)
    typer.echo(f"wrote {output}")
