"""Leading edges that pass from one nose to another without a jump over span.

The leading edge is the point farthest from the trailing edge.  A blunt nose can have two such
points, and between two sections the one becomes the farther: chord lines turn there at once, and
landmarks are joined across the nose.  Here the leading edge goes from one to the other over a
stretch of the span, and where it is on its way the nose is lowered until it is the farthest
point, by no more than is told.

Per section, r(psi) is the distance from the trailing edge's middle at the angle psi from the
chord line, in chords.  The path psi(z) of leading edges has the least of

    integral (1 - r) chord / ALLOWED + WEIGHT (ds / dz)^2 dz,    s = chord psi,

lengths in chords, by dynamic programming over even angles (Bellman, 1957).
"""

from dataclasses import replace

import numpy as np

from bladegen.airfoils.landmarks import contour, landmark_parameters
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.curves.crossing import crossing_sections
from bladegen.errors import GeometryError
from bladegen.fitting.measuring import LANDMARKS, Sections
from bladegen.fitting.smoothing import with_twist
from bladegen.support.arrays import Array, Indices, Mask

__all__ = ["vagueness", "with_steady_noses"]

WEIGHT = 40.0  # of the leading edge's slope over span
FARTHEST = 8.0  # times `allowed`: a nose is lowered by less
STEP = 2.5e-4  # rad between places on a nose
AHEAD = 0.45  # of the chord, in which a nose is
WIDEST = 0.3  # rad on either side of the chord line
FEWEST = 4  # landmarks of a nose on either side
NEAR = 0.02  # rad between a lowered nose's highest landmark and where it is to be
SAME = 2.0  # steps: places nearer to the farthest point than this are that
ROUNDED = 1.0  # of `allowed`, by which a lowered nose falls off to where it was highest


def with_steady_noses(sections: Sections, length: float, allowed: float) -> Sections:
    """Return sections whose leading edges do not jump.

    Parameters
    ----------
    sections : Sections
        As they were measured, root first.
    length : float
        Of the blade [m].
    allowed : float
        By what a nose may be lowered without much ado [m].
    """
    noses = [_Nose(airfoil, WIDEST) for airfoil in sections.airfoils]
    wanted = _path(noses, sections, length, allowed)
    turn = np.zeros(len(wanted))
    airfoils = sections.airfoils.copy()
    for k in np.flatnonzero(np.abs(wanted) > SAME * STEP).tolist():
        cut = noses[k].lowered(wanted[k], ROUNDED * allowed / float(sections.chord[k]))
        if cut is not None:
            airfoils[k], turn[k] = cut, wanted[k]
    moved = np.flatnonzero(turn)
    if not moved.size:
        return sections
    turned = with_twist(replace(sections, airfoils=airfoils), sections.twist + turn)
    return _sized(turned, moved)


def vagueness(sections: Sections, allowed: float) -> Array:
    """Return by what angle (k,) leading edges may lie elsewhere on their noses [rad].

    Where points are as far from the trailing edge as the leading edge, but for a length `allowed`
    [m].
    """
    found = np.zeros(len(sections.eta))
    for k, airfoil in enumerate(sections.airfoils):
        psi, _ = _Nose(airfoil, WIDEST).places(allowed / float(sections.chord[k]))
        found[k] = 0.5 * np.ptp(psi)
    return found


class _Nose:
    """The nose of an airfoil (n, 2) about its trailing edge: distances over angles."""

    def __init__(self, airfoil: Array, widest: float) -> None:
        from scipy.interpolate import CubicSpline

        self.airfoil = airfoil
        x, y = airfoil.T
        self.psi, self.r = np.arctan2(-y, 1.0 - x), np.hypot(1.0 - x, y)
        middle = len(airfoil) // 2
        ahead = (x < AHEAD) & (np.abs(self.psi) < widest)
        rising = np.diff(self.psi) > 0.0
        first = middle - _run((ahead[1:] & ahead[:-1] & rising)[:middle][::-1])
        last = middle + _run((ahead[1:] & ahead[:-1] & rising)[middle:])
        self.rows = np.arange(first, last + 1)
        self.plain = min(middle - first, last - middle) >= FEWEST
        if self.plain:
            self.spline = CubicSpline(self.psi[self.rows], self.r[self.rows])
        self.low, self.high = self.psi[first], self.psi[last]

    def places(self, drop: float) -> tuple[Array, Array]:
        """Return even angles where the nose is at most so much short of the farthest point."""
        if not self.plain:  # it turns back on itself
            return np.zeros(1), np.zeros(1)
        steps = np.arange(np.ceil(self.low / STEP), np.floor(self.high / STEP) + 1.0)
        psi = steps * STEP
        short = np.maximum(1.0 - self.spline(psi), 0.0)
        some = short <= drop
        some[np.abs(psi) < 0.5 * STEP] = True
        if not some.any():  # the chord line is beside the nose
            return np.zeros(1), np.zeros(1)
        return psi[some], short[some]

    def lowered(self, psi: float, fall: float) -> Array | None:
        """Return the airfoil with its nose cut back until it is farthest at an angle.

        None where that leaves another point the farthest, beside what counts as the nose, or the
        airfoil crossing itself.
        """
        top = float(self.spline(psi))
        reach = abs(psi)
        cap = top - fall * np.minimum(((self.psi - psi) / reach) ** 2, 1.0)
        near = np.zeros(len(self.r), dtype=bool)
        near[self.rows] = True
        r = np.where(near, np.minimum(self.r, cap), self.r)
        away = self.airfoil - [1.0, 0.0]
        lowered: Array = [1.0, 0.0] + away * (r / self.r)[:, None]
        first = int(np.argmax(r))
        if not self.rows[1] < first < self.rows[-2] or abs(self.psi[first] - psi) > NEAR:
            return None
        try:
            points = contour(lowered).landmarks(landmark_parameters(LANDMARKS))
        except GeometryError:
            return None
        return None if crossing_sections(points[None]) else lowered


def _run(flags: Mask) -> int:
    """Return how many flags are set before the first that is not."""
    unset = np.flatnonzero(~flags)
    return int(unset[0]) if unset.size else len(flags)


def _path(noses: list[_Nose], sections: Sections, length: float, allowed: float) -> Array:
    """Return the angles (k,) of the path's leading edges from the chord lines."""
    chord, z = sections.chord, sections.eta * length
    gap = np.diff(z)
    share = np.zeros(len(z))  # of the span that each section stands for
    share[1:] += 0.5 * gap
    share[:-1] += 0.5 * gap
    cost = np.zeros(1)
    before: list[Indices] = []
    found = [nose.places(FARTHEST * allowed / c) for nose, c in zip(noses, chord, strict=True)]
    for k, (psi, short) in enumerate(found):
        own = short * chord[k] / allowed * share[k] / chord[k]
        if k == 0:
            cost = own
            continue
        last = found[k - 1][0] + sections.twist[k - 1]
        step = (psi + sections.twist[k])[:, None] - last[None]
        mean = 0.5 * (chord[k] + chord[k - 1])
        total = cost[None] + WEIGHT * step**2 * (mean / max(gap[k - 1], 1e-9))
        best = np.argmin(total, axis=1)
        before.append(best)
        cost = total[np.arange(len(psi)), best] + own
    at = int(np.argmin(cost))
    path = [at]
    for best in reversed(before):
        at = int(best[at])
        path.append(at)
    return np.array([psi[i] for (psi, _), i in zip(found, reversed(path), strict=True)])


def _sized(sections: Sections, moved: Indices) -> Sections:
    """Bring lowered airfoils to unit chord, and their landmarks to the leading edge."""
    u = landmark_parameters(LANDMARKS)
    airfoils, chord, offset = (
        getattr(sections, name).copy() for name in ("airfoils", "chord", "offset")
    )
    thickness = sections.thickness.copy()
    points = np.stack([contour(airfoils[k]).landmarks(u) for k in moved.tolist()])
    curves = SectionSplines(u).fit(points)
    size = curves.chord
    airfoils[moved] = [1.0, 0.0] + (points - [1.0, 0.0]) / size[:, None, None]
    offset[moved] -= chord[moved] * (1.0 - size)
    chord[moved] *= size
    thickness[moved] = curves.relative_thickness
    return replace(sections, airfoils=airfoils, chord=chord, offset=offset, thickness=thickness)
