"""What commands have in common: options and groups of them (`groups`), and what they make."""

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from bladegen.cli.options.targets import FamilyTarget, Target, ending_in
from bladegen.errors import BladegenError

__all__ = [
    "LANDMARKS",
    "MAKING",
    "Airfoils",
    "BladeName",
    "FamilyTarget",
    "Formats",
    "Json",
    "Landmarks",
    "Making",
    "Mirror",
    "Polars",
    "Reynolds",
    "Target",
    "ending_in",
    "suffixes_of",
]

LANDMARKS = 401


class PathKind(StrEnum):
    """How stations are joined."""

    spline = "spline"
    geodesic = "geodesic"


class Planes(StrEnum):
    """Which way section planes face."""

    flange = "flange"
    axis = "axis"
    z = "z"


BladeName = Annotated[
    str,
    typer.Argument(
        metavar="BLADE",
        help="A bundled blade's name, a definition's file, or a family's variant, FOLDER/NUMBER.",
    ),
]
Airfoils = Annotated[
    Path | None,
    typer.Option(
        metavar="DIR",
        help="Folder of airfoil files, for formats that only name their airfoils; one beside the "
        "file if not given.",
    ),
]
Formats = Annotated[
    list[str] | None,
    typer.Option(
        "--format",
        help="CAD: step iges brep curves.step structure.step; triangles: stl regions.stl glb ply "
        "obj 3mf vtp; grids: p3d fmt cgns vtu; volumes: volume.cgns volume.p3d volume.fmt "
        "volume.foam.zip; shells: inp; beams: elastodyn_blade.dat beamdyn_blade.dat beamdyn.dat "
        "beam.csv; definitions: yaml (windIO 2) dat (OpenFAST) htc (HAWC2) csv xlsx; "
        "sections.csv; png. Several with commas, or repeated.",
    ),
]
Landmarks = Annotated[int, typer.Option(help="Landmarks a section, odd.")]
Mirror = Annotated[
    bool,
    typer.Option(
        "--mirror",
        help="The mirror image in all files: its rotor turns anticlockwise seen from upwind.",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Polars = Annotated[
    str | None,
    typer.Option(
        metavar="estimate|estimate-all|keep|none",
        help="Polars of windIO, OpenFAST and HAWC2 files: by NeuralFoil for shapes without their "
        "own (default of perturbed blades if the extra aero is installed) or for all, as they "
        "are, or none.",
    ),
]
Reynolds = Annotated[
    float | None, typer.Option(help="Of estimated polars; from the file or the chord if not given.")
]


@dataclass(frozen=True)
class Making:
    """How a definition becomes a blade."""

    airfoils: Airfoils = None
    path: Annotated[
        PathKind,
        typer.Option(
            case_sensitive=False,
            help="Join stations by geodesics with blended corners, or by the paper's geodesics.",
        ),
    ] = PathKind.spline
    planes: Annotated[
        Planes,
        typer.Option(
            case_sensitive=False,
            help="Section planes: normal to z at the flange and to the reference axis past the "
            "round root; to the axis all over; or to z all over.",
        ),
    ] = Planes.flange
    trailing_edge: Annotated[
        str,
        typer.Option(
            metavar="LENGTH[,SHARE%]|given|sharp",
            help="Least thickness of the trailing edge, such as 5mm; 2mm,1% is at most 1 % of the "
            "local chord; or as given; or sharp.",
        ),
    ] = "2mm,1%"
    fairing: Annotated[
        str,
        typer.Option(
            metavar="SHARE|off",
            help="Take noise out of airfoils, at most that share of the chord off any point; "
            "or off.",
        ),
    ] = "1e-5"
    fair_planform: Annotated[
        str,
        typer.Option(
            metavar="SHARE%[,ANGLE]|off",
            help="Make chord, twist and axis C2, at most that share of the chord and that angle "
            "off what is given, such as 0.1%,0.02deg; or off.",
        ),
    ] = "off"

    def blade(self, source: str, landmarks: int = LANDMARKS, *, asked: bool = True) -> Any:
        """Read and build a blade, or take a family's variant, whose landmarks are `asked` for."""
        from bladegen.blade.blade import Blade
        from bladegen.blade.planform import PLANES
        from bladegen.cli.options.fairing import chord_share, planform_fairing
        from bladegen.cli.options.parsing import finish
        from bladegen.cli.options.variants import variant
        from bladegen.formats.reading import read

        found = variant(source, landmarks if asked else None, plain=self == Making())
        if found is not None:
            return found

        made = Blade.from_definition(
            read(source, airfoils=self.airfoils),
            landmarks=landmarks,
            path=self.path,
            planes=PLANES[self.planes],
            trailing_edge=finish(self.trailing_edge),
            fairing=chord_share(self.fairing, "fairing"),
            fair_planform=planform_fairing(self.fair_planform, "fair-planform"),
        )
        made.sections(made.eta)  # refuses a trailing edge that is thicker than its section
        return made


MAKING = Making()


def suffixes_of(formats: list[str] | None) -> tuple[str, ...]:
    """Return the suffixes of the formats that are asked for, none by default."""
    from bladegen.cli.options.parsing import suffixes
    from bladegen.exports import registry

    if not formats:
        return ()
    try:
        return suffixes(formats, registry.FORMATS)
    except BladegenError:  # one is not bladegen's own
        return suffixes(formats, registry.formats(), registry.plugins().remark)
