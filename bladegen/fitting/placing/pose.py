"""Where a blade lies in a file: unit, pitch axis, root and tip, suction side, handedness.

A pose maps points of a file to the blade frame, ``scale * points @ axes + origin``: z from root to
tip, x toward the suction side, y toward the trailing edge, metres.  Of a mirror image (a blade
whose rotor turns anticlockwise seen from upwind) `axes` has the determinant -1.
"""

from dataclasses import dataclass, replace

import numpy as np

from bladegen.fitting.sections.chains import Cut
from bladegen.fitting.sections.cutting import Cutter
from bladegen.measures.surfaces import Surface
from bladegen.support.arrays import Array
from bladegen.surface.mesh import TriangleMesh

__all__ = ["Pose", "cuts_across", "ends", "tilted"]


@dataclass(frozen=True, eq=False)
class Pose:
    """A map from a file's points to the blade frame.

    Parameters
    ----------
    scale : float
        Metres in the file's unit.
    axes : (3, 3) array
        Columns: the blade's x, y and z in the file's axes.
    origin : (3,) array
        The blade-frame image of the file's origin [m].
    said : tuple of str
        How it was found.
    """

    scale: float
    axes: Array
    origin: Array
    said: tuple[str, ...] = ()

    @property
    def mirrored(self) -> bool:
        """Whether the file holds the mirror image of the blade."""
        return bool(np.linalg.det(self.axes) < 0.0)

    def __call__(self, points: Array) -> Array:
        """Return points (..., 3) of the file in the blade frame [m]."""
        return np.asarray(self.scale * points @ self.axes + self.origin)

    def back(self, points: Array) -> Array:
        """Return points (..., 3) of the blade frame in the file's axes and unit."""
        return np.asarray((points - self.origin) @ self.axes.T / self.scale)

    def surface(self, surface: Surface) -> Surface:
        """Return a surface of the file in the blade frame."""
        faces = surface.mesh.faces[:, ::-1] if self.mirrored else surface.mesh.faces
        patches = tuple(replace(p, poles=self(p.poles)) for p in surface.patches)
        return replace(
            surface, mesh=TriangleMesh(self(surface.mesh.vertices), faces), patches=patches
        )

    def then(self, axes: Array, origin: Array) -> "Pose":
        """Return this pose followed by the map ``points @ axes + origin``."""
        return replace(self, axes=self.axes @ axes, origin=self.origin @ axes + origin)


def cuts_across(pose: Pose, surface: Surface, shares: Array) -> tuple[list[Cut], Array]:
    """Cut at shares of the length along z, normal to it; the cuts and their z."""
    placed = Surface(
        TriangleMesh(pose(surface.mesh.vertices), surface.mesh.faces),
        (),
        surface.owner,
        surface.uv,
    )
    low, high = (float(f(placed.mesh.vertices[:, 2])) for f in (np.min, np.max))
    z = low + shares * (high - low)
    origins = np.stack([0.0 * z, 0.0 * z, z], axis=1)
    frames = np.broadcast_to(np.eye(3), (len(z), 3, 3))
    return Cutter(placed).cuts(origins, frames), z


def ends(pose: Pose, surface: Surface) -> tuple[float, float]:
    """Return the least and the largest z of a surface [m]."""
    z = pose(surface.mesh.vertices)[:, 2]
    return float(z.min()), float(z.max())


def tilted(pose: Pose, normal: Array, through: Array) -> Pose:
    """Turn the direction `normal` to z by the shortest way, and a point of it to the axis."""
    x = np.cross([0.0, 1.0, 0.0], normal)
    x /= np.linalg.norm(x)
    axes = np.stack([x, np.cross(normal, x), normal], axis=1)
    moved = pose.then(axes, np.zeros(3))
    at = through @ axes
    return replace(moved, origin=moved.origin - [at[0], at[1], 0.0])
