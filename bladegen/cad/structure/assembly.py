"""A blade's skin cut where layers end, its webs and its inner surface, as named parts of STEP.

The skin is the solid's own surface: zones are cut out of it by curves in its parameters, so that
nothing moves.  Webs are ruled between the same curves on both sides; the inner surface is a net of
its own (`bladegen.surface.inner`).  Millimetres; OCP comes late.
"""

from collections import Counter
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.layup.layup import Layup
from bladegen.cad import pieces, shaping, step_documents
from bladegen.cad.pieces import Patch
from bladegen.cad.shapes import MILLIMETRES, area
from bladegen.cad.solids import Solid, cap, closed, edge_strip, tip_faces
from bladegen.cad.step_documents import Part
from bladegen.cad.structure.inner_part import inner_part
from bladegen.cad.structure.zones import Bay, bays_of
from bladegen.errors import Finding
from bladegen.support.arrays import Array
from bladegen.surface.inner.inner import TOLERANCE
from bladegen.surface.regions import EDGE, ROOT, colour
from bladegen.surface.tips import Tip, flat_tip

__all__ = ["Inside", "inside", "write_structure"]

SEWING = 1e-2  # mm; edges of zones are followed in space within `shaping.NEAR`
SHADES = (  # sRGB; of zones, by the first of the layers that cover a part of the section
    (0, 114, 178),
    (230, 159, 0),
    (0, 158, 115),
    (204, 121, 167),
    (86, 180, 233),
    (240, 228, 66),
)
WEB = (120, 94, 240)
MISSED = 0.02  # of a layer's area
LOOKED_AT = 4001  # spans


@dataclass(frozen=True, eq=False)
class Inside:
    """A blade's skin, webs and inner surface.

    Parameters
    ----------
    skin : Part
        A closed solid; the faces of its sides and of its trailing edge carry the names of layers
        that cover a part of the section.
    webs : tuple of Part
        Faces between the sides.
    inner : Part or None
        The inner side of the skin's wall, open at root and tip; None where it cannot be had.
    wall : dict of float
        Area of the inner surface [m2], volume between it and the skin, of the skin's layers, and
        of those that have no room [m3], and how far it strays from them [m].
    areas : dict of float
        Area [m2] of the faces of each layer of the skin, and of each web.
    findings : tuple of Finding
        Layers whose faces are larger or smaller than they are by more than `MISSED`, and what is
        to be said of the inner surface.
    """

    skin: Part
    webs: tuple[Part, ...]
    inner: Part | None
    wall: dict[str, float]
    areas: dict[str, float]
    findings: tuple[Finding, ...]


@dataclass(frozen=True, eq=False)
class _Zone:
    """A face, its side, the layers that cover it, and those that cover but a part of a section."""

    side: str
    layers: tuple[str, ...]
    partly: tuple[str, ...]
    face: Any

    @property
    def name(self) -> str:
        return f"{self.side}: {' + '.join(self.partly)}" if self.partly else self.side


def inside(solid: Solid, layup: Layup, tolerance: float = TOLERANCE, tip: Tip = flat_tip) -> Inside:
    """Return the skin, webs and inner surface of a blade.

    Parameters
    ----------
    solid : Solid
        The blade's.
    layup : Layup
        Its layers and webs.
    tolerance : float
        Largest distance of the inner surface to where layers end aimed at [m].
    tip : callable
        The solid's; webs and inner surface end at the last section.

    Raises
    ------
    CadError
        If the skin is not one valid closed solid.
    """
    net, order = solid.net, [layer.name for layer in layup.structure.layers]
    bays = bays_of(layup, net.v)
    breaks = np.array([bay.v[0] for bay in bays[1:]])
    halves = [Patch(h.poles * MILLIMETRES, h.u_knots, h.v_knots) for h in net.halves()]
    cut = [pieces.cut(half, np.zeros(0), breaks) for half in halves]
    zones, webs, areas = list[_Zone](), dict[str, list[Any]](), Counter[str]()
    corners = [_corners(*two) for two in pairwise([None, *bays, None])]
    for k, bay in enumerate(bays):
        lines = list[Any]()
        for line, layers in enumerate(bay.layers):
            half = int(line >= bay.nose)
            on = shaping.surface(*_about(cut[half][k][0], *bay.lines[line : line + 2]))
            left, right = (_along(on, bay, one) for one in (line, line + 1))
            start, end = (
                _across(on, bay.lines[line : line + 2, at], bay.v[at], corners[k - at])
                for at in (0, -1)
            )
            face = shaping.face_within(on, [*start, right, *end[::-1], left])
            partly = tuple(name for name in layers if name not in bay.whole)
            zones.append(_Zone(layup.blade.sides[half], layers, partly, face))
            lines = [*lines[:-1], left, right]
        for web, (foot, other) in bay.feet.items():
            webs.setdefault(web, []).append(shaping.ruled(lines[foot], lines[other]))
    scaled = replace(net, poles=net.poles * MILLIMETRES)
    others = [(ROOT, cap(halves, 0, net.blunt)), *tip_faces(scaled, tip, halves)]
    if net.blunt:
        strip = edge_strip(net.poles * MILLIMETRES, net.v_knots)
        rows = pieces.cut(strip, np.zeros(0), breaks)
        for bay, row in zip(bays, rows, strict=True):
            face = shaping.face(shaping.surface(*row[0]))
            for covering in bay.edge:
                areas.update(dict.fromkeys(covering, 0.5 * area(face) / MILLIMETRES**2))
            there = {*bay.edge[0], *bay.edge[1]} - bay.whole
            zones.append(_Zone(EDGE, (), tuple(filter(there.__contains__, order)), face))
    sheets = tuple(_sheet(web, faces) for web, faces in webs.items())
    for zone in zones:
        areas.update(dict.fromkeys(zone.layers, area(zone.face) / MILLIMETRES**2))
    skin, found = _skin(solid.name, zones, others, areas), _missed(layup, areas)
    areas.update({part.name: area(part.shape) / MILLIMETRES**2 for part in sheets})
    inner, wall, said = inner_part(net, layup, tolerance)
    return Inside(skin, sheets, inner, wall, dict(areas), found + said)


def _skin(
    name: str, zones: list[_Zone], others: list[tuple[str, Any]], areas: Counter[str]
) -> Part:
    """Return the closed solid of all faces; zones are numbered from the root on.

    A zone has the shade of that of its layers which is the smallest.
    """
    order = {layer: i for i, layer in enumerate(areas)}
    counted, faces = Counter[str](), list[tuple[str, Any]]()
    shades = list[tuple[int, int, int] | None]()
    for zone in zones:
        counted[zone.name] += 1
        faces.append((f"{zone.name} {counted[zone.name]}", zone.face))
        own = min(zone.partly, key=areas.__getitem__, default="")
        shades.append(SHADES[order[own] % len(SHADES)] if own else colour(zone.side))
    shape, named = closed([*faces, *others], name, SEWING)
    shades += [colour(label) for label, _ in others]
    return Part("skin", shape, [(*one, shade) for one, shade in zip(named, shades, strict=True)])


def _missed(layup: Layup, areas: Counter[str]) -> tuple[Finding, ...]:
    """Return which layers of the skin have faces of another area than their own."""
    eta = np.linspace(0.0, 1.0, LOOKED_AT)
    laid = layup.at(eta)
    steps = np.linalg.norm(layup.blade.definition.axis(eta, 1), axis=-1)
    own = np.trapezoid(laid.width * (laid.thickness > 0.0) * steps, eta)
    found = []
    for layer, whole in zip(layup.structure.layers, own.tolist(), strict=True):
        made = areas[layer.name]
        if not layer.web and abs(made - whole) > MISSED * whole:
            said = f"its faces in STEP have {made:.4g} m2, the layer {whole:.4g} m2"
            found.append(Finding(f"structure: {layer.name}", said))
    return tuple(found)


def _sheet(web: str, faces: list[Any]) -> Part:
    shell, made = shaping.sewn(faces, SEWING)
    return Part(web, shell, [(f"{web} {i}", face, WEB) for i, face in enumerate(made, start=1)])


def _corners(before: Bay | None, behind: Bay | None) -> Array:
    """Return where lines of two neighbours end between them."""
    ends = [bay.lines[:, at] for bay, at in ((before, -1), (behind, 0)) if bay is not None]
    return np.unique(np.concatenate(ends))


def _about(patch: Patch, left: Array, right: Array) -> Patch:
    """Return the part of a surface, from knot to knot, that holds what lies between two lines."""
    knots = np.unique(patch.u_knots)
    low = knots[knots <= left.min()].max(initial=knots[0])
    high = knots[knots >= right.max()].min(initial=knots[-1])
    inner = [place for place in (low, high) if knots[0] < place < knots[-1]]
    return pieces.cut(patch, np.array(inner), np.zeros(0))[0][int(low > knots[0])]


def _along(on: Any, bay: Bay, line: int) -> Any:
    """Return the edge along a line of a bay, C1."""
    u, v = bay.lines[line], bay.v
    if np.all(u == u[0]):
        return shaping.segment_on(on, (u[0], v[0]), (u[0], v[-1]))
    flat = np.stack([u, v], axis=-1)
    third = np.diff(v)[:, None] / 3.0
    tangents = np.stack([bay.slopes[line], np.ones(len(v))], axis=-1)
    inner = np.stack([flat[:-1] + third * tangents[:-1], flat[1:] - third * tangents[1:]], axis=1)
    poles = np.concatenate([flat[:1], inner.reshape(-1, 2), flat[-1:]])
    return shaping.edge_on(on, poles, np.repeat(v, [4, *[2] * (len(v) - 2), 4]))


def _across(on: Any, between: Array, v: float, corners: Array) -> list[Any]:
    """Return the edges from one line to the next at a span, one between two corners each."""
    inner = corners[(corners > between[0]) & (corners < between[1])]
    places = [between[0], *inner, between[1]]
    return [shaping.segment_on(on, (a, v), (b, v)) for a, b in pairwise(places)]


def write_structure(made: Inside, name: str, path: Path, **options: Any) -> None:
    """Write all parts as a STEP assembly; options as of `step_documents`.

    Raises
    ------
    CadError
        If OCCT cannot write the file.
    """
    parts = [made.skin, *made.webs, *([] if made.inner is None else [made.inner])]
    step_documents.write_parts(f"{name} structure", parts, path, **options)
