"""Lengths as people write them: 0.3mm, 2 mm, 0.002 m, 5cm."""

import re

from bladegen.errors import BladegenError

__all__ = ["metres"]

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
