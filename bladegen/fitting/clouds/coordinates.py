"""Coordinates in which every section of a blade is nearly a circle.

In its plane a section, its camber taken out, lies about an ellipse of half axes a and b; all follow
the blade smoothly over z.  With w the point from the ellipse's middle along its axes, its height
less that of the camber line there, and f^2 = a^2 - b^2,

    Z = w + sqrt(w^2 - f^2),    rho = log |Z| / (a + b),    phi = arg Z

(Joukowsky's map) takes the ellipse to rho = 0 and any airfoil to a smooth function rho(phi), with
edges that are resolved as well as they are sharp.  `phi` is 0 at one edge and pi at the other.
"""

import itertools
from dataclasses import dataclass

import numpy as np

from bladegen.fitting.smoothing import smoothed
from bladegen.support.arrays import Array

__all__ = ["Ellipses", "about"]

INSIDE = 0.96  # of f^2: foci inside of thin edges
SLABS = 96
FEWEST = 30  # points of a slab
END = 0.002  # of the span, where caps may lie
AROUND = 5  # slabs on either side, of which the median is taken
CLEAR = 0.15  # of the moments, by which one axis is longer: less is nearly round
BINS = 24  # along a section, in which its camber is told
EDGE = 0.015  # of the extent, of points at an edge
BEYOND = 0.5  # per cent of a slab's points that are left out at either end of an axis


@dataclass(frozen=True, eq=False)
class Ellipses:
    """Ellipses over z: middles (k, 2), angles of the long axes [rad], half axes (k, 2) [m].

    `camber` (k, 4) are the coefficients of camber lines in half axes, (1 - x^2) times a cubic.
    """

    z: Array
    middle: Array
    angle: Array
    half: Array
    camber: Array

    def _at(self, z: Array) -> tuple[Array, Array, Array, Array, Array]:
        from scipy.interpolate import PchipInterpolator

        table = np.column_stack([self.middle, self.angle, self.half, self.camber])
        inside = np.clip(z, self.z[0], self.z[-1])
        x, y, angle, a, b, *camber = PchipInterpolator(self.z, table)(inside).T
        square = INSIDE * np.maximum(a * a - b * b, 0.0)
        return x + 1j * y, np.exp(1j * angle), np.stack([a, b]), square, np.stack(camber)

    def flattened(self, points: Array) -> tuple[Array, Array]:
        """Return rho and phi of points (m, 3)."""
        start, turn, half, square, camber = self._at(points[:, 2])
        w = (points[:, 0] + 1j * points[:, 1] - start) / turn
        w = w - 1j * half[0] * _line(w.real / half[0], camber)
        f = np.sqrt(square)
        Z = w + np.sqrt(w - f) * np.sqrt(w + f)
        return np.log(np.maximum(np.abs(Z), 1e-12) / half.sum(axis=0)), np.angle(Z)

    def points(self, rho: Array, phi: Array, z: Array) -> Array:
        """Return points (m, 3) of coordinates (m,) each."""
        start, turn, half, square, camber = self._at(z)
        Z = half.sum(axis=0) * np.exp(rho + 1j * phi)
        w = 0.5 * (Z + square / Z)
        w = start + turn * (w + 1j * half[0] * _line(w.real / half[0], camber))
        return np.stack([w.real, w.imag, z], axis=-1)


def _line(x: Array, camber: Array) -> Array:
    """Return heights of camber lines at x from -1 to 1; level beyond."""
    x = np.clip(x, -1.0, 1.0)
    cubic = camber[0] + x * (camber[1] + x * (camber[2] + x * camber[3]))
    height: Array = (1.0 - x * x) * cubic
    return height


def about(points: Array) -> Ellipses:
    """Return ellipses that follow points (m, 3) of a blade along z, which starts at 0.

    Their long axes end at the sections' edges.
    """
    length = float(points[:, 2].max())
    edges = np.linspace(END * length, (1.0 - END) * length, SLABS + 1)
    order = np.argsort(points[:, 2], kind="stable")
    bounds = np.searchsorted(points[order, 2], edges)
    slabs = [
        points[order[first:last]]
        for first, last in itertools.pairwise(bounds)
        if last - first >= FEWEST
    ]
    z, way_x, way_y, share = np.array([_moments(slab) for slab in slabs]).T
    doubled = np.unwrap(np.arctan2(way_y, way_x)[::-1])[::-1]  # from the tip, where it is clear
    clear = share > CLEAR
    rough = np.interp(z, z[clear], _even(_steady(0.5 * doubled[clear])))
    ends = np.array([_ends(slab, angle) for slab, angle in zip(slabs, rough, strict=True)]).T
    low, high, bottom, top, at_low, at_high = (
        smoothed(z, _steady(row, quantile))
        for row, quantile in zip(ends, (0.3, 0.7, 0.3, 0.7, 0.5, 0.5), strict=True)
    )
    ready = np.clip((share - CLEAR) / CLEAR, 0.0, 1.0)
    tilt = ready * (at_high - at_low) / (high - low)
    middle = (
        0.5 * (low + high),
        (1.0 - ready) * 0.5 * (bottom + top) + ready * 0.5 * (at_low + at_high),
    )
    c, s = np.cos(rough), np.sin(rough)
    half = np.stack([0.5 * (high - low) * np.hypot(1.0, tilt), 0.5 * (top - bottom)], axis=1)
    half = np.stack([half.max(axis=1), half.min(axis=1)], axis=1)
    middles = np.stack([middle[0] * c - middle[1] * s, middle[0] * s + middle[1] * c], axis=1)
    angle = rough + np.arctan(tilt)
    camber = np.array(
        [_camber(slab, *own) for slab, *own in zip(slabs, middles, angle, half[:, 0], strict=True)]
    )
    camber = np.stack([smoothed(z, ready * _steady(row)) for row in camber.T], axis=1)
    return Ellipses(z, middles, angle, half, camber)


def _camber(slab: Array, middle: Array, angle: float, half: float) -> Array:
    """Return a slab's camber line, from the middles of its extents across, bin by bin."""
    w = (slab[:, 0] + 1j * slab[:, 1] - middle[0] - 1j * middle[1]) * np.exp(-1j * angle) / half
    bins = np.floor((w.real + 1.0) * 0.5 * BINS).astype(np.int64)
    x, heights = [], []
    for k in range(1, BINS - 1):
        own = w.imag[bins == k]
        if len(own) > 3:
            x.append(2.0 * (k + 0.5) / BINS - 1.0)
            heights.append(0.5 * (own.min() + own.max()))
    if len(x) < BINS // 2:
        return np.zeros(4)
    at = np.array(x)
    rows = (1.0 - at * at)[:, None] * at[:, None] ** np.arange(4)
    return np.asarray(np.linalg.lstsq(rows, np.array(heights), rcond=None)[0])


def _ends(slab: Array, angle: float) -> tuple[float, float, float, float, float, float]:
    """Return extents of a slab along and across a direction, and where across its ends are."""
    c, s = np.cos(angle), np.sin(angle)
    along, across = slab[:, 0] * c + slab[:, 1] * s, slab[:, 1] * c - slab[:, 0] * s
    low, high = np.percentile(along, [BEYOND, 100.0 - BEYOND])
    bottom, top = np.percentile(across, [BEYOND, 100.0 - BEYOND])
    near = EDGE * (high - low)
    first, last = across[along < low + near], across[along > high - near]
    return low, high, bottom, top, float(first.mean()), float(last.mean())


def _even(values: Array) -> Array:
    """Return running means of values (k,), twice of five, about their line at the ends."""
    for _ in range(2):
        ring = np.concatenate(
            [2.0 * values[0] - values[2:0:-1], values, 2.0 * values[-1] - values[-2:-4:-1]]
        )
        values = np.lib.stride_tricks.sliding_window_view(ring, 5).mean(axis=1)
    return values


def _steady(values: Array, quantile: float = 0.5) -> Array:
    """Return running quantiles of values (k,) about their running slope: holes make dips."""
    count = min(AROUND, (len(values) - 1) // 2)
    ring = np.concatenate(
        [
            2.0 * values[0] - values[count:0:-1],
            values,
            2.0 * values[-1] - values[-2 : -count - 2 : -1],
        ]
    )
    near = np.lib.stride_tricks.sliding_window_view(ring, 2 * count + 1)
    slope = np.median(np.diff(near, axis=1), axis=1)
    level = near - slope[:, None] * np.arange(-count, count + 1)
    steady: Array = np.quantile(level, quantile, axis=1)
    return steady


def _moments(slab: Array) -> tuple[float, float, float, float]:
    """Return a slab's z, the direction of its long axis as a doubled angle, and how clear it is."""
    x, y, z = slab.mean(axis=0)
    u, v = slab[:, 0] - x, slab[:, 1] - y
    xx, yy, xy = np.mean(u * u), np.mean(v * v), np.mean(u * v)
    way = float(np.hypot(xx - yy, 2.0 * xy))
    return float(z), float(xx - yy), float(2.0 * xy), way / float(xx + yy)
