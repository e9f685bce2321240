"""Meshes and structured grids of a differentiable blade: fixed cells, points that move.

Triangles, blocks and the places (eta, u) of points are the baseline's, so that points correspond
whatever the parameters.  All points are sections' points, or lie on the tip between them: what
lays them out is linear in these, but for the arcs of a round tip, whose derivative `tips` has.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.errors import PerturbationError
from bladegen.support.arguments import shown
from bladegen.support.arrays import Array, Indices
from bladegen.surface import mesh
from bladegen.surface.grids import blocks
from bladegen.surface.grids.coupling import coupled
from bladegen.surface.grids.spacing import Spacing
from bladegen.surface.tips import SPANS, Tip, ends, flat_tip, on_arcs, round_tip, round_tip_slopes

__all__ = ["GridModel", "MeshModel"]


class SectionModel(Protocol):
    """Sections as a function of a vector x (p,): a `ParametricBlade`."""

    @property
    def blade(self) -> Blade:
        """The baseline."""
        ...

    @property
    def eta(self) -> Array:
        """Span fractions."""
        ...

    @property
    def u(self) -> Array | None:
        """Landmark parameters, None for the blade's."""
        ...

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters' names."""
        ...

    @property
    def baseline(self) -> Array:
        """The vector that changes nothing."""
        ...

    def at(self, eta: Array, u: Array | None = None) -> "SectionModel":
        """Return the model at other places."""
        ...

    def sections(self, x: Array) -> Array:
        """Return sections (k, n, 3)."""
        ...

    def jacobian(self, x: Array) -> Array:
        """Return derivatives (k, n, 3, p)."""
        ...


@dataclass(frozen=True, eq=False)
class TipModel:
    """A tip's arcs, from the sections of a model at `tips.SPANS`."""

    model: SectionModel
    tip: Tip

    def __post_init__(self) -> None:
        if self.tip not in (flat_tip, round_tip):
            raise PerturbationError(
                f"tip: got {shown(self.tip)}, derivatives are known of flat_tip and round_tip"
            )

    @property
    def is_flat(self) -> bool:
        """Whether there are no arcs."""
        return self.tip is flat_tip

    def points(self, x: Array) -> tuple[Array, Array | None]:
        """Return the last section (n, 3) and the arcs' poles (m, 4, 3)."""
        sections = self.model.sections(x)
        return sections[0], self.tip(*ends(sections))

    def slopes(self, x: Array) -> tuple[Array, Array | None]:
        """Return the derivatives (n, 3 p) and (m, 4, 3 p) of both."""
        changes = self.model.jacobian(x)
        if self.is_flat:
            return _flat(changes[0]), None
        given = ends(self.model.sections(x))
        return _flat(changes[0]), _flat(round_tip_slopes(given, ends(changes)))


@dataclass(frozen=True, eq=False)
class MeshModel:
    """A triangle mesh through the sections of a model that reach from root to tip."""

    model: SectionModel
    tip: Tip

    def __post_init__(self) -> None:
        if self.model.eta[-1] != 1.0:
            raise PerturbationError(
                f"eta: ends at {self.model.eta[-1]:g}, a mesh needs the tip, 1, as its last"
            )

    @cached_property
    def _end(self) -> TipModel:
        return TipModel(self.model.at(SPANS, self.model.u), self.tip)

    @cached_property
    def _cells(self) -> tuple[Indices, Indices]:
        x = self.model.baseline
        _, used, faces, _ = mesh.topology(
            self.model.sections(x), self._across(self._end.points(x)[1])
        )
        return used, faces

    @staticmethod
    def _across(poles: Array | None) -> Array | None:
        w = np.linspace(0.0, 1.0, mesh.ACROSS + 1)
        return None if poles is None else on_arcs(poles[:, None], w[None])

    def __call__(self, x: Array) -> mesh.TriangleMesh:
        """Return the mesh at a vector (p,)."""
        used, faces = self._cells
        parts = [self.model.sections(x), self._across(self._end.points(x)[1])]
        return mesh.TriangleMesh(_joined(parts, 3)[used], faces)

    def jacobian(self, x: Array) -> Array:
        """Return the derivatives (v, 3, p) of its vertices."""
        count = len(self.model.names)
        parts = [_flat(self.model.jacobian(x)), self._across(self._end.slopes(x)[1])]
        return _joined(parts, 3 * count)[self._cells[0]].reshape(-1, 3, count)


@dataclass(frozen=True, eq=False)
class GridModel:
    """A structured grid over the surface of a model's blade."""

    model: SectionModel
    spacing: Spacing
    tip: Tip

    @cached_property
    def _spacing(self) -> Spacing:
        return coupled(self.spacing, self.model.blade, self.tip)

    @cached_property
    def _sides(self) -> SectionModel:
        spacing = self._spacing
        return self.model.at(spacing.spans(self.model.blade), spacing.parameters())

    @cached_property
    def _frame(self) -> tuple[blocks.Frame, TipModel]:
        """Where points lie, and the tip, of the baseline."""
        x, u = self.model.baseline, self._spacing.parameters()
        sections = self._sides.sections(x)
        blunt = blocks.is_blunt(self.model.blade.name, sections)
        if not blunt:
            sections[:, -1] = sections[:, 0]
        poles = TipModel(self.model.at(SPANS, u), self.tip).points(x)[1]
        made = blocks.frame(sections, u, self.spacing.edge, poles, blunt=blunt)
        return made, TipModel(self.model.at(SPANS, made.places), self.tip)

    def _made(
        self, sections: Array, ended: Callable[[TipModel], tuple[Array, Array | None]]
    ) -> list[blocks.Block]:
        frame, end = self._frame
        if frame.edge is None:
            sections[:, -1] = sections[:, 0]
        return frame.blocks(sections, ended(end), self._sides.eta, self._spacing.parameters())

    def __call__(self, x: Array) -> tuple[Array, ...]:
        """Return the points (ni, nj, 3) of its blocks at a vector (p,)."""
        made = self._made(self._sides.sections(x), lambda end: end.points(x))
        return tuple(block.points for block in made)

    def jacobian(self, x: Array) -> tuple[Array, ...]:
        """Return the derivatives (ni, nj, 3, p) of the points of its blocks."""
        made = self._made(_flat(self._sides.jacobian(x)), lambda end: end.slopes(x))
        count = len(self.model.names)
        return tuple(b.points.reshape(*b.points.shape[:2], 3, count) for b in made)


def _flat(slopes: Array) -> Array:
    """Return derivatives (..., 3, p) of points as (..., 3 p), for what is linear in points."""
    return slopes.reshape(*slopes.shape[:-2], -1)


def _joined(parts: list[Array | None], length: int) -> Array:
    """Return arrays (..., length) as one (m, length)."""
    return np.concatenate([part.reshape(-1, length) for part in parts if part is not None])
