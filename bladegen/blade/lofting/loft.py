"""A blade's airfoils joined over span, before anything is perturbed.

Stations' shapes are joined on Gr(n, 2) by a path, and their affine maps by splines; trailing
edges are brought to their width over span.  A `Loft` is what all variants of a blade share, and
with it what it has computed.  Span fractions (k,) to sections (k, n, 2), not brought to size.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from bladegen.airfoils.landmarks import Contour, Spacing, contour, landmark_parameters
from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.lofting.edge_widths import BETWEEN, EdgeWidths, Joining
from bladegen.blade.lofting.joined import JoinedSections
from bladegen.blade.lofting.parameters import Parameter
from bladegen.blade.lofting.paths import PATHS, Maps, Path, PathMaker, spline_path
from bladegen.definition.airfoil_findings import disagreeing, opened
from bladegen.definition.blade_definition import BladeDefinition, Distribution, pchip
from bladegen.definition.thickness import own_thickness
from bladegen.errors import DefinitionError, Finding
from bladegen.shapes import affine
from bladegen.support.arguments import amount, function, instance, one_of, whole
from bladegen.support.arrays import Array, Indices, readonly
from bladegen.support.recent import Recent
from bladegen.support.values import state_of

__all__ = ["Loft", "lofted"]

REMEMBERED = 4  # sets of spans whose sections are kept; some 5 MB each for 100 x 401
LARGEST = 200  # spans in a set that is kept
SAME_SHAPE = 1e-10  # of the largest singular value; stations may repeat an airfoil


@dataclass(frozen=True, eq=False)
class Loft:
    """The stations' airfoils joined over span.

    Parameters
    ----------
    u : (n,) array
        Landmark parameters, 0 at the suction side's trailing edge, 0.5 at the leading edge.
    eta : (s,) array
        Span fractions of the stations.
    representatives : (s, n, 2) array
        The stations' airfoils as points of Gr(n, 2): orthonormal, centred bases.
    M, b : (s, 2, 2), (s, 2) arrays
        Their affine maps, ``airfoil = representatives @ M + b``.
    relative_thickness : Distribution, optional
        The thickness over chord that rules over span; without it, that of the path.
    path : callable
        How stations are joined: `paths.spline_path` or `geodesic_path`.
    edge_width : callable, optional
        Joins the stations' edge widths over the path's parameter: `definition.pchip`, or None
        for the widths that the path happens to have.
    contours : tuple of Contour, optional
        The stations' airfoils between their landmarks; without them, splines through the
        landmarks.
    fairing : float, optional
        How far airfoils may have been moved to take noise out [chord], to be told.
    """

    u: Array
    eta: Array
    representatives: Array
    M: Array
    b: Array
    relative_thickness: Distribution | None = None
    path: PathMaker = spline_path
    edge_width: Joining | None = pchip
    contours: tuple[Contour, ...] | None = None
    fairing: float | None = None

    def __post_init__(self) -> None:
        for field in ("u", "eta", "representatives", "M", "b"):
            object.__setattr__(self, field, readonly(getattr(self, field)))

    __getstate__ = state_of

    def __repr__(self) -> str:
        return f"<Loft of {len(self.eta)} stations, {len(self.u)} landmarks>"

    @cached_property
    def splines(self) -> SectionSplines:
        """Splines through sections with these landmarks."""
        return SectionSplines(self.u)

    @cached_property
    def parameter(self) -> Parameter:
        """The path's parameter as a function of span."""
        return Parameter(self.eta, self.relative_thickness)

    @cached_property
    def _joined(self) -> tuple[Path, Maps]:
        # A representative's rotation is moved to the tip's M first, so that no result
        # depends on which representatives there are.
        angle, _ = affine.polar(self.M[-1:])
        turn = affine.rotation(angle)
        path, M = self.path(self.parameter, self.representatives @ turn, turn.mT @ self.M)
        return path, path.maps(M, self.b)

    @property
    def shape_path(self) -> Path:
        """The path on the Grassmannian, a function of `parameter`."""
        return self._joined[0]

    def at(self, eta: Array) -> tuple[Array, Array, Array]:
        """Return the path's points X and their maps M and b at span fractions (k,)."""
        path, maps = self._joined
        q = self.parameter(eta)
        return path(q), *maps(q)

    def shapes(self, eta: Array) -> tuple[Array, Array, Array]:
        """Return shapes (k, n, 2) at span fractions (k,), their edges brought to width, M and b.

        Bases join over span.
        """
        return self.sections(eta).standardised

    def sections(self, eta: Array) -> JoinedSections:
        """Return the path's sections at span fractions (k,), their edges brought to width."""
        if len(eta) > LARGEST:
            return self._sections(eta)
        return self._recent.get(eta.tobytes(), lambda: self._sections(eta))

    @cached_property
    def _recent(self) -> Recent[JoinedSections]:
        return Recent(REMEMBERED)

    def _sections(self, eta: Array) -> JoinedSections:
        path, maps = self._joined
        q, ruling = self.parameter(eta), self.ruling(eta)
        points = path.combined(q).mapped(*maps(q))
        curves, wedges = self.splines.fit(points), None
        if self.edge_width is not None:
            wedges = self._widths.wedges(curves, ruling, q)
        return JoinedSections.of(curves, ruling, wedges)

    @cached_property
    def _widths(self) -> EdgeWidths:
        airfoils = affine.restore(self.representatives, self.M, self.b)
        thickness = self.ruling(self.eta)
        return EdgeWidths.through(
            airfoils,
            self.splines,
            thickness,
            self.parameter.knots,
            self.edge_width or pchip,
            self._between,
        )

    def _between(self, stations: Indices) -> tuple[Array, Array, Array | None]:
        """Return the path's parameter, its sections and their thickness behind stations (m,)."""
        spans = self.eta[stations, None] + np.diff(self.eta)[stations, None] * BETWEEN
        flat = spans.reshape(-1)
        q = self.parameter(flat).reshape(spans.shape)
        return q, affine.restore(*self.at(flat)), self.ruling(flat)

    def finer(self, joined: JoinedSections, eta: Array, u: Array) -> Array:
        """Return points (k, m, 2) at landmark parameters (m,) of the sections at spans (k,)."""
        (X, M, b), wedges = self.at(eta), joined.wedges
        if self.contours is None:
            points = affine.restore(SectionSplines(self.u).values(u) @ X, M, b)
        else:
            own, weights = self.between(u), (self._shares @ X) @ M
            flat = own @ weights.transpose(1, 0, 2).reshape(own.shape[1], -1)
            points = flat.reshape(len(u), len(eta), 2).swapaxes(0, 1) + b[:, None]
        return points if wedges is None else wedges.opened(points)[0]

    def ruling(self, eta: Array) -> Array | None:
        """Return the relative thickness that rules at span fractions (k,), if one does."""
        thickness = self.relative_thickness
        return None if thickness is None else thickness(eta)

    def between(self, u: Array) -> Array:
        """Return the stations' shapes at other landmark parameters (m,), side by side, (m, 2 s).

        Paths run in the span of the stations' shapes: what makes a path's landmarks of theirs
        (`_shares`) makes its points at `u` of these.
        """
        airfoils = np.stack([contour.landmarks(u) for contour in self.contours or ()])
        finer = (airfoils - self.b[:, None]) @ np.linalg.inv(self.M)
        return np.concatenate([*finer], axis=1)

    @cached_property
    def _shares(self) -> Array:
        """The map from points of a path to their shares in the stations' shapes, (2 s, n)."""
        columns = np.concatenate([*self.representatives], axis=1)
        shares: Array = np.linalg.pinv(columns, rcond=SAME_SHAPE)
        return shares


def lofted(
    definition: BladeDefinition,
    landmarks: int,
    path: str,
    spacing: Spacing,
    fairing: float | None,
) -> tuple[BladeDefinition, Loft, tuple[Finding, ...]]:
    """Join a definition's airfoils over span: landmarks, standardisation, path.

    Returned are the definition, with the airfoils' own thickness over span where it gives none,
    and what was mended or looks odd, besides.
    """
    must = "a BladeDefinition, such as bladegen.read('iea15mw') or bladegen.read(path) gives"
    instance(definition, BladeDefinition, "definition", must, DefinitionError)
    one_of(path, PATHS, "path", DefinitionError)
    must = "a function such as bladegen.airfoils.landmarks.cosine"
    function(spacing, "spacing", must, DefinitionError)
    if fairing is not None:
        amount(fairing, "fairing", DefinitionError)
    u = landmark_parameters(whole(landmarks, "landmarks", DefinitionError), spacing)
    contours = tuple(
        contour(station.airfoil.coordinates, fairing=fairing) for station in definition.stations
    )
    airfoils = np.stack([curve.landmarks(u) for curve in contours])
    X, M, b = affine.standardise(airfoils)
    eta = np.array([station.eta for station in definition.stations])
    findings = (
        definition.findings + opened(definition, contours) + disagreeing(definition, u, airfoils)
    )
    if definition.relative_thickness is None:
        definition = replace(definition, relative_thickness=own_thickness(eta, u, airfoils))
    thickness = definition.relative_thickness
    way = PATHS[path]
    loft = Loft(u, eta, X, M, b, thickness, way, contours=contours, fairing=fairing)
    return definition, loft, findings
