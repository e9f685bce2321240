"""The command `bladegen fit`: a surface of unknown origin to a blade's definition."""

import json
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from bladegen.cli.options.common import Json, ending_in
from bladegen.cli.options.groups import COMMAND, grouped
from bladegen.cli.options.parsing import metres
from bladegen.cli.terminal import print_figures, print_findings, print_table, progress_bar
from bladegen.errors import BladegenError, Finding

__all__ = ["fit"]


class Units(StrEnum):
    """Units of files that say none."""

    m = "m"
    mm = "mm"
    cm = "cm"
    inch = "in"
    foot = "ft"


class Frame(StrEnum):
    """Whose axes the blade's are."""

    auto = "auto"
    file = "file"
    blade = "blade"


WITHIN = 0.02  # of the tolerance, for what takes up that airfoils are moved into windIO's 0 to 1
SHOWN = 12  # airfoils in the table


class Root(StrEnum):
    """What the pitch axis follows."""

    auto = "auto"
    flange = "flange"
    circles = "circles"


@grouped
def fit(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="SOURCE",
            help="A CAD file (STEP, IGES, BREP), a mesh, points or sections (.xyz .csv .ply).",
        ),
    ],
    target: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            help="The definition to write, such as blade.yaml (windIO 2).",
            callback=ending_in(".yaml", ".yml", ".dat", ".htc", ".csv", ".xlsx"),
        ),
    ],
    tolerance: Annotated[
        str, typer.Option(help="Distance that 99 % of the points shall keep.")
    ] = "1mm",
    unit: Annotated[
        Units | None,
        typer.Option(help="Unit of the file; by default what it says, or its size suggests."),
    ] = None,
    length: Annotated[
        str | None,
        typer.Option(
            metavar="LENGTH",
            help="Of the blade, for a table of sections at span fractions, such as 61.5m.",
        ),
    ] = None,
    frame: Annotated[
        Frame,
        typer.Option(
            help="Axes of the blade: those of the file, those that follow from its shape alone "
            "(twist is then zero at 90 % span), or the file's where these fit."
        ),
    ] = Frame.auto,
    root: Annotated[
        Root,
        typer.Option(
            help="What the pitch axis follows: the root's flange, the middle of its circles where "
            "its end is a cut, or the flange unless it is more than 4 degrees off."
        ),
    ] = Root.auto,
    name: Annotated[str | None, typer.Option(help="The blade's name; the file's if not given.")] = (
        None
    ),
    like: Annotated[
        str | None,
        typer.Option(
            metavar="BLADE",
            help="A blade whose parameters are fitted besides: shape at three spans, thickness, "
            "chord, twist, with standard deviations.",
        ),
    ] = None,
    screenshot: Annotated[
        Path | None,
        typer.Option(
            help="A PNG of the surface coloured by its distance from the blade.",
            callback=ending_in(".png"),
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Fit a definition to a surface: axis, chord, twist, offsets, airfoils at few stations.

    A report lies beside it. Exit with 1 if the tolerance is missed; the files are there then, too.
    """
    from bladegen.cli.options.variants import defined
    from bladegen.fitting.fit import fit as fitted_to
    from bladegen.formats.writing import format_of
    from bladegen.support.files import replacing

    row = format_of(target, None)
    allowed = metres(tolerance, "tolerance", example="1mm")
    with progress_bar() as progress:
        fitted = fitted_to(
            source,
            like=None if like is None else defined(str(like)),
            tolerance=allowed,
            unit=unit and unit.value,
            length=None if length is None else metres(length, "length", example="61.5m"),
            frame=frame.value,
            root=root.value,
            name=name,
            progress=progress,
        )
        progress(f"writing {target}")
        try:
            findings = _written(fitted, target, row.title, WITHIN * allowed)
        except BladegenError as error:
            if not fitted.noise:
                raise
            raise BladegenError(
                f"{error}; the points scatter by {1e3 * fitted.noise:.2g} mm: a larger --tolerance "
                "takes fewer airfoils"
            ) from None
        report = fitted.report() | {"format": row.title}
        told = target.with_suffix(".fit.json")
        with replacing(told) as temporary:
            temporary.write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
        if screenshot is not None:
            progress("rendering")
            _draw(fitted, screenshot)
    if as_json:
        typer.echo(json.dumps(report, indent=2))
    else:
        print_findings([str(finding) for finding in (*fitted.findings, *findings)])
        print_figures(f"{source} fitted", fitted.figures)
        _print_bands(fitted)
        _print_airfoils(fitted, told)
        if fitted.parameters is not None:
            rows = [
                [row["name"], f"{row['value']:.5g}", f"{row['standard_deviation']:.2g}"]
                for row in fitted.parameters.rows()
            ]
            print_table(["parameter", "value", "standard deviation"], rows, title=f"like {like}")
        for path in (target, told, *([screenshot] if screenshot else [])):
            typer.echo(f"wrote {path}")
    fitted.require_held()


def _written(fitted: Any, target: Path, title: str, off: float) -> list[Any]:
    """Write the definition, a windIO file no closer than `off` [m]; return what it cannot hold."""
    from bladegen.exports.definitions import write
    from bladegen.formats.windio.writing import within

    definition, findings = fitted.definition, []
    if title.startswith("windIO"):  # moved by itself it is a hundred times closer than fits
        definition = within(definition, lambda *one: findings.append(Finding(*one)), off)
    findings += write(definition, target, command=COMMAND.get(), polars="none")
    return findings


def _print_bands(fitted: Any) -> None:
    rows = [
        [
            f"{100 * band['from_eta']:.0f} to {100 * band['to_eta']:.0f}",
            *(
                f"{band[key]:.3f}"
                for key in ("maximum_mm", "percentile_99_mm", "rms_mm", "mean_mm")
            ),
        ]
        for band in fitted.bands()
    ]
    print_table(["span, %", "largest, mm", "99 %, mm", "RMS, mm", "mean (outside +), mm"], rows)


def _print_airfoils(fitted: Any, told: Path) -> None:
    """Print where some of the airfoils lie, evenly over the span; the report holds all."""
    places = fitted.places()
    each = [s.airfoil for s in fitted.definition.stations]
    eta = [place.eta for place in places]
    shown = sorted(
        {min(range(len(eta)), key=lambda k: abs(eta[k] - s / (SHOWN - 1))) for s in range(SHOWN)}
    )
    rows = [
        [
            f"{places[k].eta:.3f}",
            f"{100 * each[k].relative_thickness:.1f}",
            " ".join(f"{1e3 * t:4.0f}" for t in places[k].coordinates),
            f"{1e3 * places[k].distance:.0f}",
            f"{places[k].spread:.1f}",
            f"{1e3 * places[k].away:.0f}",
            places[k].nearest,
        ]
        for k in shown
    ]
    some = "airfoils" if len(shown) == len(places) else f"{len(shown)} of {len(places)} airfoils"
    print_table(
        ["eta", "t/c, %", "t", "off", "spread", "away", "nearest airfoil"],
        rows,
        title=f"{some}: t, off the space, away from the nearest in mrad; all in {told.name}",
    )


def _draw(fitted: Any, target: Path) -> None:
    from bladegen.exports.marks import marked
    from bladegen.exports.provenance import drawn_of
    from bladegen.measures.sides import Side, surface_of
    from bladegen.views.comparison import compared, draw

    found = compared(Side("the source", fitted.surface), surface_of(fitted.blade))
    with marked(target, drawn_of(fitted.blade, command=COMMAND.get())) as temporary:
        draw(found, f"{fitted.definition.name}: source against fit", temporary)
