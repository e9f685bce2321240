"""A solid's two ends: the surface that rounds its tip, its volume, and how far both are off.

The tip's arcs (`tips`) are made from the net's sides where a spline with their knots is
determined, so that their surface meets the sides pole by pole.  What it is held against is made
from the blade itself, at landmarks between those of the net.  Metres.
"""

import numpy as np

from bladegen.blade.remembered import Sectioned
from bladegen.support.arrays import Array
from bladegen.surface.deviation import Offsets
from bladegen.surface.net import BEZIER, CLOSED_EDGE, SurfaceNet, cone_volume
from bladegen.surface.splines import DEGREE
from bladegen.surface.tips import Tip, arcs, on_arcs

__all__ = ["edge_poles", "measured", "rounded", "tip_volume"]

ACROSS = np.linspace(0.0, 1.0, 9)  # places across the ends at which they are measured


def rounded(net: SurfaceNet, tip: Tip) -> Array | None:
    """Return the poles (a, 4, 3) of the surface that rounds the tip, None if it is flat.

    Along the first axis they belong to the knots of the net's suction side, along the second they
    are cubic Bezier poles from the suction to the pressure side.
    """
    from scipy.interpolate import make_interp_spline

    suction, pressure = net.halves()
    knots, end = suction.u_knots, np.ones(1)
    u = np.lib.stride_tricks.sliding_window_view(knots[1:-1], DEGREE).mean(axis=-1)
    (start,), (along,) = suction.evaluate(u, end), suction.evaluate(u, end, nv=1)
    (stop,), (opposite,) = pressure.evaluate(1.0 - u, end), pressure.evaluate(1.0 - u, end, nv=1)
    across = tip(start, stop, along, opposite)
    if across is None:
        return None
    poles: Array = make_interp_spline(u, across, DEGREE, t=knots).c
    poles[:, 0], poles[:, -1] = suction.poles[:, -1], pressure.poles[::-1, -1]
    return poles


def edge_poles(poles: Array) -> Array:
    """Return the poles (4, 4, 3) of the ruled face that closes a round tip's trailing edge.

    It goes from the straight line across the last section's edge to the first arc of `rounded`.
    """
    return np.linspace(np.linspace(poles[0, 0], poles[0, -1], DEGREE + 1), poles[0], DEGREE + 1)


def tip_volume(net: SurfaceNet, tip: Tip) -> float:
    """Return the volume [m3] beyond the plane of the last section, exact but for rounding."""
    poles = rounded(net, tip)
    if poles is None:
        return 0.0
    poles = poles - poles[0, 0]  # the plane then goes through the origin, and its cone is flat
    face = cone_volume(poles, net.halves()[0].u_knots, BEZIER)
    return face + cone_volume(edge_poles(poles), BEZIER, BEZIER)


def measured(net: SurfaceNet, blade: Sectioned, tip: Tip) -> list[Offsets]:
    """Measure root and tip: the planes of flat ends, the arcs of a round tip."""
    middles = 0.5 * (net.u[1:] + net.u[:-1])
    u = np.unique(np.concatenate([[0.0], middles, [0.5, 1.0]]))
    ends = [_plane("root", net, blade, u, 0.0)]
    poles = rounded(net, tip)
    if poles is None:
        return [*ends, _plane("tip", net, blade, u, 1.0)]
    wanted = arcs(blade, tip, u)
    assert wanted is not None  # the tip is round
    return [*ends, *_round(net, poles, wanted, u[: len(wanted)])]


def _plane(face: str, net: SurfaceNet, blade: Sectioned, u: Array, v: float) -> Offsets:
    """Measure the plane of an end section, over all of it."""
    (ours,) = net.evaluate(u, np.array([v]))
    centre = ours.mean(axis=0)
    normal = np.sum(np.cross(ours[:-1] - centre, ours[1:] - centre), axis=0)
    (points,) = blade.sections(np.array([v]), u)
    half = len(u) // 2 + 1
    lines = points[:half] + ACROSS[:, None, None] * (points[: half - 2 : -1] - points[:half])
    distances = np.abs((lines - centre) @ normal) / np.linalg.norm(normal)
    places = np.broadcast_to(u[:half], distances.shape)
    return Offsets(face, distances.ravel(), np.full(distances.size, v), places.ravel())


def _round(net: SurfaceNet, poles: Array, wanted: Array, u: Array) -> list[Offsets]:
    """Measure a round tip against the arcs (m, 4, 3) that the blade itself has at u (m,)."""
    from scipy.interpolate import BSpline

    spline = BSpline(net.halves()[0].u_knots, poles, DEGREE)
    ours, along = (spline(u, nu)[:, None] for nu in (0, 1))
    points = on_arcs(ours, ACROSS)
    slopes = DEGREE * (ours[:, :, 1:] - ours[:, :, :-1])
    round_ = _normal_offsets(
        on_arcs(wanted[:, None], ACROSS) - points, on_arcs(along, ACROSS), _quadratic(slopes)
    )
    faces = [_offsets("tip", round_, u)]
    if np.linalg.norm(ours[0, 0, 0] - ours[0, 0, -1]) > CLOSED_EDGE:
        straight, other = (
            ends[0] + ACROSS[:, None] * (ends[-1] - ends[0]) for ends in (ours[0, 0], wanted[0])
        )
        rise = points[0] - straight
        missed = 0.5 * (on_arcs(wanted[:1], ACROSS) - points[0] + other - straight)
        level = np.broadcast_to(ours[0, 0, -1] - ours[0, 0, 0], rise.shape)
        edge = _normal_offsets(missed[1:-1], rise[1:-1], level[1:-1])
        faces.append(_offsets("tip trailing edge", edge[None], u[:1]))
    return faces


def _quadratic(poles: Array) -> Array:
    """Return points of quadratic Bezier curves (m, 1, 3, 3) across the tip, (m, q, 3)."""
    t = ACROSS[:, None]
    weights = np.stack([(1 - t) ** 2, 2 * t * (1 - t), t**2], axis=-2)
    points: Array = np.sum(weights * poles, axis=-2)
    return points


def _normal_offsets(missed: Array, one: Array, other: Array) -> Array:
    """Return lengths of vectors along the normals of two directions, 0 where these are one."""
    normal = np.cross(one, other)
    length = np.linalg.norm(normal, axis=-1)
    distances = np.abs(np.sum(missed * normal, axis=-1))
    return np.asarray(np.divide(distances, length, out=np.zeros_like(length), where=length > 0))


def _offsets(face: str, distances: Array, u: Array) -> Offsets:
    places = np.broadcast_to(u[:, None], distances.shape)
    return Offsets(face, distances.ravel(), np.ones(distances.size), places.ravel())
