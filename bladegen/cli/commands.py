"""The command line: parse, call, print.  Nothing is computed here."""

import json
import logging
import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from bladegen import __version__
from bladegen.cli import space
from bladegen.cli.check import check
from bladegen.cli.convert import convert
from bladegen.cli.family import family
from bladegen.cli.formats import formats
from bladegen.cli.groups import grouped
from bladegen.cli.options import (
    LANDMARKS,
    MAKING,
    PRODUCING,
    Airfoils,
    BladeName,
    Formats,
    Json,
    Landmarks,
    Making,
    Producing,
    Target,
    suffixes_of,
)
from bladegen.cli.output import CLOSED_PIPE, OutputError, guarded
from bladegen.cli.perturb import NO_CHANGES, Changes
from bladegen.cli.studio import studio
from bladegen.cli.terminal import (
    log_to_terminal,
    print_figures,
    print_findings,
    print_summary,
    print_table,
    progress_bar,
)
from bladegen.cli.view import KEYS, plot, preview
from bladegen.errors import BladegenError
from bladegen.support.stopping import Stopped, stopped_by_signals

__all__ = ["app", "main"]

app = typer.Typer(
    name="bladegen",
    help="Wind turbine blades from spanwise tables to STEP solids, meshes and pictures.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


app.add_typer(space.app, name="space")
app.command()(check)
app.command()(convert)
app.command()(family)
app.command()(formats)
app.command(epilog=KEYS)(preview)
app.command()(plot)
app.command()(studio)


def main() -> None:
    """Run the command line; a `BladegenError` is one line on stderr and exit code 1.

    So is a signal that ends the command, with 128 and the signal's number as exit code.
    """
    try:
        with stopped_by_signals(), guarded():
            app()
    except BladegenError as error:
        if isinstance(error, OutputError) and error.closed_pipe:
            sys.exit(CLOSED_PIPE)
        sys.stderr.write(f"bladegen: {' '.join(str(error).split())}\n")
        sys.exit(1)
    except Stopped as stop:
        sys.stderr.write(f"bladegen: {stop}\n")
        sys.exit(stop.status)
    except ImportError as error:  # libraries are imported where they are needed
        sys.stderr.write(f"bladegen: {_missing(error)}\n")
        sys.exit(1)
    except KeyboardInterrupt:
        sys.stderr.write("bladegen: interrupted\n")
        sys.exit(130)


def _missing(error: ImportError) -> str:
    """Say in a line which library a command needs and does not find, or cannot load."""
    library = (error.name or "a library").partition(".")[0]
    package = {"OCP": "cadquery-ocp", "vtkmodules": "vtk", "PIL": "pillow"}.get(library, library)
    return (
        f"this command needs {library}, which cannot be imported ({' '.join(str(error).split())}); "
        f"pip install {package}, and the system libraries that the README names"
    )


@app.callback(invoke_without_command=True)
def begin(
    show: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
    verbose: Annotated[
        int,
        typer.Option(
            "-v",
            "--verbose",
            count=True,
            help="Say what is done (before a command); -vv: all.",
        ),
    ] = 0,
) -> None:
    """Wind turbine blades from spanwise tables to STEP solids, meshes and pictures."""
    if verbose:
        log_to_terminal(logging.INFO if verbose == 1 else logging.DEBUG)
    if show:
        typer.echo(f"bladegen {__version__}")
        raise typer.Exit


@app.command("list")
def list_blades() -> None:
    """List the bundled blades."""
    from bladegen.formats.reading import bundled, read

    rows = []
    for name in bundled():
        definition = read(name)
        rows.append(
            [
                name,
                definition.description,
                f"{definition.length:.1f} m",
                str(len({station.airfoil.name for station in definition.stations})),
            ]
        )
    print_table(["name", "blade", "length", "airfoils"], rows)


@app.command()
def info(blade: BladeName, airfoils: Airfoils = None, as_json: Json = False) -> None:
    """Show what a blade's definition holds."""
    from bladegen.formats.reading import read
    from bladegen.views.tables import definition_figures, station_rows

    definition = read(blade, airfoils=airfoils)
    figures = definition_figures(definition)
    if as_json:
        typer.echo(json.dumps(figures, indent=2))
        return
    print_figures(figures["blade"], {k: v for k, v in figures.items() if not isinstance(v, list)})
    print_table(
        ["eta", "z m", "airfoil", "chord m", "twist deg", "thickness"],
        station_rows(definition),
        title="stations",
    )
    print_findings(figures["findings"])


Mirror = Annotated[
    bool,
    typer.Option(
        "--mirror",
        help="The mirror image in all files: its rotor turns anticlockwise seen from upwind.",
    ),
]


@app.command()
@grouped
def build(
    blade: BladeName,
    output: Target,
    formats: Formats = None,
    landmarks: Landmarks = LANDMARKS,
    making: Making = MAKING,
    producing: Producing = PRODUCING,
    rotor: Annotated[
        bool, typer.Option("--rotor", help="The whole rotor too, as STEP assembly and GLB.")
    ] = False,
    mirror: Mirror = False,
    hub_radius: Annotated[
        str | None,
        typer.Option(metavar="LENGTH", help="Of the rotor, instead of the definition's; 2m."),
    ] = None,
    precone: Annotated[
        str | None,
        typer.Option(
            metavar="ANGLE",
            help="Of the rotor in degrees, tips upwind, instead of the definition's.",
        ),
    ] = None,
) -> None:
    """Build a blade: a STEP solid, meshes, grids, a picture and a report."""
    options, suffixes = producing.options(), suffixes_of(formats)
    made = making.blade(blade, landmarks)
    made = made.mirror_image() if mirror else made
    whole = None
    if not rotor and (hub_radius or precone):
        raise BladegenError("hub-radius, precone: are of the rotor; add --rotor, or leave them out")
    if rotor:
        from bladegen.cad.rotor import rotor_of
        from bladegen.cli.texts import metres, radians

        whole = rotor_of(
            made,
            hub_radius=None if hub_radius is None else metres(hub_radius, "hub-radius"),
            cone=None if precone is None else radians(precone, "precone"),
        )
    _build(made, output, suffixes, options, whole)


@app.command()
@grouped
def perturb(
    blade: BladeName,
    output: Target,
    changes: Changes = NO_CHANGES,
    formats: Formats = None,
    landmarks: Landmarks = LANDMARKS,
    making: Making = MAKING,
    producing: Producing = PRODUCING,
    mirror: Mirror = False,
) -> None:
    """Perturb a blade consistently and build it."""
    if not changes.asked:
        raise BladegenError(
            f"perturb: nothing is to change; give --pga, --thickness, --twist or another change, "
            f"or make the blade as it is: bladegen build {blade} -o {output}"
        )
    options, suffixes = producing.options(), suffixes_of(formats)
    made = changes.applied(making.blade(blade, landmarks))
    _build(made.mirror_image() if mirror else made, output, suffixes, options)


def _build(
    blade: Any, output: Path, formats: tuple[str, ...], options: Any, rotor: Any = None
) -> None:
    """Build a blade's files and print what was made, a missed tolerance included."""
    from bladegen.errors import PromiseError
    from bladegen.exports.build import DEFAULT_FORMATS
    from bladegen.exports.build import build as build_files

    miss = None
    with progress_bar() as progress:
        try:
            build_files(
                blade,
                output,
                formats=formats or DEFAULT_FORMATS,
                options=options,
                rotor=rotor,
                progress=progress,
            )
        except PromiseError as error:
            miss = error
    print_summary(output, blade.name)
    if miss is not None:
        raise miss
