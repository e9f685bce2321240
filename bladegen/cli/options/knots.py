"""Parameters of `perturb` with knots over span, from texts like ``twist=0@0.3,-2@0.7,-1@1``."""

from collections.abc import Sequence

import numpy as np

from bladegen.definition.distribution import Distribution
from bladegen.errors import BladegenError, DefinitionError

__all__ = ["over_span"]

NAMES = ("thickness", "camber", "chord", "twist", "prebend")


def over_span(texts: Sequence[str], given: Sequence[str] = ()) -> dict[str, Distribution]:
    """Return distributions by name, twist in radians; `given` are told by options of their own.

    Raises
    ------
    BladegenError
        If a text is of another form, names nothing that is known, or something twice.

    >>> over_span(["chord=1@0.2,1.05@1"])["chord"].values
    array([1.  , 1.05])
    """
    found: dict[str, Distribution] = {}
    for text in texts:
        name, _, knots = text.partition("=")
        if name not in NAMES:
            raise BladegenError(
                f"over: got {text!r}, must be NAME=VALUE@ETA,... with one of {', '.join(NAMES)}, "
                "such as twist=0@0.3,-2@0.7,-1@1"
            )
        if name in found or name in given:
            raise BladegenError(f"over: {name} is given twice; put all of it into one --over")
        found[name] = _distribution(name, knots)
    return found


def _distribution(name: str, knots: str) -> Distribution:
    try:
        pairs = sorted(tuple(map(float, knot.split("@")))[::-1] for knot in knots.split(","))
        eta, values = np.array(pairs, dtype=np.float64).T
    except ValueError:
        raise BladegenError(
            f"over: {name}: got {knots!r}, must be values with their span fractions, such as "
            f"{name}=1@0.3,1.02@0.7,1@1"
        ) from None
    try:
        return Distribution(eta, np.radians(values) if name == "twist" else values)
    except DefinitionError as error:
        raise BladegenError(f"over: {name}: {error}") from None
