"""Along which axis a cloud of a blade lies: normal to the rim of its root, where that is flat.

The longest axis of inertia of a prebent or swept blade leans by degrees from its pitch axis (DTU
10 MW by 1.7).  The rim of the root, the points that are lowest in each sector round it, lies in a
plane to within the distance between points, over a diameter of metres.
"""

import itertools

import numpy as np

from bladegen.errors import GeometryError
from bladegen.support.arrays import Array, Mask

__all__ = ["along"]

SOME = 100_000  # points that tell the longest axis
CLOSE = np.radians(5.0)  # between the longest axis and another that is taken for the pitch axis
SECTORS = 48  # of a rim
NEAR = 0.04  # of the length, in which a rim is
OUTSIDE = 0.9  # of the root's radius: points nearer to its middle are of a cap
FEW = 5  # points of a sector that say where the rim is
LOWEST = 2  # points of a sector that are passed over: they may be strays
MOST = 1.3  # times the median radius: a root is round, or nearly
FLAT = 0.005  # of the root's radius, by which a rim leaves its plane
WHOLE = 0.5  # of the sectors, at least, that a rim is seen in
ROUNDS = 4
WIDE = 0.1  # of the squared diameter, that a triangle's area is twice of: its plane is sure


def along(points: Array, name: str) -> tuple[Array, Array, bool]:
    """Return axes with z along a cloud from its root, the root's middle, and whether by its rim.

    Raises
    ------
    GeometryError
        If the points are no slender body.
    """
    some = points[:: max(1, len(points) // SOME)]
    away = some - some.mean(axis=0)
    sizes, axes = np.linalg.eigh(away.T @ away)
    if not sizes[2] > 9.0 * sizes[1]:
        raise GeometryError(
            f"{name}: no blade: the points spread as far across as along; must be a slender body"
        )
    longest = axes[:, 2]
    reach = some @ longest
    low, high = np.percentile(reach, [5.0, 95.0])
    spread = [np.var(some[side] @ axes[:, 0]) for side in (reach < low, reach > high)]
    if spread[1] > spread[0]:
        longest = -longest
    direction = _on_rim(points, longest)
    found = direction is not None
    if direction is None:
        k = int(np.argmax(np.abs(longest)))
        near = abs(longest[k]) > np.cos(CLOSE)
        direction = np.eye(3)[k] * np.sign(longest[k]) if near else longest
    frame = _frame(direction)
    own = some @ frame  # sections' places are followed over z: a far origin would turn with them
    start = np.array([*_middle(own), float((points @ direction).min())])
    return frame, start, found


def _middle(own: Array) -> Array:
    """Return the middle of the root's extents across its axis."""
    z = own[:, 2]
    near = own[z < z.min() + NEAR * np.ptp(z), :2]
    middle: Array = np.percentile(near, [1.0, 99.0], axis=0).mean(axis=0)
    return middle


def _frame(direction: Array) -> Array:
    x = np.cross([0.0, 1.0, 0.0] if abs(direction[1]) < 0.9 else [1.0, 0.0, 0.0], direction)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(direction, x), direction], axis=1)


def _on_rim(points: Array, longest: Array) -> Array | None:
    """Return the normal of the plane that the root's rim lies in, None where it has none."""
    direction = longest
    for _ in range(ROUNDS):
        frame = _frame(direction)
        own = points @ frame
        low, high = float(own[:, 2].min()), float(own[:, 2].max())
        near = own[own[:, 2] < low + NEAR * (high - low)]
        ends = np.percentile(near[:, :2], [1.0, 99.0], axis=0)
        away = near[:, :2] - ends.mean(axis=0)
        far = np.hypot(*away.T)
        radius = float(np.median(far[far > 0.5 * np.percentile(far, 90.0)]))
        if np.percentile(far, 99.0) > MOST * radius:
            return None
        rim = _rim(away, near[:, 2], far > OUTSIDE * radius)
        if len(rim) < WHOLE * SECTORS:
            return None
        plane, some = _plane(rim, FLAT * radius)
        normal = np.array([-plane[0], -plane[1], 1.0])
        direction = frame @ (normal / np.linalg.norm(normal))
        if some.sum() < WHOLE * SECTORS or direction @ longest < np.cos(CLOSE):
            return None
    return direction


def _rim(away: Array, z: Array, outer: Array) -> Array:
    """Return a low point (x, y, z) of each sector round a root that has points enough."""
    turn = np.arctan2(away[:, 1], away[:, 0]) / (2.0 * np.pi) + 0.5
    sector = np.minimum((SECTORS * turn).astype(np.int64), SECTORS - 1)
    rim = []
    for k in range(SECTORS):
        own = np.flatnonzero(outer & (sector == k))
        if len(own) > FEW:
            one = own[np.argsort(z[own])[LOWEST]]
            rim.append([*away[one], z[one]])
    return np.array(rim).reshape(-1, 3)


def _plane(rim: Array, within: float) -> tuple[Array, Mask]:
    """Return the coefficients of z over (x, y, 1) of the plane that most of a rim lies in.

    Holes take whole sectors of a rim away, so that all planes through three of its points are
    tried (Fischler and Bolles, Comm. ACM 24 (1981)); also which points lie within a distance.
    """
    rows = np.column_stack([rim[:, :2], np.ones(len(rim))])
    three = np.array(list(itertools.combinations(range(len(rim)), 3)))
    wide = np.abs(np.linalg.det(rows[three])) > WIDE * np.ptp(rim[:, :2]) ** 2
    three = three[wide]
    if not len(three):
        return np.zeros(3), np.zeros(len(rim), dtype=bool)
    made = np.linalg.solve(rows[three], rim[three, 2][..., None])[..., 0]
    off = np.abs(made @ rows.T - rim[:, 2])
    some = off[np.argmax((off < within).sum(axis=1))] < within
    best = np.linalg.lstsq(rows[some], rim[some, 2], rcond=None)[0]
    return best, some
