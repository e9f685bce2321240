"""Principal geodesics: a low-dimensional space of shapes learned from points of Gr(n, 2).

Normal coordinates t of a shape are the components of its logarithm at the Karcher mean along
the principal modes; a shape of the learned manifold is exp(mean, sum_k t_k modes_k)
(sections "Principal geodesic deformations" and "Consistent blade deformations" of the paper;
Fletcher, Lu & Joshi 2003).  Coordinates are radians: |t| is the distance from the mean.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from bladegen.errors import SpaceError
from bladegen.shapes import grassmann
from bladegen.shapes.learning import checked, chunks, parameters, principal
from bladegen.shapes.other_landmarks import evaluated
from bladegen.shapes.saved_spaces import ORTHONORMAL, problem_of, read_space
from bladegen.shapes.statistics.distributions import distribution_of, sound_at
from bladegen.support.archive import save_arrays
from bladegen.support.arguments import generator, numbers, one_of, path_of, whole
from bladegen.support.arrays import Array, readonly
from bladegen.support.files import beside, require_suffix
from bladegen.support.services import shown_by
from bladegen.support.values import equal, hashed

__all__ = ["ShapeSpace"]

ARRAYS = ("u", "mean", "modes", "variances", "coordinates")
SAME_LANDMARKS = 1e-12
FILES = {"paper": "reference.npz", "sound": "sound.npz"}  # spaces that come with bladegen


@dataclass(frozen=True, eq=False)
class ShapeSpace:
    """Mean, principal modes and spread of a set of shapes.

    Parameters
    ----------
    u : (n,) array
        Landmark parameters of the shapes.
    mean : (n, 2) array
        Karcher mean: an orthonormal basis.
    modes : (r, n, 2) array
        Principal tangent vectors at the mean: horizontal, and orthonormal at the landmarks
        that the space was learned at (see `at`).
    variances : (q,) array
        Variance along all principal directions, largest first [rad^2]; q >= r.
    coordinates : (m, r) array
        Normal coordinates of the shapes it was learned from.
    about : str
        Where the shapes are from.
    """

    u: Array
    mean: Array
    modes: Array
    variances: Array
    coordinates: Array = field(repr=False)
    about: str = ""

    def __post_init__(self) -> None:
        for name in ARRAYS:
            values = numbers(getattr(self, name), name, SpaceError)
            object.__setattr__(self, name, readonly(values))

    __eq__ = equal
    __hash__ = hashed
    _repr_html_ = shown_by("space_html")

    def __repr__(self) -> str:
        return (
            f"<ShapeSpace of {self.dimension} modes, {len(self.u)} landmarks"
            f"{self.about and ': '}{self.about}>"
        )

    @classmethod
    def fit(
        cls, points: Array, *, modes: int = 4, u: Array | None = None, about: str = ""
    ) -> "ShapeSpace":
        """Learn a space from shapes.

        Parameters
        ----------
        points : (m, n, 2) array
            Orthonormal bases, any representatives.
        modes : int
            How many principal modes to keep.
        u : (n,) array, optional
            Their landmark parameters; if not given, those of `landmarks.landmark_parameters`,
            or even ones for a number of landmarks that these do not know.
        about : str
            Where the shapes are from.

        Raises
        ------
        SpaceError
            If there are too few shapes, or too few that differ, for the modes.
        GeometryError
            If the Karcher mean does not converge.
        """
        points = checked(points, "points")
        if points.ndim != 3:
            raise SpaceError(f"points: got the shape {points.shape}, must be (shapes, n, 2)")
        count, n, _ = points.shape
        modes = whole(modes, "modes", SpaceError)
        largest = min(count - 1, 2 * n - 4)
        if not 1 <= modes <= largest:
            raise SpaceError(f"modes: got {modes}, allowed is 1 to {largest} for {count} shapes")
        mean, kept, variances = principal(points, modes)
        space = cls(
            u=parameters(n) if u is None else u,
            mean=mean,
            modes=kept,
            variances=variances[:largest],
            coordinates=np.zeros((0, modes)),
            about=about,
        )
        coordinates = np.concatenate([space.encode(points[part]) for part in chunks(count)])
        return cls(space.u, mean, kept, space.variances, coordinates, about)

    @classmethod
    def bundled(cls, name: str = "paper") -> "ShapeSpace":
        """Return a space that comes with bladegen: four modes, 401 landmarks.

        "paper" is that of the paper's 16-airfoil database; "sound" is learned from the same with
        edges open by 1 % of the chord and even landmarks: none of its shapes crosses itself.
        """
        one_of(name, FILES, "space", SpaceError)
        return cls.load(Path(__file__).resolve().parent / FILES[name])

    @classmethod
    def load(cls, path: str | Path) -> "ShapeSpace":
        """Read a space from an npz file (ours, G2Aero's), or a bundled one by name ("sound").

        Raises
        ------
        SpaceError
            If the file is no space, is of another version, is damaged, or holds arrays that are
            no mean, modes and spread.
        """
        place = path_of(path, "space", SpaceError)
        if str(path) in FILES and not place.exists():
            return cls.bundled(str(path))
        if not place.exists():
            raise SpaceError(
                f"{path}: is no file; bundled spaces are {', '.join(FILES)}; the paper's is Shape"
                f"Space.bundled(), in the shell that without --space{beside(place, ('.npz',))}"
            )
        arrays, about = read_space(place, ARRAYS)
        problem = problem_of(arrays)
        if problem is not None:
            raise SpaceError(f"{path}: is no shape space: {problem}")
        return cls(**arrays, about=about)

    def save(self, path: str | Path) -> None:
        """Write the space to an npz file, with a version and a checksum."""
        where = path_of(path, "path", SpaceError)
        if not self.is_own:
            raise SpaceError(f"{path}: save the space that was learned, not one evaluated from it")
        require_suffix(where, (".npz",))
        save_arrays(where, {name: getattr(self, name) for name in ARRAYS}, self.about)

    def at(self, u: Array) -> "ShapeSpace":
        """Return the same space of shapes with landmarks at other parameters.

        Mean and modes are functions of the landmark parameter, splines through their own
        landmarks; they are evaluated at `u`.  A coordinate t moves a shape's contour as it does
        here, whatever the landmarks: where these lie closer or farther apart the modes are no
        longer orthonormal, and |t| is no distance there.

        Parameters
        ----------
        u : (n,) array
            Landmark parameters, as `landmarks.landmark_parameters` makes them.

        Raises
        ------
        SpaceError
            If the space's own landmarks are too few for it, or `u` too few for its modes.
        """
        if len(u) == len(self.u) and np.allclose(u, self.u, rtol=0, atol=SAME_LANDMARKS):
            return self
        mean, modes = evaluated(self.u, self.mean, self.modes, np.asarray(u))
        return replace(self, u=u, mean=mean, modes=modes)

    @cached_property
    def _gram(self) -> Array | None:
        """The inner products of the modes; None where these are orthonormal."""
        flat = self.modes.reshape(self.dimension, -1)
        gram: Array = flat @ flat.T
        return None if np.abs(gram - np.eye(len(gram))).max() < ORTHONORMAL else gram

    @property
    def is_own(self) -> bool:
        """Whether its landmarks are those that it was learned at, so that |t| is a distance."""
        return self._gram is None

    @property
    def dimension(self) -> int:
        """The number of modes, r."""
        return len(self.modes)

    @property
    def variance_ratio(self) -> Array:
        """Each direction's share of the whole variance, (q,)."""
        ratio: Array = self.variances / self.variances.sum()
        return ratio

    @cached_property
    def lower(self) -> Array:
        """The least coordinate of the shapes along each mode, (r,)."""
        return readonly(self.coordinates.min(axis=0))

    @cached_property
    def upper(self) -> Array:
        """The largest coordinate of the shapes along each mode, (r,)."""
        return readonly(self.coordinates.max(axis=0))

    @property
    def extent(self) -> float:
        """Standard deviations to the farthest shape: the smallest centred ellipsoid's size."""
        spread = np.sqrt(self.variances[: self.dimension])
        return float(np.max(np.linalg.norm(self.coordinates / spread, axis=1)))

    def encode(self, points: Array) -> Array:
        """Return normal coordinates (..., r) of shapes (..., n, 2), any representatives."""
        # The logarithm is Y G - X H, and modes are horizontal: <Y G - X H, U> = <G, Y^T U>.
        points = checked(points, "points", len(self.mean))
        G, _ = grassmann.log_factors(self.mean.T @ points)
        across = np.moveaxis(self.modes, 0, 1).reshape(len(self.mean), -1)
        inner = (points.mT @ across).reshape(*G.shape[:-1], self.dimension, 2)
        t: Array = np.einsum("...arb,...ab->...r", inner, G)
        if self._gram is not None:
            t = t @ np.linalg.inv(self._gram)
        return t

    def tangent(self, t: Array) -> Array:
        """Return the tangent vectors (..., n, 2) at the mean with coordinates t (..., r)."""
        V: Array = np.tensordot(self._checked(t), self.modes, axes=1)
        return V

    def decode(self, t: Array) -> Array:
        """Return the shapes (..., n, 2) of the learned manifold at coordinates t (..., r).

        Raises
        ------
        SpaceError
            If t has not one number a mode.
        """
        return grassmann.exp(self.mean, self.tangent(t))

    def carried(self, t: Array, points: Array) -> Array:
        """Carry tangents at the mean, of coordinates t (k, r), to shapes `points` (k, n, 2).

        By parallel transport: tangent vectors (k, n, 2) there, inner products kept.
        """
        return grassmann.transport(self.tangent(t), self.mean[None], points)

    def sample(self, count: int, rng: np.random.Generator | int | None = None) -> Array:
        """Draw coordinates (count, r), uniform in the smallest centred ellipsoid of the data.

        Its axes lie along the modes, in the ratio of the standard deviations.  `rng` is a generator
        of random numbers, or its seed.
        """
        count = whole(count, "count", SpaceError)
        if count < 0:
            raise SpaceError(f"count: got {count}, must not be negative")
        random = generator(rng, "rng", SpaceError)
        spread = np.sqrt(self.variances[: self.dimension])
        direction = random.normal(size=(count, self.dimension))
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        radius = random.uniform(size=(count, 1)) ** (1.0 / self.dimension)
        drawn: Array = self.extent * radius * direction * spread
        return drawn

    def outside(self, t: Array) -> str | None:
        """Say which of the coordinates t (..., r) leaves the data's range, or None."""
        t = self._checked(t).reshape(-1, self.dimension)
        low, high = t.min(axis=0), t.max(axis=0)
        for k in range(self.dimension):
            for value in (low[k], high[k]):
                if not self.lower[k] <= value <= self.upper[k]:
                    return (
                        f"t{k + 1} = {value:g}, allowed is {self.lower[k]:.4g} to "
                        f"{self.upper[k]:.4g}"
                    )
        return None

    distribution, sound = distribution_of, sound_at

    def _checked(self, t: Array) -> Array:
        t = numbers(t, "t", SpaceError)
        if t.ndim == 0 or t.shape[-1] != self.dimension:
            given = t.shape[-1] if t.ndim else 1
            raise SpaceError(f"t: got {given} coordinates, the space has {self.dimension} modes")
        if not np.isfinite(t).all():
            raise SpaceError("t: coordinates must be finite")
        return t
