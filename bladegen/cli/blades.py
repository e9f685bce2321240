"""`bladegen list` and `bladegen info`: which blades there are, and what one's definition holds."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from bladegen.cli.options.common import Airfoils, Json, ending_in
from bladegen.cli.terminal import print_figures, print_findings, print_table
from bladegen.errors import BladegenError
from bladegen.formats.bundled import Facts, bundled, facts, layups

if TYPE_CHECKING:
    from bladegen.definition.blade_definition import BladeDefinition

__all__ = ["info", "list_blades"]

SHOWN = 20  # variants of a family that fulfil conditions
FACTS = ("blade", "source", "sha256", "definition", "command")


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


def info(
    blade: Annotated[
        str,
        typer.Argument(
            metavar="BLADE",
            help="A bundled blade's name, a definition's file, any file that bladegen wrote, a "
            "family's folder, or a variant of it, FOLDER/NUMBER.",
        ),
    ],
    airfoils: Airfoils = None,
    where: Annotated[
        str | None,
        typer.Option(
            metavar="CONDITIONS",
            help="Of a family: which variants fulfil them, 'volume > 600 and t1 < 0.1'.",
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Of a family: how its numbers spread, a PNG, SVG or PDF.",
            callback=ending_in(".png", ".svg", ".pdf"),
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Show what a blade's definition holds.

    Of any file that bladegen wrote it shows what it is made from; of a family's folder, what is
    in it and how it spreads.
    """
    from bladegen.cli.options.variants import defined, is_family, place
    from bladegen.formats.airfoils.contours import thickness
    from bladegen.formats.reading import holds_blade, is_read
    from bladegen.views.tables import definition_figures, station_rows

    path = place(blade)
    if is_family(path):
        _print_family(path, where, plot, as_json)
        return
    for name, value in (("where", where), ("plot", plot)):
        if value is not None:
            said = f"is for a family's folder, which {blade} is not; leave it out"
            raise BladegenError(f"{name}: {said}")
    made = None if blade in bundled() or not path.is_file() else _made_by(path)
    if made is not None and not (is_read(path) and holds_blade(path)):
        _print_making(blade, made, as_json)
        return
    definition = defined(blade, airfoils)
    figures = definition_figures(definition)
    figures |= {} if made is None else {"made_from": made.text}
    if definition.structure is not None:
        inside = layups()[blade] if blade in bundled() else _inside(definition)
        figures["findings"] += inside.pop("findings")
        figures |= inside
    if as_json:
        typer.echo(json.dumps(figures, indent=2))
        return
    single = {k: v for k, v in figures.items() if not isinstance(v, list) and v != ""}
    print_figures(figures["blade"], single)
    print_table(
        ["eta", "z m", "airfoil", "chord m", "twist deg", "thickness"],
        station_rows(definition, lambda airfoil: thickness(airfoil.coordinates)),
        title="stations",
    )
    if "layers" in figures:
        from bladegen.views.tables import layer_rows

        print_table(
            ["layer", "material", "on", "eta", "thickest mm", "kg"],
            layer_rows(figures),
            title=f"structure, webs: {', '.join(figures['webs']) or 'none'}",
        )
    print_findings(figures["findings"])


def _inside(definition: "BladeDefinition") -> dict[str, Any]:
    """Return what lies inside the skin, with findings on what does not fit there."""
    from bladegen.blade.blade import Blade
    from bladegen.views.tables import layup_figures

    try:
        layup = Blade.from_definition(definition).layup
    except BladegenError as error:
        said = f"structure: its mass is not known, since the sections cannot be made: {error}"
        return {"findings": [said]}
    return layup_figures(layup) | {"findings": [*map(str, (*layup.findings, *layup.remarks))]}


def _made_by(path: Path) -> Any:
    """Return what a file is made from, None if it does not tell."""
    from bladegen.exports.inventory import made_by

    return made_by(path)


def _print_making(file: str, made: Any, as_json: bool) -> None:
    """Print what a file that is no definition is made from."""
    facts = {name: getattr(made, name) for name in ("version", *FACTS)} | dict(made.settings)
    facts = {key: value for key, value in facts.items() if value} | {"id": made.id}
    if as_json:
        typer.echo(json.dumps({"file": file, "made_from": facts}, indent=2))
    else:
        print_figures(f"{file}: what it is made from", facts)


def _print_family(path: Path, where: str | None, plot: Path | None, as_json: bool) -> None:
    """Print, and draw, what a family holds, and which of its variants fulfil conditions."""
    from bladegen.families.dataset.loading import load_family
    from bladegen.families.dataset.summary import figures

    family = load_family(path)
    found = figures(family)
    places = None if where is None else family.where(where)
    if plot is not None:
        _draw_family(family, found["ranges"], places, where, plot)
    if as_json:
        found |= {} if places is None else {"where": where, "fulfilled_by": places.tolist()}
        typer.echo(json.dumps(found, indent=2))
        return
    said = {k: v for k, v in found.items() if not isinstance(v, dict)}
    said["splits"] = ", ".join(f"{name} {count}" for name, count in found["splits"].items())
    said["megabytes"] = f"{found['megabytes']:.1f}"
    print_figures(f"family of {found['blade']}", said)
    head = ["least", "mean", "largest", "deviation"]
    ranges = found["ranges"].items()
    rows = [[name, own["unit"], *(f"{own[one]:.5g}" for one in head)] for name, own in ranges]
    print_table(["of sound variants", "unit", *head], rows)
    if plot is not None:
        typer.echo(f"wrote {plot}")
    if places is None:
        return
    shown = [[str(k), str(family["name"][k])] for k in places[:SHOWN].tolist()]
    print_table(["variant", "name"], shown, title=f"{len(places)} of {len(family)}: {where}")
    if len(places) > SHOWN:
        typer.echo(f"and {len(places) - SHOWN} more; --json gives all")


def _draw_family(family: Any, ranges: Any, places: Any, where: str | None, plot: Path) -> None:
    """Draw how numbers of the sound variants spread."""
    import numpy as np

    from bladegen.support.files import replacing
    from bladegen.views.plots.spread_plot import draw

    held = None if places is None else np.isin(np.arange(len(family)), places)
    sound = {
        name: (np.where(family.valid, family.numbers[name], np.nan), ranges[name]["unit"])
        for name in ranges
    }
    title = f"{family.identity['blade']}: {int(family.valid.sum())} sound of {len(family)} variants"
    title += "" if places is None else f"; {len(places)} of them with {where}"
    with replacing(plot) as temporary:
        draw(sound, held, title, temporary)
