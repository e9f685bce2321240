"""A surface net fitted to a blade, with knots added until it meets a tolerance.

Each round measures a net between its knots and adds knots where it strays most.  How goes by what
has been measured alone, not by what is asked for: of those
rounds that come closer than all before them, the first that meets the tolerance is taken.  So a
smaller tolerance never gives a larger deviation.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from bladegen.airfoils.landmarks import landmark_parameters
from bladegen.blade.blade import Blade
from bladegen.blade.remembered import Remembered
from bladegen.curves.vectors import cross, lengths
from bladegen.support.arrays import Array
from bladegen.surface.creases import TEAR, Breaks, crease_between
from bladegen.surface.deviation import Deviation, Measured, Offsets, measured, watched
from bladegen.surface.ends import measured as measured_ends
from bladegen.surface.net import SurfaceNet, along_sections, on_knots
from bladegen.surface.splines import DEGREE, Fit, Knots, basis
from bladegen.surface.tips import Tip, flat_tip

__all__ = ["fitted", "resolving"]

FIRST_LANDMARKS = 25  # knots along the chord to begin with
FIRST_GAP = 1.0 / 64.0  # of the span: breaks that are farther apart have knots from the start
FIRST_MISS = 1e-3  # m; so have breaks at which a spline would stray by more
MAX_POLES = 400_000  # some 40 MB of STEP
ROUNDS = 60
RMS_SHARE = 0.1  # of the tolerance, in the mean
VOLUME = 3e-6  # of the blade's may lie between it and the net at most, inside less outside
FINE = 3e-4  # m; of larger tolerances, in proportion
FALL = 0.6  # from one level to the next: an interval that strays by a share of the level is split
SHARE = 0.7  # of the level, along the chord or along the span; half of it where both are over it
PIECES = 4  # of an interval at most in one round
SHORTEST = 1e-4  # of the span, between sections that are taken apart: where they jump, in vain
NARROWEST = 1e-5  # of the way round a section, between knots that are taken apart
CURVED = 0.0246  # a cubic C2 spline strays by so much of a jump of curvature at a knot, times gap^2
TURNED = 0.0851  # and by so much of one of slope, times gap
EXPLAINS = 0.3  # of what an interval strays by: from then on a jump at its end is the reason
SLOWLY = 0.3  # an interval that strays by more than this of what it did before it was halved


def fitted(
    blade: Blade,
    tolerance: float,
    *,
    sections: int | None = None,
    spans: Array | None = None,
    tip: Tip = flat_tip,
    progress: Callable[[str], None] = lambda _: None,
) -> tuple[SurfaceNet, Deviation]:
    """Fit a net to a blade, with knots added until it meets `tolerance`.

    Parameters
    ----------
    blade : Blade
        What to fit.
    tolerance : float
        Largest distance to the blade [m], on all faces.
    sections : int, optional
        Use exactly so many sections instead, wherever that leads.
    spans : (k,) array, optional
        Knots along the span to begin with, root and tip among them, such as those of a blade that
        is alike: twice where that is only C1.
    tip : callable
        How the blade ends, which is measured too.
    progress : callable
        Told what is being done.

    Returns
    -------
    SurfaceNet, Deviation
        The net, and how far it is from the blade.  A deviation above the tolerance means that no
        net of up to `MAX_POLES` met it: the best of them is returned.
    """
    breaks = Breaks.of(blade)
    if sections is not None:
        v = _creased(Knots.simple(blade.stations(sections)), breaks)
        progress(f"fitting {len(v.at)} sections")
        net = on_knots(blade, resolving(blade, v.at, SHARE * tolerance), v)
        return net, Deviation.of([*measured(net, blade).parts, *measured_ends(net, blade, tip)])
    if spans is None:
        u, v = Knots.simple(landmark_parameters(FIRST_LANDMARKS)), _first(breaks, blade.eta)
    else:
        at = np.union1d(spans, blade.eta)
        v = Knots(at, np.clip(np.sum(spans == at[:, None], axis=1), 1, DEGREE - 1))
        u = resolving(blade, at, SHARE * tolerance)
    state = _State(blade, breaks, u, _creased(v, breaks), np.full(len(v.at) - 1, np.inf))
    known, level, best = Remembered(blade), np.inf, None
    for _ in range(ROUNDS):
        progress(f"fitting {len(state.v.at)} sections")
        net = on_knots(known, state.u, state.v)
        found, ends = measured(net, known), measured_ends(net, known, tip)
        deviation = Deviation.of([*found.parts, *ends])
        if best is None or deviation.maximum < best[1].maximum:
            best = net, deviation
            volume = VOLUME * max(1.0, tolerance / FINE)
            good = deviation.rms <= RMS_SHARE * tolerance and abs(found.volume) <= volume
            if deviation.maximum <= tolerance and good:
                break
        level = FALL * min(level, deviation.maximum) if deviation.maximum <= level else level
        finer = state.finer(found, [*found.parts[2:], *ends], level)
        if finer is None or finer.u.poles * finer.v.poles > MAX_POLES:
            break
        state = finer
    assert best is not None
    return best


def resolving(blade: Blade, v: Array, most: float) -> Knots:
    """Return as few knots along the chord as keep splines within `most` [m] of sections at v (k,).

    They are symmetric about 0.5.
    """
    u = Knots.simple(landmark_parameters(FIRST_LANDMARKS))
    for _ in range(ROUNDS):
        places = watched(u, blade)
        fit, points = Fit(u, places), blade.sections(v, places)
        poles = fit(points)
        left = points - along_sections(fit.matrix, poles)
        along = along_sections(basis(u.sequence, places, 1), poles)
        off = lengths(cross(left, along)) / lengths(along)
        finer = _taken_apart(u, _worst(u.at, places, off.max(axis=0)), most)
        if len(finer.at) == len(u.at):
            break
        u = finer
    return u


@dataclass(frozen=True, eq=False)
class _State:
    """A blade's knots in one round, and what each interval strayed by before it was made."""

    blade: Blade
    breaks: Breaks
    u: Knots
    v: Knots
    before: Array

    def finer(self, found: Measured, others: list[Offsets], level: float) -> "_State | None":
        """Return knots with which nothing strays by more than `level` [m], or nearly so."""
        weight, most = np.where(np.abs(found.offsets) > level, 2.0, 1.0), SHARE * level
        across, along = weight * np.abs(found.across), weight * np.abs(found.offsets - found.across)
        by_u = _worst(self.u.at, found.u, across.max(axis=0))
        by_v = _worst(self.v.at, found.v, along.max(axis=1))
        for part in others:
            by_v = np.maximum(by_v, _worst(self.v.at, part.eta, part.distances))
            if part.face == "tip":
                by_u = np.maximum(by_u, _worst(self.u.at, part.u, part.distances))
        u = _taken_apart(self.u, by_u, most)
        state = self._along(by_v, most)
        return None if state.v is self.v and len(u.at) == len(self.u.at) else replace(state, u=u)

    def _along(self, by: Array, most: float) -> "_State":
        """Return the state with more knots along the span where intervals stray by too much."""
        v, times, breaks = self.v.at, self.v.times.copy(), self.breaks
        marked, gap, jumps = by > most, np.diff(v), breaks.found(v)
        for end in (slice(None, -1), slice(1, None)):
            turned = TURNED * jumps[0][end] * gap * (self.v.times[end] < DEGREE)
            curved = CURVED * jumps[1][end] * gap**2 * (self.v.times[end] == 1)
            reasons = marked & (np.maximum(turned, curved) > EXPLAINS * by)
            wanted = np.where(turned > EXPLAINS * by, DEGREE, 2)
            times[end] = np.maximum(times[end], np.where(reasons, wanted, 1))
        raised = times > self.v.times
        split = marked & (gap > SHORTEST)
        new, before = [], self.before
        for i in np.flatnonzero(split):
            at, breaks = _within(
                self.blade,
                breaks,
                v[i : i + 2],
                by[i],
                before[i],
                most,
                bool(raised[i : i + 2].any()),
            )
            new.append(at)
            split[i] = len(at) > 0
        if not (split.any() or raised.any()):
            return self
        counts = np.ones(len(gap), dtype=np.int64)
        counts[split] = [1 + len(at) for at in new if len(at)]
        before = np.repeat(np.where(split, by, before), counts)
        at = np.concatenate([v, *new])
        order = np.argsort(at, kind="stable")
        times = np.concatenate([times, np.ones(len(at) - len(v), dtype=np.int64)])
        knots = _creased(Knots(at[order], times[order]), breaks)
        return replace(self, breaks=breaks, v=knots, before=before)


def _within(
    blade: Blade,
    breaks: Breaks,
    ends: Array,
    by: float,
    before: float,
    most: float,
    raised: bool,
) -> tuple[Array, Breaks]:
    """Return new knots in an interval: at breaks, at a crease that is found, or evenly spread."""
    low, high = ends.tolist()
    gap = high - low
    inner = (breaks.at > low + 0.2 * gap) & (breaks.at < high - 0.2 * gap)
    listed = breaks.at[inner]
    if raised:
        listed = breaks.at[inner & (CURVED * breaks.bends * gap**2 > EXPLAINS * by)]
        return listed, breaks
    if listed.size:
        return listed[[np.argmin(np.abs(listed - 0.5 * (low + high)))]], breaks
    if by > SLOWLY * before:
        at, jumps = crease_between(blade, low, high)
        if min(at - low, high - at) > 2.0 * TEAR:
            if jumps:
                return np.array([at - TEAR, at + TEAR]), breaks.torn(at)
            more = breaks.with_one(blade, at, low, high)
            if TURNED * float(more.found(np.array([at]))[0][0]) * gap > EXPLAINS * by:
                return np.array([at]), more
    wanted = np.ceil((by / most) ** (1.0 / (DEGREE + 1)))
    pieces = int(np.clip(wanted, 2, max(2, min(PIECES, int(2.0 * gap / SHORTEST)))))
    return np.linspace(low, high, pieces + 1)[1:-1], breaks


def _first(breaks: Breaks, stations: Array) -> Knots:
    """Return knots at root, tip and stations, at sharp bends, and at breaks far from all these."""
    bent = CURVED * breaks.bends * FIRST_GAP**2 > FIRST_MISS
    v = np.unique(np.concatenate([[0.0], stations, breaks.at[bent], [1.0]]))
    for at in breaks.at:
        if np.abs(v - at).min() >= FIRST_GAP:
            v = np.insert(v, np.searchsorted(v, at), at)
    return Knots(v, np.where(np.isin(v, breaks.at[bent]), 2, 1))


def _creased(knots: Knots, breaks: Breaks) -> Knots:
    """Return knots that stand three times where the blade has a crease."""
    sharp = np.isin(knots.at, breaks.at[breaks.creases])
    return Knots(knots.at, np.where(sharp, DEGREE, knots.times))


def _worst(at: Array, places: Array, values: Array) -> Array:
    """Return the largest of values at places in each interval between knots (k,), (k - 1,)."""
    worst = np.zeros(len(at) - 1)
    cells = np.clip(np.searchsorted(at, places, side="right") - 1, 0, len(worst) - 1)
    np.maximum.at(worst, cells, values)
    return worst


def _taken_apart(u: Knots, by: Array, most: float) -> Knots:
    """Return knots along the chord with those intervals taken apart that stray by too much.

    On both sides alike: the surface of a round tip meets both pole by pole.
    """
    half = len(by) // 2
    by, side = np.maximum(by, by[::-1])[:half], u.at[: half + 1]
    wanted = np.clip(np.ceil((by / most) ** (1.0 / (DEGREE + 1))), 2, PIECES)
    pieces = np.where((by > most) & (np.diff(side) > NARROWEST), wanted, 1).astype(np.int64)
    start, width = np.repeat(side[:-1], pieces), np.repeat(np.diff(side) / pieces, pieces)
    first = np.repeat(np.cumsum(pieces) - pieces, pieces)
    finer = start + width * (np.arange(len(start)) - first)
    return Knots.simple(np.concatenate([finer, [0.5], 1.0 - finer[::-1]]))
