"""Options of how a blade becomes files: solids, meshes, structured grids, volumes, definitions."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, fields
from enum import StrEnum
from functools import partial
from typing import Annotated, Any

import typer

from bladegen.cli.options.common import Polars, Reynolds
from bladegen.cli.options.groups import COMMAND
from bladegen.errors import BladegenError

__all__ = ["PRODUCING", "Producing"]

TOLERANCE = "0.3mm"
LIGHT, LIGHT_BYTES = "1mm", 2_000_000
EDGE, EDGE_OF_VOLUMES = 72, 16  # cells across the trailing edge and the tip
GRIDS = "Structured grids: p3d, fmt, cgns, vtu"
VOLUMES = "Volumes on structured grids: volume.cgns, volume.p3d, volume.fmt, volume.foam.zip"


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


Element = Annotated[str, typer.Option(metavar="LENGTH", help="Of a shell's elements (inp).")]
Laminates = Annotated[bool, typer.Option("--laminates", help="Shells layer by layer (Abaqus).")]
OpenFast = Annotated[
    int,
    typer.Option(
        "--openfast",
        metavar="4|5",
        help="Whose ElastoDyn and BeamDyn read beam properties; 4 for those before, too.",
    ),
]
SIDE = "Cell at that edge over the side's length, about the chord."
SPAN = "Cell at that end over the length."
_spacing = partial(typer.Option, rich_help_panel=GRIDS)
_coupled = partial(_spacing, show_default="as high as those beyond the block's edge")


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
        int | None,
        typer.Option(
            help="Cells across the trailing edge and the tip, even.",
            rich_help_panel=GRIDS,
            show_default="72; 16 where a volume is among the formats",
        ),
    ] = None
    le_spacing: Annotated[float, _spacing(help=SIDE)] = 1e-3
    te_spacing: Annotated[float | None, _coupled(help=SIDE)] = None
    tip_spacing: Annotated[float | None, _coupled(help=SPAN)] = None
    root_spacing: Annotated[float, _spacing(help=SPAN)] = 0.008
    first_height: Annotated[
        str | None,
        typer.Option(
            metavar="LENGTH",
            help="Of the cells on the wall; 0.01mm if neither it nor --y-plus is given.",
            rich_help_panel=VOLUMES,
        ),
    ] = None
    y_plus: Annotated[
        float | None,
        typer.Option(
            help="Their height in wall units, at the --reynolds number of the chord at 75 % span.",
            rich_help_panel=VOLUMES,
        ),
    ] = None
    growth: Annotated[
        float, typer.Option(help="Of heights from layer to layer.", rich_help_panel=VOLUMES)
    ] = 1.2
    distance: Annotated[
        str | None,
        typer.Option(
            metavar="LENGTH",
            help="How far layers reach; a fifth of the blade's length if not given.",
            rich_help_panel=VOLUMES,
        ),
    ] = None
    smoothing: Annotated[
        float,
        typer.Option(help="Times the smoothing of layers, 0.5 to 2.", rich_help_panel=VOLUMES),
    ] = 1.0
    element: Element = "1m"
    laminates: Laminates = False
    openfast: OpenFast = 5
    polars: Polars = None
    reynolds: Reynolds = None

    def options(self, suffixes: Sequence[str] = ()) -> Any:
        """Return how products are made, for files of some suffixes among others.

        A volume does not grow from edges' cells as narrow as a surface alone may have.
        """
        from bladegen.cli.options.parsing import metres
        from bladegen.exports.options import Options
        from bladegen.surface.grids.grid import Spacing
        from bladegen.surface.tips import TIPS
        from bladegen.surface.volumes.volume import Extrusion

        if self.light and self.tolerance is not None:
            raise BladegenError(
                f"--tolerance: got {self.tolerance}, but --light takes {LIGHT}; leave one out"
            )
        volume = any(suffix.lower().lstrip(".").startswith("volume.") for suffix in suffixes)
        edge = (EDGE_OF_VOLUMES if volume else EDGE) if self.grid_edge is None else self.grid_edge
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
            openfast=self.openfast,
            polars=self.polars,
            reynolds=self.reynolds,
            extrusion=Extrusion(
                first_height=_length(self.first_height, "first-height", "0.01mm"),
                growth=self.growth,
                distance=_length(self.distance, "distance", "20m"),
                smoothing=self.smoothing,
                y_plus=self.y_plus,
                reynolds=self.reynolds if self.y_plus is not None else None,
            ),
            spacing=Spacing(
                around=self.grid_around,
                along=self.grid_along,
                edge=edge,
                leading_edge=self.le_spacing,
                trailing_edge=self.te_spacing,
                tip=self.tip_spacing,
                root=self.root_spacing,
            ),
        )

    def idle(self, files: Sequence[tuple[Any, str]]) -> list[str]:
        """Return the options that change no file of some kinds and suffixes, though given.

        What an option changes is what files say that they are made with (`Options.settings`).
        """
        made, found = self.options(), []
        for field in fields(self):
            given, other = getattr(self, field.name), field.default
            if given == other:
                continue
            if field.name == "grid_edge":  # whose default may be what is given
                other = given + 2
            plain = Producing(**(vars(self) | {field.name: other}))
            with suppress(BladegenError):  # of two that go together, and so change something
                without = plain.options()
                if all(made.settings(*one) == without.settings(*one) for one in files):
                    found.append(f"--{field.name.replace('_', '-')}")
        return found


PRODUCING = Producing()


def _length(text: str | None, field: str, example: str) -> float | None:
    from bladegen.cli.options.parsing import metres

    return None if text is None else metres(text, field, example=example)
