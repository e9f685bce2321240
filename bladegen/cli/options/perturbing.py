"""The options that perturb a blade, given once to every command that takes them."""

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from bladegen.errors import BladegenError

__all__ = ["NO_CHANGES", "Changes", "ChordLine"]


class ChordLine(StrEnum):
    """What a change of shape does with the chord line."""

    kept = "kept"
    paper = "paper"


@dataclass(frozen=True)
class Changes:
    """How a blade is perturbed."""

    pga: Annotated[
        list[str] | None,
        typer.Option(
            metavar="t1,t2,...[@ETA]",
            help="Coordinates along the modes in rad; with @ETA repeated, knots over span.",
        ),
    ] = None
    displacement: Annotated[
        str | None,
        typer.Option(
            metavar="SHARE%",
            help="Scale --pga so that the skin moves by so much of the chord where it moves "
            "farthest, such as 0.5%.",
        ),
    ] = None
    space: Annotated[
        Path | None, typer.Option(help="A space made by `space build`; the bundled one if not.")
    ] = None
    thickness: Annotated[
        float, typer.Option(help="Thickness times this, chord as it is; 1 for no change.")
    ] = 1
    camber: Annotated[
        float,
        typer.Option(
            help="The paper's: thickness and camber in metres times s, chord times 2 - s (1.05: "
            "+5 % and -5 %); 1 for no change."
        ),
    ] = 1
    chord: Annotated[
        float, typer.Option(help="Chord times this, thickness in metres as it is; 1 for no change.")
    ] = 1
    twist: Annotated[
        float,
        typer.Option(help="Degrees added to the twist, leading edge upwind; 0 for no change."),
    ] = 0
    chord_scale: Annotated[
        float, typer.Option(help="Chord and thickness times this, root included; 1 for no change.")
    ] = 1
    twist_scale: Annotated[float, typer.Option(help="Twist times this; 1 for no change.")] = 1
    prebend_scale: Annotated[float, typer.Option(help="Prebend times this; 1 for no change.")] = 1
    over: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE@ETA,...",
            help="thickness, camber, chord or twist as above, or prebend (metres added), with "
            "knots over span: twist=0@0.3,-2@0.7,-1@1. Repeat for more.",
        ),
    ] = None
    window: Annotated[
        str | None,
        typer.Option(
            metavar="FROM,TO", help="Where the changes fade in; past round roots if not given."
        ),
    ] = None
    chord_line: Annotated[
        ChordLine,
        typer.Option(
            help="Keep chord line and nose where the baseline has them under --pga, or leave them "
            "where the paper's formula takes them."
        ),
    ] = ChordLine.kept
    allow_extrapolation: Annotated[
        bool, typer.Option("--allow-extrapolation", help="Go beyond the space's data.")
    ] = False
    allow_odd: Annotated[
        bool,
        typer.Option("--allow-odd", help="Take sections with noses, tails or waves of no airfoil."),
    ] = False
    deviation: Annotated[
        Path | None,
        typer.Option(
            metavar="MAP.csv", help="Put a deviation on the skin that `check --deviation` wrote."
        ),
    ] = None
    deviation_scale: Annotated[
        float,
        typer.Option(help="The map's deviation times this: 0.5 for half of it, -1 the other way."),
    ] = 1
    erosion: Annotated[
        str | None,
        typer.Option(
            metavar="FROM,TO,WIDTH,DEPTH",
            help="Wear the leading edge off over a span, WIDTH of the chord along the arc, DEPTH "
            "with its unit: 0.7,0.98,0.03,4mm.",
        ),
    ] = None
    dent: Annotated[
        list[str] | None,
        typer.Option(
            metavar="ETA,U,SIZE,DEPTH",
            help="Dent the skin at a span fraction and place around the section (suction side's "
            "trailing edge 0, leading edge 0.5): 0.5,0.2,600mm,10mm. Repeat for more.",
        ),
    ] = None
    name: Annotated[str | None, typer.Option(help="Of the perturbed blade and its files.")] = None

    @property
    def asked(self) -> bool:
        """Whether anything is to change."""
        shape = bool(self.pga or self.over or self.deviation or self.erosion or self.dent)
        shape = shape or self.deviation_scale != 1  # is answered, if there is no map
        return shape or any(self._moved(key) for key in AFFINE)

    def _moved(self, key: str) -> bool:
        """Tell whether a number is not the identity."""
        return bool(getattr(self, key) != getattr(Changes, key))

    def shape_space(self) -> Any:
        """Return the shape space that coordinates belong to."""
        from bladegen.shapes.shape_space import ShapeSpace

        return ShapeSpace.load(self.space) if self.space else ShapeSpace.bundled()

    def _displacing(self, blade: Any, space: Any, t: Any) -> Any:
        """Return coordinates that move the skin of a blade by the displacement."""
        from bladegen.blade.changes.deformation import Coordinates
        from bladegen.cli.options.parsing import share, span_window

        if t is None or len(t.grid) > 1:
            raise BladegenError(
                f"displacement: got {self.displacement}, scales --pga t1,t2,... without @ETA; "
                "give that"
            )
        return Coordinates.displacing(
            blade,
            space,
            t.values[0],
            share(str(self.displacement), "displacement"),
            window=None if self.window is None else span_window(self.window),
            chord_line=self.chord_line,
        )

    def on_the_skin(self, blade: Any) -> Any:
        """Return wear and dents together, None if there are none."""
        if self.deviation is None and self.deviation_scale != 1:
            raise BladegenError(
                "--deviation-scale: is for a map: add --deviation MAP.csv; --erosion and --dent "
                "have depths of their own"
            )
        if not (self.deviation or self.erosion or self.dent):
            return None
        from bladegen.cli.options.skin import dented, eroded
        from bladegen.fitting.deviations import DeviationMap

        maps = []
        if self.deviation is not None:
            maps.append(self.deviation_scale * DeviationMap.read(self.deviation))
        if self.erosion:
            maps.append(DeviationMap.erosion(blade, **eroded(self.erosion)))
        maps += [DeviationMap.dent(blade, **dented(text)) for text in self.dent or []]
        first, *others = maps
        return sum(others, first)

    def applied(self, blade: Any) -> Any:
        """Return the blade with the changes."""
        from math import radians

        from bladegen.cli.options.knots import over_span
        from bladegen.cli.options.parsing import coordinates, span_window

        t = coordinates(self.pga or [])
        space = None if t is None and self.space is None else self.shape_space()
        if self.displacement is not None:
            t = self._displacing(blade, space, t)
        amounts: dict[str, Any] = {key: float(getattr(self, key)) for key in AFFINE}
        amounts["twist"] = radians(self.twist)
        amounts |= over_span(self.over or [], [key for key in AFFINE if self._moved(key)])
        return blade.perturbed(
            None if t is None else space,
            () if t is None else t,
            **amounts,
            window=None if self.window is None else span_window(self.window),
            chord_line=self.chord_line,
            allow_extrapolation=self.allow_extrapolation,
            allow_odd=self.allow_odd,
            deviation=self.on_the_skin(blade),
            name=self.name or f"{blade.name}-perturbed",
        )


AFFINE = (
    "thickness",
    "camber",
    "chord",
    "twist",
    "chord_scale",
    "twist_scale",
    "prebend_scale",
)
NO_CHANGES = Changes()
