"""The root of a blade: its flange, its circle, and so the pitch axis.

The flange is flat and normal to the pitch axis, which goes through the middle of the root.  Where
there is no flange, circles of a round root say where the axis is.
"""

from dataclasses import replace

import numpy as np

from bladegen.fitting.placing.pose import Pose, cuts_across, ends, tilted
from bladegen.fitting.sections.outlines import circle_of, is_round
from bladegen.measures.surfaces import Surface
from bladegen.support.arrays import Array

__all__ = ["upright"]

FEW = 5  # points that an outline has more than
ROOT = np.linspace(0.002, 0.06, 30)  # of the span, where a round root is sought
END = 0.02  # of the span, within which a flange lies
FLAT = 0.95  # of a flange's normal along the blade, at first
RING = 0.02  # of the squared diameter that a flange's area is at least
LEAST_RIM = 8  # points of a rim
THIN = 0.01  # of a rim's size, which it leaves its plane by at most


def upright(pose: Pose, surface: Surface, said: list[str]) -> tuple[Pose, float]:
    """Bring the root's flange to z = 0 and its middle to the axis; also return its diameter.

    Where there is no flange, the axis of a round root is brought to z.
    """
    flat = False
    for _ in range(3):
        low, high = ends(pose, surface)
        normal = _flange(pose, surface, low + END * (high - low))
        if normal is None:
            break
        flat = True
        pose = tilted(pose, normal, np.zeros(3))
    cuts, z = cuts_across(pose, surface, ROOT)
    known = [k for k, cut in enumerate(cuts) if len(cut.outline) > FEW and is_round(cut.outline)]
    run = _first_run(known)
    if run and not flat and len(run) > 2:
        for _ in range(3):
            centres = np.array([[*circle_of(cuts[k].outline)[0], z[k]] for k in run])
            slope, offset = np.polyfit(centres[:, 2], centres[:, :2], 1)
            normal = np.array([*slope, 1.0]) / np.hypot(1.0, np.hypot(*slope))
            pose = tilted(pose, normal, np.array([*offset, 0.0]))
            cuts, z = cuts_across(pose, surface, ROOT)
            run = [k for k in run if len(cuts[k].outline) > 7]
    first = next((k for k, cut in enumerate(cuts) if len(cut.outline)), 0)
    outline = cuts[run[0] if run else first].outline
    if run:
        middle, radius = circle_of(outline)
        said.append(f"the root is a circle of {2.0 * radius:.4g} m")
    else:
        middle = 0.5 * (outline.min(axis=0) + outline.max(axis=0))
        radius = 0.5 * float(np.ptp(outline, axis=0).max())
        said.append("the root is no circle: the pitch axis goes through its middle")
    ways = {True: "normal to the root's flange", False: "the middle of the root's circles"}
    if run or flat:
        said.append(f"the pitch axis is {ways[flat]}")
    else:
        said.append("the pitch axis is along the blade: it has neither a flange nor a round root")
    low, _ = ends(pose, surface)
    return replace(pose, origin=pose.origin - [*middle, low]), 2.0 * radius


def _flange(pose: Pose, surface: Surface, below: float) -> Array | None:
    """Return the normal of the flat end of a root below a height, or of its rim; None if none."""
    vertices, faces = pose(surface.mesh.vertices), surface.mesh.faces
    some = faces[(vertices[:, 2] < below)[faces].all(axis=1)]
    a, b, c = (vertices[some[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals *= np.where(normals[:, 2:] < 0.0, -1.0, 1.0)
    size = np.linalg.norm(normals, axis=1)
    flat = normals[:, 2] > FLAT * size
    if flat.any():
        total = normals[flat].sum(axis=0)
        width = float(np.ptp(vertices[vertices[:, 2] < below, :2], axis=0).max())
        if 0.5 * np.linalg.norm(total) > RING * width**2:
            return np.asarray(total / np.linalg.norm(total))
    edges = np.sort(np.concatenate([some[:, [0, 1]], some[:, [1, 2]], some[:, [2, 0]]]), axis=1)
    if not len(edges):
        return None
    edges, count = np.unique(edges, axis=0, return_counts=True)
    rim = np.unique(edges[count == 1])
    low = vertices[rim, 2]
    rim = rim[low < low.min(initial=np.inf) + 0.2 * (below - low.min(initial=0.0))]
    if len(rim) < LEAST_RIM:
        return None
    away = vertices[rim] - vertices[rim].mean(axis=0)
    sizes, axes = np.linalg.svd(away, full_matrices=False)[1:]
    normal = axes[2] * (1.0 if axes[2, 2] > 0.0 else -1.0)
    return np.asarray(normal) if normal[2] > FLAT and sizes[2] < THIN * sizes[1] else None


def _first_run(known: list[int]) -> list[int]:
    """Return the numbers that follow each other from the first one on."""
    return [k for i, k in enumerate(known) if k == known[0] + i]
