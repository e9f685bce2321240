"""Closed triangle meshes from a structured grid of sections.

A grid of sections (k, n, 3) becomes quads split along their shorter diagonal, a strip that
closes a blunt trailing edge, and caps zipped between opposite landmarks at root and tip; arcs
across the tip round it.  The mesh is watertight and its triangles face outward.  Lengths are
those of the sections, metres.
"""

from dataclasses import dataclass, replace

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.outputs import at_least
from bladegen.errors import GeometryError
from bladegen.support.arrays import Array, Indices, readonly
from bladegen.surface.regions import REGIONS
from bladegen.surface.tips import Tip, arcs, flat_tip, on_arcs

__all__ = ["ACROSS", "TriangleMesh", "from_blade", "spans", "surface", "topology"]

ACROSS = 16  # quads across a rounded tip
SECTIONS = 300  # 300 x 401 landmarks make 240,000 triangles
SAME_POINT = 1e-9  # m; landmarks nearer than this are one vertex


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Triangles that share vertices.

    Parameters
    ----------
    vertices : (v, 3) array
        Points [m].
    faces : (f, 3) array of int
        Vertices of each triangle, counter-clockwise seen from outside.
    places : (v, 2) array, optional
        Span fraction eta and landmark parameter u of each vertex, of one where several coincide.
    regions : (f,) array of int, optional
        Where each triangle lies, as a place in `regions.REGIONS`.
    """

    vertices: Array
    faces: Indices
    places: Array | None = None
    regions: Indices | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", readonly(self.vertices))
        if self.places is not None:
            object.__setattr__(self, "places", readonly(self.places))
        for name in ("faces", "regions"):
            if getattr(self, name) is not None:
                numbers = np.array(getattr(self, name), dtype=np.int64)
                numbers.flags.writeable = False
                object.__setattr__(self, name, numbers)

    def __repr__(self) -> str:
        return f"<TriangleMesh of {len(self.faces)} triangles, {len(self.vertices)} vertices>"

    @property
    def area(self) -> float:
        """Surface area [m2]."""
        return float(0.5 * np.linalg.norm(self._normals, axis=1).sum())

    @property
    def volume(self) -> float:
        """Enclosed volume [m3], by the divergence theorem; positive if faces look outward."""
        first = self.vertices[self.faces[:, 0]] - self.vertices[0]
        return float(np.sum(first * self._normals) / 6.0)

    @property
    def _normals(self) -> Array:
        a, b, c = (self.vertices[self.faces[:, i]] for i in range(3))
        return np.cross(b - a, c - a)


def from_blade(blade: Blade, *, stations: int = SECTIONS, tip: Tip = flat_tip) -> TriangleMesh:
    """Mesh a blade by `stations` sections where it bends, ended by `tip`."""
    eta, poles = spans(blade, stations), arcs(blade, tip)
    places = np.stack(np.meshgrid(eta, blade.u, indexing="ij"), axis=-1).reshape(-1, 2)
    across = None
    if poles is not None:
        w = np.linspace(0.0, 1.0, ACROSS + 1)
        across = on_arcs(poles[:, None], w[None])
        side = blade.u[: len(poles), None]
        nearer = np.where(w <= 0.5, side, 1.0 - side).reshape(-1)
        places = np.concatenate([places, np.stack([np.ones_like(nearer), nearer], axis=-1)])
    made = surface(blade.sections(eta), across, places)
    sides = [REGIONS.index(name) for name in blade.sides]
    return replace(made, regions=np.array([*sides, *range(2, len(REGIONS))])[made.regions])


def spans(blade: Blade, stations: int = SECTIONS) -> Array:
    """Return spans of a mesh's sections: more than the default where the blade's own are more."""
    return at_least(blade, SECTIONS) if stations == SECTIONS else blade.stations(stations)


def surface(
    sections: Array, across: Array | None = None, places: Array | None = None
) -> TriangleMesh:
    """Mesh a grid of sections.

    Parameters
    ----------
    sections : (k, n, 3) array
        From root to tip, each from trailing edge over suction side, leading edge and pressure
        side to trailing edge, n odd.  First and last landmark may differ (blunt) or agree
        (sharp), at each section for itself.
    across : (n // 2 + 1, q, 3) array, optional
        Rows over the tip from suction to pressure side, q odd, from the trailing edge to the
        leading edge, where they are one point.  Without them the tip is flat.
    places : (m, 2) array, optional
        Of all these points, for `TriangleMesh.places`.

    Raises
    ------
    GeometryError
        If there are fewer than 2 sections or an even number of landmarks.
    """
    k, n, _ = sections.shape
    if k < 2 or n < 5 or n % 2 == 0:
        raise GeometryError(
            f"mesh: got {k} sections of {n} landmarks, allowed are at least 2 sections of an "
            "odd number of at least 5 landmarks"
        )
    points, used, faces, regions = topology(sections, across)
    return TriangleMesh(points[used], faces, None if places is None else places[used], regions)


def topology(
    sections: Array, across: Array | None = None
) -> tuple[Array, Indices, Indices, Indices]:
    """Return the points (m, 3) of a grid of sections, which are vertices, and their triangles.

    Last come their regions.  Arguments are those of `surface`.
    """
    k, n, _ = sections.shape
    points = sections.reshape(-1, 3)
    grid = np.arange(k * n).reshape(k, n)
    around = np.concatenate([grid, grid[:, :1]], axis=1)  # the last column closes the edge
    suction, pressure = grid[-1, : n // 2 + 1], grid[-1, : n // 2 - 1 : -1]
    if across is None:
        rows = np.stack([suction, pressure], axis=1)
    else:
        rows = np.arange(across.shape[0] * across.shape[1]).reshape(across.shape[:2]) + k * n
        rows[:, 0], rows[:, -1] = suction, pressure
        points = np.concatenate([points, across.reshape(-1, 3)])
    parts = [
        _quads(points, around[:-1, :-1], around[1:, :-1], around[1:, 1:], around[:-1, 1:]),
        _cap(points, grid[0]),
        _quads(points, rows[:-1, :-1], rows[:-1, 1:], rows[1:, 1:], rows[1:, :-1]),
        *(() if across is None else (_cap(points, rows[0])[:, ::-1],)),
    ]
    sides = np.repeat([0, 1, 2], [n // 2, n // 2, 1])  # by the columns of quads
    regions = [np.tile(sides, 2 * (k - 1))]
    regions += [np.full(len(part), 3 + i) for i, part in enumerate(parts[1:])]
    used, faces, kept = _welded(points, np.concatenate(parts), grid, rows)
    return points, used, faces, np.concatenate(regions)[kept]


def _quads(points: Array, a: Indices, b: Indices, c: Indices, d: Indices) -> Indices:
    """Split quads a-b-c-d along their shorter diagonal."""
    a, b, c, d = (corner.reshape(-1) for corner in (a, b, c, d))
    ac = np.sum((points[a] - points[c]) ** 2, axis=1)
    bd = np.sum((points[b] - points[d]) ** 2, axis=1)
    by_ac = (ac <= bd)[:, None]
    first = np.where(by_ac, np.stack([a, b, c], axis=1), np.stack([a, b, d], axis=1))
    second = np.where(by_ac, np.stack([a, c, d], axis=1), np.stack([b, c, d], axis=1))
    return np.concatenate([first, second])


def _cap(points: Array, row: Indices) -> Indices:
    """Zip opposite landmarks of one section; the triangles look to the root."""
    middle = len(row) // 2
    suction, pressure = row[: middle + 1], row[: middle - 1 : -1]
    return _quads(points, pressure[:-1], suction[:-1], suction[1:], pressure[1:])


def _welded(
    points: Array, faces: Indices, grid: Indices, rows: Indices
) -> tuple[Indices, Indices, Array]:
    """Join neighbours that coincide, drop collapsed triangles.

    Returns the points that are used, the triangles of them, and which triangles were kept.
    """
    faces = _merged(points, grid, rows)[faces]
    a, b, c = faces.T
    kept = (a != b) & (b != c) & (c != a)
    used, faces = np.unique(faces[kept], return_inverse=True)
    return used, faces.reshape(-1, 3), kept


def _merged(points: Array, grid: Indices, rows: Indices) -> Indices:
    """Return the vertex that stands for each point: the first of those that coincide.

    Sides are joined across the blade at its trailing edge and at its end sections only;
    elsewhere the edges between two such places would belong to four triangles.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    half = grid.shape[1] // 2
    neighbours = (
        (grid[:, 1:], grid[:, :-1]),
        (grid[1:], grid[:-1]),
        (grid[:, 0], grid[:, -1]),
        (grid[0, :half], grid[0, :half:-1]),
        (rows[:, 1:], rows[:, :-1]),
        (rows[1:], rows[:-1]),
    )
    a, b = (np.concatenate([pair[i].reshape(-1) for pair in neighbours]) for i in range(2))
    same = np.linalg.norm(points[a] - points[b], axis=1) <= SAME_POINT
    joined = coo_array(
        (np.ones(np.count_nonzero(same)), (a[same], b[same])), shape=(len(points), len(points))
    )
    _, group = connected_components(joined, directed=False)
    _, first = np.unique(group, return_index=True)
    return np.asarray(first[group], dtype=np.int64)
