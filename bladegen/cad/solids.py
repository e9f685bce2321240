"""A blade's B-spline net to a closed solid with named faces.

The net is handed to OCCT as poles, knots and multiplicities, cut at the leading edge into a
suction and a pressure side, and closed by a trailing-edge strip, a root plane and a tip.
Solids are in millimetres, as STEP files of machine parts are; everything else is in metres.
cadquery and OCP are imported when first needed.
"""

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.cad import pieces, shaping
from bladegen.cad.pieces import Patch
from bladegen.cad.shapes import MILLIMETRES, area, is_valid
from bladegen.cad.step_documents import Part
from bladegen.errors import CadError, visible
from bladegen.support.arrays import Array
from bladegen.support.threads import one_thread
from bladegen.surface.deviation import Deviation
from bladegen.surface.ends import edge_poles, rounded, tip_volume
from bladegen.surface.fitting import fitted
from bladegen.surface.net import BEZIER, CLOSED_EDGE, SurfaceNet
from bladegen.surface.regions import EDGE, ROOT, TIP, TIP_EDGE, colour
from bladegen.surface.tips import Tip, flat_tip

__all__ = ["DEFAULT_TOLERANCE", "Solid", "cap", "closed", "edge_strip", "solid"]

logger = logging.getLogger(__name__)
DIGITS = 6  # of a pole's coordinates in mm: nanometres; more would only make files larger
SEWING = 1e-4  # mm; edges of one net meet to rounding, so this is slack, not repair
NONE = np.zeros(0)  # knots that are not added
DEFAULT_TOLERANCE = 0.3e-3  # m


@dataclass(frozen=True, eq=False)
class Solid:
    """A valid closed solid of a blade.

    Parameters
    ----------
    shape : TopoDS_Solid
        OCCT's solid [mm].
    faces : tuple of (str, TopoDS_Face)
        Its faces by name.
    net : SurfaceNet
        The surface of its two sides [m].
    deviation : Deviation
        Of all faces from the blade.
    tip_volume : float
        What its tip holds beyond the plane of the last section [m3].
    name : str
        The blade's name.
    """

    shape: Any
    faces: tuple[tuple[str, Any], ...]
    net: SurfaceNet
    deviation: Deviation
    tip_volume: float
    name: str

    def __repr__(self) -> str:
        off = 1e3 * self.deviation.maximum
        return f"<Solid {visible(self.name)}: {len(self.faces)} faces, {off:.3g} mm off the blade>"

    @property
    def volume(self) -> float:
        """Volume [m3] inside all faces, its tip's included, exact but for rounding."""
        return self.net.volume() + self.tip_volume

    @property
    def area(self) -> float:
        """Surface area [m2], by OCCT."""
        return area(self.shape) / MILLIMETRES**2

    @property
    def part(self) -> Part:
        """The solid under its name, its faces named and in the colours of their regions."""
        return Part(self.name, self.shape, [(n, face, colour(n)) for n, face in self.faces])

    def workplane(self) -> Any:
        """Return the solid as a cadquery.Workplane [mm], to go on from in CadQuery."""
        import cadquery

        return cadquery.Workplane(cadquery.Solid(self.shape))


@one_thread()
def solid(
    blade: Blade,
    *,
    tolerance: float = DEFAULT_TOLERANCE,
    sections: int | None = None,
    spans: Array | None = None,
    tip: Tip = flat_tip,
    split: bool = False,
    progress: Callable[[str], None] = lambda _: None,
) -> Solid:
    """Make a blade's solid.

    Parameters
    ----------
    blade : Blade
        What to make; its trailing-edge policy decides between a strip and a sharp edge.
    tolerance : float
        Largest distance to the blade's sections aimed at [m]; `Solid.deviation` says what
        was reached.
    sections : int, optional
        Use exactly so many sections instead.
    spans : (k,) array, optional
        Knots along the span to begin with (`fitting.fitted`).
    tip : callable
        `tips.flat_tip` or `tips.round_tip`.
    split : bool
        Cut the sides in pieces, so that OCCT's default quadrature finds the volume to 1e-5
        (`pieces`); else each side is one face.
    progress : callable
        Told what is being done.

    Raises
    ------
    CadError
        If the result is not one valid closed solid.
    """
    net, deviation = fitted(
        blade, tolerance, sections=sections, spans=spans, tip=tip, progress=progress
    )
    logger.info(
        "%s: %d sections, %d poles, off the blade by %.4f mm at most (%s, eta = %.4f), %.5f mm RMS",
        blade.name,
        len(net.v),
        net.poles.size // 3,
        deviation.maximum * MILLIMETRES,
        deviation.face,
        deviation.eta,
        deviation.rms * MILLIMETRES,
    )
    if net.blunt and net.gaps.min() <= CLOSED_EDGE:
        raise CadError(
            f"{blade.name}: the trailing edge is sharp at some spans and blunt at others; give "
            "it a minimum thickness or make it sharp everywhere"
        )
    progress("building the solid")
    poles = net.poles * MILLIMETRES
    poles[:, 1:-1] = np.round(poles[:, 1:-1], DIGITS)  # root and tip stay in their planes
    scaled = replace(net, poles=poles)
    faces = _faces(scaled, blade.sides, net.blunt, tip, split)
    shape, named = closed(faces, blade.name)
    return Solid(shape, named, net, deviation, tip_volume(net, tip), blade.name)


def _faces(
    net: SurfaceNet, sides: tuple[str, str], blunt: bool, tip: Tip, split: bool
) -> list[tuple[str, Any]]:
    """Make the faces of a solid by name, in pieces if it is to be split."""
    suction, pressure = (Patch(h.poles, h.u_knots, h.v_knots) for h in net.halves())
    more_u = pieces.shorter(suction.u_knots, pieces.LONGEST_AROUND) if split else NONE
    more_v = pieces.shorter(net.v_knots, pieces.LONGEST_ALONG) if split else NONE
    suction = pieces.with_knots(suction, more_u, more_v)
    pressure = pieces.with_knots(pressure, pieces.mirrored(more_u), more_v)
    u = pieces.cuts(suction.u_knots, pieces.AROUND) if split else NONE
    v = pieces.cuts(suction.v_knots, pieces.ALONG) if split else NONE
    cut = [pieces.cut(suction, u, v), pieces.cut(pressure, pieces.mirrored(u), v)]
    faces = [
        face
        for name, rows in zip(sides, cut, strict=True)
        for face in _numbered(
            name, [shaping.face(shaping.surface(*p)) for row in rows for p in row]
        )
    ]
    if blunt:
        strip = edge_strip(net.poles, net.v_knots)
        rows = pieces.cut(pieces.with_knots(strip, NONE, more_v), NONE, v)
        faces += _numbered(EDGE, [shaping.face(shaping.surface(*row[0])) for row in rows])
    faces.append((ROOT, cap([p for rows in cut for p in rows[0]], 0, blunt)))
    return faces + tip_faces(net, tip, [p for rows in cut for p in rows[-1]], more_u, u)


def tip_faces(
    net: SurfaceNet, tip: Tip, around: list[Patch], more_u: Array = NONE, u: Array = NONE
) -> list[tuple[str, Any]]:
    """Make the faces that close a net's tip [mm] by name, flat within patches around it, or round.

    A round one has more knots about the chord, and is cut at some, if they are given.
    """
    poles = rounded(net, tip)
    if poles is None:
        return [(TIP, cap(around, -1, net.blunt))]
    # OCCT's quadrature takes as many points along u as v has knot spans: v goes to the nose
    own = Patch(poles.swapaxes(0, 1), BEZIER, net.halves()[0].u_knots)
    across = pieces.cut(pieces.with_knots(own, NONE, more_u), NONE, u)
    faces = _numbered(TIP, [shaping.face(shaping.surface(*row[0])) for row in across])
    if net.blunt:
        edge = shaping.surface(edge_poles(poles)[[-1, 0]], _LINEAR, BEZIER)
        faces.append((TIP_EDGE, shaping.face(edge)))
    return faces


def _numbered(name: str, faces: list[Any]) -> list[tuple[str, Any]]:
    """Name faces after their region, with numbers from the root on if there are several."""
    if len(faces) == 1:
        return [(name, faces[0])]
    return [(f"{name} {number}", face) for number, face in enumerate(faces, start=1)]


_LINEAR = np.array([0.0, 0.0, 1.0, 1.0])


def edge_strip(poles: Array, v_knots: Array) -> Patch:
    """Return the strip between the ends of a net's poles (a, b, 3): a blunt trailing edge."""
    return Patch(np.stack([poles[-1], poles[0]]), _LINEAR, v_knots)


def cap(around: list[Patch], end: int, blunt: bool) -> Any:
    """Make the plane face inside the section at an end, the first row or the last, of patches."""
    edges = [shaping.edge(shaping.curve(patch.poles[:, end], patch.u_knots)) for patch in around]
    if blunt:
        edges.append(shaping.line(around[-1].poles[-1, end], around[0].poles[0, end]))
    return shaping.filled(edges)


def closed(
    faces: list[tuple[str, Any]], name: str, slack: float = SEWING
) -> tuple[Any, tuple[tuple[str, Any], ...]]:
    """Sew faces that meet within a slack [mm] to one outward solid.

    Returned are the solid, and its faces by name in their order.

    Raises
    ------
    CadError
        If the result is not one valid closed solid.
    """
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeSolid
    from OCP.BRepLib import BRepLib
    from OCP.TopAbs import TopAbs_SHELL
    from OCP.TopoDS import TopoDS

    sewing, made = shaping.sewing([face for _, face in faces], slack)
    shell = sewing.SewedShape()
    if sewing.NbFreeEdges() or shell.ShapeType() != TopAbs_SHELL:
        raise CadError(f"{name}: the faces leave {sewing.NbFreeEdges()} free edges, allowed is 0")
    solid = BRepBuilderAPI_MakeSolid(TopoDS.Shell_s(shell)).Solid()
    BRepLib.OrientClosedSolid_s(solid)
    if not is_valid(solid):
        raise CadError(f"{name}: OCCT's check finds the solid invalid")
    return solid, tuple((label, face) for (label, _), face in zip(faces, made, strict=True))
