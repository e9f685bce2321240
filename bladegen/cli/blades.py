"""`bladegen list` and `bladegen info`: which blades there are, and what one's definition holds."""

import json

import typer

from bladegen.cli.options.common import Airfoils, BladeName, Json
from bladegen.cli.terminal import print_figures, print_findings, print_table
from bladegen.formats.bundled import Facts, bundled, facts

__all__ = ["info", "list_blades"]


def list_blades() -> None:
    """List the bundled blades."""
    known, rows = facts(), []
    for name in bundled():
        blade = known.get(name) or _read(name)
        rows.append([name, blade.description, f"{blade.length:.1f} m", str(blade.airfoils)])
    print_table(["name", "blade", "length", "airfoils"], rows)


def _read(name: str) -> Facts:
    """Read what the list shows of a blade that is new."""
    from bladegen.formats.reading import read

    return Facts.of(read(name))


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
