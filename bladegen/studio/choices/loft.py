"""How a blade is made of its definition, as a page has it to choose."""

from dataclasses import dataclass

from bladegen.blade.blade import Blade
from bladegen.blade.lofting.paths import DEFAULT, PATHS
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.definition.fair_planform import PlanformFairing
from bladegen.errors import StudioError

__all__ = ["PLAIN", "Loft"]


@dataclass(frozen=True)
class Loft:
    """How stations are joined, and whether the planform is made fair.

    Parameters
    ----------
    path : str
        Of `paths.PATHS`.
    fair : bool
        Whether chord, twist and axis become C2, within `PlanformFairing`'s own bounds.

    Raises
    ------
    StudioError
        If the path is none.
    """

    path: str = DEFAULT
    fair: bool = False

    def __post_init__(self) -> None:
        if self.path not in PATHS:
            raise StudioError(f"path: got {self.path[:40]!r}, allowed are {', '.join(PATHS)}")

    @property
    def fairing(self) -> PlanformFairing | None:
        """How far the planform may move."""
        return PlanformFairing() if self.fair else None

    def blade(self, definition: BladeDefinition) -> Blade:
        """Return the blade of a definition."""
        return Blade.from_definition(definition, path=self.path, fair_planform=self.fairing)


PLAIN = Loft()
