"""Whether perturbed sections are sections still: tests of a `Shape` before anybody is handed it.

A section may leave a space's data, cross itself, lose its thickness, or be none that an
aerodynamicist would take (`sanity`).  Shapes to findings, or to an error with place and figure.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from bladegen.airfoils.chord_lines import ChordLines
from bladegen.blade.changes.deformation import Deformation
from bladegen.blade.sanity import ODD, Oddities, characteristics_along, oddities
from bladegen.blade.shape import Shape
from bladegen.curves.crossing import crossing_sections
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import Finding, PerturbationError
from bladegen.shapes import affine
from bladegen.shapes.domain import BEYOND, Domain
from bladegen.support.arrays import Array, readonly

__all__ = ["SOUND_SPANS", "Trial", "leaving"]

SOUND_SPANS = 60  # spans at which a perturbed blade is tested
FOLDING = 0.1  # of a step's direction; sections that keep less of one are about to fold
FINER = 32  # times, between spans of which one is about to fold
LOST_THICKNESS = 0.2  # of the thickness before, which a deformation must leave


def leaving(shape: Shape, deformation: Deformation, *, allowed: bool) -> tuple[Finding, ...]:
    """Say which section of a shape a deformation takes out of its space's data first.

    Raises
    ------
    PerturbationError
        If one leaves them, and that is not allowed.
    """
    eta = _spans(shape)
    joined = shape.loft.sections(eta)
    thickness = shape.wanted_thickness(eta)
    thickness = joined.thickness if thickness is None else thickness
    if shape.deformations:
        own = deformation.space.encode(shape.shapes(eta)[1])
    else:
        own = joined.carried(deformation.space).coordinates
    domain = Domain.around(deformation.space, eta, own, thickness)
    said = domain.said(deformation.step(eta))
    if said and not allowed:
        coarse = deformation.space.outside(deformation.t.values)
        raise PerturbationError(f"{coarse or f't: {said}'}; {BEYOND}")
    return (Finding("beyond the space's data", said),) if said else ()


def _spans(shape: Shape) -> Array:
    """Return the spans (k,) at which a shape is tested, the same array for the same stations."""
    return _united(shape.loft.eta.tobytes())


@lru_cache(maxsize=8)
def _united(stations_in_bytes: bytes) -> Array:
    even = np.linspace(0.0, 1.0, SOUND_SPANS)
    return readonly(np.union1d(even, np.frombuffer(stations_in_bytes)))


@dataclass(frozen=True, eq=False)
class Trial:
    """A shape that is tested.

    Parameters
    ----------
    shape : Shape
        Which one.
    definition : BladeDefinition
        Says what the blade and its airfoils are called.
    asked : dict
        What it was perturbed by, to be told.
    """

    shape: Shape
    definition: BladeDefinition
    asked: dict[str, Any]

    def findings(self, *, allow_odd: bool) -> tuple[Finding, ...]:
        """Raise if a section is unsound, or odd where that is not allowed; say which are odd.

        Tested are the stations and `SOUND_SPANS` others, and many more between these where
        sections are about to fold: a nose may curl up on a thousandth of the span.
        """
        eta = _spans(self.shape)
        shares, odd = self.tested(eta)
        folding = np.flatnonzero(shares < FOLDING)
        cells = np.union1d(folding[folding > 0] - 1, folding[folding < len(eta) - 1])
        if cells.size:
            between = np.linspace(eta[cells], eta[cells + 1], FINER, endpoint=False)[1:]
            self.tested(np.sort(between.reshape(-1)))
        if odd is None or not odd.kinds.any():
            return ()
        if not allow_odd:
            k = int(np.argmax(odd.kinds > 0))
            raise PerturbationError(f"{self._accused(eta[k])} {odd.said((k,))}; {ODD}")
        return odd.findings(eta)

    def _accused(self, eta: float) -> str:
        """Return which section is wrong, as the start of a sentence."""
        place = int(np.argmin(np.abs(self.shape.loft.eta - eta)))
        near = self.definition.stations[place]
        return (
            f"{self.definition.name}: the section at eta = {eta:.4f} (near {near.airfoil.name} at "
            f"{near.eta:.4f})"
        )

    def tested(self, eta: Array) -> tuple[Array, Oddities | None]:
        """Raise if a section at spans (k,) is unsound; return how far they are from folding, (k,).

        That is the least share of its direction that a step along the contour or across the
        section keeps of what it was: 1 unchanged, 0 turned by a right angle or shrunk to nothing.
        Returned besides is what is odd about them, where their shape is another.
        """
        shape = self.shape
        joined = shape.loft.sections(eta)
        before, curves = joined.before, shape.deformed(eta)
        same = curves is before.curves
        crossing = before.crossing if same else crossing_sections(curves.points)
        own, given = curves.relative_thickness, before.curves.relative_thickness
        thin = np.flatnonzero(~(own > LOST_THICKNESS * given))
        for places, fault in ((crossing, "crosses itself"), (thin, "loses its thickness")):
            if len(places):
                said = ", ".join(f"{k} = {v}" for k, v in self.asked.items() if k != "window")
                raise PerturbationError(
                    f"{self._accused(float(eta[places[0]]))} {fault}{said and ' with ' + said}"
                )
        shares = before.kept(curves)
        if not shape.deformations:
            return shares, None
        ruling = joined.thickness  # all are held against each other at that
        wanted = ruling
        for thickening in shape.thickenings:
            wanted = wanted * thickening(eta)
        A, c, lines = ChordLines.sized(curves, wanted)
        looks = characteristics_along(
            np.concatenate([lines.nose, lines.edge], axis=1),
            affine.restore(curves.points, A, c),
            ruling / wanted,
        )
        return shares, oddities(looks, before.looks, ruling)
