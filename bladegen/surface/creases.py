"""Where along the span a blade's surface is less than smooth, and by how much.

A blade lists the spans at which it may be (`Blade.breaks`); what its slopes and curvatures do there
is measured on its sections, on both sides.  Between them an edge's finish or a thickness that
leaves the range of its stations may crease it too: `crease_between` looks for it.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.curves.vectors import cross, dots, lengths
from bladegen.support.arrays import Array, Mask
from bladegen.support.values import brief

__all__ = ["TEAR", "Breaks", "crease_between"]

SHARP = 1e-4  # rad; a surface whose normal turns by less at a span is no crease
WATCHED = 4  # every so many-th landmark is watched
NEAR = 1.0 / 16.0  # of the way to the next break: the first of three sections beside it
FARTHEST = 3e-4  # of the span, a step
CLOSEST = 5e-4  # of the span between breaks; of nearer ones one is kept, a station if there is one
ZOOM = 33  # sections that are looked at at once
SETTLED = 1e-9  # of the span
TEAR = 2e-5  # of the span to either side of a jump, which a surface crosses between
JUMP = 1e-5  # m; a surface that moves by more over less than `SETTLED` is torn there


@dataclass(frozen=True, eq=False)
class Breaks:
    """Spans at which a surface may be less than smooth.

    Parameters
    ----------
    at : (m,) array
        Span fractions, increasing.
    turns, bends : (m,) arrays
        By how much the first and the second derivative along the span jump there, along the
        surface's normal, at most [m].
    length : float
        The blade's length [m].
    """

    at: Array
    turns: Array
    bends: Array
    length: float

    __repr__ = brief

    @classmethod
    def of(cls, blade: Blade) -> "Breaks":
        """Measure a blade at its breaks."""
        listed, stations = blade.breaks, blade.eta
        far = np.abs(listed[:, None] - stations).min(axis=1) > CLOSEST
        at = np.concatenate([stations, listed[far]])
        at = np.sort(at[(at > CLOSEST) & (at < 1.0 - CLOSEST)])
        keep = np.insert(np.diff(at) > CLOSEST, 0, True) | np.isin(at, stations)
        at = at[keep]
        bounds = np.concatenate([[0.0], at, [1.0]])
        return cls(at, *_jumps(blade, at, bounds), blade.length)

    @property
    def creases(self) -> Mask:
        """At which the surface's normal turns, (m,)."""
        return self.turns > SHARP * self.length

    def with_one(self, blade: Blade, at: float, low: float, high: float) -> "Breaks":
        """Return these and another, between two spans."""
        turns, bends = _jumps(blade, np.array([at]), np.array([low, at, high]))
        return self._with(np.array([at]), turns, bends)

    def torn(self, at: float) -> "Breaks":
        """Return these and a crease on either side of a span at which the surface jumps."""
        return self._with(np.array([at - TEAR, at + TEAR]), np.full(2, self.length), np.zeros(2))

    def _with(self, at: Array, turns: Array, bends: Array) -> "Breaks":
        place = np.searchsorted(self.at, at)
        at = np.insert(self.at, place, at)
        turns, bends = np.insert(self.turns, place, turns), np.insert(self.bends, place, bends)
        return Breaks(at, turns, bends, self.length)

    def found(self, v: Array) -> tuple[Array, Array]:
        """Return the jumps of first and second derivative at spans (k,), zero at all others."""
        if not len(self.at):
            return np.zeros(len(v)), np.zeros(len(v))
        near = np.clip(np.searchsorted(self.at, v), 0, len(self.at) - 1)
        here = self.at[near] == v
        return np.where(here, self.turns[near], 0.0), np.where(here, self.bends[near], 0.0)


def _jumps(blade: Blade, at: Array, bounds: Array) -> tuple[Array, Array]:
    """Return the jumps of first and second derivative at spans (k,) between bounds (k + 2,)."""
    if not len(at):
        return np.zeros(0), np.zeros(0)
    u = blade.u[::WATCHED]
    gaps = np.diff(bounds)
    step = np.minimum(NEAR * np.minimum(gaps[1:], gaps[:-1]), FARTHEST)
    ways = np.arange(-3.0, 4.0)[:, None]
    made = blade.sections((at + ways * step).reshape(-1), u).reshape(len(ways), len(at), -1, 3)
    here, h = made[3], step[:, None, None]
    slopes, curves = [], []
    for side, (one, two, three) in ((-1.0, made[2::-1]), (1.0, made[4:])):
        slopes.append(side * (18.0 * one - 11.0 * here - 9.0 * two + 2.0 * three) / (6.0 * h))
        curves.append((2.0 * here - 5.0 * one + 4.0 * two - three) / h**2)
    normal = cross(np.gradient(here, u, axis=1), slopes[0] + slopes[1])
    length = lengths(normal)[..., None]
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    turns, bends = (
        np.abs(dots(behind - ahead, normal)).max(axis=1) for ahead, behind in (slopes, curves)
    )
    return turns, bends


def crease_between(blade: Blade, low: float, high: float) -> tuple[float, bool]:
    """Return the span between two at which slopes jump most, and whether sections do so too."""
    u = blade.u[::WATCHED]
    while high - low > SETTLED:
        v = np.linspace(low, high, ZOOM)
        sections = blade.sections(v, u)
        turn = np.diff(sections, 2, axis=0)
        turn = np.abs(turn - np.median(turn, axis=0)).max(axis=(1, 2))
        worst = int(np.argmax(turn)) + 1
        low, high = float(v[worst - 1]), float(v[worst + 1])
    across = sections[worst + 1] - sections[worst - 1]
    return 0.5 * (low + high), bool(np.linalg.norm(across, axis=-1).max() > JUMP)
