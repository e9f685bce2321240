"""How a blade's shapes are joined over span: the ways there are, by name.

A path runs over a parameter that increases from station to station (`Parameter`).
`geodesic_path` is the paper's; `spline_path` blends its corners.  A way of one's own is one more
row of `PATHS`.
"""

from collections.abc import Callable
from typing import Protocol

from bladegen.blade.lofting.combined import Combined
from bladegen.blade.lofting.geodesics import GeodesicPath
from bladegen.blade.lofting.parameters import Parameter
from bladegen.blade.lofting.splines import SplinePath
from bladegen.shapes import affine
from bladegen.support.arrays import Array

__all__ = ["DEFAULT", "PATHS", "Maps", "Path", "PathMaker", "geodesic_path", "spline_path"]


class Maps(Protocol):
    """Affine maps over a path's parameter."""

    def __call__(self, q: Array) -> tuple[Array, Array]:
        """Return M (k, 2, 2) and b (k, 2) at parameters (k,)."""
        ...


class Path(Protocol):
    """A curve on the Grassmannian."""

    def __call__(self, q: Array) -> Array:
        """Return orthonormal bases (k, n, 2) at parameters (k,)."""
        ...

    def combined(self, q: Array) -> Combined:
        """Return the bases at parameters (k,) as combinations."""
        ...

    def maps(self, M: Array, b: Array) -> Maps:
        """Return the stations' affine maps, (s, 2, 2) and (s, 2), joined over the parameter."""
        ...


PathMaker = Callable[[Parameter, Array, Array], tuple[Path, Array]]


def geodesic_path(parameter: Parameter, X: Array, M: Array) -> tuple[Path, Array]:
    """Cluster the stations from tip to hub and join them by geodesics.

    Returns the path and the linear maps that belong to its bases.
    """
    X, M = affine.cluster(X, M)
    return GeodesicPath(parameter.knots, X), M


def spline_path(parameter: Parameter, X: Array, M: Array) -> tuple[Path, Array]:
    """Cluster the stations from tip to hub and join them by geodesics with blended corners.

    Returns the path and the linear maps that belong to its bases.
    """
    X, M = affine.cluster(X, M)
    return SplinePath(parameter.knots, X, parameter.thickness, parameter.speeds), M


PATHS: dict[str, PathMaker] = {"spline": spline_path, "geodesic": geodesic_path}
DEFAULT = "spline"
