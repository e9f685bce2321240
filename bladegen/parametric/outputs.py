"""Surfaces that a differentiable blade gives: meshes and structured grids, with derivatives.

These functions are methods of `ParametricBlade`.
"""

from functools import lru_cache
from typing import Any

from bladegen.parametric.surfaces import GridModel, MeshModel
from bladegen.support.arrays import Array, ArrayLike
from bladegen.surface.grids.grid import Spacing
from bladegen.surface.mesh import TriangleMesh
from bladegen.surface.tips import Tip, flat_tip

__all__ = ["grid", "grid_jacobian", "mesh", "mesh_jacobian"]

KEPT = 4  # surfaces whose cells and features are remembered

_mesh, _grid = lru_cache(KEPT)(MeshModel), lru_cache(KEPT)(GridModel)


def mesh(model: Any, x: ArrayLike, *, tip: Tip = flat_tip) -> TriangleMesh:
    """Return a watertight mesh through the sections at one vector (p,), ended by a tip.

    Its triangles are the baseline's, so that vertices correspond.
    """
    return _mesh(model, tip)(model.vector(x))


def mesh_jacobian(model: Any, x: ArrayLike, *, tip: Tip = flat_tip) -> Array:
    """Return the derivatives (v, 3, p) of the vertices of `mesh` in the parameters."""
    return _mesh(model, tip).jacobian(model.vector(x))


def grid(
    model: Any, x: ArrayLike, spacing: Spacing | None = None, *, tip: Tip = flat_tip
) -> tuple[Array, ...]:
    """Return the points (ni, nj, 3) of the blocks of `surface.grids.grid.from_blade`.

    At one vector (p,); where points lie on the surface, by span and landmark parameter, is the
    baseline's.
    """
    return _grid(model, spacing or Spacing(), tip)(model.vector(x))


def grid_jacobian(
    model: Any, x: ArrayLike, spacing: Spacing | None = None, *, tip: Tip = flat_tip
) -> tuple[Array, ...]:
    """Return the derivatives (ni, nj, 3, p) of the points of `grid` in the parameters."""
    return _grid(model, spacing or Spacing(), tip).jacobian(model.vector(x))
