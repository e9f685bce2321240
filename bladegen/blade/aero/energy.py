"""Annual energy: a power curve met by winds of a Weibull distribution.

The rotor turns at its optimum tip speed ratio up to its largest tip speed, with which it then goes
on; above the rated power it is pitched to hold that.  Neither a least rotor speed nor losses of
wakes and stops are counted.
"""

from dataclasses import asdict, dataclass, fields
from math import gamma

import numpy as np

from bladegen.definition.blade_definition import Rotor
from bladegen.definition.estimates import TIP_SPEED
from bladegen.errors import BladegenError
from bladegen.support.arguments import amount
from bladegen.support.arrays import Array

__all__ = ["HOURS", "Conditions", "annual_energy", "weibull_shares"]

HOURS = 8760.0  # of a year
CLASSES = {"I": 10.0, "II": 8.5, "III": 7.5}  # m/s, yearly means of IEC 61400-1
UNITS = {
    "tip_speed": "m_s",
    "rated_power": "W",
    "mean_wind": "m_s",
    "air_density": "kg_m3",
    "cut_in": "m_s",
    "cut_out": "m_s",
}
MOST = {  # beyond which a figure has a slip in it, such as watts for megawatts
    "tip_speed": 340.0,
    "rated_power": 1e9,
    "mean_wind": 50.0,
    "weibull_shape": 20.0,
    "air_density": 10.0,
    "cut_in": 100.0,
    "cut_out": 100.0,
    "efficiency": 1.0,
}
WIND_STEP = 0.25  # m/s, of power curves


@dataclass(frozen=True)
class Conditions:
    """Under which a rotor works.

    Parameters
    ----------
    tip_speed : float
        The largest [m/s]; it gives the Reynolds numbers, too.
    rated_power : float, optional
        [W]; without it there is no annual energy.
    mean_wind : float
        Over a year, at the hub [m/s].
    weibull_shape : float
        2 is Rayleigh's distribution.
    air_density : float
        [kg/m3].
    cut_in, cut_out : float
        [m/s].
    efficiency : float
        Of drive train and generator.
    """

    tip_speed: float = TIP_SPEED
    rated_power: float | None = None
    mean_wind: float = 8.5
    weibull_shape: float = 2.0
    air_density: float = 1.225
    cut_in: float = 3.0
    cut_out: float = 25.0
    efficiency: float = 1.0

    def __post_init__(self) -> None:
        for entry in fields(self):
            value = getattr(self, entry.name)
            if entry.name == "rated_power" and value is None:
                continue
            if not amount(value, entry.name, BladegenError) > 0.0:
                raise BladegenError(f"{entry.name}: got {value:g}, must be positive")
            if value > MOST[entry.name]:
                raise BladegenError(_too_large(entry.name, value))
        if self.cut_out <= self.cut_in:
            raise BladegenError(
                f"cut_out: got {self.cut_out:g} m/s, must be above cut_in, {self.cut_in:g} m/s"
            )

    @classmethod
    def of(cls, rotor: Rotor, tip_radius: float, **given: float | None) -> "Conditions":
        """Return the conditions that a file names, with what is given instead of them.

        The tip speed is that of the rated rotor speed, else of the largest, else `TIP_SPEED`;
        the mean wind that of the turbine's class (IEC 61400-1).
        """
        turbine_class = dict(rotor.facts).get("assembly.turbine_class", "")
        wanted: dict[str, float | None] = {
            "tip_speed": None if rotor.speed is None else rotor.speed * tip_radius,
            "rated_power": rotor.fact("assembly.rated_power", "control.rated_power"),
            "mean_wind": CLASSES.get(str(turbine_class)),
            "cut_in": rotor.fact("assembly.cut_in_wind_speed"),
            "cut_out": rotor.fact("assembly.cut_out_wind_speed"),
        }
        wanted |= {name: value for name, value in given.items() if value is not None}
        return cls(**{name: value for name, value in wanted.items() if value is not None})

    @property
    def named(self) -> dict[str, float | None]:
        """The conditions by names that hold their units."""
        return {
            f"{name}_{UNITS[name]}" if name in UNITS else name: value
            for name, value in asdict(self).items()
        }

    @property
    def winds(self) -> Array:
        """Wind speeds from cut-in to cut-out (m,), about `WIND_STEP` apart."""
        count = max(2, round((self.cut_out - self.cut_in) / WIND_STEP) + 1)
        return np.linspace(self.cut_in, self.cut_out, count)


def _too_large(name: str, value: float) -> str:
    """Return what is wrong with a condition that is larger than any rotor's."""
    if name == "rated_power":
        return (
            f"rated_power: got {value / 1e6:g} MW, allowed is up to {MOST[name] / 1e6:g} MW; "
            "--rated-power is in MW, such as 15, Conditions and files have it in W"
        )
    unit = {"m_s": " m/s", "kg_m3": " kg/m3"}.get(UNITS.get(name, ""), "")
    return f"{name}: got {value:g}{unit}, allowed is up to {MOST[name]:g}{unit}"


def weibull_shares(winds: Array, mean: float, shape: float) -> Array:
    """Return the share of the time (m - 1,) between successive wind speeds (m,)."""
    scale = mean / gamma(1.0 + 1.0 / shape)
    shares: Array = -np.diff(np.exp(-((winds / scale) ** shape)))
    return shares


def annual_energy(winds: Array, power: Array, mean: float, shape: float) -> Array:
    """Return the energy of a year (...) [J] of power curves (..., m) [W], straight in between."""
    between = 0.5 * (power[..., 1:] + power[..., :-1])
    return np.asarray(3600.0 * HOURS * (between @ weibull_shares(winds, mean, shape)))
