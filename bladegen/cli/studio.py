"""`bladegen studio`: look at a blade in the browser and play with it."""

from typing import Annotated

import typer

from bladegen.cli.options.common import Airfoils

__all__ = ["studio"]


def studio(
    blade: Annotated[
        str,
        typer.Argument(
            metavar="[BLADE]",
            help="A bundled blade's name, a definition's file, or a variant, FOLDER/NUMBER.",
        ),
    ] = "iea15mw",
    airfoils: Airfoils = None,
    port: Annotated[
        int | None, typer.Option(min=0, max=65535, help="Where to listen; 0 takes a free port.")
    ] = None,
    host: Annotated[
        str, typer.Option(help="Listen at another address than loopback, behind a token.")
    ] = "127.0.0.1",
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the page in the browser.")
    ] = True,
) -> None:
    """See a blade in the browser and play with it: sliders, checks, exports."""
    from contextlib import ExitStack
    from pathlib import Path
    from tempfile import TemporaryDirectory

    from bladegen.cli.options.variants import variant
    from bladegen.cli.terminal import progress_bar
    from bladegen.formats.writing import write
    from bladegen.studio.server import Serving, serve

    with TemporaryDirectory(prefix="bladegen-variant-") as room, ExitStack() as waiting:

        def told(serving: Serving) -> None:
            waiting.close()
            typer.echo(f"bladegen studio: {serving.address} (Ctrl C ends it)")
            if browser:
                import webbrowser

                webbrowser.open(serving.address)

        waiting.enter_context(progress_bar())("preparing the blade")
        made = variant(blade, None, plain=airfoils is None)
        if made is not None:  # the studio begins with a file
            blade = str(Path(room) / f"{made.name}.yaml")
            write(made, blade, polars="keep")
        serve(blade, host, port, told, airfoils=airfoils)
