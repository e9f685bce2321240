"""Zones of a blade's skin on which the same layers lie, in the parameters of its surface.

The span is cut into bays where layers and webs begin and end.  In a bay, lines run along the span:
trailing edges, the leading edge, feet of webs, and the edges of the layers that are there.  A
zone lies between two lines of a bay.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from bladegen.blade.layup.layup import Layup, covers_edge
from bladegen.blade.layup.outlines import Outlines
from bladegen.blade.layup.shell.lines import mesh_lines
from bladegen.definition.distribution import united
from bladegen.definition.structure.structure import Layer, Web
from bladegen.support.arrays import Array, Mask

__all__ = ["Bay", "bays_of"]

APART = 2e-3  # of the arc, least between two lines
SAME = 2e-3  # of the arc, in the mean over a bay: one line is enough for both
SHORTEST = 5e-3  # of the span; ends nearer to each other, or to root and tip, are one
MEETING = 2e-4  # of u; lines of two bays that end so near to each other go on in each other
LOOKED_AT = 401  # spans at which edges are looked at for those that pass each other
THIN = 1e-6  # m
KEPT = 0.5  # of the distance of two lines at spans, that they keep between these
BETWEEN = np.arange(1, 16) / 16  # places from span to span at which that is looked at
HALVINGS = 6  # of the distance from span to span


@dataclass(frozen=True, eq=False)
class Bay:
    """A part of the span on which no layer and no web begins or ends.

    Parameters
    ----------
    v : (m,) array
        Span fractions, both ends among them.
    lines : (lines, m) array
        Landmark parameters u of lines, increasing, from 0 to 1.
    nose : int
        Which line is the leading edge, u = 0.5.
    feet : dict of (int, int)
        For each web that stands here which lines it stands on.
    layers : tuple of tuples of str
        For each zone, between a line and the next, the layers that cover it, from the outside to
        the inside.
    edge : pair of tuples of str
        The layers that cover the halves of the trailing edge, next to the first and the last line.
    whole : frozenset of str
        The layers that cover all of the section.
    """

    v: Array
    lines: Array
    nose: int
    feet: dict[str, tuple[int, int]]
    layers: tuple[tuple[str, ...], ...]
    edge: tuple[tuple[str, ...], tuple[str, ...]]
    whole: frozenset[str]

    @cached_property
    def slopes(self) -> Array:
        """Derivatives (lines, m) of the lines over the span, by PCHIP; cubics of Hermite follow."""
        return _slopes(self.v, self.lines)

    @property
    def tight(self) -> Mask:
        """Between which spans (m - 1,) a line comes nearer to the next than it is at both."""
        step, t = np.diff(self.v), BETWEEN[:, None, None]
        apart, turns = (np.diff(a, axis=0) for a in (self.lines, _slopes(self.v, self.lines)))
        low, high = apart[:, :-1], apart[:, 1:]
        ends = (1.0 - t) ** 2 * (1.0 + 2.0 * t) * low + t**2 * (3.0 - 2.0 * t) * high
        bent = (1.0 - t) * turns[:, :-1] - t * turns[:, 1:]
        found: Mask = np.any(
            ends + t * (1.0 - t) * step * bent < KEPT * np.minimum(low, high), axis=(0, 1)
        )
        return found

    @property
    def reversed(self) -> "Bay":
        """The same on a mirror image."""
        last = len(self.lines) - 1
        feet = {name: (last - a, last - b) for name, (a, b) in self.feet.items()}
        lines = 1.0 - self.lines[::-1]
        layers, edge = self.layers[::-1], (self.edge[1], self.edge[0])
        return Bay(self.v, lines, last - self.nose, feet, layers, edge, self.whole)


def bays_of(layup: Layup, v: Array) -> list[Bay]:
    """Return the bays of a blade, with lines at span fractions `v` (k,) and at their ends."""
    if layup.blade.mirrored:  # whose landmarks run the other way
        own = Layup(layup.blade.mirror_image(), layup.structure)
        return [bay.reversed for bay in bays_of(own, v)]
    placed: list[Web | Layer] = [*layup.structure.webs]
    placed += [layer for layer in layup.structure.layers if not layer.web]
    ends = united(*map(_there, placed), _crossings(layup, placed), apart=SHORTEST)
    ends = ends[(ends > SHORTEST) & (ends < 1.0 - SHORTEST)]
    bays = [
        _kept_apart(layup, np.unique(np.concatenate([[a, b], v[(v > a) & (v < b)]])))
        for a, b in pairwise([0.0, *ends.tolist(), 1.0])
    ]
    for before, behind in pairwise(bays):
        _meet(before.lines[:, -1], behind.lines[:, 0])
    return bays


def _meet(before: Array, behind: Array) -> None:
    """Let lines begin where those end that lie next to them in the bay before."""
    nearest = np.argmin(np.abs(behind[:, None] - before), axis=1)
    near = np.abs(before[nearest] - behind) < MEETING
    behind[near] = before[nearest[near]]


def _crossings(layup: Layup, placed: list[Web | Layer]) -> Array:
    """Return the span fractions at which edges of layers and feet of webs pass each other."""
    eta = np.linspace(0.0, 1.0, LOOKED_AT)
    outlines, known = Outlines.of(layup.blade, eta), dict[int, Array]()
    ends = [outlines.places(end, known) for one in placed for end in (one.start, one.end)]
    spans = np.array([_there(one) for one in placed]).repeat(2, axis=0)
    inside = (eta > spans[:, :1]) & (eta < spans[:, 1:])
    edges = np.where(inside, ends, np.nan)
    first, second = np.triu_indices(len(edges), 1)
    apart = edges[first] - edges[second]
    order = np.where(np.abs(apart) > SAME, np.sign(apart), 0.0)
    at = np.maximum.accumulate(np.where(order != 0.0, np.arange(len(eta)), 0), axis=1)
    last = np.take_along_axis(order, at, axis=1)
    pairs, places = np.nonzero(last[:, 1:] * last[:, :-1] < 0.0)
    found: Array = 0.5 * (eta[at[pairs, places]] + eta[places + 1])
    return found


def _there(one: Web | Layer) -> Array:
    """Return the span fractions between which there is something of a web or a layer."""
    first, last = one.extent
    if isinstance(one, Layer):
        grid, thick = one.thickness.grid, np.flatnonzero(one.thickness.values > THIN)
        if not thick.size:
            return np.zeros(2)
        first = max(first, float(grid[max(thick[0] - 1, 0)]))
        last = min(last, float(grid[min(thick[-1] + 1, len(grid) - 1)]))
    return np.array([first, last])


def _kept_apart(layup: Layup, v: Array) -> Bay:
    """Return a bay with as many more spans as its lines need to stay in order between them."""
    bay = _bay(layup, v)
    for _ in range(HALVINGS):
        tight = bay.tight
        if not tight.any():
            break
        v = np.union1d(v, 0.5 * (v[:-1] + v[1:])[tight])
        bay = _bay(layup, v)
    return bay


def _slopes(v: Array, lines: Array) -> Array:
    from scipy.interpolate import PchipInterpolator

    found: Array = PchipInterpolator(v, lines, axis=1).derivative()(v)
    return found


def _bay(layup: Layup, v: Array) -> Bay:
    structure, blade = layup.structure, layup.blade
    middle = 0.5 * (v[0] + v[-1])

    def stands(one: Web | Layer) -> bool:
        there = _there(one)
        return bool(there[0] < middle < there[1])

    here = replace(
        structure,
        webs=tuple(filter(stands, structure.webs)),
        layers=tuple(one for one in structure.layers if not one.web and stands(one)),
    )
    outlines = Outlines.of(blade, v)
    found = mesh_lines(here, outlines, apart=APART, same=SAME, edge=SAME)
    lines = outlines.parameters(found.fractions.T)
    lines[0], lines[found.nose], lines[-1] = 0.0, 0.5, 1.0
    half = len(v) // 2
    between = found.fractions[half]
    centres = 0.5 * (between[1:] + between[:-1])
    ends = [[outlines.places(end)[half] for end in (one.start, one.end)] for one in here.layers]
    arcs = np.reshape(ends, (-1, 2))
    wrapped = np.array([one.around for one in here.layers], dtype=bool)
    first, last = arcs[:, :1] <= centres, centres <= arcs[:, 1:]
    covers = np.where(wrapped[:, None], first | last, first & last)
    names = np.array([one.name for one in here.layers], dtype=object)
    layers = tuple(tuple(names[row]) for row in covers.T)
    arcs[wrapped, 0] -= 1.0
    at_edge = covers_edge(arcs, wrapped)
    edge = tuple(names[at_edge[:, 0]]), tuple(names[at_edge[:, 1]])
    whole = frozenset(names[covers.all(axis=1)])
    return Bay(v, lines, found.nose, found.feet, layers, edge, whole)
