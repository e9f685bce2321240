"""Which parameters of a known blade a surface has: Gauss-Newton with exact derivatives.

Each point of the surface is held against the tangent plane at the nearest landmark of the model's
sections, since where on the blade it lies is not known; the planes move with the parameters.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import BladegenError
from bladegen.parametric.model import ParametricBlade
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array

__all__ = ["Parameters", "model_like", "parameters_of"]

SPANS = 140
INSIDE = 0.03, 0.985  # of the span: caps and round roots tell nothing
KINDS: tuple[Any, ...] = (("pga", [0.3, 0.6, 0.9]), "thickness", "chord", "twist")
STEPS = 10
SETTLED, STILL = 1e-7, 0.02  # of a step: at all, and of the standard deviations
DAMPING = 1e-9  # of the normal equations' diagonal
SCREENED = 6.0  # times the median distance: farther points are something else
FEWEST = 10  # points a parameter


@dataclass(frozen=True, eq=False)
class Parameters:
    """Parameters of a blade that a surface is like.

    Parameters
    ----------
    model : ParametricBlade
        What they are parameters of.
    x : (p,) array
        Their values, in the order of `model.names`.
    covariance : (p, p) array
        Of the values, if distances are independent and normal.
    rms : float
        Of the points' distances from the blade of these parameters [m].
    """

    model: ParametricBlade
    x: Array
    covariance: Array
    rms: float

    def __repr__(self) -> str:
        return f"<Parameters like {self.model.blade.name}: RMS {1e3 * self.rms:.3g} mm>"

    @property
    def deviations(self) -> Array:
        """The standard deviations of the values, (p,)."""
        return np.sqrt(np.diagonal(self.covariance))

    def rows(self) -> list[dict[str, Any]]:
        """Return names, values and standard deviations."""
        found = zip(self.model.names, self.x.tolist(), self.deviations.tolist(), strict=True)
        return [{"name": n, "value": v, "standard_deviation": s} for n, v, s in found]


def model_like(like: Blade | BladeDefinition | ParametricBlade) -> ParametricBlade:
    """Return the model that a blade is fitted by: shape at three spans, thickness, chord, twist."""
    if isinstance(like, ParametricBlade):
        return like
    blade = Blade.from_definition(like) if isinstance(like, BladeDefinition) else like
    if not isinstance(blade, Blade):
        raise BladegenError(
            f"like: got {type(like).__name__}, must be a BladeDefinition, a Blade or a "
            "ParametricBlade"
        )
    eta = np.linspace(*INSIDE, SPANS)
    return ParametricBlade(blade, ShapeSpace.bundled(), KINDS, eta)


def parameters_of(points: Array, model: ParametricBlade) -> Parameters:
    """Fit the parameters of a model to points (m, 3) of a surface in the blade frame.

    Raises
    ------
    BladegenError
        If there are too few points, or these do not tell the parameters.
    """
    z = model.blade.axis(model.eta[[0, -1]])[:, 2]
    inside = points[(points[:, 2] > z[0]) & (points[:, 2] < z[1])]
    count = len(model.names)
    if len(inside) < FEWEST * count:
        raise BladegenError(
            f"like: {len(inside)} points lie on the model's span, at least {FEWEST * count} are "
            f"needed for {count} parameters"
        )
    x = model.baseline.copy()
    for _ in range(STEPS):
        off, rows = _residuals(x, inside, model)
        normal = rows.T @ rows
        scale = np.sqrt(np.diagonal(normal))
        if not scale.all():
            blind = model.names[int(np.argmin(scale))]
            raise BladegenError(f"like: the points say nothing of {blind}")
        system = normal / np.outer(scale, scale) + DAMPING * np.eye(count)
        step = -np.linalg.solve(system, rows.T @ off / scale) / scale
        x = np.clip(x + step, model.lower, model.upper)
        variance = float(off @ off) / max(len(off) - count, 1)
        covariance = variance * np.linalg.inv(system) / np.outer(scale, scale)
        if np.all(np.abs(step) <= SETTLED + STILL * np.sqrt(np.diagonal(covariance))):
            break
    off, _ = _residuals(x, inside, model)
    return Parameters(model, x, covariance, float(np.sqrt(np.mean(off**2))))


def _residuals(x: Array, points: Array, model: ParametricBlade) -> tuple[Array, Array]:
    """Return distances (m,) of points from tangent planes [m], and their derivatives (m, p)."""
    from scipy.spatial import cKDTree

    sections, slopes = model.sections(x), model.jacobian(x)
    normals = np.cross(np.gradient(sections, axis=1), np.gradient(sections, axis=0))
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    skin = slice(1, -1)  # edges have no plane
    flat = sections[:, skin].reshape(-1, 3)
    n = normals[:, skin].reshape(-1, 3)
    near = cKDTree(flat).query(points)[1]
    off = np.sum(n[near] * (points - flat[near]), axis=-1)
    held = np.abs(off) <= SCREENED * np.median(np.abs(off)) + 1e-6
    some = near[held]
    moved = slopes[:, skin].reshape(len(flat), 3, -1)
    rows = -np.einsum("mi,mip->mp", n[some], moved[some])
    return off[held], rows
