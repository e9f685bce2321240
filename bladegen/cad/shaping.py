"""Poles and knots to OCCT's surfaces, curves, edges and faces.  OCP is imported when needed."""

from typing import Any

import numpy as np

from bladegen.errors import CadError
from bladegen.support.arrays import Array

__all__ = [
    "curve",
    "edge",
    "edge_on",
    "face",
    "face_within",
    "filled",
    "line",
    "ruled",
    "segment_on",
    "sewing",
    "sewn",
    "surface",
    "wire",
]

NEAR = 1e-3  # mm; of a curve in space from the same curve in a surface's parameters


def surface(poles: Array, u_knots: Array, v_knots: Array) -> Any:
    """Hand a net to OCCT; degrees follow from the numbers of poles and knots."""
    from OCP.Geom import Geom_BSplineSurface
    from OCP.gp import gp_Pnt
    from OCP.TColgp import TColgp_Array2OfPnt

    rows, columns = poles.shape[:2]
    points = TColgp_Array2OfPnt(1, rows, 1, columns)
    for i, row in enumerate(poles.tolist(), start=1):
        for j, (x, y, z) in enumerate(row, start=1):
            points.SetValue(i, j, gp_Pnt(x, y, z))

    (u, mu), (v, mv) = _knots(u_knots), _knots(v_knots)
    degrees = len(u_knots) - rows - 1, len(v_knots) - columns - 1
    return Geom_BSplineSurface(points, u, v, mu, mv, *degrees, False, False)


def curve(poles: Array, knots: Array) -> Any:
    """Hand a row of poles to OCCT, as `surface` does a net."""
    from OCP.Geom import Geom_BSplineCurve
    from OCP.gp import gp_Pnt
    from OCP.TColgp import TColgp_Array1OfPnt

    points = TColgp_Array1OfPnt(1, len(poles))
    for i, (x, y, z) in enumerate(poles.tolist(), start=1):
        points.SetValue(i, gp_Pnt(x, y, z))
    return Geom_BSplineCurve(points, *_knots(knots), len(knots) - len(poles) - 1, False)


def _knots(knots: Array) -> tuple[Any, Any]:
    """Return distinct knots and their multiplicities as OCCT's arrays."""
    from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

    values, counts = np.unique(knots, return_counts=True)
    reals = TColStd_Array1OfReal(1, len(values))
    integers = TColStd_Array1OfInteger(1, len(values))
    for i, (value, count) in enumerate(zip(values.tolist(), counts.tolist(), strict=True), start=1):
        reals.SetValue(i, value)
        integers.SetValue(i, count)
    return reals, integers


def face(on: Any) -> Any:
    """Make the face that is all of a surface."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace

    return BRepBuilderAPI_MakeFace(on, 1e-7).Face()


def edge(along: Any) -> Any:
    """Make the edge that is all of a curve."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge

    return BRepBuilderAPI_MakeEdge(along).Edge()


def line(start: Array, end: Array) -> Any:
    """Make the straight edge between two points."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.gp import gp_Pnt

    return BRepBuilderAPI_MakeEdge(gp_Pnt(*start.tolist()), gp_Pnt(*end.tolist())).Edge()


def wire(edges: list[Any]) -> Any:
    """Make the wire of edges that follow one another."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeWire

    maker = BRepBuilderAPI_MakeWire()
    for one in edges:
        maker.Add(one)
    return maker.Wire()


def filled(edges: list[Any]) -> Any:
    """Make the plane face that a closed loop of edges encloses."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace

    made = BRepBuilderAPI_MakeFace(wire(edges), True)
    if not made.IsDone():
        raise CadError("an end of the blade does not lie in a plane")
    return made.Face()


def edge_on(on: Any, poles: Array, knots: Array) -> Any:
    """Make the edge along a spline (n, 2) in the parameters of a surface."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.BRepLib import BRepLib
    from OCP.Geom2d import Geom2d_BSplineCurve
    from OCP.gp import gp_Pnt2d
    from OCP.TColgp import TColgp_Array1OfPnt2d

    points = TColgp_Array1OfPnt2d(1, len(poles))
    for i, (u, v) in enumerate(poles.tolist(), start=1):
        points.SetValue(i, gp_Pnt2d(u, v))
    flat = Geom2d_BSplineCurve(points, *_knots(knots), len(knots) - len(poles) - 1, False)
    made = BRepBuilderAPI_MakeEdge(flat, on).Edge()
    if not BRepLib.BuildCurve3d_s(made, NEAR):
        raise CadError("OCCT found no curve in space along a line on the surface")
    return made


def segment_on(on: Any, start: tuple[float, float], end: tuple[float, float]) -> Any:
    """Make the edge along a straight line in the parameters of a surface."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.BRepLib import BRepLib
    from OCP.GCE2d import GCE2d_MakeSegment
    from OCP.gp import gp_Pnt2d

    flat = GCE2d_MakeSegment(gp_Pnt2d(*start), gp_Pnt2d(*end)).Value()
    made = BRepBuilderAPI_MakeEdge(flat, on).Edge()
    BRepLib.BuildCurve3d_s(made, NEAR)
    return made


def face_within(on: Any, edges: list[Any]) -> Any:
    """Make the face of a surface that a closed loop of edges on it encloses."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace

    made = BRepBuilderAPI_MakeFace(on, wire(edges), True)
    if not made.IsDone():
        raise CadError(f"OCCT made no face of a loop of edges ({made.Error().name})")
    return made.Face()


def ruled(first: Any, second: Any) -> Any:
    """Make the face of straight lines between two edges that run the same way."""
    from OCP.BRepFill import BRepFill

    return BRepFill.Face_s(first, second)


def sewing(faces: list[Any], slack: float) -> tuple[Any, list[Any]]:
    """Sew faces that meet within a slack [mm]; return OCCT's sewing, and its faces in order."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Sewing
    from OCP.TopoDS import TopoDS

    done = BRepBuilderAPI_Sewing(slack)
    for one in faces:
        done.Add(one)
    done.Perform()
    made = [TopoDS.Face_s(done.Modified(one) if done.IsModified(one) else one) for one in faces]
    return done, made


def sewn(faces: list[Any], slack: float) -> tuple[Any, list[Any]]:
    """Sew faces that meet within a slack [mm] to a shell; return it, and its faces in order."""
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Shell

    _, made = sewing(faces, slack)
    shell, builder = TopoDS_Shell(), BRep_Builder()
    builder.MakeShell(shell)
    for one in made:
        builder.Add(shell, one)
    return shell, made
