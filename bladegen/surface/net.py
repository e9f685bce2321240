"""A blade's surface as one tensor-product B-spline, fitted until it meets a tolerance.

The surface wraps suction side -> leading edge -> pressure side: cubic and C2 along the chord
in the landmark parameter u, and along the span in eta.  It interpolates the landmarks of its
sections; sections are added where the surface strays from the blade in between.  The truth it
is held against is the blade itself, at spans and landmarks that the net does not use.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.support.arrays import Array, readonly

__all__ = [
    "BEZIER",
    "CLOSED_EDGE",
    "Deviation",
    "Offsets",
    "SurfaceNet",
    "cone_volume",
    "fit",
    "fitted",
    "resolving_landmarks",
]

DEGREE = 3
BEZIER = np.repeat([0.0, 1.0], DEGREE + 1)  # knots of a single cubic
FIRST_SECTIONS = 120
MAX_SECTIONS = 480
MAX_LANDMARKS = 1601
REFINEMENTS = 14
MENDINGS = 6  # single sections that may be added where the final measurement is over
MAXIMUM_SHARE = 0.5  # of the tolerance may be spent between sections at most
RMS_SHARE = 0.08  # and in the mean; the rest is left to what lies between landmarks
CLOSED_EDGE = 1e-7  # m; a trailing edge thinner than this everywhere is sharp
BETWEEN = np.array([0.25, 0.5, 0.75])  # of the way between landmarks, where a net is measured
COARSE = (4, 2, 1)  # strides through the blade's landmarks to begin with
BETWEEN_SHARE = 0.6  # of the tolerance, between landmarks: where more is missed, some are added


@dataclass(frozen=True, eq=False)
class Offsets:
    """Distances of points of the blade to one face of its solid.

    Parameters
    ----------
    face : str
        The face's name.
    distances, eta, u : (m,) arrays
        Distances [m], and where the points are.
    """

    face: str
    distances: Array
    eta: Array
    u: Array


@dataclass(frozen=True)
class Deviation:
    """How far a surface lies from the blade, at points that it was not made from.

    Lengths in metres; `face`, `eta` and `u` say where the largest is, `samples` how many were
    taken; `parts` holds them.
    """

    maximum: float
    rms: float
    percentile99: float
    face: str
    eta: float
    u: float
    samples: int
    parts: tuple[Offsets, ...] = field(default=(), repr=False, compare=False)

    @classmethod
    def of(cls, parts: Sequence[Offsets]) -> "Deviation":
        """Return the deviation over some faces, not all of them without points."""
        distances, eta, u = (
            np.concatenate([getattr(part, name) for part in parts])
            for name in ("distances", "eta", "u")
        )
        worst = int(np.argmax(distances))
        counts = np.cumsum([len(part.distances) for part in parts])
        return cls(
            maximum=float(distances[worst]),
            rms=float(np.sqrt(np.mean(distances**2))),
            percentile99=float(np.percentile(distances, 99)),
            face=parts[int(np.searchsorted(counts, worst, side="right"))].face,
            eta=float(eta[worst]),
            u=float(u[worst]),
            samples=len(distances),
            parts=tuple(parts),
        )

    @property
    def faces(self) -> dict[str, "Deviation"]:
        """The deviation of each face by itself."""
        return {part.face: Deviation.of((part,)) for part in self.parts if len(part.distances)}


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
        rows, slopes = self.evaluate(u, _ENDS), self.evaluate(u, _ENDS, nu=1)
        corners = self.evaluate(_ENDS, _ENDS)
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


def fitted(
    blade: Blade,
    tolerance: float,
    *,
    sections: int | None = None,
    spans: Array | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> tuple[SurfaceNet, Deviation]:
    """Fit a net to a blade, with sections added until it meets `tolerance`.

    Parameters
    ----------
    blade : Blade
        What to fit.
    tolerance : float
        Largest distance to the blade's sections [m].
    sections : int, optional
        Use exactly so many sections instead, wherever that leads.
    spans : (k,) array, optional
        Sections to begin with, root and tip among them, such as those of a blade that is alike.
    progress : callable
        Told what is being done.

    Returns
    -------
    SurfaceNet, Deviation
        The net, and how far it is from the blade.  A deviation above the tolerance means
        that more sections would not help, or would be more than `MAX_SECTIONS`.
    """
    v = spans
    if v is None:
        v = blade.stations(FIRST_SECTIONS if sections is None else sections)
    u = blade.u if sections is not None else resolving_landmarks(blade, v, tolerance)
    for _ in range(REFINEMENTS):
        progress(f"fitting {len(v)} sections")
        net = fit(_sections(blade, v, u), u, v)
        if sections is not None:
            break
        middles = 0.5 * (v[1:] + v[:-1])
        offsets = net.offsets(_sections(blade, middles, u), u, middles)
        worst = np.abs(offsets).max(axis=1)
        rms = np.sqrt(np.mean(offsets**2, axis=1))
        excess = np.maximum(worst / MAXIMUM_SHARE, rms / RMS_SHARE) / tolerance
        room = MAX_SECTIONS - len(v)
        split = np.argsort(-excess, kind="stable")[: min(np.count_nonzero(excess > 1), room)]
        if not split.size:
            break
        v = np.sort(np.concatenate([v, middles[split]]))
    measured = deviation(net, blade)
    for _ in range(MENDINGS):
        if sections is not None or measured.maximum <= tolerance or len(v) >= MAX_SECTIONS:
            break
        i = int(np.clip(np.searchsorted(v, measured.eta), 1, len(v) - 1))
        v = np.sort(np.append(v, 0.5 * (v[i - 1] + v[i])))
        net = fit(_sections(blade, v, u), u, v)
        measured = deviation(net, blade)
    return net, measured


def _sections(blade: Blade, v: Array, u: Array) -> Array:
    return blade.sections(v, None if u is blade.u else u)


def resolving_landmarks(blade: Blade, v: Array, tolerance: float) -> Array:
    """Return as few landmark parameters as keep splines close to the airfoils' own.

    Every so many-th of the blade's to begin with, then more where they are needed, on both
    sides alike: the blade's own first, and others between them where noise of the airfoils is
    finer than these.
    """
    from scipy.interpolate import CubicSpline

    half = len(blade.u) // 2
    stride = next(step for step in COARSE if half % step == 0)
    u = blade.u[::stride]
    while len(u) < MAX_LANDMARKS:
        at = np.searchsorted(blade.u, u)
        between = np.clip((at[1:] + at[:-1]) // 2, 0, len(blade.u) - 1)
        own = (np.diff(at) > 1) & (blade.u[at[:-1]] == u[:-1]) & (blade.u[at[1:]] == u[1:])
        # where it is measured in the end, but for the middle: there the blade's own come first
        places = u[:-1, None] + BETWEEN * np.diff(u)[:, None]
        places[own, len(BETWEEN) // 2] = blade.u[between[own]]
        places[len(places) // 2 :] = 1.0 - places[: len(places) // 2][::-1, ::-1]
        spline = CubicSpline(u, _sections(blade, v, u), axis=1)
        missed = blade.sections(v, places.ravel()) - spline(places.ravel())
        along = spline(places.ravel(), 1)
        along /= np.linalg.norm(along, axis=-1, keepdims=True)
        missed = np.linalg.norm(np.cross(missed, along), axis=-1)
        split = missed.reshape(-1, *places.shape).max(axis=(0, 2)) > BETWEEN_SHARE * tolerance
        split |= split[::-1]
        if not split.any():
            break
        u = np.sort(np.concatenate([u, places[split, len(BETWEEN) // 2]]))
    return u


def deviation(net: SurfaceNet, blade: Blade) -> Deviation:
    """Measure a net against its blade, at three places between landmarks and off its sections.

    The end sections' rims are measured too, and the strip between the trailing edges.
    """
    starts, widths = net.v[:-1], np.diff(net.v)
    v = np.sort(np.concatenate([starts + widths / 3.0, starts + 0.75 * widths, net.v[[0, -1]]]))
    u = np.concatenate([[0.0], *(net.u[:-1] + share * np.diff(net.u) for share in BETWEEN), [1.0]])
    u = np.sort(u)
    points = blade.sections(v, u)
    offsets = np.abs(net.offsets(points, u, v))
    eta, places = np.broadcast_arrays(v[:, None], u)
    front, back = u <= 0.5, u >= 0.5
    sides = [
        Offsets(face, offsets[:, some].ravel(), eta[:, some].ravel(), places[:, some].ravel())
        for face, some in zip(blade.sides, (front, back), strict=True)
    ]
    return Deviation.of([*sides, _strip(net, points[:, [0, -1]], v)])


def _strip(net: SurfaceNet, ends: Array, v: Array) -> Offsets:
    """Measure the strip between the trailing edges (k, 2, 3) at spans v (k,), where it is open."""
    ours, along = net.evaluate(_ENDS, v), net.evaluate(_ENDS, v, nv=1)
    share = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    across = np.stack([1.0 - share, share], axis=-1)  # of the suction side's end, the pressure's
    normal = np.cross(across @ along, (ours[:, 1] - ours[:, 0])[:, None])
    length = np.linalg.norm(normal, axis=-1)
    missed = np.abs(np.sum(across @ (ends - ours) * normal, axis=-1))
    wide = np.linalg.norm(ours[:, 1] - ours[:, 0], axis=-1) > CLOSED_EDGE
    distances = missed[wide] / length[wide]
    eta = np.broadcast_to(v[wide, None], distances.shape)
    u = np.broadcast_to(np.round(share), distances.shape)
    return Offsets("trailing edge", distances.ravel(), eta.ravel(), u.ravel())


_ENDS = np.array([0.0, 1.0])


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
