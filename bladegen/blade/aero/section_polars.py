"""Polars of many sections at once: NeuralFoil between stalls, Viterna's equations beyond.

The same laws as for a definition's airfoils (`definition.estimates`), in batches: from 40 %
thickness on, the polar of the section thinned to 40 % is mixed with that of a cylinder.  Angles
are from the chord line, nose to the middle of the trailing edge.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.airfoils.viterna import around, stalls
from bladegen.blade.aero.kulfan import WEIGHTS, kulfan
from bladegen.definition.estimates import ANGLES, CYLINDER_DRAG, MODEL, THICK, rounded
from bladegen.errors import BladegenError, MissingLibraryError
from bladegen.support.arguments import one_of
from bladegen.support.arrays import Array

__all__ = ["GRID", "NETWORKS", "SectionPolars", "polars_of"]

GRID = np.radians(np.linspace(-180.0, 180.0, 721))  # where rotors read coefficients
NETWORKS = ("xxsmall", "xsmall", "small", "medium", "large", "xlarge", "xxlarge", "xxxlarge")
AT_ONCE = 8192  # cases; the network's answer takes 2 kB each
FIGURES = ("CL", "CD", "CM", "analysis_confidence")


@dataclass(frozen=True, eq=False)
class SectionPolars:
    """Coefficients of sections (...) at angles of attack, by default `ANGLES` [deg].

    Parameters
    ----------
    lift, drag, moment : (..., m) arrays
        As the network gives them for the sections, thinned where they are too thick for it.
    confidence : (..., m) array
        Of the network in its answer, 0 to 1.
    share : (...) array
        Of a cylinder in the polar.
    """

    lift: Array
    drag: Array
    moment: Array
    confidence: Array
    share: Array

    @property
    def cl(self) -> Array:
        """Lift coefficients (..., m)."""
        return self._mixed(self.lift)

    @property
    def cd(self) -> Array:
        """Drag coefficients (..., m)."""
        return self._mixed(self.drag, CYLINDER_DRAG)

    @property
    def cm(self) -> Array:
        """Moment coefficients (..., m) about the quarter chord, nose up."""
        return self._mixed(self.moment)

    def extended(self) -> tuple[Array, Array]:
        """Return lift and drag (..., 721) at the angles of `GRID`, if they are at `ANGLES`."""
        shape = self.lift.shape[:-1]
        parts = (part.reshape(-1, part.shape[-1]) for part in (self.lift, self.drag))
        cl, cd = (part.reshape(*shape, -1) for part in around(GRID, np.radians(ANGLES), *parts))
        return self._mixed(cl), self._mixed(cd, CYLINDER_DRAG)

    def _mixed(self, values: Array, cylinder: float = 0.0) -> Array:
        share = self.share[..., None]
        return np.asarray((1.0 - share) * values + share * cylinder)

    @property
    def least_confidence(self) -> Array:
        """Of sections (...), between their stalls."""
        low, high = stalls(np.radians(ANGLES), self.lift)
        at = np.arange(len(ANGLES))
        between = (at >= low) & (at <= high)
        least: Array = np.where(between, self.confidence, 1.0).min(axis=-1)
        return least


def polars_of(
    outlines: Array,
    thickness: Array,
    reynolds: Array,
    *,
    angles: Array = ANGLES,
    size: str = MODEL,
) -> SectionPolars:
    """Return the polars of sections.

    Parameters
    ----------
    outlines : (..., n, 2) array
        In chords, nose in the origin, as `elements.Elements` has them.
    thickness : (...) array
        Over chord.
    reynolds : (...) array
        Reynolds numbers.
    angles : (m,) array
        Of attack [deg].
    size : str
        Of NeuralFoil's network, of `NETWORKS`.

    Raises
    ------
    MissingLibraryError
        If NeuralFoil is not installed.
    BladegenError
        If there is no network of that size.
    """
    one_of(size, NETWORKS, "network", BladegenError)
    shape = thickness.shape
    flat = np.asarray(outlines, dtype=np.float64).reshape(-1, *outlines.shape[-2:])
    thick = thickness.reshape(-1)
    thinned = np.minimum(1.0, THICK / thick)[:, None]
    weights, _ = kulfan(flat[..., 0], flat[..., 1] * thinned)
    numbers = np.broadcast_to(reynolds, shape).reshape(-1)
    rows = max(1, AT_ONCE // len(angles))
    parts = [
        _answer(weights[start : start + rows], numbers[start : start + rows], angles, size)
        for start in range(0, len(weights), rows)
    ]
    found = {name: np.concatenate([part[name] for part in parts]) for name in FIGURES}
    cl, cd, cm, sure = (values.reshape(*shape, -1) for values in found.values())
    return SectionPolars(cl, cd, cm, sure, rounded(thickness))


def _answer(weights: Array, reynolds: Array, angles: Array, size: str) -> dict[str, Any]:
    """Return what the network says of sections with Kulfan's parameters (b, 18), (b, m) each."""
    try:
        import neuralfoil
    except ImportError as error:
        raise MissingLibraryError(error) from None
    count, each = len(weights), len(angles)
    columns = np.repeat(weights, each, axis=0).T
    given = {
        "upper_weights": columns[:WEIGHTS],
        "lower_weights": columns[WEIGHTS : 2 * WEIGHTS],
        "leading_edge_weight": columns[-2],
        "TE_thickness": columns[-1],
    }
    found = neuralfoil.get_aero_from_kulfan_parameters(
        given, np.tile(angles, count), np.repeat(reynolds, each), model_size=size
    )
    return {name: np.asarray(found[name]).reshape(count, each) for name in FIGURES}
