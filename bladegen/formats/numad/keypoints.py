"""NuMAD's key points of a section as places: le, a, b, c, d and te of the low and high pressure.

Along each side, from the leading edge to the corner of the trailing edge: a ends the band of the
leading edge, b and c are the ends of the spar cap, d begins the band of the trailing edge, which
is counted from the middle of that edge.  The cap lies about the place where a plane through the
pitch axis cuts the side: along the blade, normal to y, or, with swept twist, normal to the chord.
Each is held within shares of the side (NuMAD's BladeDef.updateKeypoints, pyNuMAD's KeyPoints).
"""

from dataclasses import dataclass

from bladegen.definition.distribution import Distribution
from bladegen.definition.structure.positions import (
    LEADING_EDGE,
    Arc,
    Between,
    EdgeMiddle,
    Limited,
    PlaneCut,
    Position,
    Shifted,
)

__all__ = ["LABELS", "SIDES", "Widths", "places"]

LABELS = ("le", "a", "b", "c", "d", "te")  # e depends on what shape the trailing edge has
SIDES = {"HP": "pressure", "LP": "suction"}
BAND = (0.01, 0.1)  # of the side's arc from the leading edge, between which a is
CAP = (0.15, 0.8)  # the least of b and the most of c
REAR = {"HP": (0.85, 0.98), "LP": (0.85, 0.96)}  # between which d is


@dataclass(frozen=True)
class Widths:
    """Widths [m] of a workbook; those of caps by side, and how far they are behind the plane."""

    leading_band: float
    trailing_band: float
    cap: dict[str, float]
    cap_offset: dict[str, float]


def places(side: str, widths: Widths, frame: str) -> dict[str, Position]:
    """Return the key points of a side, "HP" or "LP", by their labels.

    `frame` is that of the plane of the spar caps: "root" or "chord".
    """
    toward = 1.0 if side == "HP" else -1.0  # along the arc, to the trailing edge
    corner = Arc(Distribution.constant(1.0 if side == "HP" else 0.0))
    plane = PlaneCut(SIDES[side], Distribution.constant(0.0), frame=frame)

    def within(place: Position, least: float, most: float) -> Position:
        first, last = (
            LEADING_EDGE if share == 0.0 else corner if share == 1.0 else _share(corner, share)
            for share in (least, most)
        )
        return Limited(place, first, last)

    def beside(base: Position, behind: float) -> Position:
        return Shifted(base, Distribution.constant(abs(behind)), toward if behind > 0 else -toward)

    half, offset = 0.5 * widths.cap[side], widths.cap_offset[side]
    return {
        "le": LEADING_EDGE,
        "a": within(beside(LEADING_EDGE, widths.leading_band), *BAND),
        "b": within(beside(plane, offset - half), CAP[0], 1.0),
        "c": within(beside(plane, offset + half), 0.0, CAP[1]),
        "d": within(beside(EdgeMiddle(SIDES[side]), -widths.trailing_band), *REAR[side]),
        "te": corner,
    }


def _share(corner: Position, share: float) -> Position:
    return Between(LEADING_EDGE, corner, share)
