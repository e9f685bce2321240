"""Blade definitions: airfoils at stations and distributions over span, as a file gives them.

Everything is in metres and radians, in the blade frame (origin at the root on the pitch
axis, x to the suction side, y to the trailing edge, z to the tip).  Span is `eta` in
[0, 1], root to tip: the nondimensional grid of the file, whatever it measures there, since
the reference axis is given on the same grid.  Layout and names follow windIO.
"""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from bladegen.airfoils.polars import Polar
from bladegen.definition.distribution import (
    OVER_SPAN,
    SMALLEST_STEP,
    Distribution,
    Interpolant,
    pchip,
    united,
)
from bladegen.definition.reference_axis import ReferenceAxis
from bladegen.definition.rotor import Rotor
from bladegen.definition.structure.structure import Structure
from bladegen.errors import DefinitionError, Finding, visible
from bladegen.support.arguments import instance, numbers, shown
from bladegen.support.arrays import Array, ArrayLike, readonly
from bladegen.support.services import shown_by
from bladegen.support.values import equal, hashed

__all__ = [
    "SMALLEST_RISE",
    "SMALLEST_STEP",
    "Airfoil",
    "BladeDefinition",
    "Distribution",
    "Interpolant",
    "ReferenceAxis",
    "Rotor",
    "Station",
    "pchip",
    "united",
]

MIN_AIRFOIL_POINTS = 3
ROUND = 0.02  # of the chord; an airfoil nearer to its circle than this is round
SMALLEST_SIZE = 1e-6  # m of a chord, chords of a thickness; a tip may run out to a point, all but
SMALLEST_RISE = 1e-9  # m, of the axis' z from one grid point to the next
THICKNESS_RIPPLE = 1e-4  # published curves ripple by 1e-5 about the thinnest airfoil (DTU 10 MW)
STATIONS = "a tuple of bladegen.Station"
QUANTITIES = (
    "chord",
    "twist",
    "section_offset_y",
    "pitch_axis",
    "section_offset_x",
    "relative_thickness",
)
MAX_AIRFOIL_POINTS = 5_000  # far above any published airfoil (399); bounds time and memory


@dataclass(frozen=True, eq=False, repr=False)
class Airfoil:
    """A closed or open airfoil contour, as its file gives it.

    Parameters
    ----------
    name : str
        The airfoil's name; free text, never used as a path.
    coordinates : (m, 2) array
        Points in chords, trailing edge -> leading edge -> trailing edge, either side first.
    relative_thickness : float, optional
        Nominal thickness over chord, as the file states it.
    polars : tuple of Polar
        What is known of its aerodynamics; it shapes nothing.
    aerodynamic_center : float, optional
        Where polars are taken about, from the leading edge over the chord.
    """

    name: str
    coordinates: Array
    relative_thickness: float | None = None
    polars: tuple[Polar, ...] = ()
    aerodynamic_center: float | None = None

    def __post_init__(self) -> None:
        instance(self.name, str, "airfoil: name", "a text", DefinitionError)
        what = f"airfoil {self.name!r}: coordinates"
        points = readonly(numbers(self.coordinates, what, DefinitionError, "rows of x and y"))
        if points.ndim != 2 or points.shape[1] != 2:
            raise DefinitionError(
                f"airfoil {self.name!r}: coordinates must be rows of x and y, got shape "
                f"{points.shape}"
            )
        if not MIN_AIRFOIL_POINTS <= len(points) <= MAX_AIRFOIL_POINTS:
            raise DefinitionError(
                f"airfoil {self.name!r}: {len(points)} points, allowed are "
                f"{MIN_AIRFOIL_POINTS} to {MAX_AIRFOIL_POINTS}"
            )
        if not np.isfinite(points).all():
            row = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
            raise DefinitionError(
                f"airfoil {self.name!r}: point {row} is {tuple(points[row].tolist())}, "
                "must be finite"
            )
        object.__setattr__(self, "coordinates", points)

    __eq__ = equal
    __hash__ = hashed

    @cached_property
    def is_round(self) -> bool:
        """Whether it is a circle, whole or cut open at its edge."""
        low, high = self.coordinates.min(axis=0), self.coordinates.max(axis=0)
        size = float(np.max(high - low))
        radius = np.linalg.norm(self.coordinates - 0.5 * (low + high), axis=1)
        return bool(np.all(np.abs(radius - 0.5 * size) < ROUND * size))

    def __repr__(self) -> str:
        thick = self.relative_thickness
        said = "" if thick is None else f", {100.0 * thick:.4g} % thick"
        polars = f", {len(self.polars)} polars" if self.polars else ""
        return f"<Airfoil {visible(self.name)}: {len(self.coordinates)} points{said}{polars}>"


@dataclass(frozen=True, repr=False)
class Station:
    """An airfoil at a span fraction."""

    eta: float
    airfoil: Airfoil

    def __post_init__(self) -> None:
        if numbers(self.eta, "station: eta", DefinitionError, "a span fraction").ndim:
            raise DefinitionError(f"station: eta: got {shown(self.eta)}, must be a span fraction")
        instance(self.airfoil, Airfoil, "station: airfoil", "a bladegen.Airfoil", DefinitionError)

    def __repr__(self) -> str:
        return f"<Station at eta = {self.eta:.4g}: {self.airfoil!r}>"


@dataclass(frozen=True, repr=False)
class BladeDefinition:
    """A blade as its designer defines it: airfoils at stations, distributions over span.

    Parameters
    ----------
    name : str
        Short name; free text, made safe before it becomes part of a file name.
    stations : tuple of Station
        At least two, at strictly increasing span fractions.
    chord : Distribution
        Chord [m], positive.
    twist : Distribution
        Twist [rad]; positive moves the leading edge upwind.
    axis : ReferenceAxis
        The reference axis [m]; z increases.
    section_offset_y : Distribution, optional
        Leading edge to reference axis along the chord [m] (windIO 2).
    pitch_axis : Distribution, optional
        The same as a fraction of the chord (windIO 1); exactly one of both is given.
    section_offset_x : Distribution, optional
        Axis offset normal to the chord, positive toward the suction side [m] (windIO 2).
    relative_thickness : Distribution, optional
        Thickness over chord; where given it rules between stations.
    rotor : Rotor
        Facts on the rotor.
    structure : Structure, optional
        Webs, layers and materials inside the skin; they shape nothing.
    description, source, format : str
        Free text; the file it was read from, and in which format that is.
    findings : tuple of Finding
        What was mended or looks odd.
    """

    name: str
    stations: tuple[Station, ...]
    chord: Distribution
    twist: Distribution
    axis: ReferenceAxis
    section_offset_y: Distribution | None = None
    pitch_axis: Distribution | None = None
    section_offset_x: Distribution | None = None
    relative_thickness: Distribution | None = None
    rotor: Rotor = field(default_factory=Rotor)
    structure: Structure | None = None
    description: str = ""
    source: str = ""
    format: str = ""
    findings: tuple[Finding, ...] = ()

    def __post_init__(self) -> None:
        self._require_kinds()
        object.__setattr__(self, "stations", tuple(self.stations))
        etas = [station.eta for station in self.stations]
        if len(etas) < 2:
            raise DefinitionError(f"{self.name}: {len(etas)} stations, at least 2 are needed")
        rising = bool(np.all(np.diff(etas) >= SMALLEST_STEP))
        if not (etas[0] >= 0 and etas[-1] <= 1 and rising):
            raise DefinitionError(
                f"{self.name}: stations must increase strictly within 0 to 1, got "
                + ", ".join(f"{eta:g}" for eta in etas)
            )
        if (self.section_offset_y is None) == (self.pitch_axis is None):
            raise DefinitionError(
                f"{self.name}: exactly one of section_offset_y and pitch_axis must be given"
            )
        self._require_positive("chord", self.chord, "m")
        if self.relative_thickness is not None:
            self._require_positive("relative_thickness", self.relative_thickness, "of chord")
        z = self.axis.z
        level = np.flatnonzero(np.diff(z.values) < SMALLEST_RISE)
        if level.size:
            i = int(level[0])
            raise DefinitionError(
                f"{self.name}: reference axis z must increase from root to tip, got "
                f"{z.values[i]:g} then {z.values[i + 1]:g} m at eta = {z.grid[i]:g} and "
                f"{z.grid[i + 1]:g}"
            )

    def __repr__(self) -> str:
        airfoils = {station.airfoil.name for station in self.stations}
        source = f", {visible(self.format)}" if self.format else ""
        return (
            f"<BladeDefinition {visible(self.name)}: {self.length:.1f} m, {len(self.stations)} "
            f"stations, {len(airfoils)} airfoils{source}>"
        )

    _repr_html_ = shown_by("definition_html")

    def _require_kinds(self) -> None:
        instance(self.name, str, "name", "a text", DefinitionError)
        instance(self.stations, (tuple, list), f"{self.name}: stations", STATIONS, DefinitionError)
        for station in self.stations:
            instance(station, Station, f"{self.name}: stations", STATIONS, DefinitionError)
        for name in QUANTITIES:
            value = getattr(self, name)
            if value is not None or name in ("chord", "twist"):
                instance(value, Distribution, f"{self.name}: {name}", OVER_SPAN, DefinitionError)
        for name, kind in (("axis", ReferenceAxis), ("rotor", Rotor)):
            must = f"a bladegen.{kind.__name__}"
            instance(getattr(self, name), kind, f"{self.name}: {name}", must, DefinitionError)
        if self.structure is not None:
            must = "a bladegen.Structure or None"
            field = f"{self.name}: structure"
            instance(self.structure, Structure, field, must, DefinitionError)

    def _require_positive(self, field: str, quantity: Distribution, unit: str) -> None:
        bad = np.flatnonzero(quantity.values < SMALLEST_SIZE)
        if bad.size:
            i = int(bad[0])
            raise DefinitionError(
                f"{self.name}: {field} must be positive, at least {SMALLEST_SIZE:g} {unit}, got "
                f"{quantity.values[i]:g} at eta = {quantity.grid[i]:g} (entry {i})"
            )

    def offset_y(self, eta: ArrayLike) -> Array:
        """Return the distance from leading edge to reference axis along the chord [m]."""
        if self.section_offset_y is not None:
            return self.section_offset_y(eta)
        assert self.pitch_axis is not None  # __post_init__ saw to it
        return self.pitch_axis(eta) * self.chord(eta)

    def offset_x(self, eta: ArrayLike) -> Array:
        """Return the axis offset normal to the chord, positive toward suction [m]."""
        if self.section_offset_x is None:
            return np.zeros(np.shape(eta))
        return self.section_offset_x(eta)

    @property
    def length(self) -> float:
        """Blade length along z, root to tip [m]."""
        return float(self.axis.z(1.0) - self.axis.z(0.0))
