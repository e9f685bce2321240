"""Perturbing a blade: what `Blade.perturbed` asks for, does and refuses.

Shape moves along the modes of a space, the same at every span; thickness, chord, twist and
prebend move by the paper's affine parameters.  A perturbed blade is a blade like any other.
"""

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from bladegen.airfoils.chord_lines import KEPT
from bladegen.airfoils.crossing import crossing_sections
from bladegen.airfoils.curves import SectionSplines
from bladegen.blade.deformation import (
    AffineChange,
    Coordinates,
    Deformation,
    Thickening,
    Window,
    deformation_of,
)
from bladegen.blade.sanity import ODD, Oddities, characteristics, oddities
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import Finding, PerturbationError
from bladegen.shapes import affine
from bladegen.shapes.domain import BEYOND, Domain
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arguments import amount, instance, numbers, shown
from bladegen.support.arrays import Array, ArrayLike

__all__ = ["Perturbable"]

SOUND_SPANS = 60  # spans at which a perturbed blade is tested
FOLDING = 0.1  # of a step's direction; sections that keep less of one are about to fold
FINER = 32  # times, between spans of which one is about to fold
LOST_THICKNESS = 0.2  # of the thickness before, which a deformation must leave
CALL = "call perturbed(space, [t1, t2, ...]), with space = bladegen.ShapeSpace.bundled()"


class Perturbable:
    """The perturbing half of `Blade`, which is its only kind and holds these fields."""

    if TYPE_CHECKING:
        definition: BladeDefinition
        u: Array
        eta: Array
        deformations: tuple[Deformation, ...]
        thickenings: tuple[Thickening, ...]
        changes: tuple[dict[str, Any], ...]
        findings: tuple[Finding, ...]

        @property
        def splines(self) -> SectionSplines: ...

        def _with(self, **changes: Any) -> Self: ...

        def shapes(self, eta: Array) -> tuple[Array, Array, Array, Array]: ...

        def _ruling(self, eta: Array) -> Array | None: ...

        def _target(self, eta: Array, points: Array) -> Array | None: ...

    def perturbed(
        self,
        space: ShapeSpace | None = None,
        t: ArrayLike | Coordinates = (),
        *,
        thickness: float = 1.0,
        camber: float = 1.0,
        chord: float = 1.0,
        twist: float = 0.0,
        chord_scale: float = 1.0,
        twist_scale: float = 1.0,
        prebend_scale: float = 1.0,
        window: Window | None = None,
        chord_line: str = KEPT,
        allow_extrapolation: bool = False,
        allow_odd: bool = False,
        name: str | None = None,
    ) -> Self:
        """Return a perturbed blade; this one stays as it is.

        Parameters
        ----------
        space : ShapeSpace, optional
            Modes of deformation; needed with `t`.
        t : (r,) array or Coordinates
            Coordinates along the modes [rad], the same at all spans or with knots over span.
        thickness, camber, chord, twist, chord_scale, twist_scale, prebend_scale : float
            See `deformation.AffineChange`; twist in radians.
        window : Window, optional
            Where shape, thickness, camber, chord and twist change; by default not on round
            roots, and fully from the first lifting airfoil on.
        chord_line : str
            "kept": after `t` moved the shape, each section is turned and shifted in its plane
            until chord line and nose are those it had, so that twist stays twist; "paper": it
            stays where the paper's formula leaves it, turned by up to some degrees.
        allow_extrapolation : bool
            Let sections leave the range of the space's data; a finding says where they do.
        allow_odd : bool
            Take sections that no aerodynamicist would (`sanity`); findings say which.
        name : str, optional
            The perturbed blade's name; this one's by default.

        Raises
        ------
        PerturbationError
            If space and t are not given together, a value is of another kind or out of range, or
            a section leaves the data, crosses itself, loses its thickness or is odd.
        """
        amounts = {
            "thickness": thickness,
            "camber": camber,
            "chord": chord,
            "twist": twist,
            "chord_scale": chord_scale,
            "twist_scale": twist_scale,
            "prebend_scale": prebend_scale,
        }
        variant = self.untested(
            *_together(space, t),
            AffineChange(
                **{key: amount(value, key, PerturbationError) for key, value in amounts.items()}
            ),
            window=window,
            chord_line=chord_line,
            allow_extrapolation=True,
            name=name,
        )
        if len(variant.deformations) > len(self.deformations):
            said = self._leaving(variant.deformations[-1])
            if said and not allow_extrapolation:
                coarse = variant.deformations[-1].space.outside(variant.deformations[-1].t.values)
                raise PerturbationError(f"{coarse or f't: {said}'}; {BEYOND}")
            if said:
                finding = Finding("beyond the space's data", said)
                variant = variant._with(findings=(*variant.findings, finding))
        return variant.require_sound(allow_odd=allow_odd)

    def _leaving(self, deformation: Deformation) -> str:
        """Say which of this blade's sections leaves the space's data first; "" if none does."""
        eta = np.union1d(np.linspace(0.0, 1.0, SOUND_SPANS), self.eta)
        plain, X, M, b = self.shapes(eta)
        thickness = self._target(eta, affine.restore(plain, M, b))
        if thickness is None:
            thickness = self.splines.fit(affine.restore(plain, M, b)).relative_thickness
        return Domain.of(deformation.space, eta, X, thickness).said(deformation.step(eta))

    def untested(
        self,
        space: ShapeSpace | None,
        t: ArrayLike | Coordinates,
        affine_change: AffineChange,
        *,
        window: Window | None = None,
        chord_line: str = KEPT,
        allow_extrapolation: bool = False,
        name: str | None = None,
    ) -> Self:
        """Return a perturbed blade as `perturbed` does, whose sections nobody has tested.

        For those who test them otherwise: `families` many at once, the studio after a move.
        """
        if window is None:
            window = Window.beyond_circles(self.definition.stations)
        instance(window, Window, "window", "a bladegen.Window(start, end)", PerturbationError)
        if name is not None:
            instance(name, str, "name", "a text", PerturbationError)
        coordinates = t if isinstance(t, Coordinates) else Coordinates.constant(t)
        asked: dict[str, Any] = affine_change.changed()
        deformations = self.deformations
        if coordinates.values.size:
            deformations += (
                deformation_of(
                    space,
                    coordinates,
                    window,
                    self.u,
                    allow_extrapolation=allow_extrapolation,
                    chord_line=chord_line,
                ),
            )
            asked |= {"pga": coordinates.values.tolist(), "pga_at_eta": coordinates.grid.tolist()}
            asked |= {} if chord_line == KEPT else {"chord_line": chord_line}
        thickening = Thickening(float(affine_change.thickening), window)
        definition = affine_change.applied(self.definition, window)
        return self._with(
            definition=replace(definition, name=name or self.definition.name),
            deformations=deformations,
            thickenings=self.thickenings + ((thickening,) if thickening.factor != 1.0 else ()),
            changes=(*self.changes, asked | {"window": [window.start, window.end]}),
        )

    def require_sound(self, *, allow_odd: bool = False) -> Self:
        """Return the blade, or raise if a section crosses itself, has lost its thickness or is odd.

        Tested are the stations and `SOUND_SPANS` others, and many more between these where
        sections are about to fold: a nose may curl up on a thousandth of the span.

        Raises
        ------
        PerturbationError
            If a section does; where odd ones are allowed, findings say which they are.
        """
        eta = np.union1d(np.linspace(0.0, 1.0, SOUND_SPANS), self.eta)
        shares, odd = self._tested(eta)
        folding = np.flatnonzero(shares < FOLDING)
        cells = np.union1d(folding[folding > 0] - 1, folding[folding < len(eta) - 1])
        if cells.size:
            between = np.linspace(eta[cells], eta[cells + 1], FINER, endpoint=False)[1:]
            self._tested(np.sort(between.reshape(-1)))
        if odd is None or not odd.kinds.any():
            return self
        if not allow_odd:
            k = int(np.argmax(odd.kinds > 0))
            raise PerturbationError(f"{self._accused(eta[k])} {odd.said((k,))}; {ODD}")
        return self._with(findings=self.findings + odd.findings(eta))

    def _accused(self, eta: float) -> str:
        """Return which section is wrong, as the start of a sentence."""
        near = self.definition.stations[int(np.argmin(np.abs(self.eta - eta)))]
        return (
            f"{self.definition.name}: the section at eta = {eta:.4f} (near {near.airfoil.name} at "
            f"{near.eta:.4f})"
        )

    def _tested(self, eta: Array) -> tuple[Array, Oddities | None]:
        """Raise if a section at spans (k,) is unsound; return how far they are from folding, (k,).

        That is the least share of its direction that a step along the contour or across the
        section keeps of what it was: 1 unchanged, 0 turned by a right angle or shrunk to nothing.
        Returned besides is what is odd about them, where their shape is another.
        """
        plain, X, M, b = self.shapes(eta)
        points, given = affine.restore(X, M, b), affine.restore(plain, M, b)
        crossing = crossing_sections(points)
        curves, curves_before = self.splines.fit(points), self.splines.fit(given)
        own, before = curves.relative_thickness, curves_before.relative_thickness
        thin = np.flatnonzero(~(own > LOST_THICKNESS * before))
        for places, fault in ((crossing, "crosses itself"), (thin, "loses its thickness")):
            if len(places):
                asked = self.changes[-1] if self.changes else {}
                said = ", ".join(f"{k} = {v}" for k, v in asked.items() if k != "window")
                raise PerturbationError(
                    f"{self._accused(float(eta[places[0]]))} {fault}{said and ' with ' + said}"
                )
        shares = np.minimum(
            _kept(np.diff(points, axis=1), np.diff(given, axis=1)),
            _kept(_across(points), _across(given)),
        )
        if not self.deformations:
            return shares, None
        ruling = self._ruling(eta)
        ruling = before if ruling is None else ruling  # all are held against each other at that
        wanted = ruling.copy()
        for thickening in self.thickenings:
            wanted *= thickening(eta)
        sized = curves.mapped(*curves.normalising(wanted))
        looks = characteristics(sized, ruling / wanted)
        looks_before = characteristics(curves_before, ruling / before)
        return shares, oddities(looks, looks_before, ruling)


def _together(space: Any, t: Any) -> tuple[ShapeSpace | None, Coordinates]:
    """Return a space and coordinates that were given together, or neither."""
    if space is not None and not isinstance(space, ShapeSpace):
        raise PerturbationError(f"space: got {shown(space)}, must be a ShapeSpace; {CALL}")
    if not isinstance(t, Coordinates):
        values = numbers(() if t is None else t, "t", PerturbationError)
        t = Coordinates.constant(values)
    if space is not None and not t.values.size:
        raise PerturbationError(f"t: got no coordinates for the shape space; {CALL}")
    if space is None and t.values.size:
        raise PerturbationError(f"t: coordinates need a shape space; {CALL}")
    return space, t


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
