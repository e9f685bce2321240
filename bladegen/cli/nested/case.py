"""`bladegen case`: what a flow solver runs, with its mesh and the commands to type."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any

import typer

from bladegen.cli.options.common import MAKING, BladeName, Json, Making, Target
from bladegen.cli.options.groups import COMMAND, grouped
from bladegen.cli.options.slips import Answering
from bladegen.cli.terminal import print_figures, progress_bar, remark

__all__ = ["app"]

app = typer.Typer(
    help="Write cases that OpenFOAM runs: a rotor, or the flow around a section.",
    no_args_is_help=True,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.callback()
def begin() -> None:
    """Write cases that OpenFOAM runs: a rotor, or the flow around a section."""


@dataclass(frozen=True)
class OfRotor:
    """How the rotor works."""

    wind: Annotated[
        float | None,
        typer.Option(metavar="M/S", help="Where its design works at rated speed if not given."),
    ] = None
    tip_speed_ratio: Annotated[
        float | None, typer.Option(help="The design's, up to rated speed, if not given.")
    ] = None
    rotor_speed: Annotated[
        float | None,
        typer.Option(metavar="1/MIN", help="That of wind and tip speed ratio if not given."),
    ] = None
    pitch: Annotated[
        str | None,
        typer.Option(metavar="ANGLE", help="Toward feather, degrees; the file's fine pitch, or 0."),
    ] = None
    hub_radius: Annotated[
        str | None, typer.Option(metavar="LENGTH", help="Instead of the definition's; 2m.")
    ] = None


@dataclass(frozen=True)
class OfSection:
    """What flows around the section."""

    speed: Annotated[
        float | None,
        typer.Option(help="Of the air past the section, m/s; that of the rotor if not given."),
    ] = None
    reynolds: Annotated[
        float | None, typer.Option(help="Of the chord; that of air if not given.")
    ] = None
    alpha: Annotated[
        str | None,
        typer.Option(
            metavar="ANGLE",
            help="Angle of attack from the chord line, degrees; that of the rotor if not given.",
        ),
    ] = None


@dataclass(frozen=True)
class Meshing:
    """The mesh, of a rotor and of a section."""

    y_plus: Annotated[
        float | None, typer.Option(help="Of the first cells' centres.", show_default="300; 2")
    ] = None
    cells: Annotated[
        int | None,
        typer.Option(
            help="Around the section, of a rotor that at 75 % span.", show_default="48; 512"
        ),
    ] = None
    growth: Annotated[
        float | None,
        typer.Option(help="Of layers' heights, outward.", show_default="1.6; 1.15"),
    ] = None
    radius: Annotated[
        float | None,
        typer.Option(
            help="Of the far field: of a rotor in tip radii, of a section in chords.",
            show_default="5; 500",
        ),
    ] = None
    end: Annotated[
        int | None, typer.Option(help="Iterations at most.", show_default="500; 1000")
    ] = None

    @property
    def given(self) -> dict[str, Any]:
        """What is not left to the case."""
        return {name: value for name, value in vars(self).items() if value is not None}


OF_ROTOR, OF_SECTION, MESHING = OfRotor(), OfSection(), Meshing()


@app.command("openfoam", cls=Answering)
@grouped
def case_openfoam(
    blade: BladeName,
    output: Target,
    section: Annotated[
        float | None,
        typer.Option(
            metavar="ETA",
            help="Of a section alone, in two dimensions: its span fraction, 0 (root) to 1 (tip).",
        ),
    ] = None,
    rotor: OfRotor = OF_ROTOR,
    flow: OfSection = OF_SECTION,
    meshing: Meshing = MESHING,
    making: Making = MAKING,
    as_json: Json = False,
) -> None:
    """Write an OpenFOAM case of a rotor in steady wind, or of the flow around a section.

    A rotor is one blade in its sector, meshed by snappyHexMesh; a section comes with its mesh.
    By default either works at the rotor's rated speed and best tip speed ratio.
    """
    _require_of(flow if section is None else rotor, section)
    with progress_bar() as progress:
        progress(f"reading {blade}")
        if section is None:
            made: Any = _of_rotor(making, blade, rotor, meshing, progress)
            title = f"{blade}, a rotor"
        else:
            made = _of_section(making, blade, section, flow, meshing, progress)
            title = f"{blade} at {100.0 * section:g} % span"
        progress(f"writing {output}")
        made.write(output, command=COMMAND.get())
    if as_json:
        typer.echo(json.dumps(made.figures, indent=2))
        return
    if made.flow.told:
        others = _others(rotor if section is None else flow)
        remark(f"{made.flow.told}; to change that: {others}")
    for line in made.remarks:
        remark(line)
    print_figures(title, made.figures)
    typer.echo(f"wrote {output}: run it with {output}/Allrun, {output}/README.md says how")


def _others(given: OfRotor | OfSection) -> str:
    """Name the options of a flow that were not given and may be."""
    if isinstance(given, OfSection):
        values = {"--speed": given.speed, "--alpha": given.alpha}
    else:
        values = {"--wind": given.wind, "--tip-speed-ratio": given.tip_speed_ratio}
        if sum(value is not None for value in (*values.values(), given.rotor_speed)) > 1:
            values = {}  # two of the three make the third
        values["--pitch"] = given.pitch
    return ", ".join(name for name, value in values.items() if value is None)


def _require_of(others: OfRotor | OfSection, section: float | None) -> None:
    """Refuse options of a section's case in that of a rotor, and the other way round."""
    from bladegen.errors import BladegenError

    given = [name for name, value in vars(others).items() if value is not None]
    if given:
        option = f"--{given[0].replace('_', '-')}"
        raise BladegenError(
            f"{option}: is of a section; name one, such as --section 0.7"
            if section is None
            else f"{option}: is of a rotor's case, which --section leaves out; give one of them"
        )


def _of_rotor(
    making: Making,
    blade: str,
    rotor: OfRotor,
    meshing: Meshing,
    progress: Callable[[str], None],
) -> Any:
    """Return the case of a rotor."""
    from bladegen.cli.options.parsing import metres, radians
    from bladegen.exports.cases.rotors.rotor import LANDMARKS, rotor_case

    hub, pitch = rotor.hub_radius, rotor.pitch
    return rotor_case(
        making.blade(blade, LANDMARKS, asked=False),
        hub_radius=None if hub is None else metres(hub, "hub-radius", example="2m"),
        wind=rotor.wind,
        ratio=rotor.tip_speed_ratio,
        turns=rotor.rotor_speed,
        pitch=None if pitch is None else radians(pitch, "pitch"),
        **meshing.given,
        progress=progress,
    )


def _of_section(
    making: Making,
    blade: str,
    section: float,
    flow: OfSection,
    meshing: Meshing,
    progress: Callable[[str], None],
) -> Any:
    """Return the case of a section."""
    from bladegen.cli.options.parsing import radians
    from bladegen.exports.cases.section import section_case

    return section_case(
        making.blade(blade),
        section,
        speed=flow.speed,
        reynolds=flow.reynolds,
        alpha=None if flow.alpha is None else radians(flow.alpha, "alpha"),
        **meshing.given,
        progress=progress,
    )
