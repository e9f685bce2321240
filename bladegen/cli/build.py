"""`bladegen build` and `bladegen perturb`: the files of one blade."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from bladegen.cli.options.common import (
    LANDMARKS,
    MAKING,
    BladeName,
    Formats,
    Landmarks,
    Making,
    Mirror,
    Target,
    suffixes_of,
)
from bladegen.cli.options.groups import grouped
from bladegen.cli.options.perturbing import NO_CHANGES, Changes
from bladegen.cli.options.producing import PRODUCING, Producing
from bladegen.cli.options.rotors import HubRadius, Precone, require_rotor, rotor_given
from bladegen.cli.terminal import print_summary, progress_bar, remark
from bladegen.errors import BladegenError

__all__ = ["build", "perturb"]


class RotorKind(StrEnum):
    """What a rotor is made as."""

    assembly = "assembly"
    fused = "fused"
    sector = "sector"


CURVES, STRUCTURE = "curves.step", "structure.step"
Inside = Annotated[
    bool,
    typer.Option(
        "--structure",
        help="Skin cut where layers end, webs and inner surface too, NAME.structure.step.",
    ),
]
Curves = Annotated[
    bool,
    typer.Option(
        "--curves", help="Stations, edges and axes as named curves too, NAME.curves.step."
    ),
]


@grouped
def build(
    blade: BladeName,
    output: Target,
    formats: Formats = None,
    landmarks: Landmarks = LANDMARKS,
    making: Making = MAKING,
    producing: Producing = PRODUCING,
    curves: Curves = False,
    structure: Inside = False,
    rotor: Annotated[
        bool, typer.Option("--rotor", help="The whole rotor too, as STEP assembly and GLB.")
    ] = False,
    rotor_as: Annotated[
        RotorKind,
        typer.Option(
            "--rotor-as",
            help="The rotor as parts in an assembly; fused, one solid and its STL by regions; or "
            "the sector of one blade between two cuts.",
        ),
    ] = RotorKind.assembly,
    mirror: Mirror = False,
    hub_radius: HubRadius = None,
    precone: Precone = None,
) -> None:
    """Build a blade: a STEP solid, meshes, grids, a picture and a report."""
    suffixes = suffixes_of(formats)
    options = producing.options(suffixes)
    made = making.blade(blade, landmarks)
    made = made.mirror_image() if mirror else made
    whole = None
    rotor = rotor or rotor_as is not RotorKind.assembly
    require_rotor(rotor, hub_radius, precone)
    if rotor:
        whole = rotor_given(made, hub_radius, precone, rotor_as.value)
    suffixes = _with(suffixes, {CURVES: curves, STRUCTURE: structure})
    _say_what_is_idle(producing, suffixes, rotor=rotor)
    _build(made, output, suffixes, options, whole)


@grouped
def perturb(
    blade: BladeName,
    output: Target,
    changes: Changes = NO_CHANGES,
    formats: Formats = None,
    landmarks: Landmarks = LANDMARKS,
    making: Making = MAKING,
    producing: Producing = PRODUCING,
    curves: Curves = False,
    structure: Inside = False,
    mirror: Mirror = False,
) -> None:
    """Perturb a blade consistently and build it."""
    if not changes.asked:
        raise BladegenError(
            f"perturb: nothing is to change; give --pga, --thickness, --twist or another change, "
            f"or make the blade as it is: bladegen build {blade} -o {output}"
        )
    suffixes = suffixes_of(formats)
    options = producing.options(suffixes)
    made = changes.applied(making.blade(blade, landmarks))
    made = made.mirror_image() if mirror else made
    suffixes = _with(suffixes, {CURVES: curves, STRUCTURE: structure})
    _say_what_is_idle(producing, suffixes)
    _build(made, output, suffixes, options)


def _say_what_is_idle(
    producing: Producing, suffixes: tuple[str, ...], *, rotor: bool = False
) -> None:
    """Say which options were given that none of the files to be made depends on."""
    from bladegen.exports.build import SPANWISE
    from bladegen.exports.options import Kind
    from bladegen.exports.registry import format_of, suffix_of

    paths = [Path(f"x.{suffix.lower().lstrip('.')}") for suffix in suffixes]
    files = [(format_of(path).kind, suffix_of(path)) for path in paths]
    files.append((Kind.table, SPANWISE))
    if rotor:
        files += [(Kind.solid, ".step"), (Kind.triangles, ".glb")]
    for option in producing.idle(files):
        remark(
            f"{option}: changes none of the files asked for ({', '.join(suffixes)}); "
            "bladegen build -h says which files it is of"
        )


def _with(formats: tuple[str, ...], asked: dict[str, bool]) -> tuple[str, ...]:
    """Return the formats, those by default if none are given, and what is asked for besides."""
    from bladegen.exports.build import DEFAULT_FORMATS

    formats = formats or DEFAULT_FORMATS
    return (*formats, *(one for one, wanted in asked.items() if wanted and one not in formats))


def _build(
    blade: Any, output: Path, formats: tuple[str, ...], options: Any, rotor: Any = None
) -> None:
    """Build a blade's files and print what was made, a missed tolerance included."""
    from bladegen.errors import PromiseError
    from bladegen.exports.build import build as build_files

    miss = None
    with progress_bar() as progress:
        try:
            build_files(
                blade,
                output,
                formats=formats,
                options=options,
                rotor=rotor,
                progress=progress,
            )
        except PromiseError as error:
            miss = error
    print_summary(output, blade.name)
    if miss is not None:
        raise miss
