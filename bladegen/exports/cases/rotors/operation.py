"""How a rotor works: wind, speed and pitch, those of its design where nothing is given.

Below its rated speed a rotor turns at its design tip speed ratio, above at its rated speed, as
`bladegen evaluate` has it; without a wind it works where both hold.  Speeds in m/s and rad/s,
angles in radians.
"""

from dataclasses import dataclass
from math import degrees, hypot, pi, radians

from bladegen.blade.blade import Blade
from bladegen.definition.estimates import AIR
from bladegen.errors import GeometryError, visible
from bladegen.support.arguments import require_within

__all__ = ["DENSITY", "REFERENCE", "Operation", "operation_of"]

DENSITY = 1.225  # kg/m3, of air at 15 degrees C at sea level
REFERENCE = 0.75  # span fraction that stands for the blade
RATIOS = (1.0, 20.0)
WINDS = (0.5, 60.0)  # m/s
STEEPEST = 95.0  # degrees of pitch
FASTEST = 150.0  # m/s; flow that is not compressed
TURN = 2.0 * pi / 60.0  # rad/s of a turn a minute


@dataclass(frozen=True)
class Operation:
    """A rotor in steady wind along its axis.

    Parameters
    ----------
    wind : float
        [m/s].
    speed : float
        Of the rotor [rad/s].
    pitch : float
        Toward feather [rad].
    radius : float
        Of the tip [m].
    chord, reach : float
        Of the section that stands for the blade, and its distance from the axis [m].
    told : str
        What is from the definition, in words.
    """

    wind: float
    speed: float
    pitch: float
    radius: float
    chord: float
    reach: float
    told: str = ""

    def __post_init__(self) -> None:
        steep = -STEEPEST, STEEPEST
        require_within(self.wind, "wind", WINDS, GeometryError, " m/s")
        require_within(self.ratio, "tip speed ratio", RATIOS, GeometryError)
        require_within(self.tip_speed, "tip speed", (0.0, FASTEST), GeometryError, " m/s")
        require_within(degrees(self.pitch), "pitch", steep, GeometryError, " degrees")

    @property
    def tip_speed(self) -> float:
        """[m/s]."""
        return self.speed * self.radius

    @property
    def ratio(self) -> float:
        """Tip speed over wind."""
        return self.tip_speed / self.wind

    @property
    def section_speed(self) -> float:
        """Of the air past the section that stands for the blade, not slowed down [m/s]."""
        return hypot(self.wind, self.speed * self.reach)

    @property
    def reynolds(self) -> float:
        """Of that section's chord."""
        return self.section_speed * self.chord / AIR

    @property
    def force(self) -> float:
        """Of the wind on the rotor's disc, 1/2 rho U^2 pi R^2 [N]."""
        return 0.5 * DENSITY * self.wind**2 * pi * self.radius**2


def operation_of(
    blade: Blade,
    radius: float,
    reach: float,
    *,
    wind: float | None = None,
    ratio: float | None = None,
    turns: float | None = None,
    pitch: float | None = None,
) -> Operation:
    """Return how a rotor works: what is given, and what its definition says where nothing is.

    Parameters
    ----------
    blade : Blade
        Its rotor's facts are asked for rated speed, design tip speed ratio and fine pitch.
    radius, reach : float
        Of the tip, and of the section that stands for the blade [m].
    wind : float, optional
        [m/s].
    ratio : float, optional
        Tip speed over wind.
    turns : float, optional
        A minute.
    pitch : float, optional
        Toward feather [rad].

    Raises
    ------
    GeometryError
        If a value is out of range, is missing, or all three of wind, ratio and turns are given.
    """
    facts = blade.definition.rotor
    told = []
    if None not in (wind, ratio, turns):
        raise GeometryError(
            "wind, tip speed ratio and rotor speed: two of them make the third; leave one out"
        )
    for name, value in (("wind", wind), ("tip speed ratio", ratio), ("rotor speed", turns)):
        if value is not None and not value > 0.0:
            raise GeometryError(f"{name}: got {value:g}, must be positive")
    speed = None if turns is None else turns * TURN
    if ratio is None and (wind is None or speed is None):
        ratio = facts.design_ratio
        if ratio is None:
            alone = facts.speed is None and wind is None and speed is None
            raise GeometryError(_unnamed(blade.name, *(["rotor speed"] if alone else [])))
        told.append(f"tip speed ratio {ratio:.3g}")
    if speed is None:
        rated = facts.speed
        if wind is not None and ratio is not None:
            speed = ratio * wind / radius
            if told and rated is not None and rated < speed:
                speed, told = rated, [f"rated speed {rated / TURN:.4g} 1/min"]
        elif rated is None:
            raise GeometryError(
                f"{visible(blade.name)}: its file names no rotor speed; give one, --rotor-speed "
                "9.6 a minute, or a wind, --wind 10"
            )
        else:
            speed = rated
            told.append(f"rated speed {rated / TURN:.4g} 1/min")
    if wind is None:
        assert ratio is not None
        wind = speed * radius / ratio
    if pitch is None:
        fine = facts.fact("control.fine_pitch")
        pitch = radians(fine or 0.0)
        told.append("zero pitch" if fine is None else f"fine pitch {fine:g} degrees")
    chord = float(blade.chord(REFERENCE))
    return Operation(wind, speed, pitch, radius, chord, reach, ", ".join(told))


def _unnamed(name: str, *besides: str) -> str:
    """Say that a file names no tip speed ratio, nor what else is missing, and what to give."""
    lost = " and no ".join(["tip speed ratio", *besides])
    give = "them: --tip-speed-ratio 8 --rotor-speed 9.6" if besides else "one: --tip-speed-ratio 8"
    return f"{visible(name)}: its file names no {lost}; give {give}"
