"""How a blade ends: flat in the plane of its last section, or rounded by arcs across it.

A tip maps the last section's opposite points, and the directions in which the sides arrive
there, to cubic Bezier arcs from the suction to the pressure side: the one formula from which
solids, meshes and grids take the same surface.  Metres, blade frame; any unit will do.
"""

from collections.abc import Callable

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.support.arrays import Array

__all__ = ["TIPS", "Tip", "arcs", "flat_tip", "on_arcs", "round_tip"]

STEP = 1e-4  # of the span: sides' directions by differences are then good to 1e-6 and better

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


TIPS: dict[str, Tip] = {"flat": flat_tip, "round": round_tip}  # as the command line calls them


def arcs(blade: Blade, tip: Tip, u: Array | None = None) -> Array | None:
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
    last, before, further = blade.sections(np.array([1.0, 1.0 - STEP, 1.0 - 2.0 * STEP]), u)
    along = 1.5 * last - 2.0 * before + 0.5 * further
    middle = len(last) // 2
    suction, pressure = slice(None, middle + 1), slice(None, middle - 1, -1)
    return tip(last[suction], last[pressure], along[suction], along[pressure])


def on_arcs(poles: Array, w: Array) -> Array:
    """Return points of arcs (..., 4, 3) at parameters w (...) from 0, suction, to 1, pressure."""
    t = w[..., None]
    weights = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=-2)
    points: Array = np.sum(weights * poles, axis=-2)
    return points
