"""`bladegen evaluate`: what the wind makes of a blade, beside its baseline."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from bladegen.cli.options.common import MAKING, BladeName, Json, Making, ending_in
from bladegen.cli.options.groups import COMMAND, grouped
from bladegen.cli.options.perturbing import NO_CHANGES, Changes
from bladegen.cli.terminal import print_table, progress_bar

__all__ = ["evaluate"]

LANDMARKS = 201  # NeuralFoil takes eighteen numbers of a section


@dataclass(frozen=True)
class Working:
    """Under which conditions the rotor works."""

    tip_speed: Annotated[
        float | None,
        typer.Option(
            metavar="M/S",
            help="The largest; that of the file's rated rotor speed, or 80, if not given.",
        ),
    ] = None
    rated_power: Annotated[
        float | None,
        typer.Option(metavar="MW", help="The file's if not given; no annual energy without."),
    ] = None
    mean_wind: Annotated[
        float | None,
        typer.Option(
            metavar="M/S", help="Over a year; that of the file's IEC class, or 8.5, if not given."
        ),
    ] = None
    weibull_shape: Annotated[float, typer.Option(help="Of the winds; 2 is Rayleigh's.")] = 2.0
    cut_in: Annotated[
        float | None, typer.Option(metavar="M/S", help="The file's, or 3, if not given.")
    ] = None
    cut_out: Annotated[
        float | None, typer.Option(metavar="M/S", help="The file's, or 25, if not given.")
    ] = None
    air_density: Annotated[float, typer.Option(metavar="KG/M3", help="Of the air.")] = 1.225
    efficiency: Annotated[float, typer.Option(help="Of drive train and generator.")] = 1.0
    hub_radius: Annotated[
        str | None,
        typer.Option(metavar="LENGTH", help="Instead of the definition's; 2m."),
    ] = None
    network: Annotated[
        str, typer.Option(help="NeuralFoil's, xxsmall to xxxlarge: exactness against time.")
    ] = "xlarge"


WORKING = Working()


@grouped
def evaluate(
    blade: BladeName,
    changes: Changes = NO_CHANGES,
    making: Making = MAKING,
    working: Working = WORKING,
    plot: Annotated[
        Path | None,
        typer.Option(
            help="A diagram of power and thrust coefficient and power curve: PNG, SVG, PDF.",
            callback=ending_in(".png", ".svg", ".pdf"),
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Evaluate a blade: power, thrust, root moment, annual energy and mass.

    A changed blade stands beside its baseline. Polars are of its own sections, by NeuralFoil (the
    extra aero); the rotor is rigid, in steady uniform wind, by blade-element momentum theory.
    """
    from bladegen.blade.aero.energy import Conditions
    from bladegen.blade.aero.evaluation import evaluated
    from bladegen.cli.options.parsing import metres
    from bladegen.views import rotor_tables as tables

    hub = working.hub_radius
    given = {
        "tip_speed": working.tip_speed,
        "rated_power": None if working.rated_power is None else 1e6 * working.rated_power,
        "mean_wind": working.mean_wind,
        "weibull_shape": working.weibull_shape,
        "cut_in": working.cut_in,
        "cut_out": working.cut_out,
        "air_density": working.air_density,
        "efficiency": working.efficiency,
    }
    with progress_bar() as progress:
        progress("building")
        baseline = making.blade(blade, LANDMARKS, asked=False)
        blades = [baseline, changes.applied(baseline)] if changes.asked else [baseline]
        progress("evaluating")
        found = evaluated(
            blades,
            lambda rotor, radius: Conditions.of(rotor, radius, **given),
            hub_radius=None if hub is None else metres(hub, "hub-radius", example="2m"),
            network=working.network,
        )
        progress("weighing")
        masses = [None if made.layup is None else made.layup.mass for made in blades]
    names = [made.name for made in blades]
    if plot is not None:
        from bladegen.exports.marks import marked
        from bladegen.exports.provenance import drawn_of
        from bladegen.views.plots.rotor_plot import draw

        with marked(plot, drawn_of(blades[-1], command=COMMAND.get())) as temporary:
            draw(found, names, temporary)
    if as_json:
        document = {
            "conditions": found.conditions.named,
            "network": working.network,
            "wind_m_s": found.conditions.winds.tolist(),
            "blades": [
                {"name": name, "baseline": changes.asked and row == 0}
                | tables.rotor_figures(found, row, masses[row])
                | {"curve": tables.rotor_curve(found, row)}
                | {"power_W": found.power[row].tolist()}
                for row, name in enumerate(names)
            ],
        }
        typer.echo(json.dumps(document, indent=2))
        return
    print_table(["conditions", ""], tables.conditions_rows(found))
    if len(blades) > 1:
        print_table(["figure", *names, "change"], tables.figure_rows(found, masses))
        columns = [f"{what}, {of}" for of in ("baseline", "variant") for what in ("Cp", "Ct")]
    else:
        print_table(["figure", *names], tables.figure_rows(found, masses))
        columns = ["Cp", "Ct"]
    print_table(["tip speed ratio", *columns], tables.curve_rows(found), title="at that pitch")
    for said in tables.notes_on(found):
        typer.echo(f"note: {said}")
    if plot is not None:
        typer.echo(f"wrote {plot}")
