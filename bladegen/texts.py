"""Values as people write them: lengths (0.3mm, 2 mm, 0.002 m), coordinates (0.1,0,0,0@0.5)."""

import re
from collections.abc import Sequence

import numpy as np

from bladegen.deformation import Coordinates, Window
from bladegen.errors import BladegenError

__all__ = ["coordinates", "metres", "span_window"]

_METRES = {"um": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1.0}
_LENGTH = re.compile(r"\s*([0-9]*\.?[0-9]+(?:[eE][-+]?[0-9]+)?)\s*(um|mm|cm|m)\s*")


def metres(text: str, field: str) -> float:
    """Return a length with its unit in metres.

    Raises
    ------
    BladegenError
        If there is no number or no unit.

    >>> metres("0.3mm", "tolerance")
    0.0003
    """
    match = _LENGTH.fullmatch(text)
    if match is None:
        raise BladegenError(
            f"{field}: got {text!r}, must be a length with its unit ({', '.join(_METRES)}), "
            "such as 0.3mm"
        )
    return float(f"{float(match[1]) * _METRES[match[2]]:.15g}")


def coordinates(texts: Sequence[str]) -> Coordinates | None:
    """Return coordinates over span from texts like ``0.1,0,0,0`` or ``0.1,0,0,0@0.5``.

    Raises
    ------
    BladegenError
        If a text holds anything but numbers, or several are given and one has no ``@eta``.

    >>> coordinates(["0.1,0@0.5", "0,0@0.25"]).grid
    array([0.25, 0.5 ])
    """
    if not texts:
        return None
    rows = []
    for text in texts:
        values, _, place = text.partition("@")
        if len(texts) > 1 and not place:
            raise BladegenError(f"pga: got {text!r}, must end in @ETA where several are given")
        rows.append((_numbers(place, "pga")[0] if place else 0.0, _numbers(values, "pga")))
    rows.sort(key=lambda row: row[0])
    if len({len(values) for _, values in rows}) > 1:
        raise BladegenError("pga: all must have the same number of coordinates")
    return Coordinates(np.array([at for at, _ in rows]), np.array([values for _, values in rows]))


def span_window(text: str) -> Window:
    """Return a window over span from a text like ``0.1,0.3``.

    Raises
    ------
    BladegenError
        If it does not hold two span fractions that rise.
    """
    numbers = _numbers(text, "window")
    if len(numbers) != 2:
        raise BladegenError(f"window: got {text!r}, must be two span fractions, such as 0.1,0.3")
    return Window(*numbers)


def _numbers(text: str, field: str) -> list[float]:
    try:
        return [float(word) for word in text.split(",")]
    except ValueError:
        raise BladegenError(
            f"{field}: got {text!r}, must be numbers with commas between, such as 0.1,0,0,0"
        ) from None
