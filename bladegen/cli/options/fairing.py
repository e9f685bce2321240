"""How far fairing may move what is given, as it is typed: airfoils and the planform."""

import re

from bladegen.cli.options.parsing import radians
from bladegen.definition.fair_planform import PlanformFairing
from bladegen.errors import BladegenError

__all__ = ["chord_share", "planform_fairing"]

_BOUNDS = re.compile(r"(\d*\.?\d+(?:[eE][-+]?\d+)?) ?%(?:, ?(.+))?")


def chord_share(text: str, field: str) -> float | None:
    """Return a length in chords, None for "off".

    Raises
    ------
    BladegenError
        If it is neither.

    >>> chord_share("2e-5", "fairing")
    2e-05
    """
    if text.lower() == "off":
        return None
    try:
        return float(text)
    except ValueError:
        raise BladegenError(
            f"{field}: got {text!r}, must be a share of the chord, such as 1e-5, or off"
        ) from None


def planform_fairing(text: str, field: str) -> PlanformFairing | None:
    """Return how far a planform may move, None for "off"; twist as by default if it is not said.

    Raises
    ------
    BladegenError
        If it is neither.

    >>> str(planform_fairing("0.1%", "fair-planform"))
    '0.1%,0.02deg'
    """
    if text.lower() == "off":
        return None
    bounds = _BOUNDS.fullmatch(text)
    if bounds is None:
        raise BladegenError(
            f"{field}: got {text!r}, must be a share of the chord and an angle, such as "
            "0.1%,0.02deg, or off"
        )
    share = float(bounds[1]) / 100.0
    return PlanformFairing(share, *(radians(one, field) for one in bounds.groups()[1:] if one))
