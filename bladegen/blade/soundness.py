"""Whether perturbed sections are sections still: tests of a `Shape` before anybody is handed it.

A section may leave a space's data, cross itself, lose its thickness, or be none that an
aerodynamicist would take (`sanity`).  Shapes to findings, or to an error with place and figure.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.blade.deformation import Deformation
from bladegen.blade.sanity import ODD, Oddities, characteristics, oddities
from bladegen.blade.shape import Shape
from bladegen.curves.crossing import crossing_sections
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import Finding, PerturbationError
from bladegen.shapes import affine
from bladegen.shapes.domain import BEYOND, Domain
from bladegen.support.arrays import Array

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
    plain, X, M, b = shape.shapes(eta)
    thickness = shape.wanted_thickness(eta)
    if thickness is None:
        thickness = shape.loft.splines.fit(affine.restore(plain, M, b)).relative_thickness
    said = Domain.of(deformation.space, eta, X, thickness).said(deformation.step(eta))
    if said and not allowed:
        coarse = deformation.space.outside(deformation.t.values)
        raise PerturbationError(f"{coarse or f't: {said}'}; {BEYOND}")
    return (Finding("beyond the space's data", said),) if said else ()


def _spans(shape: Shape) -> Array:
    return np.union1d(np.linspace(0.0, 1.0, SOUND_SPANS), shape.loft.eta)


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
        shape, splines = self.shape, self.shape.loft.splines
        plain, X, M, b = shape.shapes(eta)
        points, given = affine.restore(X, M, b), affine.restore(plain, M, b)
        crossing = crossing_sections(points)
        curves, curves_before = splines.fit(points), splines.fit(given)
        own, before = curves.relative_thickness, curves_before.relative_thickness
        thin = np.flatnonzero(~(own > LOST_THICKNESS * before))
        for places, fault in ((crossing, "crosses itself"), (thin, "loses its thickness")):
            if len(places):
                said = ", ".join(f"{k} = {v}" for k, v in self.asked.items() if k != "window")
                raise PerturbationError(
                    f"{self._accused(float(eta[places[0]]))} {fault}{said and ' with ' + said}"
                )
        shares = np.minimum(
            _kept(np.diff(points, axis=1), np.diff(given, axis=1)),
            _kept(_across(points), _across(given)),
        )
        if not shape.deformations:
            return shares, None
        ruling = shape.loft.ruling(eta)
        ruling = before if ruling is None else ruling  # all are held against each other at that
        wanted = ruling.copy()
        for thickening in shape.thickenings:
            wanted *= thickening(eta)
        sized = curves.mapped(*curves.normalising(wanted))
        looks = characteristics(sized, ruling / wanted)
        looks_before = characteristics(curves_before, ruling / before)
        return shares, oddities(looks, looks_before, ruling)


def _across(points: Array) -> Array:
    """Return the steps from the pressure to the suction side of sections (k, n, 2)."""
    half = points.shape[1] // 2
    return points[:, 1:half] - points[:, -2:half:-1]


def _kept(steps: Array, before: Array) -> Array:
    """Return the least share that steps (k, m, 2) keep of steps before, (k,)."""
    along, length = np.sum(steps * before, axis=-1), np.sum(before * before, axis=-1)
    shares = np.divide(along, length, out=np.ones_like(along), where=length > 0.0)
    least: Array = shares.min(axis=1)
    return least
