"""Measuring a solid or a mesh that came from a file: topology, soundness, volume, area, extent.

Every figure is measured on the thing itself, never assumed from how it was made.  Lengths
are metres, volumes m3; STEP files state their unit, mesh files do not and are taken as they are.
"""

from typing import Any

import numpy as np

from bladegen.cad import shapes
from bladegen.support.arrays import Array
from bladegen.surface import mesh

__all__ = ["mesh_figures", "solid_figures"]

SLIVER = 1e-12  # of a mesh's extent; triangles lower than this are degenerate


def solid_figures(shape: Any, *, quick: bool = False) -> dict[str, Any]:
    """Measure a shape of OCCT [mm]: topology, validity, volume, area, bounding box.

    Sheets beside solids, such as webs, are counted and left out of all but validity.  `quick`
    takes OCCT's coarse volume, off by up to 1e-3: good for comparing a shape with
    its copy, not for quoting.
    """
    from OCP.Bnd import Bnd_Box
    from OCP.BRep import BRep_Tool
    from OCP.BRepBndLib import BRepBndLib

    whole, (shape, sheets) = shape, shapes.bodies(shape)
    solids, shells, faces = (shapes.members(shape, kind) for kind in ("solid", "shell", "face"))
    box = Bnd_Box()
    BRepBndLib.AddOptimal_s(shape, box, False, False)
    bounds = np.array(box.Get() if not box.IsVoid() else (0.0,) * 6) / shapes.MILLIMETRES
    volume = shapes.quick_volume if quick else shapes.volume
    return {
        "solids": len(solids),
        "shells": len(shells),
        "faces": len(faces),
        **({"sheets_beside": sheets} if sheets else {}),
        "valid": shapes.is_valid(whole),
        "closed": bool(shells) and all(BRep_Tool.IsClosed_s(shell) for shell in shells),
        "one_solid": len(solids) == 1,
        "volume_m3": volume(shape) / shapes.MILLIMETRES**3,
        "area_m2": shapes.area(shape) / shapes.MILLIMETRES**2,
        "bounds_m": _bounds(bounds.reshape(2, 3)),
    }


def mesh_figures(triangles: Any) -> dict[str, Any]:
    """Measure a trimesh.Trimesh: closedness, orientation, volume, area, bounding box."""
    own = mesh.TriangleMesh(triangles.vertices, triangles.faces)
    extent = float(np.ptp(own.vertices, axis=0).max())
    corners = np.asarray(triangles.triangles)
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    height = np.divide(
        2.0 * triangles.area_faces, longest, out=np.zeros_like(longest), where=longest > 0
    )
    degenerate = int(np.count_nonzero(height <= SLIVER * extent))
    watertight = bool(triangles.is_watertight)
    return {
        "triangles": len(triangles.faces),
        "vertices": len(triangles.vertices),
        "watertight": watertight,
        "outward": watertight and bool(triangles.is_winding_consistent and own.volume > 0),
        "degenerate_triangles": degenerate,
        "no_degenerate_triangle": degenerate == 0,
        "volume": own.volume,
        "area": own.area,
        "bounds": _bounds(np.asarray(triangles.bounds)),
    }


def _bounds(corners: Array) -> list[list[float]]:
    return [[round(float(value), 6) for value in corner] for corner in corners]
