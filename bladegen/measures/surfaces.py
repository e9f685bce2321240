"""Surfaces that distances are measured between: exact patches, and triangles that find them.

A `Surface` is made of a blade, of a CAD file's faces or of a mesh.  Its triangles say where on
which patch the nearest point may lie; the patch says where it does lie.  What has no patch (a
mesh) is its triangles.  Metres.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.outputs import at_least
from bladegen.measures.patches import Patch
from bladegen.support.arrays import Array, Indices
from bladegen.surface.ends import edge_poles, rounded
from bladegen.surface.fitting import resolving
from bladegen.surface.mesh import TriangleMesh
from bladegen.surface.net import BEZIER, SurfaceNet, on_knots
from bladegen.surface.splines import DEGREE, Knots
from bladegen.surface.tips import Tip, flat_tip

__all__ = ["Surface", "of_blade", "of_faces", "of_mesh"]

STATIONS = 240  # of a blade, besides the grids of its definition
CLOSE = 1e-5  # m, what splines through the landmarks may miss between them
NEAREST_KNOTS = 1e-7  # of the span
LEAST, MOST = 12, 400  # rows of triangles on a patch
FEW = 8  # patches that may have so many
SAG = 4e-4  # m, of triangles to their patch aimed at
RIM = 8  # points of a flat end's rim for each landmark


@dataclass(frozen=True, eq=False)
class Surface:
    """A surface.

    Parameters
    ----------
    mesh : TriangleMesh
        Triangles on it.
    patches : tuple of Patch
        Pieces of exact surface.
    owner : (f,) array of int
        The patch of each triangle, -1 for those that are the surface themselves.
    uv : (v, 2) array
        Parameters of the vertices on their patch.
    """

    mesh: TriangleMesh
    patches: tuple[Patch, ...]
    owner: Indices
    uv: Array

    @property
    def size(self) -> float:
        """The largest extent along an axis [m]."""
        return float(np.ptp(self.mesh.vertices, axis=0).max())

    def scaled(self, factor: float) -> "Surface":
        """Return the surface with all lengths times a factor."""
        return replace(
            self,
            mesh=TriangleMesh(self.mesh.vertices * factor, self.mesh.faces),
            patches=tuple(replace(patch, poles=patch.poles * factor) for patch in self.patches),
        )


def of_mesh(mesh: TriangleMesh) -> Surface:
    """Return a mesh as a surface: it is its triangles."""
    nowhere = np.full(len(mesh.faces), -1)
    return Surface(mesh, (), nowhere, np.zeros((len(mesh.vertices), 2)))


def of_faces(arrays: Mapping[str, Array]) -> Surface:
    """Return the faces that `face_patches.faces` has made of a shape."""
    count = 1 + max(int(name.partition("/")[0]) for name in arrays)
    pieces: list[_Piece] = []
    for k in range(count):
        part = {name: arrays[f"{k}/{name}"] for name in _NAMES if f"{k}/{name}" in arrays}
        triangles = None
        if "triangles" in part:
            triangles = part["vertices"], part["triangles"], part["uv"]
        patch = None
        if "poles" in part:
            starts = part.get("starts", np.zeros(1)).astype(int).tolist()
            rims = part.get("rims", np.zeros((0, 2)))
            patch = Patch(
                part["poles"],
                part["u"],
                part["v"],
                part.get("weights"),
                tuple(rims[a:b] for a, b in pairwise(starts)),
                float(part["sign"]),
            )
        pieces.append((patch, triangles))
    return _joined(pieces)


_NAMES = ["poles", "u", "v", "weights", "rims", "starts", "sign", "vertices", "triangles", "uv"]
_Triangles = tuple[Array, Any, Array]
_Piece = tuple[Patch | None, _Triangles | None]


def of_blade(blade: Blade, tip: Tip = flat_tip) -> Surface:
    """Return a blade's surface, from which the blade departs by some micrometres."""
    net, sign = _net(blade), 1.0 if blade.mirrored else -1.0
    pieces: list[_Piece] = [(Patch(net.poles, net.u_knots, net.v_knots, sign=sign), None)]
    if net.blunt:
        strip = np.stack([net.poles[-1], net.poles[0]])
        pieces.append((Patch(strip, _LINEAR, net.v_knots, sign=sign), None))
    pieces.append(_flat(net, 0.0))
    poles = rounded(net, tip)
    if poles is None:
        pieces.append(_flat(net, 1.0))
    else:
        pieces.append((Patch(poles, net.halves()[0].u_knots, BEZIER, sign=sign), None))
        if net.blunt:
            pieces.append((Patch(edge_poles(poles)[[-1, 0]], _LINEAR, BEZIER, sign=sign), None))
    return _joined(pieces)


_LINEAR = np.array([0.0, 0.0, 1.0, 1.0])


def _net(blade: Blade) -> SurfaceNet:
    """Return cubics from span to span with the blade's own slopes on both sides of each.

    A blade may be creased at the grids of its definition, so that no smooth spline will do.
    """
    v = np.unique(np.concatenate([blade.breaks, at_least(blade, STATIONS)]))
    v = v[np.concatenate([[True], np.diff(v) > NEAREST_KNOTS])]
    v[-1] = 1.0
    u = resolving(blade, blade.stations(max(60, len(blade.eta) + 2)), CLOSE)
    return on_knots(blade, u, Knots(v, np.full(len(v), DEGREE)))


def _flat(net: SurfaceNet, v: float) -> tuple[Patch, _Triangles]:
    """Return the plane inside a net's first or last section, and triangles across it."""
    from scipy.interpolate import BSpline

    u = np.unique(np.linspace(net.u[:-1], net.u[1:], RIM + 1))
    end, before = (0, 1) if v == 0.0 else (-1, -2)
    rim = BSpline(net.u_knots, net.poles[:, end], DEGREE)(u)
    x = rim[len(rim) // 2] - rim[0]
    x = x / np.linalg.norm(x)
    normal = np.sum(np.cross(rim[:-1] - rim[0], rim[1:] - rim[0]), axis=0)
    y = np.cross(normal / np.linalg.norm(normal), x)
    flat = (rim - rim[0]) @ np.stack([x, y]).T
    low, high = flat.min(axis=0), flat.max(axis=0)
    corners = np.array(
        [[(low[0], low[1]), (low[0], high[1])], [(high[0], low[1]), (high[0], high[1])]]
    )
    knots = np.repeat(np.stack([low, high], axis=1), 2, axis=1)
    away = np.mean(net.poles[:, end] - net.poles[:, before], axis=0)
    outward = float(np.sign(np.cross(x, y) @ away))
    patch = Patch(
        rim[0] + corners @ np.stack([x, y]),
        knots[0],
        knots[1],
        None,
        (flat[[*range(len(flat)), 0]],),
        outward,
    )
    half = len(flat) // 2
    upper, lower = np.arange(half), np.arange(len(flat) - 1, len(flat) - 1 - half, -1)
    quads = np.stack([upper[:-1], upper[1:], lower[1:], lower[:-1]], axis=1)
    tail = np.array([[half - 1, half, half + 1]])
    faces = np.concatenate([quads[:, :3], quads[:, [0, 2, 3]], tail])
    return patch, (rim, faces if outward > 0 else faces[:, ::-1], flat)


def _joined(pieces: Sequence[_Piece]) -> Surface:
    vertices, faces, uv, owner = [], [], [], []
    patches: list[Patch] = []
    count, most = 0, int(np.clip(MOST * np.sqrt(FEW / len(pieces)), LEAST, MOST))
    for patch, given in pieces:
        made = _gridded(patch, most) if patch and given is None else given
        if made is None:
            continue
        points, corners, places = made
        vertices.append(points)
        faces.append(corners + count)
        uv.append(places if len(places) == len(points) else np.zeros((len(points), 2)))
        owner.append(np.full(len(corners), len(patches) if patch else -1))
        count += len(points)
        if patch:
            patches.append(patch)
    mesh = TriangleMesh(np.concatenate(vertices), np.concatenate(faces))
    return Surface(mesh, tuple(patches), np.concatenate(owner), np.concatenate(uv))


def _gridded(patch: Patch, most: int) -> _Triangles:
    """Return triangles on a patch, as fine as its sag asks for, looking outward."""
    u, v = (_refined(patch, axis, most) for axis in (0, 1))
    points = patch.grid(u, v)
    grid = np.arange(len(u) * len(v)).reshape(len(u), len(v))
    a, b, c, d = (g.ravel() for g in (grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]))
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1)
    return points.reshape(-1, 3), faces if patch.sign > 0 else faces[:, ::-1], uv.reshape(-1, 2)


def _refined(patch: Patch, axis: int, most: int) -> Array:
    """Return parameters along an axis between which the patch is flat, at least its cells' ends."""
    x = patch.cells(axis)
    if len(x) > most:
        some: Array = x[np.unique(np.linspace(0, len(x) - 1, most).astype(int))]
        return some
    others = patch.cells(1 - axis)
    others = others[:: max(1, len(others) // 40)]
    while len(x) < most:
        middles = 0.5 * (x[1:] + x[:-1])
        ends, between = (
            patch.grid(*((y, others) if axis == 0 else (others, y))) for y in (x, middles)
        )
        ends, between = (p if axis == 0 else np.moveaxis(p, 1, 0) for p in (ends, between))
        sag = np.linalg.norm(between - 0.5 * (ends[1:] + ends[:-1]), axis=-1).max(axis=1)
        few = patch.degrees[axis] > 1 and len(x) < LEAST
        split = np.ones(len(middles), dtype=bool) if few else sag > SAG
        if not split.any():
            break
        x = np.sort(np.concatenate([x, middles[split]]))
    return x
