"""Deviations of a real surface from a blade, over span and arc: measured, made up, and put on.

A deviation is a distance [m] along the outward normal of a section in its plane, at span
fractions and landmark parameters.  It is split into what an affine map of the section would do,
what the modes of a shape space would do besides, and the rest: dents and dings.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bladegen.airfoils.section_splines import SectionSplines
from bladegen.blade.blade import Blade
from bladegen.definition.distribution import united
from bladegen.errors import BladegenError, FileError
from bladegen.fitting.wear import patterns
from bladegen.fitting.wear.worn import APART, normals, worn
from bladegen.measures import distances
from bladegen.measures.surfaces import Surface
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arguments import amount
from bladegen.support.arrays import Array, readonly
from bladegen.support.files import content_of

__all__ = ["DeviationMap"]

FARTHEST = 0.5  # m: what lies farther away is another surface
MOST = 1 << 28  # bytes of a table
GRID, VALUES = ("eta", "u"), "deviation_mm"


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
    def measured(
        cls, blade: Blade, surface: Surface, *, spans: int = patterns.SPANS
    ) -> "DeviationMap":
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
        eta, values = patterns.erosion(blade, start, end, width, depth)
        return cls(eta, blade.u, values)

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
        spans, values = patterns.dent(blade, eta, u, size, depth)
        return cls(spans, blade.u, values)

    @classmethod
    def waves(
        cls, blade: Blade, *, start: float, end: float = 1.0, length: float, height: float
    ) -> "DeviationMap":
        """Return the pattern of a wavy skin: waves along the arc on both sides.

        Parameters
        ----------
        blade : Blade
            Whose sections are meant.
        start, end : float
            Span fractions between which they are; over a fifth of that they set in at either end.
        length : float
            Of a wave along the arc [m].
        height : float
            From trough to crest [m]; they fade over a wave at the leading and trailing edge.
        """
        eta, values = patterns.waves(blade, start, end, length, height)
        return cls(eta, blade.u, values)

    @classmethod
    def read(cls, path: str | Path) -> "DeviationMap":
        """Read a map from a table with columns eta, u and deviation_mm, as `check` writes it.

        Raises
        ------
        FileError
            If a column is missing, a value is no number, or a span lacks a landmark.
        """
        text = content_of(Path(path), MOST).decode("utf-8", "replace")
        header, _, rest = text.partition("\n")
        names = [name.strip() for name in header.split(",")]
        missing = [name for name in (*GRID, VALUES) if name not in names]
        if missing:
            raise FileError(
                str(path),
                [f"has no column {', '.join(missing)}; check SCAN BLADE --deviation writes them"],
            )
        try:
            rows = np.loadtxt(rest.splitlines(), delimiter=",", ndmin=2, dtype=np.float64)
            columns = rows[:, [names.index(name) for name in (*GRID, VALUES)]].T
        except (ValueError, IndexError) as error:
            raise FileError(str(path), [f"a row holds no {len(names)} numbers: {error}"]) from None
        eta, u = (np.unique(values) for values in columns[:2])
        if len(eta) < 2 or len(u) < 2 or rows.shape[0] != len(eta) * len(u):
            said = f"has {len(rows)} rows, must have one for each of {len(eta)} eta and {len(u)} u"
            raise FileError(str(path), [said])
        values = columns[2][np.lexsort((columns[1], columns[0]))]
        return cls(eta, u, values.reshape(len(eta), len(u)) / 1e3)

    def __add__(self, other: "DeviationMap") -> "DeviationMap":
        """Return both together, at the spans of either; the landmarks are these."""
        eta = united(self.eta, other.eta, apart=APART)
        values = sum(one.between(eta, self.u) for one in (self, other))
        return DeviationMap(eta, self.u, np.asarray(values))

    def __mul__(self, factor: float) -> "DeviationMap":
        """Return it so many times as large: 0.5 for half of it, -1 for as much the other way."""
        if isinstance(factor, DeviationMap | np.ndarray):
            raise BladegenError(
                "deviation: is multiplied by a number, such as 0.5 * map; maps add up with +"
            )
        times = amount(factor, "deviation: factor", BladegenError)
        return DeviationMap(self.eta, self.u, times * self.values)

    __rmul__ = __mul__
    __array_ufunc__ = None  # so that NumPy's numbers and arrays leave products to the map

    def between(self, eta: Array, u: Array) -> Array:
        """Return the values at span fractions (k,) and landmark parameters (n,), (k, n).

        By monotone splines over span; beyond the first and last span they are those there.
        """
        from scipy.interpolate import PchipInterpolator

        spline = PchipInterpolator(self.eta, self.at(u), axis=0)
        return np.asarray(spline(np.clip(eta, *self.eta[[0, -1]])))

    def at(self, u: Array) -> Array:
        """Return the values at landmark parameters (m,), (k, m), by splines along the arc."""
        if len(u) == len(self.u) and np.array_equal(u, self.u):
            return self.values
        return np.asarray(self.values @ SectionSplines(self.u).values(u).T)

    def parts(self, blade: Blade, space: ShapeSpace | None = None) -> dict[str, Array]:
        """Return what affine maps of sections, modes of a space and neither make of it, (k, n).

        By least squares over each section's landmarks, affine maps first.
        """
        space = (ShapeSpace.bundled() if space is None else space).at(blade.u)
        profiles = blade.profiles(self.eta)
        normal = normals(profiles)
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

        Its planes and axis stay; chord, twist, offsets and thickness are those of the new sections,
        at as many spans as keep points within 0.3 mm of where they belong.
        """
        if blade.mirrored:
            return self.applied(blade.mirror_image()).mirror_image()
        made = worn(blade, self.eta, lambda eta: self.between(eta, blade.u))
        return made.require_sound(allow_odd=True)


def _projected(basis: Array, values: Array) -> Array:
    """Return the nearest combinations of basis vectors (k, n, m) to values (k, n)."""
    Q, R = np.linalg.qr(basis)
    size = np.abs(np.diagonal(R, axis1=1, axis2=2))
    Q = Q * (size > 1e-9 * size.max(axis=1, keepdims=True))[:, None]
    return np.asarray((Q @ (Q.mT @ values[..., None]))[..., 0])
