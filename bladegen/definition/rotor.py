"""What a file says of the rotor around a blade."""

from dataclasses import dataclass
from math import pi

from bladegen.errors import DefinitionError
from bladegen.support.arguments import amount
from bladegen.support.values import brief

__all__ = ["Rotor"]


@dataclass(frozen=True, repr=False)
class Rotor:
    """What a file says of the rotor around the blade; nothing here shapes the blade.

    `facts` are kept for other tools, by their path in windIO 2 and in its units.
    """

    blades: int = 3
    hub_radius: float | None = None
    diameter: float | None = None
    cone: float | None = None
    tilt: float | None = None
    hub_drag: float | None = None
    facts: tuple[tuple[str, str | float], ...] = ()

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is not None and name != "facts":
                amount(value, f"rotor: {name}", DefinitionError)

    __repr__ = brief

    def fact(self, *places: str) -> float | None:
        """Return the first of some facts that is a number, None if none is."""
        known = dict(self.facts)
        found = (known[place] for place in places if isinstance(known.get(place), int | float))
        return next((float(value) for value in found), None)

    @property
    def speed(self) -> float | None:
        """The rated speed [rad/s], else the largest, None where a file names none."""
        turns = self.fact("control.rated_rotor_speed", "control.max_rotor_speed")  # 1/min
        return turns * pi / 30.0 if turns is not None and turns > 0.0 else None

    @property
    def design_ratio(self) -> float | None:
        """The tip speed ratio below rated speed, None where a file names none."""
        ratio = self.fact("control.optimal_tsr")
        return ratio if ratio is not None and ratio > 0.0 else None
