"""The command `bladegen check`: measure one thing, or the distance between two."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from bladegen.cli.options.common import MAKING, Json, Making, ending_in
from bladegen.cli.options.groups import COMMAND, grouped
from bladegen.cli.options.targets import each_ending_in
from bladegen.cli.terminal import print_figures, print_findings, print_table, progress_bar
from bladegen.errors import BladegenError

__all__ = ["blade_of", "check"]


@grouped
def check(
    file: Annotated[
        str, typer.Argument(metavar="FILE", help="A CAD, mesh or grid file, or a blade definition.")
    ],
    other: Annotated[
        str | None,
        typer.Argument(metavar="[OTHER]", help="Another one: the distance between the two."),
    ] = None,
    screenshot: Annotated[
        Path | None,
        typer.Option(
            help="With OTHER: a PNG of FILE coloured by distance.", callback=ending_in(".png")
        ),
    ] = None,
    zebra: Annotated[
        Path | None,
        typer.Option(
            help="A PNG of zebra stripes on FILE, a CAD file or a blade, from its exact normals.",
            callback=ending_in(".png"),
        ),
    ] = None,
    deviation: Annotated[
        list[Path] | None,
        typer.Option(
            help="With a definition as OTHER: FILE's distance from it over span and arc as a .csv, "
            ".png or .vtp file; repeated for several.",
            callback=each_ending_in(".csv", ".png", ".vtp"),
        ),
    ] = None,
    as_json: Json = False,
    making: Making = MAKING,
) -> None:
    """Measure a solid, mesh, grid or blade definition, or the distance between two.

    Exit with 1 if a single one is not sound.
    """
    if other is not None:
        if zebra is not None:
            raise BladegenError("zebra: stripes are drawn on one file; leave the other one out")
        if replace(making, airfoils=None) != MAKING:
            raise BladegenError(
                f"{other}: of two, a definition is made as the other one was; build it as it shall "
                "be, and check its file"
            )
        _compare(file, other, screenshot, making, as_json, tuple(deviation or ()))
        return
    if screenshot is not None:
        raise BladegenError("screenshot: a picture is made of two files; name another one")
    if deviation:
        raise BladegenError("deviation: is from a definition; name one as OTHER")
    from bladegen.exports.inventory import made_by
    from bladegen.measures import checks

    blade = blade_of(file, making)
    if blade is None and replace(making, airfoils=None) != MAKING:
        raise BladegenError(f"{file}: is no definition; how a blade is made matters to these alone")
    result = checks.check_file(Path(file)) if blade is None else checks.check_blade(blade)
    if zebra is not None:
        _stripes(Path(file) if blade is None else blade, zebra)
    made = made_by(Path(file if blade is None else blade.definition.source))
    if as_json:
        typer.echo(
            json.dumps(
                {
                    "source": result.source,
                    "kind": result.kind,
                    **result.figures,
                    "problems": list(result.problems),
                    "made_from": None if made is None else made.text,
                },
                indent=2,
            )
        )
    else:
        figures = {k: v for k, v in result.figures.items() if k != "findings"}
        print_figures(f"{result.source} ({result.kind})", figures)
        print_findings(result.figures.get("findings", []))
        if made is not None:
            typer.echo(f"made from: {made.text}")
        if zebra is not None:
            typer.echo(f"wrote {zebra}")
    if result.problems:
        raise BladegenError(f"{result.source}: {'; '.join(result.problems)}")


def blade_of(file: str, making: Making = MAKING) -> Any:
    """Return the blade that a name or a definition means, None for other files."""
    from bladegen.formats.bundled import bundled
    from bladegen.formats.reading import is_read
    from bladegen.measures.foreign import GRIDS, MESHES, SOLIDS

    suffix = Path(file).suffix.lower()
    measured = suffix in SOLIDS + MESHES + GRIDS
    if file in bundled() or not suffix or (not measured and is_read(Path(file))):
        return making.blade(file)
    return None


def _stripes(thing: Any, target: Path) -> None:
    """Draw zebra stripes on a blade or on what a file holds."""
    from bladegen.exports.marks import marked
    from bladegen.exports.provenance import drawn_of
    from bladegen.views.zebra import draw, sheets_of

    with progress_bar() as progress:
        progress("rendering")
        with marked(target, drawn_of(thing, command=COMMAND.get())) as temporary:
            draw(sheets_of(thing), thing.name, temporary)


def _compare(
    file: str,
    other: str,
    screenshot: Path | None,
    making: Making,
    as_json: bool,
    deviation: tuple[Path, ...],
) -> None:
    """Measure two surfaces against each other and print, or draw, what was found."""
    from bladegen.cli.options.provenance import alike
    from bladegen.exports.marks import marked
    from bladegen.exports.provenance import compared_of
    from bladegen.views.comparison import compared, draw, surface_of

    with progress_bar() as progress:
        progress("reading")
        things = [blade_of(name, making) or Path(name) for name in (file, other)]
        things, tips, differing = alike(things)
        one, two = (surface_of(*pair) for pair in zip(things, tips, strict=True))
        progress("measuring distances")
        found = compared(one, two)
        figures = found.figures
        if deviation:
            progress("mapping deviations")
            figures |= _deviate(found.one, things[1], deviation)
        if screenshot is not None:
            progress("rendering")
            with marked(
                screenshot, compared_of(things[0], things[1], command=COMMAND.get())
            ) as temporary:
                draw(found, f"{file} against {other}", temporary)
    if as_json:
        said = {"source": file, "other": other, "note": "; ".join(found.notes), "made": differing}
        typer.echo(json.dumps({**said, **figures, "bands": found.bands()}, indent=2))
        return
    for note in (*found.notes, *differing):  # first: all that follows rests on it
        typer.echo(f"note: {note}")
    for thing in things:
        if not isinstance(thing, Path):
            print_findings([str(finding) for finding in thing.findings])
    print_figures(f"{file} against {other}", figures)
    rows = [
        [
            f"{band['from_z_m']:.2f} to {band['to_z_m']:.2f}",
            *(f"{band[key]:.3f}" for key in ("maximum_mm", "rms_mm", "mean_mm")),
        ]
        for band in found.bands()
    ]
    print_table(["z, m", "largest, mm", "RMS, mm", "mean (outside +), mm"], rows)
    for path in (*deviation, *([screenshot] if screenshot is not None else [])):
        typer.echo(f"wrote {path}")


def _deviate(surface: Any, blade: Any, paths: tuple[Path, ...]) -> dict[str, float]:
    """Write the map of a surface's deviation from a blade, and return its figures."""
    from bladegen.exports.marks import marked
    from bladegen.exports.provenance import drawn_of
    from bladegen.fitting.deviations import DeviationMap
    from bladegen.views.deviations import figures_of, write

    if isinstance(blade, Path):
        raise BladegenError(f"deviation: {blade} is no definition; name one as OTHER")
    deviation = DeviationMap.measured(blade, surface)
    for path in paths:
        with marked(path, drawn_of(blade, command=COMMAND.get())) as temporary:
            write(deviation, blade, temporary)
    return figures_of(deviation, blade)
