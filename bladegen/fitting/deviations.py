"""Deviations of a real surface from a blade, over span and arc: measured, made up, and put on.

A deviation is a distance [m] along the outward normal of a section in its plane, at span
fractions and landmark parameters.  It is split into what an affine map of the section would do,
what the modes of a shape space would do besides, and the rest: dents and dings.
"""

from dataclasses import dataclass, replace

import numpy as np

from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.blade import Blade
from bladegen.blade.lofting.loft import Loft
from bladegen.blade.shape import Shape
from bladegen.definition.blade_definition import Airfoil, Distribution, Station
from bladegen.errors import BladegenError
from bladegen.measures import distances
from bladegen.measures.surfaces import Surface
from bladegen.shapes import affine
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array, readonly

__all__ = ["DeviationMap"]

SPANS = 120
FARTHEST = 0.5  # m: what lies farther away is another surface
DIGITS = 9  # of airfoil coordinates


@dataclass(frozen=True, eq=False)
class DeviationMap:
    """Distances of a surface from a blade's sections.

    Parameters
    ----------
    eta : (k,) array
        Span fractions, from 0 to 1.
    u : (n,) array
        Landmark parameters: 0 at the suction side's trailing edge, 0.5 at the leading edge.
    values : (k, n) array
        Along the outward normals [m], positive outward.
    """

    eta: Array
    u: Array
    values: Array

    def __post_init__(self) -> None:
        for name in ("eta", "u", "values"):
            object.__setattr__(self, name, readonly(getattr(self, name)))
        shape = len(self.eta), len(self.u)
        if self.values.shape != shape or not np.isfinite(self.values).all():
            raise BladegenError(
                f"deviation: values must be numbers of shape {shape}, got {self.values.shape}"
            )

    def __repr__(self) -> str:
        low, high = 1e3 * self.values.min(), 1e3 * self.values.max()
        return f"<DeviationMap of {len(self.eta)} x {len(self.u)}: {low:.3g} to {high:.3g} mm>"

    @classmethod
    def measured(cls, blade: Blade, surface: Surface, *, spans: int = SPANS) -> "DeviationMap":
        """Measure how far a surface lies from a blade, in the blade's frame.

        Raises
        ------
        BladegenError
            If it lies somewhere else.
        """
        eta = np.linspace(0.0, 1.0, spans)
        points = blade.sections(eta)
        inside = np.clip(eta, 0.25 / spans, 1.0 - 0.25 / spans)  # caps are no skin
        off = -distances.signed(blade.sections(inside).reshape(-1, 3), surface)
        usual = float(np.median(np.abs(off)))
        if usual > FARTHEST:
            raise BladegenError(
                f"deviation: half of the surface lies more than {usual:.3g} m from the blade; are "
                "frames and units the same? bladegen fit finds them"
            )
        return cls(eta, blade.u, off.reshape(points.shape[:2]))

    @classmethod
    def erosion(
        cls, blade: Blade, *, start: float, end: float = 1.0, width: float, depth: float
    ) -> "DeviationMap":
        """Return the pattern of an eroded leading edge.

        Parameters
        ----------
        blade : Blade
            Whose sections are meant.
        start, end : float
            Span fractions between which it is; over a fifth of that it sets in at the start.
        width : float
            How far it reaches from the leading edge along the arc, over the chord.
        depth : float
            At the leading edge [m]; it ends smoothly.
        """
        _between(start, end)
        eta = np.unique(np.concatenate([np.linspace(0.0, 1.0, SPANS), [start, end]]))
        arc = _arcs(blade, eta)
        along = np.clip((eta - start) / (0.2 * (end - start)), 0.0, 1.0) * (eta <= end)
        across = np.clip(1.0 - np.abs(arc) / width, 0.0, 1.0)
        return cls(eta, blade.u, -depth * _smooth(along)[:, None] * _smooth(across))

    @classmethod
    def dent(
        cls, blade: Blade, *, eta: float, u: float, size: float, depth: float
    ) -> "DeviationMap":
        """Return the pattern of a dent, a round hollow that ends smoothly.

        Parameters
        ----------
        blade : Blade
            Whose sections are meant.
        eta, u : float
            Where its middle is: a span fraction and a landmark parameter.
        size : float
            Its diameter [m].
        depth : float
            At its middle [m].
        """
        reach = size / blade.length
        near = np.linspace(max(eta - reach, 0.0), min(eta + reach, 1.0), 41)
        spans = np.unique(np.concatenate([np.linspace(0.0, 1.0, SPANS // 2), near]))
        middle = blade.sections(np.array([eta]), np.array([u]))[0, 0]
        away = np.linalg.norm(blade.sections(spans) - middle, axis=-1)
        return cls(spans, blade.u, -depth * _smooth(np.clip(1.0 - 2.0 * away / size, 0.0, 1.0)))

    def parts(self, blade: Blade, space: ShapeSpace | None = None) -> dict[str, Array]:
        """Return what affine maps of sections, modes of a space and neither make of it, (k, n).

        By least squares over each section's landmarks, affine maps first.
        """
        space = (ShapeSpace.bundled() if space is None else space).at(blade.u)
        profiles = blade.profiles(self.eta)
        normal = _normals(profiles)
        x, y = profiles[..., 0], profiles[..., 1]
        one, nought = np.ones_like(x), np.zeros_like(x)
        ways = [(x, nought), (y, nought), (nought, x), (nought, y), (one, nought), (nought, one)]
        maps = np.stack([a * normal[..., 0] + b * normal[..., 1] for a, b in ways], axis=-1)
        X, M, _ = blade.shape.loft.shapes(self.eta)
        modes = []
        for unit in np.eye(space.dimension):
            moved = space.carried(np.tile(unit, (len(self.eta), 1)), X) @ M
            modes.append(np.sum(moved * normal, axis=-1))
        by_affine = _projected(maps, self.values)
        left = self.values - by_affine
        by_space = _projected(np.stack(modes, axis=-1), left)
        return {"affine": by_affine, "space": by_space, "rest": left - by_space}

    def applied(self, blade: Blade) -> Blade:
        """Return the blade with this deviation on its skin, each landmark moved along its normal.

        Its planes and axis stay; chord, twist, offsets and thickness are those of the new sections.
        """
        eta, definition = self.eta, blade.definition
        at = SectionSplines(self.u).values(blade.u) if len(self.u) != len(blade.u) else None
        values = self.values if at is None else self.values @ at.T
        chord = blade.chord(eta)
        start = np.stack([-definition.offset_y(eta), definition.offset_x(eta)], axis=-1)
        profiles = blade.profiles(eta)
        points = chord[:, None, None] * profiles + start[:, None]
        points = points + values[..., None] * _normals(profiles)
        curves = SectionSplines(blade.u).fit(points)
        lead, away = curves.leading_edge, curves.trailing_edge - curves.leading_edge
        turn = np.arctan2(away[:, 1], away[:, 0])
        c, s = np.cos(turn), np.sin(turn)
        back = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)
        airfoils = (points - lead[:, None]) @ back / curves.chord[:, None, None]
        place = (lead[:, None] @ back)[:, 0]
        thickness = curves.relative_thickness
        stations = tuple(
            Station(
                float(e), Airfoil(f"{blade.name} {100 * e:.2f} %", np.round(xy, DIGITS), float(t))
            )
            for e, xy, t in zip(eta, airfoils, thickness, strict=True)
        )
        made = replace(
            definition,
            stations=stations,
            chord=Distribution(eta, curves.chord),
            twist=Distribution(eta, blade.twist(eta) + turn),
            section_offset_y=Distribution(eta, -place[:, 0]),
            section_offset_x=Distribution(eta, place[:, 1]),
            pitch_axis=None,
            relative_thickness=Distribution(eta, thickness),
        )
        X, M, b = affine.standardise(airfoils)
        loft = Loft(blade.u, eta, X, M, b, made.relative_thickness, blade.path)
        return Blade(Shape(loft), replace(blade.planform, definition=made), blade.trailing_edge)


def _between(start: float, end: float) -> None:
    if not 0.0 <= start < end <= 1.0:
        raise BladegenError(
            f"erosion: start and end must rise within 0 to 1, got {start:g} and {end:g}"
        )


def _smooth(share: Array) -> Array:
    """Return a C2 step from 0 to 1."""
    step: Array = share * share * share * (10.0 - 15.0 * share + 6.0 * share * share)
    return step


def _normals(profiles: Array) -> Array:
    """Return outward unit normals (k, n, 2) of sections that run from suction to pressure."""
    along = np.gradient(profiles, axis=1)
    normal = along[..., ::-1] * [1.0, -1.0]
    return np.asarray(normal / np.linalg.norm(normal, axis=-1, keepdims=True))


def _arcs(blade: Blade, eta: Array) -> Array:
    """Return arc lengths from the leading edge (k, n), over the chord, positive on either side."""
    steps = np.linalg.norm(np.diff(blade.profiles(eta), axis=1), axis=-1)
    arc = np.concatenate([np.zeros((len(eta), 1)), np.cumsum(steps, axis=1)], axis=1)
    return np.asarray(np.abs(arc - arc[:, len(blade.u) // 2][:, None]))


def _projected(basis: Array, values: Array) -> Array:
    """Return the nearest combinations of basis vectors (k, n, m) to values (k, n)."""
    Q, R = np.linalg.qr(basis)
    size = np.abs(np.diagonal(R, axis1=1, axis2=2))
    Q = Q * (size > 1e-9 * size.max(axis=1, keepdims=True))[:, None]
    return np.asarray((Q @ (Q.mT @ values[..., None]))[..., 0])
