"""What a page shows of a state: surface, section, curves over span, checks; and as it is sent."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.studio.state import State
from bladegen.support.arrays import Array

__all__ = ["Check", "Curves", "Scene", "flattened"]

SHOWN_LANDMARKS = 100  # of the surface, about


@dataclass(frozen=True)
class Check:
    """One line of the live checks: "good", "near", "odd" or "bad", what it looks at, its figure."""

    status: str
    what: str
    figure: str


@dataclass(frozen=True, eq=False)
class Curves:
    """What varies over span, each (k,): chord [m], twist [deg], thickness [%], prebend [m]."""

    eta: Array
    chord: Array
    twist: Array
    thickness: Array
    prebend: Array


@dataclass(frozen=True, eq=False)
class Scene:
    """What a page shows of a state.

    Parameters
    ----------
    state : State
        Of what.
    eta : (k,) array
        Span fractions.
    sections : (k, n, 3) array
        The surface [m].
    deviation : (k, n) array
        How far it lies off the baseline, along the baseline's outward normal [m]: the part of it
        that the state asks for.
    curves : Curves
        Over span.
    checks : tuple of Check
        What was found.
    """

    state: State
    eta: Array
    sections: Array
    deviation: Array
    curves: Curves
    checks: tuple[Check, ...]

    @property
    def place(self) -> int:
        """Where in `eta` the section looked at stands."""
        return int(np.argmin(np.abs(self.eta - self.state.at)))

    @property
    def valid(self) -> bool:
        """Whether nothing is wrong with the blade."""
        return all(check.status != "bad" for check in self.checks)

    @property
    def profile(self) -> Array:
        """The section looked at (n, 2), in chords from its leading edge along its chord."""
        return flattened(self.sections[self.place], float(self.curves.chord[self.place]))

    @property
    def placed(self) -> Array:
        """The section looked at (n, 2) as it stands in the blade, y and x [m]."""
        placed: Array = self.sections[self.place][:, 1::-1]
        return placed

    def packet(self) -> bytes:
        """Return what the 3D view draws: little-endian counts k, n, the place of the section
        (uint32), the surface and the deviation at every fourth landmark or so (float32).
        """
        some = _thinned(self.sections.shape[1])
        surface, off = self.sections[:, some], self.deviation[:, some]
        head = np.array([*surface.shape[:2], self.place], dtype="<u4")
        return head.tobytes() + surface.astype("<f4").tobytes() + off.astype("<f4").tobytes()


def _thinned(n: int) -> Any:
    """Return which landmarks are drawn, the ends and the leading edge among them."""
    step = max(1, (n - 1) // SHOWN_LANDMARKS)
    return slice(None, None, step if (n - 1) % (2 * step) == 0 else 1)


def flattened(section: Array, chord: float) -> Array:
    """Return a section in space (n, 3) as (n, 2) in chords: leading edge at 0, upright."""
    edge = 0.5 * (section[0] + section[-1])
    nose = section[np.argmax(np.linalg.norm(section - edge, axis=1))]
    along = (edge - nose) / np.linalg.norm(edge - nose)
    from_edge = section - edge
    area = np.cross(from_edge[:-1], from_edge[1:]).sum(axis=0)
    normal = area - (area @ along) * along
    up = np.cross(normal / np.linalg.norm(normal), along)
    flat: Array = (section - nose) @ np.stack([along, up], axis=1) / chord
    return flat
