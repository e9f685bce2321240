"""What commands have in common: their options, and what they make of them."""

from enum import StrEnum
from typing import Annotated, Any

import typer

__all__ = [
    "BladeName",
    "EdgeOption",
    "FairingOption",
    "Formats",
    "GridAlong",
    "GridAround",
    "GridEdge",
    "Json",
    "Landmarks",
    "LightOption",
    "PathKind",
    "PathOption",
    "Planes",
    "PlanesOption",
    "SchemaOption",
    "SideSpacing",
    "SpanSpacing",
    "Stations",
    "StepSchema",
    "TipKind",
    "TipOption",
    "Tolerance",
    "Unit",
    "UnitOption",
    "build_options",
    "read_blade",
]


LIGHT = "1mm"


class PathKind(StrEnum):
    """How stations are joined."""

    geodesic = "geodesic"
    spline = "spline"


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

    axis = "axis"
    z = "z"


BladeName = Annotated[
    str, typer.Argument(metavar="BLADE", help="A bundled blade's name, or a windIO file.")
]
Formats = Annotated[
    list[str] | None,
    typer.Option(
        "--format",
        help="step iges brep stl glb png ply obj 3mf vtp p3d fmt cgns vtu sections.csv; may be "
        "repeated.",
    ),
]
Tolerance = Annotated[
    str, typer.Option(metavar="LENGTH", help="Largest deviation of the solid, such as 0.3mm.")
]
Stations = Annotated[int, typer.Option(help="Sections of the meshes.")]
TipOption = Annotated[TipKind, typer.Option(help="A flat or a rounded tip.")]
UnitOption = Annotated[Unit, typer.Option(help="Unit of STL, PLY, OBJ, VTP, PLOT3D and VTU files.")]
SchemaOption = Annotated[StepSchema, typer.Option("--step", help="Schema of STEP files.")]
LightOption = Annotated[bool, typer.Option("--light", help="Solids within 1 mm in less than 2 MB.")]
GridAround = Annotated[int, typer.Option(help="Grids: points around a section, odd.")]
GridAlong = Annotated[int, typer.Option(help="Grids: points from root to tip.")]
GridEdge = Annotated[int, typer.Option(help="Grids: cells across the trailing edge, even.")]
SideSpacing = Annotated[
    float, typer.Option(help="Grids: cell at that edge over the side's length, about the chord.")
]
SpanSpacing = Annotated[float, typer.Option(help="Grids: cell at that end over the length.")]
Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Landmarks = Annotated[int, typer.Option(help="Landmarks a section, odd.")]
PathOption = Annotated[
    PathKind, typer.Option("--path", help="Join stations by geodesics or by a smooth spline.")
]
PlanesOption = Annotated[
    Planes, typer.Option("--planes", help="Section planes normal to the reference axis or to z.")
]
EdgeOption = Annotated[
    str,
    typer.Option(
        "--trailing-edge",
        metavar="LENGTH|given|sharp",
        help="Least thickness of the trailing edge, such as 2mm; or as given; or sharp.",
    ),
]
FairingOption = Annotated[
    str,
    typer.Option(
        "--fairing",
        metavar="SHARE|off",
        help="Take noise out of airfoils, at most that share of the chord off any point; or off.",
    ),
]
FAIRING = "1e-5"


def read_blade(
    source: str, landmarks: int, path: str, planes: Planes, edge: str, fairing: str = FAIRING
) -> Any:
    """Read and build a blade as the options say."""
    from bladegen.blade import Blade
    from bladegen.edges import AsGiven, MinimumThickness, Sharp, TrailingEdge
    from bladegen.planform import normal_to_axis, normal_to_z
    from bladegen.readers import read
    from bladegen.texts import chord_share, metres

    named: dict[str, TrailingEdge] = {"given": AsGiven(), "sharp": Sharp()}
    return Blade.from_definition(
        read(source),
        landmarks=landmarks,
        path=path,
        planes={"axis": normal_to_axis, "z": normal_to_z}[planes],
        trailing_edge=named.get(edge) or MinimumThickness(metres(edge, "trailing-edge")),
        fairing=chord_share(fairing, "fairing"),
    )


def build_options(
    tolerance: str,
    stations: int,
    tip: TipKind,
    unit: Unit,
    schema: StepSchema,
    light: bool = False,
    spacing: dict[str, Any] | None = None,
) -> Any:
    """Return how products are made, as the options say."""
    from bladegen.exporters import Options
    from bladegen.grid import Spacing
    from bladegen.texts import metres
    from bladegen.tips import Tip, flat_tip, round_tip

    tips: dict[str, Tip] = {"flat": flat_tip, "round": round_tip}
    return Options(
        tolerance=metres(LIGHT if light else tolerance, "tolerance"),
        step_schema=schema,
        stations=stations,
        tip=tips[tip],
        unit=unit,
        spacing=Spacing(**(spacing or {})),
    )
