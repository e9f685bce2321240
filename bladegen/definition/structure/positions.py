"""Places on the outline of a section, by rule: where layers start and end, where webs stand.

A place is a fraction of the arc: 0 at the trailing edge of the suction side, 1 at that of the
pressure side, about 0.5 at the leading edge (windIO's `nd_arc`).  A rule says how it is found on
any section, be it of the blade it was made for or of a perturbed one.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from bladegen.definition.distribution import OVER_SPAN, Distribution
from bladegen.errors import DefinitionError
from bladegen.support.arguments import amount, instance, one_of
from bladegen.support.values import brief

__all__ = [
    "LEADING_EDGE",
    "Arc",
    "Between",
    "EdgeMiddle",
    "LeadingEdge",
    "Limited",
    "PlaneCut",
    "Position",
    "Shifted",
    "around",
    "base_of",
    "extent_of",
    "knots",
]

SIDES = ("suction", "pressure")
FRAMES = ("root", "chord")
MIDDLE = 0.5  # of the arc, about where the leading edge is


@dataclass(frozen=True, repr=False)
class Arc:
    """A fraction of the arc over span; nothing lies outside its grid."""

    fraction: Distribution

    def __post_init__(self) -> None:
        instance(self.fraction, Distribution, "arc: fraction", OVER_SPAN, DefinitionError)

    __repr__ = brief


@dataclass(frozen=True)
class LeadingEdge:
    """The leading edge: the blade's own landmark."""


LEADING_EDGE = LeadingEdge()


@dataclass(frozen=True, repr=False)
class PlaneCut:
    """Where a plane along the blade cuts one side of a section.

    Parameters
    ----------
    side : str
        "suction" or "pressure".
    offset : Distribution
        From the axis toward the trailing edge, normal to the plane [m]; there is no plane outside
        its grid.
    rotation : Distribution, optional
        By which sections are turned about z, right-handed, before they are cut [rad]; 0 if None.
    frame : str
        Whose y is normal to the plane: "root", the blade's, or "chord", that along the chord.
    through : pair of float, optional
        Span fractions of two points of the reference axis, through which the plane without offset
        goes; None: it follows the axis.
    """

    side: str
    offset: Distribution
    rotation: Distribution | None = None
    frame: str = "root"
    through: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        one_of(self.side, SIDES, "plane: side", DefinitionError)
        one_of(self.frame, FRAMES, "plane: frame", DefinitionError)
        instance(self.offset, Distribution, "plane: offset", OVER_SPAN, DefinitionError)

    __repr__ = brief


@dataclass(frozen=True, repr=False)
class Shifted:
    """A place so far from another, toward the pressure side's trailing edge.

    Parameters
    ----------
    base : Position
        The other place.
    width : Distribution
        A length along the skin [m]; 0 outside its grid.
    times : float
        Which share of it lies between: 0.5 and -0.5 are the ends of a strip about its middle.
    """

    base: "Position"
    width: Distribution
    times: float = 1.0

    def __post_init__(self) -> None:
        instance(self.width, Distribution, "shifted: width", OVER_SPAN, DefinitionError)
        amount(self.times, "shifted: times", DefinitionError)

    __repr__ = brief


@dataclass(frozen=True)
class EdgeMiddle:
    """The middle of the trailing edge: beyond its corner on a side by half of its width."""

    side: str

    def __post_init__(self) -> None:
        one_of(self.side, SIDES, "edge: side", DefinitionError)


@dataclass(frozen=True)
class Between:
    """A place at a share of the arc from one place to another."""

    first: "Position"
    last: "Position"
    share: float

    def __post_init__(self) -> None:
        amount(self.share, "between: share", DefinitionError)


@dataclass(frozen=True)
class Limited:
    """A place that goes no farther than two others, whichever of them comes first."""

    base: "Position"
    first: "Position"
    last: "Position"


Position = Arc | LeadingEdge | PlaneCut | Shifted | EdgeMiddle | Between | Limited


def base_of(position: Position) -> Position:
    """Return the place that another one rests on, through all its widths and limits."""
    while isinstance(position, Shifted | Limited):
        position = position.base
    return position


def around(start: Position, end: Position) -> bool:
    """Tell whether what lies between two places lies around the trailing edge.

    It does where it starts on the pressure side and ends on the suction side, both by the arc.
    """
    first, last = base_of(start), base_of(end)
    if not (isinstance(first, Arc) and isinstance(last, Arc)):
        return False
    return bool(first.fraction.values.min() > MIDDLE > last.fraction.values.max())


def extent_of(*positions: Position) -> tuple[float, float]:
    """Return the span fractions between which all of some places are known."""
    low, high = 0.0, 1.0
    for position in positions:
        for base in _rests_on(position):
            if isinstance(base, Arc | PlaneCut):
                grid = (base.fraction if isinstance(base, Arc) else base.offset).grid
                low, high = max(low, float(grid[0])), min(high, float(grid[-1]))
    return low, high


def knots(position: Position) -> tuple[float, ...]:
    """Return the span fractions at which a place, or a width that leads to it, starts or ends."""
    found: tuple[float, ...] = extent_of(position)
    for part in _rests_on(position):
        if isinstance(part, Shifted):
            found += float(part.width.grid[0]), float(part.width.grid[-1])
    return found


def _rests_on(position: Position) -> Iterator[Position]:
    """Yield a place and all places that it rests on."""
    yield position
    for name in ("base", "first", "last"):
        if isinstance(part := getattr(position, name, None), Position):
            yield from _rests_on(part)
