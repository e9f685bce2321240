"""A blade where it stands in its rotor: its surface, radii, and whether it fits into its sector."""

from dataclasses import replace
from math import degrees

import numpy as np

from bladegen.blade.aero.elements import elements_of
from bladegen.blade.blade import Blade
from bladegen.blade.outputs import at_least
from bladegen.cad.rotor import Rotor
from bladegen.errors import GeometryError
from bladegen.exports.cases.rotors.operation import REFERENCE
from bladegen.exports.cases.rotors.sector import Sector
from bladegen.support.arrays import Array
from bladegen.surface.mesh import TriangleMesh, from_blade

__all__ = ["edges", "radii", "require_clear", "standing"]

NOSE = 0.03  # of the way around a section, on both sides of its leading edge
TAIL = 0.01  # of it, ahead of its trailing edge on both sides
ROUND = 0.6  # relative thickness, from which sections are mostly cylinders
STATIONS = 150  # of the blade's triangles
CLEAR = 0.95  # of the sector's half angle, within which the blade must be


def radii(blade: Blade, rotor: Rotor) -> tuple[float, float]:
    """Return how far from the axis the tip is, and the section that stands for the blade."""
    plain = blade.mirror_image() if blade.mirrored else blade
    sections = plain.sections(np.array([0.0, REFERENCE, 1.0]))
    _, reach, tip = elements_of(sections[None], rotor.hub_radius, rotor.cone).radius[0].tolist()
    return tip, reach


def standing(blade: Blade, rotor: Rotor, pitch: float) -> TriangleMesh:
    """Return the blade's surface in the rotor's frame, pitched."""
    made = from_blade(blade, stations=len(at_least(blade, STATIONS)))
    c, s = np.cos(pitch), np.sin(pitch) * (-1.0 if blade.mirrored else 1.0)
    pitched = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])  # the nose, -y, to -x
    rotations, shifts = rotor.placements()
    return replace(made, vertices=made.vertices @ (rotations[0] @ pitched).T + shifts[0])


def edges(blade: Blade, surface: TriangleMesh) -> TriangleMesh:
    """Return the part of a blade's surface around both edges of its airfoils."""
    assert surface.places is not None  # a blade's mesh has them
    assert surface.regions is not None
    eta, u = surface.places.T
    spans, which = np.unique(eta, return_inverse=True)
    thin = (blade.relative_thickness(spans) < ROUND)[which]
    away = np.abs(u - 0.5)  # from the leading edge
    near = (away < NOSE) | (away > 0.5 - TAIL)
    kept = np.all((thin & near)[surface.faces], axis=1)
    used, faces = np.unique(surface.faces[kept], return_inverse=True)
    return TriangleMesh(surface.vertices[used], faces.reshape(-1, 3), regions=surface.regions[kept])


def require_clear(blade: Blade, sector: Sector, points: Array) -> None:
    """See that the blade's points (v, 3), where air flows, are off the sector's sides."""
    radius = np.hypot(points[:, 1], points[:, 2])
    outer = points[radius > sector.hub]
    angle = float(np.abs(np.arctan2(outer[:, 1], outer[:, 2])).max())
    if angle > CLEAR * sector.half:
        raise GeometryError(
            f"{blade.name}: reaches {degrees(angle):.1f} degrees to the side at the hub, allowed "
            f"is {degrees(CLEAR * sector.half):.1f} in a sector of {2 * degrees(sector.half):g}; "
            "give a larger hub radius (--hub-radius LENGTH)"
        )
