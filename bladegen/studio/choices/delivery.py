"""How files are written: the unit of meshes and grids, the tolerance of solids."""

from dataclasses import dataclass
from math import isfinite

from bladegen.cad.solids import DEFAULT_TOLERANCE
from bladegen.errors import StudioError
from bladegen.exports.options import TOLERANCES, UNITS, Options

__all__ = ["USUAL", "Delivery"]


@dataclass(frozen=True)
class Delivery:
    """How files are written.

    Parameters
    ----------
    unit : str
        Of `exports.options.UNITS`.
    tolerance : float
        Of solids [mm].

    Raises
    ------
    StudioError
        If one of them is not allowed.
    """

    unit: str = "m"
    tolerance: float = 1e3 * DEFAULT_TOLERANCE

    def __post_init__(self) -> None:
        if self.unit not in UNITS:
            raise StudioError(f"unit: got {self.unit[:40]!r}, allowed are {', '.join(UNITS)}")
        low, high = (1e3 * end for end in TOLERANCES)
        if not isfinite(self.tolerance) or not low <= self.tolerance <= high:
            raise StudioError(
                f"tolerance: got {self.tolerance:g}, allowed is {low:g} to {high:g} mm"
            )

    @property
    def options(self) -> Options:
        """The options of an export."""
        if self.tolerance == USUAL.tolerance:  # the same number, whatever it is in millimetres
            return Options(unit=self.unit)
        return Options(unit=self.unit, tolerance=self.tolerance / 1e3)


USUAL = Delivery()
