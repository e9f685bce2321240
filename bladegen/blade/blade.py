"""A blade is a pure function of span: its shape in chords, and its sections in space.

`Blade.from_definition` runs the paper's pipeline: landmarks, standardisation, clustering, a
path on Gr(n, 2) with splines for the affine part, and the planform.  A `Blade` is a frozen
value; everything about it follows from its fields.  Metres and radians, blade frame.
"""

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from bladegen.airfoils.fairing import TOLERANCE
from bladegen.airfoils.landmarks import Contour, Spacing, clustered, contour, landmark_parameters
from bladegen.blade.crowding import Crowding
from bladegen.blade.deformation import Deformation, Thickening, in_units
from bladegen.blade.edge_widths import Joining
from bladegen.blade.edges import MinimumThickness, TrailingEdge
from bladegen.blade.paths import PathMaker, geodesic_path, spline_path
from bladegen.blade.planform import Planform, SectionPlanes, normal_to_axis
from bladegen.blade.shape import Shaped
from bladegen.definition.blade_definition import BladeDefinition, pchip
from bladegen.definition.remarks import disagreeing, opened
from bladegen.definition.thickness import own_thickness
from bladegen.errors import DefinitionError, Finding
from bladegen.shapes import affine
from bladegen.support.arguments import amount, function, instance, numbers, one_of, whole
from bladegen.support.arrays import Array, ArrayLike, readonly
from bladegen.support.services import service

__all__ = ["PATHS", "Blade"]

PATHS: dict[str, PathMaker] = {"geodesic": geodesic_path, "spline": spline_path}
RESOLVING_SPANS = 1001  # spans at which bends are looked for
RESOLVING_LANDMARKS = 40  # landmarks that are watched for bends, about
MIRROR = readonly([1.0, -1.0, 1.0])
MINIMUM_EDGE = MinimumThickness(0.002, most=0.01)


@dataclass(frozen=True, eq=False)
class Blade(Shaped):
    """A blade as a function of span.

    Parameters
    ----------
    definition : BladeDefinition
        Planform, axis and thickness distribution; `thickness.own_thickness` where a file has none.
    u : (n,) array
        Landmark parameters, 0 at the suction side's trailing edge, 0.5 at the leading edge.
    eta : (s,) array
        Span fractions of the stations.
    representatives : (s, n, 2) array
        The stations' airfoils as points of Gr(n, 2): orthonormal, centred bases.
    M, b : (s, 2, 2), (s, 2) arrays
        Their affine maps, ``airfoil = representatives @ M + b``.
    path : callable
        How stations are joined: `paths.geodesic_path` or `spline_path`.
    planes : callable
        Section planes: `planform.normal_to_axis` or `normal_to_z`.
    trailing_edge : callable
        How trailing edges are finished: `edges.MinimumThickness`, `AsGiven` or `Sharp`.
    edge_width : callable, optional
        Joins the stations' edge widths over the path's parameter: `definition.pchip`, or None
        for the widths that the path happens to have.
    contours : tuple of Contour, optional
        The stations' airfoils between their landmarks; without them, splines through the
        landmarks.
    findings : tuple of Finding
        What was mended or looks odd.
    deformations : tuple of Deformation
        Applied to the shapes, one after the other (`perturbed`).
    thickenings : tuple of callable
        Factors of the relative thickness over span (`perturbed`).
    changes : tuple of dict
        What was asked of `perturbed`, once a call.
    mirrored : bool
        Whether this is the mirror image in y, for rotors that turn the other way.
    fairing : float, optional
        How far airfoils may have been moved to take noise out [chord], to be told.
    """

    definition: BladeDefinition
    u: Array
    eta: Array
    representatives: Array
    M: Array
    b: Array
    path: PathMaker = geodesic_path
    planes: SectionPlanes = normal_to_axis
    trailing_edge: TrailingEdge = MINIMUM_EDGE
    edge_width: Joining | None = pchip
    contours: tuple[Contour, ...] | None = None
    findings: tuple[Finding, ...] = ()
    deformations: tuple[Deformation, ...] = ()
    thickenings: tuple[Thickening, ...] = ()
    changes: tuple[dict[str, Any], ...] = ()
    mirrored: bool = False
    fairing: float | None = None

    def __post_init__(self) -> None:
        for field in ("u", "eta", "representatives", "M", "b"):
            object.__setattr__(self, field, readonly(getattr(self, field)))

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}  # no caches

    def __repr__(self) -> str:
        return (
            f"<Blade {self.name}: {self.length:.1f} m, {len(self.eta)} stations, "
            f"{len(self.u)} landmarks{''.join(map(_told, self.changes))}>"
        )

    def _repr_html_(self) -> str:
        """Return table and picture for notebooks."""
        shown: str = service("blade_html")(self)
        return shown

    @classmethod
    def from_definition(
        cls,
        definition: BladeDefinition,
        *,
        landmarks: int = 401,
        path: str = "geodesic",
        planes: SectionPlanes = normal_to_axis,
        trailing_edge: TrailingEdge = MINIMUM_EDGE,
        spacing: Spacing = clustered,
        fairing: float | None = TOLERANCE,
    ) -> "Blade":
        """Build a blade from its definition.

        Parameters
        ----------
        definition : BladeDefinition
            What the designer gives.
        landmarks : int
            Landmarks a section, odd.
        path : str
            "geodesic" (the paper's) or "spline" (smooth).
        planes : callable
            Section planes, normal to the reference axis by default.
        trailing_edge : callable
            Finish of the trailing edges in `sections`; by default at least 2 mm thick, or 1 % of
            the local chord where that is less.
        spacing : callable
            Spacing of the landmarks along each side.
        fairing : float, optional
            Largest distance of an airfoil's given points to its curve, in chords, within which
            noise of their digits is taken out; None keeps the points.

        Raises
        ------
        DefinitionError
            If `definition` is none, `path` is no path, or a choice is of another kind.
        GeometryError
            If an airfoil or `fairing` is unusable.
        """
        must = "a BladeDefinition, such as bladegen.read('iea15mw') or bladegen.read(path) gives"
        instance(definition, BladeDefinition, "definition", must, DefinitionError)
        one_of(path, PATHS, "path", DefinitionError)
        for field, value, wanted in (
            ("planes", planes, "a function such as bladegen.blade.planform.normal_to_z"),
            (
                "trailing_edge",
                trailing_edge,
                "such as bladegen.blade.edges.MinimumThickness(0.002)",
            ),
            ("spacing", spacing, "a function such as bladegen.airfoils.landmarks.cosine"),
        ):
            function(value, field, wanted, DefinitionError)
        if fairing is not None:
            amount(fairing, "fairing", DefinitionError)
        u = landmark_parameters(whole(landmarks, "landmarks", DefinitionError), spacing)
        curves = {
            id(station.airfoil): contour(station.airfoil.coordinates, fairing=fairing)
            for station in definition.stations
        }
        shapes = {key: curve.landmarks(u) for key, curve in curves.items()}
        keys = [id(station.airfoil) for station in definition.stations]
        airfoils = np.stack([shapes[key] for key in keys])
        X, M, b = affine.standardise(airfoils)
        contours = tuple(curves[key] for key in keys)
        eta = np.array([station.eta for station in definition.stations])
        findings = (
            definition.findings
            + opened(definition, contours)
            + disagreeing(definition, u, airfoils)
        )
        if definition.relative_thickness is None:
            thickness = own_thickness(eta, u, airfoils)
            definition = replace(definition, relative_thickness=thickness)
        return cls(
            definition=definition,
            u=u,
            eta=eta,
            representatives=X,
            M=M,
            b=b,
            path=PATHS[path],
            planes=planes,
            trailing_edge=trailing_edge,
            contours=contours,
            fairing=fairing,
            findings=findings,
        )

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
        return self.definition.chord(_spans(eta))

    def twist(self, eta: ArrayLike) -> Array:
        """Return the twist [rad] at `eta`: the definition's spline."""
        return self.definition.twist(_spans(eta))

    def axis(self, eta: ArrayLike) -> Array:
        """Return the reference axis (..., 3) [m] at `eta`."""
        axis = self.definition.axis(_spans(eta))
        return axis * MIRROR if self.mirrored else axis

    @cached_property
    def planform(self) -> Planform:
        """Where sections stand."""
        return Planform(self.definition, self.planes)

    def profiles(self, eta: ArrayLike, u: Array | None = None) -> Array:
        """Return unit-chord sections, as the definition gives them.

        Parameters
        ----------
        eta : (...) array
            Span fractions.
        u : (m,) array, optional
            Other landmark parameters than the blade's own, symmetric about 0.5: points that
            lie between its landmarks on the very same sections.

        Returns
        -------
        (..., n, 2) array
            Landmarks in chords, airfoil axes: unit chord, and the distribution's relative
            thickness where there is one, exactly.  Trailing edges are as given.
        """
        spans = _spans(eta)
        u = u if u is None else _parameters(u)
        flat = spans.reshape(-1)
        path = self._path(flat)
        opening = self._opening(flat, *path)
        points = opening(affine.restore(*path))
        wanted = self._target(flat, points)
        finer = points
        if u is not None:
            finer = opening(affine.restore(self._between(u) @ path[0], *path[1:]))
        if self.deformations:
            stages = self._stages(flat, points)
            change = stages[-1] - points
            finer = finer + (change if u is None else self.splines.values(u) @ change)
            A, c, *_ = self._restored(stages, wanted)
        else:
            A, c = self.splines.normalising(points, wanted)
        result = affine.restore(finer, A, c)
        return result.reshape(*spans.shape, *result.shape[1:])

    def relative_thickness(self, eta: ArrayLike) -> Array:
        """Return the relative thickness of the sections at `eta`."""
        spans = _spans(eta)
        profiles = self.profiles(spans.reshape(-1))
        return self.splines.fit(profiles).relative_thickness.reshape(spans.shape)

    def sections(self, eta: ArrayLike, u: Array | None = None) -> Array:
        """Return sections in space, with finished trailing edges.

        Parameters
        ----------
        eta : (...) array
            Span fractions.
        u : (m,) array, optional
            Other landmark parameters, as for `profiles`; 0 and 1 among them, where trailing
            edges are finished.

        Returns
        -------
        (..., n, 3) array
            Landmarks [m], blade frame, trailing edge -> suction -> leading edge -> pressure; of
            a mirror image pressure before suction, so that they go round the same way.
        """
        spans = _spans(eta)
        flat = spans.reshape(-1)
        finished = self.trailing_edge(self.profiles(flat, u), self.chord(flat))
        placed = self.planform.place(finished, flat)
        if self.mirrored:
            placed = placed[:, ::-1] * MIRROR
        return placed.reshape(*spans.shape, *placed.shape[1:])

    def _with(self, **changes: Any) -> "Blade":
        return replace(self, **changes)

    def with_trailing_edge(self, trailing_edge: TrailingEdge) -> "Blade":
        """Return the blade with another finish of its trailing edges."""
        return replace(self, trailing_edge=trailing_edge)

    def mirror_image(self) -> "Blade":
        """Return the blade mirrored in y: its trailing edge lies at -y then, its tip at z still.

        Shape, planform and what is measured of them stay; `sections` and `axis` are mirrored.
        """
        return replace(self, mirrored=not self.mirrored)

    def stations(self, count: int = 120) -> Array:
        """Return span fractions that resolve shape, planform and axis.

        Parameters
        ----------
        count : int
            How many; at least as many as the fixed ones.

        Returns
        -------
        (count,) array
            Increasing; the root, the tip and the definition's stations are among them, the
            others crowd where the surface bends along the span.

        Raises
        ------
        DefinitionError
            If `count` is too small to hold the fixed ones.
        """
        fixed = np.unique(np.concatenate([[0.0], self.eta, [1.0]]))
        count = whole(count, "stations", DefinitionError)
        if count < len(fixed):
            raise DefinitionError(
                f"stations: got {count}, at least {len(fixed)} are needed: root, tip and the "
                "definition's own"
            )
        return self._crowding.spans(fixed, count)

    @cached_property
    def _crowding(self) -> Crowding:
        grid = np.linspace(0.0, 1.0, RESOLVING_SPANS)
        some = slice(None, None, max(1, len(self.u) // RESOLVING_LANDMARKS))
        return Crowding.of(grid, self.sections(grid)[:, some])


def _spans(eta: ArrayLike) -> Array:
    """Return span fractions as an array, or say which is not allowed."""
    spans = numbers(eta, "eta", DefinitionError, "span fractions from 0 (root) to 1 (tip)")
    if not bool(np.all((spans >= 0) & (spans <= 1))):
        bad = spans[~((spans >= 0) & (spans <= 1))][0]
        raise DefinitionError(f"eta: got {bad:g}, allowed is 0 (root) to 1 (tip)")
    return spans


def _parameters(u: Array) -> Array:
    """Return landmark parameters as an array, or say that they are none."""
    values = numbers(u, "u", DefinitionError, "landmark parameters from 0 to 1")
    if values.ndim != 1 or not bool(np.all((values >= 0) & (values <= 1))):
        raise DefinitionError("u: must be a list of landmark parameters from 0 to 1")
    return values


def _told(change: dict[str, Any]) -> str:
    """Return in a few words what one call of `perturbed` asked for."""
    asked = [in_units(key, value) for key, value in change.items() if isinstance(value, float)]
    names = [key for key, value in change.items() if isinstance(value, float)]
    words = [f"{name} {value}" for name, value in zip(names, asked, strict=True)]
    rows = change.get("pga", [])
    if rows:
        first = ", ".join(f"{value:.4g}" for value in rows[0])
        words.insert(0, f"t {first}" if len(rows) == 1 else f"t at {len(rows)} spans")
    return f"; perturbed: {', '.join(words) or 'by nothing'}"
