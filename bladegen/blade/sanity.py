"""Which perturbed sections no aerodynamicist would take for an airfoil, and why.

A section may be sound, neither crossing itself nor without thickness, and be no airfoil
all the same: its nose concave or pinched, its tail drooped, its sides wavy.  Each is held against
the section that the blade had there before it was perturbed, brought to the same relative
thickness, by the figures of `characteristics`.

The limits are from data (`benchmarks/sanity.py`): none of the perturbed airfoils of the paper's
database leaves them, and none of the bundled blades' own sections.
"""

from dataclasses import dataclass

import numpy as np

from bladegen.airfoils.section_curves import SectionCurves
from bladegen.errors import Finding
from bladegen.support.arrays import Array, Indices

__all__ = [
    "CHARACTERISTICS",
    "FIGURES",
    "KINDS",
    "ODD",
    "Oddities",
    "characteristics",
    "characteristics_along",
    "oddities",
]

# what `characteristics` fills: the nose's turning back [rad], its radius [chord], inflections of
# either side, the mean line's average [chord] and its angle at the tail [rad]
CHARACTERISTICS = ("notch", "radius", "suction_bends", "pressure_bends", "camber", "tail")
ODD = "allow_odd=True (--allow-odd) takes it"
ROUND = 0.7  # of the chord; thicker sections are on the way to a circle, and no airfoils
NOTCH = np.radians(3.0)  # by which a nose may turn back more than the one before
RADIUS = (0.5, 2.0)  # times the radius before
BENDS = 2  # more on a side than before
CAMBER = 0.035  # of the chord: the mean line's average may leave the one before
TAIL = np.radians(6.0)  # by which the mean line may turn at the trailing edge
DEGREES = 180.0 / np.pi
KINDS = (
    "",
    "has a concave nose",
    "has a pinched nose",
    "has a blunted nose",
    "has a wavy suction side",
    "has a wavy pressure side",
    "has another camber",
    "has a drooped tail",
)
# what `KINDS` from 1 on are judged by: angles [deg], radii over the one before, camber [chord]
FIGURES = ("notch", "radius", "radius", "suction_bends", "pressure_bends", "camber", "tail")
SMALLER = 2  # of `KINDS`: here the figure is too small, elsewhere too large


def characteristics(curves: SectionCurves, flat: Array) -> Array:
    """Return `CHARACTERISTICS` (k, 6) of sections, their heights times factors (k,)."""
    lines = np.concatenate([curves.leading_edge, curves.trailing_edge], axis=-1)
    return characteristics_along(lines, curves.points, flat)


def characteristics_along(lines: Array, points: Array, flat: Array) -> Array:
    """Return `CHARACTERISTICS` (k, 6) of sections (k, n, 2) along chord lines (k, 4)."""
    from bladegen.airfoils.characteristics import characteristics_of

    result: Array = np.empty((len(points), len(CHARACTERISTICS)))
    characteristics_of(np.ascontiguousarray(points.mT), lines, np.array(flat), result)
    return result


@dataclass(frozen=True, eq=False)
class Oddities:
    """What is odd about sections (...), and the figures behind it.

    Parameters
    ----------
    kinds : (...) array of int
        Places in `KINDS`, the first that applies; 0 where nothing is odd.
    figures, limits : (..., 7) arrays
        `FIGURES`, and what is allowed.
    """

    kinds: Indices
    figures: Array
    limits: Array

    def said(self, place: tuple[int, ...]) -> str:
        """Say what is odd about one section; "" if nothing is."""
        kind = int(self.kinds[place])
        if not kind:
            return ""
        figure, limit = self.figures[place][kind - 1], self.limits[place][kind - 1]
        return f"{KINDS[kind]}: " + _WORDS[kind - 1].format(figure=figure, limit=limit)

    def findings(self, eta: Array) -> tuple[Finding, ...]:
        """Return one finding a kind for sections at span fractions (k,): where, and the worst."""
        found = []
        for kind in np.unique(self.kinds[self.kinds > 0]).tolist():
            rows = np.flatnonzero(self.kinds == kind)
            figure = self.figures[rows, kind - 1] / self.limits[rows, kind - 1]
            worst = rows[np.argmin(figure) if kind == SMALLER else np.argmax(figure)]
            low, high = eta[rows[0]], eta[rows[-1]]
            place = f"eta = {low:.4f}" if len(rows) == 1 else f"eta = {low:.4f} to {high:.4f}"
            at = f" (at eta = {eta[worst]:.4f})" if len(rows) > 1 else ""
            found.append(Finding(place, f"the section {self.said((int(worst),))}{at}"))
        return tuple(found)


_WORDS = (
    "its contour turns back by {figure:.1f} deg, at most {limit:.1f} deg is allowed",
    "its radius is {figure:.2f} of the baseline's, at least {limit:.2f} is allowed",
    "its radius is {figure:.2f} of the baseline's, at most {limit:.2f} is allowed",
    "{figure:.0f} inflections, at most {limit:.0f} are allowed",
    "{figure:.0f} inflections, at most {limit:.0f} are allowed",
    "its mean line is {figure:.1%} of the chord off the baseline's, at most {limit:.1%} is allowed",
    "its mean line is turned by {figure:.1f} deg, at most {limit:.1f} deg is allowed",
)


def oddities(own: Array, before: Array, thickness: Array) -> Oddities:
    """Return what is odd about sections.

    Parameters
    ----------
    own, before : (..., 6) arrays
        `CHARACTERISTICS`, theirs and before.
    thickness : (...) array
        Relative thickness before; sections above `ROUND` are never odd.
    """
    own, before = np.broadcast_arrays(own, before)
    thickness = np.broadcast_to(thickness, own.shape[:-1])
    notch, radius, suction, pressure, camber, tail = np.moveaxis(own, -1, 0)
    notch0, radius0, suction0, pressure0, camber0, tail0 = np.moveaxis(before, -1, 0)
    share = np.divide(radius, radius0, out=np.ones_like(radius), where=radius0 > 0.0)
    one = np.ones_like(notch)
    figures = np.stack(
        [
            DEGREES * notch,
            share,
            share,
            suction,
            pressure,
            np.abs(camber - camber0),
            DEGREES * np.abs(tail - tail0),
        ],
        axis=-1,
    )
    limits = np.stack(
        [
            DEGREES * (notch0 + NOTCH),
            RADIUS[0] * one,
            RADIUS[1] * one,
            suction0 + BENDS,
            pressure0 + BENDS,
            CAMBER * one,
            DEGREES * TAIL * one,
        ],
        axis=-1,
    )
    odd = ~(figures <= limits)
    odd[..., SMALLER - 1] = ~(figures[..., SMALLER - 1] >= limits[..., SMALLER - 1])
    kinds = np.where(odd.any(axis=-1) & (thickness <= ROUND), 1 + np.argmax(odd, axis=-1), 0)
    return Oddities(kinds, figures, limits)
