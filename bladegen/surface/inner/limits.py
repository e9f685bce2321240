"""Where walls do not fit into their sections, and how much of the layers that leaves out."""

import numpy as np

from bladegen.airfoils.landmarks import landmark_parameters
from bladegen.curves.vectors import cross, lengths
from bladegen.errors import Finding
from bladegen.support.arrays import Array, Mask
from bladegen.surface.inner.room import MOST
from bladegen.surface.inner.wall import Mapped, Wall

__all__ = ["limited"]

SPANS, PLACES = 201, 401
KEPT = 0.98  # of a wall: one that keeps less is said to be limited
NEAR = 0.02  # of the span, between parts of it that are told as one
HALF = 0.5  # of the chord: what lies behind is told apart from what lies before


def limited(wall: Wall) -> tuple[float, tuple[Finding, ...]]:
    """Return the volume [m3] of layers for which there is no room, and findings on where."""
    at = wall.at(np.linspace(0.0, 1.0, SPANS), landmark_parameters(PLACES))
    lost = at.thickness - at.depth
    slopes = wall.net.evaluate(at.u, at.eta, nu=1), wall.net.evaluate(at.u, at.eta, nv=1)
    area = lengths(cross(*slopes))
    left_out = float(np.trapezoid(np.trapezoid(lost * area, at.u, axis=1), at.eta))
    few, along = at.depth < KEPT * at.thickness, _along_chord(at)
    parts = (("behind", few & (along >= HALF)), ("around the nose", few & (along < HALF)))
    found = tuple(_said(where, there, at, along) for where, there in parts if there.any())
    return left_out, found


def _along_chord(at: Mapped) -> Array:
    """Return how far behind the nose points lie (k, n), over the chord."""
    nose = at.points[:, len(at.u) // 2, None]
    chord = 0.5 * (at.points[:, :1] + at.points[:, -1:]) - nose
    found: Array = np.sum((at.points - nose) * chord, axis=-1) / np.sum(chord**2, axis=-1)
    return found


def _said(where: str, there: Mask, at: Mapped, along: Array) -> Finding:
    """Say where walls are limited, and what they are where that takes most of them."""
    spans = at.eta[there.any(axis=1)]
    runs = np.split(spans, np.flatnonzero(np.diff(spans) > NEAR) + 1)
    told = ", ".join(f"{100 * run[0]:.0f} to {100 * run[-1]:.0f}" for run in runs)
    taken = np.where(there, at.thickness - at.depth, 0.0).sum(axis=1)
    row = int(np.argmax(taken))
    column = int(np.argmin(np.where(there[row], along[row], np.inf)))
    thick, free = 1e3 * at.thickness[row, column], 2e3 * at.room[row, column]
    place = f"{where} {100 * along[there].min():.0f} % chord" if where == "behind" else where
    return Finding(
        "inner surface",
        f"limited {place} from {told} % span, to {100 * MOST:.0f} % of the room: walls of 2 x "
        f"{thick:.0f} mm in {free:.0f} mm at eta = {at.eta[row]:.3f}, "
        f"{100 * along[row, column]:.0f} % chord",
    )
