"""Sections that are asked for again and again at mostly the same spans, made once.

Who fits a surface measures it round by round, with a few knots more in each: most of the spans
that it asks for it has asked for before.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from bladegen.support.arrays import Array
from bladegen.support.recent import Recent

__all__ = ["Remembered", "Sectioned"]

PLACES = 4  # sets of landmark parameters whose sections are kept; some 10 MB each


class Sectioned(Protocol):
    """What has sections over span: a `Blade`."""

    @property
    def u(self) -> Array:
        """Landmark parameters, (n,)."""
        ...

    @property
    def sides(self) -> tuple[str, str]:
        """What the halves of sections are called."""
        ...

    def sections(self, eta: Array, u: Array | None = None) -> Array:
        """Return sections (k, n, 3) [m] at span fractions (k,)."""
        ...


@dataclass(frozen=True, eq=False)
class Remembered:
    """The sections of a blade, each made once for as long as its landmark parameters are in use."""

    blade: Sectioned

    @property
    def u(self) -> Array:
        """The blade's landmark parameters, (n,)."""
        return self.blade.u

    @property
    def sides(self) -> tuple[str, str]:
        """What the halves of sections are called."""
        return self.blade.sides

    @cached_property
    def _known(self) -> Recent[dict[float, Array]]:
        return Recent(PLACES)

    def sections(self, eta: Array, u: Array | None = None) -> Array:
        """Return sections (k, n, 3) [m] at span fractions (k,), as `Blade.sections` does."""
        known = self._known.get(b"" if u is None else u.tobytes(), dict)
        spans = eta.tolist()
        new = list(dict.fromkeys(span for span in spans if span not in known))
        if new:
            known.update(zip(new, self.blade.sections(np.array(new), u), strict=True))
        return np.stack([known[span] for span in spans])
