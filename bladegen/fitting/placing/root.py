"""The root of a blade: its flange, its circle, and so the pitch axis.

The flange is flat and normal to the pitch axis, which goes through the middle of the root.  Where
there is no flange, circles of a round root say where the axis is.
"""

from dataclasses import replace

import numpy as np

from bladegen.fitting.placing.pose import Pose, cuts_across, ends, tilted
from bladegen.fitting.sections.chains import Cut
from bladegen.fitting.sections.outlines import circle_of, is_round
from bladegen.measures.surfaces import Surface
from bladegen.support.arrays import Array, Indices

__all__ = ["ROOTS", "upright"]

FEW = 5  # points that an outline has more than
ROOT = np.linspace(0.002, 0.06, 30)  # of the span, where a round root is sought
END = 0.02  # of the span, within which a flange lies
FLAT = 0.95  # of a flange's normal along the blade, at first
RING = 0.02  # of the squared diameter that a flange's area is at least
LEAST_RIM = 8  # points of a rim
ROOTS = ("auto", "flange", "circles")
SLANT = np.radians(4.0)  # between flange and circles, above which it is a cut at a slant
DOUBT = np.radians(0.5)  # above which it may be one: circles of IEA 15 MW lean by 2 degrees
TUBE = 0.004  # of the radius, by which the circles of a root that says so differ at most
LEAN = 0.05  # of the diameter above a slanted end: planes across the blade lean as its axis does
LEAST_CIRCLES = 3  # that say where an axis is
THIN = 0.01  # of a rim's size, which it leaves its plane by at most


def upright(
    pose: Pose, surface: Surface, said: list[str], *, root: str = "auto", flanged: bool = True
) -> tuple[Pose, float, str]:
    """Bring the root's flange to z = 0 and its middle to the axis.

    Also return its diameter, and what is doubtful about the axis unless the file's own is taken.
    Where there is no flange, or where it is a cut across the blade at a slant, the axis of a round
    root is brought to z, and z = 0 is where the blade is whole.

    Parameters
    ----------
    said : list of str
        To which is added how it was found.
    root : str
        Of `ROOTS`: "flange" or "circles" say what z follows; "auto" takes the flange, unless it is
        off the circles' axis by more than roots of blades are.
    flanged : bool
        Whether an end can be a flange; that of a surface through a cloud is none.
    """
    level, (around, tube) = _on_flange(pose, surface), _around_circles(pose, surface)
    apart = 0.0
    if level is not None and around is not None:
        apart = float(np.arccos(np.clip(level.axes[:, 2] @ around.axes[:, 2], -1.0, 1.0)))
    slanted = root == "circles" or (root == "auto" and flanged and tube and apart > SLANT)
    flat = level is not None and not (slanted and around is not None)
    if flat and level is not None:
        pose = level
    elif around is not None:
        pose = around
    cuts, _ = cuts_across(pose, surface, ROOT)
    run = _run(cuts)
    first = next((k for k, cut in enumerate(cuts) if len(cut.outline)), 0)
    outline = cuts[run[0] if run else first].outline
    if run:
        middle, radius = circle_of(outline)
        said.append(f"the root is a circle of {2.0 * radius:.4g} m")
    else:
        middle = 0.5 * (outline.min(axis=0) + outline.max(axis=0))
        radius = 0.5 * float(np.ptp(outline, axis=0).max())
        said.append("the root is no circle: the pitch axis goes through its middle")
    doubt = ""
    if flat and not flanged:
        said.append("the pitch axis is that of the points")
    elif flat:
        said.append("the pitch axis is normal to the root's flange")
        if tube and apart > DOUBT:
            doubt = (
                f"the root's flange is {np.degrees(apart):.1f} degrees off the axis of its circles:"
                " if it is no flange but a cut, --root circles"
            )
    elif run:
        said.append("the pitch axis is the middle of the root's circles")
    else:
        said.append("the pitch axis is along the blade: it has neither a flange nor a round root")
    low, high = ends(pose, surface)
    if level is not None and not flat:
        low, under = _whole(pose, surface, low + END * (high - low)), low
        low += LEAN * 2.0 * radius
        said.append(
            f"the root's end is {np.degrees(apart):.1f} degrees off square: the blade begins where "
            f"it is whole, {low - under:.3g} m from its lowest point"
        )
    return replace(pose, origin=pose.origin - [*middle, low]), 2.0 * radius, doubt


def _on_flange(pose: Pose, surface: Surface) -> Pose | None:
    """Return the pose whose z is normal to a root's flat end, None if it has none."""
    flat = False
    for _ in range(3):
        low, high = ends(pose, surface)
        normal = _flange(pose, surface, low + END * (high - low))
        if normal is None:
            break
        flat = True
        pose = tilted(pose, normal, np.zeros(3))
    return pose if flat else None


def _around_circles(pose: Pose, surface: Surface) -> tuple[Pose | None, bool]:
    """Return the pose whose z is the axis of a round root, and whether that is a round tube.

    None if it is not round; what is round but roughly counts where nothing is a tube.
    """
    cuts, z = cuts_across(pose, surface, ROOT)
    run, tube = _run(cuts), False
    for _ in range(4):
        if len(run) < LEAST_CIRCLES:
            return None, False
        centres = np.array([[*circle_of(cuts[k].outline)[0], z[k]] for k in run])
        slope, offset = np.polyfit(centres[:, 2], centres[:, :2], 1)
        normal = np.array([*slope, 1.0]) / np.hypot(1.0, np.hypot(*slope))
        pose = tilted(pose, normal, np.array([*offset, 0.0]))
        cuts, z = cuts_across(pose, surface, ROOT)
        run = [k for k in run if len(cuts[k].outline) > FEW + 2]
        close = [k for k in run if is_round(cuts[k].outline, TUBE)]
        tube = len(close) >= LEAST_CIRCLES
        run = close if tube else run
    return pose, tube


def _whole(pose: Pose, surface: Surface, below: float) -> float:
    """Return the least z from which on planes across the root meet all of it."""
    vertices, faces = pose(surface.mesh.vertices), surface.mesh.faces
    flange = _end_of(vertices, faces, below)
    return float(vertices[:, 2].min() if flange is None else vertices[flange[1], 2].max())


def _run(cuts: list[Cut]) -> list[int]:
    """Return which cuts are round, from the first one on."""
    known = [k for k, cut in enumerate(cuts) if len(cut.outline) > FEW and is_round(cut.outline)]
    return [k for i, k in enumerate(known) if k == known[0] + i]


def _flange(pose: Pose, surface: Surface, below: float) -> Array | None:
    """Return the normal of the flat end of a root below a height, or of its rim; None if none."""
    found = _end_of(pose(surface.mesh.vertices), surface.mesh.faces, below)
    return None if found is None else found[0]


def _end_of(vertices: Array, faces: Indices, below: float) -> tuple[Array, Indices] | None:
    """Return the normal of a flat end below a height, or of its rim, and its vertices."""
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
            return np.asarray(total / np.linalg.norm(total)), np.unique(some[flat])
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
    flat_rim = normal[2] > FLAT and sizes[2] < THIN * sizes[1]
    return (np.asarray(normal), rim) if flat_rim else None
