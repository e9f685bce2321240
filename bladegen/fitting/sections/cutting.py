"""Triangles and exact patches cut by planes, to closed outlines.

A plane meets each triangle in a segment; segments become outlines (`chains`).  Where triangles lie
on a patch, the points are moved along the plane onto the patch: so they are exact, however coarse
the triangles.  Metres, blade frame (`placing.pose`), z along the span.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from bladegen.fitting.sections.chains import Cut, outlines_of, without_diagonals
from bladegen.measures.patches import Patch
from bladegen.measures.surfaces import Surface
from bladegen.support.arrays import Array, Indices, Mask

__all__ = ["Cutter"]

ROUNDING = 1e-7  # of the longest triangle, by which more are looked at
NEWTON = 3  # steps onto a patch; triangles begin within a millimetre of it


@dataclass(frozen=True, eq=False)
class Cutter:
    """A surface, ready to be cut by planes that are nearly normal to z."""

    surface: Surface

    @cached_property
    def _corners(self) -> Array:
        return self.surface.mesh.vertices[self.surface.mesh.faces]

    @cached_property
    def _sorted(self) -> tuple[Indices, Array, float]:
        """Triangles by their middles along z, these, and half the longest triangle."""
        z = self._corners[..., 2]
        low, high = z.min(axis=1), z.max(axis=1)
        middle = 0.5 * (low + high)
        order = np.argsort(middle)
        return order, middle[order], float(0.5 * (high - low).max(initial=0.0))

    def cuts(self, origins: Array, frames: Array) -> list[Cut]:
        """Cut by planes through `origins` (k, 3); `frames` (k, 3, 3) are their axes and normals."""
        parts = [self._segments(o, f) for o, f in zip(origins, frames, strict=True)]
        points = self._on_patches(parts, origins, frames)
        made = [
            outlines_of((p - o) @ f[:2].T, part.ends)
            for p, o, f, part in zip(points, origins, frames, parts, strict=True)
        ]
        if self.surface.patches:
            return made
        return [replace(cut, outline=without_diagonals(cut.outline)) for cut in made]

    def _near(self, origin: Array, normal: Array) -> Indices:
        order, middle, half = self._sorted
        low, high = self._box
        lean = np.abs(normal[:2]) @ np.maximum(np.abs(low - origin), np.abs(high - origin))[:2]
        reach = half + float(lean / abs(normal[2])) + ROUNDING * (1.0 + half)
        first, last = np.searchsorted(middle, [origin[2] - reach, origin[2] + reach])
        return order[first:last]

    @cached_property
    def _box(self) -> tuple[Array, Array]:
        vertices = self.surface.mesh.vertices
        return vertices.min(axis=0), vertices.max(axis=0)

    def _segments(self, origin: Array, frame: Array) -> "_Segments":
        near = self._near(origin, frame[2])
        height = (self._corners[near] - origin) @ frame[2]
        above = height > 0.0
        count = above.sum(axis=1)
        met = (count == 1) | (count == 2)
        near, height, above = near[met], height[met], above[met]
        alone = np.argmax(above == (above.sum(axis=1) == 1)[:, None], axis=1)
        rows = np.arange(len(near))
        faces = self.surface.mesh.faces[near]
        tail = np.stack([faces[rows, alone]] * 2, axis=1)
        others = (alone[:, None] + np.array([1, 2])) % 3
        head = faces[rows[:, None], others]
        start = height[rows, alone][:, None]
        share = start / (start - height[rows[:, None], others])
        low, high = np.minimum(tail, head), np.maximum(tail, head)
        keys = low.astype(np.int64) * len(self.surface.mesh.vertices) + high
        _, first, ends = np.unique(keys.ravel(), return_index=True, return_inverse=True)
        tail, head, share = (x.ravel()[first] for x in (tail, head, share))
        owner = np.repeat(self.surface.owner[near], 2)[first]
        return _Segments(tail, head, share, owner, ends.reshape(-1, 2))

    def _on_patches(self, parts: list["_Segments"], origins: Array, frames: Array) -> list[Array]:
        counts = [len(part.tail) for part in parts]
        tail, head, owner = (
            np.concatenate([getattr(part, name) for part in parts]).astype(np.int64)
            for name in ("tail", "head", "owner")
        )
        share = np.concatenate([part.share for part in parts])[:, None]
        vertices, uv = self.surface.mesh.vertices, self.surface.uv
        points = (1.0 - share) * vertices[tail] + share * vertices[head]
        plane = np.repeat(np.arange(len(parts)), counts)
        for k, patch in enumerate(self.surface.patches):
            some = np.flatnonzero(owner == k)
            if not some.size:
                continue
            ends = uv[tail[some]], uv[head[some]]
            at = (1.0 - share[some]) * ends[0] + share[some] * ends[1]
            rim = (ends[0] == ends[1]) & ((at == patch.low) | (at == patch.high))
            normal, origin = frames[plane[some], 2], origins[plane[some]]
            for _ in range(NEWTON):
                at = _stepped(patch, at, rim, points[some], origin, normal)
            place = patch.at(at)[0]
            off = np.abs(np.sum((place - origin) * normal, axis=1))
            far = np.linalg.norm(place - points[some], axis=1)
            good = (off < 1e-6 * (1.0 + far)) & (far < FARTHEST)
            points[some[good]] = place[good]
        return np.split(points, np.cumsum(counts)[:-1])


def _stepped(
    patch: Patch, at: Array, rim: Mask, points: Array, origin: Array, normal: Array
) -> Array:
    """Move parameters (m, 2) so that their points lie on planes, as near to `points` as can be.

    Along a rim where one is there already (`rim`, (m, 2)), or would pass it.
    """
    place, du, dv = patch.at(at)
    along = np.cross(np.cross(du, dv), normal)
    height = np.sum((origin - place) * normal, axis=1)
    aside = np.sum((points - place) * along, axis=1)
    slopes = np.stack([np.sum(normal * du, axis=1), np.sum(normal * dv, axis=1)], axis=1)
    others = np.stack([np.sum(along * du, axis=1), np.sum(along * dv, axis=1)], axis=1)
    determinant = slopes[:, 0] * others[:, 1] - slopes[:, 1] * others[:, 0]
    determinant = np.where(np.abs(determinant) < TINY, np.inf, determinant)
    step = np.stack(
        [
            height * others[:, 1] - aside * slopes[:, 1],
            aside * slopes[:, 0] - height * others[:, 0],
        ],
        axis=1,
    )
    step /= determinant[:, None]
    step[rim] = 0.0
    held = rim | (at + step < patch.low) | (at + step > patch.high)
    bound = np.clip(at + step, patch.low, patch.high) - at
    for free in (0, 1):
        some = held[:, 1 - free] & ~held[:, free]
        slope = np.where(np.abs(slopes[:, free]) < TINY, np.inf, slopes[:, free])
        alone = (height - slopes[:, 1 - free] * bound[:, 1 - free]) / slope
        step[some, 1 - free], step[some, free] = bound[some, 1 - free], alone[some]
    return np.asarray(np.clip(at + step, patch.low, patch.high))


TINY = 1e-300
FARTHEST = 0.05  # m that a point moves onto its patch


@dataclass(frozen=True, eq=False)
class _Segments:
    """Edges of a mesh that a plane meets, and the segments between them."""

    tail: Indices
    head: Indices
    share: Array
    owner: Indices
    ends: Indices
