"""A surface net fitted to a blade, with sections added until it meets a tolerance.

Sections are added where the surface strays from the blade in between, and landmarks where splines
through them stray from the airfoils.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.support.arrays import Array, Indices
from bladegen.surface.deviation import BETWEEN, Deviation, deviation
from bladegen.surface.net import SurfaceNet, fit

__all__ = ["fitted", "resolving_landmarks"]

FIRST_SECTIONS = 120
MAX_SECTIONS = 480
MAX_LANDMARKS = 1601
REFINEMENTS = 14
SHORTEST = 1e-4  # of the span, between sections that are taken apart: where they jump, in vain
MENDINGS = 6  # single sections that may be added where the final measurement is over
MAXIMUM_SHARE = 0.5  # of the tolerance may be spent between sections at most
RMS_SHARE = 0.08  # and in the mean; the rest is left to what lies between landmarks
COARSE = (4, 2, 1)  # strides through the blade's landmarks to begin with
BETWEEN_SHARE = 0.6  # of the tolerance, between landmarks: where more is missed, some are added


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
    if sections is not None:
        progress(f"fitting {len(v)} sections")
        net = fit(blade.sections(v), blade.u, v)
        return net, deviation(net, blade)
    u, points = resolving_landmarks(blade, v, tolerance)
    taken = _Taken.between_all(blade, u, v, points)
    for _ in range(REFINEMENTS):
        progress(f"fitting {len(taken.v)} sections")
        net = taken.net
        offsets = net.offsets(taken.between, u, taken.middles)
        worst = np.abs(offsets).max(axis=1)
        rms = np.sqrt(np.mean(offsets**2, axis=1))
        excess = np.maximum(worst / MAXIMUM_SHARE, rms / RMS_SHARE) / tolerance
        excess[np.diff(taken.v) < SHORTEST] = 0.0
        room = MAX_SECTIONS - len(taken.v)
        split = np.argsort(-excess, kind="stable")[: min(np.count_nonzero(excess > 1), room)]
        if not split.size:
            break
        taken = taken.split(blade, np.sort(split))
    measured = deviation(net, blade)
    for _ in range(MENDINGS):
        v = taken.v
        if measured.maximum <= tolerance or len(v) >= MAX_SECTIONS:
            break
        i = int(np.clip(np.searchsorted(v, measured.eta), 1, len(v) - 1)) - 1
        if v[i + 1] - v[i] < SHORTEST:
            break
        taken = taken.split(blade, np.array([i]))
        net = taken.net
        measured = deviation(net, blade)
    return net, measured


@dataclass(frozen=True, eq=False)
class _Taken:
    """Sections at v (k,), and those in the middles between them, at landmarks u."""

    u: Array
    v: Array
    points: Array
    between: Array

    @classmethod
    def between_all(cls, blade: Blade, u: Array, v: Array, points: Array) -> "_Taken":
        """Return sections with those in between."""
        return cls(u, v, points, _sections(blade, 0.5 * (v[1:] + v[:-1]), u))

    @property
    def middles(self) -> Array:
        """The spans in between, (k - 1,)."""
        return 0.5 * (self.v[1:] + self.v[:-1])

    @property
    def net(self) -> SurfaceNet:
        """The net through the sections."""
        return fit(self.points, self.u, self.v)

    def split(self, blade: Blade, rows: Indices) -> "_Taken":
        """Take the middles of the intervals `rows` (rising) as sections; make those beside them."""
        v = np.insert(self.v, rows + 1, self.middles[rows])
        points = np.insert(self.points, rows + 1, self.between[rows], axis=0)
        new = np.repeat(rows + np.arange(len(rows)), 2) + np.tile([0, 1], len(rows))
        between = np.repeat(self.between, 1 + np.isin(np.arange(len(self.between)), rows), axis=0)
        between[new] = _sections(blade, 0.5 * (v[new] + v[new + 1]), self.u)
        return _Taken(self.u, v, points, between)


def _sections(blade: Blade, v: Array, u: Array) -> Array:
    return blade.sections(v, None if u is blade.u else u)


def resolving_landmarks(blade: Blade, v: Array, tolerance: float) -> tuple[Array, Array]:
    """Return as few landmark parameters as keep splines close to the airfoils' own, and sections.

    Every so many-th of the blade's to begin with, then more where they are needed, on both
    sides alike: the blade's own first, and others between them where noise of the airfoils is
    finer than these.
    """
    from scipy.interpolate import CubicSpline

    half = len(blade.u) // 2
    stride = next(step for step in COARSE if half % step == 0)
    u = blade.u[::stride]
    points = _sections(blade, v, u)
    while len(u) < MAX_LANDMARKS:
        at = np.searchsorted(blade.u, u)
        between = np.clip((at[1:] + at[:-1]) // 2, 0, len(blade.u) - 1)
        own = (np.diff(at) > 1) & (blade.u[at[:-1]] == u[:-1]) & (blade.u[at[1:]] == u[1:])
        # where it is measured in the end, but for the middle: there the blade's own come first
        places = u[:-1, None] + BETWEEN * np.diff(u)[:, None]
        places[own, len(BETWEEN) // 2] = blade.u[between[own]]
        places[len(places) // 2 :] = 1.0 - places[: len(places) // 2][::-1, ::-1]
        spline, true = CubicSpline(u, points, axis=1), blade.sections(v, places.ravel())
        missed = true - spline(places.ravel())
        along = spline(places.ravel(), 1)
        along /= np.linalg.norm(along, axis=-1, keepdims=True)
        missed = np.linalg.norm(np.cross(missed, along), axis=-1)
        split = missed.reshape(-1, *places.shape).max(axis=(0, 2)) > BETWEEN_SHARE * tolerance
        split |= split[::-1]
        if not split.any():
            break
        u = np.sort(np.concatenate([u, places[split, len(BETWEEN) // 2]]))
        points = _sections(blade, v, u)
    return u, points
