"""Deviations that are made up: an eroded leading edge, a dent, waves; at spans and landmarks."""

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import BladegenError
from bladegen.support.arrays import Array

__all__ = ["SPANS", "dent", "erosion", "waves"]

SPANS = 120
FEWEST = 8  # landmarks a wave
SETS_IN = 0.2  # of a pattern's span, over which it sets in

Pattern = tuple[Array, Array]  # span fractions (k,), and values (k, n) at the blade's landmarks [m]


def erosion(blade: Blade, start: float, end: float, width: float, depth: float) -> Pattern:
    """Return an eroded leading edge; see `DeviationMap.erosion`."""
    eta = _spans("erosion", start, end)
    arc = _arcs(blade, eta)
    along = np.clip((eta - start) / (SETS_IN * (end - start)), 0.0, 1.0) * (eta <= end)
    across = np.clip(1.0 - arc / width, 0.0, 1.0)
    return eta, -depth * _smooth(along)[:, None] * _smooth(across)


def dent(blade: Blade, eta: float, u: float, size: float, depth: float) -> Pattern:
    """Return a round hollow; see `DeviationMap.dent`."""
    widest = float(np.max(blade.chord(np.linspace(0.0, 1.0, SPANS))))
    for name, value in (("size", size), ("depth", depth)):
        if not 0.0 < abs(value) <= widest or (name == "size" and value < 0.0):
            raise BladegenError(
                f"dent: {name}: got {value:g} m, allowed is above 0 to the largest chord, "
                f"{widest:.3g} m; lengths are metres, such as 0.6 for 600 mm"
            )
    reach = size / blade.length
    near = np.linspace(max(eta - reach, 0.0), min(eta + reach, 1.0), 41)
    spans = np.unique(np.concatenate([np.linspace(0.0, 1.0, SPANS // 2), near]))
    middle = blade.sections(np.array([eta]), np.array([u]))[0, 0]
    away = np.linalg.norm(blade.sections(spans) - middle, axis=-1)
    return spans, -depth * _smooth(np.clip(1.0 - 2.0 * away / size, 0.0, 1.0))


def waves(blade: Blade, start: float, end: float, length: float, height: float) -> Pattern:
    """Return a wavy skin; see `DeviationMap.waves`."""
    eta = _spans("waves", start, end)
    arc = _arcs(blade, eta) * blade.chord(eta)[:, None]
    steps = np.abs(np.diff(arc, axis=1))[(eta >= start) & (eta <= end)]
    if steps.max() > length / FEWEST:
        raise BladegenError(
            f"waves: length {length:g} m is less than {FEWEST} landmarks, which lie up to "
            f"{1e3 * steps.max():.3g} mm apart; take longer waves, or more landmarks (landmarks=)"
        )
    share = (eta - start) / (end - start)
    along = np.clip(np.minimum(share, 1.0 - share) / SETS_IN, 0.0, 1.0)
    half = arc.shape[1] // 2
    ends = np.where(np.arange(arc.shape[1]) < half, arc[:, :1], arc[:, -1:])
    across = np.clip(np.minimum(arc, ends - arc) / length, 0.0, 1.0)
    values = 0.5 * height * np.sin(2.0 * np.pi * arc / length)
    return eta, _smooth(along)[:, None] * _smooth(across) * values


def _spans(what: str, start: float, end: float) -> Array:
    """Return the spans of a pattern, its ends among them."""
    if not 0.0 <= start < end <= 1.0:
        raise BladegenError(
            f"{what}: start and end must rise within 0 to 1, got {start:g} and {end:g}"
        )
    return np.unique(np.concatenate([np.linspace(0.0, 1.0, SPANS), [start, end]]))


def _smooth(share: Array) -> Array:
    """Return a C2 step from 0 to 1."""
    step: Array = share * share * share * (10.0 - 15.0 * share + 6.0 * share * share)
    return step


def _arcs(blade: Blade, eta: Array) -> Array:
    """Return arc lengths from the leading edge (k, n), over the chord, positive on either side."""
    steps = np.linalg.norm(np.diff(blade.profiles(eta), axis=1), axis=-1)
    arc = np.concatenate([np.zeros((len(eta), 1)), np.cumsum(steps, axis=1)], axis=1)
    return np.asarray(np.abs(arc - arc[:, len(blade.u) // 2][:, None]))
