"""A CAD shape's faces as arrays: exact B-spline patches, and triangles where there is more to it.

Faces on B-splines that end where these do are patches alone; trimmed ones have rims in (u, v) and
OCCT's triangles with their parameters.  Other surfaces (planes, cylinders, spheres, ...) are turned
into B-splines, rational ones where need be, which is exact.  Metres.
OCP is imported when first needed.
"""

from typing import Any

import numpy as np

from bladegen.cad.shapes import MILLIMETRES, members
from bladegen.cad.triangles import ANGLE, triangles_of
from bladegen.errors import CadError
from bladegen.support.arrays import Array

__all__ = ["faces"]

FINE = 0.05  # mm, of triangles on faces that OCCT makes no B-spline of
DEFLECTION = 1.0  # mm, of triangles on trimmed patches, where the search for feet begins
SAME = 1e-9  # of a surface's range: bounds that agree to this are its own
WHOLE = 1e-6  # of the area in (u, v): rims that enclose all but this trim nothing
ALONG = 32  # points of a rim in each span of a curve
STRAIGHT = 2048  # and on a straight one, which is none in space
LIGHTEST = 1e-9  # of the largest weight; a surface with lighter poles may be nowhere
LEAST, MOST = 512, 20_000  # of one edge


def faces(shape: Any) -> tuple[dict[str, Any], int]:
    """Return a shape's faces as arrays.

    Parameters
    ----------
    shape : TopoDS_Shape
        OCCT's shape [mm].

    Returns
    -------
    dict of arrays
        For face k, as far as it has them: `k/poles` (a, b, 3) [m], `k/u`, `k/v` knots,
        `k/weights` (a, b), `k/rims` (m, 2) and `k/starts` of each line among them; `k/vertices`
        [m], `k/triangles`, `k/uv` at the vertices; `k/sign`.
    int
        How many faces could not be turned into any of it.

    Raises
    ------
    CadError
        If that is all of them.
    """
    from OCP.TopoDS import TopoDS

    found: dict[str, Any] = {}
    count = lost = 0
    for face in map(TopoDS.Face_s, members(shape, "face")):
        parts = _face(face)
        if not parts:
            lost += 1
            continue
        found |= {f"{count}/{name}": values for name, values in parts.items()}
        count += 1
    if not count:
        raise CadError("has no face that OCCT can make triangles of")
    return found, lost


def _face(face: Any) -> dict[str, Any]:
    from OCP.TopAbs import TopAbs_REVERSED

    sign = -1.0 if face.Orientation() == TopAbs_REVERSED else 1.0
    patch = _patch(face)
    if patch and "rims" not in patch:
        return patch | {"sign": np.array(sign)}
    flat = _triangles(patch.pop("face", face), DEFLECTION if patch else FINE, sign)
    return patch | flat | {"sign": np.array(sign)} if flat else {}


def _patch(face: Any) -> dict[str, Any]:
    """Return a face's B-spline, and its rims if it is trimmed; nothing where OCCT fails."""
    from OCP.Standard import Standard_Failure

    try:
        face, surface = _spline(face)
        if surface is None:
            return {}
        parts = _arrays(surface)
        weights = parts.get("weights", np.ones(1))
        if not weights.min() > LIGHTEST * weights.max():
            return {}
        rims = _rims(face)
    except (Standard_Failure, RuntimeError):
        return {}
    sizes = np.array([np.ptp(parts[name]) for name in ("u", "v")])
    places = np.concatenate(rims) - [parts["u"][0], parts["v"][0]]
    if not np.all((places > -sizes) & (places < 2.0 * sizes)):  # a turn of a period away
        return {}
    if abs(abs(_area(rims)) / np.prod(sizes) - 1.0) < WHOLE:
        return parts
    starts = np.cumsum([0, *(len(rim) for rim in rims)])
    return parts | {"rims": np.concatenate(rims), "starts": starts, "face": face}


def _spline(face: Any) -> tuple[Any, Any]:
    """Return a face on a B-spline surface, its own or one made of it, and the surface."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert
    from OCP.BRepTools import BRepTools
    from OCP.Geom import Geom_BSplineSurface, Geom_RectangularTrimmedSurface
    from OCP.GeomConvert import GeomConvert
    from OCP.TopoDS import TopoDS

    surface = BRep_Tool.Surface_s(face)
    if not isinstance(surface, Geom_BSplineSurface):
        face = TopoDS.Face_s(BRepBuilderAPI_NurbsConvert(face, True).Shape())
        surface = BRep_Tool.Surface_s(face)
        if not isinstance(surface, Geom_BSplineSurface):
            return face, None
    asked, own = BRepTools.UVBounds_s(face), surface.Bounds()
    same = all(abs(a - o) <= SAME * (1.0 + abs(o)) for a, o in zip(asked, own, strict=True))
    if not same or surface.IsUPeriodic() or surface.IsVPeriodic():
        box = Geom_RectangularTrimmedSurface(surface, *asked, True, True)
        surface = GeomConvert.SurfaceToBSplineSurface_s(box)
        if surface.IsUPeriodic():
            surface.SetUNotPeriodic()
        if surface.IsVPeriodic():
            surface.SetVNotPeriodic()
    return face, surface


def _arrays(surface: Any) -> dict[str, Any]:
    rows, columns = surface.NbUPoles(), surface.NbVPoles()
    poles = np.array(
        [[surface.Pole(i + 1, j + 1).Coord() for j in range(columns)] for i in range(rows)]
    )
    parts = {"poles": poles / MILLIMETRES}
    for name, sequence in (("u", surface.UKnotSequence()), ("v", surface.VKnotSequence())):
        parts[name] = np.array([sequence.Value(i) for i in range(1, sequence.Length() + 1)])
    if surface.IsURational() or surface.IsVRational():
        parts["weights"] = np.array(
            [[surface.Weight(i + 1, j + 1) for j in range(columns)] for i in range(rows)]
        )
    return parts


def _rims(face: Any) -> list[Array]:
    """Return a face's edges as lines (m, 2) in its parameters, in the sense of their wires."""
    from OCP.BRepAdaptor import BRepAdaptor_Curve2d
    from OCP.GeomAbs import GeomAbs_BSplineCurve, GeomAbs_Line
    from OCP.TopAbs import TopAbs_REVERSED
    from OCP.TopoDS import TopoDS

    found = []
    for edge in map(TopoDS.Edge_s, members(face, "edge")):
        curve = BRepAdaptor_Curve2d(edge, face)
        spans = curve.NbKnots() - 1 if curve.GetType() == GeomAbs_BSplineCurve else ALONG
        count = (
            STRAIGHT
            if curve.GetType() == GeomAbs_Line
            else int(np.clip(ALONG * spans, LEAST, MOST))
        )
        ends = [curve.FirstParameter(), curve.LastParameter()]
        if edge.Orientation() == TopAbs_REVERSED:
            ends.reverse()
        t = np.linspace(ends[0], ends[1], count)
        found.append(np.array([curve.Value(x).Coord() for x in t.tolist()]))
    return found


def _triangles(face: Any, deflection: float, sign: float) -> dict[str, Any]:
    """Return OCCT's triangles of a face, looking outward, with parameters at their corners."""
    from OCP.BRepMesh import BRepMesh_IncrementalMesh

    BRepMesh_IncrementalMesh(face, deflection, False, ANGLE, True)
    made = triangles_of(face)
    if made is None:
        return {}
    corners = made.corners if sign > 0 else made.corners[:, ::-1]
    return {"vertices": made.points / MILLIMETRES, "triangles": corners, "uv": made.uv}


def _area(rims: list[Array]) -> float:
    """Return the area that lines enclose together."""
    ends = ((rim[:-1], rim[1:]) for rim in rims)
    return 0.5 * sum(float(np.sum(a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1])) for a, b in ends)
