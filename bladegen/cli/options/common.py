"""What commands have in common: options and groups of them (`groups`), and what they make."""

from dataclasses import dataclass
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from bladegen.cli.options.groups import COMMAND
from bladegen.cli.options.targets import Target, ending_in
from bladegen.errors import BladegenError

__all__ = [
    "LANDMARKS",
    "MAKING",
    "PRODUCING",
    "Airfoils",
    "BladeName",
    "Formats",
    "Json",
    "Landmarks",
    "Making",
    "Mirror",
    "Polars",
    "Producing",
    "Reynolds",
    "Target",
    "ending_in",
    "suffixes_of",
]

LANDMARKS = 401
TOLERANCE = "0.3mm"
LIGHT, LIGHT_BYTES = "1mm", 2_000_000
GRIDS = "Structured grids: p3d, fmt, cgns, vtu"


class PathKind(StrEnum):
    """How stations are joined."""

    spline = "spline"
    geodesic = "geodesic"


class TipKind(StrEnum):
    """How the tip is closed."""

    flat = "flat"
    round = "round"


class Unit(StrEnum):
    """Units of mesh files."""

    m = "m"
    mm = "mm"


class StepSchema(StrEnum):
    """Application protocols of STEP files."""

    ap242 = "ap242"
    ap214 = "ap214"


class Planes(StrEnum):
    """Which way section planes face."""

    flange = "flange"
    axis = "axis"
    z = "z"


BladeName = Annotated[
    str, typer.Argument(metavar="BLADE", help="A bundled blade's name, or a definition's file.")
]
Airfoils = Annotated[
    Path | None,
    typer.Option(
        metavar="DIR",
        help="Folder of airfoil files, for formats that only name their airfoils; one beside the "
        "file if not given.",
    ),
]
Element = Annotated[str, typer.Option(metavar="LENGTH", help="Of a shell's elements (inp).")]
Laminates = Annotated[bool, typer.Option("--laminates", help="Shells layer by layer (Abaqus).")]
Formats = Annotated[
    list[str] | None,
    typer.Option(
        "--format",
        help="CAD: step iges brep curves.step structure.step; triangles: stl regions.stl glb ply "
        "obj 3mf vtp; grids: p3d fmt cgns vtu; shells: inp; definitions: yaml (windIO 2) dat "
        "(OpenFAST) htc (HAWC2) csv xlsx; sections.csv; png. Several with commas, or repeated.",
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
SIDE = "Cell at that edge over the side's length, about the chord."
SPAN = "Cell at that end over the length."
_spacing = partial(typer.Option, rich_help_panel=GRIDS)
_coupled = partial(_spacing, show_default="as high as those beyond the block's edge")
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

    def blade(self, source: str, landmarks: int = LANDMARKS) -> Any:
        """Read and build a blade."""
        from bladegen.blade.blade import Blade
        from bladegen.blade.planform import PLANES
        from bladegen.cli.options.fairing import chord_share, planform_fairing
        from bladegen.cli.options.parsing import finish
        from bladegen.formats.reading import read

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


@dataclass(frozen=True)
class Producing:
    """How a blade becomes files."""

    tolerance: Annotated[
        str | None,
        typer.Option(metavar="LENGTH", help="Largest deviation of the solid; 0.3mm if not given."),
    ] = None
    light: Annotated[bool, typer.Option("--light", help="Solids within 1 mm, under 2 MB.")] = False
    split: Annotated[
        bool,
        typer.Option(
            "--split", help="Solids' sides in pieces: volumes in FreeCAD are right to 1e-5."
        ),
    ] = False
    stations: Annotated[int, typer.Option(help="Sections of the meshes.")] = 300
    tip: Annotated[TipKind, typer.Option(case_sensitive=False, help="A flat or a rounded tip.")] = (
        TipKind.flat
    )
    unit: Annotated[
        Unit,
        typer.Option(
            case_sensitive=False, help="Unit of STL, PLY, OBJ, VTP, PLOT3D and VTU files."
        ),
    ] = Unit.m
    step: Annotated[
        StepSchema, typer.Option(case_sensitive=False, help="Schema of STEP files.")
    ] = StepSchema.ap242
    author: Annotated[
        str, typer.Option(metavar="NAME", help="Whom STEP and IGES files name; nobody by default.")
    ] = ""
    organisation: Annotated[
        str, typer.Option(metavar="NAME", help="The author's, in the same files.")
    ] = ""
    grid_around: Annotated[
        int, typer.Option(help="Points around a section, odd.", rich_help_panel=GRIDS)
    ] = 289
    grid_along: Annotated[
        int, typer.Option(help="Points from root to tip.", rich_help_panel=GRIDS)
    ] = 165
    grid_edge: Annotated[
        int,
        typer.Option(
            help="Cells across the trailing edge and the tip, even.", rich_help_panel=GRIDS
        ),
    ] = 72
    le_spacing: Annotated[float, _spacing(help=SIDE)] = 1e-3
    te_spacing: Annotated[float | None, _coupled(help=SIDE)] = None
    tip_spacing: Annotated[float | None, _coupled(help=SPAN)] = None
    root_spacing: Annotated[float, _spacing(help=SPAN)] = 0.008
    element: Element = "1m"
    laminates: Laminates = False
    polars: Polars = None
    reynolds: Reynolds = None

    def options(self) -> Any:
        """Return how products are made."""
        from bladegen.cli.options.parsing import metres
        from bladegen.exports.options import Options
        from bladegen.surface.grids.grid import Spacing
        from bladegen.surface.tips import TIPS

        if self.light and self.tolerance is not None:
            raise BladegenError(
                f"--tolerance: got {self.tolerance}, but --light takes {LIGHT}; leave one out"
            )
        tolerance = LIGHT if self.light else self.tolerance or TOLERANCE
        return Options(
            tolerance=metres(tolerance, "tolerance"),
            largest=LIGHT_BYTES if self.light else None,
            command=COMMAND.get(),
            step_schema=self.step,
            author=self.author,
            organisation=self.organisation,
            split=self.split,
            stations=self.stations,
            tip=TIPS[self.tip],
            unit=self.unit,
            element=metres(self.element, "element", example="1m"),
            laminates=self.laminates,
            polars=self.polars,
            reynolds=self.reynolds,
            spacing=Spacing(
                around=self.grid_around,
                along=self.grid_along,
                edge=self.grid_edge,
                leading_edge=self.le_spacing,
                trailing_edge=self.te_spacing,
                tip=self.tip_spacing,
                root=self.root_spacing,
            ),
        )


MAKING, PRODUCING = Making(), Producing()


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
