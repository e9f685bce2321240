"""The command line: which commands there are, and how one is run.

Each command is a function in a module of its own, imported when it is asked for: a new one is a
module, a line in SUMMARIES and two in `function_of`.
"""

import logging
import sys
from collections.abc import Callable
from functools import cache
from typing import Annotated, Any

import typer
import typer.core
import typer.main

from bladegen.cli.options.slips import Answering
from bladegen.cli.output import CLOSED_PIPE, OutputError, guarded
from bladegen.errors import BladegenError, MissingLibraryError
from bladegen.support.stopping import Stopped, stopped_by_signals
from bladegen.version import __version__
from bladegen.views.rendering.keys import help_text

__all__ = ["SUMMARIES", "app", "command_of", "function_of", "main"]

SUMMARIES = {
    "list": "List the bundled blades.",
    "info": "Show what a blade's definition holds.",
    "build": "Build a blade: a STEP solid, meshes, grids, a picture and a report.",
    "perturb": "Perturb a blade consistently and build it.",
    "family": "Make a family of perturbed blades: sections, a manifest, files and a contact sheet.",
    "label": "Add labels to a family: polars, what rotors do, mass of each sound variant.",
    "check": "Measure a solid, mesh, grid or blade definition, or the distance between two.",
    "evaluate": "Evaluate a blade: power, thrust, root moment, annual energy and mass.",
    "fit": "Fit a definition to a surface: axis, chord, twist, offsets, airfoils at few stations.",
    "convert": "Convert a blade between file formats, and say what the new one cannot hold.",
    "formats": "List the formats that are read and written, those of plug-ins too.",
    "preview": "Look at a blade: in a window, or as a picture, a page, a GIF or a film.",
    "plot": "Draw diagrams of a blade.",
    "studio": "See a blade in the browser and play with it: sliders, checks, exports.",
    "space": "Make and look at shape spaces.",
    "case": "Write cases that OpenFOAM runs: a rotor, or the flow around a section.",
}
CONTEXT = {"help_option_names": ["-h", "--help"]}


class Commands(typer.core.TyperGroup):
    """The commands by name, each imported when it is asked for; `--help` lists their summaries."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings | {"commands": dict.fromkeys(SUMMARIES)})

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return a command, or None if there is none of this name."""
        if cmd_name == "help":
            ctx.fail(
                "No such command 'help'; bladegen -h lists commands, bladegen build -h options."
            )
        return command_of(cmd_name) if cmd_name in SUMMARIES else None

    def format_commands(self, ctx: Any, formatter: Any) -> None:  # noqa: ARG002
        """Write the summaries, without importing a command."""
        with formatter.section("Commands"):
            formatter.write_dl(list(SUMMARIES.items()))


def function_of(name: str) -> Any:  # noqa: PLR0912
    """Return the function that a command runs, or the Typer of a group of commands."""
    run: Callable[..., None]
    match name:
        case "list":
            from bladegen.cli.blades import list_blades as run
        case "info":
            from bladegen.cli.blades import info as run
        case "build":
            from bladegen.cli.build import build as run
        case "perturb":
            from bladegen.cli.build import perturb as run
        case "family":
            from bladegen.cli.family import family as run
        case "label":
            from bladegen.cli.analysis.label import label as run
        case "check":
            from bladegen.cli.check import check as run
        case "evaluate":
            from bladegen.cli.analysis.evaluate import evaluate as run
        case "fit":
            from bladegen.cli.fit import fit as run
        case "convert":
            from bladegen.cli.convert import convert as run
        case "formats":
            from bladegen.cli.formats import formats as run
        case "preview":
            from bladegen.cli.view import preview as run
        case "plot":
            from bladegen.cli.view import plot as run
        case "studio":
            from bladegen.cli.studio import studio as run
        case "case":
            from bladegen.cli.nested.case import app as cases

            return cases
        case _:
            from bladegen.cli.nested.space import app as space

            return space
    return run


@cache
def command_of(name: str) -> Any:
    """Return the command of a name."""
    run = function_of(name)
    if isinstance(run, typer.Typer):
        return typer.main.get_command(run)
    alone = typer.Typer(add_completion=False, context_settings=CONTEXT)
    keys = help_text() if name == "preview" else None
    alone.command(name, cls=Answering, epilog=keys)(run)
    return typer.main.get_command(alone)


app = typer.Typer(
    name="bladegen",
    cls=Commands,
    help="Wind turbine blades from spanwise tables to STEP solids, meshes and pictures.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings=CONTEXT,
)


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
        sys.stderr.write(f"bladegen: {MissingLibraryError(error)}\n")
        sys.exit(1)
    except KeyboardInterrupt:
        sys.stderr.write("bladegen: interrupted\n")
        sys.exit(130)


@app.callback(invoke_without_command=True)
def begin(
    ctx: typer.Context,
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
        from bladegen.cli.terminal import log_to_terminal

        log_to_terminal(logging.INFO if verbose == 1 else logging.DEBUG)
    if show:
        typer.echo(f"bladegen {__version__}")
        raise typer.Exit
    if ctx.invoked_subcommand is None:
        typer.echo(ctx.get_help())
