"""What is asked of another process: a blade's source, as `bladegen.read` takes it, and a state."""

from dataclasses import dataclass
from functools import lru_cache

from bladegen.formats.reading import read
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.studio.choices.loft import Loft
from bladegen.studio.model import Baseline
from bladegen.studio.state import State

__all__ = ["Question", "opened"]


@dataclass(frozen=True)
class Question:
    """A state, and where its blade is from.

    Parameters
    ----------
    source : str
        The blade, as `bladegen.read` takes it.
    airfoils : str, optional
        The folder of its airfoil files, as `bladegen.read` takes it.
    state : State
        What is changed of it.
    """

    source: str
    airfoils: str | None
    state: State

    @property
    def baseline(self) -> Baseline:
        """The blade, prepared; the same one while its source and its loft are."""
        return opened(self.source, self.airfoils, self.state.loft)


@lru_cache(2)
def opened(source: str, airfoils: str | None, loft: Loft) -> Baseline:
    """Return a blade; what lies under a source in a studio's folder never changes."""
    definition = read(source, airfoils=airfoils)
    return Baseline(source, loft.blade(definition), ShapeSpace.bundled())
