"""The curve that carries a blade's sections: x, y and z over span, as points and derivatives."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.definition.distribution import OVER_SPAN, Distribution, Interpolant, pchip
from bladegen.errors import DefinitionError
from bladegen.support.arguments import instance, numbers
from bladegen.support.arrays import Array, ArrayLike

__all__ = ["ReferenceAxis"]


@dataclass(frozen=True, repr=False)
class ReferenceAxis:
    """The curve that carries the sections: x, y, z over span [m], blade frame."""

    x: Distribution
    y: Distribution
    z: Distribution

    def __post_init__(self) -> None:
        for name in ("x", "y", "z"):
            instance(getattr(self, name), Distribution, f"axis: {name}", OVER_SPAN, DefinitionError)

    def __repr__(self) -> str:
        x, y, z = self(1.0) - self(0.0)
        return f"<ReferenceAxis: {z:.4g} m long, tip at x = {x:.4g} m, y = {y:.4g} m from the root>"

    @cached_property
    def _together(self) -> Interpolant | None:
        """All three in one, where they are PCHIP on one grid."""
        parts = self.x, self.y, self.z
        grid = self.x.grid
        alike = all(one.spline is pchip and np.array_equal(one.grid, grid) for one in parts)
        return pchip(grid, np.stack([one.values for one in parts], axis=-1)) if alike else None

    def __call__(self, eta: ArrayLike, nu: int = 0) -> Array:
        """Return points, or `nu`-th derivatives, of shape (..., 3) at `eta`."""
        if self._together is None:
            return np.stack([self.x(eta, nu), self.y(eta, nu), self.z(eta, nu)], axis=-1)
        spans = numbers(eta, "eta", DefinitionError)
        inside = np.clip(spans, self.z.grid[0], self.z.grid[-1])
        points = np.asarray(self._together(inside, nu=nu))
        return np.where((inside == spans)[..., None], points, 0.0) if nu else points
