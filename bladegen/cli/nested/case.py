"""`bladegen case`: what a flow solver runs, with its mesh and the commands to type."""

import json
from typing import Annotated

import typer

from bladegen.cli.options.common import MAKING, BladeName, Json, Making, Target
from bladegen.cli.options.groups import COMMAND, grouped
from bladegen.cli.options.slips import Answering
from bladegen.cli.terminal import print_figures, progress_bar, remark

__all__ = ["app"]

app = typer.Typer(
    help="Write cases that flow solvers run: the flow around a section, for OpenFOAM.",
    no_args_is_help=True,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.callback()
def begin() -> None:
    """Write cases that flow solvers run: the flow around a section, for OpenFOAM."""


@app.command("openfoam", cls=Answering)
@grouped
def case_openfoam(
    blade: BladeName,
    output: Target,
    section: Annotated[
        float | None,
        typer.Option(metavar="ETA", help="Span fraction of the section, from 0 (root) to 1 (tip)."),
    ] = None,
    speed: Annotated[
        float | None,
        typer.Option(help="Of the air past the section, m/s; that of the rotor if not given."),
    ] = None,
    reynolds: Annotated[
        float | None, typer.Option(help="Of the chord; that of air if not given.")
    ] = None,
    alpha: Annotated[
        str | None,
        typer.Option(
            metavar="ANGLE",
            help="Angle of attack from the chord line, degrees; that of the rotor if not given.",
        ),
    ] = None,
    y_plus: Annotated[float, typer.Option(help="Of the first cells' centres.")] = 2.0,
    cells: Annotated[int, typer.Option(help="Around the section.")] = 512,
    growth: Annotated[float, typer.Option(help="Of cells' heights from layer to layer.")] = 1.15,
    radius: Annotated[float, typer.Option(help="Of the far field, chords.")] = 500.0,
    end: Annotated[int, typer.Option(help="Iterations at most.")] = 1000,
    making: Making = MAKING,
    as_json: Json = False,
) -> None:
    """Write an OpenFOAM case: the steady flow around a section, mesh included.

    Speed and angle are by default those at the rotor's rated speed and best tip speed ratio.
    """
    from bladegen.cli.options.parsing import radians
    from bladegen.errors import BladegenError
    from bladegen.exports.cases.section import section_case

    if section is None:
        raise BladegenError(
            "section: not given; cases of whole blades and rotors are not written yet, that of a "
            "section is: --section 0.7"
        )
    angle = None if alpha is None else radians(alpha, "alpha")
    with progress_bar() as progress:
        progress(f"reading {blade}")
        made = section_case(
            making.blade(blade),
            section,
            speed=speed,
            reynolds=reynolds,
            alpha=angle,
            y_plus=y_plus,
            cells=cells,
            growth=growth,
            radius=radius,
            end=end,
            progress=progress,
        )
        progress(f"writing {output}")
        made.write(output, command=COMMAND.get())
    if as_json:
        typer.echo(json.dumps(made.figures, indent=2))
        return
    if made.flow.told:
        remark(f"{made.flow.told}; give --speed and --alpha for others")
    if made.flow.is_stalled:
        remark("most sections stall at this angle, and a steady run may not settle")
    print_figures(f"{blade} at {100.0 * section:g} % span", made.figures)
    typer.echo(f"wrote {output}: run it with {output}/Allrun, {output}/README.md says how")
