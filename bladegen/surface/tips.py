"""How a blade ends: flat in the plane of its last section, or rounded by arcs across it.

A tip maps the last section's opposite points, and the directions in which the sides arrive
there, to cubic Bezier arcs from the suction to the pressure side: the one formula from which
solids, meshes and grids take the same surface.  Metres, blade frame; any unit will do.
"""

from collections.abc import Callable

import numpy as np

from bladegen.blade.remembered import Sectioned
from bladegen.support.arrays import Array, readonly

__all__ = [
    "SPANS",
    "TIPS",
    "Tip",
    "arcs",
    "ends",
    "flat_tip",
    "on_arcs",
    "round_tip",
    "round_tip_slopes",
]

STEP = 1e-4  # of the span: sides' directions by differences are then good to 1e-6 and better
SPANS = readonly([1.0, 1.0 - STEP, 1.0 - 2.0 * STEP])

Tip = Callable[[Array, Array, Array, Array], Array | None]


def flat_tip(*_: Array) -> None:
    """End in the plane of the last section: there are no arcs."""


def round_tip(suction: Array, pressure: Array, along: Array, opposite: Array) -> Array:
    """End in a cap that leaves both sides tangentially and is round across.

    Opposite points are joined by cubic Bezier arcs whose inner poles lie 4/3 of half their
    distance along the blade, the usual arc of 180 degrees: an ellipse to 2 % of its size.

    Parameters
    ----------
    suction, pressure : (m, 3) arrays
        Opposite points of the last section.
    along, opposite : (m, 3) arrays
        Directions along the blade in which the suction and the pressure side arrive there, of
        any length.

    Returns
    -------
    (m, 4, 3) array
        The arcs' poles, from the suction to the pressure side.
    """
    reach = 2.0 / 3.0 * np.linalg.norm(suction - pressure, axis=-1, keepdims=True)
    lifted = suction + reach * along / np.linalg.norm(along, axis=-1, keepdims=True)
    opposed = pressure + reach * opposite / np.linalg.norm(opposite, axis=-1, keepdims=True)
    return np.stack([suction, lifted, opposed, pressure], axis=-2)


def round_tip_slopes(given: tuple[Array, ...], changes: tuple[Array, ...]) -> Array:
    """Return the derivatives (m, 4, 3, p) of `round_tip` in p directions.

    Parameters
    ----------
    given : four (m, 3) arrays
        Its arguments.
    changes : four (m, 3, p) arrays
        Their derivatives.
    """
    suction, pressure, along, opposite = given
    by_suction, by_pressure, by_along, by_opposite = changes
    gap, width = suction - pressure, np.linalg.norm(suction - pressure, axis=-1)[:, None, None]
    growth = np.sum(gap[..., None] * (by_suction - by_pressure), axis=1, keepdims=True)
    reach = 2.0 / 3.0 * width
    by_reach = np.divide(2.0 / 3.0 * growth, width, out=np.zeros_like(growth), where=width > 0)

    def raised(start: Array, way: Array, change: Array) -> Array:
        length = np.linalg.norm(way, axis=-1)[:, None, None]
        unit, change = way[..., None] / length, change / length
        change = change - unit * np.sum(unit * change, axis=1, keepdims=True)
        result: Array = start + by_reach * unit + reach * change
        return result

    lifted = raised(by_suction, along, by_along)
    opposed = raised(by_pressure, opposite, by_opposite)
    return np.stack([by_suction, lifted, opposed, by_pressure], axis=1)


TIPS: dict[str, Tip] = {"flat": flat_tip, "round": round_tip}  # as the command line calls them


def arcs(blade: Sectioned, tip: Tip, u: Array | None = None) -> Array | None:
    """Return the arcs' poles at a blade's tip, from the trailing to the leading edge.

    Parameters
    ----------
    blade : Blade
        What ends there.
    tip : callable
        `flat_tip` or `round_tip`.
    u : (n,) array, optional
        Landmark parameters instead of the blade's own, as for `Blade.sections`.

    Returns
    -------
    (n // 2 + 1, 4, 3) array or None
        Poles [m]; None if the tip is flat.
    """
    return tip(*ends(blade.sections(SPANS, u)))


def ends(sections: Array) -> tuple[Array, Array, Array, Array]:
    """Return what a tip maps, (m, ...) each, of sections (3, n, ...) at `SPANS`, or derivatives."""
    last, before, further = sections
    along = 1.5 * last - 2.0 * before + 0.5 * further
    middle = len(last) // 2
    suction, pressure = slice(None, middle + 1), slice(None, middle - 1, -1)
    return last[suction], last[pressure], along[suction], along[pressure]


def on_arcs(poles: Array, w: Array) -> Array:
    """Return points of arcs (..., 4, 3) at parameters w (...) from 0, suction, to 1, pressure."""
    t = w[..., None]
    weights = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=-2)
    points: Array = np.sum(weights * poles, axis=-2)
    return points
