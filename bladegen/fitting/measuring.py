"""Sections of a surface along a reference axis: chord, twist, offset, prebend and airfoils.

The reference axis is y = 0, the pitch axis, bent in x until it lies on the chord lines; section
planes are those that a blade of this axis has (`planform.flange_to_axis`), so that what is
measured is what a definition says.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from bladegen.airfoils.landmarks import landmark_parameters
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.section_planes import ROOT, flange_to_axis
from bladegen.curves.crossing import crossing_sections
from bladegen.definition.blade_definition import Distribution, ReferenceAxis
from bladegen.errors import GeometryError
from bladegen.fitting.sections.chains import Cut
from bladegen.fitting.sections.edges import Edges, edges_about, edges_of
from bladegen.fitting.sections.outlines import is_round, landmarks_of
from bladegen.support.arrays import Array, Mask

__all__ = ["LANDMARKS", "Cutting", "Sections", "axis_of", "measured", "settled", "uncrossed"]

LANDMARKS = 401
SOUND = 0.75  # of the sections, at least: fewer make no blade
SETTLED = 1e-5  # m that the axis still moves
ROUNDS = 8
LEVER = 0.01  # of the span, over which the axis' last direction is taken: sections scatter
Cutting = Callable[[Array, Array], list[Cut]]


@dataclass(frozen=True, eq=False)
class Sections:
    """Measures of sections at span fractions, root first.

    Parameters
    ----------
    eta : (k,) array
        Span fractions.
    chord, twist, offset, prebend : (k,) arrays
        [m], [rad], from the leading edge to the axis along the chord [m], and the axis' x [m].
    airfoils : (k, n, 2) array
        Landmarks in chords, leading edge at (0, 0), trailing-edge midpoint at (1, 0).
    thickness : (k,) array
        Over the chord.
    rounded : (k,) array of bool
        Whether they are circles.
    angle, width, held : (k,) arrays
        Where their edges are, and whether they were not seen: see `Edges`.
    shift : (k,) array
        From the axis that they were measured along to the chord line, along the plane's x [m].
    rise : (k,) array, optional
        From the axis to the chord line, normal to that [m]; none where the axis lies on it.
    """

    eta: Array
    chord: Array
    twist: Array
    offset: Array
    prebend: Array
    airfoils: Array
    thickness: Array
    rounded: Mask
    angle: Array
    width: Array
    held: Mask
    shift: Array
    rise: Array | None = None

    def joined(self, other: "Sections") -> "Sections":
        """Return both sections, by span."""
        eta = np.concatenate([self.eta, other.eta])
        order = np.argsort(eta, kind="stable")
        parts = {
            name: np.concatenate([value, getattr(other, name)])[order]
            for name, value in vars(self).items()
            if value is not None
        }
        return Sections(**parts)

    def take(self, rows: Array) -> "Sections":
        """Return some of the sections."""
        parts = {name: v[rows] for name, v in vars(self).items() if v is not None}
        return replace(self, **parts)


def axis_of(eta: Array, prebend: Array, length: float) -> ReferenceAxis:
    """Return the axis y = 0 with a prebend (k,) at span fractions (k,), prolonged straight."""
    ends = np.array([0.0, 1.0])
    slope = np.diff(prebend) / np.diff(eta)
    behind = int(np.searchsorted(eta, eta[-1] - LEVER, side="right")) - 1
    steep = (prebend[-1] - prebend[behind]) / (eta[-1] - eta[behind]) if behind >= 0 else slope[-1]
    if eta[0] > 0.0:
        prebend = np.concatenate([[prebend[0] - slope[0] * eta[0]], prebend])
        eta = np.concatenate([[0.0], eta])
    if eta[-1] < 1.0:
        prebend = np.concatenate([prebend, [prebend[-1] + steep * (1.0 - eta[-1])]])
        eta = np.concatenate([eta, [1.0]])
    return ReferenceAxis(
        Distribution(eta, prebend),
        Distribution(ends, np.zeros(2)),
        Distribution(ends, np.array([0.0, length])),
    )


def settled(
    cuts: Cutting, eta: Array, length: float, *, name: str, fairing: float | None = None
) -> tuple[Sections, ReferenceAxis]:
    """Measure sections along the axis that lies on their chord lines.

    The axis is sought by turns: sections, then an axis through their chord lines at y = 0.
    """
    axis = axis_of(np.array([0.0, 1.0]), np.zeros(2), length)
    found = None
    for _ in range(ROUNDS):
        found = measured(cuts, axis, eta, name=name, fairing=fairing)
        axis = axis_of(found.eta, found.prebend, length)
        if np.abs(found.shift).max() < SETTLED:
            break
    assert found is not None
    return found, axis


def measured(
    cuts: Cutting,
    axis: ReferenceAxis,
    eta: Array,
    *,
    name: str,
    fairing: float | None = None,
    guide: Sections | None = None,
) -> Sections:
    """Measure sections at span fractions (k,) along an axis.

    Parameters
    ----------
    cuts : callable
        Cuts the surface by planes, as `Cutter.cuts`.
    guide : Sections, optional
        Sections measured before, which say where chord lines run about; by default they are
        tracked from y at 75 % of the span.

    Raises
    ------
    GeometryError
        If a plane cuts no section.
    """
    frames = flange_to_axis(axis, ROOT)(eta)
    origins = axis(eta)
    found = cuts(origins, frames)
    outlines = []
    for at, cut in zip(eta, found, strict=True):
        if len(cut.outline) < 8:
            raise GeometryError(f"{name}: no closed section at {100 * at:.2f} % of the span")
        outlines.append(_turned(cut.outline))
    rounded = np.array([is_round(outline) for outline in outlines])
    if guide is None:
        inner = np.flatnonzero(~rounded)
        if not inner.size:
            raise GeometryError(f"{name}: no blade: all its sections are round")
        rounded[inner[0] :] = False  # a round tip is no root
    else:
        rounded &= eta < guide.eta[~guide.rounded][0]
    edges = edges_of(outlines, eta, rounded) if guide is None else _guided(outlines, eta, guide)
    opened = edges.outlines
    u = landmark_parameters(LANDMARKS)
    points = np.stack([landmarks_of(one, u, fairing) for one in opened])
    curves = SectionSplines(u).fit(points)
    lead, chord = curves.leading_edge.copy(), curves.chord.copy()
    away = curves.trailing_edge - lead
    twist = np.arctan2(away[:, 1], away[:, 0])
    c, s = np.cos(twist), np.sin(twist)
    turn = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)  # columns: along, normal
    airfoils = (points - lead[:, None]) @ turn / chord[:, None, None]
    offset = -lead[:, 0] / c
    shift = lead[:, 1] + offset * s
    moved = origins + shift[:, None] * frames[:, 0]
    z = axis.z(1.0)
    order = np.argsort(moved[:, 2])
    prebend = np.interp(eta * z, moved[order, 2], moved[order, 0])
    return Sections(
        eta,
        chord,
        twist,
        offset,
        prebend,
        airfoils,
        curves.relative_thickness,
        rounded,
        edges.angles,
        edges.widths,
        edges.held,
        shift,
    )


def _turned(outline: Array) -> Array:
    """Return an outline with x toward the trailing edge and y toward suction, counter-clockwise."""
    return np.ascontiguousarray(outline[::-1, ::-1])


def _guided(outlines: list[Array], eta: Array, guide: Sections) -> Edges:
    """Open outlines about where sections measured before have their edges."""
    held = guide.eta[guide.held].max(initial=-1.0)
    angles = np.interp(eta, guide.eta, guide.angle)
    widths = np.interp(eta, guide.eta, guide.width)
    return edges_about(outlines, angles, widths, eta <= held)


def uncrossed(sections: Sections, name: str) -> tuple[Sections, tuple[str, ...]]:
    """Return sections of a cloud's surface with shapes that do not cross themselves; what was done.

    A surface through noise cannot narrow as a tip does.  A shape whose sides cross is that of the
    nearest section that is sound; chord, twist and place stay.

    Raises
    ------
    GeometryError
        If many sections cross themselves.
    """
    crossed = crossing_sections(sections.airfoils)
    if not crossed:
        return sections, ()
    sound = np.setdiff1d(np.arange(len(sections.eta)), crossed)
    if len(sound) < SOUND * len(sections.eta):
        raise GeometryError(
            f"{name}: {len(crossed)} of {len(sections.eta)} sections of the points' surface cross "
            "themselves; must be fewer: give more points, or points with less noise"
        )
    nearest = np.abs(sections.eta[:, None] - sections.eta[sound]).argmin(axis=1)
    rows = np.arange(len(sections.eta))
    rows[crossed] = sound[nearest[crossed]]
    low, high = sections.eta[[crossed[0], crossed[-1]]]
    place = f"at eta = {low:.4f}" if len(crossed) == 1 else f"of eta = {low:.4f} to {high:.4f}"
    said = (
        f"{len(crossed)} sections of the points' surface, {place}, cross themselves; they have the "
        "shapes of the nearest that do not"
    )
    own = replace(sections, airfoils=sections.airfoils[rows], thickness=sections.thickness[rows])
    return own, (said,)
