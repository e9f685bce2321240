"""Sections cut in sectors with one laminate each, along the chord, as section solvers take them.

The plane is that of the chord: x from the nose to the trailing edge, y to the suction side, both
over the chord.  A side is cut where its layers begin and end.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.blade.layup.laid import Laid
from bladegen.blade.layup.layup import Layup
from bladegen.blade.layup.outlines import Outlines
from bladegen.support.arrays import Array, ArrayLike

__all__ = ["Sectors", "Stack", "sectors"]

THIN = 1e-6  # m
NARROW = 1e-4  # of the chord: sectors are no narrower
SHARP = 1e-5  # of the arc: half a trailing edge that is no wall

Stack = tuple[tuple[int, float, float], ...]  # layers: which, thickness [m], angle [rad]


@dataclass(frozen=True, eq=False)
class Sectors:
    """A section.

    Parameters
    ----------
    eta, chord, twist, nose : float
        Span fraction, [m], [rad], and how far the nose lies before the axis, over the chord.
    outline : (n, 2) array
        From the suction side's trailing edge on, over the chord.
    upper, lower : pair of (s + 1,) array and of s stacks
        Where sectors of the suction and pressure side begin and end along the chord, from the nose
        on, and their layers from the outside to the inside.
    walls : tuple of (float, Stack)
        Webs, and the trailing edge if it has a width: where along the chord, and their layers.
    """

    eta: float
    chord: float
    twist: float
    nose: float
    outline: Array
    upper: tuple[Array, tuple[Stack, ...]]
    lower: tuple[Array, tuple[Stack, ...]]
    walls: tuple[tuple[float, Stack], ...]


def sectors(layup: Layup, eta: ArrayLike) -> list[Sectors]:
    """Return the sections at span fractions (k,) of a blade that is no mirror image."""
    blade = layup.blade
    spans = np.atleast_1d(np.asarray(eta, dtype=np.float64))
    outlines, laid = Outlines.of(blade, spans), layup.at(spans)
    c, s = np.cos(outlines.twist)[:, None], np.sin(outlines.twist)[:, None]
    x, y = outlines.flat[..., 1], outlines.flat[..., 0]
    chord = blade.chord(spans)[:, None]
    along, up = (x * c + y * s) / chord, (y * c - x * s) / chord
    return [
        _section(layup, laid, outlines, k, np.stack([along[k], up[k]], axis=-1))
        for k in range(len(spans))
    ]


def _section(layup: Layup, laid: Laid, outlines: Outlines, k: int, plane: Array) -> Sectors:
    front = int(np.argmin(plane[:, 0]))
    nose = plane[front]
    outline = plane - nose
    fraction, x = outlines.fractions[k], outline[:, 0]
    thick, angle = laid.thickness[:, k], laid.angle[:, k]
    structure = layup.structure
    skin = [i for i, one in enumerate(structure.layers) if not one.web and thick[i] > THIN]

    def stack(held: Array) -> Stack:
        return tuple(
            (i, float(thick[i] * share), float(angle[i]))
            for i, share in zip(skin, held.tolist(), strict=True)
            if share > 0.0
        )

    arcs = laid.arcs[skin, k]
    turned = np.array([[structure.layers[i].around] for i in skin], dtype=float)
    arcs = np.concatenate([arcs, arcs + np.where(turned > 0.0, 1.0, 9.0)])  # 9: nowhere

    def side(low: float, high: float) -> tuple[Array, tuple[Stack, ...]]:
        inner = np.unique(arcs[(arcs > low) & (arcs < high)])
        ends = np.concatenate([[low], inner, [high]])
        middles = 0.5 * (ends[1:] + ends[:-1])
        covers = (arcs[:, :1] <= middles) & (middles <= arcs[:, 1:])
        covers = covers[: len(skin)] | covers[len(skin) :]
        places = np.interp(ends, fraction, x)
        stacks = [stack(row) for row in covers.T.astype(float)]
        if places[0] > places[-1]:  # the suction side, from the trailing edge on
            places, stacks = places[::-1], stacks[::-1]
        places = np.maximum.accumulate(places)
        wide = np.diff(places) > NARROW
        kept = np.append(places[:-1][wide], places[-1])
        kept[0], kept[-1] = 0.0, 1.0
        return kept, tuple(one for one, held in zip(stacks, wide, strict=True) if held)

    walls = []
    for i, web in enumerate(structure.webs):
        own = [j for j, one in enumerate(structure.layers) if one.web == web.name]
        layers = tuple((j, float(thick[j]), float(angle[j])) for j in own if thick[j] > THIN)
        if layers:
            walls.append((float(np.interp(laid.web_arcs[i, k], fraction, x).mean()), layers))
    edge = stack(laid.edge[skin, k].mean(axis=-1))
    if edge and laid.half_edge[k] > SHARP:
        walls.append((1.0, edge))
    return Sectors(
        float(laid.eta[k]),
        float(layup.blade.chord(laid.eta[k])),
        float(outlines.twist[k]),
        -float(nose[0]),
        outline / x[[0, -1]].mean(),
        side(0.0, float(fraction[front])),
        side(float(fraction[front]), 1.0),
        tuple(sorted(walls, key=lambda wall: wall[0])),
    )
