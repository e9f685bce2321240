"""Triangles of OCCT's shapes: a whole shape in metres, or one face as OCCT keeps it."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from bladegen.cad.shapes import MILLIMETRES, members
from bladegen.errors import CadError
from bladegen.support.arrays import Array, Indices
from bladegen.surface.mesh import TriangleMesh

__all__ = ["FaceTriangles", "by_face", "triangles_of", "triangulated", "welded"]

WELD = 1e-7  # m, within which points are one
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
    return replace(by_face(shape, members(shape, "face"), deflection), regions=None)


def by_face(shape: Any, faces: Sequence[Any], deflection: float) -> TriangleMesh:
    """Triangulate a shape as `triangulated` does; return some faces' triangles.

    Regions are their places among the faces.
    """
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.TopAbs import TopAbs_REVERSED
    from OCP.TopoDS import TopoDS

    BRepMesh_IncrementalMesh(shape, deflection * MILLIMETRES, False, ANGLE, True)
    points: list[Array] = []
    triangles: list[Indices] = []
    regions: list[Indices] = []
    count = 0
    for place, face in enumerate(map(TopoDS.Face_s, faces)):
        part = triangles_of(face)
        if part is None:
            continue
        back = face.Orientation() == TopAbs_REVERSED
        points.append(part.points / MILLIMETRES)
        triangles.append((part.corners[:, ::-1] if back else part.corners) + count)
        regions.append(np.full(len(part.corners), place))
        count += len(part.points)
    if not points:
        raise CadError("OCCT makes no triangles of this shape")
    mesh = TriangleMesh(np.concatenate(points), np.concatenate(triangles))
    return replace(mesh, regions=np.concatenate(regions))


def welded(mesh: TriangleMesh) -> TriangleMesh:
    """Return a mesh whose faces share vertices along common edges, without flat triangles.

    Points of one place differ by rounding where faces were moved differently.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    count = len(mesh.vertices)
    one, other = cKDTree(mesh.vertices).query_pairs(WELD, output_type="ndarray").T
    near = coo_array((np.ones(len(one)), (one, other)), shape=(count, count))
    place = connected_components(near, directed=False)[1]
    _, first = np.unique(place, return_index=True)
    faces = place[mesh.faces]
    full = ~(faces == np.roll(faces, 1, axis=1)).any(axis=1)
    regions = None if mesh.regions is None else mesh.regions[full]
    return TriangleMesh(mesh.vertices[first], faces[full], regions=regions)


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
