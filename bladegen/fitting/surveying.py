"""Sections of a surface as close as they are needed, along an axis that is found on the way.

The axis is y = 0, bent in x until it lies on the chord lines; sections stand normal to it.  Where
chord lines are vague, axis and twist go on steadily, and offsets and airfoils take the rest up.
"""

from dataclasses import replace

import numpy as np

from bladegen.definition.distribution import pchip
from bladegen.definition.reference_axis import ReferenceAxis
from bladegen.errors import GeometryError
from bladegen.fitting.measuring import Cutting, Sections, axis_of, measured, settled
from bladegen.fitting.noses import vagueness, with_steady_noses
from bladegen.fitting.smoothing import CLEAR, steady, with_twist
from bladegen.fitting.tips import length_along
from bladegen.support.arrays import Array

__all__ = ["surveyed"]

COARSE = np.concatenate([np.linspace(1e-4, 0.05, 8), np.linspace(0.08, 0.985, 30)])
FIRST = np.unique(
    np.concatenate(
        [
            np.linspace(0.0, 0.05, 9),
            np.linspace(0.05, 0.95, 37),
            1.0 - 0.05 * 0.5 ** np.arange(7),
            [1.0],
        ]
    )
)
INSIDE = (1e-6, 1e-5, 1e-4, 5e-4, 2e-3, 5e-3)  # of the length, by which the last plane is inside
NEAR_TIP = (np.array([0.01, 0.006]), np.array([0.003, 0.0015]), np.array([0.0008, 0.0004]))
APART = 1e-6  # of the length, between places on the axis
WHOLE, ALIKE = 0.5, 1.25  # of chord and thickness next to the tip: else it is half cut off
DISTRIBUTIONS = 0.2  # of the tolerance, for each of chord, twist, offset and prebend
SURE = 0.05  # of the tolerance: what is off by less half way is so by no chance
ROUNDS = 4  # of halving the steps between sections
MOST = 480  # sections
TURNS = 3  # of axis and planes, at last
NOSES = 0.5  # of the tolerance, by which a nose is lowered where it would jump
LOWEST = 1e-3  # m, of that: a coarse tolerance is no leave to cut noses off
VAGUE = 0.1  # of the tolerance: points that are as far from the trailing edge but for this
STILL = 0.05  # of the tolerance that the axis still moves


def surveyed(cuts: Cutting, points: Array, tolerance: float, name: str) -> tuple[Sections, float]:
    """Measure sections as close as the distributions need, and the blade's length.

    Parameters
    ----------
    cuts : callable
        Cuts the surface by planes, as `Cutter.cuts`.
    points : (m, 3) array
        Of the surface, blade frame [m].
    tolerance : float
        What the blade shall keep [m].
    name : str
        What errors call it.
    """
    rough = float(points[:, 2].max())
    coarse, axis = settled(cuts, COARSE, rough, name=name)
    z, prebend = coarse.eta * rough, coarse.prebend
    length = length_along(points, axis)
    for near in NEAR_TIP:  # the tip's plane is as good as the axis' end
        axis = axis_of(z / length, prebend, length)
        more = measured(cuts, axis, 1.0 - near, name=name, guide=coarse)
        z, prebend = np.append(z, more.eta * length), np.append(prebend, more.prebend)
        z, prebend = _in_order(z, prebend, length)
        length = length_along(points, axis_of(z / length, prebend, length))
        z, prebend = _in_order(z, prebend, length)
    axis = axis_of(z / length, prebend, length)
    last = _to_the_tip(cuts, axis, name)
    vague = vagueness(last, VAGUE * tolerance)
    axis = axis_of(last.eta, steady(last, last.prebend, vague), length)
    eta = _refined(cuts, last, axis, tolerance, name)
    sections, twist = _steadied(measured(cuts, axis, eta, name=name), length, tolerance)
    for _ in range(TURNS):  # planes follow the axis, and the axis the chord lines
        vague = vagueness(sections, VAGUE * tolerance)
        wanted = axis_of(eta, steady(sections, sections.prebend, vague), length)
        if np.abs(wanted(eta) - axis(eta)).max() < STILL * tolerance:
            break
        try:
            turned = measured(cuts, wanted, eta, name=name)
        except GeometryError:  # at the tip, where an axis through noise leaves the surface
            break
        axis = wanted
        sections, _ = _steadied(turned, length, tolerance, twist)
    sections = _on_axis(sections, axis, tolerance)
    reach = length * float(sections.eta[-1])
    eta = sections.eta / sections.eta[-1]
    eta[0] = 0.0
    return replace(sections, eta=eta), reach


def _in_order(z: Array, prebend: Array, length: float) -> tuple[Array, Array]:
    """Return places and prebend from root to tip, but for those on another or beyond the tip.

    Through noise the tip is found farther in, or farther out, than it was before.
    """
    order = np.argsort(z)
    z, prebend = z[order], prebend[order]
    kept = (z <= length) & (np.diff(z, prepend=-np.inf) > APART * length)
    return z[kept], prebend[kept]


def _steadied(
    sections: Sections, length: float, tolerance: float, twist: Array | None = None
) -> tuple[Sections, Array]:
    """Return sections whose leading edges do not jump and whose twist is steady; and the twist."""
    sections = with_steady_noses(sections, length, min(NOSES * tolerance, LOWEST))
    if twist is None:
        twist = steady(sections, sections.twist, vagueness(sections, VAGUE * tolerance))
    return with_twist(sections, twist), twist


def _on_axis(sections: Sections, axis: ReferenceAxis, tolerance: float) -> Sections:
    """Return sections whose offsets are from the axis that they were measured along.

    Where that lies on their chord lines, to what does not matter, they stay as they are.
    """
    if np.abs(sections.shift).max() < STILL * tolerance:
        return sections
    return replace(
        sections,
        prebend=axis(sections.eta)[:, 0],
        offset=sections.offset - sections.shift * np.sin(sections.twist),
        rise=sections.shift * np.cos(sections.twist),
    )


def _to_the_tip(cuts: Cutting, axis: ReferenceAxis, name: str) -> Sections:
    """Measure first sections, the last one so far inside that it is whole."""
    found = None
    for inside in INSIDE:
        at = FIRST.copy()
        at[[0, -1]] = inside, 1.0 - inside
        try:
            sections = measured(cuts, axis, at, name=name)
        except GeometryError:
            if inside == INSIDE[-1] and found is None:
                raise
            continue
        found = sections
        same = sections.thickness[-1] / sections.thickness[-2]
        if 1.0 / ALIKE < same < ALIKE and sections.chord[-1] > WHOLE * sections.chord[-2]:
            break
    assert found is not None
    return found


def _refined(
    cuts: Cutting, sections: Sections, axis: ReferenceAxis, tolerance: float, name: str
) -> Array:
    """Return spans between which chord, twist, offset and prebend are as their splines have it."""
    start, end = sections.eta[:-1], sections.eta[1:]
    held = np.zeros(len(start), dtype=bool)  # whether the interval that each was half of held
    for _ in range(ROUNDS):
        middle = 0.5 * (start + end)
        if not middle.size or len(sections.eta) + len(middle) > MOST:
            break
        between = measured(cuts, axis, middle, name=name, guide=sections)
        off = np.zeros(len(middle))
        clear = between.thickness < CLEAR  # elsewhere chord lines are vague, and smoothed
        for quantity, size in (
            ("chord", 1.0),
            ("twist", clear * between.chord),
            ("offset", clear),
            ("prebend", clear),
            ("thickness", between.chord),
        ):
            wanted = pchip(sections.eta, getattr(sections, quantity))(middle)
            off = np.maximum(off, size * np.abs(getattr(between, quantity) - wanted))
        sections = sections.joined(between)
        good = off <= DISTRIBUTIONS * tolerance
        more = ~good | (~held & (off > SURE * tolerance))
        start, middle, end, good = start[more], middle[more], end[more], good[more]
        start, end = np.sort([*start, *middle]), np.sort([*middle, *end])
        held = np.repeat(good, 2)
    return sections.eta
