"""A blade as a shell model: elements, the laminate of each, sets by name, and what it weighs.

A layer that covers a part of an element is there with that part of its thickness, so that the
model weighs what its layers do; what lies on a trailing edge that is closed is on the elements
beside it.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.layup.laid import Laid
from bladegen.blade.layup.layup import Layup
from bladegen.blade.layup.shell.mesh import Mesh, mesh_of
from bladegen.blade.layup.shell.quality import areas, corner_normals, figures
from bladegen.blade.layup.shell.trailing_edge import WIDE
from bladegen.blade.spans import MIRROR
from bladegen.definition.structure.structure import Structure
from bladegen.errors import Finding, GeometryError
from bladegen.support.arguments import amount
from bladegen.support.arrays import Array, Indices, Mask

__all__ = ["SIZES", "Section", "ShellModel", "shell_model"]

SIZES = 0.02, 20.0  # m, of elements
MIRRORED = [0, 3, 2, 1, 7, 6, 5, 4]  # nodes of an element that looks the other way
THIN = 1e-6  # m
WHOLE = 0.999  # of an element, covered by a layer
NONE = 1e-3
HALF = 0.75  # of an element on one half of the trailing edge
MOVED = 1e-3  # of the arc
TURNED = np.cos(np.radians(20.0))  # of normals in one section


@dataclass(frozen=True, eq=False)
class Section:
    """Elements with one laminate.

    Parameters
    ----------
    name : str
        Of the set.
    elements : (e,) array
        Which.
    layers : tuple of (int, float)
        Layers of the structure from the outside to the inside, and their thickness [m].
    skin : bool
        Whether it lies inside of its nodes; a web's lies about them.
    """

    name: str
    elements: Indices
    layers: tuple[tuple[int, float], ...]
    skin: bool


@dataclass(frozen=True, eq=False, repr=False)
class ShellModel:
    """A blade's shell and its laminates.

    Parameters
    ----------
    blade : Blade
    structure : Structure
    mesh : Mesh
        Nodes and elements; those of the skin look outward.
    thickness : (layers, m) array
        Of each layer on each element [m], 0 where it is not.
    angle : (layers, m) array
        Of the fibres to the span [rad].
    """

    blade: Blade
    structure: Structure
    mesh: Mesh
    thickness: Array
    angle: Array

    def __repr__(self) -> str:
        made = len(self.mesh.quads), len(self.mesh.points)
        return f"<ShellModel of {self.blade.name}: {made[0]} elements, {made[1]} nodes>"

    @cached_property
    def areas(self) -> Array:
        """Areas (m,) of the elements [m2]."""
        return areas(self.mesh.points, self.mesh.quads)

    @property
    def mass(self) -> float:
        """Mass [kg] of all elements."""
        density = np.array([self.structure.by_name[one.material].density for one in self._layers])
        return float((density @ self.thickness) @ self.areas)

    @property
    def quality(self) -> dict[str, Any]:
        """How good the elements are; see `quality.figures`."""
        return figures(self.mesh.points, self.mesh.quads)

    @cached_property
    def axes(self) -> tuple[Array, Array]:
        """Unit vectors (m, 3) of each element along the span, and toward the leading edge.

        On webs the second leads from the suction to the pressure side.
        """
        a, b, c, d = self.mesh.points[self.mesh.quads[:, :4]].swapaxes(0, 1)
        along, across = 0.5 * (b - a + c - d), 0.5 * (d - a + c - b)
        if self.blade.mirrored:  # whose elements go round the other way
            along, across = across, along
        along /= np.linalg.norm(along, axis=-1, keepdims=True)
        panel = self.panel[:, None]
        along = np.where(panel, self.mesh.along, along)
        along /= np.linalg.norm(along, axis=-1, keepdims=True)
        across -= np.einsum("mi,mi->m", across, along)[:, None] * along
        across /= np.linalg.norm(across, axis=-1, keepdims=True)
        back: Mask = self.pressure | (self.mesh.edge[:, 1] > HALF)
        return along, np.where(back[:, None], -across, across)

    @property
    def panel(self) -> Mask:
        """Which elements (m,) lie on a panel of the trailing edge."""
        found: Mask = self.mesh.edge.sum(axis=-1) > 0.0
        return found

    @cached_property
    def pressure(self) -> Mask:
        """Which elements (m,) lie on the skin of the pressure side."""
        mesh = self.mesh
        nose = mesh.lines.fractions[1::2, mesh.lines.nose][mesh.bay]
        found: Mask = (mesh.part == 0) & (mesh.sides.mean(axis=-1) > nose)
        return found

    @property
    def _layers(self) -> tuple[Any, ...]:
        return self.structure.layers

    @cached_property
    def sets(self) -> dict[str, Indices]:
        """Elements by name: parts, sides, and layers where they cover most of an element."""
        skin = self.mesh.part == 0
        found: dict[str, Mask] = {"SKIN": skin}
        suction = skin & ~self.pressure & ~self.panel
        found |= {"SUCTION_SIDE": suction, "PRESSURE_SIDE": self.pressure}
        found |= {"TRAILING_EDGE": self.panel}
        for i, web in enumerate(self.structure.webs):
            found[f"WEB_{web.name}"] = self.mesh.part == i + 1
        full = self._full
        for i, layer in enumerate(self._layers):
            half = 0.5 * full[i, self.mesh.bay]
            found[f"LAYER_{layer.name}"] = (self.thickness[i] > THIN) & (self.thickness[i] > half)
        return {name: np.flatnonzero(held) for name, held in found.items() if held.any()}

    @cached_property
    def _full(self) -> Array:
        """Thickness (layers, bays) of layers where they cover all of an element."""
        found = np.zeros((len(self._layers), int(self.mesh.bay.max()) + 1))
        for row, own in zip(found, self.thickness, strict=True):
            np.maximum.at(row, self.mesh.bay, own)
        return found

    @cached_property
    def sections(self) -> list[Section]:
        """Neighbours of one bay with the same laminate, which look about the same way."""
        mesh, made = self.mesh, list[Section]()
        normals = corner_normals(mesh.points, mesh.quads)[:, :4].mean(axis=1)
        normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
        held = (self.thickness > THIN).T
        keys = np.where(held, np.round(self.thickness.T, 9), 0.0)
        fresh = np.any(keys[1:] != keys[:-1], axis=1)
        fresh |= (mesh.bay[1:] != mesh.bay[:-1]) | (mesh.part[1:] != mesh.part[:-1])
        first = 0
        for i in range(1, len(keys) + 1):
            if i < len(keys) and not fresh[i - 1] and normals[i] @ normals[first] > TURNED:
                continue
            layers = tuple((int(k), float(keys[first, k])) for k in np.flatnonzero(keys[first]))
            part = self.structure.webs[mesh.part[first] - 1].name if mesh.part[first] else "SKIN"
            name = f"S_{part}_{mesh.bay[first]}_{mesh.column[first]}"
            made.append(Section(name, np.arange(first, i), layers, mesh.part[first] == 0))
            first = i
        return made

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """What of the model is not as the blade is."""
        said, mesh = [], self.mesh
        spans = ", ".join(f"{low:.3f} to {high:.3f}" for low, high in mesh.panels)
        panels = f"; they are panels of their own at eta = {spans}" if spans else ""
        if mesh.gap > THIN:
            share = mesh.gap / float(self.blade.chord(mesh.widest))
            closed = f"are closed to their middle, up to {1e3 * mesh.gap:.0f} mm"
            where = f", {100.0 * share:.0f} % of the chord at eta = {mesh.widest:.3f}"
            short = "; too few rows of elements there for a panel" if share > WIDE else ""
            said.append(Finding("shell: trailing edges", closed + where + short + panels))
        for name, by in mesh.lines.moved.items():
            if by > MOVED:
                where = f"stands up to {by:.3f} of the arc beside its place, to keep off others"
                said.append(Finding(f"shell: web {name}", where))
        bare = int(np.count_nonzero(~(self.thickness > THIN).any(axis=0)))
        if bare:
            said.append(Finding("shell", f"{bare} elements have no layer; they are left out"))
        return tuple(said)


def shell_model(layup: Layup, size: float = 1.0) -> ShellModel:
    """Return a blade as a shell model.

    Parameters
    ----------
    layup : Layup
        `blade.layup`.
    size : float
        Of the elements, about [m].

    Raises
    ------
    GeometryError
        If the size is none, or elements fold.
    """
    size = amount(size, "element", GeometryError)
    if not SIZES[0] <= size <= SIZES[1]:
        raise GeometryError(f"element: got {size:g} m, allowed is {SIZES[0]:g} to {SIZES[1]:g} m")
    blade = layup.blade
    own = blade.mirror_image() if blade.mirrored else blade
    mesh = mesh_of(own, layup.structure, size)
    laid = Layup(own, layup.structure).at(np.unique(mesh.eta))
    thickness, angle = _covered(layup.structure, mesh, laid)
    if blade.mirrored:
        turned = mesh.quads[:, MIRRORED]
        other = {"points": mesh.points * MIRROR, "along": mesh.along * MIRROR, "quads": turned}
        mesh = Mesh(**vars(mesh) | other)
    model = ShellModel(blade, layup.structure, mesh, thickness, angle)
    worst = model.quality["smallest_jacobian"]
    if worst <= 0.0:
        raise GeometryError(
            f"element: some of {size:g} m fold (Jacobian {worst:.2g}); a smaller size may help"
        )
    return model


def _covered(structure: Structure, mesh: Mesh, laid: Laid) -> tuple[Array, Array]:
    """Return thickness and angle (layers, m) of layers on elements."""
    row = np.searchsorted(laid.eta, mesh.eta)
    number = {web.name: i + 1 for i, web in enumerate(structure.webs)}
    thickness = np.zeros((len(structure.layers), len(mesh.quads)))
    low, high = mesh.sides.T
    beside = np.stack([low == 0.0, high == 1.0], axis=-1) & (mesh.part == 0)[:, None]
    shut = beside * (mesh.shut[mesh.bay] * laid.half_edge[row])[:, None]
    wide = np.where(mesh.edge.any(axis=-1), 1.0, high - low)
    for i, layer in enumerate(structure.layers):
        here = mesh.part == number.get(layer.web, 0)
        ends = np.nan_to_num(laid.arcs[i][row] if not layer.web else _on_web(layer, laid.eta)[row])
        share = np.zeros(len(low))
        for turn in (0.0, 1.0) if layer.around else (0.0,):
            first, last = np.clip(ends + turn, 0.0, 1.0).T
            share += np.maximum(np.minimum(high, last) - np.maximum(low, first), 0.0) / wide
        share = np.where(share > WHOLE, 1.0, np.where(share < NONE, 0.0, share))
        if not layer.web:
            share += (laid.edge[i][row] * (mesh.edge + shut / wide[:, None])).sum(axis=-1)
        thickness[i] = np.where(here, share * laid.thickness[i][row], 0.0)
    return thickness, laid.angle[:, row]


def _on_web(layer: Any, eta: Array) -> Array:
    """Return the fractions (k, 2) of a web's height between which a layer lies."""
    return np.stack([end.fraction(eta) for end in (layer.start, layer.end)], axis=-1)
