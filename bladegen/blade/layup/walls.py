"""How thick the wall is at every landmark: all layers that cover it, with ramps at their edges.

A layer does not end in a step.  Around the section it runs out over `RAMP` of the chord, half of it
to either side of its edge, so that it keeps its area; ramps that reach the trailing edge are folded
back there, which keeps it too.  Along the span thickness is blended over `BLEND` of the blade, by
cubic B-splines whose coefficients it is (Schoenberg's approximation): where it changes evenly it
stays as it is, and what begins or ends at once runs out.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.blade.layup.laid import Laid
from bladegen.blade.layup.layup import Layup
from bladegen.blade.layup.outlines import Outlines
from bladegen.support.arrays import Array
from bladegen.support.recent import Recent

__all__ = ["BLEND", "RAMP", "Walls"]

RAMP = 0.05  # of the chord: 50 mm from cap to core run out 1 to 5 where it is 5 m
BLEND = 0.01  # of the span: 50 mm run out 1 to 20 on 100 m
SPANS = 401  # at which layers are looked up: the support of a cubic is four steps of these
PLACES = 4  # sets of landmark parameters whose thicknesses are kept; some 3 MB each
DEGREE = 3


@dataclass(frozen=True, eq=False)
class Walls:
    """The walls of a blade's skin; layers of webs are no part of them.

    Parameters
    ----------
    layup : Layup
        Layers of a blade.
    """

    layup: Layup

    def thickness(self, eta: Array, u: Array) -> Array:
        """Return the thickness (k, n) [m] at span fractions (k,) and landmark parameters (n,)."""
        if self.layup.blade.mirrored:  # whose landmarks run the other way
            return self._own.thickness(eta, 1.0 - u[::-1])[:, ::-1]
        found: Array = np.maximum(_blend(eta) @ self._rows(u), 0.0)
        return found

    @cached_property
    def _own(self) -> "Walls":
        return Walls(Layup(self.layup.blade.mirror_image(), self.layup.structure))

    @cached_property
    def _known(self) -> Recent[Array]:
        return Recent(PLACES)

    @cached_property
    def _laid(self) -> tuple[Laid, Array, Array]:
        """Return layers, fractions of landmarks and lengths of ramps, of the arc, at `SPANS`."""
        eta = np.linspace(0.0, 1.0, SPANS)
        outlines = Outlines.of(self.layup.blade, eta)
        ramp = RAMP * self.layup.blade.chord(eta) / outlines.length
        return self.layup.at(eta), outlines.fractions, ramp[:, None]

    def _rows(self, u: Array) -> Array:
        """Return the coefficients (SPANS + 2, n) of thickness [m]: one more before and behind."""

        def made() -> Array:
            laid, fractions, ramp = self._laid
            at = np.array([np.interp(u, self.layup.blade.u, row) for row in fractions])
            total = np.zeros_like(at)
            for layer, thick, arcs in zip(
                self.layup.structure.layers, laid.thickness, laid.arcs, strict=True
            ):
                if layer.web or not thick.any():
                    continue
                start, end = np.nan_to_num(arcs).T[..., None]
                share = _between(at, start, end, ramp)
                if layer.around:
                    share += _between(at, start + 1.0, end + 1.0, ramp)
                total += thick[:, None] * share
            beyond = 2.0 * total[[0, -1]] - total[[1, -2]]
            return np.concatenate([beyond[:1], total, beyond[1:]])

        return self._known.get(u.tobytes(), made)


def _between(at: Array, start: Array, end: Array, ramp: Array) -> Array:
    """Return by how much layers from start to end (k, 1) cover places (k, n), 0 to 1.

    What lies beyond the corners is cut; images beyond them take the ramps there back.
    """
    start = np.clip(start, 0.0, 1.0)
    end = np.maximum(start, np.clip(end, 0.0, 1.0))
    copies = [(start, end)]
    copies += [(-end, -start)] if np.any(start < ramp) else []
    copies += [(2.0 - end, 2.0 - start)] if np.any(end > 1.0 - ramp) else []
    covered = (_risen((at - a) / ramp) - _risen((at - b) / ramp) for a, b in copies)
    return sum(covered, np.zeros_like(at))


def _risen(t: Array) -> Array:
    """Return a ramp from 0 to 1 about t = 0, of length 1, with even slopes at its ends."""
    x = np.clip(t + 0.5, 0.0, 1.0)
    risen: Array = x * x * (3.0 - 2.0 * x)
    return risen


def _blend(eta: Array) -> Array:
    """Return the cubic B-splines (k, SPANS + 2) about `SPANS` even spans, and one more each way."""
    from scipy.interpolate import BSpline

    knots = np.arange(-DEGREE, SPANS + DEGREE) / (SPANS - 1)
    matrix: Array = BSpline.design_matrix(eta, knots, DEGREE)
    return matrix
