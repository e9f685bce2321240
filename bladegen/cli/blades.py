"""`bladegen list` and `bladegen info`: which blades there are, and what one's definition holds."""

import json

import typer

from bladegen.cli.options.common import Airfoils, BladeName, Json
from bladegen.cli.terminal import print_figures, print_findings, print_table

__all__ = ["info", "list_blades"]


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
