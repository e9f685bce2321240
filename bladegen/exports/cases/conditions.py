"""What flows around a section: speed, Reynolds number, angle of attack, turbulence of the stream.

Without figures of the user's, those of a rotor at its rated speed and best tip speed ratio, as far
as its file names them: the wind is slowed down by a third, as Betz has it, the swirl is left out,
the blade stands at zero pitch.  Speeds in m/s, angles in radians.
"""

from dataclasses import dataclass
from functools import cached_property
from math import atan2, degrees, hypot, radians

from bladegen.blade.blade import Blade
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.estimates import AIR, TIP_SPEED
from bladegen.errors import GeometryError
from bladegen.support.arguments import require_within
from bladegen.surface.wall_spacing import REYNOLDS

__all__ = ["INDUCTION", "Conditions", "flow_at"]

TIP_SPEED_RATIO = 8.0  # where a file names none
INDUCTION = 1.0 / 3.0  # of the wind's speed, at the most power: Betz
STEEPEST = radians(25.0)  # of angles of attack
STALLED = radians(12.0)  # beyond it most sections' flow is not steady
SLOWEST, FASTEST = 0.01, 150.0  # m/s; flow that is not compressed
# of the stream far away: F. R. Menter, AIAA J. 32 (1994), 1598-1605, "1 to 10" speeds over length
# for omega and 10^-2 to 10^-5 of the viscosity for the eddies'
OMEGA = 5.0
EDDY = 1e-2


@dataclass(frozen=True)
class Conditions:
    """What flows around a section of a chord.

    Parameters
    ----------
    chord : float
        [m].
    speed : float
        Of the air, far away and relative to the section [m/s].
    reynolds : float
        Of chord and speed.
    alpha : float
        Angle of attack from the chord line [rad].
    told : str
        Where speed and angle are from, in words.
    """

    chord: float
    speed: float
    reynolds: float
    alpha: float
    told: str = ""

    def __post_init__(self) -> None:
        steep = degrees(STEEPEST)
        require_within(self.speed, "speed", (SLOWEST, FASTEST), GeometryError, " m/s")
        require_within(self.reynolds, "reynolds", REYNOLDS, GeometryError)
        require_within(degrees(self.alpha), "alpha", (-steep, steep), GeometryError, " degrees")

    @property
    def viscosity(self) -> float:
        """The kinematic viscosity that makes the Reynolds number [m2/s]."""
        return self.speed * self.chord / self.reynolds

    @cached_property
    def omega(self) -> float:
        """Specific dissipation rate of the stream [1/s]."""
        return OMEGA * self.speed / self.chord

    @cached_property
    def kinetic(self) -> float:
        """Kinetic energy of the stream's turbulence [m2/s2]."""
        return EDDY * self.viscosity * self.omega

    @property
    def is_stalled(self) -> bool:
        """Whether a steady solution is not to be expected."""
        return abs(self.alpha) > STALLED


def flow_at(
    blade: Blade,
    eta: float,
    *,
    speed: float | None = None,
    reynolds: float | None = None,
    alpha: float | None = None,
) -> Conditions:
    """Return what flows around a blade's section: what is given, and a rotor's where it is not.

    Parameters
    ----------
    blade : Blade
        Its rotor's facts are asked for rated speed and tip speed ratio.
    eta : float
        Span fraction.
    speed : float, optional
        Of the air relative to the section [m/s].
    reynolds : float, optional
        That of air at 15 degrees C if not given; else the viscosity is what makes it.
    alpha : float, optional
        Angle of attack from the chord line [rad].

    Raises
    ------
    GeometryError
        If a value is out of range.
    """
    rotor = _Rotor.of(blade.definition)
    axial, tangential = rotor.wind * (1.0 - INDUCTION), rotor.tip_speed * rotor.ratio(eta)
    told = []
    if speed is None:
        speed = hypot(axial, tangential)
        told.append("speed")
    if alpha is None:
        alpha = atan2(axial, tangential) - float(blade.twist(eta))
        told.append("angle")
        if abs(alpha) > STEEPEST:
            raise GeometryError(
                f"alpha: at eta = {eta:g} {rotor.told} makes {degrees(alpha):.1f} degrees, allowed "
                f"is up to {degrees(STEEPEST):g}; give one (--alpha 4), or a section farther out"
            )
    chord = float(blade.chord(eta))
    number = speed * chord / AIR if reynolds is None else reynolds
    said = f"{' and '.join(told)}: {rotor.told}" if told else ""
    return Conditions(chord, speed, number, alpha, said)


@dataclass(frozen=True)
class _Rotor:
    """A rotor in its wind: speed of the tip and of the wind [m/s], and where they are from."""

    tip_speed: float
    wind: float
    told: str
    hub: float
    length: float

    @classmethod
    def of(cls, definition: BladeDefinition) -> "_Rotor":
        hub = definition.rotor.hub_radius or 0.0
        speed, best = definition.rotor.speed, definition.rotor.design_ratio
        tip = TIP_SPEED if speed is None else speed * (hub + definition.length)
        ratio = TIP_SPEED_RATIO if best is None else best
        said = (
            f"a tip speed of {tip:.1f} m/s ({'assumed' if speed is None else 'rated'}) and a tip "
            f"speed ratio of {ratio:.2f} ({'assumed' if best is None else 'the best of the file'})"
        )
        return cls(tip, tip / ratio, said, hub, definition.length)

    def ratio(self, eta: float) -> float:
        """Return the radius at a span fraction over the tip's."""
        return (self.hub + eta * self.length) / (self.hub + self.length)
