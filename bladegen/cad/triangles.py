"""Triangles of OCCT's shapes: a whole shape in metres, or one face as OCCT keeps it."""

from typing import Any, NamedTuple

import numpy as np

from bladegen.cad.shapes import MILLIMETRES, members
from bladegen.errors import CadError
from bladegen.support.arrays import Array, Indices
from bladegen.surface.mesh import TriangleMesh

__all__ = ["FaceTriangles", "triangles_of", "triangulated"]

ANGLE = 0.3  # rad, the largest turn from triangle to triangle; noses need it besides deflection


def triangulated(shape: Any, deflection: float) -> TriangleMesh:
    """Triangulate a shape.

    Parameters
    ----------
    shape : TopoDS_Shape
        OCCT's shape [mm].
    deflection : float
        Largest distance of the triangles to the shape aimed at [m].

    Returns
    -------
    TriangleMesh
        In metres; faces of the shape have vertices of their own along common edges.

    Raises
    ------
    CadError
        If OCCT makes no triangles of it.
    """
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.TopAbs import TopAbs_REVERSED
    from OCP.TopoDS import TopoDS

    BRepMesh_IncrementalMesh(shape, deflection * MILLIMETRES, False, ANGLE, True)
    points: list[Array] = []
    triangles: list[Indices] = []
    count = 0
    for face in map(TopoDS.Face_s, members(shape, "face")):
        part = triangles_of(face)
        if part is None:
            continue
        back = face.Orientation() == TopAbs_REVERSED
        points.append(part.points / MILLIMETRES)
        triangles.append((part.corners[:, ::-1] if back else part.corners) + count)
        count += len(part.points)
    if not points:
        raise CadError("OCCT makes no triangles of this shape")
    return TriangleMesh(np.concatenate(points), np.concatenate(triangles))


class FaceTriangles(NamedTuple):
    """A face's triangles as OCCT keeps them, whichever way the face looks.

    Parameters
    ----------
    points : (v, 3) array
        Corners [mm].
    corners : (f, 3) array of int
        Of each triangle.
    uv : (v, 2) array
        Parameters of the points on the face's surface.
    """

    points: Array
    corners: Indices
    uv: Array


def triangles_of(face: Any) -> FaceTriangles | None:
    """Return the triangles of a face that `BRepMesh` has meshed, None where it failed."""
    from OCP.BRep import BRep_Tool
    from OCP.TopLoc import TopLoc_Location

    place = TopLoc_Location()
    part = BRep_Tool.Triangulation_s(face, place)
    if part is None or not part.NbTriangles():
        return None
    move, count = place.Transformation(), range(1, part.NbNodes() + 1)
    points = [part.Node(i).Transformed(move).Coord() for i in count]
    corners = [part.Triangle(i).Get() for i in range(1, part.NbTriangles() + 1)]
    uv = [part.UVNode(i).Coord() for i in count] if part.HasUVNodes() else np.zeros((0, 2))
    return FaceTriangles(np.array(points), np.array(corners) - 1, np.array(uv))
