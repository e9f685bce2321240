"""The command line: parse, call, print.  Nothing is computed here."""

import json
import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from bladegen import __version__, cli_space
from bladegen.cli_check import check
from bladegen.cli_family import family
from bladegen.cli_options import (
    FAIRING,
    BladeName,
    EdgeOption,
    FairingOption,
    Formats,
    GridAlong,
    GridAround,
    GridEdge,
    Json,
    Landmarks,
    LightOption,
    PathKind,
    PathOption,
    Planes,
    PlanesOption,
    SchemaOption,
    SideSpacing,
    SpanSpacing,
    Stations,
    StepSchema,
    TipKind,
    TipOption,
    Tolerance,
    Unit,
    UnitOption,
    build_options,
    read_blade,
)
from bladegen.errors import BladegenError
from bladegen.terminal import (
    print_figures,
    print_findings,
    print_summary,
    print_table,
    progress_bar,
)

__all__ = ["app", "main"]

app = typer.Typer(
    name="bladegen",
    help="Wind turbine blades from spanwise tables to STEP solids, meshes and pictures.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


app.add_typer(cli_space.app, name="space")
app.command()(check)
app.command()(family)


def main() -> None:
    """Run the command line; a `BladegenError` is one line on stderr and exit code 1."""
    try:
        app()
    except BladegenError as error:
        sys.stderr.write(f"bladegen: {' '.join(str(error).split())}\n")
        sys.exit(1)
    except KeyboardInterrupt:
        sys.stderr.write("bladegen: interrupted\n")
        sys.exit(130)


@app.callback(invoke_without_command=True)
def version(
    show: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    """Wind turbine blades from spanwise tables to STEP solids, meshes and pictures."""
    if show:
        typer.echo(f"bladegen {__version__}")
        raise typer.Exit


@app.command("list")
def list_blades() -> None:
    """List the bundled blades."""
    from bladegen.readers import bundled, read

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
def info(blade: BladeName, as_json: Json = False) -> None:
    """Show what a blade's definition holds."""
    from bladegen.readers import read
    from bladegen.tables import definition_figures, station_rows

    definition = read(blade)
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


@app.command()
def build(
    blade: BladeName,
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for the files.")],
    formats: Formats = None,
    landmarks: Landmarks = 401,
    stations: Stations = 300,
    path: PathOption = PathKind.geodesic,
    planes: PlanesOption = Planes.axis,
    tolerance: Tolerance = "0.3mm",
    trailing_edge: EdgeOption = "2mm",
    fairing: FairingOption = FAIRING,
    tip: TipOption = TipKind.flat,
    unit: UnitOption = Unit.m,
    step: SchemaOption = StepSchema.ap242,
    light: LightOption = False,
    grid_around: GridAround = 257,
    grid_along: GridAlong = 129,
    grid_edge: GridEdge = 8,
    le_spacing: SideSpacing = 1e-3,
    te_spacing: SideSpacing = 1e-3,
    tip_spacing: SpanSpacing = 2e-4,
    root_spacing: SpanSpacing = 0.01,
    rotor: Annotated[
        bool, typer.Option("--rotor", help="The whole rotor too, as STEP assembly and GLB.")
    ] = False,
    mirror: Annotated[
        bool, typer.Option("--mirror", help="A rotor that turns anticlockwise seen from upwind.")
    ] = False,
) -> None:
    """Build a blade: a STEP solid, meshes, grids, a picture and a report."""
    spacing = {
        "around": grid_around,
        "along": grid_along,
        "edge": grid_edge,
        "leading_edge": le_spacing,
        "trailing_edge": te_spacing,
        "tip": tip_spacing,
        "root": root_spacing,
    }
    options = build_options(tolerance, stations, tip, unit, step, light, spacing)
    made = read_blade(blade, landmarks, path, planes, trailing_edge, fairing)
    whole = None
    if rotor or mirror:
        from bladegen.rotor import rotor_of

        whole = rotor_of(made, mirrored=mirror)
    _build(made, output, formats, options, whole)


@app.command()
def perturb(
    blade: BladeName,
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for the files.")],
    pga: Annotated[
        list[str] | None,
        typer.Option(
            metavar="t1,t2,...[@ETA]",
            help="Coordinates along the modes [rad]; with @ETA repeated, knots over span.",
        ),
    ] = None,
    space: Annotated[
        Path | None, typer.Option(help="A space made by `space build`; the bundled one if not.")
    ] = None,
    thickness: Annotated[float, typer.Option(help="Thickness times this; 1 changes nothing.")] = 1,
    camber: Annotated[
        float, typer.Option(help="diag(2 - s, s), chord against thickness; 1 changes nothing.")
    ] = 1,
    chord: Annotated[
        float, typer.Option(help="Chord times this at the same thickness in metres; 1 is none.")
    ] = 1,
    twist: Annotated[float, typer.Option(help="Added to the twist [deg]; 0 changes nothing.")] = 0,
    chord_scale: Annotated[float, typer.Option(help="Sections times this; 1 is none.")] = 1,
    twist_scale: Annotated[float, typer.Option(help="Twist times this; 1 is none.")] = 1,
    prebend_scale: Annotated[float, typer.Option(help="Prebend times this; 1 is none.")] = 1,
    window: Annotated[
        str | None,
        typer.Option(
            metavar="FROM,TO", help="Where the changes fade in; past round roots if not given."
        ),
    ] = None,
    allow_extrapolation: Annotated[
        bool, typer.Option("--allow-extrapolation", help="Go beyond the space's data.")
    ] = False,
    name: Annotated[str | None, typer.Option(help="Of the perturbed blade and its files.")] = None,
    formats: Formats = None,
    landmarks: Landmarks = 401,
    stations: Stations = 300,
    path: PathOption = PathKind.geodesic,
    planes: PlanesOption = Planes.axis,
    tolerance: Tolerance = "0.3mm",
    trailing_edge: EdgeOption = "2mm",
    fairing: FairingOption = FAIRING,
    tip: TipOption = TipKind.flat,
    unit: UnitOption = Unit.m,
    step: SchemaOption = StepSchema.ap242,
    light: LightOption = False,
) -> None:
    """Perturb a blade consistently and build it."""
    from math import radians

    from bladegen.pga import ShapeSpace
    from bladegen.texts import coordinates, span_window

    t = coordinates(pga or [])
    options = build_options(tolerance, stations, tip, unit, step, light)
    made = read_blade(blade, landmarks, path, planes, trailing_edge, fairing)
    variant = made.perturbed(
        None if t is None else ShapeSpace.load(space) if space else ShapeSpace.bundled(),
        () if t is None else t,
        thickness=thickness,
        camber=camber,
        chord=chord,
        twist=radians(twist),
        chord_scale=chord_scale,
        twist_scale=twist_scale,
        prebend_scale=prebend_scale,
        window=None if window is None else span_window(window),
        allow_extrapolation=allow_extrapolation,
        name=name or f"{made.name}-perturbed",
    )
    _build(variant, output, formats, options)


@app.command()
def preview(
    blade: BladeName,
    screenshot: Annotated[
        Path | None, typer.Option(help="Write a PNG instead of opening a window.")
    ] = None,
    landmarks: Landmarks = 401,
    path: PathOption = PathKind.geodesic,
    planes: PlanesOption = Planes.axis,
    trailing_edge: EdgeOption = "2mm",
    fairing: FairingOption = FAIRING,
) -> None:
    """Look at a blade in a window, or write a picture of it."""
    from bladegen import preview as view
    from bladegen.files import replacing

    made = read_blade(blade, landmarks, path, planes, trailing_edge, fairing)
    if screenshot is None:
        view.show(made)
        return
    with replacing(screenshot) as temporary:
        view.picture(made, temporary)
    typer.echo(f"wrote {screenshot}")


def _build(
    blade: Any, output: Path, formats: list[str] | None, options: Any, rotor: Any = None
) -> None:
    """Build a blade's files and print what was made, a missed tolerance included."""
    from bladegen.build import DEFAULT_FORMATS
    from bladegen.build import build as build_files
    from bladegen.errors import ToleranceError

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
        except ToleranceError as error:
            miss = error
    print_summary(output, blade.name)
    if miss is not None:
        raise miss
