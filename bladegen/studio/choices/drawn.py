"""Chord, twist and prebend as they were dragged: what is added to each at knots over span.

A `Drawn` holds a factor of the chord, degrees of twist and metres of prebend at `KNOTS`; at the
root each is the identity.  Between knots they are a `Distribution`, as in commands and scripts.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from bladegen.definition.distribution import Distribution
from bladegen.errors import StudioError

__all__ = ["CURVES", "KNOTS", "UNDRAWN", "Drawn"]

KNOTS = (0.2, 0.4, 0.6, 0.8, 1.0)


class Curve(NamedTuple):
    """How far a curve may be dragged, in which steps, and what leaves it as it is."""

    low: float
    high: float
    places: int
    identity: float


CURVES = {
    "chord": Curve(0.5, 1.5, 3, 1.0),
    "twist": Curve(-10.0, 10.0, 2, 0.0),
    "prebend": Curve(-15.0, 15.0, 2, 0.0),
}


@dataclass(frozen=True)
class Drawn:
    """What was dragged of each curve, at `KNOTS`; nothing where it is empty."""

    chord: tuple[float, ...] = ()
    twist: tuple[float, ...] = ()
    prebend: tuple[float, ...] = ()

    def values(self, name: str) -> tuple[float, ...]:
        """Return what a curve has at the knots."""
        values: tuple[float, ...] = getattr(self, name)
        return values or (CURVES[name].identity,) * len(KNOTS)

    def having(self, name: str, knot: int, value: float) -> "Drawn":
        """Return it with one knot dragged, as far as that is allowed."""
        curve, values = CURVES[name], list(self.values(name))
        values[knot] = round(min(max(value, curve.low), curve.high), curve.places)
        moved = any(one != curve.identity for one in values)
        return replace(self, **{name: tuple(values) if moved else ()})

    def over_span(self, name: str, base: float) -> Distribution | None:
        """Return what a curve and a slider's `base` ask for together; None if it was not dragged.

        Factors are multiplied, and what is added is summed; in the curve's own unit.
        """
        if not getattr(self, name):
            return None
        curve = CURVES[name]
        at = np.array([curve.identity, *self.values(name)])
        together = at * base if curve.identity else at + base
        return Distribution(np.array([0.0, *KNOTS]), together)

    @classmethod
    def parsed(cls, name: str, text: str, before: "Drawn") -> "Drawn":
        """Return `before` with a curve as a link holds it."""
        curve = CURVES[name]
        try:
            values = [float(word) for word in text.split(",")]
        except ValueError:
            values = []
        if len(values) != len(KNOTS) or not all(curve.low <= v <= curve.high for v in values):
            raise StudioError(
                f"link: over.{name}: got {text[:60]!r}, must be {len(KNOTS)} numbers from "
                f"{curve.low:g} to {curve.high:g}"
            )
        for knot, value in enumerate(values):
            before = before.having(name, knot, value)
        return before


UNDRAWN = Drawn()
