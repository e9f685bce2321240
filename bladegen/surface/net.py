"""A blade's surface as one tensor-product B-spline through its sections.

The surface wraps suction side -> leading edge -> pressure side: cubic and C2 along the chord
in the landmark parameter u, and cubic along the span in eta, C2 but for knots of lower continuity
where the blade has them: C0 at its creases, C1 where its curvature jumps.  `on_knots` makes it
of a blade and its knots; `fitting` finds which knots it takes, `deviation` how far it lies from
the blade.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.blade.remembered import Sectioned
from bladegen.support.arrays import Array, readonly
from bladegen.support.values import brief
from bladegen.surface.splines import DEGREE, NOSE, Fit, Knots, basis, joined

__all__ = [
    "BEZIER",
    "CLOSED_EDGE",
    "ENDS",
    "SurfaceNet",
    "along_sections",
    "cone_volume",
    "on_knots",
]

FITTED = np.array([0.125, 0.375, 0.625, 0.875])  # of the way between knots, where points are taken
STEP = 1e-5  # of the span: slopes of second order are then good to 1e-10 of a third derivative
CLOSE = 0.125  # of the way to the next knot, which a step never exceeds
BEZIER = np.repeat([0.0, 1.0], DEGREE + 1)  # knots of a single cubic
ENDS = np.array([0.0, 1.0])
NEAR = 1e-6  # of the span; a cut that near to a knot is at the knot
CLOSED_EDGE = 1e-7  # m; a trailing edge thinner than this everywhere is sharp


@dataclass(frozen=True, eq=False)
class SurfaceNet:
    """A bicubic B-spline surface.

    Parameters
    ----------
    poles : (a, b, 3) array
        Control points [m], chordwise first.
    u_knots, v_knots : (a + 4,), (b + 4,) arrays
        Knots with multiplicities, in landmark parameter and span fraction.
    """

    poles: Array
    u_knots: Array
    v_knots: Array

    __repr__ = brief

    def __post_init__(self) -> None:
        for name in ("poles", "u_knots", "v_knots"):
            object.__setattr__(self, name, readonly(getattr(self, name)))

    @property
    def u(self) -> Array:
        """The distinct knots along the chord."""
        return np.unique(self.u_knots)

    @property
    def v(self) -> Array:
        """The distinct knots along the span: those of sections that the surface passes through."""
        return np.unique(self.v_knots)

    @property
    def spans(self) -> Array:
        """The knots along the span, as often as they stand, root and tip once."""
        spans: Array = self.v_knots[DEGREE:-DEGREE]
        return spans

    @property
    def creases(self) -> Array:
        """The spans, but for the ends, at which the surface is only C0."""
        v, times = np.unique(self.v_knots, return_counts=True)
        creases: Array = v[times == DEGREE]
        return creases

    @property
    def gaps(self) -> Array:
        """Widths [m] of the trailing edge's strip, between its poles, (b,)."""
        gaps: Array = np.linalg.norm(self.poles[0] - self.poles[-1], axis=-1)
        return gaps

    @property
    def blunt(self) -> bool:
        """Whether the trailing edge is open somewhere."""
        return bool(self.gaps.max() > CLOSED_EDGE)

    def evaluate(self, u: Array, v: Array, nu: int = 0, nv: int = 0) -> Array:
        """Return points, or mixed derivatives, on the grid of `v` and `u`, (kv, ku, 3).

        At a crease derivatives along the span are those behind it.
        """
        return self.combined(basis(self.u_knots, u, nu), basis(self.v_knots, v, nv))

    def combined(self, across: Any, along: Any) -> Array:
        """Return points, or derivatives, of which both bases are known (`splines.basis`)."""
        rows = along @ self.poles.swapaxes(0, 1).reshape(along.shape[1], -1)
        return along_sections(across, rows.reshape(along.shape[0], -1, 3).swapaxes(0, 1))

    def halves(self) -> tuple["SurfaceNet", "SurfaceNet"]:
        """Cut the surface at the leading edge, u = 0.5, exactly, by knot insertion."""
        from scipy.interpolate import BSpline

        spline = BSpline(self.u_knots, self.poles, DEGREE)
        present = int(np.count_nonzero(self.u_knots == 0.5))
        spline = spline.insert_knot(0.5, DEGREE - present)
        first = int(np.searchsorted(spline.t, 0.5))
        clamp = np.full(DEGREE + 1, 0.5)
        behind = spline.c[first - 1 : len(spline.t) - DEGREE - 1]
        return (
            SurfaceNet(spline.c[:first], np.concatenate([spline.t[:first], clamp]), self.v_knots),
            SurfaceNet(behind, np.concatenate([clamp, spline.t[first + DEGREE :]]), self.v_knots),
        )

    def between(self, first: float, last: float) -> "SurfaceNet":
        """Cut the surface at two spans, or at knots beside them, by knot insertion, exactly."""
        from scipy.interpolate import BSpline

        near = self.v[np.argmin(np.abs(self.v - np.array([[first], [last]])), axis=1)]
        first, last = np.where(np.abs(near - (first, last)) < NEAR, near, (first, last)).tolist()
        if (first, last) == (self.v_knots[0], self.v_knots[-1]):
            return self
        spline = BSpline(self.v_knots, self.poles.swapaxes(0, 1), DEGREE)
        for place in (first, last):
            missing = DEGREE + 1 - int(np.count_nonzero(spline.t == place))
            spline = spline.insert_knot(place, missing) if missing > 0 else spline
        low = int(np.searchsorted(spline.t, first))
        high = int(np.searchsorted(spline.t, last))
        poles = spline.c[low:high].swapaxes(0, 1)
        return SurfaceNet(poles, self.u_knots, spline.t[low : high + DEGREE + 1])

    def volume(self) -> float:
        """Return the volume [m3] inside the surface, its flat ends and its trailing edge.

        The divergence theorem, exact but for rounding (`cone_volume`).  What a round tip adds is
        `ends.tip_volume`.
        """
        strip = np.linspace(self.poles[-1], self.poles[0], DEGREE + 1)
        total = cone_volume(self.poles, self.u_knots, self.v_knots)
        total += cone_volume(strip, BEZIER, self.v_knots)
        u, wu = _quadrature(self.u_knots)
        ends = self.v[[0, -1]]
        rows, slopes = self.evaluate(u, ends), self.evaluate(u, ends, nu=1)
        corners = self.evaluate(ENDS, ends)
        for row, slope, (first, _), sign in zip(rows, slopes, corners, (1, -1), strict=True):
            doubled = wu @ np.cross(row - first, slope)
            total += sign * float(first @ doubled) / 6.0
        return total

    def offsets(self, points: Array, u: Array, v: Array) -> Array:
        """Return the distances [m] from points (kv, ku, 3) to the surface, signed, (kv, ku).

        Points are expected near the surface's (u, v): the distance is measured along the
        surface normal there, which is exact to second order.
        """
        offsets: Array = np.sum((points - self.evaluate(u, v)) * self.normals(u, v), axis=-1)
        return offsets

    def normals(self, u: Array, v: Array) -> Array:
        """Return unit normals on the grid of `v` and `u`, (kv, ku, 3); at a crease behind it."""
        normal = np.cross(self.evaluate(u, v, nu=1), self.evaluate(u, v, nv=1))
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        return normal


def along_sections(across: Any, poles: Array) -> Array:
    """Return points (k, m, 3) of splines with poles (a, k, 3), by their basis (m, a)."""
    points = across @ poles.reshape(across.shape[1], -1)
    sections: Array = points.reshape(across.shape[0], -1, 3).swapaxes(0, 1)
    return sections


def cone_volume(poles: Array, u_knots: Array, v_knots: Array) -> float:
    """Return the signed volume [m3] of the cone from the origin to a bicubic surface.

    Positive where d/dv x d/du looks away from the origin.  Cones to the faces of a solid add up to
    its volume.  Gauss-Legendre quadrature on every cell: exact but for rounding.
    """
    u, wu = _quadrature(u_knots)
    v, wv = _quadrature(v_knots)
    surface = SurfaceNet(poles, u_knots, v_knots)
    flux = np.cross(surface.evaluate(u, v, nv=1), surface.evaluate(u, v, nu=1))
    return float(wv @ np.sum(surface.evaluate(u, v) * flux, axis=-1) @ wu) / 3.0


def on_knots(blade: Sectioned, u: Knots, v: Knots) -> SurfaceNet:
    """Make a blade's net on given knots.

    Sections at all knots along the span are fitted along the chord; between them the net has the
    blade's own slopes wherever a knot leaves it less than C2, on both sides of a crease, and at
    root and tip.

    Parameters
    ----------
    blade : Blade or Remembered
        What to fit.
    u, v : Knots
        Along the chord, symmetric about 0.5; along the span.
    """
    (after, before), step = v.slopes, np.minimum(STEP, CLOSE * np.diff(v.at))
    steps = step[after[:-1]], -step[before[1:]]
    beside = [
        at + k * by
        for at, by in zip((v.at[after], v.at[before]), steps, strict=True)
        for k in (1, 2)
    ]
    places, spans = np.union1d(u.inside(FITTED), [NOSE]), np.concatenate([v.at, *beside])
    rows = Fit(u, places)(blade.sections(spans, places))
    ends = np.cumsum([len(v.at), *(len(at) for at in beside[:-1])])
    here, *near = np.split(rows, ends, axis=1)
    behind, ahead = (
        (2.0 * one - 1.5 * here[:, some] - 0.5 * two) / by[:, None]
        for some, by, one, two in zip((after, before), steps, near[::2], near[1::2], strict=True)
    )
    return SurfaceNet(joined(v, here, behind, ahead), u.sequence, v.sequence)


def _quadrature(knots: Array) -> tuple[Array, Array]:
    """Return nodes and weights that integrate the products of a bicubic surface exactly."""
    nodes, weights = np.polynomial.legendre.leggauss(5)
    distinct = np.unique(knots)
    half = 0.5 * np.diff(distinct)[:, None]
    return (
        (distinct[:-1, None] + half + half * nodes).reshape(-1),
        (half * weights).reshape(-1),
    )
