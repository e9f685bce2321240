"""What `bladegen preview` writes or opens of two that are compared, and of sweeps."""

from functools import partial
from pathlib import Path
from typing import Any

import typer

from bladegen.cli.check import blade_of
from bladegen.cli.options.common import Making
from bladegen.cli.options.groups import COMMAND
from bladegen.cli.terminal import progress_bar, variants_bar

__all__ = ["compare", "sweep_through"]


def compare(
    one: str, other: str, screenshot: Path | None, html: Path | None, plain: Making
) -> None:
    """Show a surface coloured by its distance from another one."""
    from bladegen.exports.marks import marked
    from bladegen.exports.provenance import compared_of
    from bladegen.views import comparison
    from bladegen.views import preview as view
    from bladegen.views.page import write_page

    title = f"{one} against {other}"
    with progress_bar() as progress:
        progress("reading")
        things = [blade_of(name, plain) or Path(name) for name in (one, other)]
        surfaces = [comparison.surface_of(thing) for thing in things]
        made = compared_of(things[0], things[1], command=COMMAND.get())
        progress("measuring distances")
        found = comparison.compared(*surfaces)
        progress("drawing")
        if screenshot is not None:
            with marked(screenshot, made) as temporary:
                comparison.draw(found, title, temporary)
        if html is not None:
            with marked(html, made) as temporary:
                write_page(comparison.scene(found, title), temporary, colour="distance")
    for note in found.notes:
        typer.echo(f"note: {note}")
    for path in (screenshot, html):
        if path is not None:
            typer.echo(f"wrote {path}")
    if screenshot is None and html is None:
        view.require_window()
        view.show(comparison.scene(found, title), colour="distance")


def sweep_through(
    blade: Any, space: Any, texts: list[str], count: int, gif: Path | None, mp4: Path | None
) -> None:
    """Render a sweep once and write it as asked."""
    from bladegen.cli.options.parsing import factor_bounds
    from bladegen.exports.marks import marked
    from bladegen.exports.provenance import made_from
    from bladegen.views import sweep
    from bladegen.views.tables import megabytes

    motion = sweep.Motion(blade, space, factor_bounds(texts, "sweep"), count)
    if mp4 is not None:
        sweep.require_encoder(mp4)
    with variants_bar(count, "frames") as progress:
        images = list(sweep.frames(motion, progress=progress))
    settings = {"sweep": " ".join(texts), "frames": str(count)}
    made = made_from(blade, settings, COMMAND.get())
    film = partial(sweep.write_mp4, about=made.text)
    for path, write in ((gif, sweep.write_gif), (mp4, film)):
        if path is not None:
            with marked(path, made) as temporary:
                write(images, temporary)
            typer.echo(f"wrote {path}: {count} frames, {megabytes(path.stat().st_size)}")
