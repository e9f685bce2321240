"""A blade is a pure function of span: its shape in chords, and its sections in space.

`Blade.from_definition` runs the paper's pipeline.  A `Blade` is a frozen value that holds values;
everything about it follows from them.  Metres and radians, blade frame.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, Unpack

from bladegen.airfoils.chord_lines import KEPT
from bladegen.airfoils.fairing import TOLERANCE
from bladegen.airfoils.landmarks import Spacing, clustered
from bladegen.blade import outputs, parts
from bladegen.blade.changes.deformation import AffineChange, Coordinates, Window
from bladegen.blade.edges import MINIMUM_EDGE, TrailingEdge
from bladegen.blade.lofting.loft import lofted
from bladegen.blade.lofting.paths import DEFAULT, PATHS
from bladegen.blade.perturbation import Perturbation, Where, change_of, deviated, together, told
from bladegen.blade.planform import Planform, SectionPlanes, flange_to_axis
from bladegen.blade.shape import Shape
from bladegen.blade.soundness import leaving
from bladegen.blade.spans import MIRROR, around, reflected, span_fractions
from bladegen.definition import fair_planform as fair
from bladegen.definition.blade_definition import BladeDefinition, Distribution
from bladegen.errors import DefinitionError, Finding, visible
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arguments import function
from bladegen.support.arrays import Array, ArrayLike
from bladegen.support.values import state_of

__all__ = ["PATHS", "Blade"]


@dataclass(frozen=True, eq=False, init=False, repr=False)
class Blade:
    """A blade as a function of span, made of values that its variants share.

    Parameters
    ----------
    shape : Shape
        What its sections are: the stations' airfoils joined over span (`Shape.loft`), deformed.
    planform : Planform
        Where they stand: the definition's chord, twist and axis, and the section planes.
    trailing_edge : callable
        How their edge is finished: `edges.MinimumThickness`, `AsGiven` or `Sharp`.
    findings : tuple of Finding
        What was mended or looks odd.
    changes : tuple of dict
        What was asked of `perturbed`, once a call.
    mirrored : bool
        Whether this is the mirror image in y, for rotors that turn the other way.
    **changed
        Parts of shape and planform to change, by the names in `parts`: so
        ``dataclasses.replace(blade, edge_width=None)`` makes another blade.
    """

    shape: Shape
    planform: Planform
    trailing_edge: TrailingEdge
    findings: tuple[Finding, ...]
    changes: tuple[dict[str, Any], ...]
    mirrored: bool

    definition, planes = parts.definition, parts.planes
    fair_planform = parts.fair_planform
    u, eta, representatives = parts.u, parts.eta, parts.representatives
    M, b, contours, fairing = parts.M, parts.b, parts.contours, parts.fairing
    path, edge_width, parameter = parts.path, parts.edge_width, parts.parameter
    shape_path, splines, points = parts.shape_path, parts.splines, parts.points
    shapes, wanted_thickness = parts.shapes, parts.wanted_thickness
    deformations, thickenings = parts.deformations, parts.thickenings

    def __init__(
        self,
        shape: Shape,
        planform: Planform,
        trailing_edge: TrailingEdge = MINIMUM_EDGE,
        findings: tuple[Finding, ...] = (),
        changes: tuple[dict[str, Any], ...] = (),
        mirrored: bool = False,
        **changed: Any,
    ) -> None:
        shape, planform = parts.composed(shape, planform, changed)
        given = (shape, planform, trailing_edge, findings, changes, mirrored)
        for entry, value in zip(fields(self), given, strict=True):
            object.__setattr__(self, entry.name, value)

    __getstate__ = state_of

    def __repr__(self) -> str:
        return (
            f"<Blade {visible(self.name)}: {self.length:.1f} m, {len(self.eta)} stations, "
            f"{len(self.u)} landmarks{''.join(map(told, self.changes))}>"
        )

    plot, mesh, export, point = outputs.plot, outputs.mesh, outputs.export, outputs.point
    require_sound, stations = outputs.require_sound, outputs.stations
    volume, _repr_html_ = cached_property(outputs.volume), outputs.html
    layup = cached_property(outputs.layup)
    _crowding, breaks = cached_property(outputs.crowding), cached_property(outputs.breaks)

    @classmethod
    def from_definition(
        cls,
        definition: BladeDefinition,
        *,
        landmarks: int = 401,
        path: str = DEFAULT,
        planes: SectionPlanes = flange_to_axis,
        trailing_edge: TrailingEdge = MINIMUM_EDGE,
        spacing: Spacing = clustered,
        fairing: float | None = TOLERANCE,
        fair_planform: fair.PlanformFairing | None = None,
    ) -> Blade:
        """Build a blade from its definition.

        Parameters
        ----------
        definition : BladeDefinition
            What the designer gives.
        landmarks : int
            Landmarks a section, odd.
        path : str
            "spline" (geodesics with blended corners) or "geodesic" (the paper's).
        planes, trailing_edge, spacing : callable
            Section planes, by default normal to the pitch axis at the root's flange and to the
            reference axis past the round root; finish of the trailing edges, by default at least
            2 mm thick, or 1 % of the local chord where that is less; spacing of the landmarks
            along each side.
        fairing : float, optional
            Largest distance of an airfoil's given points to its curve [chord], within which
            noise of their digits is taken out; None keeps the points.
        fair_planform : PlanformFairing, optional
            How far chord, twist, offsets and axis may move to be C2; None keeps them.

        A `DefinitionError` says which argument is of another kind, a `GeometryError` which
        airfoil is unusable.
        """
        must = "such as bladegen.blade.edges.MinimumThickness(0.002)"
        function(trailing_edge, "trailing_edge", must, DefinitionError)
        if fair_planform is not None:
            definition = fair.fair_planform(definition, fair_planform)
        definition, loft, findings = lofted(definition, landmarks, path, spacing, fairing)
        planform = Planform(definition, planes, fair_planform)
        return cls(Shape(loft), planform, trailing_edge, findings)

    @property
    def name(self) -> str:
        """The definition's name, and that it is the mirror image if it is."""
        return f"{self.definition.name}-mirrored" if self.mirrored else self.definition.name

    @property
    def sides(self) -> tuple[str, str]:
        """What the halves of `sections` are called, from the trailing to the leading edge first."""
        names = "suction side", "pressure side"
        return names[::-1] if self.mirrored else names

    @property
    def length(self) -> float:
        """Blade length along z [m]."""
        return self.definition.length

    def chord(self, eta: ArrayLike) -> Array:
        """Return the chord [m] at `eta`: the definition's spline."""
        return self.definition.chord(span_fractions(eta))

    def twist(self, eta: ArrayLike) -> Array:
        """Return the twist [rad] at `eta`: the definition's spline."""
        return self.definition.twist(span_fractions(eta))

    def axis(self, eta: ArrayLike) -> Array:
        """Return the reference axis (..., 3) [m] at `eta`."""
        axis = self.definition.axis(span_fractions(eta))
        return axis * MIRROR if self.mirrored else axis

    def profiles(self, eta: ArrayLike, u: Array | None = None) -> Array:
        """Return unit-chord sections (..., n, 2) [chord] at span fractions `eta` (...).

        Airfoil axes; the distribution's relative thickness, where there is one, exactly; trailing
        edges as given.  `u` (m,) are other landmark parameters than the blade's own, symmetric
        about 0.5: points that lie between its landmarks on the very same sections.
        """
        return self.shape.profiles(eta, u)

    def relative_thickness(self, eta: ArrayLike) -> Array:
        """Return the relative thickness of the sections at `eta`."""
        return self.shape.relative_thickness(eta)

    def sections(self, eta: ArrayLike, u: Array | None = None) -> Array:
        """Return sections (..., n, 3) [m] at span fractions `eta` (...), blade frame.

        Trailing edges are finished; landmarks run from there along the first of `sides` to the
        leading edge and back along the second, round the same way in a mirror image.
        `u` (m,) are other landmark parameters, any: points between landmarks on the same sections.
        """
        spans, (places, kept) = span_fractions(eta), around(u)
        flat = spans.reshape(-1)
        placed = self.placed(self.profiles(flat, places), flat)[:, kept]
        return placed.reshape(*spans.shape, *placed.shape[1:])

    def placed(self, profiles: Array, eta: Array) -> Array:
        """Finish sections (k, m, 2) and put them in space, (k, m, 3)."""
        chord = self.chord(eta)
        placed = self.planform.place(self.trailing_edge(profiles, chord), eta)
        return reflected(placed) if self.mirrored else placed

    def with_trailing_edge(self, trailing_edge: TrailingEdge) -> Blade:
        """Return the blade with another finish of its trailing edges."""
        return replace(self, trailing_edge=trailing_edge)

    def mirror_image(self) -> Blade:
        """Return the blade with `sections` and `axis` mirrored in y: its trailing edge at -y."""
        return replace(self, mirrored=not self.mirrored)

    def perturbed(
        self,
        space: ShapeSpace | None = None,
        t: ArrayLike | Coordinates = (),
        *,
        thickness: float | Distribution = 1.0,
        camber: float | Distribution = 1.0,
        chord: float | Distribution = 1.0,
        twist: float | Distribution = 0.0,
        chord_scale: float = 1.0,
        twist_scale: float = 1.0,
        prebend_scale: float = 1.0,
        prebend: Distribution | None = None,
        window: Window | None = None,
        chord_line: str = KEPT,
        allow_extrapolation: bool = False,
        allow_odd: bool = False,
        deviation: Any = None,
        name: str | None = None,
    ) -> Blade:
        """Return a perturbed blade; this one stays as it is.

        Parameters
        ----------
        space, t : ShapeSpace and (r,) array or Coordinates, optional
            Modes of deformation, and coordinates along them [rad]: the same at all spans, or with
            knots over span.
        thickness, camber, chord, twist, chord_scale, twist_scale, prebend_scale : float
            See `affine_change.AffineChange`; twist in radians.  The first four may be a
            `Distribution` over span.
        prebend : Distribution, optional
            What is added to the prebend [m].
        window : Window, optional
            Where shape, thickness, camber, chord and twist change; by default not on round
            roots, and fully from the first lifting airfoil on.
        chord_line : str
            "kept": sections are turned and shifted in their plane until chord line and nose are
            those they had before `t`; "paper": they stay where the paper's formula leaves them.
        allow_extrapolation, allow_odd : bool
            Let sections leave the space's data, or be such as no aerodynamicist would take
            (`sanity`); findings say which do.
        deviation : bladegen.DeviationMap, optional
            Wear, dents or a measured deviation that is put on the perturbed skin.
        name : str, optional
            The perturbed blade's name; this one's by default.

        Raises
        ------
        PerturbationError
            If space and t are not given together, a value is of another kind or out of range, or
            a section leaves the data, crosses itself, loses its thickness or is odd.
        """
        space, t = together(space, t)
        scales = chord_scale, twist_scale, prebend_scale
        change = change_of(thickness, camber, chord, twist, *scales, prebend=prebend)
        how = Where(window=window, chord_line=chord_line, allow_extrapolation=True)
        variant = self.untested(space, t, change, name=name, **how)
        said = variant.findings
        for deformation in variant.deformations[len(self.deformations) :]:
            said += leaving(self.shape, deformation, allowed=allow_extrapolation)
        made = replace(variant, findings=said).require_sound(allow_odd=allow_odd)
        return deviated(made, deviation)

    def untested(
        self,
        space: ShapeSpace | None,
        t: ArrayLike | Coordinates,
        affine_change: AffineChange,
        *,
        name: str | None = None,
        **how: Unpack[Where],
    ) -> Blade:
        """Return a perturbed blade as `perturbed` does, whose sections nobody has tested.

        For those who test them otherwise: `families` many at once, the studio after a move.
        """
        asked = Perturbation.of(self.shape, self.definition, space, t, affine_change, **how)
        return replace(
            self,
            shape=asked.shaped(self.shape),
            planform=replace(self.planform, definition=asked.defined(self.definition, name)),
            changes=(*self.changes, asked.asked),
        )
