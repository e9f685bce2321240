"""The numbers that sliders set: their bounds, steps and words, and what they are to a blade.

A new slider of an affine parameter is a row of AFFINE and a field of `state.State`.
"""

from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from math import isfinite, radians
from typing import Any

from bladegen.errors import StudioError
from bladegen.shapes.shape_space import ShapeSpace

__all__ = ["AFFINE", "AT", "CONTROLS", "END", "MODES", "START", "Control", "controls"]

SHAPE_STEP = "0.001"
# what the bundled space's modes do to a section of the same relative thickness, upward on a slider
MODES = (
    ("fuller suction side", "Suction side fuller, pressure side flatter: more camber"),
    ("aft loading", "Pressure side more hollow towards the tail, which is thinner"),
    ("fuller front", "Suction side fuller in front, the thickest place forward: less camber"),
    ("sharper nose", "Nose sharper, sides fuller behind it"),
)


@dataclass(frozen=True)
class Control:
    """A number that a slider sets.

    Parameters
    ----------
    name, label, hint : str
        Its field or place in `State`, what people read, and what it does.
    low, high, step, default : Decimal
        Bounds, grid and the value that changes nothing, in `unit`.
    unit : str
        Shown behind the label.
    keyword : str
        What `Blade.perturbed` calls it.
    effect : str
        What it does, in two or three words shown below the label.
    """

    name: str
    label: str
    hint: str
    low: Decimal
    high: Decimal
    step: Decimal
    default: Decimal = Decimal(1)
    unit: str = ""
    keyword: str = ""
    effect: str = ""

    def parsed(self, value: object) -> float:
        """Return a number on the control's grid.

        Raises
        ------
        StudioError
            If it is no number or outside the bounds.
        """
        try:
            number = float(str(value).strip())
        except ValueError:
            number = float("nan")
        if not isfinite(number) or not float(self.low) <= number <= float(self.high):
            raise StudioError(
                f"{self.label.lower()}: got {str(value)[:40]}, allowed is {self.low:f} to "
                f"{self.high:f}{' ' + self.unit if self.unit else ''}"
            )
        steps = round(Decimal(repr(number)) / self.step)
        return float(min(max(steps * self.step, self.low), self.high))

    @property
    def places(self) -> int:
        """Decimals that the step has."""
        return max(0, -int(self.step.normalize().as_tuple().exponent))

    @property
    def option(self) -> str:
        """The option of `bladegen perturb` that does the same."""
        return f"--{self.keyword.replace('_', '-')}"

    def amount(self, state: Any) -> float:
        """Return what the state's value is to `Blade.perturbed`; angles in radians."""
        value = float(getattr(state, self.name))
        return radians(value) if self.unit == "deg" else value

    def moved(self, state: Any) -> bool:
        """Tell whether a state has another value than the default."""
        return bool(getattr(state, self.name) != float(self.default))


def _control(
    name: str, label: str, hint: str, *numbers: str, unit: str = "", keyword: str = ""
) -> Control:
    low, high, step, default = map(Decimal, numbers)
    return Control(name, label, hint, low, high, step, default, unit, keyword or name)


AFFINE = (
    _control("thickness", "Thickness", "Sections thicker or thinner", "0.8", "1.2", "0.01", "1"),
    _control("camber", "Camber", "Chord against thickness", "0.9", "1.1", "0.005", "1"),
    _control("chord", "Chord", "Wider or narrower, as thick", "0.85", "1.15", "0.01", "1"),
    _control("twist", "Twist", "Turns sections", "-5", "5", "0.1", "0", unit="deg"),
    _control(
        "prebend",
        "Prebend",
        "Bends the blade more or less",
        "0",
        "2",
        "0.05",
        "1",
        keyword="prebend_scale",
    ),
)
START = _control("start", "Fade from", "Nothing changes up to this span", "0", "1", "0.01", "0")
END = _control("end", "Fade to", "All changes hold from this span on", "0", "1", "0.01", "0")
AT = _control("at", "Section at", "Span of the section that is shown", "0", "1", "0.01", "0.5")
CONTROLS = {control.name: control for control in (*AFFINE, START, END, AT)}


def controls(space: ShapeSpace) -> dict[str, Control]:
    """Return all controls by name: t1, t2, ... within the space's data, then `CONTROLS`."""
    step = Decimal(SHAPE_STEP)
    shape = {
        f"t{k + 1}": Control(
            f"t{k + 1}",
            f"Shape {k + 1}",
            f"{does}; along principal geodesic {k + 1}",
            (Decimal(float(low)) / step).to_integral_value(ROUND_CEILING) * step,
            (Decimal(float(high)) / step).to_integral_value(ROUND_FLOOR) * step,
            step,
            Decimal(0),
            unit="rad",
            effect=effect,
        )
        for k, (low, high, (effect, does)) in enumerate(
            zip(space.lower, space.upper, MODES, strict=True)
        )
    }
    return shape | CONTROLS
