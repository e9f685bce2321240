"""Pieces of exact surface: B-splines, rational or not, and the nearest points on them.

A `Patch` maps parameters (u, v) of its box to points in space; where it is trimmed, `rims` bound
what belongs to it.  Everything is evaluated at many points at once, each in the polynomial of its
own cell.  Any unit of length; derivatives are those in u and v.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.support.arrays import Array, Indices, Mask, readonly

__all__ = ["Patch", "inside", "to_rims"]

STEPS = 40  # of Newton's method; a point that needs more keeps the nearest that was found
CONVERGED = 1e-7  # of a step to the distance or more: the distance is right to 1e-14 of itself
CHUNK = 16384  # points that are evaluated together, to stay in the processor's cache
DAMPING = 1e-9  # of the metric, against poles of a sphere and the like


@dataclass(frozen=True, eq=False)
class Patch:
    """A tensor-product B-spline surface.

    Parameters
    ----------
    poles : (a, b, 3) array
        Control points.
    u_knots, v_knots : (a + p + 1,), (b + q + 1,) arrays
        Knots with multiplicities.
    weights : (a, b) array, optional
        Of a rational surface.
    rims : tuple of (m, 2) arrays
        Lines in (u, v) that bound the piece together, by the even-odd rule; none for all of it.
    sign : float
        1 where d/du x d/dv points outward, else -1.
    """

    poles: Array
    u_knots: Array
    v_knots: Array
    weights: Array | None = None
    rims: tuple[Array, ...] = ()
    sign: float = 1.0

    def __post_init__(self) -> None:
        for name in ("poles", "u_knots", "v_knots"):
            object.__setattr__(self, name, readonly(getattr(self, name)))

    @cached_property
    def low(self) -> Array:
        """The least u and v."""
        return np.array([self.u_knots[self.degrees[0]], self.v_knots[self.degrees[1]]])

    @cached_property
    def high(self) -> Array:
        """The largest u and v."""
        rows, columns = self.poles.shape[:2]
        return np.array([self.u_knots[rows], self.v_knots[columns]])

    @property
    def degrees(self) -> tuple[int, int]:
        """Of the polynomials in u and in v."""
        rows, columns = self.poles.shape[:2]
        return len(self.u_knots) - rows - 1, len(self.v_knots) - columns - 1

    @cached_property
    def _homogeneous(self) -> Array:
        if self.weights is None:
            return self.poles
        return np.concatenate([self.poles * self.weights[..., None], self.weights[..., None]], -1)

    @cached_property
    def _cells(self) -> tuple[Array, Array]:
        knots = self.u_knots, self.v_knots
        u, v = (_polynomials(k, d) for k, d in zip(knots, self.degrees, strict=True))
        return u, v

    def cells(self, axis: int) -> Array:
        """Return the distinct knots along an axis inside the box."""
        knots = (self.u_knots, self.v_knots)[axis]
        return np.unique(np.clip(knots, self.low[axis], self.high[axis]))

    def grid(self, u: Array, v: Array) -> Array:
        """Return points on a grid, (ku, kv, 3)."""
        rows, columns = self.poles.shape[:2]
        across, along = np.zeros((len(u), rows)), np.zeros((len(v), columns))
        for matrix, axis, x in ((across, 0, u), (along, 1, v)):
            start, (values, _) = self._basis(axis, x)
            at = start[:, None] + np.arange(values.shape[1])
            np.put_along_axis(matrix, at, values, axis=1)
        points = np.tensordot(across, np.tensordot(along, self._homogeneous, axes=(1, 1)), (1, 1))
        return points if self.weights is None else points[..., :3] / points[..., 3:]

    def at(self, uv: Array) -> tuple[Array, Array, Array]:
        """Return points and their derivatives in u and v at parameters (m, 2), each (m, 3)."""
        parts = [self._at(uv[i : i + CHUNK]) for i in range(0, max(1, len(uv)), CHUNK)]
        point, du, dv = (np.concatenate([part[k] for part in parts]) for k in range(3))
        return point, du, dv

    def _at(self, uv: Array) -> tuple[Array, Array, Array]:
        i, (bu, du) = self._basis(0, uv[:, 0])
        j, (bv, dv) = self._basis(1, uv[:, 1])
        rows = i[:, None, None] + np.arange(bu.shape[1])[:, None]
        poles = self._homogeneous[rows, j[:, None, None] + np.arange(bv.shape[1])]
        along = np.einsum("mq,mpqd->mpd", bv, poles)
        point = np.einsum("mp,mpd->md", bu, along)
        in_u = np.einsum("mp,mpd->md", du, along)
        in_v = np.einsum("mp,mpd->md", bu, np.einsum("mq,mpqd->mpd", dv, poles))
        if self.weights is None:
            return point, in_u, in_v
        w = point[:, 3:]
        place = point[:, :3] / w
        return (
            place,
            (in_u[:, :3] - in_u[:, 3:] * place) / w,
            (in_v[:, :3] - in_v[:, 3:] * place) / w,
        )

    def _basis(self, axis: int, x: Array) -> tuple[Indices, tuple[Array, Array]]:
        """Return the first pole of each x, and the basis' values and slopes there (m, d + 1)."""
        knots, degree = (self.u_knots, self.v_knots)[axis], self.degrees[axis]
        last = self.poles.shape[axis] - 1
        span = np.clip(np.searchsorted(knots, x, side="right") - 1, degree, last)
        t = x - knots[span]
        powers = t[:, None] ** np.arange(degree + 1)
        slopes = np.zeros_like(powers)
        slopes[:, 1:] = np.arange(1, degree + 1) * powers[:, :-1]
        matrices = self._cells[axis][span - degree]
        values = np.einsum("mk,mkj->mj", powers, matrices)
        return span - degree, (values, np.einsum("mk,mkj->mj", slopes, matrices))

    def nearest(self, points: Array, uv: Array) -> tuple[Array, Array, Array]:
        """Follow the surface from given parameters to the points nearest to others.

        Parameters
        ----------
        points : (m, 3) array
            From where.
        uv : (m, 2) array
            Where to begin: what is found is the nearest in the neighbourhood, inside the box.

        Returns
        -------
        parameters (m, 2), surface points (m, 3), outward normals (m, 3), of any length
        """
        uv = np.clip(uv, self.low, self.high)
        place, du, dv = self.at(uv)
        best = np.linalg.norm(points - place, axis=1)
        damping = np.full(len(uv), DAMPING)
        active = np.arange(len(uv))
        for _ in range(STEPS):
            step = _step(points[active] - place[active], du[active], dv[active], damping[active])
            step = self._allowed(
                uv[active], step, points[active] - place[active], du[active], dv[active]
            )
            trial = uv[active] + step
            there, tu, tv = self.at(trial)
            length = np.linalg.norm(points[active] - there, axis=1)
            better = length < best[active]
            moved = np.linalg.norm(there - place[active], axis=1)
            kept = active[better]
            uv[kept], place[kept], du[kept], dv[kept] = (
                trial[better],
                there[better],
                tu[better],
                tv[better],
            )
            best[kept] = length[better]
            damping[active] = np.where(
                better, damping[active] / 10.0, 30.0 * damping[active] + 1e-3
            )
            active = active[moved > CONVERGED * np.maximum(best[active], 1.0)]
            if not active.size:
                break
        return uv, place, self.sign * np.cross(du, dv)

    def _allowed(self, uv: Array, step: Array, gap: Array, du: Array, dv: Array) -> Array:
        """Return steps that stay in the box: along its edge where they would leave it."""
        for axis, along in ((0, dv), (1, du)):
            low, high = self.low[axis], self.high[axis]
            at_edge = (uv[:, axis] <= low) & (step[:, axis] < 0)
            at_edge |= (uv[:, axis] >= high) & (step[:, axis] > 0)
            metric = np.maximum(np.sum(along * along, axis=1), 1e-300)
            slide = np.sum(gap * along, axis=1) / metric
            step[at_edge, axis] = 0.0
            step[at_edge, 1 - axis] = slide[at_edge]
        return np.clip(uv + step, self.low, self.high) - uv


def _step(gap: Array, du: Array, dv: Array, damping: Array) -> Array:
    """Return Gauss and Newton's steps (m, 2) to the foot of gaps (m, 3) on tangent planes."""
    a, b, c = (np.sum(x * y, axis=1) for x, y in ((du, du), (du, dv), (dv, dv)))
    e, f = np.sum(gap * du, axis=1), np.sum(gap * dv, axis=1)
    a, c = a * (1.0 + damping) + 1e-300, c * (1.0 + damping) + 1e-300
    determinant = a * c - b * b
    step: Array = np.stack([c * e - b * f, a * f - b * e], axis=1) / determinant[:, None]
    return step


def _polynomials(knots: Array, degree: int) -> Array:
    """Return each span's basis as polynomials in x less its start, (spans, d + 1, d + 1).

    Rows are powers, columns the span's poles: Cox and de Boor's recursion on coefficients.
    """
    spans = len(knots) - 2 * degree - 1
    k = np.arange(spans) + degree
    basis = np.zeros((spans, degree + 1, degree + 1))
    basis[:, 0, 0] = 1.0
    for d in range(1, degree + 1):
        new = np.zeros_like(basis)
        for j in range(d + 1):
            i = k - d + j  # the function N_i,d; its parts are N_i,d-1 and N_i+1,d-1
            for old, rising in ((j - 1, True), (j, False)):
                if not 0 <= old < d:
                    continue
                low, high = (i, i + d) if rising else (i + 1, i + d + 1)
                width = knots[high] - knots[low]
                scale = np.divide(1.0, width, out=np.zeros_like(width), where=width > 0)
                origin = knots[k] - knots[low] if rising else knots[high] - knots[k]
                part = basis[:, :, old] * scale[:, None]
                new[:, :, j] += origin[:, None] * part
                new[:, 1:, j] += (1.0 if rising else -1.0) * part[:, :-1]
        basis = new
    return basis


def inside(rims: tuple[Array, ...], uv: Array) -> Mask:
    """Tell which parameters (m, 2) lie inside what lines enclose, by the even-odd rule."""
    crossings = np.zeros(len(uv), dtype=np.int64)
    for rim in rims:
        start, end = rim[:-1], rim[1:]
        for i in range(0, len(uv), CHUNK // 64):
            x, y = uv[i : i + CHUNK // 64].T[..., None]
            over = (start[:, 1] > y) != (end[:, 1] > y)
            height = np.where(end[:, 1] == start[:, 1], 1.0, end[:, 1] - start[:, 1])
            where = start[:, 0] + (y - start[:, 1]) / height * (end[:, 0] - start[:, 0])
            crossings[i : i + CHUNK // 64] += np.count_nonzero(over & (x < where), axis=1)
    odd: Mask = crossings % 2 == 1
    return odd


def to_rims(patch: Patch, points: Array) -> tuple[Array, Array]:
    """Return where a trimmed patch's rims are nearest to points (m, 3): parameters and points."""
    from scipy.spatial import cKDTree

    best = np.full(len(points), np.inf)
    uv, place = np.zeros((len(points), 2)), np.zeros((len(points), 3))
    for line in patch.rims:
        rim = patch.at(line)[0]
        _, at = cKDTree(rim).query(points)
        for start in (at - 1, at):
            i = np.clip(start, 0, len(rim) - 2)
            edge = rim[i + 1] - rim[i]
            square = np.maximum(np.sum(edge * edge, axis=1), 1e-300)
            t = np.clip(np.sum((points - rim[i]) * edge, axis=1) / square, 0.0, 1.0)[:, None]
            there = rim[i] + t * edge
            length = np.linalg.norm(points - there, axis=1)
            nearer = length < best
            best[nearer], place[nearer] = length[nearer], there[nearer]
            uv[nearer] = (line[i] + t * (line[i + 1] - line[i]))[nearer]
    return uv, place
