"""`bladegen preview` and `bladegen plot`: blades to look at."""

from collections.abc import Callable
from dataclasses import asdict, replace
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from bladegen.cli.analysis.looking import compare as shown_apart
from bladegen.cli.analysis.looking import sweep_through
from bladegen.cli.options.common import (
    LANDMARKS,
    MAKING,
    BladeName,
    Landmarks,
    Making,
    Mirror,
    ending_in,
)
from bladegen.cli.options.groups import COMMAND, grouped
from bladegen.cli.options.perturbing import NO_CHANGES, Changes
from bladegen.cli.options.rotors import HubRadius, Precone, require_rotor, rotor_given
from bladegen.cli.terminal import progress_bar
from bladegen.errors import BladegenError

__all__ = ["plot", "preview"]


class Colour(StrEnum):
    """What surfaces are coloured by."""

    plain = "plain"
    curvature = "curvature"
    distance = "distance"


class What(StrEnum):
    """Which diagrams are drawn."""

    planform = "planform"
    sections = "sections"
    path = "path"
    curvature = "curvature"
    thickness = "thickness"
    layup = "layup"
    combs = "combs"
    grid = "grid"
    volume = "volume"
    all = "all"


class Kind(StrEnum):
    """Files of diagrams."""

    png = "png"
    svg = "svg"
    pdf = "pdf"


@grouped
def preview(
    blade: Annotated[
        str | None,
        typer.Argument(metavar="[BLADE]", help="A blade's name, its file, or FOLDER/VARIANT."),
    ] = None,
    compare: Annotated[
        tuple[str, str] | None,
        typer.Option(metavar="A B", help="Instead: A, coloured by its distance from B."),
    ] = None,
    screenshot: Annotated[
        Path | None,
        typer.Option(metavar="PNG", help="Write a picture.", callback=ending_in(".png")),
    ] = None,
    html: Annotated[
        Path | None,
        typer.Option(
            metavar="HTML",
            help="Write a page that turns in any browser, offline.",
            callback=ending_in(".html", ".htm"),
        ),
    ] = None,
    gif: Annotated[
        Path | None,
        typer.Option(
            metavar="GIF", help="Write a sweep through shapes.", callback=ending_in(".gif")
        ),
    ] = None,
    mp4: Annotated[
        Path | None,
        typer.Option(
            metavar="MP4",
            help="The same as a film (extra `video`).",
            callback=ending_in(".mp4"),
        ),
    ] = None,
    sweep: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=LOW:HIGH",
            help="What a sweep moves, there and back, such as t2=-0.1:0.05 or twist=-3:3 in deg; "
            "repeated ones move together; half of the data's range of t1 if not given.",
        ),
    ] = None,
    frames: Annotated[int, typer.Option(help="Pictures of a sweep, there and back.")] = 40,
    colour: Annotated[
        Colour | None,
        typer.Option(help="What colours show; distance for a perturbed blade, if not given."),
    ] = None,
    changes: Changes = NO_CHANGES,
    landmarks: Landmarks = LANDMARKS,
    making: Making = MAKING,
    mirror: Mirror = False,
    rotor: Annotated[
        bool, typer.Option("--rotor", help="The whole rotor, blades and spinner, as build has it.")
    ] = False,
    hub_radius: HubRadius = None,
    precone: Precone = None,
) -> None:
    """Look at a blade: in a window, or as a picture, a page, a GIF or a film."""
    if compare is not None:
        if (
            blade is not None
            or gif is not None
            or mp4 is not None
            or changes.asked
            or mirror
            or rotor
        ):
            raise BladegenError(
                "compare: takes two files or blades, --screenshot or --html, and nothing else"
            )
        shown_apart(*compare, screenshot, html, replace(MAKING, airfoils=making.airfoils))
        return
    if blade is None:
        raise BladegenError("preview: name a blade (`bladegen list` shows the bundled ones)")
    shown, baseline = _shown(making.blade(blade, landmarks), changes, mirror)
    if rotor:
        if gif or mp4 or sweep or colour not in (None, Colour.plain):
            raise BladegenError("rotor: is shown plain, by --screenshot, --html or in a window")
        _show_rotor(shown, rotor_given(shown, hub_radius, precone), screenshot, html)
        return
    require_rotor(rotor, hub_radius, precone)
    colouring = colour or (Colour.plain if baseline is None else Colour.distance)
    if gif is not None or mp4 is not None:
        sweep_through(shown, changes.shape_space(), sweep or [], frames, gif, mp4)
    elif sweep is not None:
        raise BladegenError("sweep: needs --gif or --mp4")
    _show(shown, baseline, colouring.value, screenshot, html, window=gif is None and mp4 is None)


def _shown(blade: Any, changes: Changes, mirror: bool) -> tuple[Any, Any]:
    """Return what is shown, and the baseline of what is changed; both mirrored if asked for."""
    shown, baseline = (changes.applied(blade), blade) if changes.asked else (blade, None)
    if mirror:
        baseline = None if baseline is None else baseline.mirror_image()
        return shown.mirror_image(), baseline
    return shown, baseline


def _show(
    blade: Any,
    baseline: Any,
    colour: str,
    screenshot: Path | None,
    html: Path | None,
    *,
    window: bool,
) -> None:
    """Write the picture and the page that are asked for, or open a window if nothing is."""
    from bladegen.views import page
    from bladegen.views import preview as view
    from bladegen.views.rendering.blade_scene import scene_of

    def draw(path: Path) -> None:
        view.picture(blade, path, baseline=baseline, colour=colour)

    scene = partial(scene_of, blade, baseline)

    _write(_made(blade), draw, partial(scene, landmarks=page.LANDMARKS), colour, screenshot, html)
    if window and screenshot is None and html is None:
        view.require_window()
        view.show(scene(), colour=colour)


def _show_rotor(blade: Any, rotor: Any, screenshot: Path | None, html: Path | None) -> None:
    """Write or open the picture of a rotor."""
    from bladegen.views import preview as view
    from bladegen.views.rendering.rotor_scene import rotor_picture, rotor_scene

    settings = {f"rotor_{key}": f"{value}" for key, value in asdict(rotor).items()}
    found = rotor_scene(blade, rotor)

    def draw(path: Path) -> None:
        rotor_picture(found, path)

    _write(_made(blade, **settings), draw, lambda: found, "plain", screenshot, html)
    if screenshot is None and html is None:
        view.require_window()
        view.show(found, colour="plain")


def _write(
    made: Any,
    draw: Callable[[Path], None],
    scene: Callable[[], Any],
    colour: str,
    screenshot: Path | None,
    html: Path | None,
) -> None:
    """Write the picture and the page that are asked for."""
    from bladegen.exports.marks import marked
    from bladegen.views.page import write_page

    if screenshot is not None:
        with progress_bar() as progress, marked(screenshot, made) as temporary:
            progress("rendering")
            draw(temporary)
        typer.echo(f"wrote {screenshot}")
    if html is not None:
        with progress_bar() as progress, marked(html, made) as temporary:
            progress("making the page")
            write_page(scene(), temporary, colour=colour)
        typer.echo(f"wrote {html}")


def _made(what: Any, **settings: str) -> Any:
    """Return what a file is made from by this command."""
    from bladegen.exports.provenance import made_from

    return made_from(what, settings, COMMAND.get())


@grouped
def plot(
    blade: BladeName,
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="FILE|DIR", help="A file, or a folder.")
    ] = Path(),
    what: Annotated[
        list[What] | None, typer.Option(help="Which diagrams; may be repeated; all if not given.")
    ] = None,
    kind: Annotated[
        Kind | None,
        typer.Option(
            "--format", help="Of the files in a folder, png if not given; a file's suffix says its."
        ),
    ] = None,
    changes: Changes = NO_CHANGES,
    landmarks: Landmarks = LANDMARKS,
    making: Making = MAKING,
    mirror: Mirror = False,
) -> None:
    """Draw diagrams of a blade.

    Planform, sections, path on the Grassmannian, curvature, thickness, layers and webs, and its
    airfoils' combs. A perturbed blade is drawn over its baseline.
    """
    from bladegen.exports.marks import marked
    from bladegen.support.files import folder, require_suffix, safe_stem
    from bladegen.views.plots.blade_plots import PLOTS, drawable
    from bladegen.views.plots.figures import SUFFIXES, save_figure, save_pages

    wanted = list(dict.fromkeys(what or [What.all]))
    shown, baseline = _shown(making.blade(blade, landmarks), changes, mirror)
    chosen = drawable(shown) if What.all in wanted else [one.value for one in wanted]
    single = output.suffix.lower() in SUFFIXES or (bool(output.suffix) and not output.is_dir())
    if single:
        require_suffix(output, SUFFIXES if kind is None else (f".{kind}",), "--output")
    if single and len(chosen) > 1 and output.suffix.lower() != ".pdf":
        raise BladegenError(
            f"output: got {output} for {len(chosen)} diagrams, must be a folder or a .pdf; or "
            "choose one with --what"
        )
    with progress_bar() as progress:
        if single and output.suffix.lower() == ".pdf":
            progress("drawing")
            by = _made(shown, diagrams=" ".join(chosen))
            with marked(output, by) as temporary:
                drawn = (PLOTS[name].draw(shown, baseline) for name in chosen)
                save_pages(drawn, temporary, by.text)
            files = [output]
        else:
            stem = safe_stem(shown.name)
            files = [
                output if single else folder(output) / f"{stem}-{name}.{kind or Kind.png}"
                for name in chosen
            ]
            for name, file in zip(chosen, files, strict=True):
                progress(f"drawing {name}")
                by = _made(shown, diagrams=name)
                with marked(file, by) as temporary:
                    save_figure(PLOTS[name].draw(shown, baseline), temporary, by.text)
    for file in files:
        typer.echo(f"wrote {file}")
