"""A blade is a pure function of span: its shape in chords, and its sections in space.

`Blade.from_definition` runs the paper's pipeline: landmarks, standardisation, clustering, a
path on Gr(n, 2) with splines for the affine part, and the planform.  A `Blade` is a frozen
value; everything about it follows from its fields.  Metres and radians, blade frame.
"""

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from bladegen import affine
from bladegen.arrays import Array, ArrayLike, readonly
from bladegen.crowding import Crowding
from bladegen.definition import BladeDefinition
from bladegen.deformation import Deformation, Thickening
from bladegen.edges import MinimumThickness, TrailingEdge
from bladegen.errors import DefinitionError, Finding
from bladegen.interpolation import (
    Parameter,
    Path,
    PathMaker,
    SectionSpline,
    geodesic_path,
    spline_path,
)
from bladegen.landmarks import Contour, Spacing, clustered, contour, landmark_parameters
from bladegen.perturbation import Perturbable
from bladegen.planform import Planform, SectionPlanes, normal_to_axis
from bladegen.remarks import disagreeing, opened
from bladegen.sections import SectionSplines

__all__ = ["PATHS", "Blade"]

PATHS: dict[str, PathMaker] = {"geodesic": geodesic_path, "spline": spline_path}
RESOLVING_SPANS = 1001  # spans at which bends are looked for
RESOLVING_LANDMARKS = 40  # landmarks that are watched for bends, about
MINIMUM_EDGE = MinimumThickness()
SAME_SHAPE = 1e-10  # of the largest singular value; stations may repeat an airfoil


@dataclass(frozen=True, eq=False)
class Blade(Perturbable):
    """A blade as a function of span.

    Parameters
    ----------
    definition : BladeDefinition
        Planform, axis and thickness distribution.
    u : (n,) array
        Landmark parameters, 0 at the suction side's trailing edge, 0.5 at the leading edge.
    eta : (s,) array
        Span fractions of the stations.
    representatives : (s, n, 2) array
        The stations' airfoils as points of Gr(n, 2): orthonormal, centred bases.
    M, b : (s, 2, 2), (s, 2) arrays
        Their affine maps, ``airfoil = representatives @ M + b``.
    path : callable
        How stations are joined: `interpolation.geodesic_path` or `spline_path`.
    planes : callable
        Section planes: `planform.normal_to_axis` or `normal_to_z`.
    trailing_edge : callable
        How trailing edges are finished: `edges.MinimumThickness`, `AsGiven` or `Sharp`.
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
    contours: tuple[Contour, ...] | None = None
    findings: tuple[Finding, ...] = ()
    deformations: tuple[Deformation, ...] = ()
    thickenings: tuple[Thickening, ...] = ()
    changes: tuple[dict[str, Any], ...] = ()

    def __post_init__(self) -> None:
        for field in ("u", "eta", "representatives", "M", "b"):
            object.__setattr__(self, field, readonly(getattr(self, field)))

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}  # no caches

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
            Finish of the trailing edges in `sections`; at least 2 mm thick by default.
        spacing : callable
            Spacing of the landmarks along each side.

        Raises
        ------
        DefinitionError
            If `path` is no path or an airfoil is unusable.
        """
        if path not in PATHS:
            raise DefinitionError(f"path: got {path!r}, allowed are {', '.join(PATHS)}")
        u = landmark_parameters(landmarks, spacing)
        curves = {id(s.airfoil): contour(s.airfoil.coordinates) for s in definition.stations}
        shapes = {key: curve.landmarks(u) for key, curve in curves.items()}
        keys = [id(station.airfoil) for station in definition.stations]
        X, M, b = affine.standardise(np.stack([shapes[key] for key in keys]))
        contours = tuple(curves[key] for key in keys)
        return cls(
            definition=definition,
            u=u,
            eta=np.array([station.eta for station in definition.stations]),
            representatives=X,
            M=M,
            b=b,
            path=PATHS[path],
            planes=planes,
            trailing_edge=trailing_edge,
            contours=contours,
            findings=definition.findings
            + opened(definition, contours)
            + disagreeing(definition, u, affine.restore(X, M, b)),
        )

    @property
    def name(self) -> str:
        """The definition's name."""
        return self.definition.name

    @property
    def length(self) -> float:
        """Blade length along z [m]."""
        return self.definition.length

    def chord(self, eta: ArrayLike) -> Array:
        """Return the chord [m] at `eta`: the definition's spline."""
        return self.definition.chord(eta)

    def twist(self, eta: ArrayLike) -> Array:
        """Return the twist [rad] at `eta`: the definition's spline."""
        return self.definition.twist(eta)

    def axis(self, eta: ArrayLike) -> Array:
        """Return the reference axis (..., 3) [m] at `eta`."""
        return self.definition.axis(eta)

    @cached_property
    def planform(self) -> Planform:
        """Where sections stand."""
        return Planform(self.definition, self.planes)

    @cached_property
    def splines(self) -> SectionSplines:
        """Splines through sections with the blade's landmarks."""
        return SectionSplines(self.u)

    @cached_property
    def parameter(self) -> Parameter:
        """The path's parameter as a function of span."""
        return Parameter(self.eta, self.definition.relative_thickness)

    @cached_property
    def _joined(self) -> tuple[Path, SectionSpline]:
        # A representative's rotation is moved to the tip's M first, so that no result
        # depends on which representatives `points` holds.
        knots = self.parameter.knots
        angle, _ = affine.polar(self.M[-1:])
        turn = affine.from_polar(angle, np.zeros((1, 2, 2)))
        path, M = self.path(knots, self.representatives @ turn, turn.mT @ self.M)
        return path, SectionSpline(knots, M, self.b)

    @property
    def shape_path(self) -> Path:
        """The path on the Grassmannian, a function of `parameter`."""
        return self._joined[0]

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
        flat = spans.reshape(-1)
        plain, X, M, b = self.shapes(flat)
        points = affine.restore(X, M, b)
        A, c = self.splines.normalising(points, self._target(flat, plain, M, b))
        if u is not None:
            finer = self._between(u) @ plain
            if self.deformations:
                finer = finer + self.splines.values(u) @ (X - plain)
            points = affine.restore(finer, M, b)
        result = affine.restore(points, A, c)
        return result.reshape(*spans.shape, *result.shape[1:])

    def wanted_thickness(self, eta: Array) -> Array | None:
        """Return the relative thickness that rules at span fractions (k,), None if none does."""
        plain, _, M, b = self.shapes(eta)
        return self._target(eta, plain, M, b)

    def relative_thickness(self, eta: ArrayLike) -> Array:
        """Return the relative thickness of the sections at `eta`."""
        spans = _spans(eta)
        profiles = self.profiles(spans.reshape(-1))
        return self.splines.fit(profiles).relative_thickness.reshape(spans.shape)

    @property
    def points(self) -> Array:
        """The stations' shapes as points of Gr(n, 2), deformations included, (s, n, 2)."""
        X = self.representatives
        for deformation in self.deformations:
            X = deformation(X, self.eta)
        return X

    def shapes(self, eta: Array) -> tuple[Array, Array, Array, Array]:
        """Return the path's points at span fractions (k,), the same deformed, and M and b.

        ``points @ M + b`` are sections before they are brought to unit chord and thickness;
        bases join over span.
        """
        path, spline = self._joined
        q = self.parameter(eta)
        plain, (M, b) = path(q), spline(q)
        X = plain
        for deformation in self.deformations:
            X = deformation(X, eta)
        return plain, X, M, b

    def _target(self, eta: Array, plain: Array, M: Array, b: Array) -> Array | None:
        """Return the relative thickness to reach; None if nothing rules it.

        Without a distribution, a perturbed blade keeps the thickness it had.
        """
        thickness = self.definition.relative_thickness
        if thickness is not None:
            target = thickness(eta)
        elif self.deformations or self.thickenings:
            target = self.splines.fit(affine.restore(plain, M, b)).relative_thickness
        else:
            return None
        for thickening in self.thickenings:
            target = target * thickening(eta)
        return target

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
            Landmarks [m], blade frame, trailing edge -> suction -> leading edge -> pressure.
        """
        spans = _spans(eta)
        flat = spans.reshape(-1)
        finished = self.trailing_edge(self.profiles(flat, u), self.chord(flat))
        placed = self.planform.place(finished, flat)
        return placed.reshape(*spans.shape, *placed.shape[1:])

    def _between(self, u: Array) -> Array:
        """Return the linear map (m, n) from a path's landmarks to its points at `u`.

        Paths run in the span of the stations' shapes, so a map that is right for these is
        right for all that lies between them.
        """
        if self.contours is None:
            return SectionSplines(self.u).values(u)
        airfoils = np.stack([contour.landmarks(u) for contour in self.contours])
        finer = (airfoils - self.b[:, None]) @ np.linalg.inv(self.M)
        columns = np.concatenate([*self.representatives], axis=1)
        return np.concatenate([*finer], axis=1) @ np.linalg.pinv(columns, rcond=SAME_SHAPE)

    def _with(self, **changes: Any) -> "Blade":
        return replace(self, **changes)

    def with_trailing_edge(self, trailing_edge: TrailingEdge) -> "Blade":
        """Return the blade with another finish of its trailing edges."""
        return replace(self, trailing_edge=trailing_edge)

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
    spans = np.asarray(eta, dtype=np.float64)
    if not bool(np.all((spans >= 0) & (spans <= 1))):
        bad = spans[~((spans >= 0) & (spans <= 1))][0]
        raise DefinitionError(f"eta: got {bad:g}, allowed is 0 (root) to 1 (tip)")
    return spans
