"""A blade's surface as one tensor-product B-spline through its sections.

The surface wraps suction side -> leading edge -> pressure side: cubic and C2 along the chord
in the landmark parameter u, and along the span in eta.  It interpolates the landmarks of its
sections (`fit`); `fitting` finds which sections it takes, `deviation` how far it lies from the
blade.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.support.arrays import Array, readonly
from bladegen.support.values import brief

__all__ = ["BEZIER", "CLOSED_EDGE", "ENDS", "SurfaceNet", "cone_volume", "fit"]

DEGREE = 3
BEZIER = np.repeat([0.0, 1.0], DEGREE + 1)  # knots of a single cubic
ENDS = np.array([0.0, 1.0])
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
    u, v : (a,), (b,) arrays
        The landmark parameters and spans that are interpolated.
    """

    poles: Array
    u_knots: Array
    v_knots: Array
    u: Array
    v: Array

    __repr__ = brief

    def __post_init__(self) -> None:
        for name in ("poles", "u_knots", "v_knots", "u", "v"):
            object.__setattr__(self, name, readonly(getattr(self, name)))

    def evaluate(self, u: Array, v: Array, nu: int = 0, nv: int = 0) -> Array:
        """Return points, or mixed derivatives, on the grid of `v` and `u`, (kv, ku, 3)."""
        across = _basis(self.u_knots, u, nu)
        along = _basis(self.v_knots, v, nv)
        return np.tensordot(along, np.tensordot(across, self.poles, axes=(1, 0)), axes=(1, 1))

    def halves(self) -> tuple["SurfaceNet", "SurfaceNet"]:
        """Cut the surface at the leading edge, u = 0.5, exactly, by knot insertion."""
        from scipy.interpolate import BSpline

        spline = BSpline(self.u_knots, self.poles, DEGREE)
        present = int(np.count_nonzero(self.u_knots == 0.5))
        spline = spline.insert_knot(0.5, DEGREE - present)
        first = int(np.searchsorted(spline.t, 0.5))
        clamp = np.full(DEGREE + 1, 0.5)
        middle = self.u <= 0.5, self.u >= 0.5
        return (
            SurfaceNet(
                spline.c[:first],
                np.concatenate([spline.t[:first], clamp]),
                self.v_knots,
                self.u[middle[0]],
                self.v,
            ),
            SurfaceNet(
                spline.c[first - 1 : len(spline.t) - DEGREE - 1],
                np.concatenate([clamp, spline.t[first + DEGREE :]]),
                self.v_knots,
                self.u[middle[1]],
                self.v,
            ),
        )

    def volume(self) -> float:
        """Return the volume [m3] inside the surface, its flat ends and its trailing edge.

        The divergence theorem, exact but for rounding (`cone_volume`).  What a round tip adds is
        `ends.tip_volume`.
        """
        strip = np.linspace(self.poles[-1], self.poles[0], DEGREE + 1)
        total = cone_volume(self.poles, self.u_knots, self.v_knots)
        total += cone_volume(strip, BEZIER, self.v_knots)
        u, wu = _quadrature(self.u_knots)
        rows, slopes = self.evaluate(u, ENDS), self.evaluate(u, ENDS, nu=1)
        corners = self.evaluate(ENDS, ENDS)
        for row, slope, (first, _), sign in zip(rows, slopes, corners, (1, -1), strict=True):
            doubled = wu @ np.cross(row - first, slope)
            total += sign * float(first @ doubled) / 6.0
        return total

    def offsets(self, points: Array, u: Array, v: Array) -> Array:
        """Return the distances [m] from points (kv, ku, 3) to the surface, signed, (kv, ku).

        Points are expected near the surface's (u, v): the distance is measured along the
        surface normal there, which is exact to second order.
        """
        normal = np.cross(self.evaluate(u, v, nu=1), self.evaluate(u, v, nv=1))
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        offsets: Array = np.sum((points - self.evaluate(u, v)) * normal, axis=-1)
        return offsets


def cone_volume(poles: Array, u_knots: Array, v_knots: Array) -> float:
    """Return the signed volume [m3] of the cone from the origin to a bicubic surface.

    Positive where d/dv x d/du looks away from the origin.  Cones to the faces of a solid add up to
    its volume.  Gauss-Legendre quadrature on every cell: exact but for rounding.
    """
    u, wu = _quadrature(u_knots)
    v, wv = _quadrature(v_knots)
    surface = SurfaceNet(poles, u_knots, v_knots, u, v)
    flux = np.cross(surface.evaluate(u, v, nv=1), surface.evaluate(u, v, nu=1))
    return float(wv @ np.sum(surface.evaluate(u, v) * flux, axis=-1) @ wu) / 3.0


def fit(sections: Array, u: Array, v: Array) -> SurfaceNet:
    """Interpolate sections (k, n, 3) at landmark parameters u (n,) and spans v (k,)."""
    from scipy.interpolate import make_interp_spline

    across = make_interp_spline(u, sections, DEGREE, axis=1)
    along = make_interp_spline(v, np.moveaxis(across.c, 0, 1), DEGREE, axis=0)
    return SurfaceNet(np.moveaxis(along.c, 0, 1), across.t, along.t, u, v)


def _quadrature(knots: Array) -> tuple[Array, Array]:
    """Return nodes and weights that integrate the products of a bicubic surface exactly."""
    nodes, weights = np.polynomial.legendre.leggauss(5)
    distinct = np.unique(knots)
    half = 0.5 * np.diff(distinct)[:, None]
    return (
        (distinct[:-1, None] + half + half * nodes).reshape(-1),
        (half * weights).reshape(-1),
    )


def _basis(knots: Array, x: Array, derivative: int) -> Array:
    """Return B-spline basis values or derivatives at x, (k, poles), as a matrix."""
    from scipy.interpolate import BSpline

    identity = np.eye(len(knots) - DEGREE - 1)
    values: Array = BSpline(knots, identity, DEGREE)(x, nu=derivative)
    return values
